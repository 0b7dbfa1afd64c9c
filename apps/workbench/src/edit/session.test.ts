import { signal } from "@preact/signals";
import { beforeEach, describe, expect, it } from "vitest";
import { Refused } from "../api/client";
import type * as api from "../api/types";
import type { Draft, OpenRun } from "../state";
import { EditSession, type Calls, type Desk, type Kept } from "./session";

const plan = (gutter: number): api.Plan => ({
  base: 0,
  cap: 12,
  outer: {
    points: [
      [0, 0],
      [10, 0],
      [10, 8],
      [0, 8],
    ],
    profile_of_edge: [0, 0, 0, 0],
  },
  holes: [],
  profiles: [
    [
      [0, 0],
      [0, gutter],
      [4, gutter + 3],
    ],
  ],
});
const bowtie = (): api.Plan => ({
  ...plan(6),
  outer: {
    points: [
      [0, 0],
      [10, 8],
      [10, 0],
      [0, 9],
    ],
    profile_of_edge: [0, 0, 0, 0],
  },
});
const building = (id: string, revision: number, gutter: number): api.Building => ({
  id,
  revision,
  valid: true,
  parts: [
    {
      id: `${id}-1`,
      plan: plan(gutter),
      geometry: null,
      outcome: "full",
      diagnostics: [],
      mse: 0.1,
      volume: gutter * 80,
    },
  ],
  diagnostics: [],
  mse: 0.1,
  block: "block-0",
  outcome: "full",
  reasons: [],
  edited: false,
  ground: 0,
  confidence: 0.95,
});
const none: api.History = { edits: [], done: 0 };
const gone = () =>
  new Refused(0, { severity: "error", code: "server-gone", message: "the server does not answer", subject: "" });
const stale = () => new Refused(409, { severity: "error", code: "edit-stale", message: "", subject: "" });
const invalid = () => new Refused(422, { severity: "error", code: "edit-invalid", message: "not valid", subject: "a" });

/** A call that is answered when the test resolves it. */
interface Waiting<T> {
  changes: api.Change[];
  aborted: () => boolean;
  answer: (value: T) => Promise<void>;
  refuse: (e: unknown) => Promise<void>;
}
const turn = () => new Promise<void>((resolve) => setTimeout(resolve, 0));

function table() {
  const previews: Waiting<{ buildings: api.RaisedBuilding[] }>[] = [];
  const edits: (Waiting<api.Applied> & { what: string })[] = [];
  let undone = 0;
  let now: api.Building[] = [];
  const waiting = <T>(changes: api.Change[], into: (w: Waiting<T>) => void, signal?: AbortSignal) =>
    new Promise<T>((resolve, reject) => {
      signal?.addEventListener("abort", () => reject(new DOMException("aborted", "AbortError")));
      into({
        changes,
        aborted: () => signal?.aborted ?? false,
        answer: (value) => (resolve(value), turn()),
        refuse: (e) => (reject(e as Error), turn()),
      });
    });
  const calls: Calls = {
    preview: (_run, changes, signal) => waiting(changes, (w) => previews.push(w), signal),
    edit: (_run, edit) => waiting<api.Applied>(edit.changes, (w) => edits.push({ ...w, what: edit.what })),
    undo: () => {
      ++undone;
      return Promise.resolve({ buildings: [building("a", 3, 6)], history: none });
    },
    building: () => Promise.reject(new Error("not asked for")),
    buildings: () => Promise.resolve({ buildings: now, history: none }),
  };
  const run = signal<OpenRun | null>({
    id: "run-1",
    buildings: new Map([
      ["a", building("a", 1, 6)],
      ["b", building("b", 4, 5)],
    ]),
    history: none,
  });
  const draft = signal<Draft | null>(null);
  const said: api.Diagnostic[] = [];
  const shown: number[] = [];
  let kept: Kept | null = null;
  const desk: Desk = {
    run,
    draft,
    take: (id, answer) => {
      if (run.value?.id !== id) return;
      const buildings = new Map(run.value.buildings);
      for (const b of answer.buildings) buildings.set(b.id, b);
      run.value = { id, buildings, history: answer.history };
    },
    showMessage: (d) => said.push(d),
    keep: (k) => (kept = k && (JSON.parse(JSON.stringify(k)) as Kept)),
    kept: () => kept,
    shown: (pointer) => shown.push(pointer),
  };
  const session = new EditSession(calls, desk);
  return {
    previews,
    edits,
    run,
    draft,
    said,
    shown,
    desk,
    calls,
    session,
    undone: () => undone,
    kept: () => kept,
    setKept: (k: Kept | null) => (kept = k),
    serverHas: (buildings: api.Building[]) => (now = buildings),
  };
}

