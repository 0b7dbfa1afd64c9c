// Everything that changes the signals of state.ts: calls of the server and its events.
import { batch } from "@preact/signals";
import { Client, type InputsRequest, Refused, type RunRequest } from "./api/client";
import type * as api from "./api/types";
import { keep, kept } from "./keep";
import { type Large, largeOf, mostAtOnce, mostLoaded, tilesAround } from "./large";
import { rowOf } from "./panels/table";
import * as state from "./state";

/** The token is in the fragment of the link. It is kept for reloads of this tab, and removed from the address. */
function tokenOf(): string {
  if (typeof location === "undefined") return "";
  const given = new URLSearchParams(location.hash.slice(1)).get("token");
  if (given) {
    keep("session", "token", given);
    const view = new URLSearchParams(location.hash.slice(1)).get("view"); // a link to a view: view/link.ts reads it
    history.replaceState(null, "", location.pathname + location.search + (view ? `#view=${view}` : ""));
  }
  return given ?? kept("session", "token", "");
}

export const client = new Client(tokenOf());

/** Opening a new link in the same tab changes only the fragment: the page is reloaded with its token. */
export function newLink() {
  if (!/(token|view)=/.test(location.hash)) return;
  tokenOf();
  location.reload();
}

// ---- messages

const most_messages = 5;
export function showMessage(diagnostic: state.Message) {
  const same = (m: state.Message) => m.code === diagnostic.code && m.message === diagnostic.message;
  state.messages.value = [diagnostic, ...state.messages.value.filter((m) => !same(m))].slice(0, most_messages);
}
export function dismiss(diagnostic: state.Message) {
  state.messages.value = state.messages.value.filter((m) => m !== diagnostic);
}
export const warn = (code: string, message: string, subject = "") => showMessage({ severity: "warning", code, message, subject });

/** Shows a success for a few seconds. */
export function showSuccess(code: string, message: string) {
  const diagnostic: state.Message = { severity: "success", code, message, subject: "" };
  showMessage(diagnostic);
  setTimeout(() => dismiss(diagnostic), 8000);
}

/** The answer of a call. A refusal is shown as a message, and gives undefined. */
export async function attempt<T>(call: Promise<T>): Promise<T | undefined> {
  try {
    return await call;
  } catch (e) {
    if (e instanceof Refused) showMessage(e.diagnostic);
    else if (!(e instanceof DOMException && e.name === "AbortError")) throw e;
    return undefined;
  }
}

// ---- the project

/** The open runs and the selection of a project, kept across reloads. */
interface Open {
  run: string | null;
  other: string | null;
  selection: state.Selection | null;
}
const openKey = () => `open ${state.project.value?.folder ?? ""}`;
/** Copies text; false if the browser does not allow it. */
export async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

export function keepOpen() {
  if (!state.project.value || state.opening.value) return;
  const open: Open = {
    run: state.run.value?.id ?? null,
    other: state.other.value?.id ?? null,
    selection: state.selection.value,
  };
  keep("local", openKey(), open);
  keep("session", openKey(), open);
}

/** Loads the project, and receives events until aborted. */
export async function begin(signal: AbortSignal) {
  let away = false;
  // What happens between the answers below and the first event would be missed: events come first.
  let listening = () => {};
  const heard = new Promise<void>((resolve) => (listening = resolve));
  void client.events(
    received,
    (there, status) => {
      listening();
      state.connected.value = there;
      if (there) state.wasConnected.value = true;
      state.locked.value = status === 401 || status === 403;
      if (there && away) void refresh();
      away = !there;
    },
    signal,
  );
  await heard;
  await refresh();
}

/** The project of the newest event since `refresh` began. */
let told: api.Project | null = null;

