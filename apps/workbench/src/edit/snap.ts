// Snapping of dragged corners, edges and profile points: to near geometry, otherwise to whole centimetres.
import type { Plan, Point2, ProfilePoint } from "../api/types";
import { apart } from "./corner_edges";
import { after, before, edgeName, edgesOf, endsOf, isCorner, profileOf, ringOf, sameEdge, type EdgeAt } from "./plan";
import { held, type Profile } from "./profile";
import {
  cross,
  distance,
  distanceToLine,
  dot,
  meeting,
  minus,
  nearestOn,
  onLine,
  plus,
  shareAlong,
  times,
  turnedLeft,
  unit,
  type Line,
} from "./vector";

export interface Snap {
  /** Snapping distance, metres. 0: only rounding. */
  reach: number;
  /** Rounding step, metres. */
  step: number;
  /** Spacing of a coarser grid to snap to, metres; 0 for none. */
  grid: number;
}
export interface Surroundings {
  corners: Point2[];
  edges: [Point2, Point2][];
}
/** What was snapped to: a label and a line to draw. */
export interface Guide {
  words: string;
  from: Point2;
  to: Point2;
}
export interface SnappedPoint {
  at: Point2;
  guides: Guide[];
}

export const rounded = (value: number, step: number) => {
  // Division by an integer gives 12.34; multiplication by 0.01 gives 12.340000000000002.
  const per = Math.round(1 / step);
  return per >= 1 && Math.abs(1 / step - per) < 1e-9 ? Math.round(value * per) / per : Math.round(value / step) * step;
};

/** Corners and edges of other plans, and those of the plan itself that do not move. */
export function surroundings(plan: Plan, others: Plan[], moves: (at: EdgeAt) => boolean): Surroundings {
  const found: Surroundings = { corners: [], edges: [] };
  const add = (whole: Plan, moves: (at: EdgeAt) => boolean) => {
    const { plan: p, numberOf } = apart(whole); // both ends of a corner edge are one corner
    const moving = edgesOf(whole).filter(moves).map((at) => ({ ring: at.ring, edge: numberOf(at.ring, at.edge) }));
    const skip = (at: EdgeAt) => moving.some((m) => sameEdge(m, at));
    for (const at of edgesOf(p)) {
      const ring = ringOf(p, at.ring)!;
      if (skip(at)) continue;
      found.corners.push(ring.points[at.edge]!);
      if (!skip({ ring: at.ring, edge: after(ring, at.edge) })) found.edges.push(endsOf(p, at)!);
    }
  };
  add(plan, moves);
  for (const other of others) add(other, () => false);
  return found;
}

/** A move of a whole part: along its first edge or across it if it is nearly that. */
export function snapMove(plan: Plan, by: Point2, { reach, step }: Snap): Point2 {
  const { points } = apart(plan).plan.outer;
  const along = unit(minus(points[1]!, points[0]!));
  if (!along) return by;
  let [a, b] = [dot(by, along), dot(by, turnedLeft(along))];
  if (reach > 0 && Math.abs(a) < Math.abs(b) / 4) a = 0;
  else if (reach > 0 && Math.abs(b) < Math.abs(a) / 4) b = 0;
  return plus(times(along, rounded(a, step)), times(turnedLeft(along), rounded(b, step)));
}

interface Candidate {
  line: Line;
  anchored: boolean; // lengths from its anchor are rounded
  words: string;
  limits: [Point2, Point2] | null; // ends of an edge
}

/** Lines through `anchor` at a right angle to the previous edge, straight on from it, or parallel to the main direction. */
function directions(anchor: Point2, beyond: Point2, main: Point2 | null): Candidate[] {
  const found: Candidate[] = [];
  const offer = (along: Point2 | null, words: string) => {
    if (along) found.push({ line: { at: anchor, along }, anchored: true, words, limits: null });
  };
  const incoming = unit(minus(anchor, beyond));
  if (incoming) {
    offer(turnedLeft(incoming), "right angle");
    offer(incoming, "straight on");
  }
  if (main) {
    offer(main, "parallel");
    offer(turnedLeft(main), "parallel");
  }
  return found;
}

