// Streams the tiles of the mesh at the resolution that the view needs, within a budget of triangles.
import * as THREE from "three";
import type { TileIndex, TileInfo } from "../api/types";
import type { Vector } from "./camera";
import { Budget, type Eye, Levels } from "./levels";
import { fade, meshLook, meshMaterial } from "./materials";
import { forget, textureFrom } from "./textures";

const keptAtMost = 6_000_000; // triangles
const atOnce = 4; // fetches
const picturesAtOnce = 2;
const picturesAtMost = 160e6; // bytes, as the graphics card has them

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

/** The bytes of a tile's texture: uint32 triangles, uint16 u v of each of their corners, a PNG. Null where there is none. */
export function decodePicture(bytes: ArrayBuffer): { uv: Uint16Array; image: Uint8Array } | null {
  if (bytes.byteLength < 4) return null;
  const triangles = new Uint32Array(bytes, 0, 1)[0]!;
  const end = 4 + 12 * triangles;
  if (triangles === 0 || bytes.byteLength <= end) return null;
  return { uv: new Uint16Array(bytes, 4, 6 * triangles), image: new Uint8Array(bytes, end) };
}

interface Loaded {
  mesh: THREE.Mesh;
  tile: TileInfo;
  used: number;
  pictured: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial> | null;
  noPicture: boolean;
  bytes: number; // of its picture
}

export class Tiles {
  readonly group = new THREE.Group();
  readonly look = meshLook();
  private readonly material = meshMaterial(this.look);
  readonly budget = new Budget();
  private readonly levels: Levels;
  private readonly loaded = new Map<string, Loaded>();
  private readonly painting = new Set<string>();
  private textured = false;
  private readonly coming = new Set<string>();
  private readonly failed = new Set<string>();
  private readonly gone = new AbortController();
  private wanted: TileInfo[] = [];
  private round = 0;

  constructor(
    index: TileIndex,
    private readonly centre: Vector,
    private readonly load: (id: string, signal: AbortSignal) => Promise<ArrayBuffer>,
    private readonly loadPicture: (id: string, signal: AbortSignal) => Promise<ArrayBuffer>,
    private readonly arrived: () => void,
  ) {
    this.levels = new Levels(index.tiles);
  }

  get busy() {
    return this.coming.size + this.painting.size > 0;
  }
  /** Tiles that are drawn with pictures; for tests. */
  get pictures() {
    return [...this.loaded.values()].filter((e) => e.pictured?.visible).length;
  }

  /** Draws tiles with the pictures of the scan, where it has some. */
  set textures(on: boolean) {
    if (this.textured === on) return;
    this.textured = on;
    if (!on) for (const entry of this.loaded.values()) this.strip(entry);
    this.arrived();
  }

  /** To be called before each image. `ahead`: where the camera will be next; what is needed there is loaded last. `tolerance`:
   *  error in pixels of what is drawn. */
  update(eye: Eye, ahead: readonly Eye[] = [], tolerance?: number) {
    ++this.round;
    const { draw, fetch } = this.levels.choose(eye, (id) => this.loaded.has(id), this.budget.triangles, tolerance);
    for (const { mesh, pictured } of this.loaded.values()) {
      mesh.visible = false;
      if (pictured) pictured.visible = false;
    }
    for (const tile of draw) {
      const entry = this.loaded.get(tile.id)!;
      (entry.pictured ?? entry.mesh).visible = true;
      entry.used = this.round;
    }
    if (this.textured) this.paint(draw);
    const later = ahead.flatMap((next) => this.levels.choose(next, (id) => this.loaded.has(id), this.budget.triangles).fetch);
    this.wanted = [...fetch, ...later].filter((t) => !this.failed.has(t.id));
    this.evict();
    this.fetchMore();
  }

  set opacity(value: number) {
    this.look.opacity.value = value;
    this.group.visible = value > 0;
    fade(this.material, value);
    for (const { pictured } of this.loaded.values()) if (pictured) fade(pictured.material, value);
  }