/** Loads everything again, e.g. after the connection was lost. Run, selection and draft are kept if they still exist. */
export async function refresh() {
  state.jobs.value = []; // entries found below arrived meanwhile; job numbers restart with every server
  told = null;
  const [answer, options, jobs] = await Promise.all([
    attempt(client.project()),
    state.options.value ? state.options.value : attempt(client.options()),
    attempt(client.jobs()),
  ]);
  const project = told ?? answer; // an event is never older than the answer
  if (!project) return;
  const answered = jobs?.jobs ?? [];
  const arrived = state.jobs.value;
  batch(() => {
    state.project.value = project;
    state.options.value = options ?? null;
    state.jobs.value = [
      ...answered.map((j) => arrived.find((a) => a.id === j.id && ended(a)) ?? j), // its event came before the answer
      ...arrived.filter((a) => !answered.some((j) => j.id === a.id)),
    ];
  });
  // While inputs are being read the server has what it kept of the scene, or none. It is loaded again when that job has ended.
  if (project.scene || !state.jobs.value.some((j) => j.kind === "read" && !ended(j))) void loadScene();
  const open = kept<Open | null>("session", openKey(), null) ?? kept<Open | null>("local", openKey(), null);
  const finished = project.runs.filter((r) => r.state === "done");
  const there = (id: string | null | undefined) => finished.some((r) => id && r.id === state.runOf(id));
  const wanted = state.run.value?.id ?? open?.run;
  const id = there(wanted) ? wanted : finished.at(-1)?.id;
  if (!id) {
    state.run.value = state.other.value = null;
    return;
  }
  await openRun(id, open?.selection ?? null);
  const beside = state.other.value?.id ?? open?.other;
  if (there(beside) && beside !== id && (!state.isBefore(beside!) || beside === state.beforeOf(id))) await compareWith(beside!);
}

export async function loadScene() {
  if (!state.project.value?.inputs) return;
  try {
    const [scene, tiles] = await Promise.all([client.scene(), client.tiles()]);
    // What was shown while the inputs were read again is mostly the same: its tiles stay.
    const same = (a: unknown, b: unknown) => JSON.stringify(a) === JSON.stringify(b);
    batch(() => {
      if (!same(scene, state.scene.value)) state.scene.value = scene;
      if (!same(tiles, state.tiles.value)) state.tiles.value = tiles;
      state.texturesRead.value = false;
    });
    for (const open of [state.run.value, state.other.value]) if (open?.history.done) measureAgain(open.id);
  } catch (e) {
    // "server-no-scene": it was requested too early.
    if (e instanceof Refused && e.diagnostic.code !== "server-no-scene") showMessage(e.diagnostic);
    else if (!(e instanceof Refused)) throw e;
    else state.scene.value = state.tiles.value = null;
  }
}

/** Reads the textures of the scan on the server; false if there are none. */
export async function needTextures(): Promise<boolean> {
  if (state.texturesRead.value || reading) return true;
  reading = true;
  const job = await started(client.readTextures());
  const now = () => state.jobs.value.find((j) => j.id === job?.id);
  while (job && !ended(now() ?? job)) await new Promise((resolve) => setTimeout(resolve, 50));
  reading = false;
  if (!job || now()?.state !== "done") return false;
  state.texturesRead.value = true;
  return true;
}
let reading = false;

export const openInputs = (request: InputsRequest) => started(client.open(request));
export const openSample = () => started(client.openSample());

/** Uploads files into the project's folder; returns their paths there, in the same order. No file is ever replaced: if
 *  another file has one of the names, all of them go into a subfolder where none does, so that files that belong together
 *  stay together. */
export async function upload(files: File[], progress: (name: string) => void): Promise<string[] | undefined> {
  let taken = "";
  for (let folder = 1; folder <= most_folders; ++folder) {
    const paths: string[] = [];
    try {
      for (const file of files) {
        progress(file.name);
        paths.push((await client.upload(file.name, file, folder)).path);
      }
    } catch (e) {
      if (!(e instanceof Refused)) throw e;
      const exists = e.diagnostic.code === "server-exists";
      if (!exists || folder === most_folders) {
        showMessage(e.diagnostic);
        return undefined;
      }
      taken ||= files[paths.length]!.name;
      continue;
    }
    if (taken)
      warn(
        "upload-beside",
        `the project has another file named ${taken}; it was kept, and the new files are in the folder inputs/${folder}`,
      );
    return paths;
  }
  return undefined;
}
const most_folders = 100;

// ---- runs

export const startRun = (request: RunRequest) => started(client.start(request));
/** Imports models that mansard wrote as a run. */
export const openModel = (path: string) => started(client.importModel(path));
export const cancelJob = (job: string) => attempt(client.cancel(job));
export const renameRun = (run: string, label: string) => attempt(client.rename(run, label));

