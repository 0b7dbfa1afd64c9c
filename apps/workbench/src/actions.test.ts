// Debian's Node 18 has no global File.
import { File as NodeFile } from "node:buffer";
import { beforeEach, describe, expect, it, vi } from "vitest";
import * as actions from "./actions";
import type * as api from "./api/types";
import * as state from "./state";
import { building, summary } from "./view/fixtures";

const run = (id: string, change: Partial<api.RunSummary> = {}) => summary({ id, ...change });
const project = (...runs: api.RunSummary[]): api.Project => ({
  name: "p",
  folder: "/p",
  inputs: null,
  reading: {},
  runs,
  scene: false,
  sample: false,
  basemap_attribution: "",
});
const history = (done: number, ...edits: string[]): api.History => ({ edits, done });
const job = (change: Partial<api.Job>): api.Job => ({
  id: "job-1",
  kind: "run",
  run: "run-2",
  state: "running",
  stage: "",
  subject: "",
  fraction: 0,
  failure: null,
  ...change,
});

/** Answers of the server, by method and path. */
let answers: Record<string, (body: unknown) => unknown>;
beforeEach(() => {
  answers = {};
  state.project.value = project(run("run-1"), run("run-2"));
  state.run.value = state.other.value = state.selection.value = state.draft.value = state.opening.value = null;
  state.also.value = [];
  state.jobs.value = [];
  state.messages.value = [];
  vi.stubGlobal("fetch", async (path: string, init: RequestInit) => {
    const answer = answers[`${init.method ?? "GET"} ${path}`];
    if (!answer)
      return Response.json({ error: { severity: "error", code: "none", message: path, subject: "" } }, { status: 404 });
    const given = await answer(init.body ? JSON.parse(init.body as string) : undefined);
    return given instanceof Response ? given : Response.json(given);
  });
});
const buildings = (...all: api.Building[]) => ({ buildings: all, history: history(0) });
const open = (...all: api.Building[]) =>
  (state.run.value = { id: "run-1", buildings: new Map(all.map((b) => [b.id, b])), history: history(0) });

describe("a large run", () => {
  const list: api.BuildingList = {
    attributes: [],
    tile_size: 200,
    ids: ["a", "b", "c"],
    blocks: ["", "", ""],
    outcomes: ["full", "full", "full"],
    volumes: [1, 2, 3],
    errors: [null, null, null],
    confidences: [null, null, null],
    edited: [false, false, false],
    shapes: [0, 1000, 20000].map((x) => [[0, 600, x, 0, x + 800, 0, x + 800, 800]]),
    reasons: {},
    history: history(0),
  };
  const asked: string[] = [];
  beforeEach(() => {
    asked.length = 0;
    state.project.value = project(run("run-1", { buildings: 100_000 }));
    answers["GET /api/runs/run-1/list"] = () => list;
    for (const [tile, ids] of [["0_0", ["a", "b"]], ["1_0", ["c"]]] as const)
      answers[`GET /api/runs/run-1/tiles/${tile}`] = () => {
        asked.push(tile);
        return { buildings: ids.map((id) => building(id)) };
      };
  });

  it("is opened as a list, without models", async () => {
    await actions.openRun("run-1", null);
    expect(state.run.value!.buildings.size).toBe(0);
    expect(state.run.value!.large!.rows.map((r) => r.id)).toEqual(["a", "b", "c"]);
    expect(asked).toEqual([]);
  });

  it("loads the models of tiles once", async () => {
    await actions.openRun("run-1", null);
    await actions.needTiles("run-1", ["1_0", "0_0"]);
    await actions.needTiles("run-1", ["0_0"]);
    expect(asked).toEqual(["1_0", "0_0"]);
    expect([...state.run.value!.buildings.keys()]).toEqual(["c", "a", "b"]);
  });

  it("loads the models around a selected building, and then selects its part", async () => {
    await actions.openRun("run-1", null);
    actions.select({ building: "c", part: null, ring: 0, edge: null });
    expect(state.selection.value).toMatchObject({ building: "c", part: null });
    await vi.waitFor(() => expect(state.run.value!.large!.loaded.size).toBe(2));
    expect(asked).toEqual(["1_0", "0_0"]);
    expect(state.selection.value!.part).toBe(building("c").parts[0]!.id);
  });

  it("has attributes as columns of all buildings, asked for once and again after an edit", async () => {
    await actions.openRun("run-1");
    const columns: string[] = [];
    answers["GET /api/runs/run-1/column?attribute=year"] = () => {
      columns.push("asked");
      return { attribute: { name: "year", source: true, unit: "", meaning: "" }, values: [1900, 1950, null] };
    };
    await Promise.all([actions.needColumn("run-1", "year"), actions.needColumn("run-1", "year")]);
    await actions.needColumn("run-1", "year");
    expect(columns).toHaveLength(1);
    expect(state.columns.value.get("run-1 year")?.values).toEqual([1900, 1950, null]);
    actions.forgetColumns("run-1");
    expect(state.columns.value.size).toBe(0);
    await actions.needColumn("run-1", "year");
    expect(columns).toHaveLength(2);
  });

  it("follows edits in its list, also of buildings that are not loaded", async () => {
    await actions.openRun("run-1", null);
    actions.take("run-1", { buildings: [building("b", { edited: true, revision: 1 })], history: history(1, "x") });
    expect(state.run.value!.large!.rows.map((r) => r.edited)).toEqual([false, true, false]);
    expect(state.run.value!.buildings.size).toBe(0);
  });

  it("cannot be compared side by side, and says so", async () => {
    await actions.compareWith("run-1");
    expect(state.other.value).toBeNull();
    expect(state.messages.value[0]!.code).toBe("compare-large");
  });
});