  /** The points at which a ray meets the drawn tiles, nearest first; relative to the centre. */
  meets(ray: THREE.Raycaster): THREE.Vector3[] {
    if (!this.group.visible) return [];
    const drawn = [...this.loaded.values()].filter((e) => e.mesh.visible || e.pictured?.visible).map((e) => e.mesh);
    return ray.intersectObjects(drawn, false).map((hit) => hit.point);
  }

  dispose() {
    this.gone.abort();
    for (const entry of this.loaded.values()) {
      this.strip(entry);
      entry.mesh.geometry.dispose();
    }
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
    this.loaded.set(tile.id, { mesh, tile, used: this.round, pictured: null, noPicture: false, bytes: 0 });
    this.group.add(mesh);
  }

  // ---- pictures

  private paint(drawn: TileInfo[]) {
    for (const tile of drawn) {
      const entry = this.loaded.get(tile.id)!;
      if (this.painting.size >= picturesAtOnce) return;
      if (!entry.pictured && !entry.noPicture && !this.painting.has(tile.id) && this.room()) void this.fetchPicture(entry);
    }
  }

  /** Whether another picture fits; those that are not drawn make room, the least recently drawn first. */
  private room(): boolean {
    const with_pictures = [...this.loaded.values()].filter((e) => e.pictured);
    let bytes = with_pictures.reduce((sum, e) => sum + e.bytes, 0);
    for (const entry of with_pictures.filter((e) => e.used < this.round).sort((a, b) => a.used - b.used)) {
      if (bytes < picturesAtMost) break;
      bytes -= entry.bytes;
      this.strip(entry);
    }
    return bytes < picturesAtMost;
  }

  private async fetchPicture(entry: Loaded) {
    const { id } = entry.tile;
    this.painting.add(id);
    let texture: THREE.Texture | null = null;
    try {
      const data = decodePicture(await this.loadPicture(id, this.gone.signal));
      texture = data && data.uv.length === 6 * entry.tile.triangles ? await textureFrom(data.image) : null;
      if (data && texture && this.textured && !this.gone.signal.aborted && this.loaded.get(id) === entry) {
        this.wear(entry, data.uv, texture);
        texture = null;
      }
      entry.noPicture = !data;
    } catch {
      entry.noPicture = true; // it stays plain
    } finally {
      if (texture) forget(texture);
      this.painting.delete(id);
      if (!this.gone.signal.aborted) this.arrived();
    }
  }

  /** A mesh whose triangles have corners of their own: each has its own place in the picture. */
  private wear(entry: Loaded, uv: Uint16Array, texture: THREE.Texture) {
    const geometry = entry.mesh.geometry.toNonIndexed();
    geometry.setAttribute("uv", new THREE.BufferAttribute(uv, 2, true));
    geometry.boundingSphere = entry.mesh.geometry.boundingSphere;
    entry.pictured = new THREE.Mesh(geometry, meshMaterial(this.look, texture));
    entry.pictured.position.copy(entry.mesh.position);
    entry.pictured.visible = false;
    fade(entry.pictured.material, this.look.opacity.value);
    const { width, height } = texture.image as ImageBitmap;
    entry.bytes = 4 * width * height;
    this.group.add(entry.pictured);
  }

  private strip(entry: Loaded) {
    const { pictured } = entry;
    if (pictured) {
      pictured.removeFromParent();
      pictured.geometry.dispose();
      forget(pictured.material.uniforms.picture!.value as THREE.Texture);
      pictured.material.dispose();
    }
    entry.pictured = null;
    entry.noPicture = false;
    entry.bytes = 0;
  }

  /** Removes the least recently drawn tiles above the limit. */
  private evict() {
    let triangles = 0;
    for (const { tile } of this.loaded.values()) triangles += tile.triangles;
    if (triangles <= keptAtMost) return;
    const idle = [...this.loaded.values()].filter((e) => e.used < this.round).sort((a, b) => a.used - b.used);
    for (const entry of idle) {
      const { mesh, tile } = entry;
      if (triangles <= keptAtMost) return;
      triangles -= tile.triangles;
      this.strip(entry);
      mesh.geometry.dispose();
      this.group.remove(mesh);
      this.loaded.delete(tile.id);
    }
  }
}
