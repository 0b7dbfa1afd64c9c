// Lines with a width in pixels, flat polygons, and point marks.
import * as THREE from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Point2 } from "../api/types";
import type { Vector } from "./camera";

/** Line segments relative to a centre, optionally with colours. */
export class Segments {
  readonly positions: number[] = [];
  readonly colours: number[] = [];
  constructor(private readonly centre: Vector) {}

  add(a: readonly number[], b: readonly number[], colour?: THREE.Color) {
    for (const p of [a, b]) {
      for (let i = 0; i < 3; ++i) this.positions.push(p[i]! - this.centre[i]!);
      if (colour) this.colours.push(colour.r, colour.g, colour.b);
    }
  }
  path(points: readonly (readonly number[])[], colour?: THREE.Color) {
    for (let i = 0; i + 1 < points.length; ++i) this.add(points[i]!, points[i + 1]!, colour);
  }
  ring(points: readonly Point2[], z: number) {
    points.forEach((p, i) => {
      const next = points[(i + 1) % points.length]!;
      this.add([p[0], p[1], z], [next[0], next[1], z]);
    });
  }
}

/** Lines with a width in pixels. Their contents can be replaced. */
export class WideLines {
  readonly material: LineMaterial;
  readonly object: LineSegments2;

  constructor(colour: number, width: number, over = false) {
    this.material = new LineMaterial({ color: colour, linewidth: width, dashed: false });
    this.material.clipping = true;
    if (over) this.material.depthTest = false; // visible through other objects
    this.object = new LineSegments2(new LineSegmentsGeometry(), this.material);
    this.object.visible = false;
    this.object.frustumCulled = false;
    if (over) this.object.renderOrder = 5;
  }

  set(segments: { positions: ArrayLike<number>; colours?: ArrayLike<number> }) {
    this.object.geometry.dispose();
    this.empty = segments.positions.length === 0;
    this.object.geometry = new LineSegmentsGeometry();
    if (!this.empty) {
      this.object.geometry.setPositions(Float32Array.from(segments.positions));
      if (segments.colours?.length) {
        this.object.geometry.setColors(Float32Array.from(segments.colours));
        this.material.vertexColors = true;
        this.material.color.set(0xffffff);
      }
    }
    this.show();
  }
  private empty = true;
  private faded = 1;

  set opacity(value: number) {
    this.faded = value;
    this.material.opacity = value;
    const blended = value < 1;
    if (this.material.transparent !== blended) {
      this.material.transparent = blended;
      this.material.needsUpdate = true;
    }
    this.show();
  }
  private show() {
    this.object.visible = !this.empty && this.faded > 0;
  }

  dispose() {
    this.object.geometry.dispose();
    this.material.dispose();
    this.object.removeFromParent();
  }
}

/** Triangles of a horizontal polygon with holes, relative to a centre. */
export function flat(
  outer: readonly Point2[],
  holes: readonly (readonly Point2[])[],
  z: number,
  centre: Vector,
): number[] {
  const vectors = (ring: readonly Point2[]) => ring.map(([x, y]) => new THREE.Vector2(x - centre[0], y - centre[1]));
  const rings = [vectors(outer), ...holes.map(vectors)];
  const points = rings.flat();
  return THREE.ShapeUtils.triangulateShape(rings[0]!, rings.slice(1)).flatMap((triangle) =>
    triangle.flatMap((i) => [points[i]!.x, points[i]!.y, z - centre[2]]),
  );
}

/** Coloured transparent surfaces without shading. */
export class Sheet {
  readonly material: THREE.MeshBasicMaterial;
  readonly object: THREE.Mesh;
  constructor(
    colour: number,
    private readonly most: number,
    offset = -2,
  ) {
    this.material = new THREE.MeshBasicMaterial({
      color: colour,
      transparent: true,
      opacity: most,
      side: THREE.DoubleSide,
      depthWrite: false,
      polygonOffset: true,
      polygonOffsetFactor: offset,
      polygonOffsetUnits: offset,
    });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.object.visible = false;
    this.object.frustumCulled = false;
    this.object.renderOrder = 2;
  }
  set(positions: ArrayLike<number>, colours?: ArrayLike<number>) {
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    if (colours) {
      this.object.geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
      this.material.vertexColors = true;
      this.material.color.set(0xffffff);
    }
    this.empty = positions.length === 0;
    this.object.visible = !this.empty && this.material.opacity > 0;
  }
  private empty = true;
  set opacity(value: number) {
    this.material.opacity = value * this.most;
    this.object.visible = !this.empty && value > 0;
  }
  dispose() {
    this.object.geometry.dispose();
    this.material.dispose();
    this.object.removeFromParent();
  }
}

/** By how much a cap is drawn nearer, in steps of the depth buffer: some decimetres at 50 m. Its slope plays no part, so that the
 *  outlines of the cut can be nearer still. */
export const capNearer = 8000;

/** The filled cut of a section plane. It lies in that plane, where graphics drivers interpolate the distance to the plane with
 *  errors: clipped by it, the cap would have holes, and pieces of faces that are cut are left in front of it. Nothing else is in
 *  front of the cap, so that it may be drawn nearer than it is. Opaque, so that nothing behind the cut shines through it. */
export class Cap {
  readonly object: THREE.Mesh;
  constructor(colour: number) {
    const material = new THREE.ShaderMaterial({
      uniforms: { colour: { value: new THREE.Color(colour) } },
      side: THREE.DoubleSide,
      clipping: false,
      polygonOffset: true,
      polygonOffsetFactor: 0,
      polygonOffsetUnits: -capNearer,
      vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
      fragmentShader: "uniform vec3 colour; void main() { gl_FragColor = vec4(colour, 1.0); }",
    });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.object.visible = false;
    this.object.frustumCulled = false;
  }
  set(positions: ArrayLike<number>) {
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    this.object.visible = positions.length > 0;
  }
}

/** Round marks with a size in pixels, visible through other objects. */
export class Marks {
  readonly material = new THREE.ShaderMaterial({
    uniforms: { size: { value: 11 } },
    transparent: true,
    depthTest: false,
    clipping: true,
    vertexShader: /* glsl */ `
      #include <clipping_planes_pars_vertex>
      attribute vec3 tone;
      varying vec3 shade;
      uniform float size;
      void main() {
        shade = tone;
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        gl_PointSize = size;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: /* glsl */ `
      #include <clipping_planes_pars_fragment>
      varying vec3 shade;
      void main() {
        #include <clipping_planes_fragment>
        float r = length(gl_PointCoord - 0.5);
        if (r > 0.5) discard;
        gl_FragColor = vec4(r > 0.36 ? vec3(1.0) : shade, 1.0 - smoothstep(0.44, 0.5, r));
      }`,
  });
  readonly object = new THREE.Points(new THREE.BufferGeometry(), this.material);
  constructor() {
    this.object.frustumCulled = false;
    this.object.renderOrder = 9;
    this.object.visible = false;
  }
  set(positions: number[], tones: number[]) {
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    this.object.geometry.setAttribute("tone", new THREE.Float32BufferAttribute(tones, 3));
  }
}