describe("the scene", () => {
  const asked: string[] = [];
  const scene = { name: "read" } as unknown as api.Scene;
  const read = (change: Partial<api.Job>) => job({ kind: "read", run: null, ...change });
  beforeEach(() => {
    asked.length = 0;
    state.scene.value = state.tiles.value = null;
    answers["GET /api/project"] = () => ({ ...project(), inputs: {} });
    answers["GET /api/options"] = () => ({ options: [], presets: [], formats: [] });
    answers["GET /api/scene"] = () => (asked.push("scene"), scene);
    answers["GET /api/scene/tiles"] = () => ({ tiles: [] });
  });

  it("is requested once it has been read, not before", async () => {
    answers["GET /api/jobs"] = () => ({ jobs: [read({})] });
    await actions.refresh();
    expect(asked).toEqual([]);
    actions.received({ type: "job", job: read({ state: "done" }) });
    await vi.waitFor(() => expect(state.scene.value).toEqual(scene));
    expect(asked).toEqual(["scene"]);
  });

  it("that the server kept is shown while the inputs are read again, and its tiles stay if they are the same", async () => {
    answers["GET /api/project"] = () => ({ ...project(), inputs: {}, scene: true });
    answers["GET /api/jobs"] = () => ({ jobs: [read({})] });
    await actions.refresh();
    await vi.waitFor(() => expect(state.scene.value).toEqual(scene));
    expect(state.sceneRead.value).toBe(false);
    const tiles = state.tiles.value;
    actions.received({ type: "job", job: read({ state: "done" }) });
    await vi.waitFor(() => expect(asked).toEqual(["scene", "scene"]));
    expect(state.sceneRead.value).toBe(true);
    await Promise.resolve();
    expect(state.tiles.value).toBe(tiles);
  });

  it("that was kept is not measured with: the server has no mesh yet", async () => {
    vi.useFakeTimers();
    const scored: string[] = [];
    answers["GET /api/runs/run-1/scores"] = () => (scored.push("scores"), { edits: 1, scores: null });
    state.project.value = project(run("run-1", { scores: { mse: 1 } as api.Scores }));
    state.scene.value = scene;
    state.jobs.value = [read({})];
    open(building("a"));
    actions.take("run-1", { buildings: [], history: history(1, "x") });
    await vi.advanceTimersByTimeAsync(1000);
    expect(scored).toEqual([]);
    state.jobs.value = [];
    actions.take("run-1", { buildings: [], history: history(1, "x") });
    await vi.advanceTimersByTimeAsync(1000);
    expect(scored).toEqual(["scores"]);
    vi.useRealTimers();
  });

  it("disappears if the inputs can no longer be read", async () => {
    answers["GET /api/project"] = () => ({ ...project(), inputs: {}, scene: true });
    answers["GET /api/jobs"] = () => ({ jobs: [read({})] });
    await actions.refresh();
    await vi.waitFor(() => expect(state.scene.value).toEqual(scene));
    const none = { severity: "error", code: "server-no-scene", message: "the inputs could not be read", subject: "" };
    answers["GET /api/scene"] = () => Response.json({ error: none }, { status: 404 });
    actions.received({ type: "job", job: read({ state: "failed" }) });
    await vi.waitFor(() => expect(state.scene.value).toBeNull());
  });

  it("is requested also if the end of reading arrives before the list of jobs", async () => {
    state.project.value = null;
    answers["GET /api/jobs"] = () => {
      actions.received({ type: "job", job: read({ state: "done" }) });
      return { jobs: [read({})] };
    };
    await actions.refresh();
    await vi.waitFor(() => expect(state.scene.value).toEqual(scene));
    expect(state.jobs.value).toEqual([read({ state: "done" })]);
  });

  it("belongs to the project of the last event, which an older answer does not replace", async () => {
    answers["GET /api/project"] = () => project(); // answered before the inputs were accepted
    answers["GET /api/jobs"] = () => {
      actions.received({ type: "project", project: { ...project(), inputs: {} as api.Project["inputs"] } });
      return { jobs: [read({ state: "done" })] };
    };
    await actions.refresh();
    expect(state.project.value?.inputs).toEqual({});
    await vi.waitFor(() => expect(state.scene.value).toEqual(scene));
  });

  it("of a restarted server is not requested before it has been read again", async () => {
    state.jobs.value = [read({ state: "done" })];
    answers["GET /api/jobs"] = () => ({ jobs: [read({})] });
    await actions.refresh();
    expect(state.jobs.value).toEqual([read({})]);
    expect(asked).toEqual([]);
  });
});

