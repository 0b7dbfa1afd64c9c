import { describe, expect, it } from "vitest";
import { building } from "../view/fixtures";
import { arranged, inSight, rowOf } from "./table";

const rows = [
  rowOf(building("b-10", { mse: 0.25, edited: true })),
  rowOf(building("b-9", { mse: null, outcome: "fallback" })),
  rowOf(building("b-2", { mse: 0.01, block: "block-7" })),
];
const ids = (filter: string, column: Parameters<typeof arranged>[2]["column"], down = false) =>
  arranged(rows, filter, { column, down }).map((r) => r.id);

describe("the list of buildings", () => {
  it("sorts numbers in names as numbers", () => {
    expect(ids("", "id")).toEqual(["b-2", "b-9", "b-10"]);
    expect(ids("", "id", true)).toEqual(["b-10", "b-9", "b-2"]);
  });

  it("has what is not known last, whichever way", () => {
    expect(ids("", "rmse")).toEqual(["b-2", "b-10", "b-9"]);
    expect(ids("", "rmse", true)).toEqual(["b-10", "b-2", "b-9"]);
  });

  it("keeps rows that are equal in the order of their ids", () => {
    expect(ids("", "volume", true)).toEqual(["b-2", "b-9", "b-10"]);
  });

  it("is filtered by every word, in ids, blocks, outcomes, and edited", () => {
    expect(ids("FALLBACK", "id")).toEqual(["b-9"]);
    expect(ids("edited", "id")).toEqual(["b-10"]);
    expect(ids("block-7 full", "id")).toEqual(["b-2"]);
    expect(ids("block-7 fallback", "id")).toEqual([]);
  });

  it("makes the rows in sight only, some to spare", () => {
    expect(inSight(5000, 26, 0, 520, 0)).toEqual({ from: 0, to: 20 });
    expect(inSight(5000, 26, 26_000, 520, 4)).toEqual({ from: 996, to: 1024 });
    expect(inSight(3, 26, 900, 520)).toEqual({ from: 3, to: 3 });
  });
});