const parts = (id: string, p: api.Plan) => [{ building: id, parts: [{ id: `${id}-1`, plan: p }] }];
const raised = (id: string, gutter: number, valid = true): { buildings: api.RaisedBuilding[] } => ({
  buildings: [
    {
      ...building(id, 1, gutter),
      valid,
      diagnostics: valid ? [] : [{ severity: "error", code: "edit-overlap", message: "shares ground", subject: id }],
    },
  ],
});
const applied = (id: string, revision: number, gutter: number): api.Applied => ({
  buildings: [{ ...building(id, revision, gutter), edited: true }],
  history: { edits: ["gutter"], done: 1 },
});
const gutterOf = (p: api.Plan | undefined) => p?.profiles[0]?.[1]?.[1];

let t: ReturnType<typeof table>;
beforeEach(() => (t = table()));

describe("a drag", () => {
  it("is previewed, saved on release, and leaves no draft", async () => {
    expect(t.session.begin(["a"])).toBe(true);
    t.session.change("gutter of a", parts("a", plan(7)), 120);
    expect(t.draft.value?.pending).toBe(true);
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.draft.value?.raised.get("a")?.parts[0]?.volume).toBe(560);
    expect(t.draft.value?.pending).toBe(false);
    expect(t.shown).toEqual([120]);
    expect(t.edits).toHaveLength(0);
    t.session.commit();
    expect(t.edits[0]?.what).toBe("gutter of a");
    expect(t.edits[0]?.changes[0]?.revision).toBe(1);
    await t.edits[0]!.answer(applied("a", 2, 7));
    expect(t.draft.value).toBeNull();
    expect(t.run.value?.buildings.get("a")?.revision).toBe(2);
    expect(t.session.phase.value).toBe("idle");
    expect(t.kept()).toBeNull();
  });

  it("has one preview at a time and requests the newest plans next", async () => {
    t.session.begin(["a"]);
    for (let gutter = 7; gutter < 12; ++gutter) t.session.change("gutter", parts("a", plan(gutter)), gutter);
    expect(t.previews).toHaveLength(1);
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.previews).toHaveLength(2);
    expect(gutterOf(t.previews[1]!.changes[0]!.parts[0]!.plan)).toBe(11);
    expect(t.draft.value?.pending).toBe(true);
    await t.previews[1]!.answer(raised("a", 11));
    expect(t.shown).toEqual([7, 11]);
    expect(t.draft.value?.pending).toBe(false);
  });

  it("says on release which parts it removes, and nothing if they are there again", async () => {
    const lost = parts("a", plan(7)).map((p) => ({ ...p, lost: ["a-2"] }));
    t.session.begin(["a"]);
    t.session.change("flat", lost, 1);
    t.session.change("gutter", parts("a", plan(8)), 2);
    t.session.commit();
    expect(t.said).toEqual([]);
    t.session.begin(["a"]);
    t.session.change("flat", lost, 3);
    expect(t.said).toEqual([]);
    t.session.commit();
    expect(t.said).toMatchObject([{ code: "edit-dormers", subject: "a-2" }]);
  });

  it("released before its last preview is saved if that is valid", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(7)));
    t.session.change("gutter", parts("a", plan(8)));
    t.session.commit();
    expect(t.session.phase.value).toBe("checking");
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.edits).toHaveLength(0);
    await t.previews[1]!.answer(raised("a", 8));
    expect(gutterOf(t.edits[0]!.changes[0]!.parts[0]!.plan)).toBe(8);
  });

  it("that changes nothing saves nothing", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(7)));
    t.session.change("gutter", parts("a", plan(6)));
    t.session.commit();
    await turn();
    expect(t.draft.value).toBeNull();
    expect(t.edits).toHaveLength(0);
    expect(t.previews[0]!.aborted()).toBe(true);
  });

  it("that is cancelled is reverted, and a late answer is ignored", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(9)));
    expect(t.session.cancel()).toBe(true);
    expect(t.session.cancelled.value).toBe(1);
    expect(t.session.cancel()).toBe(false);
    expect(t.session.cancelled.value).toBe(1);
    expect(t.previews[0]!.aborted()).toBe(true);
    await t.previews[0]!.answer(raised("a", 9));
    expect(t.draft.value).toBeNull();
    expect(t.session.phase.value).toBe("idle");
  });
});

