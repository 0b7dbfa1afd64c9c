import { expect, test } from "vitest";
import { prisms } from "./far";

test("prisms have the box of their roof, a flat roof, and walls that look outwards", () => {
  const { positions, normals, kinds, boxes, roofs } = prisms([[1, 6, 0, 0, 10, 0, 10, 8, 0, 8]], [100, 0, 0]);
  expect([boxes, roofs]).toEqual([6, 6]);
  expect(kinds).toHaveLength(6 + 6 + 4 * 6);
  expect(positions).toHaveLength(3 * kinds.length);
  expect(positions.slice(0, 3)).toEqual([-100, 0, 7]);
  const walls = 3 * (boxes + roofs);
  expect(positions.slice(walls, walls + 3)).toEqual([-100, 0, 1]);
  expect(normals.slice(walls, walls + 3)).toEqual([0, -1, 0]); // south
  expect(normals.slice(walls + 18, walls + 21)).toEqual([1, -0, 0].map((n) => n + 0)); // east
  const tops = positions.filter((_, i) => i % 3 === 2 && kinds[(i - 2) / 3] === 2);
  expect(new Set(tops)).toEqual(new Set([7]));
});

test("an L has a box of two triangles and a roof of four", () => {
  const { boxes, roofs } = prisms([[0, 6, 0, 0, 10, 0, 10, 4, 4, 4, 4, 8, 0, 8]], [0, 0, 0]);
  expect([boxes, roofs]).toEqual([6, 12]);
});
