// Checks that the remedy of every message that names an option or a command of the program is tried by a test.
//   node remedies.mjs REPOSITORY MANSARD [list]     list: prints those that are not
// A remedy is tried where a case of tests/cli has words of the message and a command line with what the message says, or
// where any test says "tried: " and words of the message. Those that no test of this machine can try are in
// untried_remedies.txt with the reason; one that is tried must not be there.
import fs from "node:fs";
import path from "node:path";
import { of_program, of_sources } from "./program_texts.mjs";

const [root, program, list] = process.argv.slice(2);
const text_of = (literals) => [...literals.matchAll(/"((?:\\.|[^"\\])*)"/g)].map((m) => m[1]).join("").replace(/\\(.)/g, "$1");

/// Words of messages, of the cases { command, code, words, instead } and of what other tests of remedies expect.
function words_tried() {
  const literal = String.raw`((?:"(?:\\.|[^"\\])*"\s*)+)`;
  const all = [];
  const files = fs.readdirSync(path.join(root, "tests"), { recursive: true }).filter((file) => file.endsWith(".cpp"));
  for (const file of files) {
    const source = fs.readFileSync(path.join(root, "tests", file), "utf8");
    for (const found of source.matchAll(new RegExp(String.raw`\{${literal},\s*${literal},\s*${literal},\s*(?:said|${literal})\}`, "g")))
      all.push(text_of(found[3]));
    for (const found of source.matchAll(new RegExp(String.raw`// tried: (.*)`, "g"))) all.push(found[1]);
  }
  return all.filter((words) => words.length >= 8);
}

// What cannot be tried here, by the beginning of where it is and words of it.
const untried = fs.readFileSync(new URL("untried_remedies.txt", import.meta.url), "utf8").split("\n")
  .filter((line) => line !== "" && !line.startsWith("#")).map((line) => line.split(" | "));

const { texts } = of_program(path.resolve(program));
const shown = texts.map(([, text]) => text).join("\n").replace(/\s+/g, " ");
const tried = words_tried();
const used = new Set();
let messages = 0, wrong = 0, with_test = 0;
for (const [where, text] of of_sources(root, ["apps/cli", "apps/server", "mansard", "lab"])) {
  if (!/(?<![\w-])--[a-z]|'?mansard (?:options|explain|info|reconstruct|extrude|convert|evaluate|compare|segment|serve|new|doctor|status|report)\b/.test(text)) continue;
  const flat = text.replace(/\s+/g, " ").trim();
  if (shown.includes(flat) || /^apps\/cli\/(catalogue|completion|help|manual|grammar|cluster)\.cpp/.test(where)) continue;
  messages += 1;
  const known = tried.some((words) => flat.includes(words) || words.includes(flat));
  const entry = untried.findIndex(([file, words]) => where.startsWith(file) && flat.includes(words));
  if (entry >= 0) used.add(entry);
  if (known) with_test += 1;
  if (known && entry >= 0) console.log(`${where}: is tried; take it out of untried_remedies.txt`), wrong += 1;
  if (known || entry >= 0) continue;
  wrong += 1;
  console.log(`${where}: no test tries what this says to do${list ? "" : "; add a case to tests/cli/remedies_test.cpp"}\n    ${flat}`);
}
untried.forEach(([file, words], i) => {
  if (used.has(i)) return;
  wrong += 1;
  console.log(`untried_remedies.txt: no message of ${file} has '${words}'`);
});
if (messages < 100) throw new Error(`only ${messages} messages were found`);
console.log(`${with_test} of ${messages} messages with a remedy are tried, ${used.size} cannot be here`);
if (wrong > 0) process.exit(1);
