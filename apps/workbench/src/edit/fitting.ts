// Measures of a roof that fit the scan best, found by measuring: of one plane, or of a dormer.
import type { NamedPlan, Plan } from "../api/types";
import { changeProfiles, collinear, isCorner, profileOf, type EdgeAt } from "./plan";
import { gutterOf, lastRoof, pitchOf, same, withGutter, withSlope, type Profile } from "./profile";
import { turnedBy } from "./turned_roof";
import { dormerBox, replaced, structureAt, withDormerBox } from "./structures";

/** A building with measures that can be varied; null: not with these. */
export interface Variable {
  start: number[];
  steps: number[]; // of the first round
  made(values: readonly number[]): NamedPlan[] | null;
}

/** Edges that carry one plane with this one: on the same line, with the same profile. */
export const planeOf = (plan: Plan, at: EdgeAt): EdgeAt[] => {
  const own = profileOf(plan, at);
  return own ? [at, ...collinear(plan, at).filter((e) => same(profileOf(plan, e) ?? [], own))] : [];
};

const steepest = 8; // rise over run, about 83°
const higher = 30; // m; of the cap while planes are tried

/** The gutter and the pitch of the plane over an edge, and the direction of a corner edge. Other planes stay. `ridge`: of the part as it is, above its base. Null if
 *  the edge has a wall. */
export function variablePlane(parts: readonly NamedPlan[], part: string, at: EdgeAt, ridge: number): Variable | null {
  const plan = parts.find((p) => p.id === part)?.plan;
  const own = plan && profileOf(plan, at);
  const pitch = own ? pitchOf(own) : null;
  const gutter = own ? gutterOf(own) : null;
  if (!plan || !own || gutter === null || pitch === null || !(pitch < steepest)) return null;
  const edges = planeOf(plan, at);
  // Heights of the two ends of the slope say more independent things than a height and a pitch.
  const run = Math.max(0.5, (ridge - gutter) / pitch);
  // A cap above the ridge stays above it; `trimmed` lowers it again.
  const cap = plan.cap < ridge + 0.005 ? plan.cap : plan.cap + higher;
  return {
    start: [gutter, gutter + pitch * run, ...(isCorner(plan, at) ? [0] : [])],
    steps: [0.4, 0.4, ...(isCorner(plan, at) ? [4] : [])],
    made: ([foot, top, turn]) => {
      const slope = (top! - foot!) / run;
      if (foot! < 0.1 || !(slope > 0.01 && slope < steepest)) return null;
      const change = (p: Profile) => {
        const moved = withGutter(p, foot!);
        return withSlope(moved, lastRoof(moved), slope);
      };
      return replaced(parts, part, { ...changeProfiles(turn ? turnedBy(plan, at, turn) : plan, edges, change), cap }).parts;
    },
  };
}

/** A part whose cap is just above its ridge. */
export const trimmed = (parts: readonly NamedPlan[], part: string, ridge: number): NamedPlan[] =>
  parts.map((p) => (p.id === part ? { id: p.id, plan: { ...p.plan, cap: Math.min(p.plan.cap, ridge + 0.01) } } : p));

/** The place of a dormer on its slope, its width, its height and the pitch of its roof. */
export function variableDormer(parts: readonly NamedPlan[], id: string): Variable | null {
  const box = dormerBox(parts, id);
  const plan = parts.find((p) => p.id === id)?.plan;
  if (!box || !plan) return null;
  const rises = plan.profiles.flatMap((p) => (lastRoof(p) ? [pitchOf(p)!] : []));
  const width = box.right - box.left;
  const centre = (box.left + box.right) / 2;
  return {
    start: [centre, box.front, width, box.eaves, ...rises.slice(0, 1)],
    steps: [0.4, 0.4, 0.4, 0.4, ...rises.slice(0, 1).map(() => 0.2)],
    made: ([at, front, wide, eaves, rise]) =>
      rise !== undefined && !(rise > 0.01 && rise < steepest)
        ? null
        : withDormerBox(parts, id, { left: at! - wide! / 2, right: at! + wide! / 2, front: front!, eaves: eaves! }, rise ?? null),
  };
}

const most = 160; // measurements

/** The values of the minimum, to a hundredth: one is varied after the other, in steps that become smaller. */
export async function least(
  { start, steps }: Pick<Variable, "start" | "steps">,
  cost: (values: readonly number[]) => Promise<number>,
): Promise<{ values: number[]; cost: number }> {
  let best = [...start];
  let lowest = await cost(best);
  let asked = 1;
  for (let scale = 1; scale > 0.02 && asked < most; ) {
    let better = false;
    for (const [i, step] of steps.entries())
      for (const way of [1, -1]) {
        // As long as it helps, on in the same direction.
        for (;;) {
          if (asked >= most) break;
          const next = best.map((x, k) => (k === i ? x + way * scale * step : x));
          const measured = await cost(next);
          ++asked;
          if (!(measured < lowest * (1 - 1e-4))) break;
          [best, lowest, better] = [next, measured, true];
        }
      }
    if (!better) scale /= 2;
  }
  return { values: best, cost: lowest };
}

/** Values as they are written: in millimetres, slopes to a ten-thousandth. */
export const roundedValues = (values: readonly number[]) => values.map((x) => Math.round(x * 1e4) / 1e4);

export const isDormer = (parts: readonly NamedPlan[], id: string | null) => (structureAt(parts, id)?.dormer ?? null) !== null;
