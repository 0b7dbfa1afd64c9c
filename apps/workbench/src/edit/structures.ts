// Roof structures: dormers, and parts that stand on a roof. Each is a part of its own that fills a hole of the plan of its host.
// A dormer is a rectangle on a slope; its roof ends where the slope reaches its eaves, and the back edge of the hole goes on
// with the slope, as `mansard reconstruct` makes it (mansard/refine/detail/dormers.cpp).
import type { Geometry, NamedPlan, Plan, PlanRing, Point2 } from "../api/types";
import { after, clean, oriented, ringOf } from "./plan";
import { shaped, type Shape } from "./shapes";
import { gutterOf, lastRoof, slopes, slopeTo, withGutter, withSlope, type Profile } from "./profile";
import { cross, distance, dot, middle, minus, nearestOn, plus, times, turnedLeft, unit } from "./vector";

/** Corners of a hole and of the part in it agree to within this, metres: extruding rounds each for itself. */
const near = 0.01;
/** What is moved by less was only rounded, metres. */
const asRounded = 1e-4;
/** Directions of edges agree to within about 2.5°. */
const parallel = 0.999;
/** Slopes that can have dormers, rise per run: those of `--refine-dormers-min-slope` and `-max-slope`. */
const slopeLimits = [0.25, 2] as const;
/** A new dormer, metres; smaller where there is no room. */
const usual = { widths: [2, 1.6, 1.2], rises: [1.4, 1, 0.7] };
/** What a dormer is never narrower, or lower above its front, than; metres. */
const narrowest = 0.4;
const lowest = 0.1;
/** A new structure is this much higher than the roof around it, metres. */
const usualRise = 2.5;

/** A slope of a roof: height = gutter + slope · distance from its edge, metres above the base. */
export interface Slope {
  ring: number;
  edge: number;
  start: Point2;
  along: Point2;
  inward: Point2;
  gutter: number;
  slope: number;
  from: number; // m inward: where the slope begins, and ends
  to: number;
  rest: Profile; // of its edge, from the end of the slope on; its last segment goes on
}
const heightOf = (s: Slope, inward: number) => s.gutter + s.slope * inward;
const alongOf = (s: Slope, p: Point2) => dot(minus(p, s.start), s.along);
const inwardOf = (s: Slope, p: Point2) => dot(minus(p, s.start), s.inward);
const placeOf = (s: Slope, u: number, v: number): Point2 => plus(s.start, plus(times(s.along, u), times(s.inward, v)));

/** A part in a hole of its host. */
export interface Structure {
  id: string;
  host: string;
  ring: number; // of the host's plan
  dormer: Slope | null; // the slope that a dormer is on
}
/** Corners of a dormer in directions of its slope, metres. */
export interface Box {
  left: number;
  right: number;
  front: number;
  eaves: number; // above the base of the dormer
}

/** Slopes of an edge, from the eaves up. */
function slopesOf(plan: Plan, ring: number, edge: number): Slope[] {
  const of = ringOf(plan, ring)!;
  const start = of.points[edge]!;
  const along = unit(minus(of.points[after(of, edge)]!, start));
  const profile = plan.profiles[of.profile_of_edge[edge]!]!;
  if (!along) return [];
  return profile.slice(1).flatMap((b, n) => {
    const a = profile[n]!;
    const slope = slopeTo(profile, n + 1)!;
    if (!(slope >= slopeLimits[0] && slope <= slopeLimits[1])) return [];
    const last = n + 2 === profile.length;
    const found: Slope = {
      ring,
      edge,
      start,
      along,
      inward: turnedLeft(along),
      gutter: a[1] - slope * a[0],
      slope,
      from: a[0],
      to: last ? Infinity : b[0],
      rest: last ? [a, b] : profile.slice(n + 1),
    };
    return [found];
  });
}

/** The profile of the back edge of a dormer's hole: what the slope does from there on. */
function backOf(s: Slope, inward: number): Profile {
  const height = heightOf(s, inward);
  const [a, b] = [s.rest[0]!, s.rest.at(-1)!];
  // A slope that ends nowhere keeps its run and rise, which the kernel rounds to the same plane as beside the dormer.
  const on: Profile =
    s.to === Infinity
      ? [[b[0] - a[0], height + b[1] - a[1]]]
      : s.rest.filter((p) => p[0] > inward).map((p) => [p[0] - inward, p[1]]);
  return [[0, 0], [0, height], ...on];
}

