// The docs site: every Markdown page of the repository as HTML, with the tables that the program makes of itself.
//   node build.mjs ROOT MANSARD OUT
// Ends with 1 and a line per complaint when a page and the tree, or a page and the program, do not agree.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { Marked } from "marked";
import { Checks, slug } from "./checks.mjs";
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
const known = { ...ask("options", "--json"), ...ask("options", "--attributes", "--json"), ...ask("explain", "--json") };
const version = spawnSync(program, ["--version"], { encoding: "utf8" }).stdout.trim();

// ---- which pages there are, in the order of the house
const doors = read("cmake/rooms.cmake").replace(/#.*/g, "");
const rooms = [...doors.matchAll(/mansard_room\(([a-z_]+)/g)].map((match) => match[1]);
const tables = new Tables(rooms, known);
const in_folder = (folder, ...first) => {
  const all = fs.readdirSync(path.join(root, folder)).filter((name) => name.endsWith(".md")).sort();
  const rest = all.filter((name) => !first.includes(name));
  return [...first.filter((name) => all.includes(name)), ...rest].map((name) => `${folder}/${name}`);
};
const there = (name) => fs.existsSync(path.join(root, name));
const room_pages = rooms.map((room) => `docs/${room}.md`).filter(there);
const user_pages = ["cli", "workbench", "serve", "results", "robustness", "packaging"]
  .map((name) => `docs/${name}.md`).filter(there);
const other_pages = in_folder("docs").filter((name) => !user_pages.includes(name) && !room_pages.includes(name));
const nav = [
  ["", ["README.md"]],
  ["Tutorials", in_folder("docs/tutorials", "one_house.md", "one_block.md", "one_city.md")],
  ["Use", user_pages],
  ["Rooms", room_pages],
  ["Lists", ["verbs.html", "options.html", "attributes.html", "codes.html"]],
  ["The house", ["ARCHITECTURE.md", ...other_pages, "CONTRIBUTING.md", "CHANGELOG.md", "data/README.md"]],
  ["Decisions", in_folder("docs/decisions", "README.md")],
];
const pages = nav.flatMap(([, names]) => names).filter((name) => name.endsWith(".md"));
const address = (name) =>
  name === "README.md" ? "index.html" : name.replace(/(^|\/)README\.md$/, "$1index.html").replace(/\.md$/, ".html");

// ---- pages
const checks = new Checks(root, rooms, known);
for (const room of rooms) if (!there(`docs/${room}.md`)) checks.complain(`docs/${room}.md`, "every room has a page");
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
  const room = rooms.find((candidate) => name === `docs/${candidate}.md`);
  const made = room ? tables.of_room(room) : {};
  const tokens = marked.lexer(source);
  checks.page(name, room, tokens);

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
const short_title = (name) => {
  const room = rooms.find((candidate) => name === `docs/${candidate}.md`);
  if (room) return room;
  if (name === "README.md") return "mansard";
  return title_of(name).replace(/^Tutorial: /, "");
};
const made_pages = tables.pages();

function frame(to, title, body) {
  const menu = nav.map(([heading, names]) => {
    const items = names.map((name) => {
      const target = name.endsWith(".md") ? address(name) : name;
      const text = name.endsWith(".md") ? short_title(name) : made_pages[name][0];
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
<footer>${escape(version)}, Apache License 2.0</footer></body></html>
`;
}

const files = new Map();
for (const name of pages) files.set(address(name), frame(address(name), title_of(name), render(name)));
for (const [to, [title, body]] of Object.entries(made_pages)) {
  files.set(to, frame(to, title, `<h1>${title}</h1>${body}`));
  anchors.set(to, new Set([...body.matchAll(/ id="([^"]+)"/g)].map((match) => match[1])));
}
for (const { from, to, anchor, href } of links)
  if (anchors.has(to) && !anchors.get(to).has(anchor))
    checks.complain(from, `the link ${href} leads to no section of that name`);
checks.tree(pages);
checks.made([...files.values()].join("\n"));

if (checks.complaints.length > 0) {
  for (const complaint of checks.complaints) console.error(complaint);
  console.error(`${checks.complaints.length} complaints; the site was not written`);
  process.exit(1);
}
if (fs.existsSync(out) && fs.readdirSync(out).length > 0 && !fs.existsSync(path.join(out, "codes.html"))) {
  console.error(`${out} is not empty and holds no site; choose another folder`);
  process.exit(2);
}
fs.rmSync(out, { recursive: true, force: true });
const put = (to, bytes) => {
  fs.mkdirSync(path.dirname(path.join(out, to)), { recursive: true });
  fs.writeFileSync(path.join(out, to), bytes);
};
for (const [to, html] of files) put(to, html);
for (const file of copied) put(file, fs.readFileSync(path.join(root, file)));
put("style.css", fs.readFileSync(path.join(root, "tools/site/style.css")));
const { options, codes, attributes } = known;
console.log(`${files.size} pages, ${options.length} options, ${codes.length} codes, ${attributes.length} attributes: ` +
  path.join(out, "index.html"));
