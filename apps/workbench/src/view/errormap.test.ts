import { DataUtils } from "three";
import { describe, expect, it } from "vitest";
import type { LoadedMap } from "../state";
import { combine } from "./errormap";

const map = (x: number, y: number, columns: number, rows: number, cells: number[], grid = 0.5): LoadedMap => ({
  block: "b",
  origin: [x, y],
  grid,
  columns,
  rows,
  cells: new Float32Array(cells),
});
const at = (c: NonNullable<ReturnType<typeof combine>>, x: number, y: number) => {
  const column = Math.floor((x - c.low[0]) / c.cell);
  const row = Math.floor((y - c.low[1]) / c.cell);
  return DataUtils.fromHalfFloat(c.cells[row * c.columns + column]!);
};

describe("the combined error map of a run", () => {
  it("has the cells of each block, and none between them", () => {
    const both = combine([map(0, 0, 2, 1, [1, NaN]), map(5, 3, 1, 2, [-0.5, 0.25])])!;
    expect(at(both, 0, 0)).toBe(1);
    expect(at(both, 0.5, 0)).toBeGreaterThan(10_000);
    expect(at(both, 5, 3)).toBe(-0.5);
    expect(at(both, 5, 3.5)).toBe(0.25);
    expect(at(both, 2.5, 2)).toBeGreaterThan(10_000);
  });

  it("is made coarser if it would be too large, by averaging", () => {
    const coarse = combine([map(0, 0, 8, 1, [1, 3, 1, 3, NaN, 2, NaN, NaN])], 4)!;
    expect([coarse.columns, coarse.cell]).toEqual([4, 1]);
    expect([at(coarse, 0, 0), at(coarse, 2, 0)]).toEqual([2, 2]);
    expect(at(coarse, 3, 0)).toBeGreaterThan(10_000);
  });

  it("is null without maps", () => {
    expect(combine([])).toBeNull();
    expect(combine([map(0, 0, 0, 0, [])])).toBeNull();
  });
});
