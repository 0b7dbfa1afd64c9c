import { describe, expect, it } from "vitest";
import { building } from "../view/fixtures";
import { columnsOf, filtered, sorted, unknownNames, visibleRows, rowOf } from "./table";

const rows = [
  rowOf(building("b-10", { mse: 0.25, edited: true, confidence: null })),
  rowOf(building("b-9", { mse: null, outcome: "fallback", confidence: 0.4 })),
  rowOf(building("b-2", { mse: 0.01, block: "block-7", confidence: 0.98 })),
];
const ids = (filter: string, column: Parameters<typeof sorted>[1]["column"], down = false) =>
  filtered(sorted(rows, { column, down }), filter).map((r) => r.id);

describe("the table of buildings", () => {
  it("sorts numbers in names as numbers", () => {
    expect(ids("", "id")).toEqual(["b-2", "b-9", "b-10"]);
    expect(ids("", "id", true)).toEqual(["b-10", "b-9", "b-2"]);
  });

  it("puts missing values last in either order", () => {
    expect(ids("", "rmse")).toEqual(["b-2", "b-10", "b-9"]);
    expect(ids("", "rmse", true)).toEqual(["b-10", "b-2", "b-9"]);
  });

  it("sorts by how sure models are", () => {
    expect(ids("", "confidence")).toEqual(["b-9", "b-2", "b-10"]);
  });

  it("sorts equal rows by id", () => {
    expect(ids("", "volume", true)).toEqual(["b-2", "b-9", "b-10"]);
  });

  it("is filtered by all words, in ids, blocks and outcomes", () => {
    expect(ids("FALLBACK", "id")).toEqual(["b-9"]);
    expect(ids("edited", "id")).toEqual(["b-10"]);
    expect(ids("block-7 full", "id")).toEqual(["b-2"]);
    expect(ids("block-7 fallback", "id")).toEqual([]);
  });

  it("shows a building before others of the block that is named after it", () => {
    const block = ["b-1", "b-2", "b-3"].map((id) => rowOf(building(id, { block: "block-b-2" })));
    const found = (filter: string) => filtered(sorted(block, { column: "id", down: false }), filter).map((r) => r.id);
    expect(found("b-2")).toEqual(["b-2", "b-1", "b-3"]);
    expect(found("block-b-2")).toEqual(["b-1", "b-2", "b-3"]);
    expect(found("B-2 full")).toEqual(["b-1", "b-2", "b-3"]);
  });

  it("compares its own columns by name", () => {
    expect(ids("rmse>0.3", "id")).toEqual(["b-10"]);
    expect(ids("sure<50", "id")).toEqual(["b-9"]);
    expect(ids("volume=270 rmse<0.3", "id")).toEqual(["b-2"]);
    expect(ids("parts>x", "id")).toEqual([]);
    expect(columnsOf("canal rmse>0.3 height>4 Parts=2")).toEqual({ columns: "rmse>0.3 Parts=2", rest: "canal height>4" });
  });

  it("says which names in comparisons nobody has", () => {
    expect(unknownNames("rmse>0.3 height>4 canal", ["measuredHeight"])).toBe(null);
    expect(unknownNames("hieght>4 toString=1", ["measuredHeight"])).toContain("“hieght” or “tostring”");
  });

  it("renders the visible rows and a few more", () => {
    expect(visibleRows(5000, 26, 0, 520, 0)).toEqual({ from: 0, to: 20 });
    expect(visibleRows(5000, 26, 26_000, 520, 4)).toEqual({ from: 996, to: 1024 });
    expect(visibleRows(3, 26, 900, 520)).toEqual({ from: 3, to: 3 });
  });
});
