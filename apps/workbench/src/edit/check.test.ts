import { describe, expect, it } from "vitest";
import { courtyardHouse, house, withCorners } from "./house_for_tests";
import { planFault, profileFault } from "./check";
import type { Plan } from "../api/types";

const code = (plan: Plan) => planFault(plan, "a-1")?.code ?? null;
const withProfiles = (...profiles: Plan["profiles"]) => ({ ...house(), profiles });

describe("a plan is refused without a call of the server", () => {
  it("not if it is valid", () => {
    expect(code(house())).toBeNull();
    expect(code(courtyardHouse())).toBeNull();
  });
  it("if its cap is not above its base", () => {
    expect(code({ ...house(), cap: 0 })).toBe("extrude-cap");
    expect(code({ ...house(), cap: NaN })).toBe("extrude-cap");
  });
  it("if a profile leans outwards, goes down, or does not start at the foot; the message has its number", () => {
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
    ).toBe("extends beyond 1,000 km; profiles are in metres");
  });
  it("if an edge names an unknown profile", () => {
    expect(code(withProfiles(house().profiles[0]!))).toBe("extrude-profile");
  });
  it("if edges cross; the message has their numbers, the place and a remedy", () => {
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
        "reorder the corners, or split the outline there",
      subject: "a-1",
    });
  });
  it("if a hole crosses the outline or is outside of it", () => {
    const moved = (by: number): Plan => {
      const plan = courtyardHouse();
      return { ...plan, holes: plan.holes.map((h) => ({ ...h, points: h.points.map((p) => [p[0] + by, p[1]]) })) };
    };
    expect(planFault(moved(5), "")?.message).toContain("of hole 1 cross at");
    expect(planFault(moved(20), "")?.message).toContain("hole 1 near (24.000, 3.000) is outside the footprint");
  });
  it("if it has no area", () => {
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
  it("but not if corners touch: the exact check of the server decides", () => {
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
