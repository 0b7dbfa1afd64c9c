// Picking: the first face that a ray hits, computed from the coordinates of the models.
import type { GeometryFace, RaisedBuilding, SceneFootprint } from "../api/types";
import type { Vector } from "./camera";
import { type Box, boxOf, boxOfGeometry } from "./geometry";

export interface Ray {
  origin: Vector;
  direction: Vector;
}
export interface Hit {
  building: string;
  part: string | null;
  ring: number;
  edge: number | null;
  point: Vector;
  distance: number;
}

const kept = new WeakMap<RaisedBuilding, Box>();
function box(building: RaisedBuilding): Box {
  let known = kept.get(building);
  if (!known) kept.set(building, (known = boxOf(building)));
  return known;
}

/** Distance at which the ray enters a box; null if it misses. */
export function enters(ray: Ray, { low, high }: Box): number | null {
  let near = 0;
  let far = Infinity;
  for (let i = 0; i < 3; ++i) {
    const [o, d] = [ray.origin[i]!, ray.direction[i]!];
    if (d === 0) {
      if (o < low[i]! || o > high[i]!) return null;
      continue;
    }
    const [a, b] = [(low[i]! - o) / d, (high[i]! - o) / d];
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far ? near : null;
}

/** Distance to a triangle, hit from either side (Möller and Trumbore 1997). */
function meets(ray: Ray, p: number[], a: number, b: number, c: number): number | null {
  const [ox, oy, oz] = ray.origin;
  const [dx, dy, dz] = ray.direction;
  const [ax, ay, az] = [p[a]!, p[a + 1]!, p[a + 2]!];
  const [ux, uy, uz] = [p[b]! - ax, p[b + 1]! - ay, p[b + 2]! - az];
  const [vx, vy, vz] = [p[c]! - ax, p[c + 1]! - ay, p[c + 2]! - az];
  const [hx, hy, hz] = [dy * vz - dz * vy, dz * vx - dx * vz, dx * vy - dy * vx];
  const area = ux * hx + uy * hy + uz * hz;
  if (area === 0) return null;
  const [sx, sy, sz] = [ox - ax, oy - ay, oz - az];
  const u = (sx * hx + sy * hy + sz * hz) / area;
  if (u < 0 || u > 1) return null;
  const [qx, qy, qz] = [sy * uz - sz * uy, sz * ux - sx * uz, sx * uy - sy * ux];
  const v = (dx * qx + dy * qy + dz * qz) / area;
  if (v < 0 || u + v > 1) return null;
  const t = (vx * qx + vy * qy + vz * qz) / area;
  return t > 0 ? t : null;
}

const at = (ray: Ray, t: number) => ray.origin.map((o, i) => o + ray.direction[i]! * t) as Vector;

/** The nearest face that `sees` accepts, at a point that `keeps` accepts. */
export function pick(
  ray: Ray,
  buildings: Iterable<RaisedBuilding>,
  sees: (face: GeometryFace) => boolean = () => true,
  keeps: (point: Vector) => boolean = () => true,
): Hit | null {
  let best: Hit | null = null;
  for (const building of buildings) {
    const near = enters(ray, box(building));
    if (near === null || (best && near > best.distance)) continue;
    for (const part of building.parts) {
      const g = part.geometry;
      if (!g || enters(ray, boxOfGeometry(g)) === null) continue;
      for (let t = 0; t < g.face_of.length; ++t) {
        const [a, b, c] = [g.triangles[3 * t]!, g.triangles[3 * t + 1]!, g.triangles[3 * t + 2]!];
        const distance = meets(ray, g.positions, 3 * a, 3 * b, 3 * c);
        if (distance === null || (best && distance >= best.distance)) continue;
        const face = g.faces[g.face_of[t]!]!;
        const point = at(ray, distance);
        if (!sees(face) || !keeps(point)) continue;
        const edge = face.ring === null ? null : face.edge;
        best = { building: building.id, part: part.id, ring: face.ring ?? 0, edge, point, distance };
      }
    }
  }
  return best;
}

/** The first footprint that the ray hits at ground height. */
export function pickFootprint(
  ray: Ray,
  footprints: readonly SceneFootprint[],
  keeps: (point: Vector) => boolean = () => true,
): { footprint: SceneFootprint; point: Vector } | null {
  let best: { footprint: SceneFootprint; point: Vector; t: number } | null = null;
  if (ray.direction[2] === 0) return null;
  for (const footprint of footprints) {
    const t = (footprint.ground - ray.origin[2]) / ray.direction[2];
    if (t <= 0 || (best && t >= best.t)) continue;
    const point = at(ray, t);
    if (keeps(point) && covers(footprint, point[0], point[1])) best = { footprint, point, t };
  }
  return best;
}

export const covers = (footprint: Pick<SceneFootprint, "polygons">, x: number, y: number) =>
  footprint.polygons.some((p) => within(p.outer, x, y) && !p.holes.some((hole) => within(hole, x, y)));

function within(ring: readonly (readonly [number, number])[], x: number, y: number): boolean {
  let inside = false;
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
    const [[xi, yi], [xj, yj]] = [ring[i]!, ring[j]!];
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}