/** Whether a hole has the corners of an outline, in the opposite direction. */
function fills(outline: readonly Point2[], hole: readonly Point2[]): boolean {
  const n = outline.length;
  if (hole.length !== n) return false;
  const first = hole.findIndex((p) => distance(p, outline[0]!) < near);
  return first >= 0 && outline.every((p, i) => distance(p, hole[(first + n - i) % n]!) < near);
}

/** The slope that a hole's edge continues. */
function continuedBy(host: Plan, hole: PlanRing, rings: readonly number[]): Slope | null {
  for (const [i, from] of hole.points.entries()) {
    const profile = host.profiles[hole.profile_of_edge[i]!]!;
    const own = slopes(profile)[0];
    const height = gutterOf(profile);
    const along = unit(minus(hole.points[after(hole, i)]!, from));
    if (own === undefined || height === null || !along) continue;
    for (const ring of rings)
      for (const edge of ringOf(host, ring)!.points.keys())
        for (const slope of slopesOf(host, ring, edge))
          if (
            dot(slope.along, along) > parallel &&
            Math.abs(slope.slope - own) < 0.02 &&
            Math.abs(heightOf(slope, inwardOf(slope, from)) - height) < 0.05
          )
            return slope;
  }
  return null;
}

/** The roof structures of a building. */
export function structuresOf(parts: readonly NamedPlan[]): Structure[] {
  return parts.flatMap((host) => {
    const inside = host.plan.holes.map((hole) =>
      parts.find((p) => p !== host && p.plan.holes.length === 0 && fills(p.plan.outer.points, hole.points)),
    );
    // Dormers stand on slopes of the outline and of courtyards.
    const rings = [0, ...inside.flatMap((p, i) => (p ? [] : [i + 1]))];
    return inside.flatMap((part, i): Structure[] => {
      if (!part) return [];
      const slope = part.plan.outer.points.length === 4 ? continuedBy(host.plan, host.plan.holes[i]!, rings) : null;
      const dormer = slope && boxOf(part.plan, slope) ? slope : null;
      return [{ id: part.id, host: host.id, ring: i + 1, dormer }];
    });
  });
}
export const structureAt = (parts: readonly NamedPlan[], id: string | null) =>
  structuresOf(parts).find((s) => s.id === id) ?? null;

const isFlat = (plan: Plan) => plan.outer.profile_of_edge.every((p) => slopes(plan.profiles[p]!).length === 0);
/** Eaves of a dormer: its top if it is level, else where its roof begins at the sides. */
function eavesOf(plan: Plan): number {
  if (isFlat(plan)) return plan.cap;
  const own = plan.outer.profile_of_edge.flatMap((p) =>
    slopes(plan.profiles[p]!).length ? (gutterOf(plan.profiles[p]!) ?? []) : [],
  );
  return Math.min(plan.cap, ...own);
}

/** The front edge of a dormer: its direction is that of the slope's edge. Null if there is none. */
function frontOf(plan: Plan, s: Slope): number | null {
  const { points } = plan.outer;
  const edge = points.findIndex((p, i) => {
    const along = unit(minus(points[after(plan.outer, i)]!, p));
    return along !== null && dot(along, s.along) > parallel;
  });
  return edge < 0 ? null : edge;
}
const cornersFrom = (plan: Plan, first: number) => plan.outer.points.map((_, i, all) => all[(first + i) % all.length]!);

function boxOf(plan: Plan, s: Slope): Box | null {
  const first = frontOf(plan, s);
  if (first === null || plan.outer.points.length !== 4) return null;
  const [a, b, , d] = cornersFrom(plan, first);
  const box = { left: alongOf(s, a!), right: alongOf(s, b!), front: inwardOf(s, a!), eaves: eavesOf(plan) };
  const square = Math.abs(alongOf(s, d!) - box.left) < 0.1 && Math.abs(inwardOf(s, b!) - box.front) < 0.1;
  return square ? box : null;
}

