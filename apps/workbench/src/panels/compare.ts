// The numbers of two runs, compared.
import type { Building, RunSummary } from "../api/types";
import { editsOf, scoresOf } from "../state";
import { rmse } from "./words";

export interface NumberRow {
  name: string;
  unit: string;
  digits: number;
  first: number | null;
  second: number | null;
  less: boolean | null; // whether less is better; null: neither
}

/** The numbers in the summaries of two runs. */
export function numbers(first: RunSummary, second: RunSummary): NumberRow[] {
  const row = (
    name: string,
    unit: string,
    digits: number,
    of: (r: RunSummary) => number | null | undefined,
    less: boolean | null = true,
  ): NumberRow => ({ name, unit, digits, first: of(first) ?? null, second: of(second) ?? null, less });
  const rows = [
    row("RMSE, footprints", "m", 3, (r) => rmse(scoresOf(r).scores?.footprint_mse)),
    row("RMSE, inside them", "m", 3, (r) => rmse(scoresOf(r).scores?.inside_mse)),
    row("RMSE, whole box", "m", 3, (r) => rmse(scoresOf(r).scores?.mse)),
    row("Median absolute error", "m", 3, (r) => scoresOf(r).scores?.footprint_median_absolute),
    row("Missed", "m²", 1, (r) => scoresOf(r).scores?.missed),
    row("Invented", "m²", 1, (r) => scoresOf(r).scores?.invented),
    row("Buildings", "", 0, (r) => r.buildings, null),
    row("Fully reconstructed", "", 0, (r) => r.full, false),
    row("Parts", "", 0, (r) => r.parts, null),
    row("Faces", "", 0, (r) => r.faces, null),
    row("Edits", "", 0, editsOf, null),
    row("Elapsed time", "s", 1, (r) => r.times.wall_seconds),
    row("CPU time", "s", 1, (r) => r.times.cpu_seconds),
  ];
  const stages = [...new Set([...first.times.stages, ...second.times.stages].map((t) => t.stage))];
  const time = (r: RunSummary, stage: string) => r.times.stages.find((t) => t.stage === stage)?.wall_seconds;
  return [...rows, ...stages.map((stage) => row(`Elapsed in ${stage}`, "s", 1, (r) => time(r, stage)))];
}

/** Second minus first; null if one is missing. */
export const difference = ({ first, second }: Pick<NumberRow, "first" | "second">) =>
  first === null || second === null ? null : second - first;

export interface BuildingDifference {
  id: string;
  rmse: [number | null, number | null]; // m
  parts: [number, number];
  volume: [number, number]; // m³
  only: "first" | "second" | null;
}

const volume = (b: Building | undefined) => b?.parts.reduce((sum, p) => sum + p.volume, 0) ?? 0;
const rmseOf = (b: Building | undefined) => rmse(b?.mse);

/** Buildings that differ between two runs, the largest change of the error first. */
export function buildingDifferences(
  first: ReadonlyMap<string, Building>,
  second: ReadonlyMap<string, Building>,
): BuildingDifference[] {
  const ids = [...new Set([...first.keys(), ...second.keys()])];
  const rows = ids.map((id): BuildingDifference => {
    const [a, b] = [first.get(id), second.get(id)];
    return {
      id,
      rmse: [rmseOf(a), rmseOf(b)],
      parts: [a?.parts.length ?? 0, b?.parts.length ?? 0],
      volume: [volume(a), volume(b)],
      only: !a ? "second" : !b ? "first" : null,
    };
  });
  const change = (d: BuildingDifference) => {
    const by = difference({ first: d.rmse[0], second: d.rmse[1] });
    return by === null ? 0 : Math.abs(by);
  };
  const differs = (d: BuildingDifference) =>
    d.only !== null || change(d) > 1e-6 || d.parts[0] !== d.parts[1] || Math.abs(d.volume[0] - d.volume[1]) > 1e-3;
  return rows.filter(differs).sort((a, b) => change(b) - change(a) || (a.id < b.id ? -1 : 1));
}
