// Checks of the pages: options, codes and attributes must exist in the program, and a module's page must have its parts.
import fs from "node:fs";
import path from "node:path";

/// The anchor that GitHub gives a heading.
export const slug = (text) =>
  text.replace(/<[^>]+>/g, "").replace(/[`*]/g, "").replace(/\[([^\]]*)\]\([^)]*\)/g, "$1").trim().toLowerCase()
    .replace(/[^\p{L}\p{N}\p{M} _-]/gu, "").replace(/ /g, "-");

/// The words in `code` of a piece of Markdown.
export const cells = (text) => [...text.matchAll(/`([^`]+)`/g)].map((match) => match[1]);

/// The parts of a module's page, by the heading, or the beginning of a paragraph, that identifies each.
const parts = {
  guarantees: /^(guarantees)/i,
  cost: /^(cost|costs|measured|time)\b/i,
  references: /^(references?|sources?)\b/i,
};

export class Checks {
  constructor(root, modules, known) {
    this.root = root;
    this.modules = modules;
    this.known = known;
    this.complaints = [];
    this.options = new Map(known.options.map((option) => [`${option.module}.${option.name}`, option]));
    this.codes = new Set(known.codes.map((entry) => entry.code));
    this.code_prefixes = new Set(known.codes.map((entry) => entry.code.split("-")[0]));
    this.attributes = new Set(known.attributes.map((attribute) => attribute.name));
    const names_of = (verb) => new Set(verb.options.flatMap((option) => option.names));
    this.verbs = new Map(known.verbs.map((verb) => [verb.verb, names_of(verb)]));
    this.words = new Set(["--version", "--help", "--module-name"]);  // the last is a pattern for any module's option
    const read = (name) => fs.readFileSync(path.join(root, name), "utf8");
    // Pages speak of the options of these, too.
    for (const name of [...this.find("bench", /./), ...this.find("tools", /\.(py|sh|mjs)$/)])
      for (const [word] of read(name).matchAll(/--[a-z][a-z0-9-]+/g)) this.words.add(word);
    this.tests = new Set();
    for (const name of this.find("tests", /^CMakeLists\.txt$/))
      for (const [, test] of read(name).matchAll(/NAME ([a-z]+\.[a-z_]+)/g)) this.tests.add(test);
    for (const name of this.find("tests", /\.cpp$/))
      for (const [, suite, test] of read(name).matchAll(/^TEST(?:_[FP])?\((\w+),\s*(\w+)\)/gm))
        this.tests.add(`${suite}.${test}`);
    this.suites = new Set([...this.tests].map((test) => test.split(".")[0]));
    for (const names of this.verbs.values()) for (const name of names) this.words.add(name);
    // Words that an option takes may look like a code of its module.
    this.values = new Set([...known.options.flatMap((option) => option.choices),
      ...known.presets.map((preset) => preset.name), ...known.simulate_presets.map((preset) => preset.name)]);
  }

  /// Files below a folder by the end of their path.
  find(folder, wanted) {
    return fs.readdirSync(path.join(this.root, folder), { withFileTypes: true }).flatMap((entry) => {
      const at = path.posix.join(folder, entry.name);
      if (entry.isDirectory()) return entry.name === "node_modules" ? [] : this.find(at, wanted);
      return wanted.test(entry.name) ? [at] : [];
    });
  }

  complain(page, what) { this.complaints.push(`${page}: ${what}`); }

  page(name, module, tokens) {
    const history = name === "CHANGELOG.md";  // speaks of what was, too
    const walk = (list, section) => {
      for (const token of list ?? []) {
        if (token.type === "heading") section = token.text;
        if (token.type === "codespan" && !history) this.word(name, token.text);
        if (token.type === "code" && !history) this.commands(name, token.text);
        if (token.type === "table") this.table(name, module, token);
        if (token.type === "image") this.has_picture = true;
        for (const inner of [token.tokens, token.items]) if (inner) walk(inner, section);
        if (token.type === "table")
          for (const cell of [...token.header, ...token.rows.flat()]) walk(cell.tokens, section);
      }
    };
    this.has_picture = false;
    walk(tokens, "");
    if (module) this.module_page(name, tokens);
  }

  /// One word in code.
  word(name, text) {
    const decoded = text.replace(/&quot;/g, '"').replace(/&amp;/g, "&");
    if (decoded.startsWith("mansard ")) return this.command(name, decoded);
    const option = /^(--[a-z0-9][a-z0-9.-]*)(?=$|[ =,])/.exec(decoded)?.[1];
    // Decisions and old measurements name options that there were then.
    const then = /^docs\/(decisions\/|sensitivity\.md$)/.test(name);
    if (option && !then && !this.words.has(option)) this.complain(name, `the option ${option} does not exist in the program`);
    const [, module, member] = /^([a-z]+)\.([a-z0-9_]+)(?:$| =)/.exec(decoded) ?? [];
    if (module && !then && !this.tests.has(`${module}.${member}`) && !/^(md|[ch]pp|json|mjs|gpkg|svg|png|html)$/.test(member) &&
        this.known.options.some((entry) => entry.module === module) && !this.options.has(`${module}.${member}`))
      this.complain(name, `the option ${module}.${member} does not exist in the program`);
    // A test by its name, or by the beginning of it and "…".
    const [, suite, test] = /^([A-Z]\w+)\.(\w+)…?$/.exec(decoded) ?? [];
    const begins = decoded.endsWith("…");
    const full = `${suite}.${test}`;
    if (suite && this.suites.has(suite) && !this.tests.has(full) &&
        !(begins && [...this.tests].some((known) => known.startsWith(full))))
      this.complain(name, `there is no test ${decoded}`);
    const attribute = /^\+?ms_[a-z0-9_]+$/.exec(decoded)?.[0];
    if (attribute && !this.attributes.has(attribute))
      this.complain(name, `the attribute ${attribute} does not exist in the program`);
    if (/^[a-z]+(-[a-z0-9]+)+$/.test(decoded) && this.modules.includes(decoded.split("-")[0]) &&
        this.code_prefixes.has(decoded.split("-")[0]) && !this.codes.has(decoded) && !this.values.has(decoded))
      this.complain(name, `the code ${decoded} does not exist in the program`);
  }

  /// A line as it is typed: the verb is there, and every option is that verb's.
  command(name, line) {
    const words = line.trim().split(/\s+/);
    const verb = words[1];
    if (!/^[a-z]+$/.test(verb ?? "")) return;
    const names = this.verbs.get(verb);
    if (!names) return this.complain(name, `mansard ${verb}: there is no such verb`);
    for (const word of words.slice(2)) {
      if (/^[#|>&]/.test(word)) break;
      const option = /^\[?(--?[a-z][a-z0-9.-]*)/.exec(word)?.[1];
      if (option && !names.has(option)) this.complain(name, `mansard ${verb} has no option ${option}`);
    }
  }

  commands(name, text) {
    for (const line of text.replace(/\\\n/g, " ").split("\n"))
      if (/^(\$ )?mansard /.test(line)) this.command(name, line.replace(/^\$ /, ""));
  }

  /// A table of options written by hand names options there are, with the defaults they have.
  table(name, module, token) {
    const header = token.header.map((cell) => cell.text.toLowerCase());
    if (module && header[0] === "option") {
      for (const row of token.rows) {
        const names = cells(row[0].text);
        const defaults = header[1] !== "default" ? []
          : row[1].text.split(",").map((text) => text.trim().replace(/`/g, ""));
        names.forEach((option, i) => {
          const entry = this.options.get(`${module}.${option}`);
          if (!entry) return this.complain(name, `the table of options names ${option}, which the module does not have`);
          const given = defaults.length === names.length ? defaults[i] : undefined;
          const number = /^[0-9.]+/.exec(given ?? "")?.[0];
          if (number !== undefined && Number(number) !== Number(entry.default))
            this.complain(name, `${option} is ${given} there and ${entry.default} in the program`);
        });
      }
    }
    if (header[0] === "exit code" && header[1] === "when") {
      const named = token.rows.map((row) => row[0].text).join(" ");
      const all = this.known.exit_codes.map((exit) => String(exit.exit_code)).join(" ");
      if (named !== all) this.complain(name, `the exit codes are ${all}, not ${named}`);
    }
  }

  module_page(name, tokens) {
    const starts = [];
    for (const token of tokens) {
      if (token.type === "heading") starts.push(token.text);
      if (token.type === "paragraph") starts.push(token.text.replace(/^\*+/, ""));
      if (token.type === "list") for (const item of token.items) starts.push(item.text.replace(/^\*+/, ""));
    }
    if (!this.has_picture) this.complain(name, "a module's page needs a picture");
    for (const [part, pattern] of Object.entries(parts)) {
      const said = starts.some((start) => pattern.test(start)) ||
        (part === "cost" && starts.some((text) => / Cost: /.test(text)));
      if (!said) this.complain(name, `a module's page needs its ${part}`);
    }
  }

  /// Every Markdown page of the tree is a page of the site; every attribute in the sources is in the program's list.
  tree(pages) {
    for (const name of this.find("docs", /\.md$/))
      if (!pages.includes(name)) this.complain(name, "is no page of the site");
    const used = new Set();
    // Names of CityGML have no prefix of ours.
    const standard = [...this.attributes].filter((name) => !/^\+?ms_/.test(name));
    for (const file of ["mansard", "lab", "apps/server"].flatMap((folder) => this.find(folder, /\.[ch]pp$/)))
      for (const match of fs.readFileSync(path.join(this.root, file), "utf8").matchAll(/"(\+?[A-Za-z0-9_]+)"/g)) {
        if (!/^\+?ms_[a-z0-9_]+$/.test(match[1]) && !standard.includes(match[1])) continue;
        if (!file.endsWith("attribute_list.cpp")) used.add(match[1]);
        if (!this.attributes.has(match[1])) this.complain(file, `the attribute ${match[1]} is not in the list`);
      }
    for (const attribute of this.attributes)
      if (!used.has(attribute)) this.complain("mansard options --attributes", `${attribute} is written nowhere`);
  }

  /// The search finds these pages among its first results: words of a title, of a text, an option, a code.
  search(first_of) {
    const wanted = {
      "Debian package": "docs/packaging.html", "straight skeleton": "docs/extrude.html", "mesh offset": "docs/ingest.html",
      gamma: "options.html#option-sweep-gamma", "output-exists": "codes.html#code-output-exists",
    };
    for (const [query, page] of Object.entries(wanted))
      if (!first_of(query).some((to) => to === page || to.startsWith(`${page}#`)))
        this.complain("search", `'${query}' does not find ${page}`);
  }

  /// Every option, code and attribute of the program is on a page.
  made(html) {
    for (const [key, option] of this.options)
      if (!html.includes(`id="option-${option.module}-${option.name}"`)) this.complain("options", `${key} is on no page`);
    for (const code of this.codes)
      if (!html.includes(`id="code-${code}"`)) this.complain("codes", `${code} is on no page`);
    for (const attribute of this.attributes)
      if (!html.includes(`id="attribute-${attribute}"`)) this.complain("attributes", `${attribute} is on no page`);
  }
}