/** The direction of the longest edge. */
export function mainDirection(plan: Plan, except: (at: EdgeAt) => boolean): Point2 | null {
  let best: Point2 | null = null;
  let length = 0;
  for (const at of edgesOf(plan)) {
    const [a, b] = endsOf(plan, at)!;
    if (except(at) || distance(a, b) <= length) continue;
    length = distance(a, b);
    best = unit(minus(b, a));
  }
  return best;
}

/** Snaps a corner that is dragged to `to`: to a corner, an intersection of two lines, a line, the grid, or rounds it. */
export function snapVertex(whole: Plan, corner: EdgeAt, to: Point2, around: Surroundings, snap: Snap): SnappedPoint {
  const { plan, numberOf } = apart(whole);
  return snapCorner(plan, { ring: corner.ring, edge: numberOf(corner.ring, corner.edge) }, to, around, snap);
}
function snapCorner(plan: Plan, at: EdgeAt, to: Point2, around: Surroundings, snap: Snap): SnappedPoint {
  const ring = ringOf(plan, at.ring);
  if (!ring || snap.reach <= 0) return { at: unsnapped(to, { ...snap, grid: 0 }), guides: [] };
  const previous = before(ring, at.edge);
  const next = after(ring, at.edge);
  // Snapping to an adjacent corner would give an edge without length.
  const beside = [ring.points[previous]!, ring.points[next]!];
  const free = around.corners.filter((c) => beside.every((b) => distance(b, c) > 1e-6));
  const corner = nearest(to, free, snap.reach);
  if (corner) return { at: corner, guides: [{ words: "corner", from: corner, to: corner }] };
  const own = (e: EdgeAt) => e.ring === at.ring && (e.edge === at.edge || e.edge === previous);
  const main = mainDirection(plan, own);
  const anchors: [Point2, Point2][] = [
    [ring.points[previous]!, ring.points[before(ring, previous)]!],
    [ring.points[next]!, ring.points[after(ring, next)]!],
  ];
  return alongLines(
    to,
    [...anchors.flatMap(([anchor, beyond]) => directions(anchor, beyond, main)), ...edgeLines(around)],
    snap,
  );
}

/** Snaps a newly drawn point of a courtyard or a split line. */
export function snapDrawn(plan: Plan, drawn: Point2[], to: Point2, around: Surroundings, snap: Snap): SnappedPoint {
  if (snap.reach <= 0) return { at: unsnapped(to, { ...snap, grid: 0 }), guides: [] };
  const corner = nearest(to, around.corners, snap.reach);
  if (corner) return { at: corner, guides: [{ words: "corner", from: corner, to: corner }] };
  const last = drawn.at(-1);
  const main = mainDirection(plan, () => false);
  const lines = last ? directions(last, drawn.at(-2) ?? last, main) : [];
  const first = drawn[0];
  if (first && drawn.length > 1) lines.push(...directions(first, drawn[1]!, null));
  return alongLines(to, [...lines, ...edgeLines(around)], snap);
}

const edgeLines = (around: Surroundings): Candidate[] =>
  around.edges.flatMap(([a, b]) => {
    const along = unit(minus(b, a));
    return along
      ? [{ line: { at: a, along }, anchored: false, words: "edge", limits: [a, b] as [Point2, Point2] }]
      : [];
  });

function nearest(to: Point2, points: Point2[], reach: number): Point2 | null {
  let best: Point2 | null = null;
  let least = reach;
  for (const p of points)
    if (distance(p, to) < least) {
      least = distance(p, to);
      best = p;
    }
  return best;
}

function alongLines(to: Point2, lines: Candidate[], snap: Snap): SnappedPoint {
  // A line through the corner beside it gives nothing at that corner: the edge would have no length.
  const atAnchor = (c: Candidate, at: Point2) => c.anchored && distance(c.line.at, at) < 1e-6;
  const guide = (c: Candidate, at: Point2): Guide => ({
    words: c.words,
    from: c.limits?.[0] ?? c.line.at,
    to: c.limits?.[1] ?? at,
  });
  const on = (c: Candidate): Point2 =>
    c.limits ? nearestOn(to, ...c.limits).at : onLine(c.line, rounded(shareAlong(to, c.line), snap.step));
  const near = lines
    .map((line) => ({ line, at: on(line) }))
    .map(({ line, at }) => ({ line, at, away: line.limits ? distance(at, to) : distanceToLine(to, line.line) }))
    .filter(({ line, at, away }) => away < snap.reach && !atAnchor(line, at))
    .sort((a, b) => a.away - b.away);
  const first = near[0];
  if (!first) return { at: unsnapped(to, snap), guides: [] };
  for (const second of near.slice(1)) {
    const at = meeting(first.line.line, second.line.line);
    if (!at || distance(at, to) >= 1.5 * snap.reach || atAnchor(first.line, at) || atAnchor(second.line, at)) continue;
    return { at, guides: [guide(first.line, at), guide(second.line, at)] };
  }
  return { at: first.at, guides: [guide(first.line, first.at)] };
}

