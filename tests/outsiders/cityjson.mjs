// node cityjson.mjs SAMPLES MANSARD DATA EXTENSION: holds every CityJSON object and feature of the samples, and of runs
// of MANSARD over DATA, against the schemas beside this script, against our extension, and against what the
// specification asks beyond a schema; then reads them with cityjson-threejs-loader. Copies that were spoilt must be
// refused.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import Ajv2020 from 'ajv/dist/2020.js';
import { readWithLoader } from './cityjson_loader.mjs';

const [samples, mansard, data, extensionFile] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), 'mansard-cityjson-'));
process.on('exit', () => rmSync(scratch, { recursive: true, force: true }));
const utf8 = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true });
const textOf = (path) => utf8.decode(readFileSync(path));
const json = (path) => JSON.parse(textOf(path));

// ---- the schemas: of the core, and of what the extension declares

const ajv = new Ajv2020.default({ strict: false, allErrors: false });
const schema = (name) => json(new URL(`./schemas/${name}.schema.json`, import.meta.url));
const core = ajv.compile(schema('cityjson'));
const feature = ajv.compile(schema('cityjsonfeature'));
const extensionRules = ajv.compile(schema('cityjsonextension'));
const extension = json(extensionFile);
assert(extensionRules(extension), `the extension: ${ajv.errorsText(extensionRules.errors)}`);

// What the extension says of plans is what docs/plan.schema.json says.
const plans = JSON.parse(
  JSON.stringify(json(join(data, '../docs/plan.schema.json'))).replaceAll('#/$defs/', '#/definitions/'),
);
for (const name of ['plan_ring', 'profile', 'polygon', 'ring', 'pair', 'coordinate'])
  assert.deepEqual(extension.definitions[name], plans.$defs[name], name);
for (const [name, rule] of Object.entries(plans.$defs.plan.properties))
  assert.deepEqual(extension.definitions.plan.properties[name], rule, name);
const made = extension.extraRootProperties['+mansard'].properties;
assert.deepEqual(made.made_by, plans.properties.made_by);

const declared = (rule) => ajv.compile({ definitions: extension.definitions, ...rule });
const declaredAll = (rules) => new Map(Object.entries(rules).map(([name, rule]) => [name, declared(rule)]));
const declaredRoot = declaredAll(extension.extraRootProperties);
const declaredAttributes = new Map(
  Object.entries(extension.extraAttributes).map(([type, rules]) => [type, declaredAll(rules)]),
);

function* extensionFaults(members, rules, place) {
  for (const [name, value] of Object.entries(members ?? {})) {
    if (!name.startsWith('+')) continue;
    const rule = rules?.get(name);
    if (rule === undefined) yield `${place} ${name} is declared by no extension`;
    else if (!rule(value)) yield `${place} ${name}: ${ajv.errorsText(rule.errors)}`;
  }
}

// ---- what a schema cannot say (sections 2, 3 and 8 of the specification)

const vertexNumbers = (boundaries) => boundaries.flat(Infinity);

/** The names that stand twice in one object of the text: JSON.parse keeps the last of them and says nothing. */
function* doubledNames(text) {
  const open = [];
  let last;
  for (const [token] of text.matchAll(/"(?:[^"\\]|\\.)*"|[{}[\]:]/g)) {
    if (token === '{') open.push(new Set());
    else if (token === '[') open.push(null);
    else if (token === '}' || token === ']') open.pop();
    else if (token !== ':') last = token;
    else if (open.at(-1).size === open.at(-1).add(JSON.parse(last)).size) yield `${last} is there twice`;
  }
}

