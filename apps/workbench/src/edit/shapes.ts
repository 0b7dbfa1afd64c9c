// Roof shapes in one step, where there is no scan that the engine could fit them to.
import { apart, isCornerEdge } from "./corner_edges";
import type { Plan, Point2 } from "../api/types";
import { after } from "./plan";
import { type Profile, gutterOf, pitchOf } from "./profile";
import { distance, minus, unit } from "./vector";

export type Shape = "flat" | "shed" | "gable" | "hip" | "half-hip" | "gablet" | "pyramid" | "gambrel" | "mansard";
export const shapes: { shape: Shape; name: string; meaning: string }[] = [
  { shape: "flat", name: "Flat", meaning: "A flat roof at the height of the gutter" },
  { shape: "shed", name: "Shed", meaning: "One slope, walls up to the roof on the other edges" },
  { shape: "gable", name: "Gable", meaning: "Slopes on two opposite sides, walls up to the roof across them" },
  { shape: "hip", name: "Hip", meaning: "Slopes on every edge without a neighbour" },
  { shape: "half-hip", name: "Half-hip", meaning: "A gable roof, the tops of whose ends slope" },
  { shape: "gablet", name: "Gablet", meaning: "A hip roof, the tops of whose ends are upright" },
  { shape: "pyramid", name: "Pyramid", meaning: "Slopes on every edge without a neighbour, up to one point" },
  { shape: "gambrel", name: "Gambrel", meaning: "A gable roof whose slopes are steep at the foot and shallow above" },
  { shape: "mansard", name: "Mansard", meaning: "A steep slope, and a shallow one above it, on every edge without a neighbour" },
];

const usualPitch = Math.tan((40 * Math.PI) / 180); // of new slopes, where the part has none
const steep = { rise: 2.4, run: 0.85 }; // m; of a mansard roof: about 70°
const shallow = Math.tan((20 * Math.PI) / 180);

// The lower one of two: ends of a half-hip have higher gutters.
const median = (values: number[]) => [...values].sort((a, b) => a - b)[(values.length - 1) >> 1];

/** Height of the gutters of a part; of its top if it has none. */
export function eavesOf(plan: Plan): number {
  const own = plan.outer.profile_of_edge.flatMap((p) => gutterOf(plan.profiles[p]!) ?? []);
  return Math.min(median(own) ?? plan.cap, plan.cap);
}
const pitchNow = (plan: Plan) =>
  median(plan.outer.profile_of_edge.flatMap((p) => {
    const pitch = pitchOf(plan.profiles[p]!);
    return pitch !== null && Number.isFinite(pitch) && pitch > 0.05 && pitch < 3 ? [pitch] : [];
  })) ?? usualPitch;

/** Whether an edge runs along the longest one, to within 45°. */
function alongLongest(points: readonly Point2[]): boolean[] {
  const ends = points.map((p, i) => [p, points[(i + 1) % points.length]!] as const);
  const longest = ends.reduce((a, b) => (distance(...b) > distance(...a) ? b : a));
  const along = unit(minus(longest[1], longest[0]));
  return ends.map(([a, b]) => {
    const own = unit(minus(b, a));
    return !!own && !!along && Math.abs(own[0] * along[0] + own[1] * along[1]) > Math.SQRT1_2;
  });
}

const gabled: readonly Shape[] = ["gable", "half-hip", "gablet", "gambrel"];
const ended: readonly Shape[] = ["half-hip", "gablet"]; // whose ends have slopes of their own

/** What a new roof takes from elsewhere; otherwise from the part. */
export interface Roof {
  eaves?: number; // m above the base
  pitch?: number; // rise over run
}

/** The plan with another roof. Eaves and pitch stay, or are those of `roof`. A gable has its slopes on the edges of
 *  `lengthwise`, by default those along the longest edge. Edges at which `shared` is true have a neighbour: their walls reach
 *  up to the roof. Courtyards get walls. */
