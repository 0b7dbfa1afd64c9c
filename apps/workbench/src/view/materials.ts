// Colours and materials. All colours are in screen space, without conversion.
import * as THREE from "three";

THREE.ColorManagement.enabled = false;

export const colours = {
  mesh: 0x7a9acc,
  terrain: 0x9aa583,
  footprint: 0xf08c1e,
  wall: 0xd8d4cc,
  party: 0x96969e,
  roof: 0xb06250,
  ground: 0x787c78,
  soffit: 0xc4beb4,
  line: 0x26282e,
  cut: 0x8a7f74,
  cutLine: 0x2b2622,
  accent: 0x1d5fd0,
  wrong: 0xd02020,
};

const light = /* glsl */ `
  vec3 lit(vec3 colour, vec3 normal) {
    const vec3 sun = normalize(vec3(-0.45, -0.7, 1.0));
    float shade = 0.60 + 0.36 * max(dot(normal, sun), 0.0) + 0.08 * normal.z;
    return colour * min(shade, 1.06);
  }`;

/** Uniforms that all models share. */
export interface ModelLook {
  opacities: { value: number[] }; // by kind
  errorOn: { value: number }; // 0 … 1: opacity of the error map
  errorMap: { value: THREE.Texture | null };
  errorFrame: { value: THREE.Vector4 }; // x, y of the map's corner; 1 / width, 1 / height
  errorLimit: { value: number };
}
export const modelLook = (): ModelLook => ({
  opacities: { value: [1, 1, 1, 1, 1] },
  errorOn: { value: 0 },
  errorMap: { value: null },
  errorFrame: { value: new THREE.Vector4(0, 0, 1, 1) },
  errorLimit: { value: 2 },
});

const kindColours = [colours.wall, colours.party, colours.roof, colours.ground, colours.soffit];