/** Sets the height at which a dormer ends. Everything above its eaves moves along. */
function withEaves(plan: Plan, eaves: number): Plan {
  const flat = isFlat(plan);
  const by = eaves - eavesOf(plan);
  const profiles = plan.profiles.map((p): Profile => (slopes(p).length ? withGutter(p, eaves) : [[0, 0], [0, eaves]]));
  return { ...plan, profiles, cap: flat ? eaves : plan.cap + by };
}

/** A dormer's plan and the hole of its host, of a box. `difference`: from the base of the host to that of the dormer. */
function built(plan: Plan, first: number, box: Box, s: Slope, difference: number): { plan: Plan; hole: Point2[]; back: Profile } {
  const back = (box.eaves + difference - s.gutter) / s.slope;
  const corners: Point2[] = [
    placeOf(s, box.left, box.front),
    placeOf(s, box.right, box.front),
    placeOf(s, box.right, back),
    placeOf(s, box.left, back),
  ];
  const points = corners.map((_, i) => corners[(i - first + 4) % 4]!);
  const own = Math.abs(eavesOf(plan) - box.eaves) < 1e-12 ? plan : withEaves(plan, box.eaves);
  return {
    plan: { ...own, outer: { ...own.outer, points } },
    hole: [corners[0]!, corners[3]!, corners[2]!, corners[1]!],
    back: backOf(s, back),
  };
}

/** The host with another hole for a structure; the hole of a dormer has its slope at the back, and walls elsewhere. */
function withHole(host: Plan, ring: number | null, points: Point2[], top: number, back: Profile | null): Plan {
  const at = host.profiles.length;
  const wall: Profile = [[0, 0], [0, top + 1]];
  const hole: PlanRing = { points, profile_of_edge: points.map((_, i) => (back && i === 1 ? at + 1 : at)) };
  const holes = ring === null ? [...host.holes, hole] : host.holes.map((h, i) => (i === ring - 1 ? hole : h));
  return clean({ ...host, holes, profiles: [...host.profiles, wall, ...(back ? [back] : [])] });
}

const put = (parts: readonly NamedPlan[], plans: ReadonlyMap<string, Plan>): NamedPlan[] =>
  parts.map((p) => ({ id: p.id, plan: plans.get(p.id) ?? p.plan }));

/** Of two values the one that was changed. */
const changed = (before: number, a: number, b: number) => (Math.abs(a - before) > Math.abs(b - before) ? a : b);

/** The eaves of a dormer after a change of its cap or of any of its profiles. */
function eavesChanged(before: Plan, plan: Plan): number {
  const flat = isFlat(plan);
  if (flat !== isFlat(before)) return eavesOf(plan);
  const top = (p: Plan, edge: number) => {
    const profile = p.profiles[p.outer.profile_of_edge[edge]!]!;
    return gutterOf(profile) ?? profile.at(-1)![1];
  };
  const moved = (a: number, b: number) => Math.abs(a - b) > 1e-9;
  if (flat && moved(plan.cap, before.cap)) return plan.cap;
  for (const [edge, p] of plan.outer.profile_of_edge.entries()) {
    // The cap of a gable is above its ridge, and its other walls end at the roof.
    if (!flat && slopes(plan.profiles[p]!).length === 0) continue;
    if (moved(top(plan, edge), top(before, edge))) return top(plan, edge);
  }
  return eavesOf(before);
}

/** A dormer after a change of its plan: a rectangle again, whose back is where the slope reaches its eaves. A corner moves
 *  both of its sides; moving the back moves the eaves. */
function dormerChanged(before: Plan, plan: Plan, s: Slope, difference: number): { box: Box; first: number } | null {
  const first = frontOf(before, s);
  const was = boxOf(before, s);
  if (first === null || !was || plan.outer.points.length !== 4) return null;
  const [a, b, c, d] = cornersFrom(plan, first) as [Point2, Point2, Point2, Point2];
  const [, , , old] = cornersFrom(before, first) as [Point2, Point2, Point2, Point2];
  const backWas = inwardOf(s, old);
  const back = changed(backWas, inwardOf(s, c), inwardOf(s, d));
  let eaves = eavesChanged(before, plan);
  if (Math.abs(back - backWas) > 1e-6) eaves += heightOf(s, back) - heightOf(s, backWas);
  const front = changed(was.front, inwardOf(s, a), inwardOf(s, b));
  let left = changed(was.left, alongOf(s, a), alongOf(s, d));
  let right = changed(was.right, alongOf(s, b), alongOf(s, c));
  // A side that is dragged across the other one stops before it, as does the eaves above the slope.
  if (right - left < narrowest) {
    if (Math.abs(left - was.left) > Math.abs(right - was.right)) left = right - narrowest;
    else right = left + narrowest;
  }
  return { box: { left, right, front, eaves: Math.max(eaves, heightOf(s, front) - difference + lowest) }, first };
}

