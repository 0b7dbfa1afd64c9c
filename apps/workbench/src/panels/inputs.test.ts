import { describe, expect, it } from "vitest";
import type { Format } from "../api/types";
import { accepted, extensionsOf, sorted, titlesOf } from "./inputs";

const format = (name: string, extensions: string[], reads: Format["reads"], sidecars: string[] = []): Format => ({
  name,
  title: name.toUpperCase(),
  description: "",
  extensions,
  sidecars,
  reads,
  files: [],
});
const known = {
  formats: [
    format("obj", [".obj"], ["mesh", "models"], [".mtl"]),
    format("ply", [".ply"], ["mesh"]),
    format("tiles", [".3tz"], ["mesh"]),
    format("geotiff", [".tif", ".tiff"], ["raster"], [".tfw"]),
    format("geojson", [".geojson", ".json"], ["footprints"]),
    format("geopackage", [".gpkg"], ["footprints", "models"]),
    format("zip", [".zip"], ["mesh", "footprints"]),
    format("osm", [".osm.pbf"], ["footprints"]),
    format("stl", [".stl"], []),
  ],
  compressed_extensions: [".gz"],
};

describe("dropped files", () => {
  it("are meshes, terrain or footprints by their file extensions", () => {
    expect(sorted(["a.PLY", "b.gpkg", "b.mtl", "c.docx", "d.geojson", "e.obj.gz", "f.3tz"], known)).toEqual({
      meshes: ["a.PLY", "e.obj.gz", "f.3tz"],
      terrain: [],
      footprints: ["b.gpkg", "d.geojson"],
      sidecars: ["b.mtl"],
      unknown: ["c.docx"],
    });
  });

  it("that are rasters are the mesh, unless there is a mesh or their name says terrain", () => {
    const [mesh, terrain] = [{ meshes: ["a.tif"], terrain: [] }, { meshes: [], terrain: ["a.tif"] }];
    expect(sorted(["a.tif"], known)).toMatchObject(mesh);
    expect(sorted(["a.tif"], known, true)).toMatchObject(terrain);
    expect(sorted(["a.tif", "b.obj"], known)).toMatchObject({ meshes: ["b.obj"], terrain: ["a.tif"] });
    expect(sorted(["dsm.tif", "DTM_2021.tif"], known)).toMatchObject({ meshes: ["dsm.tif"], terrain: ["DTM_2021.tif"] });
  });

  it("that can be a mesh or footprints are the mesh, unless there is one", () => {
    expect(sorted(["a.zip"], known)).toMatchObject({ meshes: ["a.zip"], footprints: [] });
    expect(sorted(["a.zip"], known, true)).toMatchObject({ meshes: [], footprints: ["a.zip"] });
    expect(sorted(["a.zip", "b.ply"], known)).toMatchObject({ meshes: ["b.ply"], footprints: ["a.zip"] });
  });
});

it("hints and file choosers list what the server reads", () => {
  expect(extensionsOf(known, "mesh", "raster")).toEqual([".obj", ".ply", ".3tz", ".tif", ".tiff", ".zip"]);
  expect(titlesOf(known, "raster", "models")).toEqual(["OBJ", "GEOTIFF", "GEOPACKAGE"]);
  expect(accepted(known, "models")).toBe(".obj,.gpkg,.mtl,.gz");
  expect(accepted(known, "footprints")).toContain(".pbf");
});
