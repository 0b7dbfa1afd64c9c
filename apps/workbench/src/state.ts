// The state of the page as signals: panels read them, actions (src/actions.ts) change them.
import { computed, signal } from "@preact/signals";
import type * as api from "./api/types";
import type { Large } from "./large";

/** A building, part or edge of the open run. `edge` belongs to `ring` (0: the outer ring) of `part`. */
export interface Selection {
  building: string;
  part: string | null;
  ring: number;
  edge: number | null;
}

/** A run with its models in their state on the server. */
export interface OpenRun {
  id: string;
  buildings: Map<string, api.Building>; // of a large run those whose models are loaded
  history: api.History;
  large?: Large;
}

/** Changed plans that are not saved: while dragging, and when they are invalid. */
export interface Draft {
  what: string;
  changes: api.Change[];
  raised: Map<string, api.RaisedBuilding>; // by building: the last preview of the server
  pending: boolean; // a newer preview was requested
  invalid: boolean; // the server would refuse to save it
}

/** The error map of one block of a run. */
export interface LoadedMap extends api.ErrorMap {
  cells: Float32Array; // rows from south to north; NaN where there is no value
}

export type Tab = "edit" | "run" | "buildings" | "review" | "attributes" | "plots" | "layers" | "compare";
/** case: to the selection, at once. */
export type Flight = "home" | "top" | "selection" | "case";

export const connected = signal(true);
export const locked = signal(false); // the server runs, but refuses the token of this page
export const wasConnected = signal(false); // it has accepted the token before: it was restarted since
export const project = signal<api.Project | null>(null);
export const scene = signal<api.Scene | null>(null);
export const tiles = signal<api.TileIndex | null>(null);
/** Whether the server has read the textures of the scene. */
export const texturesRead = signal(false);
export const options = signal<api.Options | null>(null);
export const jobs = signal<api.Job[]>([]);

export const run = signal<OpenRun | null>(null); // the run that is shown and edited
export const other = signal<OpenRun | null>(null); // the run to compare with
export const opening = signal<string | null>(null); // the run that is being loaded
export const selection = signal<Selection | null>(null);
/** Additional selected parts (Shift and click), to merge with. */
export const also = signal<{ building: string; part: string }[]>([]);
export const draft = signal<Draft | null>(null);
/** A diagnostic, or a success. */
export type Message = Omit<api.Diagnostic, "severity"> & { severity: api.Diagnostic["severity"] | "success" };
export const messages = signal<Message[]>([]); // newest first

/** Layers and error maps of the runs; fetched on demand. */
export const segmentations = signal<Map<string, api.Layers>>(new Map());
export const errorMaps = signal<Map<string, LoadedMap[]>>(new Map());
/** Scores of edited runs, as they are now. Those of a run are missing from an edit until they have been measured. */
export const scoresNow = signal<Map<string, api.ScoresNow>>(new Map());
/** Runs whose error maps are older than their last edit. */
export const outdatedMaps = signal<ReadonlySet<string>>(new Set());

/** Attributes of the buildings of the runs; fetched on demand, and again after edits. */
export const attributes = signal<Map<string, api.AttributeTable>>(new Map());
/** Single attributes of all buildings of large runs, by "run name"; fetched on demand, and again after edits. */
export const columns = signal<Map<string, api.AttributeColumn>>(new Map());
/** Runs whose attributes are older than their last edit. */
export const outdatedAttributes = signal<ReadonlySet<string>>(new Set());
/** Solids of the runs at lower levels of detail, by "run lod"; fetched on demand. */
export const levels = signal<Map<string, api.LevelOfDetail>>(new Map());
/** The terrain around the models of the runs; fetched on demand, and again after edits. */
export const terrains = signal<Map<string, ArrayBuffer>>(new Map());
/** The picture of the ground in the frame of the runs; fetched on demand. */
export const basemaps = signal<Map<string, ArrayBuffer>>(new Map());
/** Models of other programs that are shown beside those of the run. */
export const others = signal<{ name: string; model: api.OtherModel }[]>([]);