describe("runs", () => {
  it("are opened with the selection if it still exists", async () => {
    answers["GET /api/runs/run-1/buildings"] = () => buildings(building("a"), building("b"));
    await actions.openRun("run-1", { building: "b", part: "b-1", ring: 0, edge: 9 });
    expect(state.run.value!.buildings.size).toBe(2);
    expect(state.selection.value).toEqual({ building: "b", part: "b-1", ring: 0, edge: null });
    await actions.openRun("run-1", { building: "gone", part: "b-1", ring: 0, edge: 1 });
    expect(state.selection.value).toBeNull();
  });

  it("requested last are opened, whichever answer comes last", async () => {
    let late: (value: unknown) => void = () => {};
    answers["GET /api/runs/run-1/buildings"] = () => new Promise((resolve) => (late = resolve));
    answers["GET /api/runs/run-2/buildings"] = () => buildings(building("two"));
    const first = actions.openRun("run-1");
    await actions.openRun("run-2");
    late(buildings(building("one")));
    await first;
    expect(state.run.value!.id).toBe("run-2");
  });

  it("started here are opened when done, even if the event comes before the answer", async () => {
    open(building("a"));
    answers["GET /api/runs/run-2/buildings"] = () => buildings(building("two"));
    answers["POST /api/runs"] = () => {
      actions.received({ type: "job", job: job({ state: "done" }) });
      return job({ state: "queued" });
    };
    await actions.startRun({ label: "", preset: "", options: {}, blocks: [] });
    await vi.waitFor(() => expect(state.run.value!.id).toBe("run-2"));
    expect(state.jobs.value).toEqual([job({ state: "done" })]);
  });

  it("of imported models are opened when they are done", async () => {
    open(building("a"));
    answers["GET /api/runs/run-2/buildings"] = () => buildings(building("opened"));
    answers["POST /api/runs/import"] = (body) => {
      expect(body).toEqual({ path: "/data/model.glb" });
      return job({ state: "queued", id: "job-3" });
    };
    await actions.openModel("/data/model.glb");
    actions.received({ type: "job", job: job({ id: "job-3", state: "done" }) });
    await vi.waitFor(() => expect(state.run.value!.buildings.has("opened")).toBe(true));
  });

  it("started by other pages do not replace the open run", () => {
    open(building("a"));
    actions.received({ type: "job", job: job({ id: "job-7", state: "done" }) });
    expect(state.opening.value).toBeNull();
  });

  it("that failed show a message", () => {
    const failure: api.Diagnostic = { severity: "error", code: "x", message: "no", subject: "" };
    actions.received({ type: "job", job: job({ state: "failed", failure }) });
    expect(state.messages.value).toEqual([failure]);
  });

  it("deleted here are closed and another is opened, even if the project still lists them", async () => {
    state.run.value = { id: "run-2", buildings: new Map(), history: history(0) };
    answers["DELETE /api/runs/run-2"] = () => ({});
    answers["GET /api/runs/run-1/buildings"] = () => buildings(building("one"));
    await actions.deleteRun("run-2");
    await vi.waitFor(() => expect(state.run.value?.id).toBe("run-1"));
    expect(state.messages.value).toEqual([]);
  });

  it("deleted by other pages are closed, and another is opened", async () => {
    open(building("a"));
    answers["GET /api/runs/run-2/buildings"] = () => buildings(building("two"));
    actions.received({ type: "project", project: project(run("run-2")) });
    await vi.waitFor(() => expect(state.run.value?.id).toBe("run-2"));
  });
});

