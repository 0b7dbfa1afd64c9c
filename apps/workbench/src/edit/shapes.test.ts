import { expect, test } from "vitest";
import type { Plan } from "../api/types";
import { planFault } from "./check";
import { eavesOf, shaped, shapes, sharedEdges } from "./shapes";

const house = (x0: number, x1: number): Plan => ({
  base: 0,
  cap: 9,
  outer: { points: [[x0, 0], [x1, 0], [x1, 6], [x0, 6]], profile_of_edge: [0, 1, 0, 1] },
  holes: [],
  profiles: [
    [[0, 0], [0, 5], [3, 8]],
    [[0, 0], [0, 9]],
  ],
});
const kinds = (plan: Plan) => plan.outer.profile_of_edge.map((p) => (plan.profiles[p]!.length > 2 ? "slope" : "wall"));

test("every shape is a valid plan with the same outline and eaves", () => {
  for (const { shape } of shapes) {
    const plan = shaped(house(0, 10), shape);
    expect(planFault(plan, shape)).toBeNull();
    expect(plan.outer.points).toEqual(house(0, 10).outer.points);
    if (shape !== "flat") expect(eavesOf(plan)).toBe(5);
  }
});

test("gables are across the longest edge, hips all around", () => {
  expect(kinds(shaped(house(0, 10), "gable"))).toEqual(["slope", "wall", "slope", "wall"]);
  expect(kinds(shaped(house(0, 4), "gable"))).toEqual(["wall", "slope", "wall", "slope"]);
  expect(kinds(shaped(house(0, 10), "hip"))).toEqual(["slope", "slope", "slope", "slope"]);
  expect(shaped(house(0, 10), "flat").cap).toBe(5);
});

test("a shed slopes one way, and a gambrel as a gable does", () => {
  expect(kinds(shaped(house(0, 10), "shed")).filter((k) => k === "slope")).toHaveLength(1);
  expect(kinds(shaped(house(0, 10), "shed", (i) => i === 0))).toEqual(["wall", "wall", "slope", "wall"]);
  expect(kinds(shaped(house(0, 10), "gambrel"))).toEqual(["slope", "wall", "slope", "wall"]);
});

test("ends of a half-hip and of a gablet are upright for half of the gable's height", () => {
  const halfHip = shaped(house(0, 10), "half-hip");
  const end = halfHip.profiles[halfHip.outer.profile_of_edge[1]!]!;
  expect(end[1]![1]).toBeCloseTo(5 + 1.5); // the gable over 6 m at 45° is 3 m high
  expect(end.at(-1)![0]).toBeGreaterThan(0);
  const gablet = shaped(house(0, 10), "gablet");
  expect(gablet.profiles[gablet.outer.profile_of_edge[3]!]!.slice(1, 3)).toEqual([[0, 5], [1.5, 6.5]]);
  expect(kinds(shaped(house(0, 10), "half-hip", (i) => i === 1))).toEqual(["slope", "wall", "slope", "slope"]);
});

test("the pitch of the part stays", () => {
  const [, slope] = shaped(house(0, 10), "hip").profiles;
  expect((slope![2]![1] - slope![1]![1]) / (slope![2]![0] - slope![1]![0])).toBeCloseTo(1);
});

test("walls to neighbours stay walls", () => {
  const shared = sharedEdges(house(0, 10), [house(10, 20)]);
  expect(shared).toEqual([false, true, false, false]);
  expect(kinds(shaped(house(0, 10), "hip", (i) => shared[i]!))).toEqual(["slope", "wall", "slope", "slope"]);
});
