// Solids as buffers to draw: flat-shaded triangles and the outlines of faces, relative to a centre.
import type { Geometry, Plan, RaisedBuilding, RaisedPart, SurfaceClass } from "../api/types";
import type { Vector } from "./camera";

export interface Buffers {
  positions: Float32Array; // three corners of three numbers per triangle
  normals: Float32Array;
  kinds: Float32Array; // per corner: index into `kinds`
  lines: Float32Array; // two ends of three numbers per line
}

export const kinds: readonly SurfaceClass[] = ["wall", "party_wall", "roof", "ground", "soffit"];
const kindOf = new Map(kinds.map((k, i) => [k, i]));

export interface Box {
  low: Vector;
  high: Vector;
}
export const emptyBox = (): Box => ({ low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] });
export const isEmpty = (box: Box) => box.low[0] > box.high[0];
export function grow(box: Box, x: number, y: number, z: number) {
  const { low, high } = box;
  if (x < low[0]) low[0] = x;
  if (y < low[1]) low[1] = y;
  if (z < low[2]) low[2] = z;
  if (x > high[0]) high[0] = x;
  if (y > high[1]) high[1] = y;
  if (z > high[2]) high[2] = z;
}

const boxes = new WeakMap<Geometry, Box>();
export function boxOfGeometry(geometry: Geometry): Box {
  let box = boxes.get(geometry);
  if (!box) {
    box = emptyBox();
    const p = geometry.positions;
    for (let i = 0; i < p.length; i += 3) grow(box, p[i]!, p[i + 1]!, p[i + 2]!);
    boxes.set(geometry, box);
  }
  return box;
}

/** Box of a building as drawn; for parts without geometry, the box of the plan. */
export function boxOf(building: RaisedBuilding): Box {
  const box = emptyBox();
  for (const part of building.parts) {
    if (part.geometry?.positions.length) {
      const { low, high } = boxOfGeometry(part.geometry);
      grow(box, ...low);
      grow(box, ...high);
    } else {
      for (const [x, y] of part.plan.outer.points) {
        grow(box, x, y, part.plan.base);
        grow(box, x, y, part.plan.base + part.plan.cap);
      }
    }
  }
  return box;
}

/** Buffers of the faces that `keeps` accepts, or of all. */
export function buffersOf(
  geometries: readonly Geometry[],
  centre: Vector,
  keeps: (face: Geometry["faces"][number]) => boolean = () => true,
): Buffers {
  let corners = 0;
  for (const g of geometries) {
    for (const face of g.face_of) if (keeps(g.faces[face]!)) corners += 3;
  }
  const positions = new Float32Array(corners * 3);
  const normals = new Float32Array(corners * 3);
  const kind = new Float32Array(corners);
  const lines: number[] = [];
  let at = 0;
  for (const g of geometries) {
    const p = g.positions;
    for (let t = 0; t < g.face_of.length; ++t) {
      const face = g.faces[g.face_of[t]!]!;
      if (!keeps(face)) continue;
      const [a, b, c] = [g.triangles[3 * t]! * 3, g.triangles[3 * t + 1]! * 3, g.triangles[3 * t + 2]! * 3];
      const normal = normalOf(p, a, b, c);
      for (const v of [a, b, c]) {
        for (let i = 0; i < 3; ++i) {
          positions[at * 3 + i] = p[v + i]! - centre[i]!;
          normals[at * 3 + i] = normal[i]!;
        }
        kind[at++] = kindOf.get(face.class) ?? 0;
      }
    }
    outlines(g, centre, keeps, lines);
  }
  return { positions, normals, kinds: kind, lines: new Float32Array(lines) };
}

function normalOf(p: number[], a: number, b: number, c: number): Vector {
  const u = [p[b]! - p[a]!, p[b + 1]! - p[a + 1]!, p[b + 2]! - p[a + 2]!] as const;
  const v = [p[c]! - p[a]!, p[c + 1]! - p[a + 1]!, p[c + 2]! - p[a + 2]!] as const;
  const n: Vector = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const length = Math.hypot(...n);
  return length > 0 ? [n[0] / length, n[1] / length, n[2] / length] : [0, 0, 1];
}

