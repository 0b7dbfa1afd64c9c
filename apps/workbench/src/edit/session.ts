// A draft: changed plans are previewed while dragging, saved on release if they are valid, and held back if not. A proposal is a
// draft that is only saved when it is kept. The page and the calls of the server are passed in. There is one preview at a time;
// then the newest plans are next.
import { signal } from "@preact/signals";
import type * as api from "../api/types";
import type { Draft, OpenRun } from "../state";
import { Refused } from "../api/client";
import { planFault } from "./check";
import { clean, oriented } from "./plan";

export interface Calls {
  preview(run: string, changes: api.Change[], signal?: AbortSignal): Promise<{ buildings: api.RaisedBuilding[] }>;
  edit(run: string, edit: api.Edit): Promise<api.Applied>;
  undo(run: string): Promise<api.Applied>;
  buildings(run: string): Promise<{ buildings: api.Building[]; history: api.History }>;
  building(run: string, id: string): Promise<{ buildings: api.Building[]; history: api.History }>;
}

/** An unsaved draft, kept across reloads. */
export interface Kept {
  run: string;
  what: string;
  changes: api.Change[];
}

interface Cell<T> {
  value: T;
  subscribe(listener: (value: T) => void): () => void;
}
export interface Desk {
  run: Cell<OpenRun | null>;
  draft: Cell<Draft | null>;
  take(run: string, answer: api.Applied): void;
  showMessage(diagnostic: api.Diagnostic): void;
  keep(draft: Kept | null): void;
  kept(): Kept | null;
  /** The geometry of a change has arrived; `pointer` is the time of the event that requested it. */
  shown(pointer: number): void;
}

/** changing: the pointer is down. offered: a proposal is shown. checking: released, waiting for the preview. saving: sent. held: not saved, see `reason`. */
export type Phase = "idle" | "changing" | "offered" | "checking" | "saving" | "held";

export interface Parts {
  building: string;
  parts: api.NamedPlan[];
  lost?: string[]; // parts that the change removes, which is said when it is released
}

const warning = (code: string, message: string, subject = ""): api.Diagnostic => ({
  severity: "warning",
  code,
  message,
  subject,
});

export class EditSession {
  readonly phase = signal<Phase>("idle");
  /** Why the draft is not saved, or why the last preview failed. */
  readonly reason = signal<api.Diagnostic | null>(null);

  /** Number of cancelled changes: editors then clear their hints. */
  readonly cancelled = signal(0);

  private version = 0; // of the plans of the draft
  private answered = 0; // the version of `raised`
  private asking: AbortController | null = null;
  private released = false; // to be saved as soon as it is known to be valid
  private open = false; // a gesture is in progress
  private sure = false; // to be saved although it is above the scan
  private before: Draft | null = null; // the draft before the gesture
  private wasReleased = false; // that draft was about to be saved
  private pointer = 0;
  private touched = new Set<string>(); // buildings changed since the last edit was sent
  private writing: { run: string; undo: boolean } | null = null;
  private putting = false;
  private taking = false; // of the answer to an edit of this session
  private lost: string[] = []; // parts that the gesture removes
  private offer: { what: string; before: Draft | null } | null = null; // the proposal that is shown
  private interrupted: { what: string; before: Draft | null } | null = null; // that a gesture builds on

  constructor(
    private readonly calls: Calls,
    private readonly desk: Desk,
  ) {
    let had = desk.draft.value;
    desk.draft.subscribe((draft) => {
      if (had && !draft && !this.putting) this.dropped();
      had = draft;
    });
    // A redo, or another edit of the same building: what is shown was made for another state of it.
    desk.run.subscribe((run) => {
      const changes = this.offer && !this.taking && desk.draft.value?.changes;
      if (changes && changes.some((c) => run?.buildings.get(c.building)?.revision !== c.revision)) this.cancel();
    });
  }

  /** Whether a gesture is in progress. It also ends when the draft is discarded. */
  get active() {
    return this.open;
  }

  /** Whether a proposal is shown. */
  get offered() {
    return this.offer !== null;
  }

