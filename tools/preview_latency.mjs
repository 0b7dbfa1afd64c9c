// How long a preview takes: node tools/preview_latency.mjs MANSARD [SAMPLE]
// Every building of the sample five times, one after the other, a little higher each time: waiting as a page does, and the
// server's processor time, which does not depend on what else the machine does.
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";

const [mansard, sample = "data/delft"] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "mansard-latency-"));
const server = spawn(mansard, ["serve", join(folder, "project"), "--port", "0", "--sample", sample], {
  stdio: ["ignore", "pipe", "inherit"],
});
process.on("exit", () => {
  server.kill("SIGKILL");
  rmSync(folder, { recursive: true, force: true });
});
const link = await new Promise((resolve) => createInterface(server.stdout).once("line", resolve));
const [base, token] = link.split("/#token=");
async function call(method, path, body) {
  const response = await fetch(base + path, {
    method,
    headers: { Authorization: `Bearer ${token}` },
    body: body && JSON.stringify(body),
  });
  const text = await response.text();
  if (!response.ok) throw new Error(text);
  return text;
}
async function settled() {
  while (JSON.parse(await call("GET", "/api/status")).busy) await new Promise((resolve) => setTimeout(resolve, 100));
}
/** ms of processor time; the kernel counts in hundredths of a second. */
function spent() {
  const fields = readFileSync(`/proc/${server.pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) * 10;
}

await call("POST", "/api/project/sample", {});
await settled();
await call("POST", "/api/runs", {});
await settled();
const { buildings } = JSON.parse(await call("GET", "/api/runs/run-1/buildings"));
const waited = [];
const bytes = [];
let before = 0;
for (let round = 0; round < 6; round++) {
  if (round === 1) before = spent(); // the first round makes the meshes ready for rays
  for (const { id: building, revision, parts } of buildings) {
    if (parts.length === 0) continue;
    const higher = parts.map(({ id, plan }) => ({ id, plan: { ...plan, cap: plan.cap + 0.01 * round } }));
    const start = performance.now();
    const text = await call("POST", "/api/runs/run-1/preview", { changes: [{ building, revision, parts: higher }] });
    if (round === 0) continue;
    waited.push(performance.now() - start);
    bytes.push(text.length);
  }
}
const share = (values, part) => [...values].sort((a, b) => a - b)[Math.floor((values.length - 1) * part)];
console.log(`${waited.length} previews of ${buildings.length} buildings`);
console.log(`processor ${((spent() - before) / waited.length).toFixed(1)} ms each`);
console.log(`waiting   median ${share(waited, 0.5).toFixed(1)}, 95 % ${share(waited, 0.95).toFixed(1)} ms`);
console.log(`answer    median ${share(bytes, 0.5)} bytes`);
process.exit(0);