describe("a proposal", () => {
  it("is previewed, and saved as one edit only when it is kept", async () => {
    expect(t.session.offerTo("gable roof", parts("a", plan(7)))).toBe(true);
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.session.phase.value).toBe("offered");
    expect(t.edits).toHaveLength(0);
    expect(t.kept()).toBeNull(); // a reload discards it
    expect(t.session.keepOffer()).toBe(true);
    await turn();
    expect(t.edits.map((e) => e.what)).toEqual(["gable roof"]);
    await t.edits[0]!.answer(applied("a", 2, 7));
    expect(t.session.phase.value).toBe("idle");
    expect(t.session.offered).toBe(false);
  });

  it("is replaced by the next one, also of other buildings", async () => {
    t.session.offerTo("gable roofs", [...parts("a", plan(7)), ...parts("b", plan(8))]);
    await t.previews[0]!.answer({ buildings: [...raised("a", 7).buildings, ...raised("b", 8).buildings] });
    t.session.offerTo("hip roof", parts("b", plan(9)));
    expect(t.draft.value?.changes.map((c) => c.building)).toEqual(["b"]);
    expect([...t.draft.value!.raised.keys()]).toEqual(["b"]); // what is drawn stays until the answer
    expect(gutterOf(t.session.partsBefore("b")[0]!.plan)).toBe(5);
    t.session.keepOffer();
    await t.previews[1]!.answer(raised("b", 9));
    expect(t.edits.map((e) => e.what)).toEqual(["hip roof"]);
  });

  it("is taken back by Esc, by an undo and by an edit of another building", async () => {
    t.session.offerTo("gable roof", parts("a", plan(7)));
    expect(t.session.cancel()).toBe(true);
    expect(t.draft.value).toBeNull();
    t.session.offerTo("gable roof", parts("a", plan(7)));
    t.draft.value = null;
    expect(t.session.phase.value).toBe("idle");
    t.session.offerTo("gable roof", parts("a", plan(7)));
    expect(t.session.begin(["b"])).toBe(true);
    expect(t.draft.value).toBeNull();
    expect(t.session.active).toBe(true);
    expect(t.session.offered).toBe(false);
    expect(t.said).toHaveLength(0);
    expect(t.edits).toHaveLength(0);
  });

  it("is part of an edit that builds on it, and is there again if that is cancelled", async () => {
    t.session.offerTo("gable roof", parts("a", plan(7)));
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.session.begin(["a"])).toBe(true);
    t.session.change("gutter", parts("a", plan(8)));
    t.session.cancel();
    expect(t.session.phase.value).toBe("offered");
    expect(gutterOf(t.draft.value?.changes[0]?.parts[0]?.plan)).toBe(7);
    t.session.propose("gutter", parts("a", plan(8)));
    await t.previews.at(-1)!.answer(raised("a", 8));
    await turn();
    if (!t.edits.length) await t.previews.at(-1)!.answer(raised("a", 8));
    expect(t.edits.map((e) => e.what)).toEqual(["gable roof, gutter"]);
  });

  it("that is kept after its preview said that it is above the scan is saved, before that it is a question", async () => {
    const above = raised("a", 9);
    above.buildings[0]!.diagnostics = [{ severity: "warning", code: "edit-above", message: "it is 5.00 m above", subject: "a-1" }];
    t.session.offerTo("gable roof", parts("a", plan(9)));
    t.session.keepOffer();
    await t.previews[0]!.answer(above);
    expect(t.session.phase.value).toBe("held");
    t.session.cancel();
    t.session.offerTo("gable roof", parts("a", plan(9)));
    await t.previews[1]!.answer(above);
    expect(t.session.doubts.map((d) => d.code)).toEqual(["edit-above"]);
    t.session.keepOffer();
    await turn();
    expect(t.edits).toHaveLength(1);
  });

  it("is taken back where its building was changed meanwhile, by a redo", async () => {
    t.session.offerTo("gable roof", parts("a", plan(7)));
    await t.previews[0]!.answer(raised("a", 7));
    t.run.value = { ...t.run.value!, buildings: new Map([["a", building("a", 1, 6)], ["b", building("b", 5, 6)]]) };
    expect(t.session.offered).toBe(true);
    t.run.value = { ...t.run.value!, buildings: new Map([["a", building("a", 2, 6)]]) };
    expect(t.session.offered).toBe(false);
    expect(t.draft.value).toBeNull();
  });

  it("stays while an edit of the same building is being saved", async () => {
    t.session.propose("gutter", parts("a", plan(7)));
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.edits).toHaveLength(1);
    expect(t.session.offerTo("gable roof", parts("a", plan(8)))).toBe(true);
    await t.edits[0]!.answer(applied("a", 2, 7));
    expect(t.session.offered).toBe(true);
    expect(gutterOf(t.session.partsBefore("a")[0]!.plan)).toBe(7);
    await t.previews[1]!.answer(raised("a", 8));
    t.session.keepOffer();
    await turn();
    expect(t.edits[1]?.changes[0]?.revision).toBe(2);
  });

  it("on a held draft goes back to it", async () => {
    t.session.propose("wall", parts("a", plan(9)));
    await t.previews[0]!.answer(raised("a", 9, false));
    t.session.offerTo("gable roof", parts("a", plan(7)));
    expect(gutterOf(t.session.partsBefore("a")[0]!.plan)).toBe(9);
    t.session.discardOffer();
    expect(gutterOf(t.draft.value?.changes[0]?.parts[0]?.plan)).toBe(9);
    expect(t.session.offered).toBe(false);
    expect(t.session.active).toBe(false);
  });
});

