// Streams the tiles of the mesh at the resolution that the view needs, within a budget of triangles.
import * as THREE from "three";
import type { TileIndex, TileInfo } from "../api/types";
import type { Vector } from "./camera";
import { Budget, type Eye, Levels } from "./levels";
import { fade, meshLook, meshMaterial } from "./materials";

const keptAtMost = 6_000_000; // triangles
const atOnce = 4; // fetches

/** A tile's bytes: uint32 vertices, uint32 triangles, float32 xyz…, uint32 indices…, all little-endian. */
export function decode(bytes: ArrayBuffer): { positions: Float32Array; indices: Uint32Array } | null {
  if (bytes.byteLength < 8) return null;
  const [vertices, triangles] = new Uint32Array(bytes, 0, 2);
  if (bytes.byteLength !== 8 + 12 * (vertices! + triangles!)) return null;
  return {
    positions: new Float32Array(bytes, 8, 3 * vertices!),
    indices: new Uint32Array(bytes, 8 + 12 * vertices!, 3 * triangles!),
  };
}

export class Tiles {
  readonly group = new THREE.Group();
  readonly look = meshLook();
  private readonly material = meshMaterial(this.look);
  readonly budget = new Budget();
  private readonly levels: Levels;
  private readonly loaded = new Map<string, { mesh: THREE.Mesh; tile: TileInfo; used: number }>();
  private readonly coming = new Set<string>();
  private readonly failed = new Set<string>();
  private readonly gone = new AbortController();
  private wanted: TileInfo[] = [];
  private round = 0;

  constructor(
    index: TileIndex,
    private readonly centre: Vector,
    private readonly load: (id: string, signal: AbortSignal) => Promise<ArrayBuffer>,
    private readonly arrived: () => void,
  ) {
    this.levels = new Levels(index.tiles);
  }

  get busy() {
    return this.coming.size > 0;
  }

  /** To be called before each image. */
  update(eye: Eye) {
    ++this.round;
    const { draw, fetch } = this.levels.choose(eye, (id) => this.loaded.has(id), this.budget.triangles);
    for (const { mesh } of this.loaded.values()) mesh.visible = false;
    for (const tile of draw) {
      const entry = this.loaded.get(tile.id)!;
      entry.mesh.visible = true;
      entry.used = this.round;
    }
    this.wanted = fetch.filter((t) => !this.failed.has(t.id));
    this.evict();
    this.fetchMore();
  }

  set opacity(value: number) {
    this.look.opacity.value = value;
    this.group.visible = value > 0;
    fade(this.material, value);
  }

  /** The points at which a ray meets the drawn tiles, nearest first; relative to the centre. */
  meets(ray: THREE.Raycaster): THREE.Vector3[] {
    if (!this.group.visible) return [];
    const drawn = [...this.loaded.values()].filter((e) => e.mesh.visible).map((e) => e.mesh);
    return ray.intersectObjects(drawn, false).map((hit) => hit.point);
  }

  dispose() {
    this.gone.abort();
    for (const { mesh } of this.loaded.values()) mesh.geometry.dispose();
    this.material.dispose();
    this.look.mask.value?.dispose();
    this.group.removeFromParent();
  }

  private fetchMore() {
    for (const tile of this.wanted) {
      if (this.coming.size >= atOnce) return;
      if (!this.coming.has(tile.id) && !this.loaded.has(tile.id)) void this.fetch(tile);
    }
  }

  private async fetch(tile: TileInfo) {
    this.coming.add(tile.id);
    try {
      const data = decode(await this.load(tile.id, this.gone.signal));
      if (this.gone.signal.aborted) return;
      if (data) this.add(tile, data.positions, data.indices);
      else this.failed.add(tile.id);
    } catch {
      this.failed.add(tile.id); // the coarser tile stays visible
    } finally {
      this.coming.delete(tile.id);
      if (!this.gone.signal.aborted) {
        this.fetchMore();
        this.arrived();
      }
    }
  }

  private add(tile: TileInfo, positions: Float32Array, indices: Uint32Array) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    const half = tile.low.map((l, i) => (tile.high[i]! - l) / 2);
    const middle = tile.low.map((l, i) => (l + tile.high[i]!) / 2 - tile.centre[i]!) as Vector;
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(...middle), Math.hypot(...half));
    const mesh = new THREE.Mesh(geometry, this.material);
    mesh.position.set(...(tile.centre.map((c, i) => c - this.centre[i]!) as Vector));
    mesh.visible = false;
    this.loaded.set(tile.id, { mesh, tile, used: this.round });
    this.group.add(mesh);
  }

  /** Removes the least recently drawn tiles above the limit. */
  private evict() {
    let triangles = 0;
    for (const { tile } of this.loaded.values()) triangles += tile.triangles;
    if (triangles <= keptAtMost) return;
    const idle = [...this.loaded.values()].filter((e) => e.used < this.round).sort((a, b) => a.used - b.used);
    for (const { mesh, tile } of idle) {
      if (triangles <= keptAtMost) return;
      triangles -= tile.triangles;
      mesh.geometry.dispose();
      this.group.remove(mesh);
      this.loaded.delete(tile.id);
    }
  }
}
