// The terrain around the models of the run.
import * as THREE from "three";
import type { Vector } from "./camera";
import { colours, fade, meshLook, meshMaterial } from "./materials";

/** The bytes of a terrain, as openapi.json describes them; null if they are damaged. */
export function decodeTerrain(bytes: ArrayBuffer) {
  if (bytes.byteLength < 32) return null;
  const centre = [...new Float64Array(bytes, 0, 3)] as Vector;
  const [vertices, triangles] = [...new Uint32Array(bytes, 24, 2)] as [number, number];
  if (bytes.byteLength !== 32 + 12 * (vertices + triangles)) return null;
  return {
    centre,
    positions: new Float32Array(bytes, 32, 3 * vertices),
    indices: new Uint32Array(bytes, 32 + 12 * vertices, 3 * triangles),
  };
}

export class Terrain {
  readonly group = new THREE.Group();
  private readonly look = meshLook();
  private readonly material = meshMaterial(this.look, null, colours.terrain);
  /** Triangles that are drawn; for tests. */
  triangles = 0;

  set(bytes: ArrayBuffer | null, about: Vector) {
    for (const child of [...this.group.children]) {
      (child as THREE.Mesh).geometry.dispose();
      child.removeFromParent();
    }
    const terrain = bytes && decodeTerrain(bytes);
    this.triangles = terrain ? terrain.indices.length / 3 : 0;
    if (!terrain) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(terrain.positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(terrain.indices, 1));
    const mesh = new THREE.Mesh(geometry, this.material);
    mesh.position.set(...(terrain.centre.map((c, i) => c - about[i]!) as Vector));
    this.group.add(mesh);
  }
  set opacity(value: number) {
    this.group.visible = value > 0;
    this.look.opacity.value = value;
    fade(this.material, value);
  }
}