export async function deleteRun(run: string) {
  if ((await attempt(client.remove(run))) === undefined) return;
  if (state.run.value?.id === run) closeRun();
  if (state.other.value?.id === run) state.other.value = null;
}

const isLarge = (run: string) => (state.runSummary(run)?.buildings ?? 0) > mostAtOnce;

/** A run as it was before its edits. Buildings without edits are those of the open run. */
async function fetchUnedited(id: string): Promise<state.OpenRun | undefined> {
  const run = state.runOf(id);
  const answer = await attempt(client.unedited(run));
  const open = state.run.value;
  if (!answer || open?.id !== run) return undefined;
  const buildings = new Map(open.buildings);
  for (const b of answer.buildings) buildings.set(b.id, { ...open.buildings.get(b.id)!, ...b, edited: false });
  return { id, buildings, history: { edits: [], done: 0 } };
}

async function fetchRun(id: string): Promise<state.OpenRun | undefined> {
  if (state.isBefore(id)) return fetchUnedited(id);
  if (isLarge(id)) {
    const list = await attempt(client.list(id));
    return list && { id, buildings: new Map(), history: list.history, large: largeOf(list) };
  }
  const answer = await attempt(client.buildings(id));
  if (!answer) return undefined;
  return { id, buildings: new Map(answer.buildings.map((b) => [b.id, b])), history: answer.history };
}

export async function openRun(id: string, at: state.Selection | null = state.selection.value) {
  state.opening.value = id;
  const opened = await fetchRun(id);
  if (state.opening.value !== id) return; // another run was requested meanwhile
  batch(() => {
    state.opening.value = null;
    if (!opened) return;
    if (state.run.value?.id !== id) state.draft.value = null;
    const beside = state.other.value?.id;
    if (beside === id || (state.isBefore(beside) && beside !== state.beforeOf(id))) state.other.value = null;
    state.run.value = opened;
    state.selection.value = existing(opened, at);
    state.also.value = [];
  });
  if (opened?.history.done) measureAgain(id);
  if (opened?.large && state.selection.value) void needTiles(id, []);
  keepOpen();
}

function closeRun() {
  const closed = state.run.value?.id; // the project may still list it
  batch(() => {
    state.run.value = state.other.value = state.selection.value = state.draft.value = null;
    state.also.value = [];
  });
  const next = state.project.value?.runs.filter((r) => r.state === "done" && r.id !== closed).at(-1);
  if (next) void openRun(next.id);
}

/** Loads the models of these tiles of a large run, in this order. */
export async function needTiles(id: string, tiles: readonly string[]) {
  wantedTiles = tiles;
  if (loadingTiles) return;
  loadingTiles = true;
  try {
    for (;;) {
      const open = state.run.value;
      if (open?.id !== id || !open.large) return;
      const at = state.selection.value;
      const first = at && !open.buildings.has(at.building) ? tilesAround(open.large, at.building) : [];
      const next = [...first, ...wantedTiles].find((t) => !open.large!.loaded.has(t));
      if (next === undefined) return;
      const answer = await attempt(client.modelTile(id, next));
      if (!answer) return;
      addTile(id, next, answer.buildings);
    }
  } finally {
    loadingTiles = false;
  }
}
let wantedTiles: readonly string[] = [];
let loadingTiles = false;

/** Loads the models around a building of a large run. */
export async function needModelsOf(id: string, building: string) {
  const open = state.run.value;
  if (open?.id !== id || !open.large || open.buildings.has(building)) return;
  const [tile] = tilesAround(open.large, building);
  if (tile === undefined || open.large.loaded.has(tile)) return;
  const answer = await attempt(client.modelTile(id, tile));
  if (answer) addTile(id, tile, answer.buildings);
}

