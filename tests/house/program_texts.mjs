// Every text that the program shows to a user: options, codes, attributes, verbs and help as the program prints them,
// and messages as its sources have them.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";

function ask(program, ...words) {
  const answer = spawnSync(program, words, { encoding: "utf8", maxBuffer: 1 << 26 });
  if (answer.status !== 0) throw new Error(`${words.join(" ")} ended with ${answer.status}: ${answer.stderr}`);
  return answer.stdout;
}

function* texts_of(program, listed) {
  for (const option of listed.options) {
    const where = `option ${option.module}.${option.name}`;
    yield [where, option.meaning];
    yield [where, option.source];
  }
  for (const preset of [...listed.presets, ...listed.simulate_presets])
    yield [`preset ${preset.name}`, preset.meaning];
  for (const verb of listed.verbs) {
    yield [`mansard ${verb.verb}`, verb.meaning];
    yield [`mansard ${verb.verb}`, verb.task];
    for (const term of [...verb.arguments, ...verb.options])
      if (term.module === "") yield [`mansard ${verb.verb} ${term.names[0] ?? term.value}`, term.meaning];
    // The other options of --help-all and of the manual page are those of the modules, which are listed already.
    for (const paragraph of ask(program, verb.verb, "--help").split(/\n\n|\n {2}(?=\S)/))
      yield [`mansard ${verb.verb} --help`, paragraph];
  }
  for (const paragraph of ask(program, "--help").split(/\n\n/)) yield ["mansard --help", paragraph];
  for (const attribute of JSON.parse(ask(program, "options", "--attributes", "--json")).attributes)
    yield [`attribute ${attribute.name}`, attribute.meaning];
  const explained = JSON.parse(ask(program, "explain", "--json"));
  for (const code of explained.codes) {
    yield [`code ${code.code}`, code.cause];
    yield [`code ${code.code}`, code.remedy];
  }
  for (const exit of explained.exit_codes) yield [`exit code ${exit.exit_code}`, exit.when];
}

const unescaped = (text) => text.replace(/\\n/g, " ").replace(/\\(.)/g, "$1");

/// Literals of a C++ source with a blank in them: neighbours are one text, as the compiler takes them.
function* literals(source) {
  const code = source.replace(/^\s*#.*$/gm, "").replace(/R"(\w*)\([\s\S]*?\)\1"/g, '""');
  const token = /\/\/.*|\/\*[\s\S]*?\*\/|'(?:\\.|[^'\\])'|"((?:\\.|[^"\\])*)"(\s*(?="))?/g;
  let text = "", line = 0;
  for (const match of code.matchAll(token)) {
    if (match[1] === undefined) continue;
    if (text === "") line = code.slice(0, match.index).split("\n").length;
    text += match[1];
    if (match[2] !== undefined) continue;
    if (/[A-Za-z]{2,} |  *[A-Za-z]{2,}/.test(text)) yield [line, unescaped(text)];
    text = "";
  }
}

export function* of_sources(root, folders) {
  const walk = function* (folder) {
    for (const entry of fs.readdirSync(path.join(root, folder), { withFileTypes: true })) {
      const at = path.posix.join(folder, entry.name);
      if (entry.isDirectory()) yield* walk(at);
      else if (/\.[ch]pp$/.test(entry.name)) yield at;
    }
  };
  for (const folder of folders)
    for (const file of walk(folder))
      for (const [line, text] of literals(fs.readFileSync(path.join(root, file), "utf8")))
        yield [`${file}:${line}`, text];
}

/// All of them with where they are, and the names of all options of all verbs.
export function of_program(program) {
  const listed = JSON.parse(ask(program, "options", "--all", "--json"));
  const options = new Set(listed.verbs.flatMap((verb) => verb.options.flatMap((option) => option.names)));
  options.add("--version");  // of no verb
  return { options, texts: [...texts_of(program, listed)] };
}