export function shaped(
  given: Plan,
  shape: Shape,
  sharedEdge: (edge: number) => boolean = () => false,
  roof: Roof = {},
  lengthwiseEdges?: readonly boolean[],
): Plan {
  // The directions of the roof before are no sides of this one.
  const walls = given.outer.points.flatMap((_, i) => (isCornerEdge(given.outer, i) ? [] : [i]));
  const { plan } = apart(given);
  const shared = (edge: number) => sharedEdge(walls[edge]!);
  const lengthwise = lengthwiseEdges ? walls.map((i) => lengthwiseEdges[i]!) : alongLongest(plan.outer.points);
  const eaves = roof.eaves ?? eavesOf(plan);
  const pitch = roof.pitch ?? pitchNow(plan);
  const xs = plan.outer.points.map((p) => p[0]);
  const ys = plan.outer.points.map((p) => p[1]);
  const reach = Math.hypot(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
  const slope: Profile =
    shape === "mansard" || shape === "gambrel"
      ? [[0, 0], [0, eaves], [steep.run, eaves + steep.rise], [steep.run + reach, eaves + steep.rise + shallow * reach]]
      : [[0, 0], [0, eaves], [reach, eaves + pitch * reach]];
  // Higher than any ridge: slopes meet before.
  const cap = shape === "flat" ? eaves : slope.at(-1)![1];
  // Half of the gable above an end is upright, below or above.
  const endOf = (length: number): Profile => {
    const half = length / 4;
    return shape === "half-hip"
      ? [[0, 0], [0, eaves + pitch * half], [reach, eaves + pitch * (half + reach)]]
      : [[0, 0], [0, eaves], [half, eaves + pitch * half], [half, cap]];
  };
  const wall: Profile = [[0, 0], [0, cap]];
  const first = shape === "shed" ? firstSlope(plan.outer.points, lengthwise, shared) : -1;
  const slopes = plan.outer.points.map((_, i) => {
    if (shape === "flat" || shared(i)) return false;
    if (shape === "shed") return i === first;
    return !gabled.includes(shape) || lengthwise[i]!;
  });
  const sloped = slopes.some(Boolean);
  const profiles = sloped ? [wall, slope] : [wall];
  const profileOfEdge = slopes.map((is, i) => {
    if (is || !sloped || !ended.includes(shape) || shared(i)) return is ? 1 : 0;
    return profiles.push(endOf(distance(plan.outer.points[i]!, plan.outer.points[after(plan.outer, i)]!))) - 1;
  });
  return {
    ...plan,
    cap,
    profiles,
    outer: { points: plan.outer.points, profile_of_edge: profileOfEdge },
    holes: plan.holes.map((h) => ({ points: h.points, profile_of_edge: h.points.map(() => 0) })),
  };
}

/** The longest edge lengthwise without a neighbour: there the roof of a shed is lowest. */
function firstSlope(points: readonly Point2[], lengthwise: readonly boolean[], shared: (edge: number) => boolean): number {
  let best = -1;
  let most = 0;
  points.forEach((p, i) => {
    const length = distance(p, points[(i + 1) % points.length]!);
    if (lengthwise[i] && !shared(i) && length > most) [best, most] = [i, length];
  });
  return best;
}

/** Edges of the outline that touch an outline of others, over more than a third of their length. */
export function sharedEdges(plan: Plan, others: readonly Plan[], tolerance = 0.05): boolean[] {
  const { points } = plan.outer;
  return points.map((a, i) => {
    const b = points[after(plan.outer, i)]!;
    const along = unit(minus(b, a));
    const length = distance(a, b);
    if (!along) return false;
    let covered = 0;
    for (const other of others) {
      other.outer.points.forEach((c, j) => {
        const d = other.outer.points[after(other.outer, j)]!;
        const off = (p: Point2) => Math.abs((p[0] - a[0]) * along[1] - (p[1] - a[1]) * along[0]);
        if (off(c) > tolerance || off(d) > tolerance) return;
        const at = (p: Point2) => (p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1];
        covered += Math.max(0, Math.min(length, Math.max(at(c), at(d))) - Math.max(0, Math.min(at(c), at(d))));
      });
    }
    return covered > length / 3;
  });
}
