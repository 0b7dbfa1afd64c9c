import { beforeEach, expect, test } from "vitest";
import { addPoint, angleOf, areaOf, lengthOf, measure, points, removePoint, results } from "./measure";

beforeEach(() => measure(null));

test("distances, heights and slopes", () => {
  expect(lengthOf([[0, 0, 0], [3, 4, 0], [3, 4, 2]])).toBe(7);
  expect(results("distance", [[0, 0, 0], [3, 0, 4]])).toEqual([["Distance", "5.00 m"], ["In plan", "3.00 m"], ["Height difference", "4.00 m"]]);
  expect(results("height", [[0, 0, 6], [3, 0, 3]])).toEqual([["Height difference", "−3.00 m"], ["In plan", "3.00 m"], ["Slope", "45.0°"]]);
  expect(results("distance", [[0, 0, 0]])).toEqual([]);
});

test("angles and areas in space", () => {
  expect(angleOf([1, 0, 0], [0, 0, 0], [0, 0, 5])).toBeCloseTo(90);
  expect(areaOf([[0, 0, 0], [4, 0, 0], [4, 3, 3], [0, 3, 3]])).toBeCloseTo(4 * Math.hypot(3, 3));
  expect(results("area", [[0, 0, 0], [4, 0, 0], [4, 3, 3], [0, 3, 3]])[1]).toEqual(["In plan", "12.00 m²"]);
});

test("after its last point a tool begins again", () => {
  measure("height");
  addPoint([0, 0, 0]);
  addPoint([0, 0, 1]);
  addPoint([5, 5, 5]);
  expect(points.value).toEqual([[5, 5, 5]]);
  removePoint();
  expect(points.value).toEqual([]);
});