function* structureFaults(objects, vertices) {
  const used = new Set();
  for (const [id, object] of Object.entries(objects)) {
    for (const child of object.children ?? [])
      if (!objects[child]?.parents?.includes(id)) yield `${id}: the child ${child} does not name it as parent`;
    for (const parent of object.parents ?? [])
      if (!objects[parent]?.children?.includes(id)) yield `${id}: the parent ${parent} does not name it as child`;
    for (const geometry of object.geometry ?? []) {
      const faces = geometry.type === 'Solid' ? geometry.boundaries.flat() : geometry.boundaries;
      if (faces.flat().some((ring) => ring.some((v, i) => v === ring.at(i - 1))))
        yield `${id}: a vertex follows itself`;
      for (const v of vertexNumbers(geometry.boundaries)) {
        if (v >= vertices.length) yield `${id}: vertex ${v} of ${vertices.length}`;
        used.add(v);
      }
      if (geometry.semantics === undefined) continue;
      const { surfaces, values } = geometry.semantics;
      const shells = geometry.type === 'Solid' ? geometry.boundaries : [geometry.boundaries];
      const named = geometry.type === 'Solid' ? values : [values];
      if (shells.length !== named.length || shells.some((shell, s) => shell.length !== named[s].length))
        yield `${id}: semantics.values are not of the shape of the boundaries`;
      if (vertexNumbers(values).some((v) => v !== null && v >= surfaces.length))
        yield `${id}: semantics name no surface`;
    }
  }
  if (used.size !== vertices.length) yield `${vertices.length - used.size} vertices are not used`;
  if (new Set(vertices.map(String)).size !== vertices.length) yield 'a vertex is there twice';
}

/** Textures must have the shape of the boundaries, and name images and coordinates that are there; all must be named. */
function* textureFaults(objects, appearance) {
  const images = new Set(), places = new Set();
  for (const [id, object] of Object.entries(objects))
    for (const { boundaries, texture } of object.geometry ?? [])
      for (const [theme, { values }] of Object.entries(texture ?? {})) {
        if (theme !== appearance?.['default-theme-texture']) yield `${id}: a theme that is not there`;
        const shape = (all, more) => JSON.stringify(all.map((shell) => shell.map((face) => face.map((r) => r.length + more))));
        if (shape(values, 0) !== shape(boundaries, 1)) yield `${id}: its texture is not of the shape of the boundaries`;
        for (const [image, ...ring] of values.flat(2)) images.add(image), ring.forEach((place) => places.add(place));
      }
  if ([...images].some((image) => image >= (appearance?.textures.length ?? 0))) yield 'an image that is not there';
  if ([...places].some((place) => place >= (appearance?.['vertices-texture'].length ?? 0))) yield 'a coordinate that is not there';
  if (images.size !== (appearance?.textures.length ?? 0)) yield 'images that are not used, or are not there';
  if (places.size !== (appearance?.['vertices-texture'].length ?? 0)) yield 'coordinates that are not used, or are not there';
}

/** Whether an extent is not the box of these vertices. */
function isOff(extent, numbers, vertices, { scale, translate }) {
  const at = (v, axis) => (vertices[v]?.[axis] ?? NaN) * scale[axis] + translate[axis];
  const box = [Math.min, Math.max].flatMap((far) =>
    [0, 1, 2].map((axis) => numbers.reduce((all, v) => far(all, at(v, axis)), at(numbers[0], axis))));
  return extent === undefined || !box.every((x, i) => Math.abs(x - extent[i]) <= 1e-6);
}

/** A building's geographicalExtent must be the box of its geometry and that of its parts. */
function* extentFaults(objects, vertices, transform) {
  for (const [id, object] of Object.entries(objects)) {
    if (object.type !== 'Building') continue;
    const family = [object, ...(object.children ?? []).map((child) => objects[child])];
    const numbers = family.flatMap((one) => (one?.geometry ?? []).flatMap((g) => vertexNumbers(g.boundaries)));
    if (numbers.length > 0 && isOff(object.geographicalExtent, numbers, vertices, transform)) yield `${id}: its extent`;
  }
}

function* objectFaults(objects, vertices, transform, appearance) {
  for (const [id, object] of Object.entries(objects))
    yield* extensionFaults(object.attributes, declaredAttributes.get(object.type), id);
  yield* structureFaults(objects, vertices);
  yield* extentFaults(objects, vertices, transform);
  yield* textureFaults(objects, appearance);
}