describe("edits", () => {
  it("of other pages are shown; events of own edits are ignored", () => {
    open(building("a"));
    const newer = building("a", { revision: 1 });
    actions.received({
      type: "buildings",
      run: "run-1",
      client: actions.client.id,
      buildings: [newer],
      history: history(1, "x"),
    });
    expect(state.run.value!.buildings.get("a")!.revision).toBe(0);
    actions.received({ type: "buildings", run: "run-1", client: "another", buildings: [newer], history: history(1, "x") });
    expect(state.run.value!.buildings.get("a")).toBe(newer);
    expect(state.run.value!.history.done).toBe(1);
  });

  it("of other pages discard a draft of the same building, with a message", () => {
    open(building("a"), building("b"));
    const draft = (id: string): state.Draft => ({
      what: "",
      changes: [{ building: id, revision: 0, parts: [] }],
      raised: new Map(),
      pending: false,
      invalid: true,
    });
    const event = (id: string): api.Event => ({
      type: "buildings",
      run: "run-1",
      client: "another",
      buildings: [building(id, { revision: 1 })],
      history: history(1, "x"),
    });
    state.draft.value = draft("b");
    actions.received(event("a"));
    expect(state.draft.value).not.toBeNull();
    actions.received(event("b"));
    expect(state.draft.value).toBeNull();
    expect(state.messages.value[0]!.code).toBe("edit-stale");
  });

  it("never restore an older revision", () => {
    open(building("a", { revision: 3 }));
    actions.take("run-1", { buildings: [building("a", { revision: 2 })], history: history(2, "x", "y") });
    expect(state.run.value!.buildings.get("a")!.revision).toBe(3);
  });

  it("that delete the selected part keep its building selected", () => {
    open(building("a"));
    state.selection.value = { building: "a", part: "a-1", ring: 0, edge: 2 };
    const part = { ...building("a").parts[0]!, id: "a-9" };
    actions.take("run-1", { buildings: [building("a", { revision: 1, parts: [part] })], history: history(1, "x") });
    expect(state.selection.value).toEqual({ building: "a", part: "a-9", ring: 0, edge: 2 });
  });

  it("take what was said of them along when they are undone", async () => {
    state.run.value = { ...open(building("a")), history: history(1, "roof") };
    answers["POST /api/runs/run-1/undo"] = () => ({ buildings: [building("a", { revision: 1 })], history: history(0, "roof") });
    actions.warn("edit-dormers", "a dormer was removed; Undo brings it back");
    actions.warn("another", "stays");
    await actions.undo();
    expect(state.messages.value.map((m) => m.code)).toEqual(["another"]);
  });

  it("are undone one by one; a draft is discarded first, without a call of the server", async () => {
    open(building("a"));
    state.run.value = { ...state.run.value!, history: history(1, "x") };
    const undone = vi.fn(() => ({ buildings: [building("a", { revision: 2 })], history: history(0, "x") }));
    answers["POST /api/runs/run-1/undo"] = undone;
    state.draft.value = { what: "", changes: [], raised: new Map(), pending: false, invalid: true };
    await actions.undo();
    expect(undone).not.toHaveBeenCalled();
    expect(state.draft.value).toBeNull();
    await actions.undo();
    expect(undone).toHaveBeenCalledOnce();
    expect(state.run.value!.buildings.get("a")!.revision).toBe(2);
    await actions.undo();
    expect(undone).toHaveBeenCalledOnce();
  });

  it("that are refused show a message", async () => {
    open(building("a"));
    state.run.value = { ...state.run.value!, history: history(0, "x") };
    await actions.redo();
    expect(state.messages.value[0]!.code).toBe("none");
  });
});

