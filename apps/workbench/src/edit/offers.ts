// Roofs that are shown before they are saved: of a part, of selected parts or of a row, fitted to the scan, and parts like another.
import { effect, signal } from "@preact/signals";
import { client, showMessage } from "../actions";
import { Refused } from "../api/client";
import type { Diagnostic, NamedPlan } from "../api/types";
import { count } from "../panels/words";
import * as state from "../state";
import { alike, alongRow, type Place, rowOf } from "./alike";
import { ridgeOf } from "./desk";
import { isDormer, least, roundedValues, trimmed, variableDormer, variablePlane } from "./fitting";
import { session } from "./here";
import type { Parts } from "./session";
import { type Shape, shaped, sharedEdges } from "./shapes";
import { bare, dormerRoof, replaced, structureAt, structuresOf } from "./structures";

export type Reach = "part" | "selected" | "row";
export const reach = signal<Reach>("part");
/** fitted: the roof as it is. plane: that of the selected edge. alike: the selected parts like the first of them. */
export type Choice = Shape | "fitted" | "plane" | "alike";

interface Offer {
  choice: Choice;
  what: string;
  parts: Parts[];
}
/** The choice whose roof is shown, and the one that was chosen; others are shown while the pointer is over them. */
export const shownChoice = signal<Choice | null>(null);
export const chosenOffer = signal<Offer | null>(null);
/** The choice whose roof is being made. */
export const making = signal<Choice | null>(null);
/** Dormers that the roof that is shown removes. */
export const losing = signal<string[]>([]);

let asked = 0; // the number of the last request: what answers others is not shown
let keeping = false; // to be kept as soon as it is there

effect(() => {
  if (session.phase.value === "offered" || session.phase.value === "changing") return;
  shownChoice.value = chosenOffer.value = null;
  losing.value = [];
});

/** Whether a roof can be shown: nothing else is unsaved. */
const free = () => session.phase.value === "idle" || session.phase.value === "offered";

/** Shows the roof of a choice. `choose`: until it is kept or discarded; otherwise until the pointer leaves. */
export async function show(choice: Choice, choose: boolean) {
  if (!choose && !free()) return;
  const mine = ++asked;
  keeping = false;
  if (choose) making.value = choice;
  const history = state.run.value?.history;
  const made = await offerOf(choice);
  if (mine !== asked) return;
  if (state.run.value?.history !== history) return void show(choice, choose); // an edit came meanwhile
  making.value = null;
  if ("why" in made) {
    if (choose) for (const why of made.why) showMessage(why);
    return;
  }
  if (!choose && !free()) return;
  if (!session.offerTo(made.what, made.parts)) return;
  if (choose) for (const why of made.left) showMessage(why);
  shownChoice.value = choice;
  losing.value = made.parts.flatMap((p) => p.lost ?? []);
  if (choose) chosenOffer.value = made;
  if (choose && keeping) keepShown();
}

/** Shows again what was chosen, or nothing: the pointer has left. */
export function leave() {
  const chosen = chosenOffer.value;
  if (making.value) return;
  ++asked;
  if (!session.offered || shownChoice.value === chosen?.choice) return;
  if (chosen && session.offerTo(chosen.what, chosen.parts)) {
    shownChoice.value = chosen.choice;
    losing.value = chosen.parts.flatMap((p) => p.lost ?? []);
  } else session.discardOffer();
}

/** Saves the roof that was chosen. One that is still being made is saved when it is there. */
export function keepShown() {
  if (making.value) {
    keeping = true;
    return;
  }
  const chosen = chosenOffer.value;
  if (!chosen) return;
  ++asked;
  if (shownChoice.value !== chosen.choice) session.offerTo(chosen.what, chosen.parts);
  session.keepOffer();
}

export function discardShown() {
  ++asked;
  making.value = null;
  session.discardOffer();
}

// ---- roofs