/** Adds the models of a tile; those of tiles that nobody looks at are forgotten when there are too many. */
function addTile(id: string, tile: string, models: readonly api.Building[]) {
  const open = state.run.value;
  if (open?.id !== id || !open.large) return;
  const { large } = open;
  const buildings = new Map(open.buildings);
  for (const building of models) {
    const known = buildings.get(building.id);
    if (!known || known.revision <= building.revision) buildings.set(building.id, building);
  }
  const loaded = new Set(large.loaded).add(tile);
  const drafted = state.draft.value?.changes.map((c) => c.building) ?? [];
  const needed = [state.selection.value?.building, ...drafted].flatMap((b) => (b ? tilesAround(large, b) : []));
  for (const old of loaded) {
    if (buildings.size <= mostLoaded) break;
    if (old === tile || wantedTiles.includes(old) || needed.includes(old)) continue;
    for (const i of large.tiles.get(old)!.buildings) buildings.delete(large.rows[i]!.id);
    loaded.delete(old);
  }
  batch(() => {
    state.run.value = { ...open, buildings, large: { ...large, loaded } };
    const at = state.selection.value;
    if (at && !at.part && models.some((b) => b.id === at.building)) select(at);
  });
}

export async function compareWith(id: string | null) {
  if (id && isLarge(id)) {
    warn("compare-large", "runs of more than 5,000 buildings cannot be shown side by side");
    return;
  }
  const opened = id ? await fetchRun(id) : null;
  if (opened === undefined) return;
  state.other.value = opened;
  if (opened?.history.done) measureAgain(opened.id);
  keepOpen();
}

/** Fetches the layers of the segmentation, once per run. */
export async function needLayers(run: string) {
  if (state.segmentations.value.has(run) || requested.has(`layers ${run}`)) return;
  requested.add(`layers ${run}`);
  const answer = await attempt(client.layers(run));
  if (answer) state.segmentations.value = new Map(state.segmentations.value).set(run, answer);
}

/** Fetches the error maps of all blocks, once per run and again after edits. */
export async function needErrorMaps(run: string) {
  if (!state.outdatedMaps.value.has(run) && (state.errorMaps.value.has(run) || requested.has(`error ${run}`))) return;
  requested.add(`error ${run}`);
  const edit = editNumber(run);
  const answer = await attempt(client.errorMaps(run));
  if (!answer) return;
  const cells = await attempt(Promise.all(answer.maps.map((map) => client.errorMap(run, map.block))));
  if (!cells) return;
  if (edit !== editNumber(run)) return; // another edit was made meanwhile; it asks again
  const maps = answer.maps.map((map, i) => ({ ...map, cells: cells[i]! }));
  const outdated = new Set(state.outdatedMaps.value);
  outdated.delete(run);
  state.outdatedMaps.value = outdated;
  state.errorMaps.value = new Map(state.errorMaps.value).set(run, maps);
}
const requested = new Set<string>();

/** Fetches the attributes of the buildings, once per run and again after edits. */
export async function needAttributes(run: string) {
  const outdated = state.outdatedAttributes.value.has(run);
  if (!outdated && (state.attributes.value.has(run) || requested.has(`attributes ${run}`))) return;
  requested.add(`attributes ${run}`);
  const edit = editNumber(run);
  const table = await attempt(client.attributes(run));
  if (!table || edit !== editNumber(run)) return; // another edit was made meanwhile; it asks again
  batch(() => {
    const rest = new Set(state.outdatedAttributes.value);
    rest.delete(run);
    state.outdatedAttributes.value = rest;
    state.attributes.value = new Map(state.attributes.value).set(run, table);
  });
}

/** Fetches one attribute of all buildings of a large run. */
export async function needColumn(run: string, name: string) {
  const key = `${run} ${name}`;
  if (state.columns.value.has(key) || requested.has(`column ${key}`)) return;
  requested.add(`column ${key}`);
  const edit = editNumber(run);
  const column = await attempt(client.column(run, name));
  requested.delete(`column ${key}`);
  if (column && edit === editNumber(run)) state.columns.value = new Map(state.columns.value).set(key, column);
}
/** What the page has of them is older than the server's. */
export function forgetColumns(run: string) {
  state.columns.value = new Map([...state.columns.value].filter(([key]) => !key.startsWith(`${run} `)));
}

