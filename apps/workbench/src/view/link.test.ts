import { expect, test } from "vitest";
import { decoded, encoded } from "./link";

test("a link is an address, and is read as it was written", () => {
  const link = {
    run: "run-3",
    selection: { building: "Straße 5 / östlich", part: "a-1", ring: 0, edge: 2 },
    pose: { target: [1.5, -2, 3] as [number, number, number], azimuth: 1, elevation: 0.5, size: 40, fov: 0.7 },
    style: "ms_h_roof_max",
  };
  expect(encoded(link)).toMatch(/^[A-Za-z0-9_-]+$/);
  expect(decoded(encoded(link))).toEqual(link);
});

test("other text is no link", () => {
  for (const text of ["", "%%%", "bnVsbA", "abc"]) expect(decoded(text)).toBeNull();
});