function unsnapped(to: Point2, snap: Snap): Point2 {
  if (snap.grid > 0) {
    const on: Point2 = [rounded(to[0], snap.grid), rounded(to[1], snap.grid)];
    if (distance(on, to) < Math.max(snap.reach, 0)) return on;
  }
  return [rounded(to[0], snap.step), rounded(to[1], snap.step)];
}

/** Snaps the shift of an edge to its left: in line with a corner, to the grid, or rounds it. */
export function snapEdge(
  plan: Plan,
  at: EdgeAt,
  by: number,
  around: Surroundings,
  snap: Snap,
): { by: number; guides: Guide[] } {
  const ends = endsOf(plan, at);
  const along = ends && unit(minus(ends[1], ends[0]));
  if (!ends || !along || snap.reach <= 0) return { by: rounded(by, snap.step), guides: [] };
  let best: { by: number; guides: Guide[]; away: number } | null = null;
  for (const corner of around.corners) {
    const needed = cross(along, minus(corner, ends[0]));
    const away = Math.abs(needed - by);
    if (away >= snap.reach || (best && away >= best.away)) continue;
    const foot = onLine({ at: ends[0], along }, dot(minus(corner, ends[0]), along));
    best = { by: needed, away, guides: [{ words: "in line", from: corner, to: [foot[0], foot[1]] }] };
  }
  if (best) return { by: best.by, guides: best.guides };
  if (snap.grid > 0 && Math.abs(rounded(by, snap.grid) - by) < snap.reach)
    return { by: rounded(by, snap.grid), guides: [] };
  return { by: rounded(by, snap.step), guides: [] };
}

/** Radians; a direction snaps to those of other edges within this. */
const turnReach = (2.5 * Math.PI) / 180;

/** Snaps the direction of a corner edge: parallel or at a right angle to another edge; otherwise it is rounded to 0.1°. */
export function snapTurn(plan: Plan, at: EdgeAt, along: Point2, snap: Snap): { along: Point2; guides: Guide[] } {
  const corner = endsOf(plan, at)![0];
  const angle = (a: Point2, b: Point2) => Math.abs(Math.atan2(cross(a, b), dot(a, b)));
  let best: { along: Point2; words: string; away: number } | null = null;
  if (snap.reach > 0)
    for (const e of edgesOf(plan)) {
      const [a, b] = endsOf(plan, e)!;
      const own = unit(minus(b, a));
      if (!own || sameEdge(e, at)) continue;
      for (const [way, words] of [
        [own, "parallel to"],
        [times(own, -1), "parallel to"],
        [turnedLeft(own), "at a right angle to"],
        [times(turnedLeft(own), -1), "at a right angle to"],
      ] as const) {
        const away = angle(along, way);
        // Of edges in the same direction the first one, but walls before corner edges.
        const least = best ? best.away - (isCorner(plan, e) ? 1e-3 : 1e-6) : turnReach;
        if (away < least) best = { along: way, words: `${words} ${edgeName(plan, e)}`, away };
      }
    }
  if (best) {
    const arm = times(best.along, 6 * snap.reach);
    return { along: best.along, guides: [{ words: best.words, from: plus(corner, arm), to: minus(corner, arm) }] };
  }
  const step = ((snap.step < 0.01 ? 0.01 : 0.1) * Math.PI) / 180;
  const north = Math.round(Math.atan2(along[0], along[1]) / step) * step;
  return { along: [Math.sin(north), Math.cos(north)], guides: [] };
}