describe("the selection", () => {
  it("of a building is its first part", () => {
    open(building("a"));
    actions.select({ building: "a", part: null, ring: 0, edge: null });
    expect(state.selection.value!.part).toBe("a-1");
  });

  it("adds and removes further parts, and clears them when it changes", () => {
    open(building("a"), building("b"));
    actions.select({ building: "a", part: "a-1", ring: 0, edge: null });
    actions.selectAlso("b", "b-1");
    actions.selectAlso("a", "a-1");
    expect(state.also.value).toEqual([{ building: "b", part: "b-1" }]);
    actions.selectAlso("b", "b-1");
    expect(state.also.value).toEqual([]);
    actions.selectAlso("b", "b-1");
    actions.select({ building: "b", part: null, ring: 0, edge: null });
    expect(state.also.value).toEqual([]);
  });

  it("follows the sorted table and wraps around", () => {
    open(building("a"), building("b"), building("c"));
    state.order.value = ["c", "a"];
    const next = (step: number) => {
      actions.selectNext(step);
      return state.selection.value!.building;
    };
    expect([next(1), next(1), next(1), next(-1)]).toEqual(["c", "a", "c", "a"]);
    state.order.value = [];
  });
});

describe("messages", () => {
  it("are shown once, the newest first, up to a limit", () => {
    for (const n of [1, 2, 1, 3, 4, 5, 6]) actions.showMessage({ severity: "error", code: "c", message: `${n}`, subject: "" });
    expect(state.messages.value.map((m) => m.message)).toEqual(["6", "5", "4", "3", "1"]);
  });

  it("report a server that does not answer", async () => {
    vi.stubGlobal("fetch", () => Promise.reject(new TypeError("failed to fetch")));
    expect(await actions.attempt(actions.client.status())).toBeUndefined();
    expect(state.messages.value[0]!.code).toBe("server-gone");
  });
});

describe("uploads", () => {
  const file = (name: string) => new NodeFile(["bytes"], name) as unknown as File;
  const exists = () =>
    Response.json(
      { error: { severity: "error", code: "server-exists", message: "taken", subject: "" } },
      { status: 409 },
    );
  beforeEach(() => {
    vi.stubGlobal("fetch", async (path: string, init: RequestInit) => {
      const answer = answers[`${init.method} ${path}`];
      const given = answer ? answer(undefined) : { path: `/p/inputs/${path.slice("/api/uploads/".length)}` };
      return given instanceof Response ? given : Response.json(given);
    });
  });

  it("keep their names where these are free", async () => {
    const paths = await actions.upload([file("Halle Süd.obj"), file("a.mtl")], () => {});
    expect(paths).toEqual(["/p/inputs/Halle%20S%C3%BCd.obj", "/p/inputs/a.mtl"]);
    expect(state.messages.value).toEqual([]);
  });

  it("never replace a file: all of them go where no name is taken, and that is said", async () => {
    answers["PUT /api/uploads/a.mtl"] = exists;
    answers["PUT /api/uploads/a.obj?folder=2"] = exists;
    const paths = await actions.upload([file("a.obj"), file("a.mtl")], () => {});
    expect(paths).toEqual(["/p/inputs/a.obj?folder=3", "/p/inputs/a.mtl?folder=3"]);
    expect(state.messages.value.map((m) => m.code)).toEqual(["upload-beside"]);
    expect(state.messages.value[0]!.message).toContain("a.mtl");
  });

  it("that are refused for another reason are not tried again", async () => {
    answers["PUT /api/uploads/a.obj"] = () =>
      Response.json({ error: { severity: "error", code: "server-large", message: "large", subject: "" } }, { status: 413 });
    expect(await actions.upload([file("a.obj")], () => {})).toBeUndefined();
    expect(state.messages.value.map((m) => m.code)).toEqual(["server-large"]);
  });
});

