import { describe, expect, it } from "vitest";
import type { Geometry, NamedPlan, Plan, Point2 } from "../api/types";
import { planFault } from "./check";
import { house } from "./house_for_tests";
import { changeProfiles, edgesOf, insertVertex, moveAll, moveEdge, moveVertex, planArea, setProfile } from "./plan";
import { gutterOf, slopes, withGutter, type Profile } from "./profile";
import { shaped } from "./shapes";
import { bare, dormerBox, dormerRoof, faceOver, nearestDormer, removed, replaced, structureAt, structuresOf, withDormer, withDormerBox, withStructure } from "./structures";

// A dormer of Delft as `mansard reconstruct` wrote it (building b31bcc293 of data/delft): the plan of the roof, rounded by nothing,
// and what the kernel left of its hole. The house is drawn around it.
//
// The house of the tests has eaves at 6 m and slopes of 45° along edges 0 and 2.
const wall = (top: number): Profile => [[0, 0], [0, top]];
const host = (): Plan => ({
  ...house(),
  holes: [{ points: [[4, 1], [4, 2.5], [6, 2.5], [6, 1]], profile_of_edge: [2, 3, 2, 2] }],
  profiles: [...house().profiles, wall(9.5), [[0, 0], [0, 8.5], [4, 12.5]]],
});
const dormer = (): Plan => ({
  base: 1.25,
  cap: 8.5,
  outer: { points: [[4, 1], [6, 1], [6, 2.5], [4, 2.5]], profile_of_edge: [0, 0, 0, 0] },
  holes: [],
  profiles: [wall(8.5)],
});
const parts = (): NamedPlan[] => [{ id: "h-1", plan: host() }, { id: "h-2", plan: dormer() }];
const planOf = (all: readonly NamedPlan[], id: string) => all.find((p) => p.id === id)!.plan;
const close = (a: readonly Point2[], b: readonly Point2[]) =>
  a.forEach((p, i) => p.forEach((v, k) => expect(v, `corner ${i}`).toBeCloseTo(b[i]![k]!, 9)));

/** That the dormer fills its hole, whose back edge goes on with the slope where it reaches the eaves. */
function fits(all: readonly NamedPlan[], gutter = 6, slope = 1) {
  const own = structureAt(all, "h-2")!;
  expect(own, "it is a dormer").toMatchObject({ host: "h-1" });
  expect(own.dormer).not.toBeNull();
  for (const p of all) expect(planFault(p.plan, p.id)).toBeNull();
  const hole = planOf(all, "h-1").holes[own.ring - 1]!;
  const back = hole.profile_of_edge.map((p) => planOf(all, "h-1").profiles[p]!).filter((p) => slopes(p).length);
  expect(back.length).toBe(1);
  const eaves = gutterOf(back[0]!)!;
  expect(slopes(back[0]!)[0]).toBeCloseTo(slope, 12);
  expect(Math.max(...hole.points.map((p) => p[1])), "where the slope is as high as the eaves").toBeCloseTo((eaves - gutter) / slope, 9);
  return eaves;
}
/** A model of the host without walls: two slopes that meet at y = 4. */
const geometry = (): Geometry => ({
  positions: [0, 0, 7.25, 10, 0, 7.25, 10, 4, 11.25, 0, 4, 11.25, 10, 8, 7.25, 0, 8, 7.25],
  triangles: [0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5],
  face_of: [0, 0, 1, 1],
  faces: [
    { loops: [[0, 1, 2, 3]], class: "roof", ring: 0, edge: 0 },
    { loops: [[3, 2, 4, 5]], class: "roof", ring: 0, edge: 2 },
  ],
});

