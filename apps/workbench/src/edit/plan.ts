// Operations on plans. Every function returns a new plan and leaves its argument unchanged.
import type { Plan, PlanRing, Point2 } from "../api/types";
import { apart, isCornerEdge, together, type CornerEdge } from "./corner_edges";
import { same, type Profile } from "./profile";
import {
  area,
  cross,
  distance,
  distanceToLine,
  dot,
  meeting,
  minus,
  plus,
  times,
  turnedLeft,
  unit,
  type Line,
} from "./vector";

/** An edge of a plan, or the corner at its start. Ring 0 is the outline. */
export interface EdgeAt {
  ring: number;
  edge: number;
}
/** The edges that a change of a profile applies to. */
export type Scope = "edge" | "sharing" | "part";

export const ringsOf = (plan: Plan): PlanRing[] => [plan.outer, ...plan.holes];
export const ringOf = (plan: Plan, ring: number): PlanRing | undefined =>
  ring === 0 ? plan.outer : plan.holes[ring - 1];
export const after = (ring: { points: unknown[] }, i: number) => (i + 1) % ring.points.length;
export const before = (ring: { points: unknown[] }, i: number) => (i + ring.points.length - 1) % ring.points.length;

export function edgesOf(plan: Plan): EdgeAt[] {
  return ringsOf(plan).flatMap((r, ring) => r.points.map((_, edge) => ({ ring, edge })));
}
export function endsOf(plan: Plan, at: EdgeAt): [Point2, Point2] | null {
  const ring = ringOf(plan, at.ring);
  const from = ring?.points[at.edge];
  return ring && from ? [from, ring.points[after(ring, at.edge)]!] : null;
}
export function profileOf(plan: Plan, at: EdgeAt): Profile | null {
  const index = ringOf(plan, at.ring)?.profile_of_edge[at.edge];
  return index === undefined ? null : (plan.profiles[index] ?? null);
}
/** Whether an edge is one without extent at a corner, whose direction is that of a roof plane. */
export function isCorner(plan: Plan, at: EdgeAt): boolean {
  const ring = ringOf(plan, at.ring);
  return !!ring && at.edge < ring.points.length && isCornerEdge(ring, at.edge);
}
/** The edges that are walls of some length, and the others. */
export const wallsOf = (plan: Plan): EdgeAt[] => edgesOf(plan).filter((e) => !isCorner(plan, e));
export const cornerEdgesOf = (plan: Plan): EdgeAt[] => edgesOf(plan).filter((e) => isCorner(plan, e));
export const edgeName = (plan: Plan, at: EdgeAt) => `${isCorner(plan, at) ? "corner edge" : "edge"} ${at.edge}`;
export const sameEdge = (a: EdgeAt, b: EdgeAt) => a.ring === b.ring && a.edge === b.edge;

/** How far the footprint reaches behind an edge, metres: at right angles to it, or from the corner of one without extent. */
export function depthBehind(plan: Plan, at: EdgeAt): number {
  const ends = endsOf(plan, at);
  if (!ends) return 0;
  const along = isCorner(plan, at) ? null : unit(minus(ends[1], ends[0]));
  return Math.max(0, ...plan.outer.points.map((p) => (along ? cross(along, minus(p, ends[0])) : distance(p, ends[0]))));
}

/** Area of the footprint, m². */
export const planArea = (plan: Plan) =>
  ringsOf(plan).reduce((sum, r, i) => sum + (i ? -1 : 1) * Math.abs(area(r.points)), 0);

function withRing(plan: Plan, at: number, ring: PlanRing): Plan {
  return at === 0 ? { ...plan, outer: ring } : { ...plan, holes: plan.holes.map((h, i) => (i === at - 1 ? ring : h)) };
}
const withPoints = (plan: Plan, at: number, change: (p: Point2, i: number) => Point2): Plan => {
  const ring = ringOf(plan, at);
  return ring ? withRing(plan, at, { ...ring, points: ring.points.map(change) }) : plan;
};

