import { expect, test } from "vitest";
import type { Geometry } from "../api/types";
import { capOf, cutLines, normalOf, planeOf, reach, type SectionPlane } from "./section";

/** A box with its faces as triangles, counter-clockwise seen from outside. */
function box([x0, y0, z0]: number[], [x1, y1, z1]: number[], inwards = false): Geometry {
  const positions: number[] = [];
  for (let i = 0; i < 8; ++i) positions.push(i & 1 ? x1! : x0!, i & 2 ? y1! : y0!, i & 4 ? z1! : z0!);
  const quads = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
  ];
  const triangles = quads.flatMap(([a, b, c, d]) => (inwards ? [a, c, b, a, d, c] : [a, b, c, a, c, d])) as number[];
  return { positions, triangles, face_of: triangles.filter((_, i) => i % 3 === 0), faces: [] };
}
function together(a: Geometry, b: Geometry): Geometry {
  const by = a.positions.length / 3;
  return {
    positions: [...a.positions, ...b.positions],
    triangles: [...a.triangles, ...b.triangles.map((v) => v + by)],
    face_of: [...a.face_of, ...b.face_of],
    faces: [],
  };
}
function area(triangles: number[]) {
  let sum = 0;
  for (let i = 0; i < triangles.length; i += 9) {
    const [a, b, c] = [0, 3, 6].map((k) => triangles.slice(i + k, i + k + 3));
    const [u, v] = [b!.map((x, k) => x - a![k]!), c!.map((x, k) => x - a![k]!)];
    sum += Math.hypot(u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!, u[0]! * v[1]! - u[1]! * v[0]!) / 2;
  }
  return sum;
}

test("the cut of a box is filled, in any direction", () => {
  const solid = box([0, 0, 0], [4, 6, 3]);
  expect(cutLines(solid, [0, 0, 1], 1)).toHaveLength(1);
  expect(area(capOf(solid, [0, 0, 1], 1))).toBeCloseTo(24);
  expect(area(capOf(solid, [1, 0, 0], 2))).toBeCloseTo(18);
  expect(area(capOf(solid, normalOf({ azimuth: 45, tilt: 0 }), 5 / Math.SQRT2))).toBeCloseTo(4 * Math.SQRT2 * 3);
  expect(capOf(solid, [0, 0, 1], 5)).toEqual([]);
});

test("a plane through corners cuts as one beside them", () => {
  const solid = box([0, 0, 0], [4, 6, 3]);
  expect(area(capOf(solid, [0, 0, 1], 0))).toBeCloseTo(0);
  expect(area(capOf(solid, [0, 0, 1], 3))).toBeCloseTo(24);
});

test("courtyards stay open", () => {
  const ring = together(box([0, 0, 0], [10, 10, 3]), box([2, 2, -1], [5, 5, 4], true));
  expect(area(capOf(ring, [0, 0, 1], 1))).toBeCloseTo(100 - 9);
  const filled = together(ring, box([3, 3, 0], [4, 4, 3]));
  expect(area(capOf(filled, [0, 0, 1], 1))).toBeCloseTo(100 - 9 + 1);
});

test("the offsets reach from one end of a box to the other", () => {
  const section: SectionPlane = { origin: [1, 1, 0], azimuth: 90, tilt: 0, offset: 0.5, flipped: false };
  const [least, most] = reach(section, { low: [0, 0, 0], high: [4, 2, 2] });
  expect(least).toBeCloseTo(-1);
  expect(most).toBeCloseTo(3);
  expect(planeOf(section).at).toBeCloseTo(1.5);
});