  /** The parts of a building without the proposal that is shown. */
  partsBefore(building: string): api.NamedPlan[] {
    const draft = this.offer ? this.offer.before : this.desk.draft.value;
    const drafted = draft?.changes.find((c) => c.building === building)?.parts;
    return drafted ?? this.desk.run.value?.buildings.get(building)?.parts ?? [];
  }

  /** Shows a complete change without saving it, in place of the proposal before it. False where begin() is. */
  offerTo(what: string, changes: Parts[]): boolean {
    if (this.open && !this.offer) return false; // something is being dragged
    const shown = this.desk.draft.value?.raised;
    if (this.offer) {
      this.open = false;
      this.stopAsking();
      this.put(this.offer.before);
      this.offer = null;
    }
    if (!this.begin(changes.map((c) => c.building))) {
      this.settle();
      return false;
    }
    // What is drawn stays until the new preview is there.
    const draft = this.desk.draft.value;
    const raised = new Map(draft?.raised);
    for (const { building } of changes) if (shown?.has(building)) raised.set(building, shown.get(building)!);
    this.offer = { what, before: this.before };
    this.reason.value = null;
    this.change(what, changes, 0, raised);
    return true;
  }

  /** Saves the proposal that is shown. What its preview says of the scan is an answer to the question whether to save it. */
  keepOffer(): boolean {
    const draft = this.desk.draft.value;
    if (!this.offer || !draft) return false;
    this.offer = null;
    this.sure = this.answered === this.version && !draft.invalid;
    this.commit();
    return true;
  }

  /** Takes the proposal back that is shown. */
  discardOffer() {
    if (this.offer) this.cancel();
  }

  /** What the preview of the draft says that is worse for the scan. */
  get doubts(): api.Diagnostic[] {
    const draft = this.desk.draft.value;
    return draft && !draft.pending ? doubtsOf(draft) : [];
  }

  /** Starts a gesture on some buildings. False, with a message, while there is an unsaved draft of other buildings. A gesture on
   *  a building with a proposal builds on it; a proposal for others is discarded. */
  begin(buildings: string[]): boolean {
    if (!this.desk.run.value) return false;
    if (this.offer) {
      if (this.desk.draft.value?.changes.some((c) => buildings.includes(c.building))) {
        this.interrupted = this.offer;
        this.offer = null;
        this.open = false;
      } else this.cancel();
    }
    const draft = this.desk.draft.value;
    if (this.open) return true;
    if (draft && !this.interrupted && !this.writing && !draft.changes.some((c) => buildings.includes(c.building))) {
      const held = draft.changes.map((c) => c.building).join(", ");
      this.desk.showMessage(
        warning("edit-held", `the change of ${held} is not saved yet; correct it, or discard it with Esc`, held),
      );
      return false;
    }
    this.open = true;
    this.wasReleased = this.released;
    this.released = false;
    this.before = draft;
    return true;
  }

  /** Sets the new parts: all parts of each changed building. `pointer` is the time of the event, ms. */
  change(what: string, changes: Parts[], pointer = 0, raised = this.desk.draft.value?.raised) {
    const run = this.desk.run.value;
    if (!this.open || !run) return;
    const draft = this.desk.draft.value;
    const named = changes.map(({ building, parts }): api.Change => {
      const known = draft?.changes.find((c) => c.building === building);
      return { building, parts, revision: known?.revision ?? run.buildings.get(building)?.revision ?? 0 };
    });
    const others = draft?.changes.filter((c) => !changes.some((n) => n.building === c.building)) ?? [];
    for (const { building } of changes) this.touched.add(building);
    this.sure = false;
    this.lost = changes.flatMap((c) => c.lost ?? []);
    ++this.version;
    this.pointer = pointer;
    this.put({
      what: this.interrupted ? `${this.interrupted.what}, ${what}` : what,
      changes: [...others, ...named],
      raised: raised ?? new Map(),
      pending: true,
      invalid: draft?.invalid ?? false,
    });
    this.phase.value = this.offer ? "offered" : "changing";
    this.pump();
  }