/** Each edge once, though two faces have it. */
function outlines(g: Geometry, centre: Vector, keeps: (face: Geometry["faces"][number]) => boolean, to: number[]) {
  const vertices = g.positions.length / 3;
  const seen = new Set<number>();
  for (const face of g.faces) {
    if (!keeps(face)) continue;
    for (const loop of face.loops) {
      loop.forEach((a, i) => {
        const b = loop[(i + 1) % loop.length]!;
        const key = Math.min(a, b) * vertices + Math.max(a, b);
        if (seen.has(key)) return;
        seen.add(key);
        for (const v of [a, b]) for (let k = 0; k < 3; ++k) to.push(g.positions[3 * v + k]! - centre[k]!);
      });
    }
  }
}

export const solidsOf = (parts: readonly RaisedPart[]) =>
  parts.flatMap((p) => (p.geometry && p.geometry.face_of.length ? [p.geometry] : []));

export const ringOf = (plan: Plan, ring: number) => (ring === 0 ? plan.outer : plan.holes[ring - 1]);

/** A profile standing on an edge at `share` of its length: its points in space. Cut off at the plan's cap. */
export const standing = (plan: Plan, ring: number, edge: number, share: number, profile: ProfileLine) =>
  upright(plan, ring, edge, share, capped(profile, plan.cap));

export type ProfileLine = readonly (readonly [number, number])[];

/** Any line of (inward, height), placed upright across an edge. */
export function upright(plan: Plan, ring: number, edge: number, share: number, line: ProfileLine): Vector[] {
  const points = ringOf(plan, ring)?.points;
  if (!points || edge >= points.length) return [];
  const [a, b] = [points[edge]!, points[(edge + 1) % points.length]!];
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (length === 0) return [];
  const inward = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length] as const;
  const foot = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share] as const;
  const place = ([along, height]: readonly [number, number]): Vector => [
    foot[0] + inward[0] * along,
    foot[1] + inward[1] * along,
    plan.base + height,
  ];
  return line.map(place);
}

/** Height above the base up to which the faces of each edge extend. Profiles continue to the cap, but faces end where they meet
 *  those of other edges. */
export function reaches({
  plan,
  geometry,
}: Pick<RaisedPart, "plan" | "geometry">): (ring: number, edge: number) => number {
  const tops = new Map<string, number>();
  let top = -Infinity;
  for (const face of geometry?.faces ?? []) {
    for (const loop of face.loops) {
      for (const v of loop) {
        const height = geometry!.positions[3 * v + 2]! - plan.base;
        top = Math.max(top, height);
        if (face.ring === null || face.edge === null) continue;
        const key = `${face.ring} ${face.edge}`;
        tops.set(key, Math.max(tops.get(key) ?? -Infinity, height));
      }
    }
  }
  const otherwise = top > 0 ? Math.min(top, plan.cap) : plan.cap;
  return (ring, edge) => Math.min(tops.get(`${ring} ${edge}`) ?? otherwise, plan.cap);
}

/** The profile up to `cap`; its last segment is continued up to there. */
export function capped(profile: ProfileLine, cap: number): [number, number][] {
  const under: [number, number][] = [];
  for (let i = 0; i < profile.length; ++i) {
    const [x, h] = profile[i]!;
    if (h <= cap) {
      under.push([x, h]);
      continue;
    }
    const before = profile[i - 1];
    if (before && h > before[1]) under.push([before[0] + ((x - before[0]) * (cap - before[1])) / (h - before[1]), cap]);
    return under;
  }
  const [last, before] = [profile.at(-1), profile.at(-2)];
  if (last && last[1] < cap) {
    const climbs = before && last[1] > before[1];
    under.push([climbs ? last[0] + ((last[0] - before[0]) * (cap - last[1])) / (last[1] - before[1]) : last[0], cap]);
  }
  return under;
}
