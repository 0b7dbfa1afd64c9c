// Checks every string that the program shows to a user against the list of words not to be used: options, codes,
// attributes, verbs and help as the program prints them, and messages as its sources have them.
//   node program_words.mjs REPOSITORY MANSARD SCRATCH
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { of_program, of_sources } from "./program_texts.mjs";

// Names of options are not prose.
const prose = (text) => text.replace(/--[a-z][a-z0-9-]*/g, "").replace(/\b[a-z]+\.[a-z]+_[a-z_]+\b/g, "")
  .replace(/\s+/g, " ").trim();

const [root, program, scratch] = process.argv.slice(2).map((word) => path.resolve(word));
const strings = [...of_program(program).texts, ...of_sources(root, ["apps/cli"])]
  .map(([where, text]) => [where, prose(text)]).filter(([, text]) => text !== "");
if (strings.length < 500) throw new Error(`only ${strings.length} strings were found`);
fs.mkdirSync(scratch, { recursive: true });
const file = path.join(scratch, "program_strings.txt");
// An empty line after each: the check of words reads on into the next line.
fs.writeFileSync(file, strings.map(([, text]) => `${text}\n\n`).join(""));
const words = (name) => path.join(root, "tests/house", name);
const answer = spawnSync(process.execPath, [words("words.mjs"), words("words.txt"), file], { encoding: "utf8" });
for (const line of answer.stdout.split("\n").filter((text) => text !== "")) {
  const [, number, what] = /:(\d+): (.*)$/.exec(line.slice(file.length)) ?? [, 1, line];
  const [where, text] = strings[(Number(number) - 1) / 2];
  console.log(`${where}: ${what}\n    ${text}`);
}
if (answer.status !== 0) {
  console.error(answer.stderr.trim());
  process.exit(1);
}
console.log(`${strings.length} strings`);
