// The table of buildings: columns, order, and the visible rows.
import type { Building } from "../api/types";
import { type Searched, hasValue, termOf } from "./attribute_text";
import { reasonsOf } from "./reasons";

export type Column = "id" | "block" | "outcome" | "parts" | "rmse" | "volume" | "edited";
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
  edited: b.edited,
});

const natural = new Intl.Collator("en", { numeric: true });

/** Rows whose id, block, outcome or attributes contain every word of the filter; edited buildings also match "edited".
 *  A word such as measuredHeight>12 compares an attribute. Missing values come last in either order. */
export function arranged(
  rows: readonly Row[],
  filter: string,
  { column, down }: Order,
  attributes: ReadonlyMap<string, Searched> = new Map(),
): Row[] {
  const words = filter.split(/\s+/).filter(Boolean).map(termOf);
  const text = (r: Row) =>
    `${r.id} ${r.block} ${r.outcome}${r.edited ? " edited" : ""} ${attributes.get(r.id)?.text ?? ""}`.toLowerCase();
  const matches = (r: Row) =>
    words.every((w) => ("text" in w ? text(r).includes(w.text) : hasValue(attributes.get(r.id), w)));
  const way = down ? -1 : 1;
  const compare = (a: Row, b: Row): number => {
    const [x, y] = [a[column], b[column]];
    if (x === null || y === null) return x === y ? 0 : x === null ? 1 : -1;
    return way * (typeof x === "string" ? natural.compare(x, y as string) : Number(x) - Number(y));
  };
  return rows
    .filter(matches)
    .sort((a, b) => compare(a, b) || natural.compare(a.id, b.id));
}

/** The rows to render for a window of `height` pixels that is scrolled down by `top`, with `spare` rows on each side. */
export function visibleRows(rows: number, rowHeight: number, top: number, height: number, spare = 8) {
  const from = Math.max(0, Math.floor(top / rowHeight) - spare);
  const to = Math.min(rows, Math.ceil((top + height) / rowHeight) + spare);
  return { from: Math.min(from, rows), to };
}
