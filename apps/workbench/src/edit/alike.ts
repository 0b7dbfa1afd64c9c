// Several houses at once: the parts of a row, the roof of one part on others, and parts that are added or removed.
import type { NamedPlan, Plan, Point2 } from "../api/types";
import { apart, type CornerEdge, together } from "./corner_edges";
import { after, clean, cornerEdgesOf, isCorner, oriented, ringsOf, sharedWall } from "./plan";
import { gutterOf, pitchOf, slopes } from "./profile";
import { eavesOf, shaped, type Roof, type Shape } from "./shapes";
import { freeId } from "./structures";
import { withoutTurnedRoof } from "./turned_roof";
import { cross, distance, dot, minus, rotated, unit } from "./vector";

export interface Place {
  building: string;
  part: string;
  plan: Plan;
}

/** Parts of a row are joined by walls of at least this length, metres. */
const joined = 1;

/** The parts that a part is joined to by shared walls, directly or through others; with the part itself, which comes first. */
export function rowOf(first: Place, all: readonly Place[]): Place[] {
  const row = [first];
  let rest = all.filter((p) => p.building !== first.building || p.part !== first.part);
  for (let i = 0; i < row.length; ++i) {
    const next = rest.filter((p) => boxesMeet(row[i]!.plan, p.plan) && sharedWall(row[i]!.plan, p.plan) >= joined);
    rest = rest.filter((p) => !next.includes(p));
    row.push(...next);
  }
  return row;
}

function boxesMeet(a: Plan, b: Plan): boolean {
  return ([0, 1] as const).every((i) => {
    const [p, q] = [a, b].map((plan) => plan.outer.points.map((c) => c[i]));
    return Math.min(...p!) < Math.max(...q!) + 0.1 && Math.min(...q!) < Math.max(...p!) + 0.1;
  });
}

/** How far the edges of a polygon are from those of another if its edge `shift` corresponds to edge 0 there; `mirrored`: the
 *  edges follow each other the other way round. Lengths and turns are compared, so that a rotated copy is the same. */
function unlike(a: readonly Point2[], b: readonly Point2[], shift: number, mirrored: boolean): number {
  const n = a.length;
  const edge = (points: readonly Point2[], i: number) => minus(points[(i + 1) % n]!, points[i % n]!);
  const turn = (points: readonly Point2[], i: number) => {
    const [u, v] = [unit(edge(points, i + n - 1)), unit(edge(points, i))];
    return u && v ? Math.atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]) : 0;
  };
  let sum = 0;
  for (let i = 0; i < n; ++i) {
    const j = mirrored ? (2 * n + shift - i) % n : (i + shift) % n;
    sum += Math.abs(Math.hypot(...edge(a, i)) - Math.hypot(...edge(b, j)));
    // The turn at the start of edge i; mirrored, it is that at the end of edge j.
    sum += 5 * Math.abs(turn(a, i) - turn(b, mirrored ? j + 1 : j));
  }
  return sum;
}

/** For each edge of `to` the corresponding edge of `from`, and whether they follow each other the other way round. */
interface Correspondence {
  edges: number[];
  mirrored: boolean;
}

/** The edges that correspond; null if they have different numbers of corners. */
export function correspondence(from: readonly Point2[], to: readonly Point2[]): Correspondence | null {
  const n = from.length;
  if (n !== to.length || n < 3) return null;
  let best = { cost: Infinity, shift: 0, mirrored: false };
  for (const mirrored of [false, true])
    for (let shift = 0; shift < n; ++shift) {
      const cost = unlike(to, from, shift, mirrored);
      if (cost < best.cost - 1e-9) best = { cost, shift, mirrored };
    }
  const edges = to.map((_, i) => (best.mirrored ? (2 * n + best.shift - i) % n : (i + best.shift) % n));
  return { edges, mirrored: best.mirrored };
}

const wayOf = (points: readonly Point2[], edge: number) =>
  unit(minus(points[(edge + 1) % points.length]!, points[(edge + points.length) % points.length]!))!;
const turnOf = (a: Point2, b: Point2) => Math.atan2(cross(a, b), dot(a, b));

