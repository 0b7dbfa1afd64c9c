import { File as NodeFile } from "node:buffer";
import { beforeEach, describe, expect, it, vi } from "vitest";
import * as actions from "../actions";
import type * as api from "../api/types";
import * as state from "../state";
import { building } from "../view/fixtures";
import { reviewPressed } from "./keys";
import * as review from "./review";

const decided = (id: string, decision: api.Verdict, change: Partial<api.ReviewDecision> = {}): api.ReviewDecision => ({
  building: id,
  decision,
  note: "",
  reviewer: "Ann",
  time: "2026-11-28T10:00:00Z",
  lapsed: false,
  ...change,
});
const plain = (id: string): api.ReviewCase => ({ building: id, revision: 0, place: null, alternatives: [] });
const settled = () => new Promise((resolve) => setTimeout(resolve, 20));

let kept: api.ReviewDecision[];
let sent: api.ReviewRequest[];
let cases: string[];
let answer: (request: api.ReviewRequest) => Response;
beforeEach(async () => {
  kept = [];
  sent = [];
  cases = [];
  answer = (request) =>
    Response.json({ decided: request.decision && decided(request.building, request.decision, { note: request.note ?? "" }) });
  vi.stubGlobal("fetch", async (path: string, init: RequestInit) => {
    if (path.endsWith("/review") && init.method === "GET") return Response.json({ reviewer: "Ann", decisions: kept });
    if (path.endsWith("/review")) {
      const request = JSON.parse(init.body as string) as api.ReviewRequest;
      sent.push(request);
      return answer(request);
    }
    const asked = /review\/case\?building=(.*)/.exec(path);
    if (asked) {
      cases.push(asked[1]!);
      return Response.json(plain(asked[1]!));
    }
    return Response.json({ error: { severity: "error", code: "none", message: path, subject: "" } }, { status: 404 });
  });
  const all = ["a", "b", "c", "d", "e"].map((id, i) => building(id, { confidence: 0.5 + 0.1 * i }));
  state.tab.value = "run";
  state.selection.value = state.draft.value = null;
  state.messages.value = [];
  state.jobs.value = [];
  state.project.value = null;
  state.scene.value = {} as api.Scene;
  state.run.value = { id: `run-${Math.random()}`, buildings: new Map(all.map((b) => [b.id, b])), history: { edits: [], done: 0 } };
  state.tab.value = "review";
  await settled();
});

describe("a review", () => {
  it("begins with the least sure building, and loads it and the next three", () => {
    expect(review.queue.value).toEqual(["a", "b", "c", "d", "e"]);
    expect(review.current.value).toBe("a");
    expect(state.flight.value?.to).toBe("case");
    expect(cases).toEqual(["a", "b", "c", "d"]);
  });

  it("decides with one key, shows the next building at once, and tells the server", async () => {
    review.setNote("a", " a tree ");
    expect(reviewPressed("w", 0)).toBe(true);
    expect(review.current.value).toBe("b");
    expect(review.decisions.value.get("a")?.decision).toBe("wrong");
    expect(sent).toEqual([{ building: "a", revision: 0, decision: "wrong", note: "a tree" }]);
    await settled();
    expect(cases.at(-1), "loaded ahead").toBe("e");
    reviewPressed("n", 0);
    reviewPressed("n", 0);
    reviewPressed("b", 0);
    expect(review.current.value).toBe("c");
    reviewPressed("d", 0);
    expect(review.current.value).toBe("d");
    for (const key of ["r", "r"]) reviewPressed(key, 0);
    // Left are b, and c, which was put off.
    expect(review.current.value).toBe("b");
    reviewPressed("r", 0);
    expect(review.current.value).toBe("c");
    reviewPressed("r", 0);
    expect(state.messages.value[0]?.code).toBe("review-end");
  });

  it("takes a decision back that the server refused", async () => {
    answer = () =>
      Response.json(
        { error: { severity: "error", code: "edit-stale", message: "changed", subject: "a" } },
        { status: 409 },
      );
    review.decide("right");
    expect(review.decisions.value.has("a")).toBe(true);
    await settled();
    expect(review.decisions.value.has("a")).toBe(false);
    expect(state.messages.value[0]?.code).toBe("edit-stale");
  });

  it("does not decide about a change that is not saved", () => {
    state.draft.value = {
      what: "up",
      changes: [{ building: "a", revision: 0, parts: [] }],
      raised: new Map(),
      pending: false,
      invalid: true,
    };
    review.decide("right");
    expect(sent).toEqual([]);
    expect(review.current.value).toBe("a");
    expect(state.messages.value[0]?.code).toBe("review-draft");
  });

  it("asks again which decisions hold when a decided building was edited", async () => {
    review.decide("right");
    await settled();
    kept = [decided("a", "right", { lapsed: true })];
    actions.take(state.run.value!.id, { buildings: [building("a", { revision: 1, edited: true })], history: { edits: ["up"], done: 1 } });
    await settled();
    expect(review.decisions.value.get("a")?.lapsed).toBe(true);
    expect(review.queue.value[0], "the order stays").toBe("a");
  });

  it("keeps a note with the decision that is there, and before with none", async () => {
    review.setNote("a", "crane");
    review.keepNote("a");
    expect(sent).toEqual([]);
    review.decide("later");
    await settled();
    review.setNote("a", "no crane");
    review.keepNote("a");
    expect(sent.map((s) => s.note)).toEqual(["crane", "no crane"]);
    await settled();
    review.keepNote("a");
    expect(sent.length, "nothing new").toBe(2);
    review.step(-1);
    expect(review.current.value).toBe("a");
    review.takeBack();
    expect(sent.at(-1)?.decision).toBe(null);
    expect(review.decisions.value.has("a")).toBe(false);
  });

  it("has keys only while its panel is open", () => {
    state.tab.value = "edit";
    for (const key of ["r", "w", "d", "n", "1", "e"]) expect(reviewPressed(key, 0)).toBe(false);
    expect(sent).toEqual([]);
  });

  it("says what is wrong with a file to merge", async () => {
    await review.merge(new NodeFile(["{"], "theirs.json") as unknown as File);
    expect(state.messages.value[0]?.message).toContain("theirs.json is not valid JSON");
  });
});