/** Parts without the structures on their roofs, and without the holes for these; without a roof that is only shown. */
const everyPart = (): Place[] =>
  [...state.run.value!.buildings.keys()].flatMap((building) => {
    const parts = session.partsBefore(building);
    let places = placesOf.get(parts);
    if (!places) {
      const structures = new Set(structuresOf(parts).map((s) => s.id));
      places = parts.filter(({ id }) => !structures.has(id)).map(({ id }) => ({ building, part: id, plan: bare(parts, id) }));
      placesOf.set(parts, places);
    }
    return places;
  });
const placesOf = new WeakMap<readonly NamedPlan[], Place[]>(); // plans are replaced, never changed
export const isAt = (p: { building: string; part: string }, at: { building: string; part: string | null }) =>
  p.building === at.building && p.part === at.part;

/** Neighbours of a part within 60 m. */
function sharedOf(place: Place, all: readonly Place[]): boolean[] {
  const xs = place.plan.outer.points.map((p) => p[0]);
  const ys = place.plan.outer.points.map((p) => p[1]);
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const near = all.filter(
    (p) =>
      !isAt(p, place) &&
      p.plan.outer.points.some(([x, y]) => x > left - 60 && x < right + 60 && y > low - 60 && y < high + 60),
  );
  return sharedEdges(place.plan, near.map((p) => p.plan));
}

/** One edit of several parts: all parts of each building that changes. Dormers follow their slopes. */
function together(changed: readonly Place[]): Parts[] {
  const buildings = [...new Set(changed.map((p) => p.building))];
  return buildings.map((building) => {
    let parts: NamedPlan[] = session.partsBefore(building);
    const lost: string[] = [];
    for (const { part, plan } of changed.filter((c) => c.building === building)) {
      const now = replaced(parts, part, plan);
      parts = now.parts;
      lost.push(...now.lost);
    }
    return { building, parts, lost };
  });
}

/** The parts with the best roofs of a kind for the scan, as the engine fits them; those that cannot have one are left out, with
 *  the reason. Without a scan, or where it does not cover the part, as `otherwise` makes them. */
async function fittedOr(
  places: readonly Place[],
  kind: Shape | "fitted",
  otherwise?: (place: Place) => Place["plan"],
): Promise<{ changed: Place[]; left: Diagnostic[] }> {
  const run = state.run.value;
  const plain = (place: Place) => (otherwise ? [{ ...place, plan: otherwise(place) }] : []);
  if (!run || !state.sceneRead.value) return { changed: places.flatMap(plain), left: [] };
  try {
    const { roofs } = await client.roofs(run.id, kind, [...places]);
    const left: Diagnostic[] = [];
    const changed = roofs.flatMap((roof, i) => {
      const place = places[i]!;
      if (roof.plan) return [{ ...place, plan: roof.plan }];
      if (otherwise && (roof.why?.code === "refine-unseen" || roof.why?.code === "edit-unseen")) return plain(place);
      if (roof.why) left.push({ ...roof.why, severity: "warning", subject: place.part });
      return [];
    });
    return { changed, left };
  } catch (failure) {
    if (failure instanceof Refused) return { changed: [], left: [failure.diagnostic] };
    throw failure;
  }
}

type Made = (Offer & { left: Diagnostic[] }) | { why: Diagnostic[] };
const warning = (code: string, message: string, subject: string): Diagnostic => ({ severity: "warning", code, message, subject });

