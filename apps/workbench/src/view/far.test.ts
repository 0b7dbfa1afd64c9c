import { expect, test } from "vitest";
import { prisms } from "./far";

test("prisms have walls that look outwards, and flat roofs", () => {
  const { positions, normals, kinds } = prisms([[1, 6, 0, 0, 10, 0, 10, 8, 0, 8]], [100, 0, 0]);
  expect(kinds).toHaveLength(4 * 6 + 2 * 3);
  expect(positions).toHaveLength(3 * kinds.length);
  expect(positions.slice(0, 3)).toEqual([-100, 0, 1]);
  expect(normals.slice(0, 3)).toEqual([0, -1, 0]); // south
  expect(normals.slice(18, 21)).toEqual([1, -0, 0].map((n) => n + 0)); // east
  const tops = positions.filter((_, i) => i % 3 === 2 && kinds[(i - 2) / 3] === 2);
  expect(new Set(tops)).toEqual(new Set([7]));
});
