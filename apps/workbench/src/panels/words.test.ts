import { expect, it } from "vitest";
import { brief, bytes, count, fullNameOf, fixed, grouped, inPage, rmse, seconds, sentence, signed, said } from "./words";

it("numbers are formatted", () => {
  expect(grouped(1234567)).toBe("1,234,567");
  expect([count(1, "part"), count(2, "part")]).toEqual(["1 part", "2 parts"]);
  expect([signed(0.5, 1), signed(-0.5, 1), signed(-0.001, 2), signed(null, 1)]).toEqual(["+0.5", "−0.5", "0.00", "–"]);
  expect([fixed(null, 2), fixed(-1, 1), fixed(NaN, 1)]).toEqual(["–", "−1.0", "–"]);
  expect([seconds(3.14), seconds(59.6), seconds(125)]).toEqual(["3.1 s", "60 s", "2 min 05 s"]);
  expect([bytes(12), bytes(1_500), bytes(250_000_000)]).toEqual(["12 B", "1.5 kB", "250 MB"]);
});

it("messages begin with a capital letter", () => {
  expect([sentence("no such file"), sentence("3 files"), sentence("")]).toEqual(["No such file", "3 files", ""]);
});

it("options are named as in the page, not as on a command line", () => {
  expect(inPage("the footprints are far from the mesh; give --mesh-offset or --crs")).toBe(
    "the footprints are far from the mesh; give the option “mesh offset” or the option “crs”",
  );
  expect(inPage("well--known and -- alone")).toBe("well--known and -- alone");
});

it("mean squares become roots, and nothing stays nothing", () => {
  expect([rmse(0.04), rmse(null), rmse(undefined)]).toEqual([0.2, null, null]);
});

it("a message that the page has a remedy for names its button", () => {
  expect(said({ message: "mesh and footprints do not overlap", code: "ingest-no-overlap" })).toContain("“Find an offset”");
  expect(said({ message: "no", code: "toString" })).toBe("No");
});

it("long names are shortened, and runs named without repetition", () => {
  expect(brief("base of b31bbff4a-00ba-11e6-b420-2bdcc4ab5d7f-1 to −0.40 m")).toBe("base of b31bbff4a…7f-1 to −0.40 m");
  expect([fullNameOf({ id: "run-1", label: "run-1" }), fullNameOf({ id: "run-1", label: "" })]).toEqual([
    "run-1",
    "run-1",
  ]);
  expect(fullNameOf({ id: "run-2", label: "gamma" })).toBe("gamma (run-2)");
});
