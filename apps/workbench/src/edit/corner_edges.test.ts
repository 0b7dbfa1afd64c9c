import { describe, expect, it } from "vitest";
import type { Plan, Point2 } from "../api/types";
import { apart, cornerAt, isCornerEdge, together } from "./corner_edges";
import { obliqueHouse } from "./house_for_tests";
import { deleteVertex, insertVertex, moveEdge, moveVertex } from "./plan";
import { shaped } from "./shapes";
import { distance, minus, unit } from "./vector";

const at = (edge: number) => ({ ring: 0, edge });
const cornerEdges = (plan: Plan) => plan.outer.points.flatMap((_, i) => (isCornerEdge(plan.outer, i) ? [i] : []));
const direction = (plan: Plan, edge: number) =>
  unit(minus(plan.outer.points[(edge + 1) % plan.outer.points.length]!, plan.outer.points[edge]!))!;
const near = (a: Point2, b: Point2) => distance(a, b) < 1e-6;

describe("corner edges", () => {
  it("are shorter than a millimetre, at their corner", () => {
    const plan = obliqueHouse();
    expect(cornerEdges(plan)).toEqual([3]);
    expect(plan.outer.profile_of_edge).toEqual([0, 1, 1, 0, 1]);
    expect(near(cornerAt(plan.outer, 3), [0, 10])).toBe(true);
    expect(direction(plan, 3)[0]).toBeCloseTo(-1, 6);
  });

  it("are taken off and put back", () => {
    const { plan, corners, numberOf } = apart(obliqueHouse());
    expect(plan.outer.points.length).toBe(4);
    expect(near(plan.outer.points[3]!, [0, 10])).toBe(true);
    expect([0, 1, 2, 3, 4].map((i) => numberOf(0, i))).toEqual([0, 1, 2, 3, 3]);
    const again = together(plan, corners);
    expect(again.outer.points.every((p, i) => near(p, obliqueHouse().outer.points[i]!))).toBe(true);
  });

  it("keep the number of the last edge, before corner 0", () => {
    const { outer } = obliqueHouse();
    const turn = <T>(values: T[]) => [...values.slice(4), ...values.slice(0, 4)];
    const last = { ...obliqueHouse(), outer: { points: turn(outer.points), profile_of_edge: turn(outer.profile_of_edge) } };
    expect(cornerEdges(last)).toEqual([4]);
    const moved = moveVertex(last, at(0), [-1, 11]);
    expect(cornerEdges(moved)).toEqual([4]);
    expect(moved.outer.profile_of_edge).toEqual(last.outer.profile_of_edge);
    expect(near(cornerAt(moved.outer, 4), [-1, 11])).toBe(true);
  });

  it("go with their corner, whichever of both points is dragged", () => {
    for (const edge of [3, 4]) {
      const moved = moveVertex(obliqueHouse(), at(edge), [-2, 12]);
      expect(cornerEdges(moved)).toEqual([3]);
      expect(near(cornerAt(moved.outer, 3), [-2, 12])).toBe(true);
      expect(direction(moved, 3)[0]).toBeCloseTo(-1, 6);
    }
  });

  it("stay as short when a wall beside them is moved", () => {
    for (const [edge, by] of [
      [2, 1],
      [2, -3],
      [4, 0.5],
      [4, -2],
    ] as const) {
      const moved = moveEdge(obliqueHouse(), at(edge), by);
      expect(cornerEdges(moved)).toEqual([3]);
      expect(moved.outer.points.length).toBe(5);
    }
    expect(moveEdge(obliqueHouse(), at(3), 1)).toEqual(obliqueHouse());
  });

  it("turn with a wall that is dragged past them", () => {
    const moved = moveVertex(obliqueHouse(), at(2), [20, 11]); // the side now rises to the east
    expect(cornerEdges(moved)).toEqual([3]);
    expect(direction(moved, 3)[1]).toBeLessThan(0);
  });

  it("keep their place when corners are added and deleted", () => {
    const more = insertVertex(obliqueHouse(), at(0), [10, 0]);
    expect(cornerEdges(more)).toEqual([4]);
    expect(more.outer.profile_of_edge).toEqual([0, 0, 1, 1, 0, 1]);
    expect(cornerEdges(deleteVertex(more, at(1))!)).toEqual([3]);
    const less = deleteVertex(more, at(4))!;
    expect(cornerEdges(less)).toEqual([]);
    expect(less.outer.points.length).toBe(4);
  });
});

describe("another roof", () => {
  it("has sides where the walls are, and no direction of the roof before", () => {
    const hip = shaped(obliqueHouse(), "hip");
    expect(cornerEdges(hip)).toEqual([]);
    expect(hip.outer.points.length).toBe(4);
    const gabled = shaped(obliqueHouse(), "gable", (edge) => edge === 4); // the last wall has a neighbour
    expect(gabled.outer.profile_of_edge).toEqual([1, 0, 1, 0]);
  });
});
