import { describe, expect, it } from "vitest";
import { cubicMetres, metres, parsed, shownNumber } from "./numbers";

describe("typed numbers", () => {
  it("may have a comma or a point", () => {
    for (const text of ["7,4", "7.4", " 7.40 ", "+7.4", "07,4"]) expect(parsed(text)).toBe(7.4);
    expect(parsed("−0,5")).toBe(-0.5);
    expect(parsed(",5")).toBe(0.5);
    expect(parsed("12")).toBe(12);
  });
  it("are rejected if they are ambiguous or not numbers", () => {
    for (const text of ["", "7,4,1", "1.234,5", "7 4", "7m", "--7", "1e3", ".", "NaN"]) expect(parsed(text)).toBeNull();
  });
});

describe("shown numbers", () => {
  it("have two to three decimals without trailing zeros", () => {
    expect(shownNumber(7)).toBe("7.00");
    expect(shownNumber(7.4)).toBe("7.40");
    expect(shownNumber(7.412345)).toBe("7.412");
    expect(shownNumber(-7.41)).toBe("−7.41");
    expect(shownNumber(-0.0001)).toBe("0.00");
    expect(shownNumber(45.126, 2)).toBe("45.13");
  });
  it("can be parsed again", () => {
    for (const value of [0, -3.25, 7.412, 1234.5]) expect(parsed(shownNumber(value))).toBe(value);
  });
  it("are a dash if there is no value", () => {
    expect(metres(null)).toBe("–");
    expect(cubicMetres(undefined)).toBe("–");
    expect(metres(-1.005)).toBe("−1.00 m");
  });
});