/** Material of solids: coloured by class of face, with the error map on faces that look up. Insides are dark. */
export function modelMaterial(look: ModelLook) {
  return new THREE.ShaderMaterial({
    uniforms: {
      ...(look as unknown as Record<string, THREE.IUniform>),
      kindColours: { value: kindColours.map((c) => new THREE.Color(c)) },
      tint: { value: new THREE.Vector4(0, 0, 0, 0) },
    },
    clipping: true,
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: /* glsl */ `
      #include <clipping_planes_pars_vertex>
      attribute float kind;
      attribute vec4 paint;
      varying vec3 facing;
      varying vec2 ground;
      flat varying int which;
      flat varying vec4 painted;
      void main() {
        which = int(kind + 0.5);
        painted = paint;
        facing = normal;
        ground = position.xy;
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: /* glsl */ `
      #include <clipping_planes_pars_fragment>
      uniform vec3 kindColours[5];
      uniform float opacities[5];
      uniform vec4 tint;
      uniform float errorOn, errorLimit;
      uniform sampler2D errorMap;
      uniform vec4 errorFrame;
      varying vec3 facing;
      varying vec2 ground;
      flat varying int which;
      flat varying vec4 painted;
      ${light}
      vec3 ramp(float t) {
        vec3 strong = t > 0.0 ? vec3(0.62, 0.05, 0.16) : vec3(0.08, 0.24, 0.60);
        vec3 weak = t > 0.0 ? vec3(0.92, 0.60, 0.50) : vec3(0.50, 0.68, 0.88);
        float s = min(abs(t), 1.0);
        return s < 0.5 ? mix(vec3(0.97), weak, s * 2.0) : mix(weak, strong, s * 2.0 - 1.0);
      }
      void main() {
        #include <clipping_planes_fragment>
        float opacity = opacities[which];
        if (opacity <= 0.0) discard;
        vec3 colour = mix(kindColours[which], painted.rgb, painted.a);
        if (errorOn > 0.0 && facing.z > 0.02) {
          vec2 at = (ground - errorFrame.xy) * errorFrame.zw;
          if (all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)))) {
            float error = texture2D(errorMap, at).r;
            if (error < 10000.0) colour = mix(colour, ramp(error / errorLimit), errorOn);
          }
        }
        colour = mix(colour, tint.rgb, tint.a);
        gl_FragColor = gl_FrontFacing ? vec4(lit(colour, facing), opacity) : vec4(colour * 0.34, opacity);
      }`,
  });
}

export interface MeshLook {
  opacity: { value: number };
  mask: { value: THREE.Texture | null }; // where there are models
  maskFrame: { value: THREE.Vector4 };
  masked: { value: number };
}
export const meshLook = (): MeshLook => ({
  opacity: { value: 1 },
  mask: { value: null },
  maskFrame: { value: new THREE.Vector4(0, 0, 1, 1) },
  masked: { value: 0 },
});

/** Material of the mesh: flat-shaded without normals, or with its picture, which has its own light. Hidden where there are
 *  models. */
export function meshMaterial(look: MeshLook, picture: THREE.Texture | null = null, colour = colours.mesh) {
  return new THREE.ShaderMaterial({
    uniforms: {
      ...(look as unknown as Record<string, THREE.IUniform>),
      colour: { value: new THREE.Color(colour) },
      picture: { value: picture },
    },
    defines: picture ? { PICTURE: "" } : {},
    clipping: true,
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 2,
    polygonOffsetUnits: 2,
    vertexShader: /* glsl */ `
      #include <clipping_planes_pars_vertex>
      varying vec3 place;
      varying vec2 across;
      void main() {
        place = (modelMatrix * vec4(position, 1.0)).xyz;
        #ifdef PICTURE
          across = uv;
        #endif
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: /* glsl */ `
      #include <clipping_planes_pars_fragment>
      uniform vec3 colour;
      uniform float opacity, masked;
      uniform sampler2D mask;
      uniform vec4 maskFrame;
      uniform sampler2D picture;
      varying vec3 place;
      varying vec2 across;
      ${light}
      void main() {
        #include <clipping_planes_fragment>
        if (masked > 0.5) {
          vec2 at = (place.xy - maskFrame.xy) * maskFrame.zw;
          if (all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0))) && texture2D(mask, at).r > 0.5) discard;
        }
        #ifdef PICTURE
          vec4 seen = texture2D(picture, across);
          if (seen.a < 0.5) discard; // a basemap ends somewhere
          gl_FragColor = vec4(seen.rgb, opacity);
        #else
          vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
          gl_FragColor = vec4(lit(colour, normal), opacity);
        #endif
      }`,
  });
}

/** Material of models with pictures, drawn over their plain faces. The pictures have their own light. */
export function pictureMaterial(look: ModelLook, picture: THREE.Texture) {
  return new THREE.ShaderMaterial({
    uniforms: { opacities: look.opacities, picture: { value: picture } },
    clipping: true,
    polygonOffset: true,
    polygonOffsetFactor: 0.5,
    polygonOffsetUnits: 0.5,
    vertexShader: /* glsl */ `
      #include <clipping_planes_pars_vertex>
      attribute float kind;
      varying vec2 across;
      flat varying int which;
      void main() {
        across = uv;
        which = int(kind + 0.5);
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        #include <clipping_planes_vertex>
      }`,
    fragmentShader: /* glsl */ `
      #include <clipping_planes_pars_fragment>
      uniform float opacities[5];
      uniform sampler2D picture;
      varying vec2 across;
      flat varying int which;
      void main() {
        #include <clipping_planes_fragment>
        // Faded faces are plain: two layers would be seen through each other.
        if (opacities[which] < 1.0) discard;
        gl_FragColor = vec4(texture2D(picture, across).rgb, 1.0);
      }`,
  });
}

/** Sets the opacity, and blending if it is needed. */
export function fade(material: THREE.Material, opacity: number) {
  const blended = opacity < 1;
  if (material.transparent !== blended) {
    material.transparent = blended;
    material.needsUpdate = true;
  }
  material.opacity = opacity;
  material.depthWrite = opacity > 0.6;
}
