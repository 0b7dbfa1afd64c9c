// Holds what the server really answers against openapi.json, and openapi.json against types.ts:
//   node answers.mjs MANSARD OPENAPI MODULES TYPES SAMPLE
// MODULES: the folder whose node_modules has ajv, openapi-typescript and typescript. Every endpoint is called at least
// once; every answer, refusals and events too, has to be of the schema that openapi.json names for it.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";

const [mansard, openapi, modules, types, sample] = process.argv.slice(2).map((path) => resolve(path));
const require = createRequire(join(modules, "package.json"));
const Ajv = require("ajv").default;
const folder = mkdtempSync(join(tmpdir(), "mansard-answers-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

// ---- openapi.json says the same as types.ts

const api = JSON.parse(readFileSync(openapi, "utf8"));
copyFileSync(types, join(folder, "types.ts"));
symlinkSync(join(modules, "node_modules"), join(folder, "node_modules"));
const bin = (name) => join(modules, "node_modules", ".bin", name);
execFileSync(bin("openapi-typescript"), [openapi, "--array-length", "-o", join(folder, "schema.d.ts")]);
const shared = [...readFileSync(types, "utf8").matchAll(/^export (?:interface|type) (\w+)/gm)].map((m) => m[1]);
assert(shared.length > 30);
const lines = shared.map(
  (name) => `export const ${name}: Same<api.${name}, components["schemas"]["${name}"]> = true;`,
);
writeFileSync(
  join(folder, "agree.ts"),
  `import type * as api from "./types";
import type { components } from "./schema";
type Same<A, B> = [A] extends [B] ? ([B] extends [A] ? true : false) : false;
${lines.join("\n")}\n`,
);
writeFileSync(
  join(folder, "tsconfig.json"),
  JSON.stringify({ compilerOptions: { noEmit: true, strict: true, skipLibCheck: true, types: [] }, files: ["agree.ts"] }),
);
try {
  execFileSync(bin("tsc"), ["-p", folder]);
} catch (e) {
  console.error(`openapi.json and types.ts differ:\n${e.stdout}`);
  process.exit(1);
}

// ---- the schemas as ajv takes them: OpenAPI 3.0 has `nullable` where JSON Schema has null

function translated(schema) {
  if (Array.isArray(schema)) return schema.map(translated);
  if (schema === null || typeof schema !== "object") return schema;
  const { nullable, ...rest } = Object.fromEntries(Object.entries(schema).map(([k, v]) => [k, translated(v)]));
  if (typeof rest.$ref === "string") rest.$ref = rest.$ref.replace("#/components/schemas/", "api#/definitions/");
  return nullable ? { anyOf: [{ type: "null" }, rest] } : rest;
}
const ajv = new Ajv({ strict: false, allErrors: true });
ajv.addSchema({ $id: "api", definitions: translated(api.components.schemas) });
const compiled = new Map();
function hold(value, schema, what) {
  const key = JSON.stringify(schema);
  if (!compiled.has(key)) compiled.set(key, ajv.compile(translated(schema)));
  const valid = compiled.get(key);
  assert(valid(value), `${what}: ${JSON.stringify(valid.errors?.slice(0, 3))}`);
}

// ---- the server

const server = spawn(mansard, ["serve", join(folder, "project"), "--port", "0", "--sample", sample], {
  stdio: ["ignore", "pipe", "inherit"],
});
process.on("exit", () => server.kill("SIGKILL"));
const link = await new Promise((resolve) => createInterface(server.stdout).once("line", resolve));
const [base, token] = link.split("/#token=");
const called = new Set();

/** Calls an endpoint by its path in openapi.json and holds the answer against its schema. */
async function call(method, path, { at = {}, query = {}, body, expect = 200 } = {}) {
  called.add(`${method} ${path}`);
  const place = path.replace(/{(\w+)}/g, (_, name) => encodeURIComponent(at[name] ?? "none"));
  const url = new URL(base + place);
  for (const [name, value] of Object.entries(query)) url.searchParams.set(name, value);
  const operation = api.paths[path][method];
  const taken = operation.requestBody?.content["application/json"]?.schema;
  if (taken && expect === 200) hold(body, taken, `body of ${method} ${path}`);
  const response = await fetch(url, {
    method: method.toUpperCase(),
    headers: { Authorization: `Bearer ${token}`, "X-Client": "answers" },
    body: body === undefined ? undefined : body instanceof Uint8Array ? body : JSON.stringify(body),
  });
  const given = operation.responses["200"].content;
  if (expect !== 200) {
    const refusal = await response.json();
    assert.equal(response.status, expect, JSON.stringify(refusal));
    hold(refusal, { $ref: "#/components/schemas/Refusal" }, `refusal of ${method} ${path}`);
    return refusal;
  }
  if (response.status !== 200) assert.fail(`${method} ${path}: ${response.status} ${await response.text()}`);
  const type = response.headers.get("Content-Type");
  assert(type in given, `${method} ${path} gives ${type}`);
  if (type !== "application/json") return new Uint8Array(await response.arrayBuffer());
  const json = await response.json();
  hold(json, given[type].schema, `${method} ${path}`);
  return json;
}

// Every event is validated against the schema when it arrives. The stream is read with a reader, which cancel() ends: in
// Node 18, aborting the fetch does not end a loop over the body.
const kinds = new Set();
called.add("get /api/events");
const stream = await fetch(base + "/api/events", { headers: { Authorization: `Bearer ${token}` } });
assert.equal(stream.headers.get("Content-Type"), "text/event-stream");
const reader = stream.body.getReader();
const events = (async () => {
  let rest = "";
  const decoder = new TextDecoder();
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    rest += decoder.decode(value, { stream: true });
    const blocks = rest.split("\n\n");
    rest = blocks.pop();
    for (const block of blocks) {
      const event = JSON.parse(block.replace(/^data: /, ""));
      hold(event, { $ref: "#/components/schemas/Event" }, "event");
      kinds.add(event.type);
    }
  }
})();

async function settled() {
  while ((await call("get", "/api/status")).busy) await new Promise((resolve) => setTimeout(resolve, 50));
}

const of = { run: "run-1" };
await call("get", "/api/openapi.json");
const { formats } = await call("get", "/api/options");
await call("get", "/api/project");
await call("get", "/api/scene", { expect: 404 });
await call("post", "/api/runs", { body: {}, expect: 404 });
await call("put", "/api/uploads/{name}", { at: { name: "a.txt" }, body: new Uint8Array([1, 2, 3]) });
await call("post", "/api/project/sample", { body: {} });
await settled();
const project = await call("get", "/api/project");
await call("post", "/api/project/inputs", {
  body: {
    ...project.inputs.given,
    reading: project.reading,
  },
});
await settled();
await call("get", "/api/scene");
const { tiles } = await call("get", "/api/scene/tiles");
await call("get", "/api/scene/tiles/{id}", { at: { id: tiles[0].id } });
await call("get", "/api/scene/tiles/{id}", { at: { id: "9-9-9" }, expect: 404 });
await call("post", "/api/scene/textures", { body: {} });
await call("get", "/api/scene/tiles/{id}/texture", { at: { id: tiles[0].id }, expect: 404 });
await call("post", "/api/runs", { body: { label: "one", preset: "", options: {}, blocks: [] } });
const second = await call("post", "/api/runs", { body: {} });
await call("delete", "/api/jobs/{id}", { at: { id: second.id } });
await settled();
await call("get", "/api/jobs");
await call("get", "/api/runs/{run}/report", { at: of });
await call("get", "/api/runs/{run}/report", { at: { run: "run-2" }, expect: 409 });
const { buildings } = await call("get", "/api/runs/{run}/buildings", { at: of });
const one = await call("get", "/api/runs/{run}/buildings", { at: of, query: { building: buildings[0].id } });
assert.deepEqual(one.buildings, buildings.slice(0, 1));
await call("get", "/api/runs/{run}/buildings", { at: of, query: { building: "none" }, expect: 404 });
const list = await call("get", "/api/runs/{run}/list", { at: of });
assert.deepEqual(list.ids, buildings.map((b) => b.id));
await call("get", "/api/runs/{run}/tiles/{tile}", { at: { ...of, tile: "0_0" } });
await call("get", "/api/runs/{run}/tiles/{tile}", { at: { ...of, tile: "0" }, expect: 400 });
await call("get", "/api/runs/{run}/search", { at: of, query: { words: buildings[0].id } });
await call("get", "/api/runs/{run}/search", { at: of, expect: 400 });
await call("get", "/api/runs/{run}/column", { at: of, query: { attribute: "ms_h_ground" } });
await call("get", "/api/runs/{run}/column", { at: of, query: { attribute: "none" }, expect: 404 });
await call("get", "/api/runs/{run}/column", { at: of, expect: 400 });
await call("get", "/api/runs/{run}/layers", { at: of });
await call("get", "/api/runs/{run}/scores", { at: of });
await call("get", "/api/runs/{run}/attributes", { at: of });
await call("get", "/api/runs/{run}/attributes", { at: of, query: { building: buildings[0].id } });
for (const lod of ["1.2", "1.3", "2.0"]) await call("get", "/api/runs/{run}/levels/{lod}", { at: { ...of, lod } });
await call("get", "/api/runs/{run}/levels/{lod}", { at: { ...of, lod: "3" }, expect: 404 });
await call("get", "/api/runs/{run}/terrain", { at: of });
await call("get", "/api/runs/{run}/basemap", { at: of, expect: 409 });
await call("get", "/api/runs/{run}/textures/{building}", { at: { ...of, building: "none" }, expect: 404 });
await call("post", "/api/project/alignment", {
  body: { ...project.inputs.given, reading: project.reading },
});
const { maps } = await call("get", "/api/runs/{run}/error", { at: of });
await call("get", "/api/runs/{run}/error/{block}", { at: { ...of, block: maps[0].block } });

const building = buildings.find((b) => b.parts.length > 0);
const part = building.parts[0];
const name = { building: building.id, part: part.id };
await call("get", "/api/runs/{run}/section", { at: of, query: { ...name, ring: 0, edge: 0, share: 0.5 } });
await call("post", "/api/runs/{run}/section", { at: of, body: { plan: part.plan, ring: 0, edge: 0, share: 0.5 } });
const { roofs } = await call("post", "/api/runs/{run}/roofs", { at: of, body: { kind: "gable", parts: [{ ...name, plan: part.plan }] } });
assert.equal(roofs.length, 1);
const parts = building.parts.map(({ id, plan }) => ({ id, plan }));
const changes = [{ building: building.id, revision: building.revision, parts }];
parts[0] = { id: part.id, plan: { ...part.plan, cap: part.plan.cap + 0.5 } };
await call("post", "/api/runs/{run}/preview", { at: of, body: { changes } });
const crossed = structuredClone(changes);
crossed[0].parts[0].plan.outer.points.reverse();
const { buildings: broken } = await call("post", "/api/runs/{run}/preview", { at: of, body: { changes: crossed } });
assert.equal(broken.length, 1);
await call("post", "/api/runs/{run}/edits", { at: of, body: { what: "cap", changes } });
await call("post", "/api/runs/{run}/edits", { at: of, body: { what: "late", changes }, expect: 409 });
const unedited = await call("get", "/api/runs/{run}/unedited", { at: of });
assert.deepEqual(unedited.buildings.map((b) => [b.id, b.parts.map((p) => p.plan)]), [[building.id, building.parts.map((p) => p.plan)]]);
await call("post", "/api/runs/{run}/undo", { at: of, body: {} });
await call("post", "/api/runs/{run}/redo", { at: of, body: {} });
await call("post", "/api/runs/{run}/redo", { at: of, body: {}, expect: 409 });
const xs = part.plan.outer.points.map((p) => p[0]);
const ys = part.plan.outer.points.map((p) => p[1]);
const y = (Math.min(...ys) + Math.max(...ys)) / 2;
const split = await call("post", "/api/runs/{run}/split", {
  at: of,
  body: { ...name, line: [[Math.min(...xs) - 1, y], [Math.max(...xs) + 1, y]] },
});
await call("post", "/api/runs/{run}/edits", { at: of, body: { what: "split", changes: split.changes } });
const two = split.changes[0].parts.slice(0, 2).map(({ id }) => ({ building: building.id, part: id }));
await call("post", "/api/runs/{run}/merge", { at: of, body: { parts: two } });
const { buildings: now } = await call("get", "/api/runs/{run}/buildings", { at: of, query: { building: building.id } });
await call("get", "/api/runs/{run}/review/case", { at: of, query: { building: building.id } });
await call("get", "/api/runs/{run}/review/case", { at: of, expect: 400 });
const verdict = { building: building.id, revision: now[0].revision };
await call("post", "/api/runs/{run}/review", { at: of, body: { ...verdict, decision: "wrong", note: "a tree" } });
await call("post", "/api/runs/{run}/review", { at: of, body: { ...verdict, decision: "maybe" }, expect: 400 });
const { decisions } = await call("get", "/api/runs/{run}/review", { at: of });
assert.deepEqual(decisions.map((d) => [d.building, d.decision, d.lapsed]), [[building.id, "wrong", false]]);
const filed = await call("get", "/api/review");
await call("post", "/api/runs/{run}/review", { at: of, body: { ...verdict, decision: null } });
await call("post", "/api/review/merge", { body: filed });
filed.decisions[0] = { ...filed.decisions[0], decision: "right", time: "2199-01-01T00:00:00Z" };
const { conflicts } = await call("post", "/api/review/merge", { body: filed });
assert.equal(conflicts.length, 1);
await call("post", "/api/review/merge", { body: {}, expect: 400 });
await call("post", "/api/runs/{run}/export", { at: of, body: { overwrite: false } });
await call("post", "/api/runs/{run}/export", { at: of, body: { overwrite: true, formats: ["plans", "glb"] } });
for (const file of formats.flatMap((f) => f.files))
  await call("get", "/api/runs/{run}/export/{file}", { at: { ...of, file } });
await call("post", "/api/runs/import", { body: { path: join(folder, "project/exports/run-1/plans.json"), label: "again" } });
await settled();
await call("get", "/api/runs/{run}/buildings", { at: { run: "run-3" } });
await call("get", "/api/runs/{run}/layers", { at: { run: "run-3" } });
await call("get", "/api/runs/{run}/error", { at: { run: "run-3" } });
await call("post", "/api/runs/import", { body: { path: openapi }, expect: 400 });
await call("post", "/api/runs/{run}/export", { at: of, body: { overwrite: true, formats: ["cityjson"] } });
await call("post", "/api/models", { body: { path: join(folder, "project/exports/run-1/model.city.json") } });
await call("post", "/api/models", { body: { path: openapi }, expect: 400 });
await call("patch", "/api/runs/{run}", { at: of, body: { label: "renamed" } });
await call("post", "/api/runs/{run}/edits/carry-over", { at: { run: "run-3" }, body: { from: "run-1" } });
await call("delete", "/api/runs/{run}", { at: { run: "run-2" } });
await call("post", "/api/runs/{run}/undo", { at: { run: "run-2" }, body: {}, expect: 404 });

await reader.cancel();
await events;
const all = Object.entries(api.paths).flatMap(([path, methods]) => Object.keys(methods).map((m) => `${m} ${path}`));
assert.deepEqual([...called].sort(), all.sort(), "every endpoint has been called");
for (const kind of ["job", "project", "buildings", "review"]) assert(kinds.has(kind), `no event of type ${kind}`);
const ended = new Promise((resolve) => server.once("exit", resolve));
server.kill("SIGINT");
assert.equal(await ended, 0);
console.log(`${all.length} endpoints, ${shared.length} types: as openapi.json says`);
process.exit(0);
