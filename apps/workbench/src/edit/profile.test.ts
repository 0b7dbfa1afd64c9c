import { describe, expect, it } from "vitest";
import { gable, roof } from "./house_for_tests";
import {
  continued,
  degreesOf,
  deletePoint,
  gutterOf,
  gutterPoint,
  held,
  insertPoint,
  kindOf,
  lastRoof,
  lifted,
  movePoint,
  onPart,
  pitchOf,
  slopeOfDegrees,
  slopeTo,
  withGutter,
  withSlope,
  type Profile,
} from "./profile";
import { profileFault } from "./check";

const mansard: Profile = [
  [0, 0],
  [0, 6],
  [1, 9],
  [5, 11],
];
const setback: Profile = [
  [0, 0],
  [0, 9],
  [3, 9],
  [3, 12],
];

describe("the kind of a profile", () => {
  it("follows from its segments", () => {
    expect([gable, roof, mansard, setback].map(kindOf)).toEqual(["wall", "pitched", "pitched", "terrace"]);
  });
  it("has a gutter where its first wall ends, and none if the wall continues", () => {
    expect([gable, roof, mansard, setback].map(gutterOf)).toEqual([null, 6, 6, 9]);
    expect(
      gutterOf([
        [0, 0],
        [4, 3],
      ]),
    ).toBe(0);
  });
  it("has its gutter at a point, unless the roof begins at the base", () => {
    expect([gable, roof, mansard, setback].map(gutterPoint)).toEqual([null, 1, 1, 1]);
    expect(
      gutterPoint([
        [0, 0],
        [4, 3],
      ]),
    ).toBeNull();
    for (const profile of [roof, mansard]) expect(profile[gutterPoint(profile)!]![1]).toBe(gutterOf(profile));
  });
  it("has the pitch of its topmost roof segment", () => {
    expect(degreesOf(pitchOf(roof)!)).toBeCloseTo(45);
    expect(pitchOf(mansard)).toBeCloseTo(0.5);
    expect(pitchOf(gable)).toBeNull();
    expect(lastRoof(mansard)).toBe(3);
    expect(slopeTo(mansard, 1)).toBe(Infinity);
  });
  it("converts degrees to slopes and back", () => {
    for (const degrees of [0.5, 22, 45, 81]) expect(degreesOf(slopeOfDegrees(degrees))).toBeCloseTo(degrees, 10);
  });
  it("continues in the direction of its last segment, vertically after a terrace", () => {
    expect(continued(roof, 12)).toEqual([6, 12]);
    expect(continued(gable, 12)).toEqual([0, 12]);
    expect(continued(setback.slice(0, 3), 12)).toEqual([3, 12]);
    expect(continued(roof, 10)).toBeNull();
  });
});

describe("operations on profiles", () => {
  it("a higher gutter moves the roof along", () => {
    expect(withGutter(mansard, 7)).toEqual([
      [0, 0],
      [0, 7],
      [1, 10],
      [5, 12],
    ]);
    expect(withGutter(gable, 7)).toBe(gable);
  });
  it("a roof that begins at the base gets a wall", () => {
    const lean: Profile = [
      [0, 0],
      [4, 3],
    ];
    expect(withGutter(lean, 2)).toEqual([
      [0, 0],
      [0, 2],
      [4, 5],
    ]);
  });
  it("a wall of two points keeps both", () => {
    const knotted: Profile = [
      [0, 0],
      [0, 3],
      [0, 6],
      [4, 10],
    ];
    expect(withGutter(knotted, 7)).toEqual([
      [0, 0],
      [0, 3],
      [0, 7],
      [4, 11],
    ]);
  });
  it("a segment with another slope keeps its run and moves the points above", () => {
    expect(withSlope(mansard, 2, 2)).toEqual([
      [0, 0],
      [0, 6],
      [1, 8],
      [5, 10],
    ]);
    expect(withSlope(mansard, 1, 2)).toBe(mansard);
  });
  it("a lowered roof stops at the point below it", () => {
    expect(lifted(mansard, 2, -9).map((p) => p[1])).toEqual([0, 6, 6, 8]);
    expect(lifted(mansard, 1, 1).map((p) => p[1])).toEqual([0, 7, 10, 12]);
  });
  it("points are moved, inserted and deleted, except for the foot and one more point", () => {
    expect(movePoint(roof, 0, [1, 1])).toBe(roof);
    expect(insertPoint(roof, 2, [2, 8])).toHaveLength(4);
    expect(deletePoint(insertPoint(roof, 2, [2, 8]), 2)).toEqual(roof);
    expect(deletePoint(roof, 0)).toBeNull();
    expect(deletePoint(gable, 1)).toBeNull();
  });
  it("an inserted point is on its segment, at whole centimetres", () => {
    expect(onPart(roof, 1, [0.3, 3.456])).toEqual([0, 3.46]);
    expect(onPart(mansard, 3, [3.003, 10])).toEqual([3, 10]);
    expect(onPart(roof, 3, [4.5, 10.7])).toEqual([4.6, 10.6]);
    expect(onPart(roof, 2, [-9, 0])).toEqual([0, 6]);
    expect(onPart(roof, 0, [1, 1])).toBeNull();
  });
  it("a point dragged anywhere leaves a valid profile", () => {
    for (let i = 1; i < mansard.length; ++i)
      for (const x of [-3, 0, 0.5, 1, 4, 5, 9])
        for (const y of [-3, 0, 5, 6, 9, 10, 11, 20]) {
          const moved = movePoint(mansard, i, held(mansard, i, [x, y]));
          expect(profileFault(moved)).toBeNull();
          for (let n = 1; n < moved.length; ++n) expect(moved[n]).not.toEqual(moved[n - 1]);
        }
  });
});