describe("an invalid draft", () => {
  const hold = async () => {
    t.session.begin(["a"]);
    t.session.change("wall", parts("a", plan(9)));
    t.session.commit();
    await t.previews[0]!.answer(raised("a", 9, false));
  };

  it("is held with its reason, kept across reloads, and not saved", async () => {
    await hold();
    expect(t.session.phase.value).toBe("held");
    expect(t.draft.value?.invalid).toBe(true);
    expect(t.session.reason.value?.code).toBe("edit-overlap");
    expect(t.kept()?.changes[0]?.building).toBe("a");
    expect(t.edits).toHaveLength(0);
  });

  it("is held with a question if it is above the scan, and saved when told so", async () => {
    t.session.propose("gable roof", parts("a", plan(9)));
    const above = { severity: "warning" as const, code: "edit-above", message: "it is 5.00 m above", subject: "a-1" };
    const answer = raised("a", 9);
    answer.buildings[0]!.diagnostics = [above];
    await t.previews[0]!.answer(answer);
    expect(t.session.phase.value).toBe("held");
    expect(t.session.reason.value?.message).toContain("save it all the same");
    expect(t.edits).toHaveLength(0);
    t.session.again();
    await turn();
    expect(t.edits).toHaveLength(1);
  });

  it("is saved and said if it raises the error", async () => {
    t.session.propose("gable roof", parts("a", plan(9)));
    const worse = { severity: "warning" as const, code: "edit-error", message: "the error rises", subject: "" };
    const answer = raised("a", 9);
    answer.buildings[0]!.diagnostics = [worse];
    await t.previews[0]!.answer(answer);
    expect(t.edits).toHaveLength(1);
    expect(t.said[0]?.code).toBe("edit-error");
  });

  it("is saved once it has been dragged to a valid state", async () => {
    await hold();
    t.session.begin(["a"]);
    t.session.change("wall", parts("a", plan(7)));
    t.session.commit();
    await t.previews[1]!.answer(raised("a", 7));
    expect(t.edits).toHaveLength(1);
    expect(t.session.reason.value).toBeNull();
  });

  it("is discarded by Esc and by an undo", async () => {
    await hold();
    expect(t.session.cancel()).toBe(true);
    expect(t.draft.value).toBeNull();
    expect(t.kept()).toBeNull();
    t.session.begin(["a"]);
    t.session.change("wall", parts("a", plan(9)));
    t.session.commit();
    await t.previews[1]!.answer(raised("a", 9, false));
    t.draft.value = null;
    expect(t.session.phase.value).toBe("idle");
    expect(t.kept()).toBeNull();
    expect(t.undone()).toBe(0);
  });

  it("prevents edits of other buildings, with a message", async () => {
    await hold();
    expect(t.session.begin(["b"])).toBe(false);
    expect(t.said[0]?.code).toBe("edit-held");
    expect(t.session.begin(["a"])).toBe(true);
  });

  it("is found without a call of the server in simple cases", async () => {
    t.session.begin(["a"]);
    t.session.change("corner", parts("a", bowtie()));
    expect(t.previews).toHaveLength(0);
    expect(t.draft.value?.invalid).toBe(true);
    expect(t.session.reason.value?.code).toBe("extrude-not-simple");
    t.session.commit();
    await turn();
    expect(t.session.phase.value).toBe("held");
  });

  it("is restored when a gesture on it is cancelled", async () => {
    await hold();
    t.session.begin(["a"]);
    t.session.change("wall", parts("a", plan(7)));
    t.session.cancel();
    expect(gutterOf(t.draft.value?.changes[0]?.parts[0]?.plan)).toBe(9);
    await t.previews.at(-1)!.answer(raised("a", 9, false));
    expect(t.session.phase.value).toBe("held");
    expect(t.edits).toHaveLength(0);
  });

  it("is held also if only the edit was refused", async () => {
    t.session.begin(["a"]);
    t.session.change("wall", parts("a", plan(9)));
    t.session.commit();
    await t.previews[0]!.answer(raised("a", 9));
    await t.edits[0]!.refuse(invalid());
    expect(t.session.phase.value).toBe("held");
    expect(t.draft.value?.invalid).toBe(true);
    expect(t.session.reason.value?.message).toBe("not valid");
  });
});