/** The first fault of a CityJSON object; undefined when there is none. */
function faultOfFile(file) {
  if (!core(file)) return ajv.errorsText(core.errors);
  for (const name of Object.keys(file).filter((key) => key.startsWith('+')))
    if (file.extensions?.[extension.name] === undefined) return `${name}, but no extension ${extension.name}`;
  if (file.extensions[extension.name].version !== extension.version) return 'another version of the extension';
  if (file.extensions[extension.name].url !== extension.url) return 'the extension has another url';
  for (const fault of extensionFaults(file, declaredRoot, 'root')) return fault;
  for (const fault of objectFaults(file.CityObjects, file.vertices, file.transform, file.appearance)) return fault;
  const all = [...file.vertices.keys()];
  if (all.length > 0 && isOff(file.metadata?.geographicalExtent, all, file.vertices, file.transform))
    return 'the extent of all';
  return undefined;
}

function faultOfFeature(line, transform) {
  if (!feature(line)) return ajv.errorsText(feature.errors);
  const buildings = Object.keys(line.CityObjects).filter((id) => line.CityObjects[id].type === 'Building');
  if (buildings.length !== 1 || buildings[0] !== line.id) return `the buildings of ${line.id} are ${buildings}`;
  for (const fault of objectFaults(line.CityObjects, line.vertices, transform, line.appearance)) return fault;
  return undefined;
}

const linesIn = (path) => textOf(path).replace(/\n$/, '').split('\n');
const linesOf = (path) => linesIn(path).map((line) => JSON.parse(line));

function faultOfSequence(lines) {
  const [head, ...features] = lines;
  const fault = faultOfFile(head);
  if (fault !== undefined) return fault;
  if (Object.keys(head.CityObjects).length > 0 || head.vertices.length > 0) return 'the first line has objects';
  const ids = features.flatMap((line) => Object.keys(line.CityObjects));
  if (new Set(ids).size !== ids.length) return 'an id is there twice';
  return features.map((line) => faultOfFeature(line, head.transform)).find((found) => found !== undefined);
}

// ---- the files: those of the samples, and runs over real data, each as a sequence too

const files = readdirSync(samples, { recursive: true }).map((name) => join(samples, String(name)));
const run = (...args) => {
  try {
    execFileSync(mansard, [...args, '-q'], { stdio: ['ignore', 'ignore', 'pipe'] });
  } catch (e) {
    if (e.status !== 1) throw new Error(`mansard ${args.join(' ')}: ${e.stderr}`);  // 1: some buildings fell back
  }
};
const runs = {
  hall: ['reconstruct', join(data, 'hall/mesh.off'), join(data, 'hall/footprints.geojson')],
  delft: ['reconstruct', join(data, 'delft/mesh.ply'), join(data, 'delft/footprints.geojson'),
    '--mesh-offset', '84800', '447400', '0', '--bbox', '84880', '447500', '84920', '447550'],
  regent_street: ['extrude', join(data, 'regent_street/footprints.geojson')],
};
for (const [name, args] of Object.entries(runs)) {
  run(...args, '-o', join(scratch, name));
  const whole = join(scratch, name, 'model.city.json');
  run('convert', whole, '-o', join(scratch, `${name}.city.jsonl`));
  run('convert', join(scratch, `${name}.city.jsonl`), '-o', join(scratch, `${name}.city.json`));
  assert(readFileSync(whole).equals(readFileSync(join(scratch, `${name}.city.json`))), `${name}: not the bytes it had`);
  files.push(join(scratch, `${name}.city.json`), join(scratch, `${name}.city.jsonl`));
}

// With textures, whose images are in a folder beside.
const textured = join(scratch, 'textured');
run('reconstruct', join(data, 'textured/houses.obj'), join(data, 'textured/houses_footprints.geojson'), '--texture',
  '--formats', 'cityjson,cityjsonseq', '-o', textured);
for (const name of ['model.city.json', 'model.city.jsonl']) {
  files.push(join(textured, name));
  const images = (name.endsWith('l') ? linesOf(join(textured, name)) : [json(join(textured, name))]).flatMap((line) => line.appearance?.textures ?? []);
  assert(images.length > 0, `${name}: no textures`);
  for (const { image } of images) assert(readFileSync(join(textured, image)).length > 1000, image);
}

