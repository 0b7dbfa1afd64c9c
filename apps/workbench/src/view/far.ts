// Buildings of a large run whose models are not loaded: prisms on their ground rings, a buffer per tile.
import * as THREE from "three";
import { type Large, type Shape, boxOfShapes } from "../large";
import type { Vector } from "./camera";
import { type ModelLook, modelMaterial } from "./materials";
import { type Hit, type Ray, enters } from "./pick";

const wall = 0; // indices into the kinds of geometry.ts
const roof = 2;

/** Positions, normals and kinds of the walls and roofs of some prisms, relative to a centre. */
export function prisms(shapes: readonly Shape[], centre: Vector) {
  const positions: number[] = [];
  const normals: number[] = [];
  const kinds: number[] = [];
  const corner = (x: number, y: number, z: number, n: readonly number[], kind: number) => {
    positions.push(x - centre[0], y - centre[1], z - centre[2]);
    normals.push(...n);
    kinds.push(kind);
  };
  for (const [base, height, ...flat] of shapes) {
    const ring: THREE.Vector2[] = [];
    for (let i = 0; i < flat.length; i += 2) ring.push(new THREE.Vector2(flat[i]!, flat[i + 1]!));
    const top = base! + height!;
    ring.forEach((a, i) => {
      const b = ring[(i + 1) % ring.length]!;
      const length = Math.hypot(b.x - a.x, b.y - a.y);
      if (length === 0) return;
      const n = [(b.y - a.y) / length, (a.x - b.x) / length, 0];
      for (const [p, z] of [[a, base!], [b, base!], [b, top], [a, base!], [b, top], [a, top]] as const) corner(p.x, p.y, z, n, wall);
    });
    const points = [...ring]; // triangulateShape may shorten what it is given
    for (const triangle of THREE.ShapeUtils.triangulateShape(points, []))
      for (const k of triangle) corner(ring[k]!.x, ring[k]!.y, top, [0, 0, 1], roof);
  }
  return { positions, normals, kinds };
}

export class Far {
  readonly group = new THREE.Group();
  private readonly material: THREE.ShaderMaterial;
  private large: Large | null = null;
  private centre: Vector = [0, 0, 0];
  private readonly meshes = new Map<string, THREE.Mesh>();
  private waiting: string[] = [];

  constructor(look: ModelLook) {
    this.material = modelMaterial(look);
  }

  set(large: Large | null, centre: Vector) {
    const same = large?.tiles === this.large?.tiles && centre.every((c, i) => c === this.centre[i]);
    this.large = large;
    this.centre = centre;
    if (!same) {
      this.clear();
      this.waiting = [...(large?.tiles.keys() ?? [])];
    }
    for (const [key, mesh] of this.meshes) mesh.visible = !large?.loaded.has(key);
  }

  /** Builds tiles for some milliseconds, those near a point first; whether some are left. */
  build(near: Vector, milliseconds: number): boolean {
    if (!this.large || !this.waiting.length) return false;
    const { tiles, shapes, loaded } = this.large;
    const away = (key: string) => {
      const { low, high } = tiles.get(key)!;
      return Math.hypot((low[0] + high[0]) / 2 - near[0], (low[1] + high[1]) / 2 - near[1]);
    };
    const order = this.waiting.map((key) => ({ key, at: away(key) })).sort((a, b) => b.at - a.at);
    const until = performance.now() + milliseconds;
    while (order.length && performance.now() < until) {
      const { key } = order.pop()!;
      const mesh = this.meshOf(tiles.get(key)!.buildings.flatMap((i) => shapes[i]!));
      mesh.visible = !loaded.has(key);
      this.meshes.set(key, mesh);
      this.group.add(mesh);
    }
    this.waiting = order.map((o) => o.key);
    return this.waiting.length > 0;
  }
  get busy() {
    return this.waiting.length > 0;
  }

  /** The nearest building that the ray meets whose models are not loaded, by its box. */
  pick(ray: Ray): Hit | null {
    let best: Hit | null = null;
    for (const [key, tile] of this.large?.tiles ?? []) {
      if (this.large!.loaded.has(key)) continue;
      const first = enters(ray, tile);
      if (first === null || (best && first > best.distance)) continue;
      for (const i of tile.buildings) {
        const distance = enters(ray, boxOfShapes(this.large!.shapes[i]!));
        if (distance === null || (best && distance >= best.distance)) continue;
        const point = ray.origin.map((o, k) => o + ray.direction[k]! * distance) as Vector;
        best = { building: this.large!.rows[i]!.id, part: null, ring: 0, edge: null, point, distance };
      }
    }
    return best;
  }

  private meshOf(shapes: readonly Shape[]) {
    const { positions, normals, kinds } = prisms(shapes, this.centre);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(positions), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(Int8Array.from(normals, (n) => Math.round(127 * n)), 3, true));
    geometry.setAttribute("kind", new THREE.BufferAttribute(Uint8Array.from(kinds), 1));
    geometry.setAttribute("paint", new THREE.BufferAttribute(new Uint8Array(4 * kinds.length), 4, true));
    geometry.computeBoundingSphere();
    return new THREE.Mesh(geometry, this.material);
  }

  clear() {
    for (const mesh of this.meshes.values()) {
      mesh.geometry.dispose();
      mesh.removeFromParent();
    }
    this.meshes.clear();
    this.waiting = [];
  }
  dispose() {
    this.clear();
    this.material.dispose();
  }
}