/** What a change makes of a plan without its corner edges, and with them again. `moved` gives a corner its new number. */
function besideCornerEdges<T extends Plan | null>(
  plan: Plan,
  at: EdgeAt,
  change: (plan: Plan, at: EdgeAt) => T,
  moved: (corner: number, edge: number) => number | null = (corner) => corner,
): T | Plan {
  const { plan: bare, corners, numberOf } = apart(plan);
  if (corners.length === 0) return change(plan, at);
  const edge = numberOf(at.ring, at.edge);
  const changed = change(bare, { ring: at.ring, edge });
  if (!changed) return changed;
  return together(
    changed,
    corners.flatMap((c): CornerEdge[] => {
      const corner = c.ring === at.ring ? moved(c.corner, edge) : c.corner;
      return corner === null ? [] : [{ ...c, corner }];
    }),
  );
}

export function moveVertex(plan: Plan, at: EdgeAt, to: Point2): Plan {
  return besideCornerEdges(plan, at, (bare, corner) => withPoints(bare, corner.ring, (p, i) => (i === corner.edge ? to : p)));
}

export function moveAll(plan: Plan, by: Point2): Plan {
  const moved = (ring: PlanRing): PlanRing => ({ ...ring, points: ring.points.map((p) => plus(p, by)) });
  return { ...plan, outer: moved(plan.outer), holes: plan.holes.map(moved) };
}

/** Shifts the edge to its left, i.e. inwards, also for holes; its neighbours keep their directions. A corner edge stays
 *  at its corner. */
export function moveEdge(plan: Plan, at: EdgeAt, by: number): Plan {
  const own = ringOf(plan, at.ring);
  if (own && isCornerEdge(own, at.edge)) return plan;
  return besideCornerEdges(plan, at, (bare, edge) => withMovedEdge(bare, edge, by));
}
function withMovedEdge(plan: Plan, at: EdgeAt, by: number): Plan {
  const ring = ringOf(plan, at.ring);
  const ends = endsOf(plan, at);
  const along = ends && unit(minus(ends[1], ends[0]));
  if (!ring || !ends || !along) return plan;
  const shift = times(turnedLeft(along), by);
  const moved: Line = { at: plus(ends[0], shift), along };
  const next = after(ring, at.edge);
  const slid = (corner: Point2, beyond: Point2): Point2 => {
    const direction = unit(minus(corner, beyond));
    // With a nearly parallel neighbour the corner would move far away.
    if (!direction || Math.abs(cross(direction, along)) < 0.3) return plus(corner, shift);
    return meeting(moved, { at: beyond, along: direction }) ?? plus(corner, shift);
  };
  const first = slid(ends[0], ring.points[before(ring, at.edge)]!);
  const second = slid(ends[1], ring.points[after(ring, next)]!);
  return withPoints(plan, at.ring, (p, i) => (i === at.edge ? first : i === next ? second : p));
}

/** The overhangs of a ring's edges after a change of its edges; nothing where it has none. */
const overhangs = (ring: PlanRing, change: (values: number[]) => number[]): Partial<PlanRing> =>
  ring.overhang_of_edge ? { overhang_of_edge: change(ring.overhang_of_edge) } : {};

/** Inserts a corner on an edge; both halves keep its profile. */
export function insertVertex(plan: Plan, at: EdgeAt, point: Point2): Plan {
  return besideCornerEdges(
    plan,
    at,
    (bare, edge) => withVertex(bare, edge, point),
    (corner, edge) => (corner > edge ? corner + 1 : corner),
  );
}
function withVertex(plan: Plan, at: EdgeAt, point: Point2): Plan {
  const ring = ringOf(plan, at.ring);
  if (!ring || at.edge >= ring.points.length) return plan;
  const twice = (values: number[]) => [
    ...values.slice(0, at.edge + 1),
    values[at.edge]!,
    ...values.slice(at.edge + 1),
  ];
  return withRing(plan, at.ring, {
    points: [...ring.points.slice(0, at.edge + 1), point, ...ring.points.slice(at.edge + 1)],
    profile_of_edge: twice(ring.profile_of_edge),
    ...overhangs(ring, twice),
  });
}

