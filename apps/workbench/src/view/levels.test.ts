import { describe, expect, it } from "vitest";
import type { TileInfo } from "../api/types";
import { Budget, Levels, errorOf } from "./levels";

/** A square of 2^n × 2^n tiles of 100 m, each with 1,000 triangles, and their levels up to a single one. */
function pyramid(n: number): TileInfo[] {
  const tiles: TileInfo[] = [];
  for (let level = 0; level <= n; ++level) {
    const [count, size] = [2 ** (n - level), 100 * 2 ** level];
    for (let column = 0; column < count; ++column) {
      for (let row = 0; row < count; ++row) {
        tiles.push({
          id: `${level}-${column}-${row}`,
          level,
          column,
          row,
          low: [column * size, row * size, 0],
          high: [(column + 1) * size, (row + 1) * size, 20],
          centre: [0, 0, 0],
          vertices: 500,
          triangles: 1000,
        });
      }
    }
  }
  return tiles;
}
const eye = (position: [number, number, number], sees = (_: TileInfo) => true) => ({ position, pixels: 1000, sees });
const all = () => true;
const area = (tiles: TileInfo[]) => tiles.reduce((sum, t) => sum + (t.high[0] - t.low[0]) * (t.high[1] - t.low[1]), 0);

describe("the choice of tiles", () => {
  const levels = new Levels(pyramid(4));

  it("is fine near the camera and coarse far away, and covers everything once", () => {
    const { draw, fetch } = levels.choose(eye([50, 50, 30]), all, 1e9);
    expect(fetch).toEqual([]);
    expect(area(draw)).toBe(1600 * 1600);
    const here = draw.find((t) => t.low[0] <= 50 && t.high[0] > 50 && t.low[1] <= 50 && t.high[1] > 50)!;
    const there = draw.find((t) => t.high[0] === 1600 && t.high[1] === 1600)!;
    expect(here.level).toBe(0);
    expect(there.level).toBeGreaterThan(0);
  });

  it("draws nothing finer than visible", () => {
    const { draw } = levels.choose(eye([800, 800, 2000]), all, 1e9);
    for (const tile of draw) {
      const parentError = errorOf(tile.level + 1);
      if (tile.level < 4) expect((parentError * 1000) / 2000).toBeGreaterThan(1.4);
    }
  });

  it("stays within its budget, used where the error is most visible", () => {
    const { draw } = levels.choose(eye([50, 50, 5]), all, 20_000);
    expect(draw.reduce((sum, t) => sum + t.triangles, 0)).toBeLessThanOrEqual(20_000);
    expect(area(draw)).toBe(1600 * 1600);
    expect(draw.some((t) => t.level === 0 && t.column === 0 && t.row === 0)).toBe(true);
  });

  it("fetches the coarsest first, and draws loaded tiles until finer ones have arrived", () => {
    const loaded = new Set<string>();
    const first = levels.choose(eye([50, 50, 30]), (id) => loaded.has(id), 1e9);
    expect(first.draw).toEqual([]);
    expect(first.fetch[0]!.id).toBe("4-0-0");
    loaded.add("4-0-0");
    for (let round = 0; round < 400; ++round) {
      const { draw, fetch } = levels.choose(eye([50, 50, 30]), (id) => loaded.has(id), 1e9);
      expect(area(draw)).toBe(1600 * 1600);
      if (!fetch.length) return;
      loaded.add(fetch[0]!.id);
    }
    expect.unreachable("something is always wanted");
  });

  it("omits invisible tiles", () => {
    const { draw, fetch } = levels.choose(
      eye([50, 50, 30], (t) => t.low[0] < 400),
      all,
      1e9,
    );
    expect([...draw, ...fetch].every((t) => t.low[0] < 400)).toBe(true);
  });

  it("treats tiles without a coarser tile as roots", () => {
    const lonely = pyramid(2).filter((t) => t.id !== "1-1-1" && t.id !== "2-0-0");
    const { draw } = new Levels(lonely).choose(eye([300, 300, 9000]), all, 1e9);
    expect(area(draw)).toBe(400 * 400);
  });
});

describe("the budget of triangles", () => {
  const after = (ms: number, pictures: number, budget = new Budget()) => {
    for (let i = 0; i < pictures; ++i) budget.took(ms);
    return budget;
  };

  it("decreases on slow machines and increases on fast ones, within bounds", () => {
    expect(after(120, 200).triangles).toBe(300_000);
    expect(after(16, 200).triangles).toBe(3_000_000);
    expect(after(16, 200, after(120, 200)).triangles).toBe(3_000_000);
  });

  it("is stable at an acceptable frame rate, also after a single slow image", () => {
    expect(after(30, 200).triangles).toBe(after(30, 100).triangles);
    expect(after(100, 1).triangles).toBe(1_500_000);
  });
});