describe("the scores of a run", () => {
  const scores = (footprint_mse: number): api.Scores => ({
    mse: 1,
    footprint_mse,
    footprint_median_absolute: 0.1,
    inside_mse: 1,
    missed: 0,
    invented: 0,
  });

  it("follow its edits, and are marked until they have been measured", async () => {
    vi.useFakeTimers();
    try {
      state.project.value = project(run("run-1", { scores: scores(1) }));
      state.scene.value = {} as api.Scene;
      open(building("a"));
      const now = () => state.scoresOf(state.project.value!.runs[0]!);
      expect(now()).toEqual({ scores: scores(1), outdated: false });
      answers["GET /api/runs/run-1/scores"] = () => ({ edits: 1, scores: scores(4) });
      state.errorMaps.value = new Map([["run-1", []]]);
      answers["GET /api/runs/run-1/error"] = () => ({ maps: [] });
      actions.take("run-1", { buildings: [building("a", { revision: 1 })], history: history(1, "x") });
      expect(now()).toEqual({ scores: scores(1), outdated: true });
      expect(state.outdatedMaps.value.has("run-1")).toBe(true);
      await vi.advanceTimersByTimeAsync(2000);
      expect(now()).toEqual({ scores: scores(4), outdated: false });
      expect(state.outdatedMaps.value.has("run-1")).toBe(false);
      actions.take("run-1", { buildings: [building("a", { revision: 2 })], history: history(0, "x") });
      expect(now(), "after undo they are those of the run").toEqual({ scores: scores(1), outdated: false });
    } finally {
      vi.useRealTimers();
    }
  });
});

it("scores are not asked for while there is no scene, and stay marked", async () => {
  vi.useFakeTimers();
  try {
    const scores = { mse: 1, footprint_mse: 1, footprint_median_absolute: 0, inside_mse: 0, missed: 0, invented: 0 };
    state.project.value = project(run("run-1", { scores }));
    state.scene.value = null;
    open(building("a"));
    let asked = 0;
    answers["GET /api/runs/run-1/scores"] = () => ({ edits: ++asked, scores });
    actions.take("run-1", { buildings: [building("a", { revision: 1 })], history: history(1, "x") });
    await vi.advanceTimersByTimeAsync(2000);
    expect(asked).toBe(0);
    expect(state.scoresOf(state.project.value!.runs[0]!).outdated).toBe(true);
  } finally {
    vi.useRealTimers();
  }
});

describe("edits of another run", () => {
  it("are carried over, and those that do not fit are named", async () => {
    open(building("a"), building("b"));
    answers["POST /api/runs/run-1/edits/carry-over"] = () => ({
      carried: ["a"],
      refused: [{ severity: "error", code: "edit-invalid", message: "overlaps", subject: "b" }],
    });
    answers["GET /api/runs/run-1/buildings"] = () => ({ ...buildings(building("a", { revision: 1 }), building("b")), history: history(1, "x") });
    await actions.carryOver("run-1", "run-2");
    expect(state.run.value!.buildings.get("a")!.revision).toBe(1);
    expect(state.messages.value.map((m) => m.code)).toEqual(["edits-carried", "edit-invalid"]);
    expect(state.messages.value[0]!.message).toContain("1 did not fit: b");
  });
});
