import { describe, expect, it } from "vitest";
import type { NamedPlan, Plan, Point2 } from "../api/types";
import { alike, correspondence, shapeOf } from "./alike";
import { planFault } from "./check";
import { apart } from "./corner_edges";
import { planeOf, variablePlane } from "./fitting";
import { gable, house, obliqueHouse, roof } from "./house_for_tests";
import { collinear, cornerEdgesOf, edgeName, endsOf, opposite, profileOf, wallsOf } from "./plan";
import { gutterOf, kindOf } from "./profile";
import { snapTurn, snapVertex, surroundings } from "./snap";
import { replaced, structuresOf, withDormer } from "./structures";
import { acrossTurned, bearingOf, liftOf, turned, turnedAt, turnedBy, turnedTo, wallBeside, withoutTurnedRoof, withTurnedRoof } from "./turned_roof";
import { distance, minus, rotated } from "./vector";

const at = (edge: number) => ({ ring: 0, edge });
const bearing = (plan: Plan, edge: number) => bearingOf(turnedAt(plan, at(edge))!.along);
const snap = { reach: 0.3, step: 0.01, grid: 0 };
/** The upper side of the house goes down by 2 m over 20 m: 5.71° from the ridge. */
const oblique = (Math.atan(0.1) * 180) / Math.PI;

describe("a corner edge", () => {
  it("is named, and is no wall", () => {
    expect(edgeName(obliqueHouse(), at(3))).toBe("corner edge 3");
    expect(wallsOf(obliqueHouse()).map((e) => e.edge)).toEqual([0, 1, 2, 4]);
    expect(cornerEdgesOf(obliqueHouse())).toEqual([at(3)]);
  });

  it("has a direction, clockwise from north", () => {
    expect(bearing(obliqueHouse(), 3)).toBeCloseTo(90, 4);
    expect(wallBeside(obliqueHouse(), at(3))).toMatchObject({ at: at(2) });
    expect(wallBeside(obliqueHouse(), at(3))!.degrees).toBeCloseTo(oblique, 3);
  });

  it("is turned at its corner, and stays between its walls", () => {
    const plan = obliqueHouse();
    for (const by of [0.5, 3, -20]) {
      const next = turnedBy(plan, at(3), by);
      expect(bearing(next, 3)).toBeCloseTo(90 + by, 3);
      expect(distance(turnedAt(next, at(3))!.corner, [0, 10])).toBeLessThan(1e-9);
      expect(next.outer.profile_of_edge).toEqual(plan.outer.profile_of_edge);
    }
    expect(wallBeside(turnedBy(plan, at(3), 60), at(3))!.degrees).toBeCloseTo(0.69, 1);
    expect(bearing(turnedBy(plan, at(3), -89.9), 3)).toBeCloseTo(0.69, 1);
    const behind = turned(plan, at(3), rotated([-1, 0], 3)); // on the other side of the corner
    expect(wallBeside(behind, at(3))!.degrees).toBeCloseTo(0.69, 1);
  });

  it("takes a typed direction either way round", () => {
    expect(bearing(turnedTo(obliqueHouse(), at(3), 80), 3)).toBeCloseTo(80, 3);
    expect(bearing(turnedTo(obliqueHouse(), at(3), 260), 3)).toBeCloseTo(80, 3);
    expect(bearing(turnedTo(obliqueHouse(), at(3), -100), 3)).toBeCloseTo(80, 3);
  });

  it("snaps to other directions, and otherwise to a tenth of a degree", () => {
    const plan = obliqueHouse();
    const way = (degrees: number): Point2 => rotated([-1, 0], (degrees * Math.PI) / 180);
    const near = snapTurn(plan, at(3), way(1.7), snap);
    expect(distance(near.along, [-1, 0])).toBeLessThan(1e-9);
    expect(near.guides.map((g) => g.words)).toEqual(["parallel to edge 0"]);
    const free = snapTurn(plan, at(3), way(23.4567), snap);
    expect(free.guides).toEqual([]);
    expect(bearingOf(free.along)).toBeCloseTo(66.5, 9);
    expect(bearingOf(snapTurn(plan, at(3), way(1.7), { ...snap, reach: 0 }).along)).toBeCloseTo(88.3, 9);
  });

  it("lifts a roof that it turns away from", () => {
    const plan = obliqueHouse();
    const next = turnedBy(plan, at(3), -5);
    expect(liftOf(next, at(3), [-1, 0], turnedAt(next, at(3))!.along)).toBeGreaterThan(1);
  });

  it("has a section across its eaves", () => {
    const across = acrossTurned(obliqueHouse(), at(3))!;
    const [a, b] = endsOf(across, at(0))!;
    expect(distance(a, [20, 10])).toBeLessThan(1e-3);
    expect(distance(b, [0, 10])).toBeLessThan(1e-3);
    expect(planFault(across, "section")).toBeNull();
  });
});