describe("a dormer", () => {
  it("is a part in a hole whose back continues a slope, also if its corners were rounded", () => {
    expect(structuresOf(parts())).toMatchObject([{ id: "h-2", host: "h-1", ring: 1, dormer: { ring: 0, edge: 0 } }]);
    const rounded = parts();
    rounded[1]!.plan.outer.points = dormer().outer.points.map(([x, y]) => [x + 8e-6, y - 5e-6]);
    expect(structureAt(rounded, "h-2")!.dormer).not.toBeNull();
    const beside = parts();
    beside[1]!.plan = moveAll(dormer(), [20, 0]);
    expect(structuresOf(beside)).toEqual([]);
  });

  it("is written as the pipeline writes it: an unchanged box gives the same plans", () => {
    // data/delft, building b31bcc293: what `reconstruct` wrote, without the other profiles of the house.
    const points: Point2[] = [[-12.905612671747804, 18.164621892385185], [-13.719219909980893, 17.6040323888883], [-15.224955768324435, 19.789370473474264], [-14.411348530091345, 20.34995997697115]];
    const back: Profile = [[0, 0], [0, 7.438249883656644], [2.1, 9.538506328788381]];
    const along: Point2 = [points[2]![0] - points[1]![0], points[2]![1] - points[1]![1]];
    const long = Math.hypot(...along);
    const [ax, ay] = [along[0] / long, along[1] / long];
    const slope = (9.538506328788381 - 7.438249883656644) / 2.1;
    const start = 5; // m from the back of the hole to the eaves
    const at = (u: number, v: number): Point2 => [points[1]![0] + u * ax - v * ay, points[1]![1] + u * ay + v * ax];
    const gutter = 7.438249883656644 - slope * start;
    const roof: Profile = [[0, 0], [0, gutter], [2.1, gutter + 9.538506328788381 - 7.438249883656644]];
    const delft: NamedPlan[] = [
      {
        id: "h-1",
        plan: {
          base: 0.1953125,
          cap: 14,
          outer: { points: [at(-4, -start), at(8, -start), at(8, 4), at(-4, 4)], profile_of_edge: [0, 1, 1, 1] },
          holes: [{ points, profile_of_edge: [2, 3, 2, 2] }],
          profiles: [roof, wall(14), wall(8.438249883656644), back],
        },
      },
      {
        id: "h-2",
        plan: {
          base: 0.1953125,
          cap: 7.438249883656644,
          outer: {
            points: [[-12.905622582882643, 18.164622922427952], [-14.411358440294862, 20.349961007013917], [-15.224965678527951, 19.78937150351703], [-13.71922982018441, 17.604033418931067]],
            profile_of_edge: [0, 0, 0, 0],
          },
          holes: [],
          profiles: [wall(7.438249883656644)],
        },
      },
    ];
    expect(structureAt(delft, "h-2")!.dormer).toMatchObject({ edge: 0 });
    const again = replaced(delft, "h-2", moveAll(planOf(delft, "h-2"), [0, 0])).parts;
    const hole = planOf(again, "h-1").holes[0]!;
    hole.points.forEach((p) => expect(Math.min(...points.map((q) => Math.hypot(p[0] - q[0], p[1] - q[1])))).toBeLessThan(3e-5));
    const profiles = hole.profile_of_edge.map((p) => planOf(again, "h-1").profiles[p]!);
    expect(profiles.map((p) => slopes(p).length)).toEqual([0, 1, 0, 0]);
    expect(profiles[0]![1]![1]).toBeCloseTo(8.438249883656644, 9);
    profiles[1]!.forEach((p, i) => p.forEach((v, k) => expect(v).toBeCloseTo(back[i]![k]!, 9)));
    expect(planOf(again, "h-2").cap).toBe(7.438249883656644);
  });

  it("moves along the eaves, and up the slope with its own eaves", () => {
    const along = replaced(parts(), "h-2", moveAll(dormer(), [1.5, 0])).parts;
    expect(fits(along)).toBeCloseTo(8.5);
    close(planOf(along, "h-2").outer.points, dormer().outer.points.map(([x, y]) => [x + 1.5, y]));
    const up = replaced(parts(), "h-2", moveAll(dormer(), [0, 0.5])).parts;
    expect(fits(up)).toBeCloseTo(9);
    expect(planOf(up, "h-2").cap).toBeCloseTo(9);
    // There and back again is the dormer as it was.
    const back = replaced(up, "h-2", moveAll(planOf(up, "h-2"), [0, -0.5])).parts;
    expect(fits(back)).toBeCloseTo(8.5, 9);
    close(planOf(back, "h-1").holes[0]!.points, host().holes[0]!.points);
  });

  it("stays a rectangle on its slope when a wall or a corner is dragged", () => {
    const wide = replaced(parts(), "h-2", moveEdge(dormer(), { ring: 0, edge: 1 }, -0.7)).parts; // the right wall, outwards
    expect(fits(wide)).toBeCloseTo(8.5);
    close(planOf(wide, "h-2").outer.points, [[4, 1], [6.7, 1], [6.7, 2.5], [4, 2.5]]);
    const corner = replaced(parts(), "h-2", moveVertex(dormer(), { ring: 0, edge: 0 }, [3.5, 0.6])).parts;
    expect(fits(corner)).toBeCloseTo(8.5);
    close(planOf(corner, "h-2").outer.points, [[3.5, 0.6], [6, 0.6], [6, 2.5], [3.5, 2.5]]);
    const back = replaced(parts(), "h-2", moveEdge(dormer(), { ring: 0, edge: 2 }, -0.5)).parts; // the back, up the slope
    expect(fits(back), "which raises the eaves").toBeCloseTo(9);
    const crossed = replaced(parts(), "h-2", moveEdge(dormer(), { ring: 0, edge: 1 }, 5)).parts;
    fits(crossed); // stops before the other wall
    const low = replaced(parts(), "h-2", { ...dormer(), cap: 3 }).parts;
    expect(fits(low), "stays above the slope at its front").toBeCloseTo(7.1);
  });

  it("gets another height by its cap, by a wall, and by the gutters of a gable", () => {
    expect(fits(replaced(parts(), "h-2", { ...dormer(), cap: 9 }).parts)).toBeCloseTo(9);
    const byWall = setProfile(dormer(), [{ ring: 0, edge: 0 }], wall(8.2));
    expect(fits(replaced(parts(), "h-2", byWall).parts)).toBeCloseTo(8.2);
    const gabled = replaced(parts(), "h-2", dormerRoof(parts(), "h-2", "gable")!).parts;
    expect(fits(gabled), "the eaves stay").toBeCloseTo(8.5);
    const sides = planOf(gabled, "h-2");
    expect(sides.outer.profile_of_edge.map((p) => slopes(sides.profiles[p]!).length)).toEqual([0, 1, 0, 1]);
    const higher = changeProfiles(sides, [{ ring: 0, edge: 1 }], (p) => withGutter(p, 9));
    const raised = replaced(gabled, "h-2", higher).parts;
    expect(fits(raised)).toBeCloseTo(9);
    for (const p of planOf(raised, "h-2").profiles) expect(gutterOf(p) ?? p.at(-1)![1]).toBeCloseTo(9);
    const flat = replaced(raised, "h-2", dormerRoof(raised, "h-2", "flat")!).parts;
    expect(fits(flat)).toBeCloseTo(9);
    expect(planOf(flat, "h-2").cap).toBeCloseTo(9);
  });

  it("goes up with the gutter of its roof, and keeps the rise of its front with another pitch", () => {
    const higher = changeProfiles(host(), edgesOf(host()), (p) => (gutterOf(p) === null ? null : withGutter(p, 7)));
    expect(fits(replaced(parts(), "h-1", higher).parts, 7)).toBeCloseTo(9.5);
    const steep = setProfile(host(), [{ ring: 0, edge: 0 }, { ring: 0, edge: 2 }], [[0, 0], [0, 6], [4, 12]]);
    const at = replaced(parts(), "h-1", { ...steep, cap: 14 }).parts;
    // 1.5 m above the slope at y = 1, as before: 6 + 1.5 · 1 + 1.5.
    expect(fits(at, 6, 1.5)).toBeCloseTo(9);
    expect(planOf(at, "h-2").outer.points[0]).toEqual([4, 1]);
  });

  it("keeps its place when another wall moves, to the bit if nothing of its slope does", () => {
    const far = replaced(parts(), "h-1", moveEdge(host(), { ring: 0, edge: 1 }, -2)).parts;
    expect(planOf(far, "h-2")).toEqual(dormer());
    expect(planOf(far, "h-1").holes).toEqual(host().holes.map((h) => ({ ...h })));
    const front = replaced(parts(), "h-1", moveEdge(host(), { ring: 0, edge: 0 }, -1)).parts; // its eaves, outwards
    const own = structureAt(front, "h-2")!;
    expect(own.dormer).not.toBeNull();
    expect(planOf(front, "h-2").outer.points[0]).toEqual([4, 1]);
    expect(planOf(front, "h-2").cap, "the slope is a metre higher there").toBeCloseTo(9.5);
    const corner = replaced(parts(), "h-1", insertVertex(host(), { ring: 0, edge: 0 }, [1, 0])).parts;
    expect(structureAt(corner, "h-2")!.dormer, "its slope is that of the half that is nearest").not.toBeNull();
  });

  it("keeps its walls where a profile is applied to all edges of the roof", () => {
    const all = replaced(parts(), "h-1", setProfile(host(), edgesOf(host()), [[0, 0], [0, 6], [4, 10]])).parts;
    expect(fits(all)).toBeCloseTo(8.5);
  });

  it("is lost with its slope, and comes back within the gesture", () => {
    const flat = replaced(parts(), "h-1", shaped(host(), "flat"));
    expect(flat.lost).toEqual(["h-2"]);
    expect(flat.parts.map((p) => p.id)).toEqual(["h-1"]);
    expect(planOf(flat.parts, "h-1").holes).toEqual([]);
    // So low that the ridge is below its eaves.
    const low = setProfile(host(), [{ ring: 0, edge: 0 }, { ring: 0, edge: 2 }], [[0, 0], [0, 6], [4, 7.2]]);
    expect(replaced(parts(), "h-1", low).lost).toEqual(["h-2"]);
    expect(replaced(parts(), "h-1", host()).lost).toEqual([]);
    const hip = replaced(parts(), "h-1", shaped(host(), "hip"));
    expect(hip.lost).toEqual([]);
    fits(hip.parts);
  });

  it("stays when its roof is made like another one", () => {
    const made = replaced(parts(), "h-1", shaped(bare(parts(), "h-1"), "hip")).parts;
    fits(made);
    expect(bare(made, "h-1").holes).toEqual([]);
  });

  it("is deleted with its hole, and with its roof", () => {
    const without = removed(parts(), "h-2");
    expect(without.map((p) => p.id)).toEqual(["h-1"]);
    expect(planOf(without, "h-1")).toEqual(house());
    expect(removed(parts(), "h-1")).toEqual([]);
  });

  it("is added where there is room, smaller where there is less", () => {
    const bareHouse: NamedPlan[] = [{ id: "h-1", plan: house() }];
    const made = withDormer("h", bareHouse, "h-1", geometry(), [5, 1])!;
    expect(made.id).toBe("h-2");
    expect(fits(made.parts)).toBeCloseTo(8.4);
    close(planOf(made.parts, "h-2").outer.points, [[4, 1], [6, 1], [6, 2.4], [4, 2.4]]);
    const other = withDormer("h", bareHouse, "h-1", geometry(), [5, 7])!;
    expect(structureAt(other.parts, "h-2")!.dormer).toMatchObject({ edge: 2 });
    const high = withDormer("h", bareHouse, "h-1", geometry(), [5, 2.7])!;
    expect(planOf(high.parts, "h-2").cap).toBeCloseTo(9.7); // a rise of 1 m
    const beside = withDormer("h", bareHouse, "h-1", geometry(), [0.9, 1])!;
    expect(planArea(planOf(beside.parts, "h-2"))).toBeCloseTo(1.2 * 1.4);
    expect(withDormer("h", bareHouse, "h-1", geometry(), [5, 3.9]), "at the ridge").toBeNull();
    expect(withDormer("h", bareHouse, "h-1", geometry(), [20, 1]), "beside the house").toBeNull();
  });
});