/** What the other slopes leave of a roof there, metres above the base; of convex plans exactly. */
function roofAt(plan: Plan, p: Point2): number {
  let least = plan.cap;
  for (const edge of plan.outer.points.keys())
    for (const s of slopesOf(plan, 0, edge)) {
      const inward = inwardOf(s, p);
      if (inward >= s.from - near && inward <= s.to + near) least = Math.min(least, heightOf(s, inward));
    }
  return least;
}
const standsOn = (host: Plan, s: Slope, corners: readonly Point2[]) =>
  corners.every((p) => {
    const inward = inwardOf(s, p);
    return inward > s.from && inward < s.to && heightOf(s, inward) <= roofAt(host, p) + near;
  });

/** The slope of a changed host that a dormer is on now: of the same edge, or of the one that is nearest to it. */
function slopeAfter(host: Plan, s: Slope, at: Point2, same: boolean): Slope | null {
  const reach = (edge: number) => {
    const of = host.outer;
    return nearestOn(s.start, of.points[edge]!, of.points[after(of, edge)]!).distance;
  };
  const edges = same && s.ring === 0 ? [s.edge] : [...host.outer.points.keys()].sort((a, b) => reach(a) - reach(b));
  const rings = s.ring > 0 ? [[s.ring, s.edge] as const] : edges.map((e) => [0, e] as const);
  for (const [ring, edge] of rings) {
    if (!ringOf(host, ring)?.points[edge]) continue;
    for (const own of slopesOf(host, ring, edge)) {
      const inward = inwardOf(own, at);
      if (dot(own.along, s.along) > 0.9 && inward > own.from && inward < own.to) return own;
    }
  }
  return null;
}

export interface Replaced {
  parts: NamedPlan[];
  lost: string[]; // dormers that no longer have a slope
}

/** A building with another plan for one of its parts. A structure keeps filling its hole, and dormers move with their slope:
 *  each keeps its place, its width, and how far its front rises above the slope. */
export function replaced(parts: readonly NamedPlan[], id: string, plan: Plan): Replaced {
  const before = parts.find((p) => p.id === id)?.plan;
  const all = structuresOf(parts);
  const own = all.find((s) => s.id === id);
  if (!before) return { parts: put(parts, new Map([[id, plan]])), lost: [] };
  if (own) {
    const host = parts.find((p) => p.id === own.host)!.plan;
    const plans = new Map([[id, plan]]);
    const difference = plan.base - host.base;
    const now = own.dormer && dormerChanged(before, plan, own.dormer, difference);
    if (own.dormer && now) {
      const made = built(plan, now.first, now.box, own.dormer, difference);
      plans.set(id, made.plan).set(own.host, withHole(host, own.ring, made.hole, made.plan.cap, made.back));
    } else plans.set(own.host, holeFollows(host, own.ring, oriented(plan)));
    return { parts: put(parts, plans), lost: [] };
  }
  return hostChanged(parts, all.filter((s) => s.host === id), id, before, plan);
}

/** Each edge of the hole keeps the profile of the nearest edge that it had. */
function holeFollows(host: Plan, ring: number, plan: Plan): Plan {
  const old = host.holes[ring - 1]!;
  const points = [...plan.outer.points].reverse();
  const profile_of_edge = points.map((p, i) => {
    if (points.length === old.points.length) {
      // The corners keep their order, whichever comes first.
      const first = old.points.reduce((best, q, k) => (distance(q, points[0]!) < distance(old.points[best]!, points[0]!) ? k : best), 0);
      return old.profile_of_edge[(first + i) % points.length]!;
    }
    const at = middle(p, points[(i + 1) % points.length]!);
    const far = old.points.map((q, k) => nearestOn(at, q, old.points[after(old, k)]!).distance);
    return old.profile_of_edge[far.indexOf(Math.min(...far))]!;
  });
  return { ...host, holes: host.holes.map((h, i) => (i === ring - 1 ? { points, profile_of_edge } : h)) };
}

