// Images without a graphics card. The view without what a drag changes is drawn once and then copied under it with its depths: an
// image of the whole scene takes some tenths of a second, a copy and one building some hundredths. Edges are smoothed only where
// nothing moves, since that takes as long again.
import * as THREE from "three";

/** Objects that a drag changes are in this layer of three.js; all others in layer 0. */
export const changing = 1;

/** Whether images are drawn by the processor, as far as the browser says. */
export function isSoftware(): boolean {
  // Asked of another canvas: that of the view cannot be changed afterwards.
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return false;
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** A rectangle of the canvas, CSS pixels from its lower left corner. */
export interface Rectangle {
  left: number;
  bottom: number;
  right: number;
  top: number;
}
export const both = (a: Rectangle, b: Rectangle): Rectangle => ({
  left: Math.min(a.left, b.left),
  bottom: Math.min(a.bottom, b.bottom),
  right: Math.max(a.right, b.right),
  top: Math.max(a.top, b.top),
});

/** Where boxes are seen, with a margin for the width of lines, within a canvas of that size. All of it where one of them reaches
 *  behind the camera. */
export function seenAt(boxes: Iterable<THREE.Box3>, eye: THREE.Camera, width: number, height: number): Rectangle {
  const all = { left: 0, bottom: 0, right: width, top: height };
  const margin = 8; // pixels
  const view = new THREE.Matrix4().multiplyMatrices(eye.projectionMatrix, eye.matrixWorldInverse);
  const corner = new THREE.Vector4();
  let seen: Rectangle | null = null;
  for (const { min, max } of boxes) {
    if (!(min.x <= max.x)) continue;
    for (let i = 0; i < 8; ++i) {
      corner.set(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z, 1).applyMatrix4(view);
      if (!(corner.w > 1e-6)) return all;
      const [x, y] = [((corner.x / corner.w + 1) / 2) * width, ((corner.y / corner.w + 1) / 2) * height];
      const at = { left: x - margin, bottom: y - margin, right: x + margin, top: y + margin };
      seen = seen ? both(seen, at) : at;
    }
  }
  if (!seen) return { left: 0, bottom: 0, right: 0, top: 0 };
  const within = (value: number, most: number) => Math.min(most, Math.max(0, value));
  return {
    left: Math.floor(within(seen.left, width)),
    bottom: Math.floor(within(seen.bottom, height)),
    right: Math.ceil(within(seen.right, width)),
    top: Math.ceil(within(seen.top, height)),
  };
}

function fullScreen(material: THREE.Material) {
  const triangle = new THREE.BufferGeometry();
  triangle.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
  const copy = new THREE.Mesh(triangle, material);
  copy.frustumCulled = false;
  return new THREE.Scene().add(copy);
}

export class Still {
  private target: THREE.WebGLRenderTarget | null = null;
  private of = ""; // what it shows
  private readonly material = new THREE.ShaderMaterial({
    depthFunc: THREE.AlwaysDepth,
    uniforms: { colour: { value: null as THREE.Texture | null }, depth: { value: null as THREE.Texture | null } },
    vertexShader: "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: `
      uniform sampler2D colour;
      uniform highp sampler2D depth;
      void main() {
        ivec2 at = ivec2(gl_FragCoord.xy);
        gl_FragColor = texelFetch(colour, at, 0);
        gl_FragDepth = texelFetch(depth, at, 0).r;
      }`,
  });
  private readonly scene = fullScreen(this.material);
  private readonly eye = new THREE.Camera();

  /** To be called when anything but what is dragged has changed. */
  forget() {
    this.of = "";
  }

  /** Draws what is still, unless it is already there; whether it did. `key`: all that it depends on and that may change without a
   *  call of forget(). */
  draw(renderer: THREE.WebGLRenderer, key: string, render: () => void): boolean {
    const size = renderer.getDrawingBufferSize(new THREE.Vector2());
    const wanted = `${key} ${size.x} ${size.y}`;
    const fresh = this.of !== wanted || !this.target;
    if (fresh) {
      if (this.target?.width !== size.x || this.target.height !== size.y) {
        this.target?.dispose();
        this.target = new THREE.WebGLRenderTarget(size.x, size.y, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
        this.target.depthTexture = new THREE.DepthTexture(size.x, size.y, THREE.UnsignedIntType);
      }
      renderer.setRenderTarget(this.target);
      renderer.clear();
      render();
      renderer.setRenderTarget(null);
      this.of = wanted;
    }
    return fresh;
  }
  /** Copies it into the canvas, as far as the scissor lets. */
  copy(renderer: THREE.WebGLRenderer) {
    this.material.uniforms.colour!.value = this.target!.texture;
    this.material.uniforms.depth!.value = this.target!.depthTexture;
    renderer.render(this.scene, this.eye);
  }

  dispose() {
    this.target?.dispose();
    this.target = null;
    this.material.dispose();
  }
}

/** Smooth edges for a canvas that has none, for images that stay. */
export class Smooth {
  private target: THREE.WebGLRenderTarget | null = null;
  private readonly material = new THREE.ShaderMaterial({
    depthTest: false,
    depthWrite: false,
    uniforms: { colour: { value: null as THREE.Texture | null } },
    vertexShader: "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: `
      uniform sampler2D colour;
      void main() { gl_FragColor = vec4(texelFetch(colour, ivec2(gl_FragCoord.xy), 0).rgb, 1.0); }`,
  });
  private readonly scene = fullScreen(this.material);
  private readonly eye = new THREE.Camera();

  /** What is drawn from now on does not reach the canvas before end(). */
  begin(renderer: THREE.WebGLRenderer) {
    const size = renderer.getDrawingBufferSize(new THREE.Vector2());
    if (this.target?.width !== size.x || this.target.height !== size.y) {
      this.target?.dispose();
      this.target = new THREE.WebGLRenderTarget(size.x, size.y, {
        samples: 4,
        minFilter: THREE.NearestFilter,
        magFilter: THREE.NearestFilter,
        resolveDepthBuffer: false,
      });
    }
    renderer.setRenderTarget(this.target);
  }
  end(renderer: THREE.WebGLRenderer, width: number, height: number) {
    renderer.setRenderTarget(null);
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, width, height);
    this.material.uniforms.colour!.value = this.target!.texture;
    renderer.render(this.scene, this.eye);
  }

  dispose() {
    this.target?.dispose();
    this.target = null;
    this.material.dispose();
  }
}