/** Fetches the solids of a lower level of detail. Those of edited runs are fetched again after an edit. */
export async function needLevel(run: string, lod: string) {
  const key = `${run} ${lod}`;
  if (state.levels.value.has(key) || requested.has(`level ${key}`)) return;
  requested.add(`level ${key}`);
  const edit = editNumber(run);
  const level = await attempt(client.level(run, lod));
  requested.delete(`level ${key}`);
  if (level && edit === editNumber(run)) state.levels.value = new Map(state.levels.value).set(key, level);
}

/** Fetches the terrain around the models; false if it cannot be made. That of an edited run is fetched again after an edit. */
export async function needTerrain(run: string): Promise<boolean> {
  if (state.terrains.value.has(run) || requested.has(`terrain ${run}`)) return true;
  requested.add(`terrain ${run}`);
  const edit = editNumber(run);
  const bytes = await attempt(client.terrain(run));
  requested.delete(`terrain ${run}`);
  if (bytes && edit === editNumber(run)) state.terrains.value = new Map(state.terrains.value).set(run, bytes);
  return bytes !== undefined;
}

/** Fetches the basemap in the frame of a run; false if the server has none. */
export async function needBasemap(run: string): Promise<boolean> {
  if (state.basemaps.value.has(run) || requested.has(`basemap ${run}`)) return true;
  requested.add(`basemap ${run}`);
  const bytes = await attempt(client.basemap(run));
  requested.delete(`basemap ${run}`);
  if (bytes) state.basemaps.value = new Map(state.basemaps.value).set(run, bytes);
  return bytes !== undefined;
}

/** Shows models of any program beside those of the run. */
export async function openOther(path: string) {
  const model = await attempt(client.otherModel(path));
  if (!model) return false;
  for (const warning of model.warnings.slice(0, most_messages - 1)) showMessage(warning);
  const name = path.split("/").at(-1) ?? path;
  state.others.value = [...state.others.value.filter((o) => o.name !== name), { name, model }];
  showSuccess("models-opened", `${name}: ${model.buildings.length} ${model.buildings.length === 1 ? "building" : "buildings"} shown beside the run`);
  return true;
}
export const closeOther = (name: string) => (state.others.value = state.others.value.filter((o) => o.name !== name));

// ---- what follows from edits

/** Time without edits after which a run is measured again, ms: while somebody types, every step is an edit. */
const measure_after = 600;
const edits = new Map<string, number>(); // edits of each run that this page has received
const editNumber = (run: string) => edits.get(run) ?? 0;
const measuring = new Map<string, ReturnType<typeof setTimeout>>();

/** Marks scores and error maps of a run as outdated, and fetches the scores, and the maps if they are loaded. */
function measureAgain(run: string) {
  edits.set(run, editNumber(run) + 1);
  clearTimeout(measuring.get(run));
  batch(() => {
    const scores = new Map(state.scoresNow.value);
    scores.delete(run);
    state.scoresNow.value = scores;
    if (state.attributes.value.has(run)) state.outdatedAttributes.value = new Set(state.outdatedAttributes.value).add(run);
    forgetColumns(run);
    state.levels.value = new Map([...state.levels.value].filter(([key]) => !key.startsWith(`${run} `)));
    state.terrains.value = new Map([...state.terrains.value].filter(([id]) => id !== run));
    if (state.errorMaps.value.has(run)) state.outdatedMaps.value = new Set(state.outdatedMaps.value).add(run);
  });
  measuring.set(run, setTimeout(() => void measure(run), measure_after));
}

async function measure(run: string) {
  const edit = editNumber(run);
  if (state.outdatedAttributes.value.has(run)) void needAttributes(run);
  // Without a scene nothing can be measured: the numbers stay marked, and are measured when it has been read.
  if (!state.runSummary(run)?.scores || !state.sceneRead.value) return;
  const scores = await client.scores(run).catch((e: unknown) => {
    if (e instanceof Refused) return null; // the scene is being read again
    throw e;
  });
  if (!scores || edit !== editNumber(run)) return;
  state.scoresNow.value = new Map(state.scoresNow.value).set(run, scores);
  if (state.outdatedMaps.value.has(run)) await needErrorMaps(run);
}

// ---- selection

