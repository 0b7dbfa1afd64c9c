// Which of some files are meshes and which footprints, by their names.
const meshEndings = ["obj", "ply", "off", "glb", "gltf"];
const footprintEndings = ["geojson", "json", "gpkg", "shp", "gml", "fgb", "zip", "kml", "osm", "pbf"];
/** Read along with another file of the same name. */
const besideEndings = ["mtl", "bin", "shx", "dbf", "prj", "cpg", "qmd", "png", "jpg", "jpeg"];

export function sorted(names: readonly string[]) {
  const ending = (name: string) => name.slice(name.lastIndexOf(".") + 1).toLowerCase();
  const of = (endings: string[]) => names.filter((n) => endings.includes(ending(n)));
  const known = [...meshEndings, ...footprintEndings, ...besideEndings];
  return {
    meshes: of(meshEndings),
    footprints: of(footprintEndings),
    beside: of(besideEndings),
    unknown: names.filter((n) => !known.includes(ending(n))),
  };
}
