import { describe, expect, it } from "vitest";
import type { NamedPlan } from "../api/types";
import { house } from "./house_for_tests";
import { changeProfiles, inScope } from "./plan";
import { gutterOf, withGutter } from "./profile";
import { facing, onSeveral, type Change } from "./several";

const moved = (by: number) => ({ ...house(), outer: { ...house().outer, points: house().outer.points.map(([x, y]) => [x + by, y] as [number, number]) } });
const flat = () => ({ ...moved(40), cap: 6, outer: { points: moved(40).outer.points, profile_of_edge: [0, 0, 0, 0] }, profiles: [[[0, 0], [0, 6]]] as [number, number][][] });
const buildings: Record<string, NamedPlan[]> = {
  a: [{ id: "a-1", plan: house() }, { id: "a-2", plan: moved(20) }],
  b: [{ id: "b-1", plan: flat() }],
};
const partsOf = (building: string) => buildings[building]!;
const gutter = (height: number): Change => (plan, edges) => changeProfiles(plan, edges, (p) => (gutterOf(p) === null ? null : withGutter(p, height)));
const guttersOf = (plan: NamedPlan["plan"]) => plan.outer.profile_of_edge.map((p) => gutterOf(plan.profiles[p]!));
const first = { building: "a", part: "a-1", edges: [{ ring: 0, edge: 0 }] };
const others = [{ building: "a", part: "a-1" }, { building: "a", part: "a-2" }, { building: "b", part: "b-1" }];

describe("a value for several parts", () => {
  it("goes to the edges that face the same way, and names the parts without one", () => {
    const now = onSeveral(first, others, false, gutter(7), partsOf);
    expect(now.changed).toBe(2);
    expect(now.left).toEqual(["b-1"]);
    expect(now.parts.map((p) => p.building)).toEqual(["a"]);
    for (const { plan } of now.parts[0]!.parts) expect(guttersOf(plan)).toEqual([7, null, 6, null]);
  });

  it("goes to all edges if it is for all edges of the part", () => {
    const edges = inScope(house(), { ring: 0, edge: 0 }, "part");
    const now = onSeveral({ ...first, edges }, others, true, gutter(7), partsOf);
    for (const { plan } of now.parts[0]!.parts) expect(guttersOf(plan)).toEqual([7, null, 7, null]);
  });

  it("of the part goes to each of them", () => {
    const now = onSeveral(first, others, false, (plan) => ({ ...plan, base: 2 }), partsOf);
    expect(now.parts.flatMap((b) => b.parts.map((p) => p.plan.base))).toEqual([2, 2, 2]);
    expect(now.left).toEqual([]);
  });

  it("finds edges of a turned plan by their direction", () => {
    const turned = { ...house(), outer: { ...house().outer, points: house().outer.points.map(([x, y]) => [-y, x] as [number, number]) } };
    expect(facing(house(), [{ ring: 0, edge: 0 }], turned)).toEqual([{ ring: 0, edge: 3 }]);
  });
});
