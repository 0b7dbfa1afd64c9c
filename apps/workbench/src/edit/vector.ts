// Points and rings in the plane. Lengths in metres, angles in radians.
import type { Point2 } from "../api/types";

export const minus = (a: Point2, b: Point2): Point2 => [a[0] - b[0], a[1] - b[1]];
export const plus = (a: Point2, b: Point2): Point2 => [a[0] + b[0], a[1] + b[1]];
export const times = (a: Point2, factor: number): Point2 => [a[0] * factor, a[1] * factor];
export const dot = (a: Point2, b: Point2) => a[0] * b[0] + a[1] * b[1];
export const cross = (a: Point2, b: Point2) => a[0] * b[1] - a[1] * b[0];
export const distance = (a: Point2, b: Point2) => Math.hypot(a[0] - b[0], a[1] - b[1]);
export const middle = (a: Point2, b: Point2): Point2 => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
/** To the left: the inside of a counter-clockwise ring. */
export const turnedLeft = (a: Point2): Point2 => [-a[1], a[0]];
/** Counter-clockwise, by an angle. */
export const rotated = (a: Point2, angle: number): Point2 => plus(times(a, Math.cos(angle)), times(turnedLeft(a), Math.sin(angle)));

/** Of length 1; null for a vector without length. */
export function unit(a: Point2): Point2 | null {
  const length = Math.hypot(a[0], a[1]);
  return length > 0 ? [a[0] / length, a[1] / length] : null;
}

export interface Line {
  at: Point2;
  along: Point2; // of length 1
}

export const shareAlong = (p: Point2, line: Line) => dot(minus(p, line.at), line.along);
export const onLine = (line: Line, share: number): Point2 => plus(line.at, times(line.along, share));
export const distanceToLine = (p: Point2, line: Line) => Math.abs(cross(line.along, minus(p, line.at)));

/** The intersection of two lines; null if they are parallel within about 3°. */
export function meeting(a: Line, b: Line): Point2 | null {
  const sine = cross(a.along, b.along);
  if (Math.abs(sine) < 0.05) return null;
  return onLine(a, cross(minus(b.at, a.at), b.along) / sine);
}

/** The nearest point of the segment a–b, and its position along it, 0 … 1. */
export function nearestOn(p: Point2, a: Point2, b: Point2): { at: Point2; share: number; distance: number } {
  const along = minus(b, a);
  const length = dot(along, along);
  const share = length > 0 ? Math.min(1, Math.max(0, dot(minus(p, a), along) / length)) : 0;
  const at = plus(a, times(along, share));
  return { at, share, distance: distance(p, at) };
}

/** Positive for counter-clockwise rings; m². */
export function area(ring: readonly Point2[]): number {
  const first = ring[0];
  if (!first) return 0;
  let twice = 0;
  for (let i = 1; i + 1 < ring.length; ++i) twice += cross(minus(ring[i]!, first), minus(ring[i + 1]!, first));
  return twice / 2;
}

export function contains(ring: readonly Point2[], p: Point2): boolean {
  let inside = false;
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
    const a = ring[i]!;
    const b = ring[j]!;
    if (a[1] > p[1] !== b[1] > p[1] && p[0] < a[0] + ((p[1] - a[1]) / (b[1] - a[1])) * (b[0] - a[0])) inside = !inside;
  }
  return inside;
}

/** The intersection of two segments; touching ends do not count. */
export function crossing(a: Point2, b: Point2, c: Point2, d: Point2): Point2 | null {
  const side = (p: Point2, q: Point2, r: Point2) => {
    const value = cross(minus(q, p), minus(r, p));
    // Less than a micrometre off the line: left to the exact check of the server.
    return Math.abs(value) < 1e-6 * distance(p, q) ? 0 : Math.sign(value);
  };
  if (side(a, b, c) * side(a, b, d) >= 0 || side(c, d, a) * side(c, d, b) >= 0) return null;
  const ab = minus(b, a);
  const cd = minus(d, c);
  return plus(a, times(ab, cross(minus(c, a), cd) / cross(ab, cd)));
}
