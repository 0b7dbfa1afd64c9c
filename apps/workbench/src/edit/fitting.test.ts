import { describe, expect, it } from "vitest";
import { least, planeOf, variablePlane } from "./fitting";
import { house } from "./house_for_tests";
import { insertVertex } from "./plan";

describe("values with the least cost", () => {
  it("are found to a hundredth, also where they depend on each other", async () => {
    let asked = 0;
    const cost = ([x, y]: readonly number[]) => {
      ++asked;
      return Promise.resolve(1 + (x! - 3.3) ** 2 + (x! + y! - 1.1) ** 2);
    };
    const found = await least({ start: [2, 0], steps: [0.4, 0.4] }, cost);
    expect(found.values[0]).toBeCloseTo(3.3, 1);
    expect(found.cost).toBeLessThan(1.01);
    expect(asked).toBeLessThanOrEqual(161);
  });
  it("are those of the start where nothing is better", async () => {
    const found = await least({ start: [1], steps: [0.4] }, ([x]) => Promise.resolve(x === 1 ? 0.5 : Infinity));
    expect(found).toEqual({ values: [1], cost: 0.5 });
  });
});

describe("a plane", () => {
  it("goes along all edges on its line", () => {
    const plan = insertVertex(house(), { ring: 0, edge: 0 }, [5, 0]);
    expect(planeOf(plan, { ring: 0, edge: 0 })).toEqual([{ ring: 0, edge: 0 }, { ring: 0, edge: 1 }]);
  });
  it("is varied by the heights of its two ends; others stay, and the cap does not cut it off", () => {
    const parts = [{ id: "a-1", plan: house() }];
    const variable = variablePlane(parts, "a-1", { ring: 0, edge: 0 }, 10)!;
    expect(variable.start).toEqual([6, 10]);
    const plan = variable.made([5, 11])![0]!.plan;
    const own = plan.profiles[plan.outer.profile_of_edge[0]!]!;
    expect(own[1]).toEqual([0, 5]);
    expect((own[2]![1] - 5) / own[2]![0]).toBeCloseTo(1.5, 9);
    expect(plan.profiles[plan.outer.profile_of_edge[2]!]).toEqual(house().profiles[0]);
    expect(plan.cap).toBeGreaterThan(20);
    expect(variable.made([6, 5])).toBeNull();
    expect(variablePlane(parts, "a-1", { ring: 0, edge: 1 }, 10)).toBeNull();
  });
});
