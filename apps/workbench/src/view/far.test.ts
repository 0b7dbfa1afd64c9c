import { expect, test } from "vitest";
import { painted, prisms } from "./far";

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

test("every vertex of a prism is painted in its colour, of others none", () => {
  const square = [1, 6, 0, 0, 10, 0, 10, 8, 0, 8];
  const ell = [0, 6, 0, 0, 10, 0, 10, 4, 4, 4, 4, 8, 0, 8];
  const { kinds, counts } = prisms([square, ell, square], [0, 0, 0]);
  expect(counts).toEqual([{ roof: 6, walls: 24 }, { roof: 12, walls: 36 }, { roof: 6, walls: 24 }]);
  const paint = painted(counts, [[1, 0, 0], undefined, [0, 0, 1]]);
  expect(paint).toHaveLength(4 * kinds.length);
  const at = (vertex: number) => [...paint.slice(4 * vertex, 4 * vertex + 4)];
  const [red, none, blue] = [[255, 0, 0, 255], [0, 0, 0, 0], [0, 0, 255, 255]];
  expect([at(0), at(6), at(12)]).toEqual([red, none, blue]); // boxes
  expect([at(18), at(23), at(24), at(35), at(36), at(41)]).toEqual([red, red, none, none, blue, blue]); // roofs
  expect([at(42), at(65), at(66), at(101), at(102), at(125)]).toEqual([red, red, none, none, blue, blue]); // walls
});
