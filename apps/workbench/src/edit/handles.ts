// Handles of a roof in the 3D view: its eaves, its ridges, and its faces; and what dragging them does to the plan.
import type { Plan, Point2, RaisedPart } from "../api/types";
import { profileFault } from "./check";
import { planeOf } from "./fitting";
import { changeProfiles, endsOf, profileOf, sameEdge, type EdgeAt } from "./plan";
import { gutterOf, gutterPoint, lastRoof, slopeTo, withGutter, withSlope, type Profile } from "./profile";
import { distance, dot, minus, turnedLeft, unit } from "./vector";

type Vector = [number, number, number];

/** A side that carries roof: edges on one line with one profile. */
export interface Side {
  edges: EdgeAt[];
  inward: Point2; // of length 1
}
interface Common {
  key: string; // the same while it is dragged
  at: Vector;
  /** Outward normals of the faces that it belongs to: seen from behind all of them it is hidden. */
  normals: Vector[];
}
export type Handle = Common &
  (
    | { kind: "eave"; side: Side; height: number }
    | { kind: "ridge"; sides: [Side, Side]; reach: [number, number]; height: number } // reach: inward from the edges of each side
    | { kind: "face"; side: Side; segment: number; normal: Vector }
    | { kind: "top"; height: number }
  );

const shortest = 0.3; // m; of a ridge that has a handle
const level = 0.05; // rise over run; of a ridge at most
const mostHandles = 60;

const keyOf = (edges: readonly EdgeAt[]) => edges.map((e) => `${e.ring}.${e.edge}`).sort().join(" ");

/** The handles of a part as it was extruded last; none of one without a model. */
export function handlesOf({ plan, geometry }: Pick<RaisedPart, "plan" | "geometry">, hidden: ReadonlySet<number> = new Set()): Handle[] {
  if (!geometry) return [];
  const sides = new Map<string, Side>();
  const sideOf = (at: EdgeAt): Side | null => {
    const ends = endsOf(plan, at);
    const along = ends && unit(minus(ends[1], ends[0]));
    if (!along) return null;
    const edges = planeOf(plan, at);
    const key = keyOf(edges);
    if (!sides.has(key)) sides.set(key, { edges, inward: turnedLeft(along) });
    return sides.get(key)!;
  };
  const point = (v: number) => geometry.positions.slice(3 * v, 3 * v + 3) as Vector;
  interface Face {
    side: Side;
    segment: number;
    centre: Vector;
    normal: Vector;
    area: number;
  }
  const faces = new Map<number, Face>();
  const tops: { at: Vector; area: number }[] = [];
  const middles = middlesOf(geometry);
  geometry.faces.forEach((face, f) => {
    if (face.class !== "roof") return;
    const { centre, normal, area } = middles[f]!;
    if (!(area > 0)) return;
    const side = face.ring === null || face.edge === null || hidden.has(face.ring) ? null : sideOf({ ring: face.ring, edge: face.edge });
    if (face.ring === null || face.edge === null) tops.push({ at: centre, area });
    if (!side) return;
    const own = side.edges.find((e) => e.ring === face.ring && e.edge === face.edge)!;
    const segment = segmentAt(plan, own, centre);
    if (segment !== null) faces.set(f, { side, segment, centre, normal, area });
  });

  const found: Handle[] = [...ridgesOf(geometry, faces, point, plan)];
  for (const side of sides.values()) {
    const own = [...faces.values()].filter((f) => f.side === side);
    if (!own.length) continue;
    const longest = side.edges.reduce((a, b) => (distance(...endsOf(plan, b)!) > distance(...endsOf(plan, a)!) ? b : a));
    const profile = profileOf(plan, longest)!;
    const [a, b] = endsOf(plan, longest)!;
    const i = gutterPoint(profile);
    if (i !== null) {
      const [inward, height] = profile[i]!;
      const at: Vector = [(a[0] + b[0]) / 2 + side.inward[0] * inward, (a[1] + b[1]) / 2 + side.inward[1] * inward, plan.base + height];
      const normals: Vector[] = [[-side.inward[0], -side.inward[1], 0], ...own.map((f) => f.normal)];
      found.push({ kind: "eave", key: `eave ${keyOf(side.edges)}`, at, normals, side, height });
    }
    for (const segment of new Set(own.map((f) => f.segment))) {
      const largest = own.filter((f) => f.segment === segment).reduce((x, y) => (y.area > x.area ? y : x));
      found.push({ kind: "face", key: `face ${segment} ${keyOf(side.edges)}`, at: largest.centre, normals: [largest.normal], side, segment, normal: largest.normal });
    }
  }
  if (tops.length) {
    const at = tops.reduce((x, y) => (y.area > x.area ? y : x)).at;
    found.push({ kind: "top", key: "top", at, normals: [[0, 0, 1]], height: plan.cap });
  }
  return found.slice(0, mostHandles);
}

