// Reviewing the buildings of the open run one after the other: decisions, the queue, and what is loaded ahead of need.
import { batch, computed, effect, signal } from "@preact/signals";
import { attempt, client, fly, forgetColumns, needModelsOf, onReview, select, showMessage, showSuccess, warn } from "../actions";
import { Refused } from "../api/client";
import type * as api from "../api/types";
import { session } from "../edit/here";
import { keep, kept } from "../keep";
import { rowOf, sorted } from "../panels/table";
import { count } from "../panels/words";
import * as state from "../state";
import { viewer } from "../view/current";
import { beginCase } from "./pace";
import { nextOpen, worstFirst } from "./queue";

/** The decisions on the buildings of the open run, by id; of which run they are. */
const loaded = signal<{ run: string; decisions: ReadonlyMap<string, api.ReviewDecision> } | null>(null);
const none: ReadonlyMap<string, api.ReviewDecision> = new Map();
export const decisions = computed(() => (loaded.value?.run === state.run.value?.id ? loaded.value!.decisions : none));
export const reviewer = signal("");

export type Order = "worst" | "list" | "view";
export const order = signal<Order>(kept<Order>("local", "review order", "worst"));
/** Ids in the order in which they are reviewed. It stays as it is while buildings are decided and edited. */
export const queue = signal<readonly string[]>([]);
export const current = computed(() => {
  const id = state.selection.value?.building;
  return id !== undefined && queue.value.includes(id) ? id : null;
});
/** Notes that belong to no decision yet, by building. */
export const notes = signal<ReadonlyMap<string, string>>(new Map());
export const noteOf = (id: string) => notes.value.get(id) ?? decisions.value.get(id)?.note ?? "";

// ---- the queue

/** Puts the buildings of the open run in their order: to be called when the panel is opened or another order is chosen. */
export function gather() {
  const run = state.run.peek();
  if (!run) {
    queue.value = [];
    return;
  }
  const rows = sorted(run.large?.rows ?? [...run.buildings.values()].map(rowOf), { column: "id", down: false });
  if (order.peek() === "list") queue.value = state.order.peek().length ? [...state.order.peek()] : rows.map((r) => r.id);
  else {
    const seen = viewer.peek();
    const worst = worstFirst(rows);
    queue.value = order.peek() === "view" && seen ? worst.filter((id) => seen.sees(id)) : worst;
  }
}
export function setOrder(to: Order) {
  order.value = to;
  keep("local", "review order", to);
  gather();
  const first = nextOpen(queue.value, decisions.value, null)[0];
  if (first !== undefined && !current.value) show(first);
}

/** The panel was opened, or another run: the selected building is the first case; without one, the worst open one. */
export async function begin() {
  gather();
  await load();
  if (state.tab.value === "review" && !current.value) go(nextOpen(queue.value, decisions.value, null)[0]);
  else if (current.value) show(current.value);
}

/** Shows a building: the camera is there at once. */
export function show(id: string, since = performance.now()) {
  beginCase(since);
  batch(() => {
    select({ building: id, part: null, ring: 0, edge: null });
    fly("case");
  });
  void ahead();
}
const go = (id: string | undefined, since?: number) => {
  if (id !== undefined) show(id, since);
};

/** The case that is `by` further in the queue, decided or not. */
export function step(by: 1 | -1, since?: number) {
  const at = queue.value.indexOf(current.value ?? "");
  const ids = queue.value;
  if (ids.length) go(ids[at < 0 ? (by > 0 ? 0 : ids.length - 1) : (at + by + ids.length) % ids.length], since);
}

// ---- decisions

export async function load() {
  const run = state.run.peek()?.id;
  if (!run) return;
  const answer = await attempt(client.review(run));
  if (!answer || state.run.peek()?.id !== run) return;
  reviewer.value = answer.reviewer;
  loaded.value = { run, decisions: new Map(answer.decisions.map((d) => [d.building, d])) };
}

/** Sets what is shown, before the server has answered. */
function put(id: string, decision: api.ReviewDecision | null) {
  const run = state.run.value!.id;
  const all = new Map(decisions.value);
  if (decision) all.set(id, decision);
  else all.delete(id);
  loaded.value = { run, decisions: all };
  attributesChanged(run);
}

/** Decides about the present case, and goes to the next one that is open. */
export function decide(verdict: api.Verdict, since?: number) {
  const id = current.value;
  const building = id !== null && state.run.value?.buildings.get(id);
  if (!id || !building) return;
  if (state.draft.value?.changes.some((c) => c.building === id)) {
    warn("review-draft", "this building has a change that is not saved; save it or discard it first", id);
    return;
  }
  const note = noteOf(id).trim();
  put(id, { building: id, decision: verdict, note, reviewer: reviewer.value, time: new Date().toISOString(), lapsed: false });
  const next = nextOpen(queue.value, decisions.value, id)[0];
  void send({ building: id, revision: building.revision, decision: verdict, note });
  if (next === undefined) showSuccess("review-end", "every building of this order is decided");
  else go(next, since);
}

export function takeBack() {
  const id = current.value;
  const building = id !== null && state.run.value?.buildings.get(id);
  if (!id || !building || !decisions.value.has(id)) return;
  put(id, null);
  void send({ building: id, revision: building.revision, decision: null });
}

