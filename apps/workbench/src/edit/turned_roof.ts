// Roof planes with a direction of their own: corner edges (docs/extrude.md) are turned, made at a corner of a wall, and removed.
import type { Plan, Point2 } from "../api/types";
import { apart, clampedBetween, cornerAt, together, wallsAt, withDirection, withoutEdge } from "./corner_edges";
import { planeOf } from "./fitting";
import {
  after,
  before,
  clean,
  collinear,
  endsOf,
  isCorner,
  profileOf,
  ringOf,
  sameEdge,
  setProfile,
  wallsOf,
  type EdgeAt,
} from "./plan";
import { kindOf, lastRoof, pitchOf, slopes, type Profile } from "./profile";
import { cross, distance, dot, minus, plus, rotated, times, turnedLeft, unit } from "./vector";

const radians = (degrees: number) => (degrees * Math.PI) / 180;
const degrees = (angle: number) => (angle * 180) / Math.PI;
const between = (a: Point2, b: Point2) => Math.atan2(cross(a, b), dot(a, b));

/** A corner edge: its corner, its direction, and those of the walls beside it. */
export interface TurnedAt {
  corner: Point2;
  along: Point2;
  before: Point2;
  after: Point2;
}
export function turnedAt(plan: Plan, at: EdgeAt): TurnedAt | null {
  const ring = ringOf(plan, at.ring);
  const walls = ring && wallsAt(ring, at.edge);
  const ends = endsOf(plan, at);
  const along = ends && unit(minus(ends[1], ends[0]));
  return ring && walls && along ? { corner: cornerAt(ring, at.edge), along, ...walls } : null;
}

/** The direction of eaves: degrees clockwise from north, 0 to 180. */
export function bearingOf(along: Point2): number {
  const turn = degrees(Math.atan2(along[0], along[1])) % 180;
  const bearing = Math.round((turn < 0 ? turn + 180 : turn) * 1e6) / 1e6;
  return bearing === 180 ? 0 : bearing;
}

/** The plan with another direction of a corner edge; with the nearest one between its walls if it is not between them. */
export function turned(plan: Plan, at: EdgeAt, along: Point2): Plan {
  const ring = ringOf(plan, at.ring);
  if (!ring) return plan;
  const now = withDirection(ring, at.edge, along);
  return at.ring === 0 ? { ...plan, outer: now } : { ...plan, holes: plan.holes.map((h, i) => (i === at.ring - 1 ? now : h)) };
}
export function turnedBy(plan: Plan, at: EdgeAt, clockwise: number): Plan {
  const own = turnedAt(plan, at);
  return own ? turned(plan, at, rotated(own.along, -radians(clockwise))) : plan;
}
/** Of the two directions with this bearing the one that needs the smaller turn. */
export function turnedTo(plan: Plan, at: EdgeAt, bearing: number): Plan {
  const own = turnedAt(plan, at);
  if (!own) return plan;
  const way: Point2 = [Math.sin(radians(bearing)), Math.cos(radians(bearing))];
  const middle = rotated(own.before, between(own.before, own.after) / 2);
  return turned(plan, at, dot(way, middle) < 0 ? times(way, -1) : way);
}

/** The wall beside a corner edge that is nearest to its direction, and the angle between them, degrees. */
export function wallBeside(plan: Plan, at: EdgeAt): { at: EdgeAt; degrees: number } | null {
  const own = turnedAt(plan, at);
  const ring = ringOf(plan, at.ring);
  if (!own || !ring) return null;
  const [first, second] = [between(own.before, own.along), between(own.along, own.after)].map((a) => degrees(Math.abs(a)));
  return first! < second!
    ? { at: { ring: at.ring, edge: before(ring, at.edge) }, degrees: first! }
    : { at: { ring: at.ring, edge: after(ring, at.edge) }, degrees: second! };
}

/** How much a roof can rise where its plane is turned from `was` to `along`, metres. */
export function liftOf(plan: Plan, at: EdgeAt, was: Point2, along: Point2): number {
  const ring = ringOf(plan, at.ring);
  const profile = profileOf(plan, at);
  const corner = ring?.points[at.edge];
  const pitch = profile && lastRoof(profile) ? pitchOf(profile)! : 0;
  if (!corner || !Number.isFinite(pitch)) return 0;
  const across = minus(turnedLeft(along), turnedLeft(was));
  return pitch * Math.max(0, ...plan.outer.points.map((p) => dot(minus(p, corner), across)));
}

/** The cap of a part whose roof may rise by `up`, as of capOver(); one that is high enough stays. */
export const capAbove = (plan: Plan, ridge: number, up: number) =>
  plan.cap < ridge + 0.005 ? plan.cap : Math.max(plan.cap, ridge + up + 0.01);

export interface Turned {
  plan: Plan;
  at: EdgeAt; // the corner edge
}

/** From its wall, degrees; the usual direction of a new corner edge. */
const usualTurn = 5;
const trials = [2.5, 10, 15, 20];
const maximumTurn = 20;

/** Plans in which the roof of a wall rises from a corner edge at one of its corners, and the wall goes up to it. The likeliest
 *  comes first: parallel or at a right angle to other walls, then 5° from its own. None where it has no roof, or no corner for it. */
