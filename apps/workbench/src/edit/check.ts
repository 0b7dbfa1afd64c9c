// Checks of a plan that need no call of the server, with its messages, simplest first. The server checks exactly, this in
// doubles: doubtful cases pass here.
import type { Diagnostic, Plan, Point2 } from "../api/types";
import { after, planArea, ringsOf } from "./plan";
import type { Profile } from "./profile";
import { area, contains, crossing } from "./vector";

const rounding = 1e-9;

/** What is wrong with a profile, to be read after "profile 3"; null if it is valid. */
export function profileFault(profile: Profile): string | null {
  if (profile.length < 2) return "has fewer than two points";
  for (const [inward, height] of profile) {
    if (!Number.isFinite(inward) || !Number.isFinite(height)) return "has a point that is not finite";
    if (Math.max(Math.abs(inward), Math.abs(height)) > 1e6) return "extends beyond 1,000 km; profiles are in metres";
  }
  if (Math.abs(profile[0]![0]) > rounding || Math.abs(profile[0]![1]) > rounding) return "does not start at (0, 0)";
  for (let i = 1; i < profile.length; ++i) {
    if (profile[i]![0] < profile[i - 1]![0] - rounding) return "leans outwards";
    if (profile[i]![1] < profile[i - 1]![1] - rounding) return "goes down";
  }
  return null;
}

const nameOf = (ring: number) => (ring === 0 ? "the outline" : `hole ${ring}`);
const textOf = (p: Point2) => `(${p[0].toFixed(3)}, ${p[1].toFixed(3)})`;

/** The first fault of a plan; null if none is found here. O(n²) for n corners. */
export function planFault(plan: Plan, subject: string): Diagnostic | null {
  const fault = (code: string, message: string): Diagnostic => ({ severity: "error", code, message, subject });
  if (!Number.isFinite(plan.cap) || !Number.isFinite(plan.base) || plan.cap <= 0 || plan.cap > 1e5)
    return fault("extrude-cap", "the cap must be above the base, by at most 100 km");
  for (const [i, profile] of plan.profiles.entries()) {
    const found = profileFault(profile);
    if (found) return fault("extrude-profile", `profile ${i} ${found}`);
  }
  const rings = ringsOf(plan);
  for (const [r, ring] of rings.entries()) {
    if (ring.points.length !== ring.profile_of_edge.length)
      return fault("extrude-profile", `${nameOf(r)} must name one profile per edge`);
    for (const [i, p] of ring.points.entries()) {
      const profile = ring.profile_of_edge[i]!;
      if (!plan.profiles[profile])
        return fault("extrude-profile", `edge ${i} of ${nameOf(r)} names profile ${profile}, which does not exist`);
      if (!Number.isFinite(p[0]) || !Number.isFinite(p[1]))
        return fault("extrude-not-simple", `corner ${i} of ${nameOf(r)} is not finite`);
    }
    if (ring.points.length < 3)
      return fault(
        r === 0 ? "extrude-no-area" : "extrude-not-simple",
        `${nameOf(r)} has fewer than three different corners; remove it`,
      );
  }
  const crossed = firstCrossing(plan);
  if (Math.abs(area(plan.outer.points)) < 1e-6) {
    const near = `the outline near ${textOf(plan.outer.points[0]!)} encloses no area`;
    return fault("extrude-no-area", crossed ? `${near}: ${crossed}` : near);
  }
  if (crossed) return fault("extrude-not-simple", crossed);
  for (const [h, hole] of plan.holes.entries()) {
    const where = `hole ${h + 1} near ${textOf(hole.points[0]!)}`;
    if (!hole.points.some((p) => contains(plan.outer.points, p)))
      return fault("extrude-not-simple", `${where} is outside the footprint; remove it, or make it a part`);
  }
  if (planArea(plan) < 1e-6) return fault("extrude-no-area", "the holes leave no area of the footprint; make them smaller, or remove one");
  return null;
}

function firstCrossing(plan: Plan): string | null {
  const edges = ringsOf(plan).flatMap((ring, r) =>
    ring.points.map((p, i) => ({ ring: r, edge: i, from: p, to: ring.points[after(ring, i)]! })),
  );
  const name = (e: { ring: number; edge: number }) => `edge ${e.edge}` + (e.ring ? ` of hole ${e.ring}` : "");
  for (let i = 0; i < edges.length; ++i)
    for (let j = i + 1; j < edges.length; ++j) {
      const a = edges[i]!;
      const b = edges[j]!;
      const at = crossing(a.from, a.to, b.from, b.to);
      if (!at) continue;
      const remedy =
        a.ring === b.ring
          ? "reorder the corners, or split the outline there"
          : "move the hole inside the outline, or merge it with the outside";
      return `${name(a)} and ${name(b)} cross at ${textOf(at)}; ${remedy}`;
    }
  return null;
}
