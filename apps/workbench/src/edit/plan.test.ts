import { describe, expect, it } from "vitest";
import type { Plan } from "../api/types";
import { courtyardHouse, gable, house, roof, withCorners } from "./house_for_tests";
import {
  addHole,
  changeProfiles,
  clean,
  collinear,
  deleteVertex,
  depthBehind,
  edgesOf,
  inScope,
  insertVertex,
  moveEdge,
  moveVertex,
  opposite,
  oriented,
  planArea,
  profileOf,
  removeHole,
  setProfile,
  sharedWall,
} from "./plan";
import { withGutter, type Profile } from "./profile";
import { area } from "./vector";

const steeper: Profile = [
  [0, 0],
  [0, 6],
  [2, 10],
];
const at = (edge: number, ring = 0) => ({ ring, edge });
const profiles = (plan: Plan) => edgesOf(plan).map((e) => profileOf(plan, e));

describe("corners", () => {
  it("move alone; the original plan is unchanged", () => {
    const before = house();
    const moved = moveVertex(before, at(2), [11, 9]);
    expect(moved.outer.points[2]).toEqual([11, 9]);
    expect(before).toEqual(house());
  });

  it("inserted on an edge give both halves its profile", () => {
    const plan = insertVertex(house(), at(0), [5, 0]);
    expect(plan.outer.points[1]).toEqual([5, 0]);
    expect(profiles(plan)).toEqual([roof, roof, gable, roof, gable]);
  });

  it("inserted on the last edge come last", () => {
    const plan = insertVertex(house(), at(3), [0, 4]);
    expect(plan.outer.points[4]).toEqual([0, 4]);
    expect(profiles(plan)).toEqual([roof, gable, roof, gable, gable]);
  });

  it("deleted leave the profile of the longer edge", () => {
    expect(profiles(deleteVertex(house(), at(1))!)).toEqual([roof, roof, gable]); // 10 m of roof, 8 m of gable
    expect(profiles(deleteVertex(house(), at(2))!)).toEqual([roof, roof, gable]);
    expect(profiles(deleteVertex(house(), at(0))!)).toEqual([gable, roof, roof]);
  });

  it("keep overhangs with their edges", () => {
    const eaves = { ...house(), outer: { ...house().outer, overhang_of_edge: [0.4, 0, 0.6, 0] } };
    expect(insertVertex(eaves, at(2), [5, 8]).outer.overhang_of_edge).toEqual([0.4, 0, 0.6, 0.6, 0]);
    expect(deleteVertex(eaves, at(1))!.outer.overhang_of_edge).toEqual([0.4, 0.6, 0]);
    expect(clean(eaves).outer.overhang_of_edge).toEqual([0.4, 0, 0.6, 0]);
    expect(setProfile(eaves, [at(1)], steeper).outer.overhang_of_edge).toEqual([0.4, 0, 0.6, 0]);
    const backward = { ...eaves, outer: { ...eaves.outer, points: [...eaves.outer.points].reverse() } };
    expect(oriented(backward).outer.overhang_of_edge).toEqual([0.6, 0, 0.4, 0]);
    expect(insertVertex(house(), at(0), [5, 0]).outer).not.toHaveProperty("overhang_of_edge");
  });

  it("of a triangle cannot be deleted; of a triangular hole, they delete the hole", () => {
    const triangle = withCorners([
      [0, 0],
      [10, 0],
      [0, 8],
    ]);
    expect(deleteVertex(triangle, at(1))).toBeNull();
    const holed = deleteVertex(courtyardHouse(), at(0, 1))!;
    expect(holed.holes[0]?.points).toHaveLength(3);
    expect(deleteVertex(holed, at(0, 1))?.holes).toHaveLength(0);
  });

  it("inserted and deleted again leave the same plan", () => {
    expect(deleteVertex(insertVertex(house(), at(1), [10, 4]), at(2))).toEqual(house());
  });
});

describe("edges", () => {
  it("move inwards in outlines and holes; their neighbours keep their directions", () => {
    expect(moveEdge(house(), at(0), 1).outer.points).toEqual([
      [0, 1],
      [10, 1],
      [10, 8],
      [0, 8],
    ]);
    expect(planArea(moveEdge(house(), at(1), -2))).toBeCloseTo(96);
    // Inwards of the solid: the courtyard becomes larger.
    expect(planArea(moveEdge(courtyardHouse(), at(0, 1), 1))).toBeCloseTo(80 - 6);
  });

  it("move along slanted neighbours", () => {
    const slanted = withCorners([
      [0, 0],
      [10, 0],
      [8, 4],
      [2, 4],
    ]);
    const points = moveEdge(slanted, at(2), -2).outer.points;
    expect(points[2]![0]).toBeCloseTo(7);
    expect(points[3]![0]).toBeCloseTo(3);
    expect(points[3]![1]).toBeCloseTo(6);
  });

  it("keep their length next to a nearly parallel neighbour", () => {
    const bent = withCorners([
      [0, 0],
      [5, 0],
      [10, 0.2],
      [10, 8],
      [0, 8],
    ]);
    const points = moveEdge(bent, at(0), 1).outer.points;
    expect(points[1]).toEqual([5, 1]);
    expect(points[0]).toEqual([0, 1]);
  });
});

