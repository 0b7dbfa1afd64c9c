// Reports words that texts should not have.
//   node words.mjs LIST FILE…
// LIST has lines `REGULAR EXPRESSION => REPLACEMENT`. Of Markdown (.md), code blocks, code in lines, HTML tags and
// addresses of links are left out; any other file is read as plain text. Exits with 1 when a word was found.
import fs from "node:fs";

const [list, ...files] = process.argv.slice(2);
if (!list || files.length === 0) {
  console.error("usage: node words.mjs LIST FILE…");
  process.exit(2);
}

const rules = fs.readFileSync(list, "utf8").split("\n").map((line, i) => ({ line: line.trim(), number: i + 1 }))
  .filter(({ line }) => line !== "" && !line.startsWith("#"))
  .map(({ line, number }) => {
    const [words, say] = line.split(/ => /);
    if (!say) throw new Error(`${list}:${number}: no ' => REPLACEMENT'`);
    return { words: new RegExp(words, "giu"), say };
  });
if (rules.length === 0) throw new Error(`${list} has no words`);

const blank = (text) => text.replace(/[^\n]/g, " ");
const prose_of = (text) => text
  .replace(/^(```|~~~)[\s\S]*?^\1/gm, blank)
  .replace(/^( {4}|\t).*$/gm, (line, _, at) => (/\n\s*\n$/.test(text.slice(0, at)) ? blank(line) : line))
  .replace(/(`+)[\s\S]*?\1/g, blank)
  .replace(/\]\([^)]*\)/g, blank)
  .replace(/<[^>\n]+>/g, blank);

let found = 0;
for (const file of files) {
  const text = fs.readFileSync(file, "utf8");
  const lines = (file.endsWith(".md") ? prose_of(text) : text).split("\n");
  lines.forEach((line, i) => {
    // A sentence goes on in the next line: a rule of several words sees its first words too.
    const next = (/^(#|\s*$)/.test(line) ? "" : lines[i + 1] ?? "").trimStart().split(/\s+/).slice(0, 3).join(" ");
    const seen = `${line.trimEnd()} ${next}`;
    for (const { words, say } of rules)
      for (const match of seen.matchAll(words)) {
        if (match.index >= line.trimEnd().length) continue;
        console.log(`${file}:${i + 1}: '${match[0]}': say ${say}`);
        ++found;
      }
  });
}
if (found > 0) {
  console.error(`${found} words of ${list}`);
  process.exit(1);
}
