// node tiles.mjs DIR: holds every tileset of DIR, and the metadata of every GLB, against schemas/ (ajv, strict) and
// against what the specifications say beyond a schema: sizes and places of columns, feature ids that name a row, enums,
// boxes within boxes, content that is there and within its box, errors that fall. Each check is then shown a file with
// that very fault.
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import Ajv from 'ajv/dist/2020.js';

const here = dirname(fileURLToPath(import.meta.url));
const ajv = new Ajv.default({ strict: true, strictRequired: false, strictTypes: false, allErrors: true });
const schema = (name) => ajv.compile(JSON.parse(readFileSync(join(here, 'schemas', `${name}.schema.json`), 'utf8')));
const isTileset = schema('tileset'), isMetadata = schema('metadata'), isFeatures = schema('mesh_features');
const words = (validate) => validate.errors.slice(0, 3).map((e) => `${e.instancePath} ${e.message}`).join('; ');

const times = (a, b) => Array.from({ length: 16 }, (_, i) =>
  [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (i % 4)] * b[4 * Math.floor(i / 4) + k], 0));
const apply = (m, p) => [0, 1, 2].map((r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/**
 * The corners of what a GLB shows, in the axes of its tile: glTF has y up, tiles have z up. By the bounds that it says
 * of its positions, which Khronos's validator holds against these.
 */
function* cornersOf({ nodes, meshes, accessors }) {
  for (const { mesh } of nodes ?? [])
    for (const { attributes } of meshes?.[mesh]?.primitives ?? []) {
      const { min, max } = accessors[attributes.POSITION];
      for (let i = 0; i < 8; ++i) {
        const [x, y, z] = [0, 1, 2].map((axis) => (i >> axis & 1 ? max : min)[axis]);
        yield [x, -z, y];
      }
    }
}

const moves = ['matrix', 'translation', 'rotation', 'scale'];

/** Faults of a tileset.json; `contentAt` gives the JSON of a GLB, or nothing where there is none. */
function faultsOfTileset(tileset, contentAt) {
  if (!isTileset(tileset)) return [words(isTileset)];
  const faults = [];
  const walk = (tile, outer, parent) => {
    const here = times(outer, tile.transform ?? identity);
    for (const [u, v] of [[0, 1], [0, 2], [1, 2]]) {
      const dot = [0, 1, 2].reduce((sum, r) => sum + here[4 * u + r] * here[4 * v + r], 0);
      if (Math.abs(dot) > 1e-9) faults.push('a transform is no rotation');
    }
    if ([3, 7, 11, 15].some((i) => here[i] !== identity[i])) faults.push('a transform is not affine');
    const b = tile.boundingVolume.box;
    const half = [b.slice(3, 6), b.slice(6, 9), b.slice(9, 12)];
    if (half.some((axis) => Math.hypot(...axis) === 0)) faults.push('a box without extent');
    const [u, v, w] = half;
    if ([[u, v], [u, w], [v, w]].some(([p, q]) => Math.abs(p.reduce((sum, c, r) => sum + c * q[r], 0)) > 1e-9))
      faults.push('a box that is not right-angled');
    const corners = [...Array(8).keys()].map((i) => apply(here, [0, 1, 2].map((r) =>
      b[r] + half.reduce((sum, axis, a) => sum + (i >> a & 1 ? axis[r] : -axis[r]), 0))));
    if (parent) {
      if (tile.geometricError > parent.error) faults.push('an error larger than its parent’s');
      for (const corner of corners) {
        const d = corner.map((c, r) => c - apply(parent.here, parent.box.slice(0, 3))[r]);
        for (let a = 0; a < 3; ++a) {
          const along = [0, 1, 2].reduce((sum, r) => sum + d[r] * parent.here[4 * a + r], 0);
          if (Math.abs(along) > parent.box[3 + 4 * a] + 0.01) faults.push('a box outside of its parent’s');
        }
      }
    } else if (tile.geometricError > tileset.geometricError) {
      faults.push('an error larger than the tileset’s');
    }
    const content = tile.content && contentAt(tile.content.uri);
    if (tile.content && !content) faults.push(`no ${tile.content.uri}`);
    if (content?.nodes?.some((node) => moves.some((move) => node[move]))) faults.push('a node that moves its mesh');
    for (const corner of content ? cornersOf(content) : [])
      for (const axis of half) {
        const along = axis.reduce((sum, c, r) => sum + c * (corner[r] - b[r]), 0);
        if (Math.abs(along) > axis.reduce((sum, c) => sum + c * c, 0)) faults.push('content outside of its box');
      }
    for (const child of tile.children ?? []) walk(child, here, { here, box: b, error: tile.geometricError });
  };
  walk(tileset.root, identity, null);
  return faults;
}

function parts(bytes) {
  const length = bytes.readUInt32LE(12);
  return { json: JSON.parse(bytes.toString('utf8', 20, 20 + length)), start: 28 + length, bytes };
}

const twice = (list) => new Set(list).size !== list.length;

/** What must agree within a schema of metadata. */
function* faultsOfClasses({ classes = {}, enums = {} }) {
  for (const [id, { values }] of Object.entries(enums))
    if (twice(values.map((v) => v.name)) || twice(values.map((v) => v.value))) yield `${id}: a name or value twice`;
  for (const of of Object.values(classes))
    for (const [name, { type, enumType, noData }] of Object.entries(of.properties ?? {})) {
      if (type !== 'ENUM') continue;
      if (!enums[enumType]) yield `${name} is of an unknown enum`;
      else if (noData !== undefined && !enums[enumType].values.some((v) => v.name === noData))
        yield `${name} has noData that is none of its enum`;
    }
}

const sizes = { INT8: 1, UINT8: 1, INT16: 2, UINT16: 2, INT32: 4, UINT32: 4, INT64: 8, UINT64: 8, FLOAT32: 4, FLOAT64: 8 };

function faultsOfTable(table, metadata, json, bytes, start) {
  const faults = [];
  const of = metadata.schema.classes[table.class];
  if (!of) return ['a table of an unknown class'];
  for (const [name, column] of Object.entries(table.properties ?? {})) {
    const property = of.properties[name];
    if (!property) { faults.push(`${name} is not in the class`); continue; }
    const view = json.bufferViews[column.values];
    if (!view || view.target !== undefined || view.extensions) { faults.push(`${name} has no view`); continue; }
    if ((start + view.byteOffset) % 8 !== 0) faults.push(`${name} is not at a multiple of 8`);
    const type = property.type === 'ENUM' ? metadata.schema.enums[property.enumType].valueType : property.componentType;
    const wanted = property.type === 'BOOLEAN' ? Math.ceil(table.count / 8) : table.count * (sizes[type] ?? 0);
    if (property.type === 'STRING') {
      const offsets = json.bufferViews[column.stringOffsets];
      if (!offsets || offsets.byteLength !== 4 * (table.count + 1)) { faults.push(`${name}: offsets of another size`); continue; }
      let last = 0;
      for (let i = 0; i <= table.count; ++i) {
        const end = bytes.readUInt32LE(start + offsets.byteOffset + 4 * i);
        if (end < last || (i === 0 && end !== 0)) faults.push(`${name}: offsets fall`);
        last = end;
      }
      if (last !== view.byteLength) faults.push(`${name}: the last offset is not the end`);
      new TextDecoder('utf-8', { fatal: true }).decode(bytes.subarray(start + view.byteOffset, start + view.byteOffset + last));
    } else if (view.byteLength !== wanted) {
      faults.push(`${name}: ${view.byteLength} bytes, not ${wanted}`);
    }
    if (property.type === 'ENUM') {
      const known = new Set(metadata.schema.enums[property.enumType].values.map((v) => v.value));
      for (let i = 0; i < table.count; ++i)
        if (!known.has(bytes.readUInt8(start + view.byteOffset + i))) faults.push(`${name}: a value that is none of its enum`);
    }
  }
  return faults;
}

/** Faults of the metadata of a GLB. */
function faultsOfGlb({ json, start, bytes }) {
  const metadata = json.extensions?.EXT_structural_metadata;
  if (!metadata) return json.meshes ? ['no metadata'] : [];
  if (!isMetadata(metadata)) return [words(isMetadata)];
  const faults = [...faultsOfClasses(metadata.schema)];
  if (faults.length > 0) return faults;
  for (const table of metadata.propertyTables) faults.push(...faultsOfTable(table, metadata, json, bytes, start));
  for (const primitive of (json.meshes ?? []).flatMap((mesh) => mesh.primitives)) {
    const features = primitive.extensions?.EXT_mesh_features;
    if (!isFeatures(features)) { faults.push(words(isFeatures)); continue; }
    for (const id of features.featureIds) {
      const accessor = json.accessors[primitive.attributes[`_FEATURE_ID_${id.attribute}`]];
      if (accessor?.type !== 'SCALAR' || accessor.componentType === 5125) { faults.push('ids of a wrong type'); continue; }
      const view = json.bufferViews[accessor.bufferView];
      if (view.extensions) continue;  // compressed: the same ids, by the tests beside the writer
      // Of the attribute: EXT_mesh_features counts the unique values of the accessor, which primitives may share.
      const seen = new Set();
      for (let vertex = 0; vertex < accessor.count; ++vertex)
        seen.add(bytes.readFloatLE(start + view.byteOffset + accessor.byteOffset + 4 * vertex));
      if (seen.size !== id.featureCount) faults.push(`${id.label}: ${seen.size} ids, not ${id.featureCount}`);
      const rows = metadata.propertyTables[id.propertyTable]?.count ?? 0;
      if ([...seen].some((value) => value < 0 || value >= rows || !Number.isInteger(value))) faults.push(`${id.label}: an id without a row`);
    }
  }
  return faults;
}

const folder = process.argv[2];
let wrong = 0;
const say = (name, faults) => {
  for (const fault of new Set(faults)) console.error(`${name}: ${fault}`);
  wrong += faults.length;
};
const names = readdirSync(folder, { recursive: true }).map(String).sort();
const tilesets = names.filter((name) => name.endsWith('tileset.json'));
const glbs = names.filter((name) => name.endsWith('.glb') && !name.startsWith('labelled'));
if (tilesets.length < 10 || glbs.length < 50) throw new Error(`only ${tilesets.length} tilesets and ${glbs.length} GLB`);
const tilesetAt = (name) => JSON.parse(readFileSync(join(folder, name), 'utf8'));
const contentOf = (name) => (uri) => {
  const path = join(folder, dirname(name), uri);
  return existsSync(path) ? parts(readFileSync(path)).json : undefined;
};
for (const name of tilesets) say(name, faultsOfTileset(tilesetAt(name), contentOf(name)));
for (const name of glbs) say(name, faultsOfGlb(parts(readFileSync(join(folder, name)))));
console.log(`${tilesets.length} tilesets and ${glbs.length} GLB, ${wrong} faults`);

// No rubber stamp: one fault each.
const blind = (what, faults) => { if (faults.length === 0) { console.error(`${what} is not seen`); ++wrong; } };
const wide = 'wide/tileset.json';
const boundsOf = ({ accessors }) => accessors.filter((accessor) => accessor.max?.length === 3);
const leafOf = (tile) => (tile.children ? leafOf(tile.children[0]) : tile);
for (const [what, change] of [
  ['an unknown member', (t) => { t.root.colour = 'red'; }],
  ['a box of 11 numbers', (t) => { t.root.boundingVolume.box.pop(); }],
  ['no refinement', (t) => { delete t.root.refine; }],
  ['another version', (t) => { t.asset.version = '1.0'; }],
  ['a growing error', (t) => { t.root.children[0].geometricError = 1e6; }],
  ['a box that is too small', (t) => { t.root.boundingVolume.box[3] /= 2; }],
  ['a sheared transform', (t) => { t.root.transform[4] += 0.1; }],
  ['a transform with perspective', (t) => { t.root.transform[3] = 0.1; }],
  ['a box larger than its parent’s', (t) => { t.root.children[0].boundingVolume.box[3] *= 100; }],
  ['a box that leans', (t) => { t.root.boundingVolume.box[6] = 1; }],
  ['children that are the same', (t) => { t.root.children[1] = t.root.children[0]; }],
  ['a leaf whose box is too low', (t) => { leafOf(t.root).boundingVolume.box[11] /= 2; }],
  ['missing content', (t) => { t.root.content.uri = 'tiles/none.glb'; }],
]) {
  const tileset = tilesetAt(wide);
  change(tileset);
  blind(what, faultsOfTileset(tileset, contentOf(wide)));
}
for (const [what, change] of [
  ['content that is larger', (j) => { for (const bounds of boundsOf(j)) bounds.max[0] += 9; }],
  ['content with z up', (j) => {
    for (const { min, max } of boundsOf(j)) for (const m of [min, max]) m.splice(1, 2, m[2], m[1]);
  }],
  ['content that is moved', (j) => { j.nodes[0].translation = [0, 0, 1]; }],
]) {
  const spoil = (uri) => {
    const content = contentOf(wide)(uri);
    change(content);
    return content;
  };
  blind(what, faultsOfTileset(tilesetAt(wide), spoil));
}
const street = readFileSync(join(folder, 'street.glb'));
const columns = (j) => j.extensions.EXT_structural_metadata;
const kinds = (j) => columns(j).schema.enums.surface_class.values;
for (const [what, change] of [
  ['a name with a blank', (j) => { const p = columns(j).schema.classes.part.properties; p['a b'] = p.name; }],
  ['a flag with noData', (j) => { columns(j).schema.classes.part.properties.x = { type: 'BOOLEAN', noData: false }; }],
  ['a number without a type', (j) => { delete columns(j).schema.classes.part.properties.order.componentType; }],
  ['a column of another size', (j) => { columns(j).propertyTables[0].count += 1; }],
  ['a column of no class', (j) => { delete columns(j).schema.classes.surface.properties.slope; }],
  ['a view off its place', (j) => { j.bufferViews[columns(j).propertyTables[0].properties.order.values].byteOffset += 4; }],
  ['a wrong count of features', (j) => { j.meshes[0].primitives[0].extensions.EXT_mesh_features.featureIds[1].featureCount += 1; }],
  ['ids beyond the table', (j) => { columns(j).propertyTables[1].count = 1; }],
  ['an unknown enum value', (j) => { kinds(j).pop(); kinds(j).shift(); }],
  ['an enum with a name twice', (j) => { kinds(j).push({ name: kinds(j)[0].name, value: 200 }); }],
  ['an enum with a value twice', (j) => { kinds(j).push({ name: 'other', value: kinds(j)[0].value }); }],
  ['an enum without a name', (j) => { kinds(j)[0].name = ''; }],
  ['an unknown enum', (j) => { delete columns(j).schema.enums.surface_class; }],
  ['noData of no enum', (j) => { columns(j).schema.classes.surface.properties.class.noData = 'none'; }],
  ['a table of no class', (j) => { columns(j).propertyTables[0].class = 'other'; }],
  ['no features', (j) => { delete j.meshes[0].primitives[0].extensions; }],
]) {
  const glb = parts(street);
  change(glb.json);
  blind(what, faultsOfGlb(glb));
}
process.exit(wrong === 0 ? 0 : 1);
