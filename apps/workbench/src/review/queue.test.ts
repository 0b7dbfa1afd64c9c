import { describe, expect, it } from "vitest";
import type { ReviewDecision, ReviewPlace, Verdict } from "../api/types";
import { nextOpen, placeInWords, progress, worstFirst } from "./queue";

const decision = (building: string, verdict: Verdict, lapsed = false): ReviewDecision => ({
  building,
  decision: verdict,
  note: "",
  reviewer: "",
  time: "2026-11-28T10:00:00Z",
  lapsed,
});
const decided = (...all: ReviewDecision[]) => new Map(all.map((d) => [d.building, d]));

describe("the order of a review", () => {
  it("has buildings without a model first, then the least sure, then those that are unknown by their errors", () => {
    const row = (id: string, confidence: number | null, rmse: number | null, parts = 1) => ({ id, confidence, rmse, parts });
    expect(
      worstFirst([
        row("sure", 0.95, 0.1),
        row("unknown", null, null),
        row("edited", null, 0.5),
        row("worse", null, 2),
        row("none-9", null, null, 0),
        row("none-10", 0.99, null, 0),
        row("doubtful", 0.2, 0.1),
        row("zero", 0, 0.1),
      ]),
    ).toEqual(["none-9", "none-10", "zero", "doubtful", "sure", "worse", "edited", "unknown"]);
  });

  it("counts a decision that has lapsed as none", () => {
    const all = decided(decision("a", "right"), decision("b", "wrong", true), decision("c", "later"), decision("z", "wrong"));
    expect(progress(["a", "b", "c", "d"], all)).toEqual({ open: 1, lapsed: 1, later: 1, right: 1, wrong: 0 });
  });

  it("goes to open buildings, from the beginning again, and to what was put off last", () => {
    const ids = ["a", "b", "c", "d", "e"];
    const some = decided(decision("a", "wrong", true), decision("c", "right"), decision("d", "later"));
    expect(nextOpen(ids, some, null, 3)).toEqual(["a", "b", "e"]);
    expect(nextOpen(ids, some, "b", 3)).toEqual(["e", "a"]);
    expect(nextOpen(ids, some, "unknown", 1)).toEqual(["a"]);
    const most = decided(...["a", "b", "c", "e"].map((id) => decision(id, "right")), decision("d", "later"));
    expect(nextOpen(ids, most, "a")).toEqual(["d"]);
    expect(nextOpen(ids, most, "d")).toEqual([]);
    expect(nextOpen([], most, null)).toEqual([]);
  });

  it("says on which side of the scan the model is", () => {
    const place = (difference: number | null, what: ReviewPlace["what"] = "roof") => placeInWords({ at: [0, 0, 0], what, difference });
    expect(place(-2.345)).toContain("at the mark: the model is 2.3 m below the scan");
    expect(place(0.456, "inside")).toContain("just inside of the outline is at the mark: the model is 0.46 m above the scan");
    expect(place(0.01)).toContain("less than 0.05 m");
    expect(place(-8.21, "outside")).toContain("at the mark, the scan is 8.2 m above the ground");
    expect(place(null, "unseen")).toContain("what the scan does not cover");
  });
});