export interface ProfileSnap extends Snap {
  /** Slopes of other edges; those of adjacent edges first. */
  slopes: number[];
  /** Gutter heights of other edges. */
  heights: number[];
}
export interface SnappedProfilePoint {
  at: ProfilePoint;
  words: string[];
}

/** Snaps a profile point that is dragged to `to`: vertical, flat, to the pitch or height of another edge, or rounds it. The
 *  profile never leans outwards or goes down. */
export function snapProfilePoint(
  profile: Profile,
  i: number,
  to: ProfilePoint,
  snap: ProfileSnap,
): SnappedProfilePoint {
  const below = profile[i - 1];
  const above = profile[i + 1];
  const words: string[] = [];
  let inward: number | null = null;
  let height: number | null = null;
  if (snap.reach > 0) {
    const level = (values: (number | undefined)[], value: number) =>
      values
        .filter((v): v is number => v !== undefined && Math.abs(v - value) < snap.reach)
        .sort((a, b) => Math.abs(a - value) - Math.abs(b - value))[0] ?? null;
    inward = level([below?.[0], above?.[0]], to[0]);
    height = level([below?.[1], above?.[1]], to[1]);
    if (inward !== null) words.push("vertical");
    if (height !== null) words.push("flat");
    if (inward !== null && height !== null && repeats(profile, i, [inward, height])) {
      height = null;
      words.pop();
    }
    if (height === null) {
      height = level(snap.heights, to[1]);
      if (height !== null) words.push("same height");
    }
    if (inward === null) {
      const pitched = onPitch(below, above, to, height, snap);
      if (pitched) {
        words.push("same pitch");
        return { at: held(profile, i, pitched, snap.step), words };
      }
    }
  }
  const step = snap.reach > 0 && snap.grid > 0 ? snap.grid : snap.step;
  const at: ProfilePoint = [inward ?? rounded(to[0], step), height ?? rounded(to[1], step)];
  return { at: held(profile, i, at, snap.step), words };
}

const repeats = (profile: Profile, i: number, at: ProfilePoint) =>
  [profile[i - 1], profile[i + 1]].some((p) => p && p[0] === at[0] && p[1] === at[1]);

/** A point on a line of a known pitch through the point below or above; at `height`, if that was snapped already. */
function onPitch(
  below: ProfilePoint | undefined,
  above: ProfilePoint | undefined,
  to: ProfilePoint,
  height: number | null,
  snap: ProfileSnap,
): ProfilePoint | null {
  let best: ProfilePoint | null = null;
  let least = snap.reach;
  for (const slope of snap.slopes)
    for (const [anchor, way] of [
      [below, 1],
      [above, -1],
    ] as const) {
      if (!anchor) continue;
      const along = unit([1, slope])!;
      const line: Line = { at: anchor, along };
      const away = distanceToLine(to, line);
      const share = shareAlong(to, line) * way;
      if (away >= least || share < snap.reach) continue;
      const at: ProfilePoint =
        height !== null && slope > 1e-6
          ? [anchor[0] + (height - anchor[1]) / slope, height]
          : ((inward) => [inward, anchor[1] + slope * (inward - anchor[0])] as ProfilePoint)(
              rounded(onLine(line, share * way)[0], snap.step),
            );
      if ((at[0] - anchor[0]) * way <= 0) continue;
      least = away;
      best = at;
    }
  return best;
}

/** Distinct values to snap to, such as pitches and gutter heights of other edges; those of adjacent edges first. `except` are
 *  the edges that change: a point must not snap to its own previous position. */
export function known(plan: Plan, at: EdgeAt, except: EdgeAt[], of: (profile: Profile) => number[]): number[] {
  const ring = ringOf(plan, at.ring);
  if (!ring) return [];
  const near: EdgeAt[] = [
    { ring: at.ring, edge: before(ring, at.edge) },
    { ring: at.ring, edge: after(ring, at.edge) },
  ];
  const rest = edgesOf(plan).filter((e) => !near.some((n) => sameEdge(n, e)));
  const found: number[] = [];
  for (const e of [...near, ...rest]) {
    if (except.some((x) => sameEdge(x, e))) continue;
    for (const value of of(profileOf(plan, e) ?? []))
      if (!found.some((f) => Math.abs(f - value) < 1e-9)) found.push(value);
  }
  return found;
}
