import { describe, expect, it } from "vitest";
import type { SceneFootprint } from "../api/types";
import type { Vector } from "./camera";
import { building } from "./fixtures";
import { type Ray, pick, pickFootprint } from "./pick";

const ray = (origin: Vector, to: Vector): Ray => {
  const d = to.map((t, i) => t - origin[i]!) as Vector;
  const length = Math.hypot(...d);
  return { origin, direction: d.map((x) => x / length) as Vector };
};
const moved = (id: string, by: number) => {
  const b = building(id);
  const part = b.parts[0]!;
  const positions = part.geometry!.positions.map((x, i) => (i % 3 === 1 ? x + by : x));
  return { ...b, parts: [{ ...part, geometry: { ...part.geometry!, positions } }] };
};

describe("picking", () => {
  it("gives the building, part and plan edge of the face hit", () => {
    const hit = pick(ray([5, -20, 10], [5, 1, 4]), [building("a")]);
    expect(hit).toMatchObject({ building: "a", part: "a-1", ring: 0, edge: 0 });
    expect(hit!.point[2]).toBeGreaterThan(3);
  });

  it("gives the nearest of several, in any order", () => {
    const street = [moved("far", 20), moved("near", 0), moved("farther", 40)];
    expect(pick(ray([5, -20, 1], [5, 100, 1]), street)!.building).toBe("near");
    expect(pick(ray([5, 90, 1], [5, -100, 1]), street)!.building).toBe("farther");
  });

  it("ignores hidden faces and what the section plane removes", () => {
    const through = ray([5, -20, 1], [5, 100, 1]);
    expect(pick(through, [building("a")], (f) => f.class !== "wall")).toBeNull();
    expect(pick(through, [moved("a", 0), moved("b", 20)], undefined, (p) => p[1] > 10)!.building).toBe("b");
  });

  it("has no edge for ground", () => {
    expect(pick(ray([5, 3, -5], [5, 3, 0]), [building("a")])!.edge).toBeNull();
  });

  it("finds nothing beside the building and behind the camera", () => {
    expect(pick(ray([5, -20, 1], [60, 0, 1]), [building("a")])).toBeNull();
    expect(pick(ray([5, -20, 1], [5, -40, 1]), [building("a")])).toBeNull();
  });

  it("finds the footprint under the ray, but not in its courtyard", () => {
    const footprint: SceneFootprint = {
      id: "f",
      block: "block-0",
      ground: 2,
      defect: null,
      polygons: [
        {
          outer: [[0, 0], [10, 0], [10, 10], [0, 10]],
          holes: [[[4, 4], [4, 6], [6, 6], [6, 4]]],
        },
      ],
    }; // prettier-ignore
    expect(pickFootprint(ray([1, 1, 50], [1, 1, 0]), [footprint])!.footprint.id).toBe("f");
    expect(pickFootprint(ray([5, 5, 50], [5, 5, 0]), [footprint])).toBeNull();
    expect(pickFootprint(ray([1, 1, 50], [1, 1, 90]), [footprint])).toBeNull();
  });
});
