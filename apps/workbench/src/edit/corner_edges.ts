// Edges shorter than a millimetre at corners: they give a roof a direction that no wall has (docs/extrude.md). For whoever
// edits a plan, such an edge is part of its corner: operations on corners and edges work on the plan without them, and they
// are put back at their corners.
import type { Plan, PlanRing, Point2 } from "../api/types";
import { cross, dot, distance, minus, plus, rotated, times, unit } from "./vector";

/** m; a longer edge is a wall. */
const longest = 1e-3;
/** The sine of half a degree, and the cosine of 150°: turns beside a corner edge, and the corner. */
const leastTurn = 0.0087;
const sharpest = -0.866;
/** rad; where a wall turned past a corner edge, so much is left between them. */
const kept = 0.012;

export interface CornerEdge {
  ring: number;
  /** Of the ring without corner edges. */
  corner: number;
  along: Point2;
  profile: number;
  overhang?: number;
  /** It is the last edge of its ring, before the corner 0. */
  last?: boolean;
}

const wrapped = (ring: readonly Point2[], i: number) => ring[(i + ring.length) % ring.length]!;
const between = (before: Point2, along: Point2, after: Point2) =>
  cross(before, along) > leastTurn && cross(along, after) > leastTurn && cross(before, after) > 0 && dot(before, after) > sharpest;

export function isCornerEdge(ring: { points: readonly Point2[] }, edge: number): boolean {
  const p = ring.points;
  const size = distance(wrapped(p, edge), wrapped(p, edge + 1));
  if (p.length < 4 || size >= longest || size === 0) return false;
  const own = unit(minus(wrapped(p, edge + 1), wrapped(p, edge)))!;
  const before = minus(wrapped(p, edge), wrapped(p, edge - 1));
  const after = minus(wrapped(p, edge + 2), wrapped(p, edge + 1));
  if (Math.hypot(...before) < 4 * longest || Math.hypot(...after) < 4 * longest) return false;
  return between(unit(before)!, own, unit(after)!);
}

/** The corner of a corner edge. */
export function cornerAt(ring: { points: readonly Point2[] }, edge: number): Point2 {
  const p = ring.points;
  const from = wrapped(p, edge);
  const to = wrapped(p, edge + 1);
  const { before, after } = wallsAt(ring, edge)!;
  return plus(from, times(before, cross(minus(to, from), after) / cross(before, after)));
}

/** The directions of the walls beside a corner edge; null for other edges. */
export function wallsAt(ring: { points: readonly Point2[] }, edge: number): { before: Point2; after: Point2 } | null {
  if (!isCornerEdge(ring, edge)) return null;
  const p = ring.points;
  const before = unit(minus(wrapped(p, edge), wrapped(p, edge - 1)))!;
  const after = unit(minus(wrapped(p, edge + 2), wrapped(p, edge + 1)))!;
  return { before, after };
}

function ringApart(ring: PlanRing, r: number): { ring: PlanRing; edges: number[]; corners: CornerEdge[] } {
  const edges = ring.points.flatMap((_, i) => (isCornerEdge(ring, i) ? [i] : []));
  if (edges.length === 0) return { ring, edges, corners: [] };
  const points = [...ring.points];
  const corners = edges.map((edge, k): CornerEdge => {
    points[(edge + 1) % points.length] = cornerAt(ring, edge);
    return {
      ring: r,
      corner: (edge - k) % (points.length - edges.length),
      along: unit(minus(wrapped(ring.points, edge + 1), ring.points[edge]!))!,
      profile: ring.profile_of_edge[edge]!,
      ...(ring.overhang_of_edge ? { overhang: ring.overhang_of_edge[edge]! } : {}),
      ...(edge === points.length - 1 ? { last: true } : {}),
    };
  });
  const rest = <T>(values: T[]) => values.filter((_, i) => !edges.includes(i));
  return {
    ring: {
      points: rest(points),
      profile_of_edge: rest(ring.profile_of_edge),
      ...(ring.overhang_of_edge ? { overhang_of_edge: rest(ring.overhang_of_edge) } : {}),
    },
    edges,
    corners,
  };
}

