// The view without what a drag changes, drawn once and then copied under it with its depths. Without a graphics card an image of
// the whole scene takes some tenths of a second, a copy and one building some hundredths.
import * as THREE from "three";

/** Objects that a drag changes are in this layer of three.js; all others in layer 0. */
export const changing = 1;

/** Whether images are drawn by the processor, as far as the browser says. */
export function isSoftware(gl: WebGLRenderingContext | WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
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
  private readonly scene = new THREE.Scene();
  private readonly eye = new THREE.Camera();

  constructor() {
    const triangle = new THREE.BufferGeometry();
    triangle.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const copy = new THREE.Mesh(triangle, this.material);
    copy.frustumCulled = false;
    this.scene.add(copy);
  }

  /** To be called when anything but what is dragged has changed. */
  forget() {
    this.of = "";
  }

  /** Draws what is still, unless it is already there, into the canvas. `key`: all that it depends on and that may change without a
   *  call of forget(). */
  draw(renderer: THREE.WebGLRenderer, key: string, render: () => void) {
    const size = renderer.getDrawingBufferSize(new THREE.Vector2());
    const wanted = `${key} ${size.x} ${size.y}`;
    if (this.of !== wanted || !this.target) {
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
    this.material.uniforms.colour!.value = this.target.texture;
    this.material.uniforms.depth!.value = this.target.depthTexture;
    renderer.render(this.scene, this.eye);
  }

  dispose() {
    this.target?.dispose();
    this.target = null;
    this.material.dispose();
  }
}