describe("other edges", () => {
  it("are not on the line of a corner edge, and can be opposite of it", () => {
    const plan = obliqueHouse();
    expect(collinear(plan, at(2))).toEqual([]);
    expect(planeOf(plan, at(3))).toEqual([at(3)]);
    expect(opposite(plan, at(0))).toEqual([at(2), at(3)]);
    expect(opposite(plan, at(3))).toEqual([at(0)]);
  });

  it("snap to one corner where a corner edge is", () => {
    const plan = obliqueHouse();
    expect(surroundings(plan, [], () => false).corners.length).toBe(4);
    const around = surroundings(plan, [], (e) => e.edge === 3);
    expect(around.corners.length).toBe(3);
    expect(around.edges.length).toBe(2);
    const snapped = snapVertex(plan, at(3), [0.1, 11], around, snap);
    expect(snapped.at[0]).toBeCloseTo(0, 9); // in line with the wall on the left
    expect(snapped.guides[0]!.words).toBe("right angle");
  });
});

describe("turning the roof of a wall", () => {
  const plain = (): Plan => withoutTurnedRoof(obliqueHouse(), at(3))!.plan;

  it("makes a corner edge, parallel to another side where there is one", () => {
    const [first, ...more] = withTurnedRoof(plain(), at(2));
    expect(first!.at).toEqual(at(3));
    expect(bearing(first!.plan, 3)).toBeCloseTo(90, 3);
    expect(profileOf(first!.plan, at(3))).toEqual(roof);
    expect(kindOf(profileOf(first!.plan, at(2))!)).toBe("wall");
    expect(more.length).toBeGreaterThan(3);
    for (const { plan, at: corner } of [first!, ...more]) {
      expect(planFault(plan, "h-1")).toBeNull();
      expect(edgeName(plan, corner)).toMatch(/^corner edge/);
      expect(wallBeside(plan, corner)!.degrees).toBeLessThan(20.1);
    }
  });

  it("is 5° where nothing is parallel, at any corner of the ring", () => {
    for (const edge of [0, 2]) {
      const [first] = withTurnedRoof(house(), at(edge));
      expect(wallBeside(first!.plan, first!.at)!.degrees).toBeCloseTo(5, 3);
      expect(first!.plan.outer.points.length).toBe(5);
      expect(first!.plan.outer.profile_of_edge.filter((p) => first!.plan.profiles[p]!.length === 3).length).toBe(2);
    }
  });

  it("is refused where there is no roof, or for a corner edge", () => {
    expect(withTurnedRoof(house(), at(1))).toEqual([]);
    expect(withTurnedRoof(obliqueHouse(), at(3))).toEqual([]);
  });

  it("is undone by removing the corner edge", () => {
    for (const edge of [0, 2])
      for (const { plan, at: corner } of withTurnedRoof(house(), at(edge))) {
        const back = withoutTurnedRoof(plan, corner)!;
        expect(back.at).toEqual(at(edge));
        expect(back.plan.profiles).toContainEqual(roof);
        expect(profileOf(back.plan, at(edge))).toEqual(roof);
        back.plan.outer.points.forEach((p, i) => expect(distance(p, house().outer.points[i]!)).toBeLessThan(1e-9));
      }
  });

  it("keeps overhangs", () => {
    const over = { ...house(), outer: { ...house().outer, overhang_of_edge: [0.4, 0, 0.3, 0] } };
    const [first] = withTurnedRoof(over, at(2));
    expect(first!.plan.outer.overhang_of_edge![first!.at.edge]).toBe(0.3);
    expect(withoutTurnedRoof(first!.plan, first!.at)!.plan.outer.overhang_of_edge).toEqual([0.4, 0, 0.3, 0]);
  });

  it("goes on along edges on one line", () => {
    const plan: Plan = { ...house(), outer: { points: [[0, 0], [5, 0], [10, 0], [10, 8], [0, 8]], profile_of_edge: [0, 0, 1, 0, 1] } };
    const [first] = withTurnedRoof(plan, at(0));
    expect(first!.plan.outer.profile_of_edge.filter((p) => kindOf(first!.plan.profiles[p]!) === "pitched").length).toBe(2);
    const back = withoutTurnedRoof(first!.plan, first!.at)!;
    expect(back.plan.outer.profile_of_edge).toEqual([0, 0, 1, 0, 1]);
  });
});