function hostChanged(
  parts: readonly NamedPlan[],
  structures: readonly Structure[],
  id: string,
  before: Plan,
  plan: Plan,
): Replaced {
  const plans = new Map<string, Plan>();
  const lost: string[] = [];
  let host = plan;
  for (const s of structures) {
    const own = parts.find((p) => p.id === s.id)!.plan;
    const hole = before.holes[s.ring - 1]!;
    const found = host.holes.findIndex((h) => fills([...hole.points].reverse(), h.points));
    const ring = found < 0 ? null : found + 1; // a roof that is taken from elsewhere has no hole yet
    const moved: Plan = { ...own, base: own.base + plan.base - before.base };
    const stay = () => {
      // As it was to the bit, also where a profile is applied to all edges.
      const at = host.profiles.length;
      const kept: PlanRing = { ...hole, profile_of_edge: hole.points.map((_, i) => at + i) };
      const holes = ring === null ? [...host.holes, kept] : host.holes.map((h, i) => (i === ring - 1 ? kept : h));
      const profiles = [...host.profiles, ...hole.profile_of_edge.map((p) => before.profiles[p]!)];
      host = clean({ ...host, holes, profiles });
      plans.set(s.id, moved);
    };
    if (!s.dormer) {
      stay();
      continue;
    }
    const was = boxOf(own, s.dormer)!;
    const first = frontOf(own, s.dormer)!;
    const centre = placeOf(s.dormer, (was.left + was.right) / 2, was.front);
    const next = slopeAfter(host, s.dormer, centre, host.outer.points.length === before.outer.points.length);
    const difference = own.base - before.base;
    let made: ReturnType<typeof built> | null = null;
    if (next) {
      const rise = was.eaves + difference - heightOf(s.dormer, was.front);
      const half = (was.right - was.left) / 2;
      const [u, front] = [alongOf(next, centre), inwardOf(next, centre)];
      const box = { left: u - half, right: u + half, front, eaves: heightOf(next, front) + rise - difference };
      made = built(moved, first, box, next, difference);
    }
    // Where the slopes alone do not tell whether it stands on its own, in a plan that is not convex, it stays.
    const told = standsOn(before, s.dormer, own.outer.points);
    if (!next || !made || (told && !standsOn(host, next, made.plan.outer.points))) {
      lost.push(s.id);
      if (ring !== null) host = clean({ ...host, holes: host.holes.filter((_, i) => i !== ring - 1) });
      continue;
    }
    const unmoved =
      made.plan.outer.points.every((p, i) => distance(p, own.outer.points[i]!) < asRounded) &&
      Math.abs(eavesOf(made.plan) - was.eaves) < asRounded &&
      Math.abs(next.slope - s.dormer.slope) < asRounded;
    if (unmoved) stay();
    else {
      host = withHole(host, ring, made.hole, made.plan.cap, made.back);
      plans.set(s.id, made.plan);
    }
  }
  plans.set(id, host);
  return { parts: put(parts.filter((p) => !lost.includes(p.id)), plans), lost };
}

/** A dormer with another roof: its slopes are on its sides, or on its front as well. */
export function dormerRoof(parts: readonly NamedPlan[], id: string, shape: Shape): Plan | null {
  const own = structureAt(parts, id);
  const plan = parts.find((p) => p.id === id)?.plan;
  const first = own?.dormer && plan ? frontOf(plan, own.dormer) : null;
  if (!plan || first === null) return null;
  const sides = plan.outer.points.map((_, i) => (i - first + 4) % 2 === 1);
  return shaped(plan, shape, (i) => i === (first + 2) % 4, { eaves: eavesOf(plan) }, sides);
}

/** Where a dormer is on its slope; null for other parts. */
export function dormerBox(parts: readonly NamedPlan[], id: string): Box | null {
  const slope = structureAt(parts, id)?.dormer;
  const plan = parts.find((p) => p.id === id)?.plan;
  return slope && plan ? boxOf(plan, slope) : null;
}

