// The roof of a wall gets a direction of its own, in one step: that which fits the scan best, if there is one.
import { signal } from "@preact/signals";
import { client, showMessage } from "../actions";
import { Refused } from "../api/client";
import type { NamedPlan, Plan } from "../api/types";
import * as state from "../state";
import { partsOf, raisedPart, ridgeOf, selectAfresh, withPlan } from "./desk";
import { least, roundedValues, trimmed, variablePlane } from "./fitting";
import { session } from "./here";
import type { Parts } from "./session";
import { changeProfiles, endsOf, profileOf, type EdgeAt } from "./plan";
import { gutterOf, lastRoof, pitchOf, withGutter } from "./profile";
import { replaced } from "./structures";
import { capAbove, liftOf, turnedAt, withTurnedRoof, type Turned } from "./turned_roof";
import { cross, middle, minus, unit } from "./vector";

/** Whether a direction is being looked for. */
export const turning = signal(false);

const highest = 30; // m; of the cap while directions are tried
const lowest = 0.1; // m; of a gutter

/** Makes a corner edge for the roof of a wall, and selects it. */
export async function turnRoof(at: EdgeAt): Promise<void> {
  const run = state.run.value;
  const selection = state.selection.value;
  const plan = state.selectedPlan.value;
  if (turning.value || !run || !plan || !selection?.part) return;
  const { building, part } = selection;
  const found = withTurnedRoof(plan, at);
  if (!found.length) {
    showMessage({
      severity: "warning",
      code: "edit-no-turn",
      message: `the roof of edge ${at.edge} cannot be turned: neither of its corners turns to the inside of the part by more than 1°`,
      subject: part,
    });
    return;
  }
  const ridge = ridgeOf(raisedPart.value) ?? 0;
  const what = `roof of edge ${at.edge} of ${part} turned`;
  const usual = () => made(what, withPlan(risen(plan, at, found[0]!, ridge)), found[0]!.at);
  if (!state.sceneRead.value) return usual();
  const before = partsOf(building);
  const history = run.history;
  turning.value = true;
  try {
    const best = await fitted(run.id, building, part, before.map(({ id, plan: p }) => ({ id, plan: p })), plan, at, found, ridge);
    const now = state.selection.value;
    // Something else was edited or selected meanwhile.
    if (state.run.value?.history !== history || partsOf(building) !== before || now?.building !== building || now.part !== part) return;
    if (best) made(what, [{ building, parts: best.parts, lost: before.flatMap((p) => (best.parts.some((q) => q.id === p.id) ? [] : [p.id])) }], best.at);
    else usual();
  } catch (failure) {
    if (!(failure instanceof Refused)) throw failure;
    usual();
  } finally {
    turning.value = false;
  }
}

function made(what: string, parts: Parts[], at: EdgeAt) {
  if (session.propose(what, parts)) selectAfresh(at);
}

/** With a cap that does not cut off what rises. */
function risen(plan: Plan, at: EdgeAt, { plan: turned, at: corner }: Turned, ridge: number): Plan {
  const [a, b] = endsOf(plan, at)!;
  const up = liftOf(turned, corner, unit(minus(b, a))!, turnedAt(turned, corner)!.along);
  return { ...turned, cap: capAbove(plan, ridge, up) };
}

/** With a gutter so much lower that the roof is as high as before over the middle of its wall. */
function levelled(plan: Plan, at: EdgeAt, { plan: turned, at: corner }: Turned): Plan {
  const [a, b] = endsOf(plan, at)!;
  const own = turnedAt(turned, corner)!;
  const inward = cross(own.along, minus(middle(a, b), own.corner));
  return changeProfiles(turned, [corner], (p) => {
    const gutter = gutterOf(p);
    return gutter === null || !lastRoof(p) ? null : withGutter(p, Math.max(lowest, gutter - pitchOf(p)! * inward));
  });
}

/** The direction, gutter and pitch with the minimum error; null if the scan does not cover the building. */
async function fitted(
  run: string,
  building: string,
  part: string,
  parts: NamedPlan[],
  plan: Plan,
  wall: EdgeAt,
  found: Turned[],
  ridge: number,
): Promise<{ parts: NamedPlan[]; at: EdgeAt } | null> {
  const revision = state.run.value!.buildings.get(building)?.revision ?? 0;
  const raise = async (all: NamedPlan[]) => (await client.preview(run, [{ building, revision, parts: all }])).buildings[0]!;
  const cost = async (all: NamedPlan[] | null) => {
    const raised = all && (await raise(all));
    return raised?.valid && raised.mse !== null && raised.parts.every((p) => p.outcome === "full") ? raised.mse : Infinity;
  };
  let best: { turned: Turned; cost: number } | null = null;
  for (const turned of found) {
    const level = levelled(plan, wall, turned);
    const high: Plan = { ...level, cap: plan.cap < ridge + 0.005 ? plan.cap : plan.cap + highest };
    const measured = await cost(replaced(parts, part, high).parts);
    if (!best || measured < best.cost) best = { turned: { plan: level, at: turned.at }, cost: measured };
  }
  if (!best || best.cost === Infinity) return null;
  const { at } = best.turned;
  const start = replaced(parts, part, best.turned.plan).parts;
  const variable = profileOf(best.turned.plan, at) && variablePlane(start, part, at, ridge);
  if (!variable) return { parts: start, at };
  const { values, cost: reached } = await least(variable, async (tried) => cost(variable.made(tried)));
  const all = (reached < best.cost ? variable.made(roundedValues(values)) : null) ?? start;
  const top = ridgeOf((await raise(all)).parts.find((p) => p.id === part)) ?? ridge;
  return { parts: trimmed(all, part, top), at };
}