/** Sets the note of a case; one that is decided is decided again with it. */
export function setNote(id: string, text: string) {
  notes.value = new Map(notes.value).set(id, text);
}
export function keepNote(id: string) {
  const known = decisions.value.get(id);
  const building = state.run.value?.buildings.get(id);
  const note = noteOf(id).trim();
  if (!known || known.lapsed || !building || known.note === note) return;
  put(id, { ...known, note });
  void send({ building: id, revision: building.revision, decision: known.decision, note });
}

async function send(request: api.ReviewRequest) {
  const run = state.run.value!.id;
  try {
    const { decided } = await client.decide(run, request);
    const rest = new Map(notes.value);
    if (decided && rest.get(request.building)?.trim() === decided.note) rest.delete(request.building);
    notes.value = rest;
    if (state.run.value?.id === run) put(request.building, decided);
  } catch (e) {
    if (!(e instanceof Refused)) throw e;
    showMessage(e.diagnostic);
    await load(); // what is shown was not kept
  }
}

/** Attributes that the page has of the run lack the decision. */
function attributesChanged(run: string) {
  forgetColumns(run);
  if (state.attributes.value.has(run)) state.outdatedAttributes.value = new Set(state.outdatedAttributes.value).add(run);
}

export async function merge(file: File) {
  let review: unknown;
  try {
    review = JSON.parse(await file.text());
  } catch {
    warn("review-file", `${file.name} is not valid JSON; choose review.json of another project`, file.name);
    return;
  }
  const answer = await attempt(client.mergeReview(review as api.ReviewFile));
  if (!answer) return;
  await load();
  for (const { kept: one, dropped } of answer.conflicts.slice(0, 3))
    warn(
      "review-conflict",
      `${one.decision} by ${one.reviewer || "somebody"} is kept, ${dropped.decision} by ${dropped.reviewer || "somebody"} was earlier`,
      one.building,
    );
  const more = answer.conflicts.length > 3 ? `; ${count(answer.conflicts.length, "building")} were decided in two ways` : "";
  showSuccess("review-merged", `${count(answer.added, "decision")} added, ${answer.replaced} replaced by later ones${more}`);
}

// ---- cases

const cases = signal<ReadonlyMap<string, api.ReviewCase>>(new Map());
const mostCases = 50;
const asking = new Set<string>();
const keyOf = (run: string, b: api.Building) => `${run} ${b.id} ${b.revision}`;

/** What the server said of a building as it is now; undefined until it has. */
export const shownCase = computed(() => {
  const run = state.run.value;
  const building = current.value === null ? undefined : run?.buildings.get(current.value);
  return run && building ? cases.value.get(keyOf(run.id, building)) : undefined;
});

async function needCase(run: string, building: api.Building) {
  const key = keyOf(run, building);
  if (cases.value.has(key) || asking.has(key)) return;
  asking.add(key);
  const answer = await attempt(client.reviewCase(run, building.id));
  asking.delete(key);
  if (!answer || answer.revision !== building.revision) return;
  const all = new Map(cases.value).set(key, answer);
  for (const old of all.keys()) {
    if (all.size <= mostCases) break;
    all.delete(old);
  }
  cases.value = all;
}

const loadedAhead = 3;
let runningAhead = false;
/** Loads the present case, then the next ones, one after the other: the server has other work. */
async function ahead() {
  if (runningAhead) return;
  runningAhead = true;
  try {
    for (let done = false; !done; ) {
      done = true;
      const run = state.run.peek();
      const id = current.peek();
      if (!run || id === null || state.tab.peek() !== "review") return;
      for (const next of [id, ...nextOpen(queue.peek(), decisions.peek(), id, loadedAhead)]) {
        if (!run.buildings.has(next)) {
          await needModelsOf(run.id, next);
          if (!state.run.peek()?.buildings.has(next)) continue;
        }
        const building = state.run.peek()!.buildings.get(next)!;
        const key = keyOf(run.id, building);
        if (cases.peek().has(key) || asking.has(key) || !state.sceneRead.peek()) continue;
        await needCase(run.id, building);
        if (cases.peek().has(key)) done = false; // the case may be another one by now: from the beginning
        break;
      }
    }
  } finally {
    runningAhead = false;
  }
}

/** Takes one of the other models: an edit, which can be undone. */
export function takeModel(number: number) {
  const run = state.run.value;
  const offered = shownCase.value;
  const one = offered?.alternatives[number - 1];
  if (!run || !offered || !one) return;
  session.propose(`${one.what} of ${offered.building}`, [{ building: offered.building, parts: one.parts }]);
}

export function openEditor() {
  if (current.value !== null) state.tab.value = "edit";
}

// ---- what follows from elsewhere

let wasOpen = false;
let lastRun: string | null = null;
effect(() => {
  const open = state.tab.value === "review";
  const run = state.run.value?.id ?? null;
  if (open && run && (!wasOpen || run !== lastRun)) queueMicrotask(() => void begin());
  wasOpen = open;
  lastRun = run;
});
// The case was edited, or the scan has been read meanwhile.
effect(() => {
  const id = current.value;
  void (id !== null && state.run.value?.buildings.get(id)?.revision);
  void state.sceneRead.value;
  if (state.tab.value === "review" && id !== null) queueMicrotask(() => void ahead());
});
// A changed building makes its decision lapse, or hold again.
onReview((buildings) => {
  if (!loaded.value) return;
  if (buildings === null || buildings.some((id) => decisions.value.has(id))) void load();
});
