// The parts around the selected one, for drawing, snapping and merging.
import { useMemo } from "preact/hooks";
import type { Plan, Point2 } from "../api/types";
import * as state from "../state";
import { partsOf } from "./desk";
import { sharedWall } from "./plan";

export interface Neighbour {
  building: string;
  part: string;
  plan: Plan;
}

/** Maximum distance of neighbours, metres. */
const nearby = 60;

function near(plan: Plan): (other: Plan) => boolean {
  const xs = plan.outer.points.map((p) => p[0]);
  const ys = plan.outer.points.map((p) => p[1]);
  const low: Point2 = [Math.min(...xs) - nearby, Math.min(...ys) - nearby];
  const high: Point2 = [Math.max(...xs) + nearby, Math.max(...ys) + nearby];
  return (other) => other.outer.points.some((p) => p[0] > low[0] && p[0] < high[0] && p[1] > low[1] && p[1] < high[1]);
}

/** All parts near the selected one, and those that it can be merged with; additionally selected ones come first. */
export function useNeighbours(plan: Plan | null, key: string): { all: Neighbour[]; touching: Neighbour[] } {
  const run = state.run.value;
  const at = state.selection.value;
  const also = state.also.value;
  // Changes of the plan itself do not affect its neighbours; but a draft may have other parts than the run.
  const drafted = state.draft.value?.changes.length;
  const all = useMemo(() => {
    if (!plan || !at || !run) return [];
    const isNear = near(plan);
    return [...run.buildings.keys()].flatMap((building) =>
      partsOf(building)
        .filter((part) => (building !== at.building || part.id !== at.part) && isNear(part.plan))
        .map((part): Neighbour => ({ building, part: part.id, plan: part.plan })),
    );
  }, [run, key, drafted]);
  const touching = useMemo(() => {
    if (!plan || !at) return [];
    const picked = (n: Neighbour) => also.some((a) => a.building === n.building && a.part === n.part);
    // Additionally selected parts first, then parts of the same building, then by the length of the shared wall.
    const rank = (n: Neighbour) => (picked(n) ? 2 : n.building === at.building ? 1 : 0);
    return all
      .map((n) => ({ ...n, shared: sharedWall(plan, n.plan) }))
      .filter((n) => picked(n) || n.shared >= 0.1)
      .sort((a, b) => rank(b) - rank(a) || b.shared - a.shared);
  }, [all, also]);
  // Structures on a roof move with it, and it with them.
  const own = new Map(at ? partsOf(at.building).map((p) => [p.id, p.plan]) : []);
  const now = all.flatMap((n) => {
    if (n.building !== at?.building) return [n];
    const plan = own.get(n.part);
    return plan ? [{ ...n, plan }] : [];
  });
  return { all: now, touching };
}
