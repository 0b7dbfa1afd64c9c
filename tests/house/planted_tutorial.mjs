// Plants one deviation at a time in a tutorial, and expects that the check of tutorials names it.
//   node planted_tutorial.mjs SCRATCH
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";

const scratch = path.resolve(process.argv[2]);
const checker = path.join(path.dirname(new URL(import.meta.url).pathname), "tutorials.mjs");
fs.rmSync(scratch, { recursive: true, force: true });
fs.mkdirSync(path.join(scratch, "tree/data"), { recursive: true });

function check(command, shown) {
  const page = path.join(scratch, "page.md");
  fs.writeFileSync(page, `# Page\n\n\`\`\`console\n$ ${command}\n${shown.map((line) => `${line}\n`).join("")}\`\`\`\n`);
  const answer = spawnSync(process.execPath,
    [checker, path.join(scratch, "tree"), "/bin/true", page, path.join(scratch, "run")], { encoding: "utf8" });
  return { ok: answer.status === 0, said: answer.stderr };
}
let failed = false;
function expect(what, { ok, said }, wanted) {
  if (wanted === undefined ? ok : !ok && said.includes(wanted)) return;
  failed = true;
  console.error(`${what}: ${ok ? "passed" : said}`);
}

const command = "echo 'mansard: slice block-0 (0 %)' >&2; printf 'a 1.00\\nb 2.5 s\\n\\nc  3\\n'";
const right = ["a 1.00", "b 2.5 s", "", "c  3"];
expect("the output itself", check(command, right));
expect("a placeholder for a number", check(command, ["a 1.00", "b <number> s", "", "c  3"]));
expect("a placeholder for any text", check(command, ["a …", "b 2.5 s", "", "c  3"]));
expect("a missing line", check(command, ["a 1.00", "", "c  3"]), "line 2");
expect("a missing last line", check(command, ["a 1.00", "b 2.5 s"]), "does not show ''");
expect("an extra line", check(command, [...right, "d"]), "line 5");
expect("a number in the last place", check(command, ["a 1.01", "b 2.5 s", "", "c  3"]), "line 1");
expect("fewer blanks", check(command, ["a 1.00", "b 2.5 s", "", "c 3"]), "line 4");
expect("a placeholder for several lines", check(command, ["…", "c  3"]), "line 2");
expect("a text for a number", check("echo 'took long s'", ["took <number> s"]), "line 1");
expect("a command that fails", check("echo a; exit 3", ["a"]), "ended with 3");
if (failed) process.exit(1);
fs.rmSync(scratch, { recursive: true, force: true });