/** The direction itself where it is between those of two walls, else the nearest that is; null where there is none. */
export function clampedBetween(before: Point2, after: Point2, along: Point2): Point2 | null {
  if (between(before, along, after)) return along;
  const turn = Math.atan2(cross(before, after), dot(before, after));
  if (turn < 2 * kept || dot(before, after) <= sharpest) return null;
  // From the middle of both: what is nearest also behind the corner.
  const centre = rotated(before, turn / 2);
  const off = Math.atan2(cross(centre, along), dot(centre, along));
  const most = turn / 2 - kept;
  return rotated(centre, Math.min(Math.max(off, -most), most));
}

/** The ends of a corner edge at a corner. */
function endsAt(at: Point2, before: Point2, along: Point2, after: Point2): [Point2, Point2] {
  const whole = cross(before, after);
  return [
    minus(at, times(before, ((longest / 2) * cross(along, after)) / whole)),
    plus(at, times(after, ((longest / 2) * cross(before, along)) / whole)),
  ];
}

function withCornerEdge(ring: PlanRing, edge: CornerEdge): PlanRing {
  const { corner } = edge;
  const at = ring.points[corner]!;
  const before = unit(minus(at, wrapped(ring.points, corner - 1)));
  const after = unit(minus(wrapped(ring.points, corner + 1), at));
  const along = before && after && clampedBetween(before, after, edge.along);
  if (!along) return ring;
  const [from, to] = endsAt(at, before, along, after);
  // At corner 0 it is the first edge or the last one: other edges keep their numbers.
  const last = edge.last && corner === 0;
  const put = <T>(values: T[], value: T) =>
    last ? [...values, value] : [...values.slice(0, corner), value, ...values.slice(corner)];
  const others = ring.points.map((p, i) => (i === corner ? to : p));
  return {
    points: put(others, from),
    profile_of_edge: put(ring.profile_of_edge, edge.profile),
    ...(ring.overhang_of_edge ? { overhang_of_edge: put(ring.overhang_of_edge, edge.overhang ?? 0) } : {}),
  };
}

/** The ring with another direction of a corner edge, or with the nearest that is between its walls. */
export function withDirection(ring: PlanRing, edge: number, way: Point2): PlanRing {
  const walls = wallsAt(ring, edge);
  const along = walls && clampedBetween(walls.before, walls.after, way);
  if (!along) return ring;
  const [from, to] = endsAt(cornerAt(ring, edge), walls.before, along, walls.after);
  const next = (edge + 1) % ring.points.length;
  return { ...ring, points: ring.points.map((p, i) => (i === edge ? from : i === next ? to : p)) };
}

/** The ring with a plain corner in the place of a corner edge. */
export function withoutEdge(ring: PlanRing, edge: number): PlanRing {
  const corner = cornerAt(ring, edge);
  const next = (edge + 1) % ring.points.length;
  const rest = <T>(values: T[]) => values.filter((_, i) => i !== edge);
  return {
    points: rest(ring.points.map((p, i) => (i === next ? corner : p))),
    profile_of_edge: rest(ring.profile_of_edge),
    ...(ring.overhang_of_edge ? { overhang_of_edge: rest(ring.overhang_of_edge) } : {}),
  };
}

export interface Apart {
  plan: Plan;
  corners: CornerEdge[];
  /** The number that an edge, or the corner at its start, has without the corner edges. */
  numberOf: (ring: number, edge: number) => number;
}

/** The plan without its corner edges, and these. */
export function apart(plan: Plan): Apart {
  const rings = [plan.outer, ...plan.holes].map(ringApart);
  return {
    plan: { ...plan, outer: rings[0]!.ring, holes: rings.slice(1).map((r) => r.ring) },
    corners: rings.flatMap((r) => r.corners),
    numberOf: (ring, edge) => {
      const own = rings[ring];
      if (!own) return edge;
      return (edge - own.edges.filter((e) => e < edge).length) % own.ring.points.length;
    },
  };
}

/** The plan with corner edges. One between whose walls there is no direction any more is left out. */
export function together(plan: Plan, corners: readonly CornerEdge[]): Plan {
  const all = [plan.outer, ...plan.holes];
  for (const edge of [...corners].sort((a, b) => b.corner - a.corner)) {
    const ring = all[edge.ring];
    if (ring && edge.corner < ring.points.length) all[edge.ring] = withCornerEdge(ring, edge);
  }
  return { ...plan, outer: all[0]!, holes: all.slice(1) };
}
