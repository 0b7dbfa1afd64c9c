import { describe, expect, it } from "vitest";
import type { Point2 } from "../api/types";
import { gable, house, roof, withCorners } from "./house_for_tests";
import { known, rounded, snapDrawn, snapEdge, snapProfilePoint, snapVertex, surroundings, type Snap } from "./snap";
import { slopes, type Profile } from "./profile";

const near: Snap = { reach: 0.3, step: 0.01, grid: 0 };
const off: Snap = { reach: 0, step: 0.001, grid: 1 };
const nothing = { corners: [], edges: [] };
const at = (edge: number) => ({ ring: 0, edge });

describe("rounding", () => {
  it("gives short decimals", () => {
    expect(rounded(12.3449, 0.01)).toBe(12.34);
    expect(rounded(0.1 + 0.2, 0.01)).toBe(0.3);
    expect(rounded(1.2346, 0.001)).toBe(1.235);
    expect(rounded(7.3, 0.5)).toBe(7.5);
    expect(rounded(-1.26, 0.1)).toBe(-1.3);
  });
});

describe("a dragged corner", () => {
  const neighbour = withCorners([
    [12, 3],
    [20, 3],
    [20, 9],
    [12, 9],
  ]);
  const around = surroundings(house(), [neighbour], (e) => e.edge === 2);

  it("snaps exactly to a corner of a neighbour", () => {
    expect(snapVertex(house(), at(2), [11.9, 8.85], around, near).at).toEqual([12, 9]);
  });
  it("snaps to a wall of a neighbour, and not beyond its ends", () => {
    const snapped = snapVertex(house(), at(2), [12.1, 5.5], around, near);
    expect(snapped.at[0]).toBe(12);
    expect(snapped.guides[0]?.words).toBe("edge");
    expect(snapVertex(house(), at(2), [12.1, 12.123], around, near).guides).toEqual([]);
  });
  it("snaps to right angles with the adjacent edges", () => {
    // Vertical above corner 1 and horizontal beside corner 3, both at once.
    const snapped = snapVertex(house(), at(2), [10.2, 8.2], nothing, near);
    expect(snapped.at).toEqual([10, 8]);
    expect(snapped.guides.map((g) => g.words)).toEqual(["right angle", "right angle"]);
  });
  it("on one line is rounded to whole centimetres of length", () => {
    const snapped = snapVertex(house(), at(2), [10.1, 9.4567], nothing, near);
    expect(snapped.at).toEqual([10, 9.46]);
  });
  it("snaps to parallels in rotated plans", () => {
    const turn = (p: Point2): Point2 => [p[0] * 0.8 - p[1] * 0.6, p[0] * 0.6 + p[1] * 0.8];
    const turned = withCorners(house().outer.points.map(turn));
    const snapped = snapVertex(turned, at(2), turn([10.1, 9.456]), nothing, near);
    expect(snapped.at[0]).toBeCloseTo(turn([10, 9.46])[0], 10);
    expect(snapped.at[1]).toBeCloseTo(turn([10, 9.46])[1], 10);
  });
  it("is only rounded if nothing is near, or with Alt", () => {
    expect(snapVertex(house(), at(2), [11.2345, 9.9876], nothing, near).at).toEqual([11.23, 9.99]);
    expect(snapVertex(house(), at(2), [10.0004, 8.1236], around, off).at).toEqual([10, 8.124]);
  });
  it("snaps to the grid if nothing else is near", () => {
    expect(snapVertex(house(), at(2), [11.45, 9.6], nothing, { ...near, grid: 0.5 }).at).toEqual([11.5, 9.5]);
  });
  it("never snaps to an adjacent corner", () => {
    const own = surroundings(house(), [], (e) => e.edge === 2);
    for (const to of [
      [10.1, 0.1],
      [0.1, 7.9],
      [9.9, -0.2],
    ] as Point2[]) {
      const { at: p } = snapVertex(house(), at(2), to, own, near);
      expect(Math.hypot(p[0] - 10, p[1])).toBeGreaterThan(0.005);
      expect(Math.hypot(p[0], p[1] - 8)).toBeGreaterThan(0.005);
    }
  });
  it("ignores its own edges", () => {
    expect(surroundings(house(), [], (e) => e.edge === 2)).toEqual({
      corners: [
        [0, 0],
        [10, 0],
        [0, 8],
      ],
      edges: [
        [
          [0, 0],
          [10, 0],
        ],
        [
          [0, 8],
          [0, 0],
        ],
      ],
    });
  });
});

describe("a dragged edge", () => {
  it("snaps in line with a near corner, otherwise moves by whole centimetres", () => {
    const around = { corners: [[3, 8.97]] as Point2[], edges: [] };
    const snapped = snapEdge(house(), at(2), -0.9, around, near);
    expect(snapped.by).toBeCloseTo(-0.97, 12);
    expect(snapEdge(house(), at(2), -0.4567, around, near).by).toBe(-0.46);
    expect(snapEdge(house(), at(2), -0.4567, around, off).by).toBe(-0.457);
  });
});

describe("points drawn for a courtyard or a split line", () => {
  it("snap to right angles with the previous line", () => {
    const snapped = snapDrawn(
      house(),
      [
        [2, 2],
        [5, 2],
      ],
      [5.1, 4.123],
      nothing,
      near,
    );
    expect(snapped.at).toEqual([5, 4.12]);
  });
});

describe("a dragged profile point", () => {
  const snap = { ...near, slopes: [0.5], heights: [5.5] };
  it("snaps to a vertical segment below and a flat one above", () => {
    const profile: Profile = [
      [0, 0],
      [0.4, 6],
      [4, 10],
    ];
    expect(snapProfilePoint(profile, 1, [0.1, 7.126], snap)).toEqual({ at: [0, 7.13], words: ["vertical"] });
    expect(snapProfilePoint(profile, 1, [2, 9.9], snap)).toEqual({ at: [2, 10], words: ["flat"] });
  });
  it("snaps to the pitch of another edge", () => {
    const snapped = snapProfilePoint(roof, 2, [3.003, 7.6], snap);
    expect(snapped.words).toEqual(["same pitch"]);
    expect((snapped.at[1] - 6) / snapped.at[0]).toBeCloseTo(0.5, 10);
    expect(snapped.at[0]).toBe(3.04); // the nearest position with that pitch, to the centimetre
  });
  it("snaps to the height of another gutter, vertically", () => {
    expect(snapProfilePoint(roof, 1, [0.1, 5.4], snap)).toEqual({ at: [0, 5.5], words: ["vertical", "same height"] });
  });
  it("never leans outwards, goes down, or coincides with another point", () => {
    expect(snapProfilePoint(roof, 2, [-2, 3], snap).at).toEqual([0, 6.01]);
    expect(snapProfilePoint(roof, 1, [9, 20], { ...snap, reach: 0 }).at).toEqual([4, 9.99]);
  });
  it("prefers the pitches of adjacent edges", () => {
    const plan = {
      ...house(),
      profiles: [
        roof,
        gable,
        [
          [0, 0],
          [0, 5],
          [2, 6],
        ] as Profile,
      ],
    };
    plan.outer = { ...plan.outer, profile_of_edge: [0, 2, 0, 1] };
    expect(known(plan, at(3), [at(3)], slopes)).toEqual([1, 0.5]);
    expect(known(plan, at(2), [at(2)], slopes)).toEqual([0.5, 1]);
    expect(known(plan, at(2), [at(0), at(2)], slopes)).toEqual([0.5]);
  });
});