  /** Ends the gesture: valid plans are saved, others are held. */
  commit() {
    if (!this.open || this.offer) return;
    this.open = false;
    const draft = this.desk.draft.value;
    if (!draft || draft.changes === this.before?.changes) {
      this.settle();
      return;
    }
    this.interrupted = null;
    if (this.unchanged(draft)) {
      this.drop();
      return;
    }
    this.put({
      ...draft,
      changes: draft.changes.map((c) => ({
        ...c,
        parts: c.parts.map((p) => ({ id: p.id, plan: clean(oriented(p.plan)) })),
      })),
    });
    if (this.lost.length) this.desk.showMessage(noSlope(this.lost));
    this.released = true;
    this.phase.value = "checking";
    this.pump();
  }

  /** Reverts the gesture; without one, discards the draft. False if there was neither. */
  cancel(): boolean {
    if (this.open || (this.desk.draft.value && !this.writing)) ++this.cancelled.value;
    if (this.open) {
      this.open = false;
      this.offer = null;
      this.stopAsking();
      ++this.version;
      this.put(this.before && { ...this.before, pending: true });
      this.settle();
      return true;
    }
    if (!this.desk.draft.value || this.writing) return false;
    this.drop();
    return true;
  }

  /** Tries again to save a held draft. */
  again() {
    if (this.open || this.writing || !this.desk.draft.value) return;
    this.released = true;
    this.sure = true;
    this.phase.value = "checking";
    this.pump();
  }

  /** A complete change: typed, split or merged. */
  propose(what: string, changes: Parts[], pointer = 0): boolean {
    if (!this.begin(changes.map((c) => c.building))) return false;
    this.change(what, changes, pointer);
    this.commit();
    return true;
  }

  /** Restores an unsaved draft after a reload; to be called when a run has been opened. */
  restore() {
    const run = this.desk.run.value;
    const kept = this.desk.kept();
    if (!run || !kept || kept.run !== run.id || this.desk.draft.value) return;
    const draft: Draft = { what: kept.what, changes: kept.changes, raised: new Map(), pending: true, invalid: false };
    if (this.unchanged(draft)) {
      this.desk.keep(null); // it had been saved
      return;
    }
    if (kept.changes.some((c) => run.buildings.get(c.building)?.revision !== c.revision)) {
      this.desk.keep(null);
      this.desk.showMessage(stale(kept.changes));
      return;
    }
    ++this.version;
    this.put(draft);
    this.phase.value = "held";
    this.pump();
  }

  private pump() {
    const draft = this.desk.draft.value;
    const run = this.desk.run.value;
    if (!draft || !run || this.asking) return;
    if (this.answered !== this.version) {
      void this.ask(run.id, draft);
      return;
    }
    if (this.open || this.writing) return;
    const doubts = doubtsOf(draft);
    const question = this.sure ? undefined : doubts.find((d) => d.code === "edit-above");
    if (!this.released || draft.invalid || question) {
      this.hold(draft, question && { ...question, message: `${question.message}; save it all the same, or discard it` });
      return;
    }
    for (const doubt of doubts) if (doubt.code !== "edit-above") this.desk.showMessage(doubt);
    void this.write(run.id, draft);
  }

  private async ask(run: string, draft: Draft) {
    const version = this.version;
    const pointer = this.pointer;
    const refused = this.refusedHere(draft);
    if (refused) {
      this.answer(version, refused);
      return;
    }
    const asking = new AbortController();
    this.asking = asking;
    let raised: api.RaisedBuilding[];
    try {
      raised = (await this.calls.preview(run, draft.changes, asking.signal)).buildings;
    } catch (e) {
      if (this.asking !== asking) return; // discarded meanwhile
      this.asking = null;
      this.failed(e, version);
      return;
    }
    if (this.asking !== asking) return;
    this.asking = null;
    this.desk.shown(pointer);
    this.answer(version, raised);
  }

  private answer(version: number, raised: api.RaisedBuilding[]) {
    const draft = this.desk.draft.value;
    if (!draft) return;
    this.answered = version;
    const all = new Map(draft.raised);
    for (const building of raised) all.set(building.id, building);
    const invalid = raised.some((b) => !b.valid);
    this.reason.value = invalid ? firstError(raised) : null;
    this.put({ ...draft, raised: all, invalid, pending: version !== this.version });
    this.pump();
  }

