// Options as a form needs them: grouped by room, filtered, checked, and told apart from what they would be anyway.
import type { Option, Preset, RunSummary } from "../api/types";

export const key = (o: Pick<Option, "room" | "name">) => `${o.room}.${o.name}`;

/** Rooms whose options say how a scene is read; a run takes the scene as it is. */
export const readingRooms: readonly string[] = ["ingest", "derive", "block"];
/** Rooms that no run passes through. */
const elsewhere: readonly string[] = ["roof", "simulate", "explore", "picture"];

export const forRuns = (options: readonly Option[]) =>
  options.filter((o) => !readingRooms.includes(o.room) && !elsewhere.includes(o.room));
export const forReading = (options: readonly Option[]) => options.filter((o) => readingRooms.includes(o.room));

/** What an option is when nobody sets it: the preset's value, or its default. */
export const usual = (o: Option, preset: Preset | undefined) => preset?.values[key(o)] ?? o.default;

/** By room in their order; those whose room, name, alias or meaning have every word of the search. */
export function grouped(options: readonly Option[], search = ""): [string, Option[]][] {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  const groups = new Map<string, Option[]>();
  for (const option of options) {
    const text =
      `${option.room} ${option.name} ${option.name.replaceAll("_", " ")} ${option.alias} ${option.meaning}`.toLowerCase();
    if (!words.every((w) => text.includes(w))) continue;
    groups.set(option.room, [...(groups.get(option.room) ?? []), option]);
  }
  return [...groups];
}

/** What is wrong with a value, in words; "" where nothing is. The server has the last word. */
export function fault(option: Option, value: string): string {
  if (value === option.default) return "";
  const { kind, choices, least, most, unit } = option;
  if (kind === "choice" && !choices.includes(value)) return `one of ${choices.join(", ")}`;
  if (kind === "flag" && value !== "true" && value !== "false") return "true or false";
  if (kind !== "number" && kind !== "whole") return "";
  const words = value.trim().split(/\s+/).filter(Boolean);
  const count = Math.max(1, option.default.trim().split(/\s+/).filter(Boolean).length);
  const range = rangeOf(option);
  if (words.length !== count) return count === 1 ? `a number${range && `, ${range}`}` : `${count} numbers`;
  for (const word of words) {
    const x = Number(word);
    if (!Number.isFinite(x)) return `"${word}" is not a number`;
    if (kind === "whole" && !Number.isInteger(x)) return "a whole number";
    if ((least !== null && x < least) || (most !== null && x > most)) return `${range}${unit && ` ${unit}`}`;
  }
  return "";
}

/** The range as far as it tells something: bounds in the millions are there for the program's sake. */
export const tellingRange = ({ least, most }: Pick<Option, "least" | "most">) => {
  const told = (x: number | null) => (x !== null && Math.abs(x) >= 1e6 ? null : x);
  return rangeOf({ least: told(least), most: told(most) });
};

export function rangeOf({ least, most }: Pick<Option, "least" | "most">): string {
  if (least !== null && most !== null) return `${least} to ${most}`;
  if (least !== null) return `${least} or more`;
  return most !== null ? `${most} or less` : "";
}

/** Those values that differ from what they would be anyway. */
export function changed(options: readonly Option[], values: Record<string, string>, preset: Preset | undefined) {
  const given: Record<string, string> = {};
  for (const option of options) {
    const value = values[key(option)];
    if (value !== undefined && value !== usual(option, preset)) given[key(option)] = value;
  }
  return given;
}

export interface OptionDifference {
  option: string;
  first: string;
  second: string;
}
/** Of two runs, all options in which they differ. */
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

/** The first value that is wrong, in words; "" where none is. */
export function faulty(options: readonly Option[], values: Record<string, string>): string {
  for (const option of options) {
    const value = values[key(option)];
    const wrong = value === undefined ? "" : fault(option, value);
    if (wrong) return `${key(option)}: ${wrong}`;
  }
  return "";
}
