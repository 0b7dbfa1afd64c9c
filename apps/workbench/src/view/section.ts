// Section planes: through a point, in any direction; and the cut faces of solids, to be filled.
import * as THREE from "three";
import type { Geometry, RaisedBuilding } from "../api/types";
import type { Vector } from "./camera";
import { type Box, boxOf } from "./geometry";

/** Everything on one side of the plane is hidden. Angles in degrees. */
export interface SectionPlane {
  origin: Vector; // in the frame of the scene
  azimuth: number; // of the plane's normal: 0 looks north and grows clockwise
  tilt: number; // of the normal above the horizon: 0 for a vertical plane, 90 for a horizontal one
  offset: number; // m along the normal
  flipped: boolean;
}

const radians = (degrees: number) => (degrees * Math.PI) / 180;

export function normalOf({ azimuth, tilt }: Pick<SectionPlane, "azimuth" | "tilt">): Vector {
  const [a, t] = [radians(azimuth), radians(tilt)];
  return [Math.cos(t) * Math.sin(a), Math.cos(t) * Math.cos(a), Math.sin(t)];
}

const dot = (a: readonly number[], b: readonly number[]) => a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;

/** The plane as normal · p = at. */
export function planeOf(section: SectionPlane): { normal: Vector; at: number } {
  const normal = normalOf(section);
  return { normal, at: dot(normal, section.origin) + section.offset };
}

/** The range of the offsets at which the plane meets a box. */
export function reach(section: SectionPlane, { low, high }: Box): [number, number] {
  const normal = normalOf(section);
  const from = dot(normal, section.origin);
  let [least, most] = [Infinity, -Infinity];
  for (let corner = 0; corner < 8; ++corner) {
    const p = [0, 1, 2].map((i) => ((corner >> i) & 1 ? high[i]! : low[i]!));
    const at = dot(normal, p) - from;
    least = Math.min(least, at);
    most = Math.max(most, at);
  }
  return [least, most];
}

/** A section across the middle of a building, at right angles to its longest edge, where roofs show their shape. */
export function across(building: RaisedBuilding): SectionPlane {
  const { low, high } = boxOf(building);
  let [longest, azimuth] = [0, 0];
  for (const { plan } of building.parts) {
    plan.outer.points.forEach(([x, y], i) => {
      const [nx, ny] = plan.outer.points[(i + 1) % plan.outer.points.length]!;
      const length = Math.hypot(nx - x, ny - y);
      if (length <= longest) return;
      longest = length;
      azimuth = (Math.atan2(nx - x, ny - y) * 180) / Math.PI; // the plane's normal is along the edge
    });
  }
  const origin = low.map((l, i) => (l + high[i]!) / 2) as Vector;
  return { origin, azimuth: Math.round(((azimuth % 180) + 180) % 180), tilt: 0, offset: 0, flipped: false };
}

/** The closed lines in which a plane cuts a closed solid. Each corner lies on an edge of the solid, so that lines close
 *  exactly. Corners of the solid in the plane count as above it. */
export function cutLines(geometry: Geometry, normal: Vector, at: number): Vector[][] {
  const p = geometry.positions;
  const height = (v: number) => {
    const d = normal[0] * p[3 * v]! + normal[1] * p[3 * v + 1]! + normal[2] * p[3 * v + 2]! - at;
    return d === 0 ? 1e-12 : d;
  };
  const vertices = p.length / 3;
  const next = new Map<number, number>(); // from edge to edge, in the direction of the triangles
  const point = new Map<number, Vector>();
  const cross = (a: number, b: number): number => {
    const key = Math.min(a, b) * vertices + Math.max(a, b);
    if (!point.has(key)) {
      const [low, high] = a < b ? [a, b] : [b, a];
      const [da, db] = [height(low), height(high)];
      const t = da / (da - db);
      point.set(key, [0, 1, 2].map((i) => p[3 * low + i]! + t * (p[3 * high + i]! - p[3 * low + i]!)) as Vector);
    }
    return key;
  };
  for (let t = 0; t < geometry.face_of.length; ++t) {
    const corners = [0, 1, 2].map((i) => geometry.triangles[3 * t + i]!);
    const above = corners.map((v) => height(v) > 0);
    if (above[0] === above[1] && above[1] === above[2]) continue;
    let [enters, leaves] = [-1, -1];
    for (let i = 0; i < 3; ++i) {
      const j = (i + 1) % 3;
      if (above[i] === above[j]) continue;
      const key = cross(corners[i]!, corners[j]!);
      if (above[i]) enters = key;
      else leaves = key;
    }
    next.set(enters, leaves);
  }
  const lines: Vector[][] = [];
  while (next.size) {
    const [start] = next.keys();
    const line: Vector[] = [];
    for (let key = start!; next.has(key); ) {
      line.push(point.get(key)!);
      const to = next.get(key)!;
      next.delete(key);
      key = to;
    }
    if (line.length > 2) lines.push(line);
  }
  return lines;
}

/** Triangles that fill the cut, in the plane: three corners of three numbers each. */
export const capOf = (geometry: Geometry, normal: Vector, at: number) => filling(cutLines(geometry, normal, at), normal);

/** Triangles that fill closed lines in a plane. */
export function filling(lines: readonly Vector[][], normal: Vector): number[] {
  if (!lines.length) return [];
  // Two axes in the plane.
  const up: Vector = Math.abs(normal[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1];
  const u = unit([
    up[1] * normal[2] - up[2] * normal[1],
    up[2] * normal[0] - up[0] * normal[2],
    up[0] * normal[1] - up[1] * normal[0],
  ]);
  const v: Vector = [
    normal[1] * u[2] - normal[2] * u[1],
    normal[2] * u[0] - normal[0] * u[2],
    normal[0] * u[1] - normal[1] * u[0],
  ];
  const flat = lines.map((line) => line.map((q) => new THREE.Vector2(dot(u, q), dot(v, q))));
  const area = flat.map((ring) => THREE.ShapeUtils.area(ring));
  // A line inside an odd number of others is a hole of the smallest of them.
  const inside = (q: THREE.Vector2, ring: THREE.Vector2[]) => {
    let odd = false;
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
      const [a, b] = [ring[i]!, ring[j]!];
      if (a.y > q.y !== b.y > q.y && q.x < ((b.x - a.x) * (q.y - a.y)) / (b.y - a.y) + a.x) odd = !odd;
    }
    return odd;
  };
  const around = flat.map((ring, i) =>
    flat.flatMap((other, j) => (i !== j && Math.abs(area[j]!) > Math.abs(area[i]!) && inside(ring[0]!, other) ? [j] : [])),
  );
  const out: number[] = [];
  lines.forEach((line, i) => {
    if (around[i]!.length % 2 === 1) return;
    const holes = lines.flatMap((_, j) => (around[j]!.length === around[i]!.length + 1 && around[j]!.includes(i) ? [j] : []));
    const places = [line, ...holes.map((j) => lines[j]!)].flat();
    for (const triangle of THREE.ShapeUtils.triangulateShape(flat[i]!, holes.map((j) => flat[j]!)))
      for (const corner of triangle) out.push(...places[corner]!);
  });
  return out;
}

const unit = (a: Vector): Vector => {
  const length = Math.hypot(...a);
  return a.map((x) => x / length) as Vector;
};
