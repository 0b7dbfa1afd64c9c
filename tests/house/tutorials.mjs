// Runs the commands of a tutorial as a reader would, and compares what the page shows with what they print.
//   node tutorials.mjs REPOSITORY MANSARD PAGE SCRATCH [--write]     --write puts what they print into the page
// In a ```console block a line after `$ ` is a command; the lines below it are its whole output, line by line and to
// the last digit. `…` stands for any text within a line, `<number>` for any number: for times and what else depends on
// the machine. Progress is left out on both sides: a terminal erases it.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";

const [root, program, page, scratch] = process.argv.slice(2, 6).map((word) => path.resolve(word));
const write = process.argv[6] === "--write";
fs.rmSync(scratch, { recursive: true, force: true });
fs.mkdirSync(scratch, { recursive: true });
fs.symlinkSync(path.join(root, "data"), path.join(scratch, "data"));

/// Whether a printed line is the line that is shown.
function matches(printed, shown) {
  const pattern = shown.trimEnd().split(/(…|<number>)/).map((part) =>
    part === "…" ? ".+" : part === "<number>" ? "\\d+(?:\\.\\d+)?" : part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"));
  return new RegExp(`^${pattern.join("")}$`, "u").test(printed);
}

const is_progress = (line) => /^mansard: [a-z]+ .*\(\d+ %\)$/.test(line);

function without_trailing_blanks(lines) {
  const end = lines.findLastIndex((line) => line !== "");
  return lines.slice(0, end + 1);
}

const steps = [];
for (const [, block] of fs.readFileSync(page, "utf8").matchAll(/^```console\n([\s\S]*?)^```/gm))
  for (const line of block.split("\n")) {
    if (line.startsWith("$ ")) steps.push({ command: line.slice(2), shown: [] });
    else steps.at(-1).shown.push(line);
  }
if (steps.length === 0) throw new Error(`${page} has no command to run`);

/// What is printed, as the page would show it: a line with the same words has any number where the line before had.
function as_shown(printed, shown) {
  const words = (line) => line.split(/(\s+)/), plain = (line) => line.replace(/<number>|…|\d+(?:\.\d+)?/g, "#");
  return printed.map((line, i) => {
    const before = shown.find((one) => matches(line, one)) ?? shown[i] ?? "";
    if (matches(line, before)) return before;
    if (plain(line) !== plain(before)) return line;
    return words(line).map((word, k) => (/<number>|…/.test(words(before)[k]) ? words(before)[k] : word)).join("");
  });
}

let failed = false;
for (const { command, shown } of steps) {
  // Errors first: then messages and the names of outputs are in the order in which a terminal shows them.
  const answer = spawnSync("bash", ["-c", command], {
    cwd: scratch, encoding: "utf8", maxBuffer: 1 << 26,
    env: { ...process.env, PATH: `${path.dirname(program)}:${process.env.PATH}`, LC_ALL: "C" },
  });
  const lines = `${answer.stderr}${answer.stdout}`.split("\n").map((line) => line.trimEnd());
  const printed = without_trailing_blanks(lines.filter((line) => !is_progress(line)));
  const wanted = without_trailing_blanks(shown);
  if (write && answer.status === 0) {
    const old = [`$ ${command}`, ...shown].join("\n"), end = shown.slice(wanted.length);
    const text = fs.readFileSync(page, "utf8");
    const block = [`$ ${command}`, ...as_shown(printed, wanted), ...end].join("\n");
    fs.writeFileSync(page, text.replace(old, () => block));
    continue;
  }
  const complain = (what) => {
    failed = true;
    console.error(`$ ${command}\n${what}; it printed:\n${printed.join("\n")}\n`);
  };
  if (answer.status !== 0) complain(`ended with ${answer.status ?? answer.signal}`);
  const differs = wanted.findIndex((line, i) => printed[i] === undefined || !matches(printed[i], line));
  if (differs >= 0) complain(`line ${differs + 1} of its output is not '${wanted[differs]}'`);
  else if (printed.length > wanted.length) complain(`the page does not show '${printed[wanted.length]}'`);
}
if (failed) process.exit(1);
fs.rmSync(scratch, { recursive: true, force: true });
console.log(`${steps.length} commands`);
