// Camera poses and pure functions of them. Angles are in radians: azimuth 0 looks north and grows clockwise; elevation 0 looks
// horizontally, π/2 straight down.

export type Vector = [number, number, number];
export interface Pose {
  target: Vector;
  azimuth: number;
  elevation: number;
  size: number; // visible height of the image at the target, m
  fov: number; // vertical
}

export const usualFov = 0.7;
export const flatFov = 0.04; // nearly parallel projection, like a plan
const down = Math.PI / 2 - 1e-4; // at exactly π/2 the up direction is undefined
const between = (x: number, low: number, high: number) => Math.min(high, Math.max(low, x));

export const distance = (pose: Pose) => pose.size / 2 / Math.tan(pose.fov / 2);

/** Unit vector from the eye to the target. */
export function gaze({ azimuth, elevation }: Pose): Vector {
  const level = Math.cos(elevation);
  return [level * Math.sin(azimuth), level * Math.cos(azimuth), -Math.sin(elevation)];
}

export function eye(pose: Pose): Vector {
  const towards = gaze(pose);
  const away = distance(pose);
  return [0, 1, 2].map((i) => pose.target[i]! - towards[i]! * away) as Vector;
}

/** Rotates by a drag of dx, dy pixels. A view from above that is tilted becomes a perspective view. */
export function orbit(pose: Pose, dx: number, dy: number): Pose {
  const elevation = between(pose.elevation + dy * 0.006, -0.2, down);
  const fov = elevation < down - 0.02 ? usualFov : pose.fov;
  return { ...pose, azimuth: pose.azimuth + dx * 0.006, elevation, fov };
}

/** Moves along the ground, following the pointer; at low elevations moves up and down instead. */
export function pan(pose: Pose, dx: number, dy: number, height: number): Pose {
  const scale = pose.size / height;
  const [sin, cos] = [Math.sin(pose.azimuth), Math.cos(pose.azimuth)];
  const steep = Math.sin(Math.max(pose.elevation, 0));
  const ahead = steep > 0.35 ? (dy * scale) / steep : 0;
  const up = steep > 0.35 ? 0 : dy * scale;
  const [x, y, z] = pose.target;
  return { ...pose, target: [x - dx * scale * cos + ahead * sin, y + dx * scale * sin + ahead * cos, z + up] };
}

/** Zooms; `point` keeps its position in the image. A factor below 1 moves closer. */
export function zoom(pose: Pose, factor: number, point: Vector | null): Pose {
  const size = between(pose.size * factor, 0.5, 50_000);
  const share = 1 - size / pose.size;
  const target = point ? (pose.target.map((t, i) => t + (point[i]! - t) * share) as Vector) : pose.target;
  return { ...pose, size, target };
}

/** Shows the whole box from the present direction. `aspect`: width over height. */
export function frame(pose: Pose, low: Vector, high: Vector, aspect: number): Pose {
  const target = low.map((l, i) => (l + high[i]!) / 2) as Vector;
  const extent = low.map((l, i) => high[i]! - l);
  // Extent of the box along the axes of the image, in parallel projection; the margin below allows for perspective.
  const [sin, cos] = [Math.abs(Math.sin(pose.azimuth)), Math.abs(Math.cos(pose.azimuth))];
  const across = extent[0]! * cos + extent[1]! * sin;
  const depth = extent[0]! * sin + extent[1]! * cos;
  const tall = depth * Math.sin(Math.abs(pose.elevation)) + extent[2]! * Math.cos(pose.elevation);
  return { ...pose, target, size: Math.max(tall, across / aspect, 4) * 1.12 };
}

export const home = (low: Vector, high: Vector, aspect: number): Pose =>
  frame({ target: [0, 0, 0], azimuth: 0.45, elevation: 0.72, size: 1, fov: usualFov }, low, high, aspect);
export const top = (pose: Pose): Pose => ({ ...pose, azimuth: 0, elevation: down, fov: flatFov });
export const isTop = (pose: Pose) => pose.fov < 0.1;

/** The angle equivalent to `to` that is nearest to `from`. */
const turned = (from: number, to: number) => {
  const turn = 2 * Math.PI;
  return from + ((((to - from + Math.PI) % turn) + turn) % turn) - Math.PI;
};

/** Interpolates two poses at share 0 … 1. Sizes and fields of view are interpolated by ratio, for an even motion. */
export function mixed(from: Pose, to: Pose, share: number): Pose {
  const mix = (a: number, b: number) => a + (b - a) * share;
  const ratio = (a: number, b: number) => a * (b / a) ** share;
  return {
    target: from.target.map((t, i) => mix(t, to.target[i]!)) as Vector,
    azimuth: mix(from.azimuth, turned(from.azimuth, to.azimuth)),
    elevation: mix(from.elevation, to.elevation),
    size: ratio(from.size, to.size),
    fov: ratio(from.fov, to.fov),
  };
}

/** Whether two poses cannot be distinguished in the image. */
export function same(a: Pose, b: Pose): boolean {
  const near = (x: number, y: number, by: number) => Math.abs(x - y) <= by;
  return (
    a.target.every((t, i) => near(t, b.target[i]!, a.size * 2e-4)) &&
    near(a.azimuth, turned(a.azimuth, b.azimuth), 2e-4) &&
    near(a.elevation, b.elevation, 2e-4) &&
    near(a.size / b.size, 1, 2e-4) &&
    near(a.fov / b.fov, 1, 2e-3)
  );
}