  private failed(e: unknown, version: number) {
    const diagnostic = diagnosticOf(e);
    this.reason.value = diagnostic;
    // Newer plans are tried at once; the same plans are only sent again on request.
    if (version !== this.version) {
      this.pump();
      return;
    }
    const draft = this.desk.draft.value;
    if (draft) this.put({ ...draft, pending: false });
    if (!this.open && draft) this.hold(draft, diagnostic);
  }

  /** Faults that are found without the server; the previous geometry stays. */
  private refusedHere(draft: Draft): api.RaisedBuilding[] | null {
    const found: api.RaisedBuilding[] = [];
    let any = false;
    for (const change of draft.changes) {
      const last = draft.raised.get(change.building) ?? this.desk.run.value?.buildings.get(change.building);
      const parts = change.parts.map(({ id, plan }): api.RaisedPart => {
        const fault = planFault(plan, id);
        const known = last?.parts.find((p) => p.id === id);
        any ||= fault !== null;
        return {
          id,
          plan,
          geometry: known?.geometry ?? null,
          outcome: known?.outcome ?? "full",
          diagnostics: fault ? [fault] : [],
          mse: fault ? null : (known?.mse ?? null),
          volume: known?.volume ?? 0,
        };
      });
      const valid = parts.every((p) => p.diagnostics.length === 0);
      found.push({ id: change.building, revision: change.revision, valid, parts, diagnostics: [], mse: null });
    }
    return any ? found : null;
  }

  private async write(run: string, draft: Draft) {
    const writing = { run, undo: false };
    this.writing = writing;
    this.released = false;
    this.touched.clear();
    this.phase.value = "saving";
    this.keep(draft);
    try {
      const applied = await this.calls.edit(run, { what: draft.what, changes: draft.changes });
      this.writing = null;
      this.written(run, applied);
      if (writing.undo) this.desk.take(run, await this.calls.undo(run));
    } catch (e) {
      this.writing = null;
      const diagnostic = diagnosticOf(e);
      if (e instanceof Refused && e.status === 409) await this.overtaken(run, draft);
      else if (writing.undo) this.desk.showMessage(diagnostic);
      else this.unwritten(diagnostic);
    }
    if (this.desk.draft.value) this.pump();
    else if (!this.open) this.reset();
  }

  private written(run: string, applied: api.Applied) {
    this.desk.keep(null);
    const draft = this.desk.draft.value;
    this.taking = true;
    this.desk.take(run, applied);
    this.taking = false;
    if (!draft || this.desk.run.value?.id !== run) return;
    // A gesture that began meanwhile is based on the plans that were just saved.
    const rest = draft.changes.filter((c) => this.touched.has(c.building));
    this.before = null;
    for (const offer of [this.offer, this.interrupted]) if (offer) offer.before = null;
    this.wasReleased = false;
    if (rest.length === 0) {
      const open = this.open;
      this.put(null);
      this.reset();
      this.open = open;
      return;
    }
    const raised = new Map([...draft.raised].filter(([id]) => this.touched.has(id)));
    const now = (id: string, otherwise: number) => applied.buildings.find((b) => b.id === id)?.revision ?? otherwise;
    this.put({ ...draft, raised, changes: rest.map((c) => ({ ...c, revision: now(c.building, c.revision) })) });
  }

  private unwritten(diagnostic: api.Diagnostic) {
    const draft = this.desk.draft.value;
    if (!draft) return;
    const invalid = diagnostic.code === "edit-invalid";
    this.put({ ...draft, invalid: draft.invalid || invalid });
    if (!this.open) this.hold(draft, diagnostic);
    else this.reason.value = diagnostic;
  }

  /** Another page was faster; or this edit was applied, and only its answer was lost. */
  private async overtaken(run: string, draft: Draft) {
    this.drop();
    let now: Awaited<ReturnType<Calls["buildings"]>>;
    try {
      // Of a large run only what the draft is about.
      const answers = this.desk.run.value?.large
        ? await Promise.all(draft.changes.map((c) => this.calls.building(run, c.building)))
        : [await this.calls.buildings(run)];
      now = { buildings: answers.flatMap((a) => a.buildings), history: answers.at(-1)!.history };
    } catch (e) {
      this.desk.showMessage(diagnosticOf(e));
      return;
    }
    this.desk.take(run, now);
    if (!this.unchanged(draft)) this.desk.showMessage(stale(draft.changes));
  }

