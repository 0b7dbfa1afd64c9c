import { expect, test } from "vitest";
import { barOf } from "./furniture";

test("the scale bar has a round length that fits", () => {
  for (const scale of [0.001, 0.013, 0.2, 1, 7.7, 300]) {
    const { metres, pixels } = barOf(scale, 110);
    expect(pixels).toBeLessThanOrEqual(110.001);
    expect(pixels).toBeGreaterThan(40);
    expect(Number((metres / 10 ** Math.floor(Math.log10(metres) + 1e-9)).toFixed(6))).toBeOneOf([1, 2, 5]);
    expect(metres / pixels).toBeCloseTo(scale);
  }
});
