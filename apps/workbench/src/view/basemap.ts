// A picture of the ground under the models.
import * as THREE from "three";
import type { Vector } from "./camera";
import { fade, meshLook, meshMaterial } from "./materials";
import { forget, textureFrom } from "./textures";

/** The bytes of a basemap: float64 west, south, east, north; a PNG. Null if they are damaged. */
export function decodeBasemap(bytes: ArrayBuffer) {
  if (bytes.byteLength <= 32) return null;
  const [west, south, east, north] = [...new Float64Array(bytes, 0, 4)] as [number, number, number, number];
  if (!(west < east && south < north)) return null;
  return { west, south, east, north, image: new Uint8Array(bytes, 32) };
}

export class Basemap {
  readonly group = new THREE.Group();
  private readonly look = meshLook();
  private material: THREE.ShaderMaterial | null = null;
  private bytes: ArrayBuffer | null = null;
  private mesh: THREE.Mesh | null = null;
  private shown = 1;
  busy = false;

  constructor(private readonly arrived: () => void) {}

  /** `height`: of the plane, in the frame of the scene. */
  set(bytes: ArrayBuffer | null, centre: Vector, height: number) {
    const map = bytes && decodeBasemap(bytes);
    if (map && this.mesh && bytes === this.bytes) return this.place(map, centre, height);
    this.clear();
    this.bytes = bytes;
    if (!map) return;
    this.busy = true;
    void textureFrom(map.image)
      .then((texture) => {
        if (this.bytes !== bytes) return forget(texture);
        texture.generateMipmaps = true;
        texture.minFilter = THREE.LinearMipmapLinearFilter;
        texture.anisotropy = 4; // seen at a flat angle, the ground is blurred without
        this.material = meshMaterial(this.look, texture);
        const geometry = new THREE.PlaneGeometry(1, 1);
        const uv = geometry.getAttribute("uv") as THREE.BufferAttribute;
        for (let i = 0; i < uv.count; ++i) uv.setY(i, 1 - uv.getY(i)); // the first row of the picture is in the north
        this.mesh = new THREE.Mesh(geometry, this.material);
        this.place(map, centre, height);
        this.group.add(this.mesh);
        this.opacity = this.shown;
      })
      .catch(() => undefined) // the picture is damaged: there is none
      .finally(() => {
        this.busy = false;
        this.arrived();
      });
  }
  private place(map: NonNullable<ReturnType<typeof decodeBasemap>>, centre: Vector, height: number) {
    this.mesh?.scale.set(map.east - map.west, map.north - map.south, 1);
    this.mesh?.position.set((map.west + map.east) / 2 - centre[0], (map.south + map.north) / 2 - centre[1], height - centre[2]);
  }
  set opacity(value: number) {
    this.shown = value;
    this.group.visible = value > 0;
    this.look.opacity.value = value;
    if (this.material) fade(this.material, value);
  }
  /** Whether it is drawn; for tests. */
  get there() {
    return this.mesh !== null && this.group.visible;
  }
  clear() {
    this.bytes = null;
    if (this.material) forget(this.material.uniforms.picture!.value as THREE.Texture);
    this.material?.dispose();
    this.mesh?.geometry.dispose();
    this.mesh?.removeFromParent();
    this.mesh = this.material = null;
  }
}
