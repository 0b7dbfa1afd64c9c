// The scan's pictures on the models: fetched for the buildings nearest to where the camera looks, within a bound of memory.
import * as THREE from "three";
import type { RaisedBuilding } from "../api/types";
import type { Vector } from "./camera";
import { boxOf, kinds } from "./geometry";
import { type ModelLook, pictureMaterial } from "./materials";

const keptAtMost = 160e6; // bytes of pictures, as the graphics card has them
const atOnce = 2; // fetches

/** The bytes of a building's texture, as openapi.json describes them; null where the scan shows nothing, or they are damaged. */
export function decodeFaces(bytes: ArrayBuffer): { revision: number; frames: Float64Array; image: Uint8Array } | null {
  if (bytes.byteLength < 8) return null;
  const [revision, faces] = new Uint32Array(bytes, 0, 2) as unknown as [number, number];
  const end = 8 + 64 * faces;
  if (faces === 0 || bytes.byteLength <= end) return null;
  return { revision, frames: new Float64Array(bytes, 8, 8 * faces), image: new Uint8Array(bytes, end) };
}

/** A picture for the graphics card: its first row is at v = 0. */
export async function textureFrom(image: Uint8Array): Promise<THREE.Texture> {
  const bitmap = await createImageBitmap(new Blob([image as Uint8Array<ArrayBuffer>]), {
    colorSpaceConversion: "none",
    premultiplyAlpha: "none",
  });
  const texture = new THREE.Texture(bitmap);
  texture.flipY = false;
  texture.generateMipmaps = false;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
export function forget(texture: THREE.Texture) {
  (texture.image as ImageBitmap | null)?.close();
  texture.dispose();
}

/** Corners, classes and places in the picture of all triangles of a building; null if it has other faces. */
export function pictured(building: RaisedBuilding, frames: Float64Array, centre: Vector) {
  const geometries = building.parts.flatMap((p) => (p.geometry ? [p.geometry] : []));
  if (8 * geometries.reduce((sum, g) => sum + g.faces.length, 0) !== frames.length) return null;
  const corners = geometries.reduce((sum, g) => sum + g.triangles.length, 0);
  const positions = new Float32Array(3 * corners);
  const uv = new Float32Array(2 * corners);
  const kind = new Float32Array(corners);
  let [first, at] = [0, 0];
  for (const g of geometries) {
    g.triangles.forEach((v, i) => {
      const face = g.face_of[Math.floor(i / 3)]!;
      const frame = frames.subarray(8 * (first + face), 8 * (first + face + 1));
      const p = g.positions.slice(3 * v, 3 * v + 3);
      for (let k = 0; k < 3; ++k) positions[3 * at + k] = p[k]! - centre[k]!;
      for (let k = 0; k < 2; ++k)
        uv[2 * at + k] = frame[4 * k]! * p[0]! + frame[4 * k + 1]! * p[1]! + frame[4 * k + 2]! * p[2]! + frame[4 * k + 3]!;
      kind[at++] = Math.max(0, kinds.indexOf(g.faces[face]!.class));
    });
    first += g.faces.length;
  }
  return { positions, uv, kinds: kind };
}

interface Worn {
  revision: number;
  mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial> | null; // null: the scan does not show it
  bytes: number;
}

export class ModelTextures {
  readonly group = new THREE.Group();
  private readonly worn = new Map<string, Worn>();
  private readonly coming = new Set<string>();
  private buildings: ReadonlyMap<string, RaisedBuilding & { revision: number }> = new Map();
  private drafts: ReadonlyMap<string, unknown> = new Map();
  private near: Vector = [0, 0, 0];
  private on = false;
  private gone = false;

  constructor(
    private readonly centre: Vector,
    private readonly look: ModelLook,
    private readonly load: (building: string) => Promise<ArrayBuffer>,
    private readonly arrived: () => void,
  ) {}

  get busy() {
    return this.coming.size > 0;
  }
  /** Buildings with pictures; for tests. */
  get count() {
    return [...this.worn.values()].filter((w) => w.mesh?.visible).length;
  }

  show(on: boolean) {
    this.on = on;
    this.group.visible = on;
    if (!on) this.clear();
    this.next();
  }
  set(buildings: ReadonlyMap<string, RaisedBuilding & { revision: number }>, drafts: ReadonlyMap<string, unknown>) {
    this.buildings = buildings;
    this.drafts = drafts;
    for (const [id, worn] of this.worn) {
      const now = buildings.get(id);
      if (!now || now.revision !== worn.revision) this.remove(id);
      else if (worn.mesh) worn.mesh.visible = !drafts.has(id); // while it is dragged it is plain
    }
    this.next();
  }
  /** The place that the camera looks at; buildings near it come first. */
  lookAt(place: Vector) {
    this.near = place;
    this.next();
  }

  private away(id: string) {
    const { low, high } = boxOf(this.buildings.get(id)!);
    return Math.hypot(...[0, 1].map((i) => Math.max(low[i]! - this.near[i]!, 0, this.near[i]! - high[i]!)));
  }

  private next() {
    if (!this.on || this.gone) return;
    const order = [...this.buildings.keys()].map((id) => ({ id, away: this.away(id) })).sort((a, b) => a.away - b.away);
    let bytes = 0;
    for (const { id } of order) {
      const worn = this.worn.get(id);
      if (worn) {
        bytes += worn.bytes;
        if (bytes > keptAtMost) this.remove(id);
      } else if (bytes < keptAtMost && this.coming.size < atOnce && !this.coming.has(id)) {
        void this.fetch(id);
      }
      if (!worn && bytes < keptAtMost && this.coming.size >= atOnce) return; // what is farther away stays until then
    }
  }

  private async fetch(id: string) {
    this.coming.add(id);
    const asked = this.buildings.get(id)!;
    const worn: Worn = { revision: asked.revision, mesh: null, bytes: 0 };
    let texture: THREE.Texture | null = null;
    try {
      const answer = decodeFaces(await this.load(id));
      if (answer && answer.revision === asked.revision) {
        const drawn = pictured(asked, answer.frames, this.centre);
        texture = drawn && (await textureFrom(answer.image));
        if (drawn && texture) {
          const geometry = new THREE.BufferGeometry();
          geometry.setAttribute("position", new THREE.BufferAttribute(drawn.positions, 3));
          geometry.setAttribute("uv", new THREE.BufferAttribute(drawn.uv, 2));
          geometry.setAttribute("kind", new THREE.BufferAttribute(drawn.kinds, 1));
          worn.mesh = new THREE.Mesh(geometry, pictureMaterial(this.look, texture));
          const { width, height } = texture.image as ImageBitmap;
          worn.bytes = 4 * width * height;
        }
      }
    } catch {
      // It stays plain: the server was restarted, or the picture is damaged.
    }
    this.coming.delete(id);
    const now = this.buildings.get(id);
    if (this.gone || !this.on || now?.revision !== worn.revision) {
      worn.mesh?.geometry.dispose();
      worn.mesh?.material.dispose();
      if (texture) forget(texture);
    } else {
      this.worn.set(id, worn);
      if (worn.mesh) {
        worn.mesh.visible = !this.drafts.has(id);
        this.group.add(worn.mesh);
      }
    }
    if (this.gone) return;
    this.next();
    this.arrived();
  }

  private remove(id: string) {
    const mesh = this.worn.get(id)?.mesh;
    if (mesh) {
      mesh.removeFromParent();
      mesh.geometry.dispose();
      forget(mesh.material.uniforms.picture!.value as THREE.Texture);
      mesh.material.dispose();
    }
    this.worn.delete(id);
  }
  private clear() {
    for (const id of [...this.worn.keys()]) this.remove(id);
  }
  dispose() {
    this.gone = true;
    this.clear();
    this.group.removeFromParent();
  }
}
