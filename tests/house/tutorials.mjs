// Runs the commands of a tutorial as a reader would, and holds what the page shows against what they say.
//   node tutorials.mjs REPOSITORY MANSARD PAGE SCRATCH
// In a ```console block a line after `$ ` is a command; the lines below it must be said in that order, among others.
// Numbers may differ by a fifth, or by 3 in the last place: they belong to results that get better. `…` is any text.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";

const [root, program, page, scratch] = process.argv.slice(2).map((word) => path.resolve(word));
fs.rmSync(scratch, { recursive: true, force: true });
fs.mkdirSync(scratch, { recursive: true });
fs.symlinkSync(path.join(root, "data"), path.join(scratch, "data"));

const number = /\d+(?:\.\d+)?/g;
const escape = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/// Whether a line that was said is the line that is shown.
function says(said, shown) {
  const words = escape(shown).replace(/…/g, ".*").replace(/\d+(?:\\\.\d+)?/g, "(\\d+(?:\\.\\d+)?)")
    .replace(/ +/g, " +");
  const match = new RegExp(`^${words}$`).exec(said.trimEnd());
  if (!match) return false;
  return (shown.match(number) ?? []).every((text, i) => {
    const decimals = text.split(".")[1]?.length ?? 0;
    const allowed = Math.max(0.2 * Number(text), decimals > 0 ? 3 * 10 ** -decimals : Number(text) < 10 ? 0 : 3);
    return Math.abs(Number(match[i + 1]) - Number(text)) <= allowed;
  });
}

const steps = [];
for (const [, block] of fs.readFileSync(page, "utf8").matchAll(/^```console\n([\s\S]*?)^```/gm))
  for (const line of block.split("\n")) {
    if (line.startsWith("$ ")) steps.push({ command: line.slice(2), shown: [] });
    else if (line.trim() !== "") steps.at(-1).shown.push(line);
  }
if (steps.length === 0) throw new Error(`${page} has no command to run`);

let failed = false;
for (const { command, shown } of steps) {
  // Errors first: then what is said and the names of results stand in the order in which a terminal shows them.
  const answer = spawnSync("bash", ["-c", command], {
    cwd: scratch, encoding: "utf8", maxBuffer: 1 << 26,
    env: { ...process.env, PATH: `${path.dirname(program)}:${process.env.PATH}`, LC_ALL: "C" },
  });
  const said = `${answer.stderr}\n${answer.stdout}`.split("\n");
  const complain = (what) => {
    failed = true;
    console.error(`$ ${command}\n${what}; it said:\n${said.slice(-40).join("\n")}\n`);
  };
  if (answer.status !== 0) complain(`ended with ${answer.status ?? answer.signal}`);
  let at = 0;
  for (const line of shown) {
    const found = said.findIndex((text, i) => i >= at && says(text, line));
    if (found < 0) complain(`did not say '${line}'`);
    else at = found + 1;
  }
}
if (failed) process.exit(1);
fs.rmSync(scratch, { recursive: true, force: true });
console.log(`${steps.length} commands`);
