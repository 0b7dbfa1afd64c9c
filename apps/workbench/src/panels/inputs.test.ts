import { expect, it } from "vitest";
import { sorted } from "./inputs";

it("files are meshes, terrain or footprints by their endings", () => {
  expect(sorted(["a.PLY", "b.gpkg", "b.mtl", "c.docx", "d.geojson", "e.obj.gz", "f.3tz"])).toEqual({
    meshes: ["a.PLY", "e.obj.gz", "f.3tz"],
    terrain: [],
    footprints: ["b.gpkg", "d.geojson"],
    beside: ["b.mtl"],
    unknown: ["c.docx"],
  });
});

it("a raster is the surface, unless there is a mesh or its name says that it is the ground", () => {
  const [mesh, terrain] = [{ meshes: ["a.tif"], terrain: [] }, { meshes: [], terrain: ["a.tif"] }];
  expect(sorted(["a.tif"])).toMatchObject(mesh);
  expect(sorted(["a.tif"], true)).toMatchObject(terrain);
  expect(sorted(["a.tif", "b.obj"])).toMatchObject({ meshes: ["b.obj"], terrain: ["a.tif"] });
  expect(sorted(["dsm.tif", "DTM_2021.tif"])).toMatchObject({ meshes: ["dsm.tif"], terrain: ["DTM_2021.tif"] });
});
