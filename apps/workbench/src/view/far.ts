// Buildings of a large run whose models are not loaded: prisms on their ground rings, a buffer per tile.
import * as THREE from "three";
import { type Large, type Shape, boxOfShapes } from "../large";
import type { Vector } from "./camera";
import type { Colour } from "./styling";
import { type ModelLook, modelMaterial } from "./materials";
import { type Hit, type Ray, enters } from "./pick";

const wall = 0; // indices into the kinds of geometry.ts
const roof = 2;

/** How near a tile has to be to the eye, in metres, for its roofs to have their outlines, and for its walls to be drawn. */
const outlinesWithin = 2000;
const wallsWithin = 800;
const slice = 12; // ms of building buffers, between which the page does other things
const pause = 700; // ms to the first image while they are built, twice as long to each next one: an image of a whole city takes seconds without a graphics card

/** How many vertices the roof and the walls of a prism have; its box has six. */
interface Counts {
  roof: number;
  walls: number;
}
const boxVertices = 6;

/** Positions, normals and kinds of some prisms, relative to a centre: first the box of each roof, then roofs, then walls. */
export function prisms(shapes: readonly Shape[], centre: Vector) {
  const positions: number[] = [];
  const normals: number[] = [];
  const kinds: number[] = [];
  const corner = (x: number, y: number, z: number, n: readonly number[], kind: number) => {
    positions.push(x - centre[0], y - centre[1], z - centre[2]);
    normals.push(...n);
    kinds.push(kind);
  };
  const up = [0, 0, 1];
  const rings = shapes.map(([base, height, ...flat]) => {
    const ring: THREE.Vector2[] = [];
    for (let i = 0; i < flat.length; i += 2) ring.push(new THREE.Vector2(flat[i]!, flat[i + 1]!));
    return { base: base!, top: base! + height!, ring };
  });
  for (const { top, ring } of rings) {
    const { min: a, max: b } = new THREE.Box2().setFromPoints(ring);
    for (const [x, y] of [[a.x, a.y], [b.x, a.y], [b.x, b.y], [a.x, a.y], [b.x, b.y], [a.x, b.y]] as const) corner(x, y, top, up, roof);
  }
  const boxes = kinds.length;
  const counts = rings.map((): Counts => ({ roof: 0, walls: 0 }));
  for (const [n, { top, ring }] of rings.entries()) {
    const before = kinds.length;
    const points = [...ring]; // triangulateShape may shorten what it is given
    for (const triangle of THREE.ShapeUtils.triangulateShape(points, []))
      for (const k of triangle) corner(ring[k]!.x, ring[k]!.y, top, up, roof);
    counts[n]!.roof = kinds.length - before;
  }
  const roofs = kinds.length - boxes;
  for (const [n, { base, top, ring }] of rings.entries()) {
    const before = kinds.length;
    ring.forEach((a, i) => {
      const b = ring[(i + 1) % ring.length]!;
      const length = Math.hypot(b.x - a.x, b.y - a.y);
      if (length === 0) return;
      const n = [(b.y - a.y) / length, (a.x - b.x) / length, 0];
      for (const [p, z] of [[a, base], [b, base], [b, top], [a, base], [b, top], [a, top]] as const) corner(p.x, p.y, z, n, wall);
    });
    counts[n]!.walls = kinds.length - before;
  }
  return { positions, normals, kinds, boxes, roofs, counts };
}

/** Red, green, blue and whether it is painted of each vertex of such prisms, 0 to 255. `colours`: of each prism. */
export function painted(counts: readonly Counts[], colours: readonly (Colour | undefined)[]): Uint8Array<ArrayBuffer> {
  const all = counts.reduce((sum, { roof, walls }) => sum + boxVertices + roof + walls, 0);
  const out = new Uint8Array(4 * all);
  let at = 0;
  for (const size of [() => boxVertices, ({ roof }: Counts) => roof, ({ walls }: Counts) => walls])
    counts.forEach((count, n) => {
      const colour = colours[n];
      const end = at + 4 * size(count);
      if (colour) {
        const [r, g, b] = colour.map((c) => Math.round(255 * c));
        for (; at < end; at += 4) out.set([r!, g!, b!, 255], at);
      }
      at = end;
    });
  return out;
}

interface Drawn {
  mesh: THREE.Mesh;
  boxes: number; // vertices
  roofs: number;
  counts: Counts[]; // of the prisms
  paints: ReadonlyMap<string, Colour> | null; // that it has
}