/** A corner edge at the corner of another ring that corresponds: as far from the wall that it is nearest to. */
function cornerEdgeAlike(edge: CornerEdge, from: readonly Point2[], to: readonly Point2[], { edges, mirrored }: Correspondence): CornerEdge {
  const before = turnOf(wayOf(from, edge.corner - 1), edge.along);
  const after = turnOf(edge.along, wayOf(from, edge.corner));
  // The corner is at the start of its edge; mirrored, at the end of the edge that corresponds to this.
  const corner = mirrored ? (edges.indexOf(edge.corner) + 1) % to.length : edges.indexOf(edge.corner);
  const [first, second] = mirrored ? [after, before] : [before, after];
  const along = first < second ? rotated(wayOf(to, corner - 1), first) : rotated(wayOf(to, corner), -second);
  const { last: _, ...kept } = edge;
  return { ...kept, corner, along };
}

/** The shape that the roof of a part has: the nearest of those that can be applied in one click. */
export function shapeOf(given: Plan, sharedEdges: readonly boolean[] = []): Shape {
  const shared = sharedEdges.filter((_, edge) => !isCorner(given, { ring: 0, edge }));
  const plan = straightened(given);
  const free = plan.outer.profile_of_edge.filter((_, i) => !shared[i]);
  const sloped = free.filter((p) => slopes(plan.profiles[p]!).length > 0);
  if (!sloped.length) return "flat";
  if (sloped.some((p) => slopes(plan.profiles[p]!).length > 1)) return "mansard";
  return sloped.length === free.length ? "hip" : "gable";
}

/** The plan whose roofs rise from its walls alone. */
function straightened(plan: Plan): Plan {
  const [first] = cornerEdgesOf(plan);
  return first ? straightened(withoutTurnedRoof(plan, first)!.plan) : plan;
}

const median = (values: number[]) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** Eaves and pitch of a part, to be given to another. */
export function roofOf(plan: Plan): Roof {
  const sloped = plan.outer.profile_of_edge.flatMap((p) => {
    const profile = plan.profiles[p]!;
    const pitch = pitchOf(profile);
    return gutterOf(profile) !== null && pitch !== null && Number.isFinite(pitch) && pitch > 0 ? [pitch] : [];
  });
  return { eaves: eavesOf(plan), pitch: median(sloped) };
}

/** The plan with the roof of another one: with as many corners, the profiles of its edges, each on the edge that corresponds;
 *  else a roof of the same shape, eaves and pitch. Outline and base stay. */
export function alike(model: Plan, plan: Plan, sharedOfModel: readonly boolean[], shared: readonly boolean[]): Plan {
  const { plan: from, corners } = apart(oriented(model));
  const { plan: to } = apart(oriented(plan));
  const rings = ringsOf(to);
  const maps = ringsOf(from).length === rings.length
    ? rings.map((ring, r) => correspondence(ringsOf(from)[r]!.points, ring.points))
    : [null];
  if (maps.every((m) => m !== null)) {
    const own = rings.map((ring, r) => ({
      points: ring.points,
      profile_of_edge: maps[r]!.edges.map((edge) => ringsOf(from)[r]!.profile_of_edge[edge]!),
    }));
    const turned = corners.map((c) => cornerEdgeAlike(c, ringsOf(from)[c.ring]!.points, rings[c.ring]!.points, maps[c.ring]!));
    return clean(together({ ...to, cap: model.cap, profiles: model.profiles, outer: own[0]!, holes: own.slice(1) }, turned));
  }
  return shaped(oriented(plan), shapeOf(model, sharedOfModel), (i) => shared[i] ?? false, roofOf(model));
}

/** Edges across a row: along these its ridge does not run. Null if the part shares no wall. */
export function alongRow(plan: Plan, shared: readonly boolean[]): boolean[] | null {
  const { points } = plan.outer;
  const ends = points.map((p, i) => [p, points[after(plan.outer, i)]!] as const);
  let longest: Point2 | null = null;
  let most = 0;
  ends.forEach(([a, b], i) => {
    if (!shared[i] || distance(a, b) <= most) return;
    most = distance(a, b);
    longest = unit(minus(b, a));
  });
  if (!longest) return null;
  const across: Point2 = longest;
  return ends.map(([a, b]) => {
    const own = unit(minus(b, a));
    return !!own && Math.abs(own[0] * across[0] + own[1] * across[1]) < Math.SQRT1_2;
  });
}

/** A part that is drawn: walls up to a flat roof. */
export function annex(building: string, parts: readonly NamedPlan[], points: Point2[], base: number, height: number): NamedPlan {
  const plan: Plan = {
    base,
    cap: height,
    outer: { points, profile_of_edge: points.map(() => 0) },
    holes: [],
    profiles: [[[0, 0], [0, height]]],
  };
  return { id: freeId(building, parts), plan: oriented(plan) };
}