describe("what else a plan with corner edges does", () => {
  it("fits gutter, pitch and direction of its plane", () => {
    const parts: NamedPlan[] = [{ id: "h-1", plan: obliqueHouse() }];
    const variable = variablePlane(parts, "h-1", at(3), 11)!;
    expect(variable.start.length).toBe(3);
    const made = variable.made([5, 10, 2])!;
    const { plan } = made[0]!;
    expect(bearing(plan, 3)).toBeCloseTo(92, 3);
    expect(gutterOf(profileOf(plan, at(3))!)).toBe(5);
    expect(profileOf(plan, at(0))).toEqual(roof);
  });

  it("gives its roof to a plan like it, turned and mirrored", () => {
    const model = obliqueHouse();
    expect(shapeOf(model)).toBe("gable");
    const { plan: bare } = apart(model);
    for (const mirrored of [false, true]) {
      const moved = bare.outer.points.map(([x, y]): Point2 => (mirrored ? [x, -y] : [y + 100, -x]));
      const points = mirrored ? moved.reverse() : moved;
      const to: Plan = { ...bare, outer: { points, profile_of_edge: [1, 1, 1, 1] }, profiles: [roof, gable] };
      expect(correspondence(bare.outer.points, points)!.mirrored).toBe(mirrored);
      const same = alike(model, to, [], []);
      const [corner] = cornerEdgesOf(same);
      expect(corner, "a corner edge").toBeTruthy();
      expect(bearingOf(turnedAt(same, corner!)!.along)).toBeCloseTo(mirrored ? 90 : 0, 3);
      const before = distance(turnedAt(same, corner!)!.corner, mirrored ? [0, -10] : [110, 0]);
      expect(before).toBeLessThan(1e-6);
      expect(profileOf(same, corner!)).toEqual(roof);
    }
    // And a plan that had one loses it with its roof.
    expect(cornerEdgesOf(alike(bare, model, [], []))).toEqual([]);
  });

  it("has dormers on the plane of a corner edge, which follow it", () => {
    const plan = obliqueHouse();
    // The upper slope, from y = 10 at 6 m to the ridge at y = 5, of 45°.
    const geometry = {
      positions: [0, 10, 6, 20, 10, 6, 20, 5, 11, 0, 5, 11],
      triangles: [0, 2, 1, 0, 3, 2],
      face_of: [0, 0],
      faces: [{ loops: [[0, 3, 2, 1]], class: "roof" as const, ring: 0, edge: 3 }],
    };
    const made = withDormer("h", [{ id: "h-1", plan }], "h-1", geometry, [8, 9])!;
    expect(made, "a dormer").toBeTruthy();
    const own = structuresOf(made.parts);
    expect(own).toMatchObject([{ id: "h-2", host: "h-1", dormer: { ring: 0, edge: 3 } }]);
    const host = made.parts.find((p) => p.id === "h-1")!.plan;
    const next = replaced(made.parts, "h-1", turnedBy(host, at(3), 3));
    expect(next.lost).toEqual([]);
    expect(structuresOf(next.parts)).toMatchObject([{ dormer: { edge: 3 } }]);
    const front = next.parts.find((p) => p.id === "h-2")!.plan.outer.points;
    expect(bearingOf(minus(front[1]!, front[0]!))).toBeCloseTo(93, 2);
    // Where the corner edge is removed, the dormer is on the slope of the wall.
    const back = replaced(made.parts, "h-1", withoutTurnedRoof(host, at(3))!.plan);
    expect(structuresOf(back.parts)).toMatchObject([{ dormer: { edge: 2 } }]);
  });
});