describe("a dormer that is placed roughly", () => {
  const bareHouse = [{ id: "h-1", plan: house() }];
  it("is added at the nearest place where it fits", () => {
    const here = nearestDormer("h", bareHouse, "h-1", geometry(), [5, 1])!;
    expect(here.moved).toBe(0);
    const ridge = nearestDormer("h", bareHouse, "h-1", geometry(), [5, 3.9])!;
    expect(ridge.moved).toBeGreaterThan(0);
    expect(ridge.moved).toBeLessThan(1.5);
    expect(structureAt(ridge.parts, "h-2")?.dormer).toBeTruthy();
    expect(nearestDormer("h", bareHouse, "h-1", geometry(), [30, 1])).toBeNull();
  });
  it("has another place and other measures, and fills its hole", () => {
    const box = dormerBox(parts(), "h-2")!;
    expect(box).toMatchObject({ left: 4, right: 6, front: 1, eaves: 8.5 });
    const now = withDormerBox(parts(), "h-2", { left: 3, right: 5.5, front: 0.8, eaves: 8.3 })!;
    expect(fits(now)).toBeCloseTo(8.3, 9);
    expect(dormerBox(now, "h-2")).toMatchObject({ left: 3, right: 5.5 });
    expect(withDormerBox(parts(), "h-2", { ...box, right: box.left + 0.1 }), "too narrow").toBeNull();
    expect(withDormerBox(parts(), "h-2", { ...box, eaves: 6.5 }), "below its slope").toBeNull();
    expect(withDormerBox(parts(), "h-2", { ...box, eaves: 12 }), "beyond the ridge").toBeNull();
    expect(dormerBox(parts(), "h-1")).toBeNull();
  });
});

