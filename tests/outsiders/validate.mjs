// node validate.mjs DIR: Khronos's glTF validator reads every GLB of DIR and below. Fails on an error or a warning, and
// where it does not complain of a file that was broken on purpose. What it only informs of is counted.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import validator from 'gltf-validator';

const fewest = 20;
const folder = process.argv[2];
const files = readdirSync(folder, { recursive: true }).map(String).filter((name) => name.endsWith('.glb')).sort();
if (files.length < fewest) throw new Error(`only ${files.length} GLB in ${folder}`);

const validate = (bytes) => validator.validateBytes(bytes, { maxIssues: 100, ignoredIssues: [] });
const infos = new Map();
let wrong = 0;
for (const name of files) {
  const { issues } = await validate(new Uint8Array(readFileSync(join(folder, name))));
  for (const message of issues.messages) {
    if (message.severity > 1) infos.set(message.code, (infos.get(message.code) ?? 0) + 1);
    else console.error(`${name}: ${message.code} ${message.pointer ?? ''} ${message.message}`);
  }
  wrong += issues.numErrors + issues.numWarnings;
}
console.log(`${files.length} GLB, ${wrong} errors and warnings; told of:`, Object.fromEntries(infos));

// No rubber stamp: bounds that are not those of the positions, and an index beyond the vertices.
const street = readFileSync(join(folder, 'street.glb'));
const length = street.readUInt32LE(12);
const json = JSON.parse(street.toString('utf8', 20, 20 + length));
const broken = (change) => {
  const copy = Buffer.from(street), changed = structuredClone(json);
  change(changed);
  copy.write(JSON.stringify(changed).padEnd(length), 20);
  return new Uint8Array(copy);
};
for (const [what, change] of [
  ['bounds', (j) => { j.accessors[0].max[0] = 0; }],
  ['an unknown view', (j) => { j.accessors[0].bufferView = 99; }],
]) {
  const { issues } = await validate(broken(change));
  if (issues.numErrors === 0) {
    console.error(`the validator does not see ${what}`);
    wrong += 1;
  }
}
process.exit(wrong === 0 ? 0 : 1);
