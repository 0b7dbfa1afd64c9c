import { describe, expect, it } from "vitest";
import { courtyardHouse, house, withCorners } from "./house_for_tests";
import { planFault, profileFault } from "./check";
import type { Plan } from "../api/types";

const code = (plan: Plan) => planFault(plan, "a-1")?.code ?? null;
const withProfiles = (...profiles: Plan["profiles"]) => ({ ...house(), profiles });

describe("a plan is refused before the server is asked", () => {
  it("not when nothing is wrong with it", () => {
    expect(code(house())).toBeNull();
    expect(code(courtyardHouse())).toBeNull();
  });
  it("when its cap is not above its base", () => {
    expect(code({ ...house(), cap: 0 })).toBe("extrude-cap");
    expect(code({ ...house(), cap: NaN })).toBe("extrude-cap");
  });
  it("when a profile leans outwards, goes down, or does not start at the foot, with its number", () => {
    const [roof, gable] = house().profiles as [Plan["profiles"][0], Plan["profiles"][0]];
    expect(
      planFault(
        withProfiles(roof, [
          [0, 0],
          [0, 5],
          [-1, 6],
        ]),
        "a-1",
      )?.message,
    ).toBe("profile 1 leans outwards");
    expect(
      planFault(
        withProfiles(
          [
            [0, 0],
            [0, 5],
            [1, 4],
          ],
          gable,
        ),
        "a-1",
      )?.message,
    ).toBe("profile 0 goes down");
    expect(
      profileFault([
        [0, 1],
        [0, 5],
      ]),
    ).toBe("does not start at (0, 0)");
    expect(profileFault([[0, 0]])).toBe("has fewer than two points");
    expect(
      profileFault([
        [0, 0],
        [0, Infinity],
      ]),
    ).toBe("has a point that is not finite");
    expect(
      profileFault([
        [0, 0],
        [0, 2e6],
      ]),
    ).toBe("reaches beyond 1,000 km; profiles are in metres");
  });
  it("when an edge names no profile", () => {
    expect(code(withProfiles(house().profiles[0]!))).toBe("extrude-profile");
  });
  it("when edges cross, with their numbers, the place and what to do", () => {
    const bowtie = withCorners([
      [0, 0],
      [10, 0],
      [1, 9],
      [10, 8],
    ]);
    expect(planFault(bowtie, "a-1")).toEqual({
      severity: "error",
      code: "extrude-not-simple",
      message:
        "edge 1 and edge 3 cross at (5.556, 4.444); " +
        "swap corners that are out of order, or cut the outline there into two",
      subject: "a-1",
    });
  });
  it("when a hole reaches out of the outline or lies outside of it", () => {
    const moved = (by: number): Plan => {
      const plan = courtyardHouse();
      return { ...plan, holes: plan.holes.map((h) => ({ ...h, points: h.points.map((p) => [p[0] + by, p[1]]) })) };
    };
    expect(planFault(moved(5), "")?.message).toContain("of hole 1 cross at");
    expect(planFault(moved(20), "")?.message).toContain("hole 1 near (24.000, 3.000) lies outside of the footprint");
  });
  it("when nothing is left of it", () => {
    expect(
      code(
        withCorners([
          [0, 0],
          [10, 0],
          [5, 0],
        ]),
      ),
    ).toBe("extrude-no-area");
  });
  it("but not when corners merely touch: the server is exact and decides", () => {
    expect(
      code(
        withCorners([
          [0, 0],
          [10, 0],
          [10, 8],
          [5, 0],
          [0, 8],
        ]),
      ),
    ).toBeNull();
  });
});
