// Options as a form needs them: grouped by module, searched, checked, and compared with their defaults.
import type { Option, Preset, RunSummary } from "../api/types";

export const key = (o: Pick<Option, "module" | "name">) => `${o.module}.${o.name}`;

export const forRuns = (options: readonly Option[]) => options.filter((o) => o.used_in === "runs");
export const forInputs = (options: readonly Option[]) => options.filter((o) => o.used_in === "inputs");

/** The value of an option that nobody sets: that of the preset, or its default. */
export const usual = (o: Option, preset: Preset | undefined) => preset?.values[key(o)] ?? o.default;

export const isChanged = (o: Option, values: Record<string, string>, preset: Preset | undefined) =>
  values[key(o)] !== undefined && values[key(o)] !== usual(o, preset);

/** Options whose module, name, alias or meaning contain every word of the search. */
export function found(options: readonly Option[], search: string): Option[] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  return options.filter((o) => {
    const text = `${o.module} ${o.name} ${o.name.replaceAll("_", " ")} ${o.alias} ${o.meaning}`.toLowerCase();
    return words.every((w) => text.includes(w));
  });
}

/** By module, in their order. */
export function grouped(options: readonly Option[]): [string, Option[]][] {
  const groups = new Map<string, Option[]>();
  for (const option of options) groups.set(option.module, [...(groups.get(option.module) ?? []), option]);
  return [...groups];
}

/** The options to show, and how many advanced ones are hidden. Advanced options that were changed are always shown. */
export function visible(
  options: readonly Option[],
  advanced: boolean,
  values: Record<string, string>,
  preset: Preset | undefined,
): { shown: Option[]; hidden: number } {
  const shown = options.filter((o) => advanced || !o.advanced || isChanged(o, values, preset));
  return { shown, hidden: options.length - shown.length };
}

/** What a value must be, if it is not valid; "" if it is. The server checks again. */
export function fault(option: Option, value: string): string {
  if (value === option.default) return "";
  const { kind, choices, minimum, maximum, unit } = option;
  if (kind === "choice" && !choices.includes(value)) return `must be one of ${choices.join(", ")}`;
  if (kind === "boolean" && value !== "true" && value !== "false") return "must be true or false";
  if (kind !== "number" && kind !== "integer") return "";
  const words = value.trim().split(/\s+/).filter(Boolean);
  const count = Math.max(1, option.default.trim().split(/\s+/).filter(Boolean).length);
  const range = rangeOf(option) && `${rangeOf(option)}${unit && ` ${unit}`}`;
  const number = kind === "integer" ? "an integer" : "a number";
  if (words.length !== count) return count === 1 ? `must be ${number}${range && `, ${range}`}` : `must be ${count} numbers`;
  for (const word of words) {
    const x = Number(word);
    if (!Number.isFinite(x) || (kind === "integer" && !Number.isInteger(x))) return `"${word}" must be ${number}`;
    if ((minimum !== null && x < minimum) || (maximum !== null && x > maximum)) return `must be ${range}`;
  }
  return "";
}

/** The range without bounds of a million and more: these only guard the program. */
export const shownRange = ({ minimum, maximum }: Pick<Option, "minimum" | "maximum">) => {
  const shown = (x: number | null) => (x !== null && Math.abs(x) >= 1e6 ? null : x);
  return rangeOf({ minimum: shown(minimum), maximum: shown(maximum) });
};

export function rangeOf({ minimum, maximum }: Pick<Option, "minimum" | "maximum">): string {
  if (minimum !== null && maximum !== null) return `${minimum} to ${maximum}`;
  if (minimum !== null) return `at least ${minimum}`;
  return maximum !== null ? `at most ${maximum}` : "";
}

/** The values that differ from the preset or the default. */
export function changed(options: readonly Option[], values: Record<string, string>, preset: Preset | undefined) {
  const given: Record<string, string> = {};
  for (const option of options) if (isChanged(option, values, preset)) given[key(option)] = values[key(option)]!;
  return given;
}

export interface OptionDifference {
  option: string;
  first: string;
  second: string;
}
/** The options in which two runs differ. */
export function differences(
  first: Pick<RunSummary, "options">,
  second: Pick<RunSummary, "options">,
  options: readonly Option[],
): OptionDifference[] {
  const defaults = new Map(options.map((o) => [key(o), o.default]));
  const names = [...new Set([...Object.keys(first.options), ...Object.keys(second.options)])].sort();
  const of = (run: Pick<RunSummary, "options">, name: string) => run.options[name] ?? defaults.get(name) ?? "";
  return names
    .map((option) => ({ option, first: of(first, option), second: of(second, option) }))
    .filter((d) => d.first !== d.second);
}

/** The first invalid value, with the name of its option; "" if all are valid. */
export function faulty(options: readonly Option[], values: Record<string, string>): string {
  for (const option of options) {
    const value = values[key(option)];
    const wrong = value === undefined ? "" : fault(option, value);
    if (wrong) return `${key(option)}: ${wrong}`;
  }
  return "";
}
