// Attributes as text, and the search in them.
import type { AttributeMeaning, AttributeTable, AttributeValue } from "../api/types";

/** Numbers with at most four decimals, without trailing zeros. */
export function attributeText(value: AttributeValue): string {
  if (value === null) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value === "number") return String(Number(value.toFixed(4))).replace("-", "−");
  return value;
}

/** Whether name or meaning contain every word. */
export function matching(a: Pick<AttributeMeaning, "name" | "meaning">, search: string): boolean {
  const text = `${a.name} ${a.meaning}`.toLowerCase();
  return search.toLowerCase().split(/\s+/).filter(Boolean).every((w) => text.includes(w));
}

/** A word of a search: text that any value contains, or a comparison such as ms_h_ridge>12. */
export type Term = { text: string } | { name: string; is: "<" | ">" | "="; value: string };
export function termOf(word: string): Term {
  const found = /^([^<>=]+)([<>=])(.+)$/.exec(word);
  return found ? { name: found[1]!.toLowerCase(), is: found[2] as "<" | ">" | "=", value: found[3]!.toLowerCase() } : { text: word.toLowerCase() };
}

/** What is searched of each building: its values by name, and all of them as one text. */
export interface Searched {
  values: Map<string, AttributeValue[]>; // by name in lower case; of the building and its parts
  text: string;
}
export function searchedOf(table: AttributeTable | undefined): Map<string, Searched> {
  const out = new Map<string, Searched>();
  for (const building of table?.buildings ?? []) {
    const values = new Map<string, AttributeValue[]>();
    for (const own of [building.values, ...building.parts.map((p) => p.values)])
      for (const [name, value] of Object.entries(own)) values.set(name.toLowerCase(), [...(values.get(name.toLowerCase()) ?? []), value]);
    const text = [...values.values()].flat().filter((v) => typeof v === "string").join(" ").toLowerCase();
    out.set(building.id, { values, text });
  }
  return out;
}

/** Whether a building has such a value. A name may be given by its end: "height>10" finds measuredHeight. */
export function hasValue(of: Searched | undefined, term: Exclude<Term, { text: string }>): boolean {
  if (!of) return false;
  const lists = of.values.get(term.name) ? [of.values.get(term.name)!] : [...of.values].filter(([name]) => name.endsWith(term.name)).map(([, v]) => v);
  const wanted = Number(term.value);
  return lists.flat().some((value) => {
    if (value === null) return false;
    if (term.is === "=") return attributeText(value).toLowerCase() === term.value || (typeof value === "number" && value === wanted);
    return typeof value === "number" && !Number.isNaN(wanted) && (term.is === "<" ? value < wanted : value > wanted);
  });
}
