// What the page knows, as signals: panels read them, actions (src/actions.ts) change them.
import { computed, signal } from "@preact/signals";
import type * as api from "./api/types";

/** A place in a run's models. `edge` belongs to `ring` (0 the outer one) of `part`. */
export interface Selection {
  building: string;
  part: string | null;
  ring: number;
  edge: number | null;
}

/** A run with its models as they stand on the server. */
export interface OpenRun {
  id: string;
  buildings: Map<string, api.Building>;
  history: api.History;
}

/** Plans being changed and not (yet) written: while dragging, and when they are invalid and held. */
export interface Draft {
  what: string;
  changes: api.Change[];
  raised: Map<string, api.RaisedBuilding>; // by building, the last answer of the server
  pending: boolean; // a newer one is asked for
  invalid: boolean; // held: the server would refuse it
}

/** The error map of one block of a run. */
export interface LoadedMap extends api.ErrorMap {
  cells: Float32Array; // rows from the south; NaN for none
}

export type Tab = "edit" | "run" | "buildings" | "plots" | "layers" | "compare";
export type Flight = "home" | "top" | "selection";

export const connected = signal(true);
export const locked = signal(false); // the server runs, but no longer takes this page's token
export const project = signal<api.Project | null>(null);
export const scene = signal<api.Scene | null>(null);
export const tiles = signal<api.TileIndex | null>(null);
export const options = signal<api.Options | null>(null);
export const jobs = signal<api.Job[]>([]);

export const run = signal<OpenRun | null>(null); // the one seen and edited
export const other = signal<OpenRun | null>(null); // the one compared with, if any
export const opening = signal<string | null>(null); // a run on its way
export const selection = signal<Selection | null>(null);
/** More parts of the selection (shift-click): for merging. */
export const also = signal<{ building: string; part: string }[]>([]);
export const draft = signal<Draft | null>(null);
export const messages = signal<api.Diagnostic[]>([]); // newest first; shown until dismissed

/** Of the runs seen: fetched when something wants to draw them. */
export const whys = signal<Map<string, api.Layers>>(new Map());
export const errorMaps = signal<Map<string, LoadedMap[]>>(new Map());

export const tab = signal<Tab>("run");
export const hovered = signal<Selection | null>(null);
export const sheet = signal(false); // of the keyboard
export const layersOpen = signal(false);
export const asksInputs = signal(false); // the first screen once more, over an open project
/** Blocks that the next run shall do, and whether clicks in the view choose them. */
export const chosenBlocks = signal<ReadonlySet<string>>(new Set());
export const choosing = signal(false);
/** Asks the view to fly; `at` makes two same wishes differ. */
export const flight = signal<{ to: Flight; at: number } | null>(null);

/** The building as it should be drawn: with its draft where there is one. */
export function shown(id: string): api.RaisedBuilding | undefined {
  return draft.value?.raised.get(id) ?? run.value?.buildings.get(id);
}

export const selectedBuilding = computed(() => {
  const at = selection.value;
  return at ? run.value?.buildings.get(at.building) : undefined;
});

/** The plan of the selected part as it is being edited. */
export const selectedPlan = computed<api.Plan | null>(() => {
  const at = selection.value;
  if (!at?.part) return null;
  const changed = draft.value?.changes.find((c) => c.building === at.building);
  const parts: api.NamedPlan[] | undefined = changed?.parts ?? selectedBuilding.value?.parts;
  return parts?.find((p) => p.id === at.part)?.plan ?? null;
});

/** Ids in the order of the list of buildings: as they are sorted and filtered there. */
export const order = signal<string[]>([]);

export const runSummary = (id: string | undefined) => project.value?.runs.find((r) => r.id === id);
export const busyJob = computed(
  () => jobs.value.find((j) => j.state === "running") ?? jobs.value.find((j) => j.state === "queued"),
);
