// A CityJSON object as cityjson-threejs-loader has it: what its parser makes of the file, without a canvas. Its other
// modules leave file endings to a bundler, so the parser is imported by its place.
import assert from 'node:assert/strict';
import { ChunkParser } from 'cityjson-threejs-loader/src/parsers/helpers/ChunkParser.js';

const inMetres = ({ scale, translate }, vertices) => vertices.map((v) => v.map((c, i) => c * scale[i] + translate[i]));

/** Six times the volume of a tetrahedron over a triangle, from an origin near by. */
function volume6([a, b, c], o) {
  const [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = [a, b, c].map((p) => p.map((v, i) => v - o[i]));
  return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}

/**
 * Parses the file; asserts that LoD 2.2 of every part and building has the volume that its attribute
 * says. Returns counts.
 */
export function readWithLoader(original) {
  const file = structuredClone(original);  // the parser flattens semantics in place
  file.vertices = inMetres(file.transform, file.vertices);
  const ids = Object.keys(file.CityObjects);
  if (ids.length === 0) return { objects: 0, triangles: 0, volumes: 0 };
  const parser = new ChunkParser();
  parser.chunkSize = Infinity;
  const pieces = [];
  parser.onchunkload = (vertices, geometry, lods) => pieces.push({ vertices, geometry, lods });
  parser.parse(file);

  const seen = new Set(), volume = new Map();
  let triangles = 0;
  for (const { vertices, geometry, lods } of pieces) {
    const { objectIds, lodIds } = geometry;
    assert.equal(vertices.length, 3 * objectIds.length);
    for (let i = 0; i < objectIds.length; i += 3) {
      triangles++;
      const id = ids[objectIds[i]];
      seen.add(id);
      if (lods[lodIds[i]] !== '2.2') continue;
      const corners = [0, 1, 2].map((k) => vertices.slice(3 * (i + k), 3 * (i + k) + 3));
      volume.set(id, (volume.get(id) ?? 0) + volume6(corners, file.transform.translate) / 6);
    }
  }
  let volumes = 0;
  for (const id of ids) {
    const object = original.CityObjects[id];
    assert(seen.has(id) || !(object.geometry?.length > 0), `${id} is not seen`);
    const said = object.attributes?.ms_volume_lod22;
    if (said === undefined) continue;
    // The solid of a part is in that of its building, or of another part.
    const own = object.type === 'Building' || (object.geometry?.length > 0 && !object.attributes['+ms_solid_of']);
    if (!own) continue;
    volumes++;
    const read = [id, ...(object.children ?? [])].reduce((sum, of) => sum + (volume.get(of) ?? 0), 0);
    assert(Math.abs(read - said) < 1e-3 * said + 0.01, `${id}: ${read} m³ are read, ${said} are said`);
  }
  return { objects: seen.size, triangles, volumes };
}