export function withTurnedRoof(plan: Plan, at: EdgeAt): Turned[] {
  const profile = profileOf(plan, at);
  const ring = ringOf(plan, at.ring);
  if (!profile || !ring || isCorner(plan, at) || slopes(profile).length === 0) return [];
  const edges = planeOf(plan, at);
  const others = wallsOf(plan).flatMap((e) => {
    const [a, b] = endsOf(plan, e)!;
    const own = unit(minus(b, a));
    return own ? [own, times(own, -1), turnedLeft(own), times(turnedLeft(own), -1)] : [];
  });
  const found: (Turned & { parallel: boolean; turn: number })[] = [];
  for (const edge of edges)
    for (const start of [true, false]) {
      const beside = { ring: at.ring, edge: start ? before(ring, edge.edge) : after(ring, edge.edge) };
      if (isCorner(plan, beside) || edges.some((e) => sameEdge(e, beside))) continue;
      const [a, b] = endsOf(plan, edge)!;
      const [c, d] = endsOf(plan, beside)!;
      const [own, other] = [unit(minus(b, a)), unit(minus(d, c))];
      if (!own || !other) continue;
      const [first, second] = start ? [other, own] : [own, other];
      // Where it rises from the start of the wall, it is turned clockwise from it, and otherwise to the other side.
      const sign = start ? -1 : 1;
      const tried: { along: Point2; parallel: boolean }[] = [
        ...others.map((along) => ({ along, parallel: true })),
        ...[usualTurn, ...trials].map((turn) => ({ along: rotated(own, sign * radians(turn)), parallel: false })),
      ];
      for (const { along, parallel } of tried) {
        const turn = degrees(sign * between(own, along));
        const held = clampedBetween(first, second, along);
        if (!held || distance(held, along) > 1e-9 || turn < 0.5 || turn > maximumTurn + 1e-6) continue;
        const corner: EdgeAt = { ring: at.ring, edge: start ? edge.edge : after(ring, edge.edge) };
        if (found.some((f) => sameEdge(f.at, corner) && distance(turnedAt(f.plan, f.at)!.along, along) < 1e-3)) continue;
        const made = madeAt(plan, edges, corner, along, profile);
        if (made) found.push({ ...made, parallel, turn });
      }
    }
  const rank = (f: { parallel: boolean; turn: number }) => (f.parallel ? f.turn - 100 : Math.abs(f.turn - usualTurn));
  return found.sort((a, b) => rank(a) - rank(b)).map((f) => ({ plan: f.plan, at: f.at }));
}

/** A corner edge at the start of edge `corner`, with the profile of `edges`, which become walls. */
function madeAt(plan: Plan, edges: EdgeAt[], corner: EdgeAt, along: Point2, profile: Profile): Turned | null {
  const walled = setProfile(plan, edges, [[0, 0], [0, plan.cap]]);
  const { plan: bare, corners, numberOf } = apart({ ...walled, profiles: [...walled.profiles, profile] });
  const place = numberOf(corner.ring, corner.edge);
  const overhang = ringOf(plan, corner.ring)!.overhang_of_edge?.[edges[0]!.edge];
  const made = together(bare, [
    ...corners,
    { ring: corner.ring, corner: place, along, profile: walled.profiles.length, ...(overhang ? { overhang } : {}) },
  ]);
  const at: EdgeAt = { ring: corner.ring, edge: corner.edge };
  const is = ringOf(made, at.ring)!.points.length === ringOf(plan, at.ring)!.points.length + 1 && isCorner(made, at);
  return is ? { plan: clean(made), at } : null;
}

/** The plan without a corner edge. Its roof goes to the wall beside it that is nearest to its direction, and to what continues
 *  that wall; if that has a roof, to the other one; to none if both have. `at`: the wall. */
export function withoutTurnedRoof(plan: Plan, at: EdgeAt): Turned | null {
  const own = turnedAt(plan, at);
  const ring = ringOf(plan, at.ring);
  const profile = profileOf(plan, at);
  if (!own || !ring || !profile) return null;
  const now = withoutEdge(ring, at.edge);
  const bare: Plan = at.ring === 0 ? { ...plan, outer: now } : { ...plan, holes: plan.holes.map((h, i) => (i === at.ring - 1 ? now : h)) };
  const n = now.points.length;
  const beside = [
    { at: { ring: at.ring, edge: (at.edge + n - 1) % n }, turn: between(own.before, own.along) },
    { at: { ring: at.ring, edge: at.edge % n }, turn: between(own.along, own.after) },
  ].sort((a, b) => a.turn - b.turn);
  const plain = (e: EdgeAt) => kindOf(profileOf(bare, e)!) === "wall";
  const wall = beside.find((b) => plain(b.at))?.at;
  if (!wall) return { plan: clean(bare), at: beside[0]!.at };
  const walls = [wall, ...collinear(bare, wall).filter(plain)];
  const given = setProfile(bare, walls, profile);
  const overhang = ring.overhang_of_edge?.[at.edge];
  if (!overhang) return { plan: given, at: wall };
  const hung = ringOf(given, at.ring)!;
  const over = { ...hung, overhang_of_edge: hung.overhang_of_edge!.map((o, i) => (walls.some((w) => w.edge === i) ? overhang : o)) };
  return { plan: at.ring === 0 ? { ...given, outer: over } : { ...given, holes: given.holes.map((h, i) => (i === at.ring - 1 ? over : h)) }, at: wall };
}

/** A rectangle around a part whose edge 0 is the eaves of the plane that rises from a corner edge. */
export function acrossTurned(plan: Plan, at: EdgeAt): Plan | null {
  const own = turnedAt(plan, at);
  if (!own) return null;
  const inward = turnedLeft(own.along);
  const along = plan.outer.points.map((p) => dot(minus(p, own.corner), own.along));
  const depth = Math.max(1, ...plan.outer.points.map((p) => dot(minus(p, own.corner), inward)));
  const place = (u: number, v: number) => plus(own.corner, plus(times(own.along, u), times(inward, v)));
  const [from, to] = [Math.min(...along), Math.max(...along)];
  return {
    ...plan,
    outer: { points: [place(from, 0), place(to, 0), place(to, depth), place(from, depth)], profile_of_edge: [0, 0, 0, 0] },
    holes: [],
  };
}
