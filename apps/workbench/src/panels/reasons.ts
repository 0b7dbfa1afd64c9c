// Why a building has a simpler model than asked for, or diagnostics.
import type { Building } from "../api/types";
import { said } from "./words";

/** As sentences, without repetitions: those of the run first, then those of the present models. */
export const reasonsOf = (b: Building): string[] => [
  ...new Set(
    [...b.reasons, ...b.diagnostics, ...b.parts.flatMap((p) => p.diagnostics)].map((d) => said(d)),
  ),
];