/** Of each face: the centre of its area, and its normal. */
function middlesOf(g: NonNullable<RaisedPart["geometry"]>): { centre: Vector; normal: Vector; area: number }[] {
  const all = g.faces.map(() => ({ centre: [0, 0, 0] as Vector, normal: [0, 0, 0] as Vector, area: 0 }));
  for (let t = 0; t < g.face_of.length; ++t) {
    const of = all[g.face_of[t]!]!;
    const [a, b, c] = [0, 1, 2].map((k) => g.positions.slice(3 * g.triangles[3 * t + k]!, 3 * g.triangles[3 * t + k]! + 3)) as [Vector, Vector, Vector];
    const [u, v] = [b.map((x, i) => x - a[i]!), c.map((x, i) => x - a[i]!)] as [Vector, Vector];
    const n: Vector = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const size = Math.hypot(...n);
    of.area += size;
    for (let i = 0; i < 3; ++i) {
      of.centre[i]! += (size * (a[i]! + b[i]! + c[i]!)) / 3;
      of.normal[i]! += n[i]!;
    }
  }
  return all.map(({ centre, normal, area }) => {
    const length = Math.hypot(...normal);
    return { centre: centre.map((x) => x / area) as Vector, normal: normal.map((x) => x / length) as Vector, area };
  });
}

const inwardOf = (plan: Plan, at: EdgeAt, p: readonly number[]): number => {
  const [a, b] = endsOf(plan, at)!;
  return dot([p[0]! - a[0], p[1]! - a[1]], turnedLeft(unit(minus(b, a))!));
};

/** The segment of an edge's profile, by the index of its end, in which a point is; null if it is in none that slopes. */
function segmentAt(plan: Plan, at: EdgeAt, p: Vector): number | null {
  const profile = profileOf(plan, at)!;
  const inward = inwardOf(plan, at, p);
  const off = profile.map((b, i) => {
    const slope = slopeTo(profile, i);
    const a = profile[i - 1];
    const last = i === profile.length - 1;
    if (!a || slope === null || !Number.isFinite(slope) || inward < a[0] - 0.05 || (!last && inward > b[0] + 0.05)) return Infinity;
    return Math.abs(a[1] + slope * (inward - a[0]) - (p[2] - plan.base));
  });
  const i = off.indexOf(Math.min(...off));
  return off[i]! < 0.1 ? i : null;
}

/** Level lines at which two slopes meet that rise towards each other. */
function ridgesOf(
  g: NonNullable<RaisedPart["geometry"]>,
  faces: ReadonlyMap<number, { side: Side; segment: number; normal: Vector }>,
  point: (v: number) => Vector,
  plan: Plan,
): Handle[] {
  const at = new Map<string, number>();
  const best = new Map<string, { length: number; handle: Handle }>();
  // Corners of two faces may be different vertices of one place.
  const name = (v: number) => point(v).map((x) => x.toFixed(3)).join(" ");
  for (const [f, face] of faces) {
    for (const loop of g.faces[f]!.loops) {
      loop.forEach((v, i) => {
        const w = loop[(i + 1) % loop.length]!;
        const other = at.get(`${name(w)} ${name(v)}`);
        at.set(`${name(v)} ${name(w)}`, f);
        const two = other === undefined ? undefined : faces.get(other);
        if (!two || two.side === face.side) return;
        const [p, q] = [point(v), point(w)];
        const length = Math.hypot(q[0] - p[0], q[1] - p[1]);
        if (length < shortest || Math.abs(q[2] - p[2]) > level * length) return;
        if (dot(face.side.inward, two.side.inward) > -0.5 || face.normal[2] > 0.9999 || two.normal[2] > 0.9999) return;
        const both = [face, two].map((s) => profileOf(plan, s.side.edges[0]!)!);
        if ([face, two].some((s, k) => s.segment !== lastRoof(both[k]!))) return;
        const middle = p.map((x, i) => (x + q[i]!) / 2) as Vector;
        const key = `ridge ${[keyOf(face.side.edges), keyOf(two.side.edges)].sort().join(" – ")}`;
        if ((best.get(key)?.length ?? 0) >= length) return;
        const reach = [face, two].map((s) => inwardOf(plan, s.side.edges[0]!, middle)) as [number, number];
        // The side whose edge comes first is the first, whichever face was met first.
        const first = keyOf(face.side.edges) < keyOf(two.side.edges);
        best.set(key, {
          length,
          handle: {
            kind: "ridge",
            key,
            at: middle,
            normals: [face.normal, two.normal],
            sides: first ? [face.side, two.side] : [two.side, face.side],
            reach: first ? reach : [reach[1], reach[0]],
            height: middle[2] - plan.base,
          },
        });
      });
    }
  }
  return [...best.values()].sort((a, b) => b.length - a.length).map((b) => b.handle);
}

