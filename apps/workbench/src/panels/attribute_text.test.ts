import { expect, test } from "vitest";
import type { AttributeTable } from "../api/types";
import { attributeText, hasValue, matching, searchedOf, termOf } from "./attribute_text";

const table: AttributeTable = {
  attributes: [],
  buildings: [
    { id: "a", values: { street: "Lange Geer", measuredHeight: 12.5, ms_edited: true }, parts: [{ id: "a-1", values: { ms_h_ridge: 14 } }] },
    { id: "b", values: { street: "Oude Delft", measuredHeight: 8 }, parts: [] },
  ],
};
const found = (word: string) => {
  const searched = searchedOf(table);
  const term = termOf(word);
  return table.buildings.map((b) => b.id).filter((id) => ("text" in term ? searched.get(id)!.text.includes(term.text) : hasValue(searched.get(id), term)));
};

test("buildings are found by values and comparisons", () => {
  expect(found("geer")).toEqual(["a"]);
  expect(found("measuredHeight>10")).toEqual(["a"]);
  expect(found("height<10")).toEqual(["b"]);
  expect(found("ms_h_ridge=14")).toEqual(["a"]);
  expect(found("ms_edited=yes")).toEqual(["a"]);
  expect(found("unknown>1")).toEqual([]);
});

test("values are shown as people write them", () => {
  expect([12.5, 3.00004, -2, true, null, "x"].map(attributeText)).toEqual(["12.5", "3", "−2", "yes", "–", "x"]);
  expect(matching({ name: "ms_h_ridge", meaning: "z of the highest corner" }, "highest h_")).toBe(true);
  expect(matching({ name: "ms_h_ridge", meaning: "" }, "wall")).toBe(false);
});