/** The building with a dormer at another place of its slope, and with other measures; null where that is not on it.
 *  `rise`: of its own slopes, per run; null: as it is. */
export function withDormerBox(parts: readonly NamedPlan[], id: string, box: Box, rise: number | null = null): NamedPlan[] | null {
  const own = structureAt(parts, id);
  const slope = own?.dormer;
  const plan = parts.find((p) => p.id === id)?.plan;
  const first = slope && plan ? frontOf(plan, slope) : null;
  if (!own || !slope || !plan || first === null) return null;
  const host = parts.find((p) => p.id === own.host)!.plan;
  const difference = plan.base - host.base;
  if (box.right - box.left < narrowest || box.eaves < heightOf(slope, box.front) - difference + lowest) return null;
  const risen = rise === null ? plan : { ...plan, profiles: plan.profiles.map((p) => (slopes(p).length ? withSlope(p, lastRoof(p), rise) : p)) };
  const made = built(risen, first, box, slope, difference);
  const told = standsOn(bare(parts, own.host), slope, plan.outer.points);
  if (told && !standsOn(bare(parts, own.host), slope, made.plan.outer.points)) return null;
  return put(parts, new Map([[id, made.plan], [own.host, withHole(host, own.ring, made.hole, made.plan.cap, made.back)]]));
}

/** A plan without the holes that structures fill. */
export function bare(parts: readonly NamedPlan[], id: string): Plan {
  const plan = parts.find((p) => p.id === id)!.plan;
  const filled = filledRings(parts, id);
  return filled.size ? clean({ ...plan, holes: plan.holes.filter((_, i) => !filled.has(i + 1)) }) : plan;
}

/** A building without a part: what stands on its roof goes with it, and the roof under a structure is closed. */
export function removed(parts: readonly NamedPlan[], id: string): NamedPlan[] {
  const all = structuresOf(parts);
  const gone = new Set([id, ...all.filter((s) => s.host === id).map((s) => s.id)]);
  const own = all.find((s) => s.id === id);
  return parts
    .filter((p) => !gone.has(p.id))
    .map((p) => {
      if (p.id !== own?.host) return { id: p.id, plan: p.plan };
      return { id: p.id, plan: clean({ ...p.plan, holes: p.plan.holes.filter((_, i) => i !== own.ring - 1) }) };
    });
}

/** The next free name of a part. */
export function freeId(building: string, parts: readonly NamedPlan[]): string {
  const numbers = parts.map((p) => Number(p.id.slice(building.length + 1))).filter(Number.isInteger);
  return `${building}-${Math.max(0, ...numbers, parts.length) + 1}`;
}

/** The highest face of a model over a point, and its height z. */
export function faceOver(g: Geometry, [x, y]: Point2): { ring: number | null; edge: number | null; z: number } | null {
  let best: { ring: number | null; edge: number | null; z: number } | null = null;
  const corner = (t: number, k: number) => {
    const i = 3 * g.triangles[3 * t + k]!;
    return [g.positions[i]!, g.positions[i + 1]!, g.positions[i + 2]!] as const;
  };
  for (let t = 0; t < g.face_of.length; ++t) {
    const [a, b, c] = [corner(t, 0), corner(t, 1), corner(t, 2)];
    const u: Point2 = [b[0] - a[0], b[1] - a[1]];
    const v: Point2 = [c[0] - a[0], c[1] - a[1]];
    const area = cross(u, v);
    if (area < 1e-9) continue; // walls, and faces that look down
    const at: Point2 = [x - a[0], y - a[1]];
    const [s, r] = [cross(at, v) / area, cross(u, at) / area];
    if (s < 0 || r < 0 || s + r > 1) continue;
    const z = a[2] + s * (b[2] - a[2]) + r * (c[2] - a[2]);
    const face = g.faces[g.face_of[t]!]!;
    if (!best || z > best.z) best = { ring: face.ring, edge: face.edge, z };
  }
  return best;
}

/** A new dormer with its front at a point, or at the nearest one within 3 m where it fits. `moved`: how far that is
 *  from the point, metres. Null if there is none. `geometry` is the host's. */
