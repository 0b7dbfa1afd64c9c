import { beforeEach, describe, expect, it } from "vitest";
import type { Building } from "../api/types";
import * as state from "../state";
import { chosen, edgeShown, partsOf, renumber, shortId, shortName, toggleChosen, withPlan } from "./desk";
import { house, withCorners } from "./house_for_tests";
import { latencies, measureShown } from "./latency";
import { deleteVertex, endsOf, insertVertex } from "./plan";

const raised = (id: string, plan = house()) => ({
  id,
  plan,
  geometry: null,
  outcome: "full" as const,
  diagnostics: [],
  mse: null,
  volume: 1,
});
const building: Building = {
  id: "b",
  revision: 0,
  valid: true,
  parts: [raised("b-1"), raised("b-2")],
  diagnostics: [],
  mse: null,
  block: "",
  outcome: "full",
  reasons: [],
  edited: false,
  ground: 0,
  confidence: 0.95,
};

beforeEach(() => {
  state.run.value = { id: "run-1", buildings: new Map([["b", building]]), history: { edits: [], done: 0 } };
  state.selection.value = { building: "b", part: "b-1", ring: 0, edge: null };
  state.draft.value = null;
  chosen.value = [];
});

describe("the selected part", () => {
  it("is changed alone; the other parts keep their drafts", () => {
    const moved = withCorners([
      [0, 0],
      [9, 0],
      [9, 9],
    ]);
    const parts = [
      { id: "b-1", plan: house() },
      { id: "b-2", plan: moved },
    ];
    const changes = [{ building: "b", revision: 0, parts }];
    state.draft.value = { what: "", changes, raised: new Map(), pending: false, invalid: true };
    expect(partsOf("b")[1]?.plan).toBe(moved);
    const plan = { ...house(), cap: 5 };
    expect(withPlan(plan)).toEqual([{ building: "b", parts: [{ id: "b-1", plan }, parts[1]], lost: [] }]);
  });

  it("shows its longest edge unless one is selected", () => {
    expect(edgeShown.value).toEqual({ ring: 0, edge: 0 });
    state.selection.value = { building: "b", part: "b-1", ring: 0, edge: 3 };
    expect(edgeShown.value).toEqual({ ring: 0, edge: 3 });
    state.selection.value = { building: "b", part: "b-1", ring: 2, edge: 3 };
    expect(edgeShown.value).toEqual({ ring: 0, edge: 0 });
  });

  it("keeps its selected edges when corners are inserted and deleted", () => {
    for (let selected = 0; selected < 4; ++selected)
      for (let at = 0; at < 4; ++at) {
        const was = endsOf(house(), { ring: 0, edge: selected })!;
        state.selection.value = { building: "b", part: "b-1", ring: 0, edge: selected };
        chosen.value = [{ ring: 0, edge: selected }];
        const more = insertVertex(house(), { ring: 0, edge: at }, [5, 4]);
        renumber({ ring: 0, edge: at }, true, 4);
        const now = endsOf(more, { ring: 0, edge: state.selection.value!.edge! })!;
        expect(now[0]).toEqual(was[0]); // the first half of the split edge
        expect(chosen.value[0]?.edge).toBe(state.selection.value?.edge);

        state.selection.value = { building: "b", part: "b-1", ring: 0, edge: selected };
        const fewer = deleteVertex(house(), { ring: 0, edge: at })!;
        renumber({ ring: 0, edge: at }, false, 4);
        const left = endsOf(fewer, { ring: 0, edge: state.selection.value!.edge! })!;
        if (selected !== at) expect(left[0]).toEqual(was[0]);
        else expect(left[1]).toEqual(was[1]); // it was merged with the previous edge
      }
  });

  it("toggles additional edges", () => {
    toggleChosen({ ring: 0, edge: 1 });
    toggleChosen({ ring: 0, edge: 2 });
    toggleChosen({ ring: 0, edge: 1 });
    expect(chosen.value).toEqual([{ ring: 0, edge: 2 }]);
  });
});

describe("names", () => {
  it("are short but distinguishable", () => {
    expect(shortName("b31", "b31-2")).toBe("part 2");
    expect(shortName("b31", "west wing")).toBe("west wing");
    expect(shortId("b31bc26a8-00ba-11e6-b420-2bdcc4ab5d7f")).toBe("b31bc26a8…ab5d7f");
  });
});

describe("latency", () => {
  it("is measured from the pointer event, if there was one", () => {
    measureShown(0);
    expect(latencies).toHaveLength(0);
    measureShown(Math.max(0.001, performance.now() - 20));
    expect(latencies).toHaveLength(1);
    expect(performance.getEntriesByName("mansard:pointer→geometry")).toHaveLength(1);
  });
});
