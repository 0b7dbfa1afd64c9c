import { beforeEach, expect, test } from "vitest";
import { addPlace, align, aligning, fitted, offsetOption, removePair, takeBack } from "./align";

beforeEach(() => align(true));

test("the offset is the mean of the differences, and residuals are what it leaves", () => {
  expect(fitted([])).toBeNull();
  expect(fitted([{ scan: [1, 2, 9], corner: [4, 6, 0] }])).toEqual({ offset: [3, 4], residuals: [0], rms: null });
  const fit = fitted([
    { scan: [0, 0, 5], corner: [2, 1, 0] },
    { scan: [10, 0, 5], corner: [12, 3, 0] },
  ])!;
  expect(fit.offset).toEqual([2, 2]);
  expect(fit.residuals).toEqual([1, 1]);
  expect(fit.rms).toBe(1);
});

test("a point of the scan and a corner are a pair; clicks are taken back one by one", () => {
  expect(addPlace(null, [1, 1, 0]), "the first is a point of the scan").toBe(false);
  expect(addPlace([0, 0, 3], null)).toBe(true);
  expect(addPlace([9, 9, 9], null), "no corner near the pointer").toBe(false);
  expect(addPlace([9, 9, 9], [1, 1, 0])).toBe(true);
  expect(aligning.value).toEqual({ pairs: [{ scan: [0, 0, 3], corner: [1, 1, 0] }], scan: null });
  takeBack();
  expect(aligning.value).toEqual({ pairs: [], scan: [0, 0, 3] });
  takeBack();
  expect(aligning.value).toEqual({ pairs: [], scan: null });
  addPlace([0, 0, 3], null);
  addPlace(null, [1, 1, 0]);
  removePair(0);
  expect(aligning.value!.pairs).toEqual([]);
});

test("the option keeps what it had, and its z", () => {
  expect(offsetOption(undefined, [1.23456, -2])).toBe("1.235 -2 0");
  expect(offsetOption("1 2 3.5", [-1, 0.5])).toBe("0 2.5 3.5");
  expect(offsetOption("1,2,3", [1, 1])).toBe("2 3 3");
});
