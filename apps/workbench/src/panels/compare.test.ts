import { describe, expect, it } from "vitest";
import { building, summary } from "../view/fixtures";
import type { RunSummary } from "../api/types";
import { buildingDifferences, difference, numbers } from "./compare";
import { rowOf } from "./table";

describe("two runs", () => {
  it("have the times of all their stages", () => {
    const rows = numbers(
      summary({ times: { cpu_seconds: 3, wall_seconds: 2, stages: [{ stage: "slice", cpu_seconds: 3, wall_seconds: 1.5 }] } }),
      summary({ times: { cpu_seconds: 4, wall_seconds: 5, stages: [{ stage: "sweep", cpu_seconds: 4, wall_seconds: 5 }] } }),
    );
    const of = (name: string) => rows.find((r) => r.name === name)!;
    expect(of("Elapsed in slice"), "not the sum over threads").toMatchObject({ first: 1.5, second: null });
    expect(of("Elapsed in sweep")).toMatchObject({ first: null, second: 5 });
    expect(difference(of("CPU time"))).toBe(1);
    expect(difference(of("Elapsed time"))).toBe(3);
  });

  it("have errors in metres, and square metres for areas only", () => {
    const scores = { mse: 4, cells: 9, footprint_mse: 0.25, footprint_median_absolute: 0.1, inside_mse: 0.09, missed: 7, invented: 8 };
    const rows = numbers(summary({ scores: scores as RunSummary["scores"] }), summary());
    const errors = rows.filter((r) => /RMSE|error/.test(r.name));
    expect(errors.map((r) => [r.unit, r.first])).toEqual([["m", 0.5], ["m", 0.3], ["m", 2], ["m", 0.1]]);
    expect(rows.filter((r) => r.unit === "m²").map((r) => r.name)).toEqual(["Missed", "Invented"]);
    expect(rowOf(building("a", { mse: 0.25 })).rmse).toBe(0.5);
  });

  it("have no difference if a value is missing", () => {
    const [mse] = numbers(summary({}), summary({}));
    expect(mse).toMatchObject({ first: null, second: null });
    expect(difference(mse!)).toBeNull();
  });

  it("list the buildings that differ, the largest change of the error first", () => {
    const of = (...all: ReturnType<typeof building>[]) => new Map(all.map((b) => [b.id, b]));
    const first = of(building("same"), building("little"), building("much"), building("left"));
    const second = of(
      building("same"),
      building("little", { mse: 0.09 }),
      building("much", { mse: 4 }),
      building("right"),
    );
    const rows = buildingDifferences(first, second);
    expect(rows.map((r) => r.id)).toEqual(["much", "little", "left", "right"]);
    expect(rows[0]!.rmse).toEqual([0.2, 2]);
    expect(rows.map((r) => r.only)).toEqual([null, null, "first", "second"]);
  });
});