describe("when the server does not answer", () => {
  it("during the preview, the draft is held and can be saved later", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(7)));
    t.session.commit();
    await t.previews[0]!.refuse(gone());
    expect(t.session.phase.value).toBe("held");
    expect(t.session.reason.value?.code).toBe("server-gone");
    expect(t.draft.value?.pending).toBe(false);
    expect(t.kept()).not.toBeNull();
    t.session.again();
    await t.previews[1]!.answer(raised("a", 7));
    await t.edits[0]!.answer(applied("a", 2, 7));
    expect(t.draft.value).toBeNull();
    expect(t.kept()).toBeNull();
  });

  it("during the edit, the draft is held and can be saved later", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(7)));
    t.session.commit();
    await t.previews[0]!.answer(raised("a", 7));
    await t.edits[0]!.refuse(gone());
    expect(t.session.phase.value).toBe("held");
    expect(t.draft.value?.invalid).toBe(false);
    t.session.again();
    await t.edits[1]!.answer(applied("a", 2, 7));
    expect(t.draft.value).toBeNull();
  });

  it("during a drag, the next move requests a preview again", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(7)));
    await t.previews[0]!.refuse(gone());
    t.session.change("gutter", parts("a", plan(8)));
    await t.previews[1]!.answer(raised("a", 8));
    expect(t.session.reason.value).toBeNull();
    expect(t.draft.value?.raised.get("a")?.parts[0]?.volume).toBe(640);
  });

  it("but had applied the edit, saving it again is no conflict", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(7)));
    t.session.commit();
    await t.previews[0]!.answer(raised("a", 7));
    await t.edits[0]!.refuse(gone());
    t.serverHas([building("a", 2, 7)]);
    t.session.again();
    await t.edits[1]!.refuse(stale());
    await turn();
    expect(t.said).toEqual([]);
    expect(t.draft.value).toBeNull();
    expect(t.run.value?.buildings.get("a")?.revision).toBe(2);
  });
});

describe("when another page was faster", () => {
  it("the buildings of the server are shown and the draft is discarded, with a message", async () => {
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(7)));
    t.session.commit();
    await t.previews[0]!.answer(raised("a", 7));
    t.serverHas([building("a", 5, 4)]);
    await t.edits[0]!.refuse(stale());
    await turn();
    expect(t.draft.value).toBeNull();
    expect(t.said.map((d) => d.code)).toEqual(["edit-stale"]);
    expect(t.run.value?.buildings.get("a")?.revision).toBe(5);
    expect(t.session.phase.value).toBe("idle");
  });
});

