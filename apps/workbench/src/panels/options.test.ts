import { describe, expect, it } from "vitest";
import type { Option } from "../api/types";
import { changed, differences, fault, faulty, forReading, forRuns, grouped, tellingRange, usual } from "./options";

const option = (room: string, name: string, change: Partial<Option> = {}): Option => ({
  room,
  name,
  kind: "number",
  unit: "m",
  least: 0,
  most: 10,
  choices: [],
  default: "1",
  alias: "",
  meaning: "How near lines are.",
  ...change,
});
const options = [
  option("ingest", "crs", { kind: "text", default: "" }),
  option("sweep", "gamma", { meaning: "Least area of a side." }),
  option("sweep", "line_gap"),
  option("segment", "cliques", { kind: "flag", default: "false" }),
];
const paper = { name: "paper", meaning: "", values: { "sweep.gamma": "10" } };

describe("options", () => {
  it("are those of reading or those of a run", () => {
    expect(forReading(options).map((o) => o.name)).toEqual(["crs"]);
    expect(forRuns(options).map((o) => o.name)).toEqual(["gamma", "line_gap", "cliques"]);
  });

  it("are found by all words of a search, in names and meanings", () => {
    expect(grouped(options, "sweep near").map(([, of]) => of.map((o) => o.name))).toEqual([["line_gap"]]);
    expect(grouped(options, "line gap")[0]![1]).toHaveLength(1);
    expect(grouped(options, "nothing like it")).toEqual([]);
    expect(grouped(options).map(([room]) => room)).toEqual(["ingest", "sweep", "segment"]);
  });

  it("count as changed only where they differ from the preset or the default", () => {
    expect(usual(options[1]!, paper)).toBe("10");
    expect(changed(options, { "sweep.gamma": "10", "sweep.line_gap": "1" }, paper)).toEqual({});
    expect(changed(options, { "sweep.gamma": "10" }, undefined)).toEqual({ "sweep.gamma": "10" });
    expect(changed(options, { "sweep.gamma": "1" }, paper)).toEqual({ "sweep.gamma": "1" });
  });

  it("of numbers must be numbers within their range", () => {
    const gap = options[2]!;
    expect(fault(gap, "2.5")).toBe("");
    expect(fault(gap, "12")).toBe("0 to 10 m");
    expect(fault(gap, "-1")).toBe("0 to 10 m");
    expect(fault(gap, "two")).toContain("not a number");
    expect(fault(gap, "")).toContain("a number");
    expect(fault(option("a", "b", { kind: "whole" }), "2.5")).toBe("a whole number");
    expect(fault(option("a", "b", { default: "" }), "")).toBe("");
  });

  it("tell their range as far as it means something", () => {
    expect(tellingRange({ least: 0, most: 10 })).toBe("0 to 10");
    expect(tellingRange({ least: 0, most: 1e6 })).toBe("0 or more");
    expect(tellingRange({ least: -1e8, most: 1e8 })).toBe("");
  });

  it("of several numbers must be as many", () => {
    const box = option("ingest", "bbox", { default: "0 0 0 0" });
    expect(fault(box, "1 2 3 4")).toBe("");
    expect(fault(box, "1 2 3")).toBe("4 numbers");
    expect(fault(box, "1 2 3 99")).toBe("0 to 10 m");
  });

  it("of choices must be one of them", () => {
    const rule = option("segment", "thin_rule", { kind: "choice", choices: ["all", "unsupported"], default: "all" });
    expect(fault(rule, "unsupported")).toBe("");
    expect(fault(rule, "some")).toBe("one of all, unsupported");
  });

  it("name the first that is wrong", () => {
    expect(faulty(options, { "sweep.line_gap": "x" })).toContain("sweep.line_gap");
    expect(faulty(options, {})).toBe("");
  });

  it("of two runs differ where their values do, defaults filled in", () => {
    const first = { options: { "sweep.gamma": "3" } };
    const second = { options: { "sweep.line_gap": "2", "sweep.gamma": "3" } };
    expect(differences(first, second, options)).toEqual([{ option: "sweep.line_gap", first: "1", second: "2" }]);
    expect(differences({ options: { "sweep.gamma": "1" } }, { options: {} }, options)).toEqual([]);
  });
});
