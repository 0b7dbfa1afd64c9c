import { describe, expect, it } from "vitest";
import { choicesFrom, list } from "./layers";
import { leaning, sheetHeights } from "./segmentation";

describe("the choice of layers", () => {
  it("has defaults if nothing was stored", () => {
    const choices = choicesFrom({});
    for (const layer of list) expect(choices[layer.id]).toEqual({ shown: layer.shown, opacity: 1 });
  });

  it("takes stored values, and ignores invalid ones", () => {
    const choices = choicesFrom({ mesh: { shown: false, opacity: 0.4 }, roofs: { opacity: 7 }, gone: { shown: true } });
    expect(choices.mesh).toEqual({ shown: false, opacity: 0.4 });
    expect(choices.roofs).toEqual({ shown: true, opacity: 1 });
    expect(Object.keys(choices).sort()).toEqual(list.map((l) => l.id).sort());
  });
});

describe("the costs of a cut", () => {
  it("lean towards the lower cost", () => {
    expect(leaning({ cost_cut: 1, cost_uncut: 3 })).toBe(0.5);
    expect(leaning({ cost_cut: 3, cost_uncut: 1 })).toBe(-0.5);
    expect(leaning({ cost_cut: 0, cost_uncut: 0 })).toBe(0);
  });

  it("are drawn above all faces of their block", () => {
    const face = (block: string, height: number | null) => ({
      block,
      height,
      outer: [],
      holes: [],
      inside: true,
      part: null,
    });
    const heights = sheetHeights(
      { sweep_edges: [], edges: [], faces: [face("a", 4), face("a", 9), face("a", null), face("b", null)] },
      20,
    );
    expect(heights.get("a")).toBe(12);
    expect(heights.get("b")).toBe(23);
  });
});
