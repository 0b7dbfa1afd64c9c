import { expect, it } from "vitest";
import type { Diagnostic } from "../api/types";
import { building } from "../view/fixtures";
import { reasonsOf } from "./reasons";

const of = (message: string): Diagnostic => ({ severity: "warning", code: "c", message, subject: "" });

it("a building has the reasons of the run and of its parts, each once", () => {
  expect(reasonsOf(building("a"))).toEqual([]);
  const part = { ...building("a").parts[0]!, diagnostics: [of("its roof is flat"), of("no roof was found")] };
  const odd = building("a", { reasons: [of("no roof was found"), of("give --crs")], parts: [part] });
  expect(reasonsOf(odd)).toEqual(["No roof was found", "Give the option “crs”", "Its roof is flat"]);
});
