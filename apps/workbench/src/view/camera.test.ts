import { describe, expect, it } from "vitest";
import * as camera from "./camera";
import type { Pose, Vector } from "./camera";

const pose: Pose = { target: [10, 20, 5], azimuth: 0.4, elevation: 0.8, size: 50, fov: camera.usualFov };

/** Position of a point in an image of the given height, in pixels from its middle: right and up. */
function seen(at: Pose, point: Vector, height: number): [number, number] {
  const eye = camera.eye(at);
  const ahead = camera.gaze(at);
  const right: Vector = [Math.cos(at.azimuth), -Math.sin(at.azimuth), 0];
  const up: Vector = [
    right[1] * ahead[2] - right[2] * ahead[1],
    right[2] * ahead[0] - right[0] * ahead[2],
    right[0] * ahead[1] - right[1] * ahead[0],
  ];
  const to = point.map((p, i) => p - eye[i]!) as Vector;
  const dot = (a: Vector, b: Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const scale = height / 2 / Math.tan(at.fov / 2) / dot(to, ahead);
  return [dot(to, right) * scale, dot(to, up) * scale];
}

describe("the camera", () => {
  it("has its target in the middle of the image", () => {
    expect(seen(pose, pose.target, 600)).toEqual([expect.closeTo(0), expect.closeTo(0)]);
  });

  it("shows a height of `size` metres at its target", () => {
    const level = { ...pose, azimuth: 0, elevation: 0 };
    expect(seen(level, [10, 20, 30], 600)[1]).toBeCloseTo(300);
  });

  it("keeps the ground under the pointer when it moves", () => {
    const before = seen(pose, [10, 20, 5], 600);
    const after = seen(camera.pan(pose, 6, -3, 600), [10, 20, 5], 600);
    expect(after[0] - before[0]).toBeCloseTo(6, 0);
    expect(after[1] - before[1]).toBeCloseTo(3, 0);
  });

  it("keeps the point under the pointer when it zooms", () => {
    const point: Vector = [18, 27, 5];
    const before = seen(pose, point, 600);
    const nearer = camera.zoom(pose, 0.5, point);
    expect(nearer.size).toBe(25);
    const after = seen(nearer, point, 600);
    expect(after[0]).toBeCloseTo(before[0], 6);
    expect(after[1]).toBeCloseTo(before[1], 6);
  });

  it("shows a framed box completely, from every direction", () => {
    for (const azimuth of [0, 0.7, 2, 4, 6]) {
      for (const elevation of [0.1, 0.7, 1.5]) {
        const framed = camera.frame({ ...pose, azimuth, elevation, fov: 0.1 }, [0, 0, 0], [40, 10, 8], 1.5);
        for (const x of [0, 40]) {
          for (const y of [0, 10]) {
            for (const z of [0, 8]) {
              const [right, up] = seen(framed, [x, y, z], 600);
              expect(Math.abs(right)).toBeLessThan(450);
              expect(Math.abs(up)).toBeLessThan(300);
            }
          }
        }
      }
    }
  });

  it("looks straight down from above, and has perspective again when tilted", () => {
    const above = camera.top(pose);
    expect(camera.isTop(above)).toBe(true);
    expect(camera.gaze(above)[2]).toBeCloseTo(-1);
    expect(camera.isTop(camera.orbit(above, 20, 0))).toBe(true);
    expect(camera.isTop(camera.orbit(above, 0, -40))).toBe(false);
  });

  it("rotates by the smaller angle in a flight", () => {
    const half = camera.mixed({ ...pose, azimuth: 0.1 }, { ...pose, azimuth: 2 * Math.PI - 0.1 }, 0.5);
    expect(half.azimuth).toBeCloseTo(0);
  });

  it("stops at its goal", () => {
    const goal = camera.zoom(camera.orbit(pose, 100, 40), 0.3, [0, 0, 0]);
    let now = pose;
    let steps = 0;
    while (!camera.same(now, goal)) {
      now = camera.mixed(now, goal, 0.25);
      expect(++steps).toBeLessThan(80);
    }
  });
});
