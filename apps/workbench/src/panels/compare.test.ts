import { describe, expect, it } from "vitest";
import { building, summary } from "../view/fixtures";
import { buildingDifferences, difference, numbers } from "./compare";

describe("two runs", () => {
  it("have the times of all their stages", () => {
    const rows = numbers(
      summary({ times: { cpu_seconds: 3, wall_seconds: 2, stages: [{ stage: "slice", cpu_seconds: 1, wall_seconds: 1 }] } }),
      summary({ times: { cpu_seconds: 4, wall_seconds: 5, stages: [{ stage: "sweep", cpu_seconds: 2, wall_seconds: 1 }] } }),
    );
    const of = (name: string) => rows.find((r) => r.name === name)!;
    expect(of("CPU time of slice")).toMatchObject({ first: 1, second: null });
    expect(of("CPU time of sweep")).toMatchObject({ first: null, second: 2 });
    expect(difference(of("CPU time"))).toBe(1);
    expect(difference(of("Elapsed time"))).toBe(3);
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