describe("a structure on a roof", () => {
  const made = () => withStructure("h", [{ id: "h-1", plan: house() }], "h-1", geometry(), [[4, 3], [6, 3], [6, 5], [4, 5]]).parts;

  it("is higher than the roof around it, and fills its hole", () => {
    expect(structureAt(made(), "h-2")).toMatchObject({ host: "h-1", dormer: null });
    expect(planOf(made(), "h-2").cap).toBeCloseTo(9 + 2.5);
    for (const p of made()) expect(planFault(p.plan, p.id)).toBeNull();
    expect(faceOver(geometry(), [5, 3])!.z).toBeCloseTo(10.25);
  });

  it("takes its hole along, with any number of corners", () => {
    const moved = replaced(made(), "h-2", moveAll(planOf(made(), "h-2"), [1, -0.5])).parts;
    expect(structureAt(moved, "h-2")).not.toBeNull();
    const more = replaced(moved, "h-2", insertVertex(planOf(moved, "h-2"), { ring: 0, edge: 0 }, [6, 2])).parts;
    expect(structureAt(more, "h-2")).not.toBeNull();
    expect(planOf(more, "h-1").holes[0]!.points.length).toBe(5);
    expect(planArea(planOf(more, "h-1")) + planArea(planOf(more, "h-2"))).toBeCloseTo(80);
  });

  it("stays as it is when its roof changes, and is deleted with its hole", () => {
    const flat = replaced(made(), "h-1", shaped(planOf(made(), "h-1"), "flat"));
    expect(flat.lost).toEqual([]);
    expect(structureAt(flat.parts, "h-2")).not.toBeNull();
    expect(planOf(removed(made(), "h-2"), "h-1").holes).toEqual([]);
  });
});
