// Profiles: points [inward, height] in metres from the foot of the edge, starting at [0, 0]; neither coordinate decreases.
import type { ProfilePoint } from "../api/types";

export type Profile = ProfilePoint[];
export type EdgeKind = "wall" | "pitched" | "terrace";

/** Minimum slope of a roof: below 1 mm of height per metre it is a terrace. */
const flat = 1e-3;
/** Maximum inward extent of a wall, metres. */
const upright = 1e-6;

const isUpright = (a: ProfilePoint, b: ProfilePoint) => b[0] - a[0] <= upright;
const isFlat = (a: ProfilePoint, b: ProfilePoint) => !isUpright(a, b) && b[1] - a[1] < flat * (b[0] - a[0]);

/** Slope (rise over run) of the segment that ends at point i; infinite for a wall, null for the first point. */
export function slopeTo(profile: Profile, i: number): number | null {
  const a = profile[i - 1];
  const b = profile[i];
  if (!a || !b) return null;
  return isUpright(a, b) ? Infinity : (b[1] - a[1]) / (b[0] - a[0]);
}

/** The slopes of all roof segments of a profile, from bottom to top. */
export function slopes(profile: Profile): number[] {
  const found: number[] = [];
  for (let i = 1; i < profile.length; ++i) {
    const slope = slopeTo(profile, i)!;
    if (Number.isFinite(slope) && slope >= flat) found.push(slope);
  }
  return found;
}

/** Wall: a wall up to the cap, as of a gable or a party wall. Pitched: has a roof slope. Terrace: flat segments, no slope. */
export function kindOf(profile: Profile): EdgeKind {
  if (slopes(profile).length > 0) return "pitched";
  for (let i = 1; i < profile.length; ++i) if (isFlat(profile[i - 1]!, profile[i]!)) return "terrace";
  return "wall";
}

/** Index of the point at the gutter: the top of the first wall, where the roof begins; null if the wall continues to the
 *  cap, or if there is no wall. */
export function gutterPoint(profile: Profile): number | null {
  const i = profile.findIndex((p, n) => n > 0 && !isUpright(profile[n - 1]!, p)) - 1;
  return i > 0 ? i : null;
}

/** Gutter height: of the top of the first wall, where the roof begins; null if the wall continues to the cap. */
export function gutterOf(profile: Profile): number | null {
  const i = profile.findIndex((p, n) => n > 0 && !isUpright(profile[n - 1]!, p));
  return i < 1 ? null : profile[i - 1]![1];
}

/** Index of the end point of the topmost roof segment; 0 if there is none. */
export function lastRoof(profile: Profile): number {
  for (let i = profile.length - 1; i > 0; --i) {
    const slope = slopeTo(profile, i)!;
    if (Number.isFinite(slope) && slope >= flat) return i;
  }
  return 0;
}
/** Slope of the topmost roof segment. */
export const pitchOf = (profile: Profile): number | null => slopeTo(profile, lastRoof(profile));

export const degreesOf = (slope: number) => (Math.atan(slope) * 180) / Math.PI;
export const slopeOfDegrees = (degrees: number) => Math.tan((degrees * Math.PI) / 180);

const put = (profile: Profile, i: number, p: ProfilePoint): Profile => profile.map((q, n) => (n === i ? p : q));

/** Moves a point without any check. The foot is fixed. */
export function movePoint(profile: Profile, i: number, to: ProfilePoint): Profile {
  return i > 0 && i < profile.length ? put(profile, i, to) : profile;
}

/** Limits a moved point to between its neighbours, so that the profile never leans outwards, goes down, or repeats a point. */
export function held(profile: Profile, i: number, to: ProfilePoint, step = 0.01): ProfilePoint {
  const before = profile[i - 1];
  const after = profile[i + 1];
  let inward = Math.max(to[0], before?.[0] ?? 0);
  let height = Math.max(to[1], before?.[1] ?? 0);
  if (after) {
    inward = Math.min(inward, after[0]);
    height = Math.min(height, after[1]);
    if (inward === after[0] && height === after[1]) {
      if (before && height - step > before[1]) height -= step;
      else inward -= step;
    }
  }
  if (before && inward === before[0] && height === before[1]) height += step;
  return [inward, height];
}

/** Changes the gutter height; everything above moves along. A roof that begins at the base gets a wall below it. */
export function withGutter(profile: Profile, height: number): Profile {
  const gutter = gutterOf(profile);
  if (gutter === null) return profile;
  const i = profile.findIndex((p, n) => n > 0 && !isUpright(profile[n - 1]!, p)) - 1;
  const above = profile.slice(i + 1).map(([inward, h]): ProfilePoint => [inward, h + (height - gutter)]);
  const wall = profile.slice(0, Math.max(1, i));
  return [...wall, [profile[i]![0], height], ...above];
}

/** Changes the slope of the segment that ends at point i, but not its run; everything above moves along. */
export function withSlope(profile: Profile, i: number, slope: number): Profile {
  const a = profile[i - 1];
  const b = profile[i];
  if (!a || !b || isUpright(a, b)) return profile;
  const lift = a[1] + slope * (b[0] - a[0]) - b[1];
  return profile.map((p, n) => (n < i ? p : [p[0], p[1] + lift]));
}

/** Inserts a point on the segment that ends at point `i`, or after the last point. */
export function insertPoint(profile: Profile, i: number, at: ProfilePoint): Profile {
  return [...profile.slice(0, i), at, ...profile.slice(i)];
}

/** The position nearest to `p` on the segment that ends at point i, or on the continuation after the last point; rounded to
 *  `step`. */
export function onPart(profile: Profile, i: number, p: ProfilePoint, step = 0.01): ProfilePoint | null {
  const a = profile[i - 1];
  if (!a) return null;
  const b = profile[i] ?? continued(profile, Math.max(p[1], a[1] + 1));
  if (!b) return null;
  const run = b[0] - a[0];
  const rise = b[1] - a[1];
  const share = ((p[0] - a[0]) * run + (p[1] - a[1]) * rise) / (run * run + rise * rise);
  const along = Math.min(1, Math.max(0, share));
  const whole = (value: number) => Math.round(value / step) / Math.round(1 / step);
  if (isUpright(a, b)) return [a[0], whole(a[1] + along * rise)];
  const inward = whole(a[0] + along * run);
  return [inward, a[1] + ((inward - a[0]) * rise) / run];
}

/** Deletes a point; null for the foot, and for profiles of two points. */
export function deletePoint(profile: Profile, i: number): Profile | null {
  if (i <= 0 || i >= profile.length || profile.length <= 2) return null;
  return profile.filter((_, n) => n !== i);
}

/** The point at which the continued last segment reaches a height; null if the profile ends above it. */
export function continued(profile: Profile, to: number): ProfilePoint | null {
  const last = profile.at(-1);
  const before = profile.at(-2);
  if (!last || !before || last[1] >= to) return null;
  const slope = slopeTo(profile, profile.length - 1)!;
  // A flat last segment continues vertically, as a wall does.
  return slope < flat || slope === Infinity ? [last[0], to] : [last[0] + (to - last[1]) / slope, to];
}

export const same = (a: Profile, b: Profile) =>
  a.length === b.length && a.every((p, i) => p[0] === b[i]![0] && p[1] === b[i]![1]);

/** Moves point `i` and all later points up or down, but not below the point before it. */
export function lifted(profile: Profile, i: number, by: number): Profile {
  const at = profile[i];
  const below = profile[i - 1];
  if (!at || !below) return profile;
  const up = Math.max(by, below[1] - at[1]);
  return profile.map((p, n) => (n < i ? p : [p[0], p[1] + up]));
}
