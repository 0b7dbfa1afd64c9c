// The index of the site's search: an entry per section of a page, and one per row of the program's tables.
import vm from "node:vm";

const entities = { amp: "&", lt: "<", gt: ">", quot: '"', "#39": "'" };
const text_of = (html) =>
  html.replace(/<a class="here"[\s\S]*?<\/a>/g, "").replace(/<[^>]+>/g, " ")
    .replace(/&(amp|lt|gt|quot|#39);/g, (_, name) => entities[name]).replace(/\s+/g, " ").trim();

/// The HTML of a page without the program's tables, which have pages of their own.
export const without_tables = (html) => html.replace(/<table class="made">[\s\S]*?<\/table>/g, "");

/// The entries of a page: its HTML cut at headings and at rows that have an id.
export function entries_of(page, to, html) {
  const entries = [{ page, heading: page, to, text: "" }];
  const starts = /<h([1-6])[^>]* id="([^"]+)"[^>]*>([\s\S]*?)<\/h\1>|<tr id="([^"]+)">([\s\S]*?)<\/tr>/g;
  let at = 0;
  for (const match of html.matchAll(starts)) {
    entries.at(-1).text += ` ${text_of(html.slice(at, match.index))}`;
    at = match.index + match[0].length;
    const [, depth, id, heading, row, cells] = match;
    if (row) {
      const [first, ...rest] = cells.split("</td>").map(text_of);
      entries.push({ page, heading: first, to: `${to}#${row}`, text: rest.join(" ") });
    } else if (depth !== "1") entries.push({ page, heading: text_of(heading), to: `${to}#${id}`, text: "" });
  }
  entries.at(-1).text += ` ${text_of(html.slice(at))}`;
  for (const entry of entries) entry.text = entry.text.trim();
  return entries.filter((entry) => entry.text !== "" || entry.heading !== page);
}

/// The search of the site, as the browser runs it.
export function search_of(source) {
  const context = vm.createContext({});
  vm.runInContext(source, context);
  return context.mansard_search.search;
}