/** Deletes a corner; its two edges become one, with the profile of the longer one. A hole with three corners is deleted;
 *  for an outline with three corners the result is null. */
export function deleteVertex(plan: Plan, at: EdgeAt): Plan | null {
  return besideCornerEdges(plan, at, withoutVertex, (corner, gone) =>
    corner === gone ? null : corner > gone ? corner - 1 : corner,
  );
}
function withoutVertex(plan: Plan, at: EdgeAt): Plan | null {
  const ring = ringOf(plan, at.ring);
  if (!ring || at.edge >= ring.points.length) return null;
  if (ring.points.length <= 3) return at.ring === 0 ? null : removeHole(plan, at.ring);
  const previous = before(ring, at.edge);
  const corner = ring.points[at.edge]!;
  const keepsOwn = distance(corner, ring.points[after(ring, at.edge)]!) > distance(ring.points[previous]!, corner);
  const others = <T>(values: T[]) => values.filter((_, i) => i !== at.edge);
  const joined = (values: number[]) =>
    others(values.map((value, i) => (i === previous && keepsOwn ? values[at.edge]! : value)));
  return withRing(plan, at.ring, {
    points: others(ring.points),
    profile_of_edge: joined(ring.profile_of_edge),
    ...overhangs(ring, joined),
  });
}

/** Adds a courtyard with walls up to the cap. The points may have any orientation; the hole is clockwise. */
export function addHole(plan: Plan, points: Point2[]): Plan {
  const clockwise = area(points) > 0 ? [...points].reverse() : points;
  const wall: Profile = [
    [0, 0],
    [0, plan.cap],
  ];
  const hole: PlanRing = { points: clockwise, profile_of_edge: clockwise.map(() => plan.profiles.length) };
  return clean({ ...plan, holes: [...plan.holes, hole], profiles: [...plan.profiles, wall] });
}
export function removeHole(plan: Plan, ring: number): Plan {
  return clean({ ...plan, holes: plan.holes.filter((_, i) => i !== ring - 1) });
}

/** The edges that a change of the profile of `at` applies to. Equal profiles count as shared. */
export function inScope(plan: Plan, at: EdgeAt, scope: Scope): EdgeAt[] {
  const own = profileOf(plan, at);
  if (scope === "edge" || !own) return [at];
  if (scope === "part") return edgesOf(plan);
  return edgesOf(plan).filter((e) => same(profileOf(plan, e) ?? [], own));
}

/** Sets the profile of some edges; other edges with the same profile keep it. */
export function setProfile(plan: Plan, edges: EdgeAt[], profile: Profile): Plan {
  const index = plan.profiles.length;
  const changed = (ring: PlanRing, r: number): PlanRing => ({
    ...ring,
    profile_of_edge: ring.profile_of_edge.map((p, i) =>
      edges.some((e) => sameEdge(e, { ring: r, edge: i })) ? index : p,
    ),
  });
  return clean({
    ...plan,
    outer: changed(plan.outer, 0),
    holes: plan.holes.map((h, i) => changed(h, i + 1)),
    profiles: [...plan.profiles, profile],
  });
}

/** Removes unused profiles, shares equal ones, and numbers them in the order of their edges. */
export function clean(plan: Plan): Plan {
  const kept: Profile[] = [];
  const renamed = (ring: PlanRing): PlanRing => ({
    points: ring.points,
    profile_of_edge: ring.profile_of_edge.map((p) => {
      const profile = plan.profiles[p] ?? [];
      const known = kept.findIndex((k) => same(k, profile));
      return known >= 0 ? known : kept.push(profile) - 1;
    }),
    ...overhangs(ring, (values) => values),
  });
  const outer = renamed(plan.outer);
  const holes = plan.holes.map(renamed);
  return { base: plan.base, cap: plan.cap, outer, holes, profiles: kept };
}

