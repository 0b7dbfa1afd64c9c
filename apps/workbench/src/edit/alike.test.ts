import { expect, test } from "vitest";
import type { Plan, Point2 } from "../api/types";
import { alike, alongRow, annex, correspondence, roofOf, rowOf, shapeOf } from "./alike";
import { planFault } from "./check";
import { house } from "./house_for_tests";
import { eavesOf, shaped } from "./shapes";

const at = (plan: Plan, change: (p: Point2) => Point2): Plan => ({ ...plan, outer: { ...plan.outer, points: plan.outer.points.map(change) } });
const place = (building: string, plan: Plan) => ({ building, part: `${building}-1`, plan });

test("a row is what is joined by walls", () => {
  const row = [0, 1, 2].map((i) => place(`h${i}`, at(house(), ([x, y]) => [x + 10 * i, y])));
  const apart = place("far", at(house(), ([x, y]) => [x + 40, y]));
  const corner = place("corner", at(house(), ([x, y]) => [x + 30, y + 8]));
  expect(rowOf(row[1]!, [...row, apart, corner]).map((p) => p.building)).toEqual(["h1", "h0", "h2"]);
});

test("corresponding edges are found in a turned and in a mirrored plan", () => {
  const l: Point2[] = [[0, 0], [9, 0], [9, 4], [5, 4], [5, 7], [0, 7]];
  const turned = [2, 3, 4, 5, 0, 1].map((i): Point2 => [-l[i]![1], l[i]![0]]);
  expect(correspondence(l, turned)).toEqual({ edges: [2, 3, 4, 5, 0, 1], mirrored: false });
  const mirrored = [...l].reverse().map(([x, y]): Point2 => [-x, y]);
  // Edge i of the mirrored plan runs from old corner 5 − i to 4 − i: the old edge 4 − i.
  expect(correspondence(l, mirrored)).toEqual({ edges: [4, 3, 2, 1, 0, 5], mirrored: true });
  expect(correspondence(l, l.slice(1))).toBeNull();
});

test("with as many corners the profiles are those of the corresponding edges, and outline and base stay", () => {
  const other: Plan = { ...shaped(at(house(), ([x, y]) => [-y * 1.1 + 50, x]), "flat"), base: 3 };
  const made = alike(house(), other, [], []);
  expect(planFault(made, "made")).toBeNull();
  expect(made.base).toBe(3);
  expect(made.outer.points).toEqual(other.outer.points);
  expect(made.cap).toBe(house().cap);
  made.outer.profile_of_edge.forEach((p, i) =>
    expect(made.profiles[p], `edge ${i}`).toEqual(house().profiles[house().outer.profile_of_edge[i]!]),
  );
});

test("with other corners the shape, the eaves and the pitch are the same", () => {
  const l: Plan = { ...house(), outer: { points: [[0, 0], [9, 0], [9, 4], [5, 4], [5, 7], [0, 7]], profile_of_edge: [1, 1, 1, 1, 1, 1] } };
  const hip = shaped(house(), "hip");
  const made = alike(hip, l, [], []);
  expect(planFault(made, "made")).toBeNull();
  expect(eavesOf(made)).toBe(eavesOf(hip));
  expect(roofOf(made).pitch).toBeCloseTo(roofOf(hip).pitch!);
  expect(shapeOf(made)).toBe("hip");
  for (const shape of ["flat", "gable", "hip", "mansard"] as const) expect(shapeOf(shaped(house(), shape)), shape).toBe(shape);
});

test("the ridge of a row runs through its houses, also through those that are deeper than wide", () => {
  const deep = at(house(), ([x, y]) => [x * 0.5, y * 1.5]); // 5 wide, 12 deep
  const shared = [false, true, false, true]; // neighbours on both sides
  expect(alongRow(deep, shared)).toEqual([true, false, true, false]);
  const row = shaped(deep, "gable", (i) => shared[i]!, {}, alongRow(deep, shared)!);
  expect(row.outer.profile_of_edge.map((p) => row.profiles[p]!.length > 2)).toEqual([true, false, true, false]);
  expect(alongRow(deep, [])).toBeNull();
});

test("an annex has a new name, walls and a flat roof", () => {
  const parts = [{ id: "h-1", plan: house() }, { id: "h-4", plan: house() }];
  const { id, plan } = annex("h", parts, [[10, 0], [10, 3], [13, 3], [13, 0]], 1.25, 3);
  expect(id).toBe("h-5");
  expect(planFault(plan, id)).toBeNull();
  expect(plan.cap).toBe(3);
  expect(plan.base).toBe(1.25);
});