export const tab = signal<Tab>("run");
/** What is under the pointer. `right`: in the run to compare with. */
export const hovered = signal<(Selection & { right?: boolean }) | null>(null);
/** The point of a model, the scan or the ground under the resting pointer, in the frame of the scene. */
export const pointer = signal<[number, number, number] | null>(null);
/** Direction of the view and size of a pixel at its target, of the last image. */
export const compass = signal<{ azimuth: number; metresPerPixel: number } | null>(null);
export const keyboardHelp = signal(false);
/** Which page of the help is shown. */
export const helpPage = signal<"keys" | "manual">("keys");
export const pictureOpen = signal(false);
export const layersOpen = signal(false);
export const changingInputs = signal(false); // the first screen is shown over an open project
/** Blocks that the next run reconstructs, and whether clicks in the view select them. */
export const chosenBlocks = signal<ReadonlySet<string>>(new Set());
export const choosing = signal(false);
/** Requests a camera flight; `at` distinguishes two equal requests. */
export const flight = signal<{ to: Flight; at: number } | null>(null);

/** Whether the server has read the inputs: until then a scene that is shown is that of the last time. */
export const sceneRead = computed(
  () => scene.value !== null && !jobs.value.some((j) => j.kind === "read" && (j.state === "queued" || j.state === "running")),
);

/** Whether the error maps of a run can be had: those of an edited one are measured again, which needs the inputs. */
export const hasMaps = (run: OpenRun | null) => run !== null && (run.history.done === 0 || sceneRead.value);

/** The building to draw: its draft, if it has one. */
export function shown(id: string): api.RaisedBuilding | undefined {
  return draft.value?.raised.get(id) ?? run.value?.buildings.get(id);
}

export const selectedBuilding = computed(() => {
  const at = selection.value;
  return at ? run.value?.buildings.get(at.building) : undefined;
});

/** The plan of the selected part, with its unsaved changes. */
export const selectedPlan = computed<api.Plan | null>(() => {
  const at = selection.value;
  if (!at?.part) return null;
  const changed = draft.value?.changes.find((c) => c.building === at.building);
  const parts: api.NamedPlan[] | undefined = changed?.parts ?? selectedBuilding.value?.parts;
  return parts?.find((p) => p.id === at.part)?.plan ?? null;
});

/** Building ids in the order of the table, as it is sorted and filtered. */
export const order = signal<string[]>([]);

/** How many edits of a run are applied: of an open run as this page has them, else as the server listed them. */
export function editsOf(summary: api.RunSummary): number {
  const open = [run.value, other.value].find((r) => r?.id === summary.id);
  return open?.history.done ?? summary.edits;
}
/** The scores of a run after its edits. `outdated`: they are still those before its last edits. */
export function scoresOf(summary: api.RunSummary): { scores: api.Scores | null; outdated: boolean } {
  if (!summary.scores || editsOf(summary) === 0) return { scores: summary.scores, outdated: false };
  const now = scoresNow.value.get(summary.id);
  return now ? { scores: now.scores, outdated: false } : { scores: summary.scores, outdated: true };
}

/** A run before its edits stands beside it as another run: its id, and that of the run itself. */
const before = "/before";
export const beforeOf = (id: string) => id + before;
export const isBefore = (id: string | undefined) => id?.endsWith(before) ?? false;
export const runOf = (id: string) => (isBefore(id) ? id.slice(0, -before.length) : id);

export function runSummary(id: string | undefined): api.RunSummary | undefined {
  const found = project.value?.runs.find((r) => id !== undefined && r.id === runOf(id));
  return found && isBefore(id) ? { ...found, id: id!, label: `${found.label || found.id} before its edits`, edits: 0 } : found;
}
export const busyJob = computed(
  () => jobs.value.find((j) => j.state === "running") ?? jobs.value.find((j) => j.state === "queued"),
);