let objects = 0, sequences = 0, triangles = 0, volumes = 0, wrong = 0;
for (const path of files) {
  const whole = path.endsWith('.city.json'), sequence = path.endsWith('.city.jsonl');
  if (!whole && !sequence) continue;
  const [doubled] = (whole ? [textOf(path)] : linesIn(path)).flatMap((text) => [...doubledNames(text)]);
  const fault = doubled ?? (whole ? faultOfFile(json(path)) : faultOfSequence(linesOf(path)));
  if (fault !== undefined) console.error(`${path}: ${fault}`), wrong++;
  if (sequence) sequences++;
  if (whole) {
    const read = readWithLoader(json(path));
    objects += read.objects;
    triangles += read.triangles;
    volumes += read.volumes;
  }
}
console.log(`${objects} objects, ${triangles} triangles, ${volumes} volumes, ${sequences} sequences: ${wrong} with faults`);
assert(sequences >= 3 && objects > 200 && triangles > 2000 && volumes > 5, 'too little was looked at');

// ---- no rubber stamp

const hall = json(join(scratch, 'hall.city.json'));
const part = Object.keys(hall.CityObjects).find((id) => hall.CityObjects[id].type === 'BuildingPart');
const building = Object.keys(hall.CityObjects).find((id) => hall.CityObjects[id].children?.length > 0);
const solidOf = (f) => f.CityObjects[building].geometry.find((g) => g.lod === '2.2');
const spoilt = {
  'another version': (f) => (f.version = '1.1'),
  'no transform': (f) => delete f.transform,
  'an unknown member': (f) => (f.mansard = {}),
  'metadata of ours': (f) => (f.metadata.mansard = {}),
  'a vertex with decimals': (f) => (f.vertices[0][0] += 0.5),
  'a part without parents': (f) => delete f.CityObjects[part].parents,
  'two parents': (f) => {
    f.CityObjects.other = { type: 'Building', children: [part] };
    f.CityObjects[part].parents.push('other');
  },
  'a parent that does not know': (f) => delete f.CityObjects[building].children,
  'children that are none': (f) => (f.CityObjects.other = { type: 'Building', children: [] }),
  'a child that is not there': (f) => f.CityObjects[building].children.push('gone'),
  'a part of a part': (f) => {
    f.CityObjects.other = { type: 'BuildingPart', parents: [part] };
    f.CityObjects[part].children = ['other'];
  },
  'an unknown type': (f) => (f.CityObjects[part].type = 'House'),
  'a level of detail as a number': (f) => (solidOf(f).lod = 2.2),
  'a ring of two': (f) => solidOf(f).boundaries[0][0][0].splice(2),
  'a surface where a ring belongs': (f) => (solidOf(f).boundaries[0][0] = solidOf(f).boundaries[0][0][0]),
  'a vertex beyond the end': (f) => (solidOf(f).boundaries[0][0][0][0] = f.vertices.length),
  'a vertex nobody names': (f) => f.vertices.push([1, 2, 3]),
  'a vertex twice': (f) => (f.vertices[0] = f.vertices[1]),
  'a ring that is closed': (f) => solidOf(f).boundaries[0][0][0].push(solidOf(f).boundaries[0][0][0][0]),
  'an appearance': (f) => (f.appearance = {}),
  'an attribute with members': (f) => (f.CityObjects[part].attributes.size = { value: 3, uom: 'm' }),
  'an unknown surface': (f) => (solidOf(f).semantics.surfaces[0].type = 'Wall'),
  'one semantic value too few': (f) => solidOf(f).semantics.values[0].pop(),
  'a semantic value too deep': (f) => (solidOf(f).semantics.values = [solidOf(f).semantics.values]),
  'a semantic surface with members': (f) => (solidOf(f).semantics.surfaces[0].ms_slope = { value: 3 }),
  'a semantic value beyond the end': (f) => (solidOf(f).semantics.values[0][0] = 99),
  'an extension of version 1.0.0': (f) => (f.extensions.Mansard.version = '1.0.0'),
  'no extension named': (f) => delete f.extensions.Mansard,
  'an undeclared attribute': (f) => (f.CityObjects[part].attributes['+other'] = 1),
  'an undeclared member': (f) => (f['+other'] = 1),
  'a plan on the wrong object': (f) =>
    (f.CityObjects[building].attributes['+ms_plan'] = f.CityObjects[part].attributes['+ms_plan']),
  'a plan without profiles': (f) => delete f.CityObjects[part].attributes['+ms_plan'].profiles,
  'an extent of others': (f) => (f.CityObjects[building].geographicalExtent[5] += 1),
  'no extent': (f) => delete f.CityObjects[building].geographicalExtent,
  'an extent of less than all': (f) => (f.metadata.geographicalExtent[0] += 1),
  'a reference system that is none': (f) => (f.metadata.referenceSystem = 'EPSG:28992'),
};
assert.equal(faultOfFile(hall), undefined);
for (const [what, change] of Object.entries(spoilt)) {
  const copy = structuredClone(hall);
  change(copy);
  assert.notEqual(faultOfFile(copy), undefined, `not complained of: ${what}`);
}
const painted = json(join(textured, 'model.city.json'));
const valuesOf = (f) => Object.values(f.CityObjects).flatMap((o) => o.geometry ?? []).find((g) => g.texture).texture.visual.values;
assert.equal(faultOfFile(painted), undefined);
for (const [what, change] of Object.entries({
  'an image that is not there': (f) => (valuesOf(f)[0][0][0][0] = 99),
  'a coordinate that is not there': (f) => (valuesOf(f)[0][0][0][1] = 1e6),
  'a ring with a coordinate too few': (f) => valuesOf(f)[0][0][0].pop(),
  'a coordinate beside the image': (f) => (f.appearance['vertices-texture'][0][0] = 1.5),
  'an image of another type': (f) => (f.appearance.textures[0].type = 'WEBP'),
  'another theme': (f) => (f.appearance['default-theme-texture'] = 'winter'),
})) {
  const copy = structuredClone(painted);
  change(copy);
  assert.notEqual(faultOfFile(copy), undefined, `not complained of: ${what}`);
}
const lines = linesOf(join(scratch, 'hall.city.jsonl'));
for (const [what, change] of Object.entries({
  'a feature with a transform': (l) => (l[1].transform = l[0].transform),
  'a feature without id': (l) => delete l[1].id,
  'an id that names nothing': (l) => (l[1].id = 'gone'),
  'two features of one id': (l) => l.push(structuredClone(l[1])),
  'objects in the first line': (l) => (l[0].CityObjects = { other: { type: 'Building' } }),
  'vertices in the first line': (l) => {
    l[0].vertices = [[0, 0, 0]];
    l[0].metadata.geographicalExtent = [...l[0].transform.translate, ...l[0].transform.translate];
  },
  'no first line': (l) => l.shift(),
  'another building in a feature': (l) => (l[1].CityObjects.other = { type: 'Building' }),
  'a part that is left out': (l) => delete l[1].CityObjects[part],
})) {
  const copy = structuredClone(lines);
  change(copy);
  assert.notEqual(faultOfSequence(copy), undefined, `not complained of: ${what}`);
}
for (const change of [
  (e) => (e.extraAttributes.Building.plain = {}),
  (e) => (e.extraAttributes.House = {}),
  (e) => (e.version = '1.0.0'),
  (e) => (e.versionCityJSON = '1.1'),
  (e) => delete e.extraSemanticSurfaces,
]) {
  const copy = structuredClone(extension);
  change(copy);
  assert(!extensionRules(copy), `not complained of in the extension: ${change}`);
}
const doubled = [...doubledNames('{"a":{"b":1,"c":"b"},"b":[{"d":"\\"d"},{"d":2}],"\\u0061":3}')];
assert.deepEqual(doubled, ['"\\u0061" is there twice']);
assert.throws(() => utf8.decode(Buffer.from([0x22, 0xff, 0x22])));
process.exit(wrong === 0 ? 0 : 1);
