// Models of other programs, to compare with those of a run.
import * as THREE from "three";
import type { OtherModel } from "../api/types";
import type { Vector } from "./camera";

const classColours: Record<string, number> = { wall: 0xbfd0bd, roof: 0x5b8c5a, ground: 0x787c78 };

export class Others {
  readonly group = new THREE.Group();
  private readonly material = new THREE.ShaderMaterial({
    uniforms: { opacity: { value: 1 } },
    clipping: true,
    side: THREE.DoubleSide,
    vertexColors: true,
    vertexShader: /* glsl */ `
      #include <clipping_planes_pars_vertex>
      varying vec3 shade;
      varying vec3 place;
      void main() {
        shade = color;
        place = position;
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: /* glsl */ `
      #include <clipping_planes_pars_fragment>
      uniform float opacity;
      varying vec3 shade;
      varying vec3 place;
      void main() {
        #include <clipping_planes_fragment>
        vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
        float light = 0.62 + 0.36 * max(dot(normal, normalize(vec3(-0.45, -0.7, 1.0))), 0.0);
        gl_FragColor = vec4(shade * light, opacity);
      }`,
  });

  set(models: readonly OtherModel[], centre: Vector) {
    for (const child of [...this.group.children]) {
      (child as THREE.Mesh).geometry.dispose();
      child.removeFromParent();
    }
    for (const { positions, triangles, classes } of models) {
      const corners = new Float32Array(triangles.length * 3);
      const colours = new Float32Array(triangles.length * 3);
      triangles.forEach((v, i) => {
        const colour = new THREE.Color(classColours[classes[Math.floor(i / 3)]!] ?? 0xa0b0a0);
        for (let k = 0; k < 3; ++k) corners[3 * i + k] = positions[3 * v + k]! - centre[k]!;
        colours.set([colour.r, colour.g, colour.b], 3 * i);
      });
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
      geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
      this.group.add(new THREE.Mesh(geometry, this.material));
    }
  }

  set opacity(value: number) {
    this.group.visible = value > 0;
    this.material.uniforms.opacity!.value = value;
    const blended = value < 1;
    if (this.material.transparent !== blended) {
      this.material.transparent = blended;
      this.material.needsUpdate = true;
    }
  }
}
