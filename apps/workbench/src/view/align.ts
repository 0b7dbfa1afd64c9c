// Pairs of points by which a mesh is moved to its footprints: a point of the scan, and the corner of a footprint where it
// should be.
import { signal } from "@preact/signals";
import type { Vector } from "./camera";

export interface Pair {
  scan: Vector; // in the frame of the scene
  corner: Vector;
}

/** Null: the tool is not in use. */
export const aligning = signal<{ pairs: Pair[]; scan: Vector | null } | null>(null);

export const align = (on: boolean) => (aligning.value = on ? { pairs: [], scan: null } : null);

/** A click: a point of the scan, then a corner of a footprint. False if there is none near it. */
export function addPlace(place: Vector | null, corner: Vector | null): boolean {
  const now = aligning.value;
  if (!now) return false;
  if (!now.scan) {
    if (!place) return false;
    aligning.value = { ...now, scan: place };
    return true;
  }
  if (!corner) return false;
  aligning.value = { pairs: [...now.pairs, { scan: now.scan, corner }], scan: null };
  return true;
}
/** Takes back the last click. */
export function takeBack() {
  const now = aligning.value;
  if (now?.scan) aligning.value = { ...now, scan: null };
  else if (now?.pairs.length)
    aligning.value = { pairs: now.pairs.slice(0, -1), scan: now.pairs.at(-1)!.scan };
}
export function removePair(i: number) {
  const now = aligning.value;
  if (now) aligning.value = { ...now, pairs: now.pairs.filter((_, j) => j !== i) };
}

export interface Fit {
  offset: [number, number]; // m east and north, to be added to the mesh
  residuals: number[]; // m; how far each point is from its corner after that
  rms: number | null; // m; null for a single pair, which any offset fits
}

/** The offset with the least squares of the residuals: the mean of the differences. Heights do not count: footprints lie on
 *  the ground, and points of walls and roofs do not. */
export function fitted(pairs: readonly Pair[]): Fit | null {
  if (!pairs.length) return null;
  const differences = pairs.map(({ scan, corner }) => [corner[0] - scan[0], corner[1] - scan[1]] as const);
  const mean = ([0, 1] as const).map((i) => differences.reduce((sum, d) => sum + d[i], 0) / pairs.length) as [number, number];
  const residuals = differences.map((d) => Math.hypot(d[0] - mean[0], d[1] - mean[1]));
  const rms = pairs.length > 1 ? Math.sqrt(residuals.reduce((sum, r) => sum + r * r, 0) / pairs.length) : null;
  return { offset: mean, residuals, rms };
}

/** The option ingest.mesh_offset with an offset added, in millimetres. */
export function offsetOption(before: string | undefined, [east, north]: readonly [number, number]): string {
  const numbers = (before ?? "").split(/[\s,]+/).filter(Boolean).map(Number);
  const [x = 0, y = 0, z = 0] = numbers;
  return [x + east, y + north, z].map((v) => String(Math.round(v * 1000) / 1000 || 0)).join(" ");
}