/** Makes the outline counter-clockwise and holes clockwise, as files require: dragging a corner across the opposite edge of
 *  a triangle reverses its orientation. */
export function oriented(plan: Plan): Plan {
  const turned = (ring: PlanRing, r: number): PlanRing => {
    if (area(ring.points) >= 0 === (r === 0)) return ring;
    // Edge i now runs from the old corner n − 1 − i to the one before it: the old edge n − 2 − i.
    const backward = (values: number[]) => {
      const all = [...values].reverse();
      return [...all.slice(1), all[0]!];
    };
    return {
      points: [...ring.points].reverse(),
      profile_of_edge: backward(ring.profile_of_edge),
      ...overhangs(ring, backward),
    };
  };
  return { ...plan, outer: turned(plan.outer, 0), holes: plan.holes.map((h, i) => turned(h, i + 1)) };
}

/** Edges on the opposite side that are parallel within 10°. A corner edge is opposite of what its roof rises towards. */
export function opposite(plan: Plan, at: EdgeAt): EdgeAt[] {
  const ends = endsOf(plan, at);
  const along = ends && unit(minus(ends[1], ends[0]));
  if (!ends || !along) return [];
  return edgesOf(plan).filter((e) => {
    const [a, b] = endsOf(plan, e)!;
    const other = unit(minus(b, a));
    if (!other || dot(other, along) > -0.985) return false;
    if (isCorner(plan, at) || isCorner(plan, e)) return cross(along, minus(a, ends[0])) > 0.1;
    const reach = (p: Point2) => dot(minus(p, ends[0]), along);
    const low = Math.max(0, Math.min(reach(a), reach(b)));
    const high = Math.min(distance(...ends), Math.max(reach(a), reach(b)));
    return cross(along, minus(a, ends[0])) > 0 && high - low > 0.1;
  });
}

/** Other edges on the same line, within 0.1 m, with the same direction. A corner edge has a plane of its own. */
export function collinear(plan: Plan, at: EdgeAt): EdgeAt[] {
  const ends = endsOf(plan, at);
  const along = ends && unit(minus(ends[1], ends[0]));
  if (!ends || !along || isCorner(plan, at)) return [];
  const line: Line = { at: ends[0], along };
  return wallsOf(plan).filter((e) => {
    if (sameEdge(e, at)) return false;
    const [a, b] = endsOf(plan, e)!;
    const other = unit(minus(b, a));
    return !!other && dot(other, along) > 0.98 && distanceToLine(a, line) < 0.1 && distanceToLine(b, line) < 0.1;
  });
}

/** Length of the walls that two plans share within 0.05 m, metres. */
export function sharedWall(a: Plan, b: Plan): number {
  let length = 0;
  for (const e of edgesOf(a))
    for (const f of edgesOf(b)) {
      const [p, q] = endsOf(a, e)!;
      const [r, s] = endsOf(b, f)!;
      const along = unit(minus(q, p));
      if (!along) continue;
      const line: Line = { at: p, along };
      if (distanceToLine(r, line) > 0.05 || distanceToLine(s, line) > 0.05) continue;
      const low = Math.max(0, Math.min(dot(minus(r, p), along), dot(minus(s, p), along)));
      const high = Math.min(distance(p, q), Math.max(dot(minus(r, p), along), dot(minus(s, p), along)));
      if (high > low) length += high - low;
    }
  return length;
}

/** Changes the profile of each edge separately; edges for which `change` returns null keep theirs. */
export function changeProfiles(plan: Plan, edges: EdgeAt[], change: (profile: Profile) => Profile | null): Plan {
  let changed = plan;
  for (const at of edges) {
    const own = profileOf(plan, at);
    const profile = own && change(own);
    if (profile) changed = setProfile(changed, [at], profile);
  }
  return changed;
}
