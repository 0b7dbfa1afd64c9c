import { describe, expect, it } from "vitest";
import type { LoadedMap } from "../state";
import { building } from "../view/fixtures";
import { clusters, edgeProfiles, histogram, inwardAt, ticks } from "./plots";

describe("characteristic profiles", () => {
  it("are of every edge, with its length, up to where its faces end", () => {
    const profiles = edgeProfiles([building("a")]);
    expect(profiles.map((p) => p.length)).toEqual([10, 6, 10, 6]);
    expect(profiles[0]!.points.at(-1)).toEqual([3, 6]);
    expect(profiles[1]!.points.at(-1)).toEqual([0, 6]);
  });

  it("are clustered if they are similar, sorted by the length of their edges", () => {
    const found = clusters(edgeProfiles([building("a"), building("b")]));
    expect(found.map((c) => [c.edges, c.length])).toEqual([
      [4, 40],
      [4, 24],
    ]);
  });

  it("are not clustered if they differ by more than the limit", () => {
    const wall = (inward: number): [number, number][] => [
      [0, 0],
      [0, 3],
      [inward, 6],
    ];
    const two = [1, 1.6].map((x) => ({ length: 5, points: wall(x) }));
    expect(clusters(two, 0.4)).toHaveLength(2);
    expect(clusters(two, 0.7)).toHaveLength(1);
  });

  it("have an inward distance at any height", () => {
    const points: [number, number][] = [
      [0, 0],
      [0, 4],
      [2, 6],
    ];
    expect([0, 2, 5, 6, 9].map((h) => inwardAt(points, h))).toEqual([0, 0, 1, 2, 2]);
  });
});

describe("the histogram of errors", () => {
  const map = (cells: number[]): LoadedMap => ({
    block: "b",
    origin: [0, 0],
    grid: 1,
    columns: cells.length,
    rows: 1,
    cells: new Float32Array(cells),
  });

  it("counts known cells; the outermost bins include larger errors", () => {
    const spread = histogram([map([-9, -0.1, NaN]), map([0.1, 1.9])], 2, 4)!;
    expect(spread.bins).toEqual([0.25, 0.25, 0.25, 0.25]);
    expect(spread.cells).toBe(4);
    expect(spread.within).toBe(0.5);
    expect(spread.mean).toBeCloseTo(-1.775);
    expect(spread.rmse).toBeCloseTo(Math.sqrt((81 + 0.01 + 0.01 + 3.61) / 4));
  });

  it("is null if nothing is known", () => {
    expect(histogram([map([NaN])], 2)).toBeNull();
    expect(histogram([], 2)).toBeNull();
  });
});

describe("ticks of an axis", () => {
  it("are round and few", () => {
    expect(ticks(10)).toEqual([0, 2, 4, 6, 8, 10]);
    expect(ticks(0.6)).toEqual([0, 0.2, 0.4, 0.6]);
    expect(ticks(0)).toEqual([0]);
    for (const most of [0.013, 1, 7, 33, 250]) expect(ticks(most).length).toBeLessThanOrEqual(7);
  });
});
