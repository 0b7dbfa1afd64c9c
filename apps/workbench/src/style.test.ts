import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, it } from "vitest";

/** The selectors of a style sheet, one by one. */
const selectors = (file: string) =>
  readFileSync(join(__dirname, file), "utf8")
    .replaceAll(/\/\*[^]*?\*\//g, "")
    .split("{")
    .flatMap((text) => text.split("}").at(-1)!.split(","))
    .map((text) => text.trim());
const classesOf = (selector: string) => [...selector.matchAll(/\.([a-z][\w-]*)/g)].map((match) => match[1]!);
/** Classes of the first element of a selector: what is written below them reaches every element with such a class. */
const leading = (file: string) => selectors(file).flatMap((selector) => classesOf(selector.split(/[\s>+~]/)[0]!));

it("no rule of the page reaches into the editor, nor the other way round", () => {
  // A class of the same name on both sides once took the pointer from every corner of the plan.
  const [page, editor] = ["style.css", "edit/edit.css"] as const;
  expect(leading(page).filter((name) => selectors(editor).some((s) => classesOf(s).includes(name)))).toEqual([]);
  expect(leading(editor).filter((name) => selectors(page).some((s) => classesOf(s).includes(name)))).toEqual([]);
  expect(leading(editor), "the sheets were read").toContain("edit-panel");
});