describe("holes", () => {
  it("are stored clockwise with walls up to the cap, in whatever order they were drawn", () => {
    for (const turned of [false, true]) {
      const drawn: [number, number][] = [
        [4, 3],
        [6, 3],
        [6, 5],
        [4, 5],
      ];
      const plan = addHole(house(), turned ? drawn.reverse() : drawn);
      expect(area(plan.holes[0]!.points)).toBeCloseTo(-4);
      expect(planArea(plan)).toBeCloseTo(76);
      expect(profileOf(plan, at(0, 1))).toEqual([
        [0, 0],
        [0, 12],
      ]);
    }
  });

  it("leave no unused profile when they are filled", () => {
    const plan = addHole(house(), [
      [4, 3],
      [6, 3],
      [5, 5],
    ]);
    expect(removeHole(plan, 1)).toEqual(house());
  });
});

describe("profiles", () => {
  it("are changed for one edge and not for others that shared them", () => {
    const plan = setProfile(house(), [at(0)], steeper);
    expect(profiles(plan)).toEqual([steeper, gable, roof, gable]);
    expect(plan.profiles).toHaveLength(3);
  });

  it("are changed for all edges that share them, or for all edges", () => {
    const sharing = inScope(house(), at(0), "sharing");
    expect(sharing).toEqual([at(0), at(2)]);
    expect(profiles(setProfile(house(), sharing, steeper))).toEqual([steeper, gable, steeper, gable]);
    const apart = { ...house(), profiles: [roof, gable, [...roof]] };
    apart.outer = { ...apart.outer, profile_of_edge: [0, 1, 2, 1] };
    expect(inScope(apart, at(0), "sharing")).toEqual([at(0), at(2)]);
    const all = setProfile(courtyardHouse(), inScope(courtyardHouse(), at(0), "part"), steeper);
    expect(profiles(all)).toEqual(Array(8).fill(steeper));
    expect(all.profiles).toEqual([steeper]);
  });

  it("are shared again when they become equal", () => {
    expect(setProfile(setProfile(house(), [at(0)], steeper), [at(0)], roof)).toEqual(house());
  });

  it("of several edges are changed separately", () => {
    const plan = setProfile(house(), [at(2)], steeper);
    const raised = changeProfiles(plan, edgesOf(plan), (p) => (p === gable ? null : withGutter(p, 7)));
    expect(profiles(raised).map((p) => p!.at(-1))).toEqual([
      [4, 11],
      [0, 10],
      [2, 11],
      [0, 10],
    ]);
  });

  it("without an edge are removed and equal ones merged", () => {
    const plan: Plan = { ...house(), profiles: [steeper, roof, [...roof], gable] };
    plan.outer = { ...plan.outer, profile_of_edge: [1, 3, 2, 3] };
    expect(clean(plan)).toEqual(house());
  });
});

describe("a plan with reversed orientation", () => {
  it("is made counter-clockwise; every edge keeps its profile", () => {
    const plan = withCorners([
      [0, 0],
      [0, 8],
      [10, 0],
    ]);
    const turned = oriented({ ...plan, outer: { ...plan.outer, profile_of_edge: [0, 1, 1] } });
    expect(area(turned.outer.points)).toBeCloseTo(40);
    // The edge between (0, 0) and (0, 8) had profile 0.
    const first = turned.outer.points.findIndex((p) => p[0] === 0 && p[1] === 8);
    expect(turned.outer.profile_of_edge[first]).toBe(0);
    expect(turned.outer.profile_of_edge.filter((p) => p === 1)).toHaveLength(2);
  });

  it("is unchanged if the orientation is right", () => {
    expect(oriented(courtyardHouse())).toEqual(courtyardHouse());
  });
});

describe("relations", () => {
  it("find opposite and collinear edges", () => {
    expect(opposite(house(), at(0))).toEqual([at(2)]);
    const stepped = withCorners([
      [0, 0],
      [4, 0],
      [4, 1],
      [6, 1],
      [6, 0],
      [10, 0],
      [10, 8],
      [0, 8],
    ]);
    expect(collinear(stepped, at(0))).toEqual([at(4)]);
    expect(opposite(stepped, at(6)).map((e) => e.edge)).toEqual([0, 2, 4]);
  });

  it("measure the shared wall of two parts", () => {
    const neighbour = withCorners([
      [10, 2],
      [20, 2],
      [20, 12],
      [10, 12],
    ]);
    expect(sharedWall(house(), neighbour)).toBeCloseTo(6);
    expect(
      sharedWall(
        house(),
        withCorners([
          [10, 8],
          [20, 8],
          [20, 12],
        ]),
      ),
    ).toBeCloseTo(0);
  });

  it("measure how far the footprint reaches behind an edge", () => {
    expect([0, 1, 2, 3].map((e) => depthBehind(house(), at(e)))).toEqual([8, 10, 8, 10]);
    expect(depthBehind(courtyardHouse(), { ring: 1, edge: 0 })).toBeCloseTo(4); // the wall of the court at x = 4 looks west
  });
});
