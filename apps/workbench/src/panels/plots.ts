// Data of the plots: the profiles of a block (the paper's Figure 10), and the histogram of errors.
import type { Building } from "../api/types";
import type { LoadedMap } from "../state";
import { endsOf } from "../edit/plan";
import { wallBeside } from "../edit/turned_roof";
import { distance } from "../edit/vector";
import { capped, reaches } from "../view/geometry";

export interface EdgeProfile {
  length: number; // of the edge, m
  points: [number, number][]; // (inward, height)
}

/** The profiles of all edges of all parts, up to the top of the part. */
export function edgeProfiles(buildings: Iterable<Building>): EdgeProfile[] {
  const all: EdgeProfile[] = [];
  for (const { parts } of buildings) {
    for (const part of parts) {
      const { plan } = part;
      const reach = reaches(part);
      [plan.outer, ...plan.holes].forEach((ring, r) =>
        ring.points.forEach((_, i) => {
          // The roof of a corner edge is as long as its wall.
          const at = { ring: r, edge: i };
          const [a, b] = endsOf(plan, wallBeside(plan, at)?.at ?? at)!;
          const profile = plan.profiles[ring.profile_of_edge[i]!];
          if (!profile) return;
          all.push({ length: distance(a, b), points: capped(profile, reach(r, i)) });
        }),
      );
    }
  }
  return all;
}

export interface Cluster extends EdgeProfile {
  edges: number;
}

const step = 0.5; // m of height between two compared points of profiles

/** The inward distance of a profile at a height; constant above its top. */
export function inwardAt(points: readonly (readonly [number, number])[], height: number): number {
  for (let i = 1; i < points.length; ++i) {
    const [[x0, h0], [x1, h1]] = [points[i - 1]!, points[i]!];
    if (height > h1) continue;
    return h1 > h0 ? x0 + ((x1 - x0) * Math.max(0, height - h0)) / (h1 - h0) : x0;
  }
  return points.at(-1)?.[0] ?? 0;
}

/** Clusters of profiles that differ by at most `near`, each with the profile of its longest edge; the largest total length
 *  first. */
export function clusters(profiles: readonly EdgeProfile[], near = 0.4): Cluster[] {
  const found: (Cluster & { samples: number[]; top: number })[] = [];
  for (const { length, points } of [...profiles].sort((a, b) => b.length - a.length)) {
    const top = points.at(-1)?.[1] ?? 0;
    const samples: number[] = [];
    for (let h = 0; h < top; h += step) samples.push(inwardAt(points, h));
    const same = found.find((c) => {
      if (Math.abs(c.top - top) > 2 * near) return false;
      const n = Math.min(c.samples.length, samples.length);
      let worst = 0;
      for (let i = 0; i < n; ++i) worst = Math.max(worst, Math.abs(c.samples[i]! - samples[i]!));
      return worst <= near;
    });
    if (same) {
      same.length += length;
      ++same.edges;
    } else found.push({ length, points, edges: 1, samples, top });
  }
  return found.map(({ length, points, edges }) => ({ length, points, edges })).sort((a, b) => b.length - a.length);
}

export interface Histogram {
  limit: number; // m; the outermost bins include all larger errors
  bins: number[]; // shares, from −limit to limit
  cells: number;
  mean: number; // m
  medianAbsolute: number; // m
  rmse: number; // m
  within: number; // share of errors below 0.25 m
}

/** Of the cells with both model and mesh. */
export function histogram(maps: readonly LoadedMap[], limit: number, bins = 40): Histogram | null {
  const counts = new Array<number>(bins).fill(0);
  const sizes: number[] = [];
  let [sum, squares, within] = [0, 0, 0];
  for (const { cells } of maps) {
    for (const error of cells) {
      if (Number.isNaN(error)) continue;
      const at = Math.floor(((error + limit) / (2 * limit)) * bins);
      counts[Math.max(0, Math.min(bins - 1, at))]! += 1;
      sizes.push(Math.abs(error));
      sum += error;
      squares += error * error;
      if (Math.abs(error) < 0.25) ++within;
    }
  }
  const cells = sizes.length;
  if (!cells) return null;
  const sorted = Float64Array.from(sizes).sort();
  return {
    limit,
    bins: counts.map((c) => c / cells),
    cells,
    mean: sum / cells,
    medianAbsolute: sorted[Math.floor(cells / 2)]!,
    rmse: Math.sqrt(squares / cells),
    within: within / cells,
  };
}

/** Round numbers for the ticks of an axis up to `most`. */
export function ticks(most: number, about = 5): number[] {
  if (!(most > 0)) return [0];
  const rough = most / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const by = power * ([1, 2, 5, 10].find((m) => m * power >= rough) ?? 10);
  return Array.from({ length: Math.floor(most / by + 1e-9) + 1 }, (_, i) => Number((i * by).toPrecision(6)));
}
