// Buildings coloured by an attribute: the scale, the colours, and the legend.
import { computed, signal } from "@preact/signals";
import type { AttributeColumn, AttributeTable, AttributeValue, Building } from "../api/types";
import type { Large } from "../large";

export type Colour = [number, number, number]; // 0 … 1

/** What can be shown beyond the attributes: it is known without them. */
export const own = { error: "RMSE", outcome: "Outcome", edited: "Edited" } as const;

/** The attribute by which buildings are coloured; null: by the class of their faces. */
export const styledBy = signal<string | null>(null);

/** Cividis (Nuñez, Anderton, Renslow 2018), which looks nearly the same with any colour vision: nine of its colours. */
const cividis: Colour[] = [
  [0.0, 0.135, 0.305],
  [0.079, 0.232, 0.429],
  [0.256, 0.317, 0.423],
  [0.374, 0.402, 0.441],
  [0.486, 0.487, 0.471],
  [0.605, 0.576, 0.469],
  [0.733, 0.669, 0.443],
  [0.865, 0.768, 0.384],
  [0.995, 0.908, 0.145],
];
/** Okabe and Ito 2008, for categories; black is left out, since outlines are dark. */
const okabeIto: Colour[] = [
  [0.902, 0.624, 0.0],
  [0.337, 0.706, 0.914],
  [0.0, 0.62, 0.451],
  [0.941, 0.894, 0.259],
  [0.0, 0.447, 0.698],
  [0.835, 0.369, 0.0],
  [0.8, 0.475, 0.655],
];
export const missing: Colour = [0.72, 0.72, 0.74];

export function ramp(t: number): Colour {
  const at = Math.min(1, Math.max(0, t)) * (cividis.length - 1);
  const i = Math.min(cividis.length - 2, Math.floor(at));
  return cividis[i]!.map((c, k) => c + (cividis[i + 1]![k]! - c) * (at - i)) as Colour;
}
export const css = (c: Colour) => `rgb(${c.map((x) => Math.round(255 * x)).join(" ")})`;

export interface Scale {
  name: string;
  unit: string;
  meaning: string;
  /** Numbers from low to high; those beyond have the colour of the end. */
  range: { low: number; high: number } | null;
  categories: { value: string; colour: Colour; count: number }[];
  missing: number; // buildings without a value
  colours: Map<string, Colour>; // by building
}

/** The colours of buildings. Numbers are spread from the 2nd to the 98th percentile, so that outliers do not hide the rest.
 *  Text and numbers with few different values are categories; the rarest share one colour. */
export function scaleOf(
  values: ReadonlyMap<string, AttributeValue | undefined>,
  what: { name: string; unit: string; meaning: string },
): Scale {
  const scale: Scale = { ...what, range: null, categories: [], missing: 0, colours: new Map() };
  const numbers = [...values.values()].filter((v): v is number => typeof v === "number").sort((a, b) => a - b);
  const present = [...values.values()].filter((v) => v !== null && v !== undefined && v !== "");
  scale.missing = values.size - present.length;
  if (numbers.length && numbers.length === present.length) {
    const at = (share: number) => numbers[Math.round(share * (numbers.length - 1))]!;
    const [low, high] = [at(0.02), at(0.98)];
    scale.range = { low, high };
    for (const [id, v] of values)
      scale.colours.set(id, typeof v === "number" ? ramp(high > low ? (v - low) / (high - low) : 0.5) : missing);
    return scale;
  }
  const count = new Map<string, number>();
  for (const v of present) count.set(textOf(v!), (count.get(textOf(v!)) ?? 0) + 1);
  const named = [...count].sort((a, b) => b[1] - a[1] || (a[0] < b[0] ? -1 : 1));
  const apart = named.length <= okabeIto.length ? named.length : okabeIto.length - 1;
  const colourOf = new Map<string, Colour>();
  named.forEach(([value], i) => colourOf.set(value, okabeIto[Math.min(i, okabeIto.length - 1)]!));
  scale.categories = named.slice(0, apart).map(([value, n], i) => ({ value, colour: okabeIto[i]!, count: n }));
  const rest = named.slice(apart);
  if (rest.length)
    scale.categories.push({
      value: `${rest.length} other values`,
      colour: okabeIto[okabeIto.length - 1]!,
      count: rest.reduce((sum, [, n]) => sum + n, 0),
    });
  for (const [id, v] of values) scale.colours.set(id, (v !== null && v !== undefined && colourOf.get(textOf(v))) || missing);
  return scale;
}

export const textOf = (v: AttributeValue) => (typeof v === "boolean" ? (v ? "yes" : "no") : String(v));

/** The value of each building; for attributes of parts only, that of its first part. */
export function valuesOf(
  name: string,
  buildings: ReadonlyMap<string, Building>,
  table: AttributeTable | undefined,
): Map<string, AttributeValue | undefined> {
  const out = new Map<string, AttributeValue | undefined>();
  if (name === "own error") for (const [id, b] of buildings) out.set(id, b.mse === null ? null : Math.sqrt(b.mse));
  else if (name === "own outcome") for (const [id, b] of buildings) out.set(id, b.outcome);
  else if (name === "own edited") for (const [id, b] of buildings) out.set(id, b.edited);
  else {
    for (const id of buildings.keys()) out.set(id, undefined);
    for (const { id, values, parts } of table?.buildings ?? [])
      if (out.has(id)) out.set(id, name in values ? values[name] : parts.find((p) => name in p.values)?.values[name]);
  }
  return out;
}

/** The same of a large run: of all its buildings, near and far. Null until the server has answered. */
export function valuesOfLarge(
  name: string,
  { rows }: Pick<Large, "rows">,
  column: AttributeColumn | undefined,
): Map<string, AttributeValue | undefined> | null {
  if (name === "own error") return new Map(rows.map((row) => [row.id, row.rmse]));
  if (name === "own outcome") return new Map(rows.map((row) => [row.id, row.outcome]));
  if (name === "own edited") return new Map(rows.map((row) => [row.id, row.edited]));
  return column ? new Map(rows.map((row, i) => [row.id, column.values[i]])) : null;
}

export const whatIs = (name: string, table: AttributeTable | undefined) => {
  if (name === "own error") return { name: "RMSE", unit: "m", meaning: "Root mean square vertical error over the footprint, as the models are now." };
  if (name === "own outcome") return { name: "Outcome", unit: "", meaning: "Result of the run: full, or a simpler model." };
  if (name === "own edited") return { name: "Edited", unit: "", meaning: "Whether the building was edited by hand." };
  const known = table?.attributes.find((a) => a.name === name);
  return { name, unit: known?.unit ?? "", meaning: known?.meaning ?? "" };
};

export const isStyled = computed(() => styledBy.value !== null);
