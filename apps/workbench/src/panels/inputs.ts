// Which of some files are meshes, which the terrain and which footprints, by their names.
const meshEndings = ["obj", "ply", "off", "glb", "gltf", "3tz"];
const rasterEndings = ["tif", "tiff", "vrt", "asc", "img"];
const footprintEndings = ["geojson", "json", "jsonl", "gpkg", "shp", "gml", "fgb", "zip", "kml", "osm", "pbf"];
/** Read along with another file of the same name. */
const besideEndings = ["mtl", "bin", "shx", "dbf", "prj", "cpg", "qmd", "png", "jpg", "jpeg", "tfw"];

/** A raster is the terrain where its name says so, or where there is a mesh; else it is the surface itself. */
export function sorted(names: readonly string[], meshThere = false) {
  const plain = (name: string) => name.toLowerCase().replace(/\.gz$/, "");
  const ending = (name: string) => plain(name).slice(plain(name).lastIndexOf(".") + 1);
  const of = (endings: string[]) => names.filter((n) => endings.includes(ending(n)));
  const known = [...meshEndings, ...rasterEndings, ...footprintEndings, ...besideEndings];
  const rasters = of(rasterEndings);
  const ground = (name: string) => /dtm|dgm|terrain|ground/.test(plain(name));
  const whole = meshThere || of(meshEndings).length > 0;
  return {
    meshes: [...of(meshEndings), ...rasters.filter((n) => !whole && !ground(n))],
    terrain: rasters.filter((n) => whole || ground(n)),
    footprints: of(footprintEndings),
    beside: of(besideEndings),
    unknown: names.filter((n) => !known.includes(ending(n))),
  };
}
