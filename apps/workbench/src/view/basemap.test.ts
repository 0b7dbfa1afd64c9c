import { expect, test } from "vitest";
import { decodeBasemap } from "./basemap";

const bytes = (...edges: number[]) => new Uint8Array([...new Uint8Array(Float64Array.from(edges).buffer), 1, 2, 3]).buffer;

test("a basemap has its edges and a picture", () => {
  expect(decodeBasemap(bytes(-10, 5, 30, 25))).toEqual({ west: -10, south: 5, east: 30, north: 25, image: new Uint8Array([1, 2, 3]) });
});

test("damaged basemaps are not shown", () => {
  expect(decodeBasemap(new ArrayBuffer(0))).toBeNull();
  expect(decodeBasemap(Float64Array.from([0, 0, 1, 1]).buffer)).toBeNull(); // without a picture
  expect(decodeBasemap(bytes(0, 0, 0, 1))).toBeNull();
  expect(decodeBasemap(bytes(0, Number.NaN, 1, 1))).toBeNull();
});
