// Shared by both editors: the edited part in its present state, and how its changes are passed to the session.
import { computed, signal } from "@preact/signals";
import type * as api from "../api/types";
import { keepOpen } from "../actions";
import * as state from "../state";
import type { Parts } from "./session";
import { replaced } from "./structures";
import { distance } from "./vector";
import { edgesOf, endsOf, ringOf, sameEdge, type EdgeAt, type Scope } from "./plan";

export const scope = signal<Scope>("edge");
/** Additional edges to copy a profile to. */
export const chosen = signal<EdgeAt[]>([]);
export const snapping = signal(true);
/** Grid spacing in metres; 0 for none. */
export const grid = signal(0);

/** The parts of a building, with unsaved changes. */
export function partsOf(building: string): api.NamedPlan[] {
  const drafted = state.draft.value?.changes.find((c) => c.building === building)?.parts;
  return drafted ?? state.run.value?.buildings.get(building)?.parts ?? [];
}

/** The parts of the building, with this plan for the selected part, which is a change of `parts`; roof structures follow. */
export function withPlan(plan: api.Plan, parts?: readonly api.NamedPlan[]): Parts[] {
  const at = state.selection.value;
  if (!at?.part) return [];
  return [{ building: at.building, ...replaced(parts ?? partsOf(at.building), at.part, plan) }];
}

/** The selected edge, or the longest one if none is selected: there is always a profile to show. */
export const edgeShown = computed<EdgeAt | null>(() => {
  const plan = state.selectedPlan.value;
  const at = state.selection.value;
  if (!plan || !at) return null;
  if (at.edge !== null && ringOf(plan, at.ring)?.points[at.edge]) return { ring: at.ring, edge: at.edge };
  let best: EdgeAt | null = null;
  let length = -1;
  for (const edge of edgesOf(plan)) {
    const long = distance(...endsOf(plan, edge)!);
    if (long > length) [best, length] = [edge, long];
  }
  return best;
});

/** The selected part with its draft, as last extruded by the server; and the part before the draft. */
export const raisedPart = computed(() => {
  const at = state.selection.value;
  return at?.part ? state.shown(at.building)?.parts.find((p) => p.id === at.part) : undefined;
});
export const partBefore = computed(() => {
  const at = state.selection.value;
  return at?.part ? state.run.value?.buildings.get(at.building)?.parts.find((p) => p.id === at.part) : undefined;
});

export function selectEdge(at: EdgeAt | null) {
  const now = state.selection.value;
  if (!now || (now.ring === (at?.ring ?? 0) && now.edge === (at?.edge ?? null))) return;
  state.selection.value = { ...now, ring: at?.ring ?? 0, edge: at?.edge ?? null };
  keepOpen();
}

/** Adjusts selected edges when a corner is added on edge `at`, or removed from its start: later edge numbers change by one. */
export function renumber(at: EdgeAt, added: boolean, edges: number) {
  const now = (edge: number) => {
    if (added) return edge > at.edge ? edge + 1 : edge;
    return edge < at.edge ? edge : edge > 0 ? edge - 1 : edges - 2;
  };
  const selected = state.selection.value;
  if (selected && selected.ring === at.ring && selected.edge !== null)
    state.selection.value = { ...selected, edge: now(selected.edge) };
  chosen.value = chosen.value.map((e) => (e.ring === at.ring ? { ring: e.ring, edge: now(e.edge) } : e));
}

/** Selects an edge after a change to which other edge numbers do not apply. */
export function selectAfresh(at: EdgeAt | null) {
  chosen.value = [];
  selectEdge(at);
}

export function toggleChosen(at: EdgeAt) {
  const rest = chosen.value.filter((e) => !sameEdge(e, at));
  chosen.value = rest.length < chosen.value.length ? rest : [...rest, at];
}

/** Ridge height: of the highest point of an extruded part above its base, metres. */
export function ridgeOf(part: api.RaisedPart | undefined): number | null {
  const positions = part?.geometry?.positions;
  if (!part || !positions?.length) return null;
  let top = -Infinity;
  for (let i = 2; i < positions.length; i += 3) top = Math.max(top, positions[i]!);
  return top - part.plan.base;
}

/** The distance that an arrow key moves, metres. */
export const keyStep = (event: KeyboardEvent) => (event.shiftKey ? 1 : event.altKey ? 0.01 : 0.1);
export function arrow(event: KeyboardEvent): [number, number] | null {
  const by = keyStep(event);
  switch (event.key) {
    case "ArrowLeft":
      return [-by, 0];
    case "ArrowRight":
      return [by, 0];
    case "ArrowUp":
      return [0, by];
    case "ArrowDown":
      return [0, -by];
    default:
      return null;
  }
}

/** Short names: parts by their number; long ids are shortened to their beginnings and ends. */
export function shortName(building: string, part: string): string {
  return part.startsWith(`${building}-`) ? `part ${part.slice(building.length + 1)}` : shortId(part);
}
export const shortId = (id: string) => (id.length <= 18 ? id : `${id.slice(0, 9)}…${id.slice(-6)}`);
