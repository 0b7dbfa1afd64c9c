import { describe, expect, it } from "vitest";
import { fitted, gripRadius, panned, ruling, toMetres, toPixels, zoomed, type Sheet } from "./sheet";

const sheet: Sheet = { centre: [100, 50], scale: 10, width: 400, height: 200 };

describe("a sheet", () => {
  it("has metres upwards and pixels downwards", () => {
    expect(toPixels(sheet, [100, 50])).toEqual([200, 100]);
    expect(toPixels(sheet, [101, 51])).toEqual([210, 90]);
    expect(toMetres(sheet, [210, 90])).toEqual([101, 51]);
  });
  it("keeps the point under the pointer when zoomed, and follows the pointer when panned", () => {
    const before = toMetres(sheet, [37, 151]);
    const after = toMetres(zoomed(sheet, [37, 151], 3.7), [37, 151]);
    expect(after[0]).toBeCloseTo(before[0], 10);
    expect(after[1]).toBeCloseTo(before[1], 10);
    const moved = toPixels(panned(sheet, [12, -7]), [100, 50]);
    expect(moved[0]).toBeCloseTo(212, 10);
    expect(moved[1]).toBeCloseTo(93, 10);
  });
  it("has limits for zooming", () => {
    expect(zoomed(sheet, [0, 0], 1e9).scale).toBe(4000);
    expect(zoomed(sheet, [0, 0], 1e-9).scale).toBe(0.2);
  });
  it("is fitted to all points with a margin", () => {
    const points: [number, number][] = [
      [0, 0],
      [30, 4],
      [12, -9],
    ];
    const now = fitted(sheet, points, 20);
    for (const p of points) {
      const [x, y] = toPixels(now, p);
      expect(x).toBeGreaterThanOrEqual(20 - 1e-9);
      expect(x).toBeLessThanOrEqual(380 + 1e-9);
      expect(y).toBeGreaterThanOrEqual(20 - 1e-9);
      expect(y).toBeLessThanOrEqual(180 + 1e-9);
    }
    expect(fitted(sheet, [], 20)).toBe(sheet);
  });
  it("has ruler lines at round distances, far enough apart", () => {
    expect(ruling(10, 36)).toBe(5);
    expect(ruling(100, 36)).toBe(0.5);
    expect(ruling(3, 36)).toBe(20);
    for (const scale of [0.3, 1, 7, 55, 900]) expect(ruling(scale, 36) * scale).toBeGreaterThanOrEqual(36 - 1e-9);
  });
  it("has handles that share the room between them", () => {
    const handles: [number, number][] = [
      [0, 0],
      [12, 0],
      [100, 0],
    ];
    expect(handles.map((h) => gripRadius(h, handles, 10))).toEqual([6, 6, 10]);
  });
});