// ---- dragging

const lowest = 0.05; // m above the base
const flattest = 0.01; // rise over run
const steepest = 8;
const narrowest = 0.1; // m, of a slope in plan

/** The cap of a part whose roof rises by `up`: as much higher, so that it does not cut the ridge off; as it is where it does so
 *  already. `ridge`: of the part, above its base. */
export const capOver = (plan: Plan, ridge: number, up: number) => (plan.cap < ridge + 0.005 ? plan.cap : plan.cap + Math.max(0, up));

/** The plan with a handle moved: up, and for a ridge to the side, in the direction inward from its first side; metres. A face moves
 *  along its normal. `ridge`: of the part, above its base. Null where that gives no roof. */
export function moved(plan: Plan, ridge: number, handle: Handle, by: { up: number; aside?: number }): Plan | null {
  switch (handle.kind) {
    case "top":
      return plan.cap + by.up < lowest ? null : { ...plan, cap: plan.cap + by.up };
    case "eave": {
      const height = handle.height + by.up;
      if (height < lowest) return null;
      const changed = changeProfiles(plan, handle.side.edges, (p) => (gutterOf(p) === null ? null : withGutter(p, height)));
      return { ...changed, cap: capOver(plan, ridge, by.up) };
    }
    case "face": {
      const rise = by.up / handle.normal[2];
      const own = profileOf(plan, handle.side.edges[0]!)!;
      const profile = shifted(own, handle.segment, rise);
      if (!profile) return null;
      return { ...changeProfiles(plan, handle.side.edges, () => profile), cap: capOver(plan, ridge, rise) };
    }
    case "ridge": {
      const top = handle.height + by.up;
      const aside = by.aside ?? 0;
      const cosine = dot(handle.sides[0].inward, handle.sides[1].inward);
      let now: Plan = { ...plan, cap: capOver(plan, ridge, by.up) };
      for (const [k, side] of handle.sides.entries()) {
        const reach = handle.reach[k]! + (k === 0 ? aside : aside * cosine);
        const profile = profileOf(plan, side.edges[0]!)!;
        const i = lastRoof(profile);
        const [from, foot] = profile[i - 1]!;
        const slope = (top - foot) / (reach - from);
        if (i < 1 || reach - from < narrowest || slope < flattest || slope > steepest) return null;
        now = changeProfiles(now, side.edges, (p) => withSlope(p, lastRoof(p), slope));
      }
      return now;
    }
  }
}

/** A profile with the plane of the segment that ends at `i` moved up: its ends slide along the segments beside it. Null where one
 *  of these would be gone. */
export function shifted(profile: Profile, i: number, up: number): Profile | null {
  const [a, b] = [profile[i - 1], profile[i]];
  const slope = slopeTo(profile, i);
  if (!a || !b || slope === null || !Number.isFinite(slope)) return null;
  const slid = (p: readonly [number, number], beside: number | null): [number, number] | null => {
    if (beside === null || beside === Infinity) return [p[0], p[1] + up];
    if (Math.abs(beside - slope) < 1e-6) return null;
    const by = up / (beside - slope);
    return [p[0] + by, p[1] + beside * by];
  };
  const from = i === 1 ? null : slid(a, slopeTo(profile, i - 1));
  if (!from || from[1] < lowest) return null;
  const to = i + 1 < profile.length ? slid(b, slopeTo(profile, i + 1)) : ([b[0] + from[0] - a[0], b[1] + from[1] - a[1]] as [number, number]);
  if (!to || to[0] - from[0] < 0.01) return null;
  const next = profile.map((p, n): [number, number] => (n === i - 1 ? from : n === i ? to : p));
  const turned = next.some((p, n) => n > 0 && (p[0] < next[n - 1]![0] - 1e-9 || p[1] < next[n - 1]![1] - 1e-9));
  return turned || profileFault(next) ? null : next;
}

/** Pitches of the sides of a handle, degrees. */
export function pitchesOf(plan: Plan, handle: Handle): number[] {
  if (handle.kind === "top") return [];
  const sides = handle.kind === "ridge" ? handle.sides : [handle.side];
  return sides.flatMap((s) => {
    const profile = profileOf(plan, s.edges[0]!);
    const i = handle.kind === "face" ? handle.segment : profile ? lastRoof(profile) : 0;
    const slope = profile && i > 0 ? slopeTo(profile, i) : null;
    return slope === null || !Number.isFinite(slope) ? [] : [(Math.atan(slope) * 180) / Math.PI];
  });
}

export const isOn = (handle: Handle, at: EdgeAt) =>
  handle.kind !== "top" && (handle.kind === "ridge" ? handle.sides : [handle.side]).some((s) => s.edges.some((e) => sameEdge(e, at)));