  private unchanged(draft: Draft) {
    return draft.changes.every((c) => {
      const known = this.desk.run.value?.buildings.get(c.building)?.parts;
      return known && samePlans(known, c.parts);
    });
  }

  private hold(draft: Draft, reason?: api.Diagnostic) {
    this.released = false;
    this.phase.value = "held";
    if (reason) this.reason.value = reason;
    this.keep(draft);
  }
  private keep(draft: Draft) {
    const run = this.desk.run.value;
    if (run) this.desk.keep({ run: run.id, what: draft.what, changes: draft.changes });
  }

  /** After a gesture that changed nothing: continues with the previous draft. */
  private settle() {
    if (!this.desk.draft.value) {
      this.reset();
      return;
    }
    if (this.interrupted) {
      this.offer = this.interrupted;
      this.before = this.interrupted.before;
      this.interrupted = null;
      this.open = true;
      this.phase.value = "offered";
      this.pump();
      return;
    }
    this.released = this.wasReleased;
    this.phase.value = this.writing ? "saving" : this.released ? "checking" : "held";
    this.pump();
  }

  private drop() {
    this.put(null);
    this.desk.keep(null);
    this.reset();
  }
  /** The draft was removed from outside: by an undo, another run, or an edit of another page. */
  private dropped() {
    if (this.writing && this.desk.run.value?.id === this.writing.run) this.writing.undo = true;
    // The draft of a run that was closed is kept until the run is opened again.
    if (this.desk.kept()?.run === this.desk.run.value?.id) this.desk.keep(null);
    this.reset();
  }
  private reset() {
    this.stopAsking();
    this.open = false;
    this.released = false;
    this.offer = null;
    this.interrupted = null;
    this.before = null;
    this.touched.clear();
    this.answered = ++this.version;
    this.reason.value = null;
    this.phase.value = this.writing ? "saving" : "idle";
  }
  private stopAsking() {
    this.asking?.abort();
    this.asking = null;
  }
  private put(draft: Draft | null) {
    this.putting = true;
    this.desk.draft.value = draft;
    this.putting = false;
  }
}

/** What the preview says that is no error: that the change is worse for the scan. Of several buildings it names each. */
const doubtsOf = (draft: Draft): api.Diagnostic[] =>
  draft.changes.flatMap((c) => {
    const all = draft.raised.get(c.building)?.diagnostics.filter((d) => d.code === "edit-above" || d.code === "edit-error") ?? [];
    return draft.changes.length > 1 ? all.map((d) => ({ ...d, subject: d.subject || c.building })) : all;
  });

function firstError(buildings: api.RaisedBuilding[]): api.Diagnostic | null {
  const all = buildings.flatMap((b) => [...b.parts.flatMap((p) => p.diagnostics), ...b.diagnostics]);
  return all.find((d) => d.severity === "error") ?? all[0] ?? null;
}

function diagnosticOf(e: unknown): api.Diagnostic {
  if (e instanceof Refused) return e.diagnostic;
  const message = e instanceof Error ? e.message : String(e);
  return { severity: "error", code: "page-fault", message, subject: "" };
}

const noSlope = (parts: string[]) =>
  warning(
    "edit-dormers",
    `the roof has no slope any more for ${parts.length === 1 ? "a dormer, which was removed" : `${parts.length} dormers, which were removed`}; Undo brings ${parts.length === 1 ? "it" : "them"} back`,
    parts.join(", "),
  );

const stale = (changes: api.Change[]) =>
  warning(
    "edit-stale",
    "another page changed this building meanwhile; it is shown in its new state, and your change was discarded",
    changes.map((c) => c.building).join(", "),
  );

/** Whether ids and plans are equal, whatever the numbering of their profiles. */
function samePlans(a: api.NamedPlan[], b: api.NamedPlan[]): boolean {
  const text = (parts: api.NamedPlan[]) => JSON.stringify(parts.map((p) => [p.id, clean(p.plan)]));
  return text(a) === text(b);
}
