// The table of buildings: columns, order, and the visible rows.
import type { Building } from "../api/types";
import { type Searched, type Term, hasValue, termOf } from "./attribute_text";
import { reasonsOf } from "./reasons";

export type Column = "id" | "block" | "outcome" | "confidence" | "rmse" | "volume" | "edited";
export interface Order {
  column: Column;
  down: boolean;
}
export interface Row {
  id: string;
  block: string;
  outcome: string;
  parts: number;
  reasons: string[]; // why the model is simpler than asked for
  rmse: number | null; // m, over the footprint
  volume: number; // m³
  confidence: number | null; // probability that the model is right
  edited: boolean;
}

export const rowOf = (b: Building): Row => ({
  id: b.id,
  block: b.block,
  outcome: b.outcome,
  reasons: reasonsOf(b),
  parts: b.parts.length,
  rmse: b.mse === null ? null : Math.sqrt(b.mse),
  volume: b.parts.reduce((sum, p) => sum + p.volume, 0),
  confidence: b.edited ? null : b.confidence,
  edited: b.edited,
});

const natural = new Intl.Collator("en", { numeric: true });

/** A text whose order by its characters is the natural one: a number begins with how many digits it has. */
const keyOf = (id: string) => id.toLowerCase().replace(/\d+/g, (digits) => digits.length.toString(36).padStart(2, "0") + digits);
const plain = (id: string) => /^[\x20-\x7e]*$/.test(id);

/** Missing values come last in either order. */
export function sorted(rows: readonly Row[], { column, down }: Order): Row[] {
  // A collator takes a second for 100,000 ids; keys are right where ids are ASCII.
  const quick = rows.every((r) => plain(r.id));
  const keyed = rows.map((row) => ({ row, key: quick ? keyOf(row.id) : row.id }));
  const byId = (a: (typeof keyed)[0], b: (typeof keyed)[0]) =>
    quick ? (a.key < b.key ? -1 : a.key > b.key ? 1 : 0) : natural.compare(a.key, b.key);
  const way = down ? -1 : 1;
  const compare = (a: (typeof keyed)[0], b: (typeof keyed)[0]): number => {
    if (column === "id") return way * byId(a, b);
    const [x, y] = [a.row[column], b.row[column]];
    if (x === null || y === null) return x === y ? 0 : x === null ? 1 : -1;
    return way * (typeof x === "string" ? (x === y ? 0 : natural.compare(x, y as string)) : Number(x) - Number(y));
  };
  return keyed.sort((a, b) => compare(a, b) || byId(a, b)).map((k) => k.row);
}

/** Rows whose id, block, outcome or attributes contain every word of the filter; edited buildings also match "edited".
 *  A word such as measuredHeight>12 compares an attribute. */
export function filtered(
  rows: readonly Row[],
  filter: string,
  attributes: ReadonlyMap<string, Searched> = new Map(),
): readonly Row[] {
  const words = filter.split(/\s+/).filter(Boolean).map(termOf);
  if (!words.length) return rows;
  const text = (r: Row) =>
    `${r.id} ${r.block} ${r.outcome}${r.edited ? " edited" : ""} ${attributes.get(r.id)?.text ?? ""}`.toLowerCase();
  const matches = (r: Row) =>
    words.every((w) => ("text" in w ? text(r).includes(w.text) : (ofColumn(r, w) ?? hasValue(attributes.get(r.id), w))));
  return idsFirst(rows.filter(matches), filter);
}

/** What the table itself has of a building, by the names of its columns and by those that people try. */
const columnsByName: Record<string, (r: Row) => number | null> = {
  rmse: (r) => r.rmse,
  sure: (r) => (r.confidence === null ? null : 100 * r.confidence),
  volume: (r) => r.volume,
  "m³": (r) => r.volume,
  parts: (r) => r.parts,
};
/** Whether a column holds the comparison; undefined if it is about none. */
function ofColumn(row: Row, term: Exclude<Term, { text: string }>): boolean | undefined {
  const column = Object.hasOwn(columnsByName, term.name) ? columnsByName[term.name] : undefined;
  if (!column) return undefined;
  const [value, wanted] = [column(row), Number(term.value)];
  if (value === null || Number.isNaN(wanted)) return false;
  return term.is === "<" ? value < wanted : term.is === ">" ? value > wanted : value === wanted;
}

/** The filter in two: comparisons of columns, and what the server searches of a large run. */
export function columnsOf(filter: string): { columns: string; rest: string } {
  const [columns, rest]: [string[], string[]] = [[], []];
  for (const word of filter.split(/\s+/).filter(Boolean)) {
    const term = termOf(word);
    ("name" in term && Object.hasOwn(columnsByName, term.name) ? columns : rest).push(word);
  }
  return { columns: columns.join(" "), rest: rest.join(" ") };
}

/** Those whose ids have every word before those that match otherwise: an id is also the name of a block, whose other buildings
 *  would hide it. */
export function idsFirst(rows: readonly Row[], filter: string): readonly Row[] {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  const own = (r: Row) => words.every((w) => r.id.toLowerCase().includes(w));
  const first = rows.filter(own);
  return first.length === 0 || first.length === rows.length ? rows : [...first, ...rows.filter((r) => !own(r))];
}

/** A sentence on names in comparisons that are neither attributes nor columns; null if there are none. */
export function unknownNames(filter: string, attributes: readonly string[]): string | null {
  const names = attributes.map((a) => a.toLowerCase());
  const unknown = filter
    .split(/\s+/)
    .filter(Boolean)
    .map(termOf)
    .flatMap((t) => ("text" in t || Object.hasOwn(columnsByName, t.name) || names.some((n) => n.endsWith(t.name)) ? [] : [t.name]));
  if (!unknown.length) return null;
  const known = Object.keys(columnsByName).slice(0, 3).join(", ");
  return `No building has an attribute named ${unknown.map((n) => `“${n}”`).join(" or ")}; the panel Attributes lists them. ${known} and parts compare columns.`;
}

/** The rows to render for a window of `height` pixels that is scrolled down by `top`, with `spare` rows on each side. */
export function visibleRows(rows: number, rowHeight: number, top: number, height: number, spare = 8) {
  const from = Math.max(0, Math.floor(top / rowHeight) - spare);
  const to = Math.min(rows, Math.ceil((top + height) / rowHeight) + spare);
  return { from: Math.min(from, rows), to };
}