export function nearestDormer(
  building: string,
  parts: readonly NamedPlan[],
  host: string,
  geometry: Geometry,
  at: Point2,
): { id: string; parts: NamedPlan[]; moved: number } | null {
  const [step, most] = [0.25, 12];
  const offsets: Point2[] = [];
  for (let i = -most; i <= most; ++i) for (let j = -most; j <= most; ++j) offsets.push([i * step, j * step]);
  const near = offsets.filter((o) => Math.hypot(...o) <= most * step).sort((a, b) => Math.hypot(...a) - Math.hypot(...b));
  for (const offset of near) {
    const made = withDormer(building, parts, host, geometry, plus(at, offset));
    if (made) return { ...made, moved: Math.hypot(...offset) };
  }
  return null;
}

/** A new dormer with its front at a point, as large as usual or as there is room for. Null if the roof has no slope there, or
 *  no room. `geometry` is the host's. */
export function withDormer(
  building: string,
  parts: readonly NamedPlan[],
  host: string,
  geometry: Geometry,
  at: Point2,
): { id: string; parts: NamedPlan[] } | null {
  const plan = parts.find((p) => p.id === host)!.plan;
  const under = faceOver(geometry, at);
  if (!under || under.edge === null) return null;
  const slope = slopesOf(plan, under.ring ?? 0, under.edge).find((s) => Math.abs(heightOf(s, inwardOf(s, at)) + plan.base - under.z) < 0.02);
  if (!slope) return null;
  const [u, front] = [alongOf(slope, at), inwardOf(slope, at)];
  const free = (box: { left: number; right: number; front: number; back: number }) => {
    const steps = [0, 0.25, 0.5, 0.75, 1];
    const margin = 0.15;
    return steps.every((s) =>
      steps.every((r) => {
        const p = placeOf(
          slope,
          box.left - margin + s * (box.right - box.left + 2 * margin),
          box.front - margin + r * (box.back - box.front + 2 * margin),
        );
        const face = faceOver(geometry, p);
        return face?.edge === under.edge && (face.ring ?? 0) === (under.ring ?? 0) && Math.abs(heightOf(slope, inwardOf(slope, p)) + plan.base - face.z) < 0.05;
      }),
    );
  };
  for (const rise of usual.rises)
    for (const width of usual.widths) {
      const eaves = heightOf(slope, front) + rise;
      const box = { left: u - width / 2, right: u + width / 2, front, eaves };
      if (!free({ ...box, back: (eaves - slope.gutter) / slope.slope })) continue;
      const bare: Plan = {
        base: plan.base,
        cap: eaves,
        outer: { points: [], profile_of_edge: [0, 0, 0, 0] },
        holes: [],
        profiles: [[[0, 0], [0, eaves]]],
      };
      const made = built(bare, 0, box, slope, 0);
      const id = freeId(building, parts);
      const plans = new Map([[host, withHole(plan, null, made.hole, eaves, made.back)]]);
      return { id, parts: [...put(parts, plans), { id, plan: made.plan }] };
    }
  return null;
}

/** A part that is drawn on the roof of another one, with walls up to a flat roof. */
export function withStructure(
  building: string,
  parts: readonly NamedPlan[],
  host: string,
  geometry: Geometry,
  points: Point2[],
): { id: string; parts: NamedPlan[] } {
  const plan = parts.find((p) => p.id === host)!.plan;
  const heights = points.flatMap((p) => faceOver(geometry, p)?.z ?? []);
  const cap = (heights.length ? Math.max(...heights) - plan.base : plan.cap) + usualRise;
  const own = oriented({
    base: plan.base,
    cap,
    outer: { points, profile_of_edge: points.map(() => 0) },
    holes: [],
    profiles: [[[0, 0], [0, cap]]],
  });
  const id = freeId(building, parts);
  const plans = new Map([[host, withHole(plan, null, [...own.outer.points].reverse(), cap, null)]]);
  return { id, parts: [...put(parts, plans), { id, plan: own }] };
}

/** The rings of a host that structures fill. */
export const filledRings = (parts: readonly NamedPlan[], host: string) =>
  new Set(structuresOf(parts).flatMap((s) => (s.host === host ? [s.ring] : [])));