describe("overlapping edits", () => {
  it("a second drag of the same building while the first is being saved has the new revision", async () => {
    t.session.propose("gutter", parts("a", plan(7)));
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.session.phase.value).toBe("saving");
    t.session.begin(["a"]);
    t.session.change("gutter", parts("a", plan(8)));
    t.session.commit();
    await t.previews[1]!.answer(raised("a", 8));
    expect(t.edits).toHaveLength(1);
    await t.edits[0]!.answer(applied("a", 2, 7));
    expect(t.edits).toHaveLength(2);
    expect(t.edits[1]!.changes[0]!.revision).toBe(2);
    await t.edits[1]!.answer(applied("a", 3, 8));
    expect(t.draft.value).toBeNull();
  });

  it("a drag of another building during saving is a separate edit", async () => {
    t.session.propose("gutter", parts("a", plan(7)));
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.session.begin(["b"])).toBe(true);
    t.session.change("gutter", parts("b", plan(8)));
    await t.edits[0]!.answer(applied("a", 2, 7));
    expect(t.draft.value?.changes.map((c) => c.building)).toEqual(["b"]);
    t.session.commit();
    await t.previews[1]!.answer(raised("b", 8));
    expect(t.edits[1]!.changes.map((c) => [c.building, c.revision])).toEqual([["b", 4]]);
  });

  it("a gesture that began during saving continues after it", async () => {
    t.session.propose("gutter", parts("a", plan(7)));
    await t.previews[0]!.answer(raised("a", 7));
    t.session.begin(["a"]);
    await t.edits[0]!.answer(applied("a", 2, 7));
    expect(t.draft.value).toBeNull();
    t.session.change("gutter", parts("a", plan(8)));
    t.session.commit();
    await t.previews[1]!.answer(raised("a", 8));
    expect(t.edits[1]!.changes[0]!.revision).toBe(2);
  });

  it("a click during the check does not prevent saving", async () => {
    t.session.propose("gutter", parts("a", plan(7)));
    t.session.begin(["a"]);
    t.session.commit();
    await t.previews[0]!.answer(raised("a", 7));
    expect(t.edits).toHaveLength(1);
  });

  it("an undo during saving undoes the edit once it has been applied", async () => {
    t.session.propose("gutter", parts("a", plan(7)));
    await t.previews[0]!.answer(raised("a", 7));
    t.draft.value = null;
    await t.edits[0]!.answer(applied("a", 2, 7));
    await turn();
    expect(t.undone()).toBe(1);
    expect(t.run.value?.buildings.get("a")?.revision).toBe(3);
    expect(t.session.phase.value).toBe("idle");
  });

  it("a hundred edits in sequence are all applied with increasing revisions", async () => {
    for (let i = 0; i < 100; ++i) {
      t.session.propose(`edit ${i}`, parts("a", plan(7 + (i % 5))));
      await t.previews.at(-1)!.answer(raised("a", 7 + (i % 5)));
      await t.edits.at(-1)!.answer(applied("a", 2 + i, 7 + (i % 5)));
    }
    expect(t.edits.map((e) => e.changes[0]!.revision)).toEqual(Array.from({ length: 100 }, (_, i) => i + 1));
  });
});

describe("a reload", () => {
  const kept = (revision: number, gutter = 9): Kept => ({
    run: "run-1",
    what: "wall",
    changes: [{ building: "a", revision, parts: [{ id: "a-1", plan: plan(gutter) }] }],
  });

  it("restores the draft and requests its preview, without saving it", async () => {
    t.setKept(kept(1));
    t.session.restore();
    expect(t.session.phase.value).toBe("held");
    await t.previews[0]!.answer(raised("a", 9));
    expect(t.edits).toHaveLength(0);
    t.session.again();
    expect(t.edits).toHaveLength(1);
  });

  it("shows a message if the building was changed meanwhile", () => {
    t.setKept(kept(0));
    t.session.restore();
    expect(t.draft.value).toBeNull();
    expect(t.said[0]?.code).toBe("edit-stale");
    expect(t.kept()).toBeNull();
  });

  it("shows no message if the draft had been saved", () => {
    t.setKept(kept(0, 6));
    t.session.restore();
    expect(t.draft.value).toBeNull();
    expect(t.said).toEqual([]);
  });

  it("of another run keeps the draft for that run", () => {
    t.setKept({ ...kept(1), run: "run-2" });
    t.session.restore();
    expect(t.draft.value).toBeNull();
    expect(t.kept()?.run).toBe("run-2");
  });
});
