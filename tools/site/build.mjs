// The docs site: every Markdown page of the repository as HTML, with tables that the program prints of itself.
//   node build.mjs ROOT MANSARD OUT
// Exits with 1 and prints a line per error when a page disagrees with the tree or with the program.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { Marked } from "marked";
import { Checks, slug } from "./checks.mjs";
import { entries_of, search_of, without_tables } from "./index.mjs";
import { Tables, escape } from "./tables.mjs";

const [root, program, out] = process.argv.slice(2).map((word) => path.resolve(word));
if (!out) {
  console.error("usage: node build.mjs ROOT MANSARD OUT");
  process.exit(2);
}

const read = (name) => fs.readFileSync(path.join(root, name), "utf8");
const ask = (...words) => {
  const answer = spawnSync(program, words, { encoding: "utf8", maxBuffer: 1 << 26 });
  if (answer.status !== 0) throw new Error(`${words.join(" ")} ended with ${answer.status}: ${answer.stderr}`);
  return JSON.parse(answer.stdout);
};
const known = { ...ask("options", "--all", "--json"), ...ask("options", "--attributes", "--json"), ...ask("explain", "--json") };
const version = spawnSync(program, ["--version"], { encoding: "utf8" }).stdout.trim();

// ---- the pages, in the order of the menu
const there = (name) => fs.existsSync(path.join(root, name));
const list = "cmake/modules.cmake";
const modules = [...read(list).replace(/#.*/g, "").matchAll(/mansard_module\(([a-z_]+)/g)].map((match) => match[1]);
const tables = new Tables(modules, known);
const in_folder = (folder, ...first) => {
  const all = fs.readdirSync(path.join(root, folder)).filter((name) => name.endsWith(".md")).sort();
  const rest = all.filter((name) => !first.includes(name));
  return [...first.filter((name) => all.includes(name)), ...rest].map((name) => `${folder}/${name}`);
};
const module_pages = modules.map((module) => `docs/${module}.md`).filter(there);
// What users look for first, then modules and decisions. A page is called as here, otherwise by its title.
const titles = {
  "docs/tutorials/your_data.md": "Ten minutes", "README.md": "Overview", "docs/packaging.md": "Install", "data/README.md": "Sample data",
  "docs/ingest.md": "Input formats", "docs/formats.md": "Output formats",
  "docs/cli.md": "Command line", "docs/city.md": "Resume, share, watch", "docs/workbench.md": "The workbench", "docs/serve.md": "Server and projects",
  "docs/results.md": "Results", "docs/robustness.md": "Robustness", "docs/bench.md": "Benchmarks",
};
/// What the site begins with: for somebody who has data and ten minutes.
const front = "docs/tutorials/your_data.md";
const docs = (...names) => names.map((name) => `docs/${name}.md`).filter(there);
const top = [
  ["Start", [front, "README.md", ...docs("packaging"), "data/README.md", ...docs("glossary")]],
  ["Tutorials", in_folder("docs/tutorials", "one_house.md", "one_block.md", "one_city.md", "lidar_tile.md", "textured_city.md", "whole_city.md").filter((name) => name !== front)],
  ["Formats", docs("ingest", "formats")],
  ["Options", ["options.html", "attributes.html", "codes.html"]],
  ["Command line", [...docs("cli"), "verbs.html"]],
  ["A whole city", docs("city")],
  ["Python, QGIS, Blender", docs("python", "qgis", "blender")],
  ["Workbench", docs("workbench", "serve")],
  ["Results", [...docs("results"), ...in_folder("docs/results", "scans.md", "shapes.md", "features.md", "validators.md", "time.md"),
    ...docs("comparison", "robustness", "worst", "cost", "hostile", "bench")]],
];
const placed = new Set([...top.flatMap(([, names]) => names), ...module_pages]);
const other_pages = in_folder("docs").filter((name) => !placed.has(name));
const nav = [
  ...top,
  ["Development", ["ARCHITECTURE.md", "CONTRIBUTING.md", ...other_pages, "CHANGELOG.md"]],
  ["Modules", module_pages],
  ["Decisions", in_folder("docs/decisions", "README.md")],
];
const pages = [...new Set(nav.flatMap(([, names]) => names))].filter((name) => name.endsWith(".md"));
const address = (name) =>
  name === front ? "index.html" : name === "README.md" ? "overview.html" : name.replace(/(^|\/)README\.md$/, "$1index.html").replace(/\.md$/, ".html");

// ---- pages
const checks = new Checks(root, modules, known);
for (const module of modules) if (!there(`docs/${module}.md`)) checks.complain(`docs/${module}.md`, "every module has a page");
const anchors = new Map();  // address → the ids on that page
const links = [];           // from, address, anchor, as written
const copied = new Set();

/// Where a link of a page leads, as the site has it; what is no page is copied as it is.
function resolve(from, href) {
  if (/^(https?:|mailto:)/.test(href)) return href;
  const [target, anchor] = href.split("#");
  let file = target === "" ? from : path.posix.normalize(path.posix.join(path.posix.dirname(from), target));
  if (there(file) && fs.statSync(path.join(root, file)).isDirectory()) file = path.posix.join(file, "README.md");
  if (!there(file) || file.startsWith("..")) {
    checks.complain(from, `the link ${href} leads nowhere`);
    return href;
  }
  const to = pages.includes(file) ? address(file) : file;
  if (!pages.includes(file)) copied.add(file);
  if (anchor !== undefined) links.push({ from, to, anchor, href });
  return relative(address(from), to) + (anchor === undefined ? "" : `#${anchor}`);
}
const relative = (from, to) => path.posix.relative(path.posix.dirname(from), to) || path.posix.basename(to);

function render(name) {
  const source = read(name);
  const marked = new Marked({ gfm: true });
  const ids = new Map();
  const page_ids = new Set();
  const take = (text) => {
    const base = slug(text);
    const count = ids.get(base) ?? 0;
    ids.set(base, count + 1);
    const id = count === 0 ? base : `${base}-${count}`;
    page_ids.add(id);
    return id;
  };
  const module = modules.find((candidate) => name === `docs/${candidate}.md`);
  const made = module ? tables.of_module(module) : {};
  const tokens = marked.lexer(source);
  checks.page(name, module, tokens);

  // The program's tables stand at the end of the section of their name; a page without it gets one.
  const sections = [];
  for (const token of tokens) {
    const starts = token.type === "heading" && token.depth <= 2;
    if (starts || sections.length === 0) sections.push({ heading: starts ? token.text : "", tokens: [] });
    sections.at(-1).tokens.push(token);
  }
  marked.use({
    renderer: {
      heading({ tokens: inline, depth, text }) {
        const id = take(text);
        const here = `<a class="here" href="#${id}" aria-label="link to this section">#</a>`;
        return `<h${depth} id="${id}">${this.parser.parseInline(inline)} ${here}</h${depth}>\n`;
      },
      link({ href, tokens: inline }) {
        return `<a href="${escape(resolve(name, href))}">${this.parser.parseInline(inline)}</a>`;
      },
      image({ href, text }) {
        return `<img src="${escape(resolve(name, href))}" alt="${escape(text)}" loading="lazy">`;
      },
      html({ text }) {
        for (const match of text.matchAll(/<a (?:name|id)="([^"]+)"/g)) page_ids.add(match[1]);
        return text;
      },
    },
  });
  const parse = (list) => {
    list.links = tokens.links;
    return marked.parser(list);
  };
  let html = "";
  for (const section of sections) {
    html += parse(section.tokens);
    if (made[section.heading]) html += made[section.heading];
    delete made[section.heading];
  }
  for (const [heading, text] of Object.entries(made))
    if (text) html += `<h2 id="${take(heading)}">${heading}</h2>\n${text}`;
  anchors.set(address(name), page_ids);
  return html;
}

const title_of = (name) => (/^#\s+(.+)$/m.exec(read(name))?.[1] ?? name).replace(/`/g, "");
const short_title = (name, section) => {
  const module = modules.find((candidate) => name === `docs/${candidate}.md`);
  if (module && section === "Modules") return module;
  return titles[name] ?? title_of(name);
};
const made_pages = tables.pages();

function frame(to, title, body) {
  const menu = nav.map(([heading, names]) => {
    const items = names.map((name) => {
      const target = name.endsWith(".md") ? address(name) : name;
      const text = name.endsWith(".md") ? short_title(name, heading) : made_pages[name][0];
      const current = target === to ? ' aria-current="page"' : "";
      return `<li><a href="${relative(to, target)}"${current}>${escape(text)}</a></li>`;
    });
    return items.length === 0 ? "" : (heading ? `<h2>${heading}</h2>` : "") + `<ul>${items.join("")}</ul>`;
  });
  return `<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escape(title)}</title><link rel="stylesheet" href="${relative(to, "style.css")}"></head>
<body><nav aria-label="pages">${menu.join("\n")}</nav>
<main>${body}</main>
<footer>${escape(version)}, Apache License 2.0</footer>
<script src="${relative(to, "search.js")}"></script></body></html>
`;
}

const files = new Map();
const entries = [];
for (const name of pages) {
  const html = render(name);
  files.set(address(name), frame(address(name), title_of(name), html));
  if (name !== "CHANGELOG.md") entries.push(...entries_of(title_of(name), address(name), without_tables(html)));
}
for (const [to, [title, body]] of Object.entries(made_pages)) {
  files.set(to, frame(to, title, `<h1>${title}</h1>${body}`));
  entries.push(...entries_of(title, to, body));
  anchors.set(to, new Set([...body.matchAll(/ id="([^"]+)"/g)].map((match) => match[1])));
}
for (const { from, to, anchor, href } of links)
  if (anchors.has(to) && !anchors.get(to).has(anchor))
    checks.complain(from, `the link ${href} leads to no section of that name`);
checks.tree(pages);
checks.made([...files.values()].join("\n"));
const search = read("tools/site/search.js");
checks.search((query) => search_of(search)(entries, query, 5).map((entry) => entry.to));

if (checks.complaints.length > 0) {
  for (const complaint of checks.complaints) console.error(complaint);
  console.error(`${checks.complaints.length} errors; the site was not written`);
  process.exit(1);
}
if (fs.existsSync(out) && fs.readdirSync(out).length > 0 && !fs.existsSync(path.join(out, "codes.html"))) {
  console.error(`${out} is not empty and contains no site; choose another folder`);
  process.exit(2);
}
fs.rmSync(out, { recursive: true, force: true });
const put = (to, bytes) => {
  fs.mkdirSync(path.dirname(path.join(out, to)), { recursive: true });
  fs.writeFileSync(path.join(out, to), bytes);
};
for (const [to, html] of files) put(to, html);
for (const file of copied) put(file, fs.readFileSync(path.join(root, file)));
put("style.css", read("tools/site/style.css"));
put("search.js", search);
put("search-data.js", `globalThis.mansard_pages = ${JSON.stringify(entries.map(({ page, heading, to, text }) =>
  ({ page, heading, to, text })))};\n`);
const { options, codes, attributes } = known;
console.log(`${files.size} pages, ${entries.length} entries of the search, ${options.length} options, ${codes.length} codes, ${attributes.length} attributes: ` +
  path.join(out, "index.html"));
