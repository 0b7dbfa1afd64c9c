// What lies on a web server or in a bucket gives the same models as what lies on disk.
//   node servers.mjs MANSARD DATA SCRATCH
// The server is a small one of our own on this machine: whole files and ranges, as web servers and S3 give them.
import { spawn } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import zlib from "node:zlib";

const [program, data, scratch] = process.argv.slice(2).map((word) => path.resolve(word));
fs.rmSync(scratch, { recursive: true, force: true });
fs.mkdirSync(path.join(scratch, "bucket"), { recursive: true });
fs.cpSync(path.join(data, "hall"), path.join(scratch, "bucket/hall"), { recursive: true });

const asked = [];
const server = http.createServer((request, response) => {
  const [name, query] = request.url.split("?");
  asked.push(name);
  const file = path.join(scratch, path.normalize(decodeURIComponent(name)));
  if (query !== undefined || !fs.statSync(file, { throwIfNoEntry: false })?.isFile()) {
    response.writeHead(404).end();
    return;
  }
  const bytes = fs.readFileSync(file);
  const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? "");
  const start = range ? Number(range[1]) : 0;
  const end = Math.min(range?.[2] ? Number(range[2]) + 1 : bytes.length, bytes.length);
  if (start >= end) {
    response.writeHead(416, { "Content-Range": `bytes */${bytes.length}` }).end();
    return;
  }
  const headers = { "Content-Length": end - start, "Accept-Ranges": "bytes" };
  if (range) headers["Content-Range"] = `bytes ${start}-${end - 1}/${bytes.length}`;
  response.writeHead(range ? 206 : 200, headers);
  response.end(request.method === "HEAD" ? undefined : bytes.subarray(start, end));
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const port = server.address().port;
const bucket = {
  AWS_S3_ENDPOINT: `127.0.0.1:${port}`, AWS_HTTPS: "NO", AWS_VIRTUAL_HOSTING: "FALSE", AWS_NO_SIGN_REQUEST: "YES",
};

function run(...words) {
  return new Promise((done) => {
    const child = spawn(program, words, { env: { ...process.env, ...bucket } });
    let said = "";
    child.stdout.resume();
    child.stderr.on("data", (text) => (said += text));
    child.on("close", (code) => done({ code, said }));
  });
}

function expect(holds, what) {
  if (!holds) throw new Error(what);
}

async function models(name, mesh, footprints, from, most = 0) {
  const out = path.join(scratch, name);
  asked.length = 0;
  const { code, said } = await run("reconstruct", mesh, footprints, "-o", out, "--formats", "obj,plans,tiles", "-q");
  expect(code <= most, `${name}: exit code ${code}: ${said}`);
  for (const file of from) expect(asked.includes(file), `${name}: ${file} was not asked for, only ${asked}`);
  // Comments say where the inputs lie.
  const obj = fs.readFileSync(path.join(out, "model.obj"), "utf8").split("\n").filter((line) => !line.startsWith("#"));
  return { obj: obj.join("\n"), plans: JSON.parse(fs.readFileSync(path.join(out, "plans.json"), "utf8")).buildings };
}

function same(a, b, what) {
  expect(a.obj.includes("\nf ") && a.obj === b.obj, `${what}: other models than from disk`);
  expect(JSON.stringify(a.plans) === JSON.stringify(b.plans), `${what}: other plans than from disk`);
}

try {
  const web = `/vsicurl/http://127.0.0.1:${port}/bucket`;
  const disk = await models("disk", path.join(data, "hall/mesh.off"), path.join(data, "hall/footprints.geojson"), []);
  const hall = ["/bucket/hall/mesh.off", "/bucket/hall/footprints.geojson"];
  same(await models("web", `${web}/hall/mesh.off`, `${web}/hall/footprints.geojson`, hall), disk, "a web server");
  same(await models("s3", "/vsis3/bucket/hall/mesh.off", "/vsis3/bucket/hall/footprints.geojson", hall), disk, "a bucket");

  // Packed ones are unpacked by their ending, wherever they lie.
  const packed = (name, to) => fs.writeFileSync(path.join(scratch, "bucket", to), zlib.gzipSync(fs.readFileSync(path.join(data, name))));
  packed("hall/mesh.off", "mesh.off.gz");
  packed("hall/footprints.geojson", "footprints.geojson.gz");
  const gz = ["/bucket/mesh.off.gz", "/bucket/footprints.geojson.gz"];
  same(await models("gz", `${web}/mesh.off.gz`, `${web}/footprints.geojson.gz`, gz), disk, "packed on a web server");

  // A tileset with what it leads to, by its own relative addresses.
  fs.cpSync(path.join(scratch, "disk/model.3dtiles"), path.join(scratch, "bucket/tiles"), { recursive: true });
  const tiles = path.join(scratch, "bucket/tiles/tileset.json"), footprints = path.join(data, "hall/footprints.geojson");
  // They are of models alone and show nothing over some of a footprint, so that a building may fall back (1).
  const local = await models("tiles_on_disk", tiles, footprints, [], 1);
  same(await models("tiles", `${web}/tiles/tileset.json`, footprints, ["/bucket/tiles/tileset.json"], 1), local, "a tileset");

  const missing = await run("reconstruct", `${web}/hall/none.off`, footprints, "-o", path.join(scratch, "none"), "-q");
  expect(missing.code === 3 && missing.said.includes("none.off"), `a file that is not there: ${missing.code}: ${missing.said}`);
  expect(!fs.existsSync(path.join(scratch, "none")), "a failed run left a folder");
  console.log("the same models from disk, web server and bucket");
} finally {
  server.close();
  server.closeAllConnections();
}
