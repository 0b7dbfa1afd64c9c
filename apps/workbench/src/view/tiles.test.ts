import { describe, expect, it } from "vitest";
import { decode } from "./tiles";

function bytes(vertices: number, triangles: number, positions: number[], indices: number[]) {
  const buffer = new ArrayBuffer(8 + 4 * (positions.length + indices.length));
  const view = new DataView(buffer);
  view.setUint32(0, vertices, true);
  view.setUint32(4, triangles, true);
  positions.forEach((x, i) => view.setFloat32(8 + 4 * i, x, true));
  indices.forEach((x, i) => view.setUint32(8 + 4 * (positions.length + i), x, true));
  return buffer;
}

describe("the bytes of a tile", () => {
  it("are vertices and triangles", () => {
    const tile = decode(bytes(3, 1, [0, 0, 0, 1, 0, 0, 0, 1, 2], [0, 1, 2]))!;
    expect([...tile.positions]).toEqual([0, 0, 0, 1, 0, 0, 0, 1, 2]);
    expect([...tile.indices]).toEqual([0, 1, 2]);
  });

  it("are rejected if they are too short or too long", () => {
    const whole = bytes(3, 1, [0, 0, 0, 1, 0, 0, 0, 1, 2], [0, 1, 2]);
    for (const size of [0, 7, 8, 40, 55]) expect(decode(whole.slice(0, size))).toBeNull();
    expect(decode(bytes(3, 1, [0, 0, 0, 1, 0, 0, 0, 1, 2], [0, 1, 2, 3]))).toBeNull();
  });
});
