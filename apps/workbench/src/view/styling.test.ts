import { expect, test } from "vitest";
import type { Row } from "../panels/table";
import { missing, ramp, scaleOf, valuesOfLarge } from "./styling";

const what = { name: "h", unit: "m", meaning: "" };

test("numbers are spread over a range without outliers", () => {
  const values = new Map(Array.from({ length: 101 }, (_, i): [string, number | null] => [`b${i}`, i === 100 ? 1e6 : i]));
  values.set("none", null);
  const scale = scaleOf(values, what);
  expect(scale.range).toEqual({ low: 2, high: 98 });
  expect(scale.missing).toBe(1);
  expect(scale.colours.get("b0")).toEqual(ramp(0));
  expect(scale.colours.get("b100")).toEqual(ramp(1));
  expect(scale.colours.get("none")).toEqual(missing);
});

test("equal numbers have one colour, and brightness grows with the value", () => {
  expect(scaleOf(new Map([["a", 4], ["b", 4]]), what).colours.get("a")).toEqual(ramp(0.5));
  const light = (t: number) => { const [r, g, b] = ramp(t); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
  for (let t = 0; t < 1; t += 0.05) expect(light(t + 0.05)).toBeGreaterThan(light(t));
});

test("categories have different colours, the rarest share one", () => {
  const few = scaleOf(new Map<string, string | null>([["a", "slanted"], ["b", "flat"], ["c", "slanted"], ["d", null]]), what);
  expect(few.categories.map((c) => [c.value, c.count])).toEqual([["slanted", 2], ["flat", 1]]);
  expect(few.colours.get("a")).not.toEqual(few.colours.get("b"));
  expect(few.colours.get("d")).toEqual(missing);
  const many = scaleOf(new Map(Array.from({ length: 20 }, (_, i) => [`b${i}`, `v${i}`])), what);
  expect(many.categories).toHaveLength(7);
  expect(many.categories.at(-1)!.value).toBe("14 other values");
  expect(new Set(many.categories.map((c) => c.colour.join())).size).toBe(7);
});

test("yes and no are categories", () => {
  expect(scaleOf(new Map([["a", true], ["b", false]]), what).categories.map((c) => c.value)).toEqual(["no", "yes"]);
});

test("of a large run all buildings have a value, whether their models are loaded or not", () => {
  const rows = ["a", "b"].map((id, i) => ({ id, rmse: i ? 0.5 : null, outcome: "full", edited: i === 1 }) as Row);
  expect([...valuesOfLarge("own error", { rows }, undefined)!]).toEqual([["a", null], ["b", 0.5]]);
  expect([...valuesOfLarge("own edited", { rows }, undefined)!]).toEqual([["a", false], ["b", true]]);
  expect(valuesOfLarge("year", { rows }, undefined)).toBeNull(); // until the server has answered nothing is coloured
  const column = { attribute: { name: "year", source: true, unit: "", meaning: "" }, values: [1900, null] };
  expect([...valuesOfLarge("year", { rows }, column)!]).toEqual([["a", 1900], ["b", null]]);
});
