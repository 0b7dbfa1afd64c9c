// A value that is typed while several parts are selected goes to all of them.
import type { NamedPlan, Plan } from "../api/types";
import { edgesOf, endsOf, type EdgeAt } from "./plan";
import type { Parts } from "./session";
import { replaced } from "./structures";
import { dot, minus, unit } from "./vector";

export interface PartAt {
  building: string;
  part: string;
}
/** A change of a plan, that of a part; `edges`: those that it applies to. */
export type Change = (plan: Plan, edges: EdgeAt[], at: PartAt) => Plan;

const sameWay = 0.966; // cosine of 15°

/** The edges of another plan that face as one of these does, to within 15°. */
export function facing(plan: Plan, edges: readonly EdgeAt[], other: Plan): EdgeAt[] {
  const directions = (of: Plan, at: EdgeAt) => {
    const ends = endsOf(of, at);
    return ends && unit(minus(ends[1], ends[0]));
  };
  const own = edges.map((e) => directions(plan, e));
  return edgesOf(other).filter((e) => {
    const way = directions(other, e);
    return way !== null && own.some((o) => o !== null && dot(o, way) > sameWay);
  });
}

/** The buildings with a change of the first part, on these edges, and of the others: on all edges, or on those that face the same
 *  way. `left`: parts that it does not change. */
export function onSeveral(
  first: PartAt & { edges: EdgeAt[] },
  others: readonly PartAt[],
  everyEdge: boolean,
  change: Change,
  partsOf: (building: string) => readonly NamedPlan[],
): { parts: Parts[]; changed: number; left: string[] } {
  const own = partsOf(first.building).find((p) => p.id === first.part)!.plan;
  const all = new Map<string, { parts: NamedPlan[]; lost: string[] }>();
  const left: string[] = [];
  let changed = 0;
  for (const at of [first, ...others.filter((o) => o.building !== first.building || o.part !== first.part)]) {
    const now = all.get(at.building) ?? { parts: partsOf(at.building).map(({ id, plan }) => ({ id, plan })), lost: [] };
    const plan = now.parts.find((p) => p.id === at.part)?.plan;
    if (!plan) continue;
    const edges = at === first ? first.edges : everyEdge ? edgesOf(plan) : facing(own, first.edges, plan);
    const next = change(plan, edges, at);
    if (at !== first && JSON.stringify(next) === JSON.stringify(plan)) {
      left.push(at.part);
      continue;
    }
    const { parts, lost } = replaced(now.parts, at.part, next);
    all.set(at.building, { parts, lost: [...now.lost, ...lost] });
    ++changed;
  }
  return { parts: [...all].map(([building, { parts, lost }]) => ({ building, parts, lost })), changed, left };
}
