// Checks that every option that a message, a remedy, a meaning or a help text of the program names is one that it has.
//   node named_options.mjs REPOSITORY MANSARD
import path from "node:path";
import { of_program, of_sources } from "./program_texts.mjs";

const [root, program] = process.argv.slice(2).map((word) => path.resolve(word));
const { options, texts } = of_program(program);
if (options.size < 300) throw new Error(`only ${options.size} options were found`);
// Of Slurm, GNU parallel and kubectl, in the scripts that `mansard cluster` writes.
const others = new Set(["--job-name", "--cpus-per-task", "--mem", "--requeue", "--array", "--parsable", "--dependency",
  "--sshlogin", "--halt", "--retries", "--for", "--timeout"]);
let named = 0, wrong = 0;
for (const [where, text] of [...texts, ...of_sources(root, ["apps/cli", "apps/server", "mansard", "lab"])])
  for (const [, name, open] of text.matchAll(/(?<![\w-])(--[a-z][a-z0-9-]*[a-z0-9])(-?…|-\*|-<)?/g)) {
    named += 1;
    const known = open ? [...options].some((option) => option.startsWith(name)) : options.has(name) || others.has(name);
    if (known) continue;
    wrong += 1;
    console.log(`${where}: no verb has the option ${name}\n    ${text}`);
  }
if (named < 300) throw new Error(`only ${named} options are named`);
if (wrong > 0) process.exit(1);
console.log(`${named} options are named`);