export class Far {
  readonly group = new THREE.Group();
  private readonly material: THREE.ShaderMaterial;
  private large: Large | null = null;
  private centre: Vector = [0, 0, 0];
  private readonly meshes = new Map<string, Drawn>();
  private waiting: string[] = [];
  private timer: ReturnType<typeof setTimeout> | undefined;
  private asked = 0;
  private pause = pause;
  private paints: ReadonlyMap<string, Colour> | null = null;

  constructor(
    look: ModelLook,
    private readonly arrived: () => void,
  ) {
    this.material = modelMaterial(look);
    // Prisms without colours of their own have no buffer for them.
    (this.material as THREE.ShaderMaterial & { defaultAttributeValues: Record<string, number[]> }).defaultAttributeValues = {
      ...this.material.defaultAttributeValues,
      paint: [0, 0, 0, 0],
    };
  }

  /** Colours the buildings; null: by the class of their faces. */
  paint(colours: ReadonlyMap<string, Colour> | null) {
    if (colours === this.paints) return;
    this.paints = colours;
    for (const [key, drawn] of this.meshes) if (drawn.mesh.visible) this.paintTile(key, drawn);
  }
  private paintTile(key: string, drawn: Drawn) {
    if (drawn.paints === this.paints) return;
    drawn.paints = this.paints;
    const { geometry } = drawn.mesh;
    if (!this.paints) {
      geometry.deleteAttribute("paint");
      return;
    }
    const { tiles, shapes, rows } = this.large!;
    const colours = tiles.get(key)!.buildings.flatMap((i) => shapes[i]!.map(() => this.paints!.get(rows[i]!.id)));
    geometry.setAttribute("paint", new THREE.BufferAttribute(painted(drawn.counts, colours), 4, true));
  }

  set(large: Large | null, centre: Vector) {
    const same = large?.tiles === this.large?.tiles && centre.every((c, i) => c === this.centre[i]);
    this.large = large;
    this.centre = centre;
    if (!same) {
      this.clear();
      this.waiting = [...(large?.tiles.keys() ?? [])];
      this.asked = performance.now();
      this.pause = pause;
      if (this.waiting.length) this.timer = setTimeout(this.build);
    }
    for (const [key, drawn] of this.meshes) {
      drawn.mesh.visible = !large?.loaded.has(key);
      if (drawn.mesh.visible) this.paintTile(key, drawn);
    }
  }

  /** Builds buffers for a moment, and goes on later. */
  private readonly build = () => {
    const { tiles, shapes, loaded } = this.large!;
    const until = performance.now() + slice;
    while (this.waiting.length && performance.now() < until) {
      const key = this.waiting.pop()!;
      const drawn = this.meshOf(tiles.get(key)!.buildings.flatMap((i) => shapes[i]!));
      drawn.mesh.visible = !loaded.has(key);
      if (drawn.mesh.visible) this.paintTile(key, drawn);
      this.meshes.set(key, drawn);
      this.group.add(drawn.mesh);
    }
    this.timer = this.waiting.length ? setTimeout(this.build, 4) : undefined;
    if (this.timer !== undefined && performance.now() < this.asked + this.pause) return;
    this.asked = performance.now();
    this.pause *= 2;
    this.arrived();
  };

  /** Chooses how much of each tile is drawn. `eye`: relative to the centre. */
  seenFrom(eye: THREE.Vector3) {
    for (const { mesh, boxes, roofs } of this.meshes.values()) {
      if (!mesh.visible) continue;
      const { center, radius } = mesh.geometry.boundingSphere!;
      const away = eye.distanceTo(center) - radius;
      if (away > outlinesWithin) mesh.geometry.setDrawRange(0, boxes);
      else mesh.geometry.setDrawRange(boxes, away > wallsWithin ? roofs : Infinity);
    }
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

  private meshOf(shapes: readonly Shape[]): Drawn {
    const { positions, normals, kinds, boxes, roofs, counts } = prisms(shapes, this.centre);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(positions), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(Int8Array.from(normals, (n) => Math.round(127 * n)), 3, true));
    geometry.setAttribute("kind", new THREE.BufferAttribute(Uint8Array.from(kinds), 1));
    geometry.computeBoundingSphere();
    return { mesh: new THREE.Mesh(geometry, this.material), boxes, roofs, counts, paints: null };
  }

  clear() {
    clearTimeout(this.timer);
    for (const { mesh } of this.meshes.values()) {
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