function existing(run: state.OpenRun, at: state.Selection | null): state.Selection | null {
  const building = at && run.buildings.get(at.building);
  if (!building) return at && run.large?.index.has(at.building) ? { building: at.building, part: null, ring: 0, edge: null } : null;
  const part = building.parts.find((p) => p.id === at.part) ?? (at.part ? building.parts[0] : undefined);
  if (!part) return { building: building.id, part: null, ring: 0, edge: null };
  const ring = at.ring === 0 ? part.plan.outer : part.plan.holes[at.ring - 1];
  const whole = ring !== undefined && at.edge !== null && at.edge < ring.points.length;
  return { building: building.id, part: part.id, ring: whole ? at.ring : 0, edge: whole ? at.edge : null };
}

/** Sets or clears the selection. For a building without a part, its first part is selected. */
export function select(at: state.Selection | null) {
  batch(() => {
    const part = at && (at.part ?? state.run.value?.buildings.get(at.building)?.parts[0]?.id ?? null);
    state.selection.value = at && { ...at, part };
    state.also.value = [];
  });
  const open = state.run.value;
  if (at && open?.large && !open.buildings.has(at.building)) void needTiles(open.id, wantedTiles);
  keepOpen();
}

/** Adds a part to those to merge, or removes it. */
export function selectAlso(building: string, part: string) {
  const at = state.selection.value;
  if (!at?.part) return select({ building, part, ring: 0, edge: null });
  if (at.building === building && at.part === part) return;
  const rest = state.also.value.filter((p) => p.building !== building || p.part !== part);
  state.also.value = rest.length < state.also.value.length ? rest : [...rest, { building, part }];
}

let requests = 0;
export const fly = (to: state.Flight) => (state.flight.value = { to, at: ++requests });

/** Selects the building `step` rows further down in the table, as it is sorted and filtered. */
export function selectNext(step: number) {
  const all = () => state.run.value?.large?.index.keys() ?? state.run.value?.buildings.keys() ?? [];
  const ids = state.order.value.length ? state.order.value : [...all()];
  if (!ids.length) return;
  const now = ids.indexOf(state.selection.value?.building ?? "");
  const next = now < 0 ? (step > 0 ? 0 : ids.length - 1) : (now + step + ids.length) % ids.length;
  select({ building: ids[next]!, part: null, ring: 0, edge: null });
  fly("selection");
}

// ---- edits

/** Updates the open runs with buildings from the server. Revisions older than the present ones are ignored. */
export function take(run: string, answer: api.Applied) {
  for (const opened of [state.run, state.other]) {
    if (opened.value?.id !== run) continue;
    const buildings = new Map(opened.value.buildings);
    for (const building of answer.buildings) {
      const known = buildings.get(building.id);
      if (opened.value.large && !known) continue; // it is not near the camera
      if (!known || known.revision <= building.revision) buildings.set(building.id, building);
    }
    const large = opened.value.large && withRows(opened.value.large, answer.buildings);
    opened.value = { ...opened.value, buildings, history: answer.history, ...(large && { large }) };
  }
  measureAgain(run);
  if (state.run.value?.id === run) for (const listener of reviewListeners) listener(answer.buildings.map((b) => b.id));
  if (state.run.value?.id === run) state.selection.value = existing(state.run.value, state.selection.value);
}

/** Called with the buildings that changed, whose decisions may have lapsed; with null where decisions were made elsewhere. */
export const onReview = (listener: (buildings: string[] | null) => void) => void reviewListeners.push(listener);
const reviewListeners: ((buildings: string[] | null) => void)[] = [];

/** The list of a large run with these buildings as they are now. */
function withRows(large: Large, changed: readonly api.Building[]): Large {
  const rows = large.rows.slice();
  for (const building of changed) {
    const at = large.index.get(building.id);
    if (at !== undefined) rows[at] = rowOf(building);
  }
  return { ...large, rows };
}

export const undo = () => step("undo");
export const redo = () => step("redo");

/** An unsaved draft is the latest change: undo discards it first. */
async function step(which: "undo" | "redo") {
  const open = state.run.value;
  if (!open) return;
  if (state.draft.value && which === "undo") {
    state.draft.value = null;
    return;
  }
  const { edits, done } = open.history;
  if (which === "undo" ? done === 0 : done === edits.length) return;
  const answer = await attempt(client[which](open.id));
  if (!answer) return;
  take(open.id, answer);
  // What it said of the edit is not so any more.
  const ofEdits = ["edit-dormers", "edit-dormer-moved", "edit-error", "edit-several"];
  state.messages.value = state.messages.value.filter((m) => !ofEdits.includes(m.code));
}

