import * as THREE from "three";
import { expect, test } from "vitest";
import { seenAt } from "./still";

const eye = () => {
  const camera = new THREE.PerspectiveCamera(60, 2, 0.1, 1000);
  camera.position.set(0, 0, 100);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  return camera;
};
const box = (...[x0, y0, z0, x1, y1, z1]: [number, number, number, number, number, number]) =>
  new THREE.Box3(new THREE.Vector3(x0, y0, z0), new THREE.Vector3(x1, y1, z1));

test("a box is seen in a rectangle that has it and a margin", () => {
  const half = 300 / 2 / Math.tan(Math.PI / 6) / 100; // pixels of a metre at the distance of the box
  expect(seenAt([box(-10, 0, 0, 10, 5, 0)], eye(), 600, 300)).toEqual({
    left: Math.floor(300 - 10 * half - 8),
    bottom: 142,
    right: Math.ceil(300 + 10 * half + 8),
    top: Math.ceil(150 + 5 * half + 8),
  });
});

test("several boxes are in one rectangle, within the canvas", () => {
  const seen = seenAt([box(-1000, 0, 0, -900, 1, 1), box(0, -2, 0, 1, 0, 1)], eye(), 600, 300);
  expect(seen.left).toBe(0);
  expect(seen.right).toBeGreaterThan(300);
  expect(seen.right).toBeLessThan(330);
});

test("where a box reaches behind the camera, it may be seen everywhere", () => {
  expect(seenAt([box(0, 0, 0, 1, 1, 200)], eye(), 600, 300)).toEqual({ left: 0, bottom: 0, right: 600, top: 300 });
});

test("nothing is seen of no boxes and of empty ones", () => {
  const none = { left: 0, bottom: 0, right: 0, top: 0 };
  expect(seenAt([], eye(), 600, 300)).toEqual(none);
  expect(seenAt([new THREE.Box3()], eye(), 600, 300)).toEqual(none);
});