async function offerOf(choice: Choice): Promise<Made> {
  const at = state.selection.value;
  const run = state.run.value;
  if (!at?.part || !run) return { why: [] };
  const own = session.partsBefore(at.building);
  const also = state.also.value;
  const one = (what: string, parts: NamedPlan[]): Made => ({ choice, what, parts: [{ building: at.building, parts }], left: [] });
  if (choice === "plane" || (choice === "fitted" && isDormer(own, at.part))) {
    const parts = await fittedByError(choice);
    if (!parts) return { why: [warning("edit-unfitted", "this cannot be fitted: the scan does not cover the building, or its plan is not valid", at.part)] };
    return one(choice === "plane" ? `plane of edge ${at.edge} of ${at.part} fitted to the scan` : `dormer ${at.part} fitted to the scan`, parts);
  }
  const structure = structureAt(own, at.part);
  if (structure && choice !== "fitted" && choice !== "alike") {
    // A roof of its own; it is not among the parts of a row.
    const plan = own.find((p) => p.id === structure.id)!.plan;
    const roof = dormerRoof(own, structure.id, choice) ?? shaped(plan, choice);
    return one(`${choice} roof of ${structure.id}`, replaced(own, structure.id, roof).parts);
  }
  const all = everyPart();
  const first = all.find((p) => isAt(p, at));
  if (!first) return { why: [] };
  if (choice === "alike") {
    const shared = sharedOf(first, all);
    const changed = all
      .filter((p) => also.some((a) => isAt(p, a)) && !isAt(p, at))
      .map((place) => ({ ...place, plan: alike(first.plan, place.plan, shared, sharedOf(place, all)) }));
    return changed.length ? { choice, what: `${count(changed.length, "part")} like ${first.part}`, parts: together(changed), left: [] } : { why: [] };
  }
  const row = reach.value === "row";
  const places = row ? rowOf(first, all) : [first, ...(reach.value === "selected" ? all.filter((p) => !isAt(p, at) && also.some((a) => isAt(p, a))) : [])];
  const { changed, left } = await fittedOr(
    places,
    choice,
    choice === "fitted"
      ? undefined
      : (place) => {
          const shared = sharedOf(place, all);
          const along = row ? alongRow(place.plan, shared) : null;
          return shaped(place.plan, choice, (i) => shared[i]!, {}, along ?? undefined);
        },
  );
  if (!changed.length) return { why: left };
  const several = changed.length > 1;
  const what = choice === "fitted" ? (several ? `${changed.length} roofs fitted to the scan` : "roof fitted to the scan") : several ? `${choice} roofs of ${changed.length} parts` : `${choice} roof`;
  return { choice, what, parts: together(changed), left };
}

/** The selected plane or dormer where the error of its building is least. The present one, if nothing is better. */
async function fittedByError(choice: "plane" | "fitted"): Promise<NamedPlan[] | null> {
  const at = state.selection.value!;
  const run = state.run.value!;
  const mine = asked;
  const own = session.partsBefore(at.building).map(({ id, plan }) => ({ id, plan }));
  const part = at.part!;
  const revision = run.buildings.get(at.building)?.revision ?? 0;
  const raise = async (parts: NamedPlan[]) => {
    const { buildings } = await client.preview(run.id, [{ building: at.building, revision, parts }]);
    return buildings[0]!;
  };
  try {
    const before = await raise(own);
    const ridge = ridgeOf(before.parts.find((p) => p.id === part)) ?? 0;
    const variable = choice === "plane" ? (at.edge === null ? null : variablePlane(own, part, { ring: at.ring, edge: at.edge }, ridge)) : variableDormer(own, part);
    if (!variable || before.mse === null) return null;
    const found = await least(variable, async (values) => {
      const parts = mine === asked ? variable.made(values) : null;
      if (!parts) return Infinity;
      const { valid, mse, parts: raised } = await raise(parts);
      return valid && mse !== null && raised.every((p) => p.outcome === "full" || before.parts.find((q) => q.id === p.id)?.outcome === p.outcome) ? mse : Infinity;
    });
    if (!(found.cost < before.mse)) return own;
    const parts = variable.made(roundedValues(found.values));
    if (!parts || choice === "fitted") return parts;
    return trimmed(parts, part, ridgeOf((await raise(parts)).parts.find((p) => p.id === part)) ?? ridge);
  } catch (failure) {
    if (failure instanceof Refused) return null;
    throw failure;
  }
}
