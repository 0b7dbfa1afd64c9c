import { expect, test } from "vitest";
import type { BuildingList } from "./api/types";
import { boxOfShapes, largeOf, tilesAround, tilesNear } from "./large";

/** A square of 10 m with its lower left corner there, 6 m high. */
const square = (x: number, y: number) => [[0, 6, x, y, x + 10, y, x + 10, y + 10, x, y + 10].map((m) => 100 * m)];
const list = (...places: [number, number][]): BuildingList => ({
  tile_size: 200,
  ids: places.map((_, i) => `b${i}`),
  blocks: places.map(() => "block-1"),
  outcomes: places.map(() => "full"),
  volumes: places.map(() => 600),
  errors: places.map((_, i) => (i ? 0.25 : null)),
  confidences: places.map((_, i) => (i ? 0.97 : null)),
  edited: places.map(() => false),
  attributes: [],
  shapes: places.map(([x, y]) => square(x, y)),
  reasons: { b1: [{ severity: "warning", code: "c", message: "too small", subject: "b1" }] },
  history: { edits: [], done: 0 },
});

test("a list becomes rows and tiles", () => {
  const large = largeOf(list([0, 0], [190, 0], [-20, 0], [500, 500]));
  expect(large.rows[0]).toMatchObject({ id: "b0", rmse: null, confidence: null, parts: 1, volume: 600, reasons: [] });
  expect(large.rows[1]).toMatchObject({ rmse: 0.5, confidence: 0.97, reasons: ["Too small"] });
  expect(large.tileOf).toEqual(["0_0", "0_0", "-1_0", "2_2"]); // by the centres: 195 m is in the first tile
  expect(large.low).toEqual([-20, 0, 0]);
  expect(large.high).toEqual([510, 510, 6]);
  expect(boxOfShapes(large.shapes[3]!)).toEqual({ low: [500, 500, 0], high: [510, 510, 6] });
});

test("the tiles near a point come nearest first, until there are enough buildings", () => {
  const large = largeOf(list([0, 0], [300, 0], [500, 0], [900, 0]));
  expect(tilesNear(large, [0, 0], 320)).toEqual(["0_0", "1_0"]);
  expect(tilesNear(large, [510, 0], 250)).toEqual(["2_0", "1_0"]);
  expect(tilesNear(large, [0, 0], 2000, 2)).toEqual(["0_0", "1_0"]);
  expect(tilesNear(large, [0, 0], 2000, 0)).toEqual(["0_0"]); // the nearest one always
});

test("the tiles around a building begin with its own", () => {
  const large = largeOf(list([300, 0], [0, 0], [500, 0], [900, 0]));
  expect(tilesAround(large, "b0")[0]).toBe("1_0");
  expect(tilesAround(large, "b0").sort()).toEqual(["0_0", "1_0", "2_0"]);
  expect(tilesAround(large, "none")).toEqual([]);
});
