import { describe, expect, it } from "vitest";
import { house as geometry, plan } from "../view/fixtures";
import { handlesOf, moved, pitchesOf, shifted, type Handle } from "./handles";
import { gutterOf, type Profile } from "./profile";

const part = { plan, geometry };
const ridge = 6; // m; the house of the view is 10 by 6 m, with eaves at 3 m
const all = () => handlesOf(part);
const one = (kind: Handle["kind"]) => all().find((h) => h.kind === kind)!;
const profiles = (p: typeof plan) => p.outer.profile_of_edge.map((i) => p.profiles[i]!);
/** The height of the plane over an edge, at some metres inward. */
const over = (p: typeof plan, edge: number, inward: number) => {
  const profile = profiles(p)[edge]!;
  const [a, b] = profile.slice(-2) as [[number, number], [number, number]];
  return a[1] + ((b[1] - a[1]) / (b[0] - a[0])) * (inward - a[0]);
};

describe("handles of a roof", () => {
  it("are at its ridge, its eaves and its faces", () => {
    expect(all().map((h) => h.kind).sort()).toEqual(["eave", "eave", "face", "face", "ridge"]);
    expect(one("ridge").at).toEqual([5, 3, 6]);
    const eaves = all().flatMap((h) => (h.kind === "eave" ? [h.at] : []));
    expect(eaves).toEqual([[5, 0, 3], [5, 6, 3]]);
    const face = one("face");
    expect(face.at).toEqual([5, 1.5, 4.5]);
    expect(face.normals[0]!.map((x) => Number(x.toFixed(3)))).toEqual([0, -0.707, 0.707]);
    expect(handlesOf({ plan, geometry: null })).toEqual([]);
  });

  it("of a ridge that is dragged up change the pitches, and leave the eaves", () => {
    const now = moved(plan, ridge, one("ridge"), { up: 1 })!;
    for (const edge of [0, 2]) {
      expect(over(now, edge, 3)).toBeCloseTo(7, 9);
      expect(gutterOf(profiles(now)[edge]!)).toBe(3);
    }
    expect(pitchesOf(now, one("ridge")).map((p) => Number(p.toFixed(2)))).toEqual([53.13, 53.13]);
    expect(now.cap).toBeGreaterThanOrEqual(7); // it does not cut the ridge off
    expect(moved(plan, ridge, one("ridge"), { up: -3 })).toBeNull();
  });

  it("of a ridge that is dragged sideways keep its height", () => {
    const now = moved(plan, ridge, one("ridge"), { up: 0, aside: 1 })!;
    expect(over(now, 0, 4)).toBeCloseTo(6, 9);
    expect(over(now, 2, 2)).toBeCloseTo(6, 9);
    expect(moved(plan, ridge, one("ridge"), { up: 0, aside: 3 })).toBeNull();
  });

  it("of an eave move its side, and those of a face along the normal", () => {
    const eave = moved(plan, ridge, one("eave"), { up: 0.5 })!;
    expect(profiles(eave).map(gutterOf)).toEqual([3.5, null, 3, null]);
    expect(eave.cap).toBe(plan.cap + 0.5);
    const face = moved(plan, ridge, one("face"), { up: Math.SQRT1_2 })!;
    expect(over(face, 0, 0)).toBeCloseTo(4, 9);
    expect(over(face, 0, 3)).toBeCloseTo(7, 9);
    expect(over(face, 2, 3)).toBeCloseTo(6, 9);
    expect(moved(plan, ridge, one("face"), { up: -3 })).toBeNull();
  });

  it("keep a cap that cuts the roof off", () => {
    const low = { ...plan, cap: 5 };
    expect(moved(low, 5, one("eave"), { up: 0.5 })!.cap).toBe(5);
    expect(moved(low, 5, { kind: "top", key: "top", at: [0, 0, 5], normals: [], height: 5 }, { up: 0.5 })!.cap).toBe(5.5);
  });
});

describe("a segment of a profile that is moved up", () => {
  const mansard: Profile = [[0, 0], [0, 3], [1, 6], [4, 7]];
  it("slides along the segments beside it", () => {
    const next = shifted(mansard, 3, 0.5)!;
    const [a, b] = [next[2]!, next[3]!];
    expect((a[1] - 3) / a[0]).toBeCloseTo(3, 9); // on the steep segment
    expect((b[1] - a[1]) / (b[0] - a[0])).toBeCloseTo(1 / 3, 9);
    expect(a[1] - a[0] / 3).toBeCloseTo(6 - 1 / 3 + 0.5, 9);
    const foot = shifted(mansard, 2, 0.5)!;
    expect(foot[1]).toEqual([0, 3.5]);
    expect(foot[2]![1] - foot[2]![0] / 3).toBeCloseTo(6 - 1 / 3, 9); // on the shallow one
    expect(foot[3]).toEqual([4, 7]);
  });
  it("is refused where one of them would be gone", () => {
    expect(shifted(mansard, 3, -4)).toBeNull();
    expect(shifted(mansard, 1, 1)).toBeNull();
    expect(shifted([[0, 0], [3, 3]], 1, 1)).toBeNull();
  });
});