/** Applies the edits of another run to this one, and says which buildings they do not fit any more. */
export async function carryOver(run: string, from: string) {
  const answer = await attempt(client.carryOver(run, from));
  if (!answer) return;
  if (state.run.value?.id === run) await openRun(run); // this page gets no events of its own edits
  const { carried, refused } = answer;
  for (const why of refused.slice(0, most_messages - 1)) showMessage({ ...why, severity: "warning" });
  const not = refused.length ? `; ${refused.length} did not fit: ${refused.map((r) => r.subject).join("; ")}` : "";
  const done = `edits of ${carried.length} ${carried.length === 1 ? "building" : "buildings"} carried over${not}`;
  if (refused.length) warn("edits-carried", done);
  else showSuccess("edits-carried", done);
}

/** Offers bytes as a file. */
export function offer(bytes: Blob, name: string) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(bytes);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Downloads one export file of the edited run. Files that name each other come together, in a ZIP: the browser may rename
 *  single files. */
export async function download(run: string, file: string) {
  const bytes = await attempt(client.exported(run, file));
  if (!bytes) return;
  offer(new Blob([bytes]), `${run}-${file}`);
}

/** Exports all formats into the project's folder. Existing files are replaced only if `agreed` returns true. */
export async function exportAll(run: string, agreed: () => boolean) {
  let call = client.exportAll(run, false);
  try {
    await call;
  } catch (e) {
    if (e instanceof Refused && e.status === 409) {
      if (!agreed()) return;
      call = client.exportAll(run, true);
    }
  }
  const answer = await attempt(call);
  if (!answer) return;
  for (const warning of answer.warnings) showMessage(warning);
  showSuccess("exported", `${answer.files.length} files written to ${answer.folder}`);
}

// ---- events

async function started(call: Promise<api.Job>) {
  const job = await attempt(call);
  if (!job) return undefined;
  mine.add(job.id);
  const known = state.jobs.value.find((j) => j.id === job.id); // its events came before this answer
  if (known?.state === "done" && known.run) void openRun(known.run);
  else if (!known) receiveJob(job);
  return job;
}
const mine = new Set<string>(); // jobs that this tab started
const ended = (job: api.Job) => job.state !== "queued" && job.state !== "running";

function receiveJob(job: api.Job) {
  const known = state.jobs.value.find((j) => j.id === job.id);
  if (known && ended(known)) return; // an event was faster than this answer
  state.jobs.value = known ? state.jobs.value.map((j) => (j.id === job.id ? job : j)) : [...state.jobs.value, job];
  if (job.failure && job.state === "failed") showMessage(job.failure);
  if (job.kind === "read" && (job.state === "done" || (ended(job) && state.scene.value))) void loadScene();
  if (job.state !== "done") return;
  if (job.kind === "run" && job.run && (mine.has(job.id) || !state.run.value)) void openRun(job.run);
}

export function received(event: api.Event) {
  if (event.type === "job") receiveJob(event.job);
  else if (event.type === "project") {
    state.project.value = told = event.project;
    if (!event.project.inputs) state.scene.value = state.tiles.value = null;
    const gone = (open: state.OpenRun | null) => open && !event.project.runs.some((r) => r.id === state.runOf(open.id));
    if (gone(state.other.value)) state.other.value = null;
    if (gone(state.run.value)) closeRun();
  } else if (event.type === "review") {
    if (event.client !== client.id) for (const listener of reviewListeners) listener(null);
  } else if (event.type === "buildings" && event.client !== client.id) {
    const stale = state.draft.value?.changes.some((c) => event.buildings.some((b) => b.id === c.building));
    take(event.run, event);
    if (stale && state.run.value?.id === event.run) {
      state.draft.value = null;
      warn(
        "edit-stale",
        "another page changed this building; it is shown in its new state, and your unsaved change was discarded",
      );
    }
  }
}
