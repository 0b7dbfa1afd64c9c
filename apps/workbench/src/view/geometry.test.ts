import { describe, expect, it } from "vitest";
import type { RaisedPart } from "../api/types";
import { building, house, plan } from "./fixtures";
import { boxOf, buffersOf, capped, reaches, standing } from "./geometry";

describe("the buffers of a solid", () => {
  it("have every triangle relative to the centre; normals of roofs point up", () => {
    const { positions, normals, kinds } = buffersOf([house], [5, 3, 0]);
    expect(kinds.length).toBe(16 * 3);
    expect(positions.slice(0, 3)).toEqual(new Float32Array([-5, -3, 0]));
    for (let corner = 0; corner < kinds.length; ++corner) {
      const up = normals[corner * 3 + 2]!;
      if (kinds[corner] === 2) expect(up).toBeCloseTo(Math.SQRT1_2);
      if (kinds[corner] === 0) expect(up).toBeCloseTo(0);
      if (kinds[corner] === 3) expect(up).toBeCloseTo(-1);
    }
  });

  it("have every edge of the solid once", () => {
    expect(buffersOf([house], [0, 0, 0]).lines.length / 6).toBe(15); // 10 vertices, 7 faces: Euler
  });

  it("can contain some faces only", () => {
    const { kinds } = buffersOf([house], [0, 0, 0], (f) => f.ring === 0 && f.edge === 2);
    expect(kinds.length / 3).toBe(4);
  });

  it("keep millimetres far from the origin", () => {
    const far = { ...house, positions: house.positions.map((x, i) => x + [5_000_000.123, 400_000, 0][i % 3]!) };
    const { positions } = buffersOf([far], [5_000_000, 400_000, 0]);
    expect(positions[0]).toBeCloseTo(0.123, 6);
  });
});

describe("a box", () => {
  it("contains the plan of parts without geometry", () => {
    const failed: RaisedPart = { ...building("a").parts[0]!, geometry: null };
    expect(boxOf({ ...building("a"), parts: [failed] })).toEqual({ low: [0, 0, 0], high: [10, 6, 9] });
  });
});

describe("a profile", () => {
  it("is cut at the cap, or continued up to it", () => {
    const profile = plan.profiles[0]!;
    expect(capped(profile, 4.5)).toEqual([
      [0, 0],
      [0, 3],
      [1.5, 4.5],
    ]);
    expect(capped(profile, 8).at(-1)).toEqual([5, 8]);
    expect(capped(profile, 2)).toEqual([
      [0, 0],
      [0, 2],
    ]);
  });

  it("is placed upright on its edge, inward to the left", () => {
    const [foot, , top] = standing({ ...plan, cap: 6 }, 0, 1, 0.5, plan.profiles[0]!);
    expect(foot).toEqual([10, 3, 0]);
    expect(top).toEqual([7, 3, 6]);
  });

  it("is shown no higher than the faces of its edge", () => {
    const reach = reaches(building("a").parts[0]!);
    expect(reach(0, 0)).toBe(6);
    expect(reach(0, 1)).toBe(6);
    expect(reaches({ plan, geometry: null })(0, 0)).toBe(9);
  });
});
