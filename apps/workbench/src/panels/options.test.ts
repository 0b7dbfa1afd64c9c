import { describe, expect, it } from "vitest";
import type { Option } from "../api/types";
import {
  changed,
  differences,
  fault,
  faulty,
  forInputs,
  forRuns,
  found,
  grouped,
  shownRange,
  usual,
  visible,
} from "./options";

const option = (module: string, name: string, change: Partial<Option> = {}): Option => ({
  module,
  name,
  used_in: "runs",
  kind: "number",
  unit: "m",
  minimum: 0,
  maximum: 10,
  choices: [],
  default: "1",
  alias: "",
  meaning: "How near lines are.",
  source: "",
  advanced: false,
  ...change,
});
const options = [
  option("ingest", "crs", { kind: "string", default: "", used_in: "inputs" }),
  option("sweep", "gamma", { meaning: "Minimum area of a side." }),
  option("sweep", "line_gap"),
  option("segment", "cliques", { kind: "boolean", default: "false" }),
  option("segment", "weight", { advanced: true }),
  option("roof", "form", { used_in: "other" }),
];
const paper = { name: "paper", meaning: "", values: { "sweep.gamma": "10" } };

describe("options", () => {
  it("are used to read inputs or in runs, as the server says", () => {
    expect(forInputs(options).map((o) => o.name)).toEqual(["crs"]);
    expect(forRuns(options).map((o) => o.name)).toEqual(["gamma", "line_gap", "cliques", "weight"]);
  });

  it("are found by all words of a search, in names and meanings", () => {
    expect(found(options, "sweep near").map((o) => o.name)).toEqual(["line_gap"]);
    expect(found(options, "line gap")).toHaveLength(1);
    expect(found(options, "nothing like it")).toEqual([]);
    expect(grouped(options).map(([module]) => module)).toEqual(["ingest", "sweep", "segment", "roof"]);
  });

  it("that are advanced are hidden until asked for or changed", () => {
    const names = (advanced: boolean, values = {}) => {
      const { shown, hidden } = visible(forRuns(options), advanced, values, undefined);
      return [shown.map((o) => o.name), hidden];
    };
    expect(names(false)).toEqual([["gamma", "line_gap", "cliques"], 1]);
    expect(names(true)).toEqual([["gamma", "line_gap", "cliques", "weight"], 0]);
    expect(names(false, { "segment.weight": "2" })).toEqual([["gamma", "line_gap", "cliques", "weight"], 0]);
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
    expect(fault(gap, "12")).toBe("must be 0 to 10 m");
    expect(fault(gap, "-1")).toBe("must be 0 to 10 m");
    expect(fault(gap, "two")).toBe('"two" must be a number');
    expect(fault(gap, "")).toBe("must be a number, 0 to 10 m");
    expect(fault(option("a", "b", { kind: "integer" }), "2.5")).toBe('"2.5" must be an integer');
    expect(fault(option("a", "b", { default: "" }), "")).toBe("");
  });

  it("show their range without bounds that only guard the program", () => {
    expect(shownRange({ minimum: 0, maximum: 10 })).toBe("0 to 10");
    expect(shownRange({ minimum: 0, maximum: 1e6 })).toBe("at least 0");
    expect(shownRange({ minimum: -1e8, maximum: 1e8 })).toBe("");
  });

  it("with several numbers need as many", () => {
    const box = option("ingest", "bbox", { default: "0 0 0 0" });
    expect(fault(box, "1 2 3 4")).toBe("");
    expect(fault(box, "1 2 3")).toBe("must be 4 numbers");
    expect(fault(box, "1 2 3 99")).toBe("must be 0 to 10 m");
  });

  it("with choices must be one of them", () => {
    const rule = option("segment", "thin_rule", { kind: "choice", choices: ["all", "unsupported"], default: "all" });
    expect(fault(rule, "unsupported")).toBe("");
    expect(fault(rule, "some")).toBe("must be one of all, unsupported");
  });

  it("report the first invalid value", () => {
    expect(faulty(options, { "sweep.line_gap": "x" })).toContain("sweep.line_gap");
    expect(faulty(options, {})).toBe("");
  });

  it("of two runs are compared with defaults filled in", () => {
    const first = { options: { "sweep.gamma": "3" } };
    const second = { options: { "sweep.line_gap": "2", "sweep.gamma": "3" } };
    expect(differences(first, second, options)).toEqual([{ option: "sweep.line_gap", first: "1", second: "2" }]);
    expect(differences({ options: { "sweep.gamma": "1" } }, { options: {} }, options)).toEqual([]);
  });
});
