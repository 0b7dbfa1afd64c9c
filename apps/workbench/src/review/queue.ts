// The order in which buildings are reviewed, and how far the review is.
import type { Building, ReviewDecision, ReviewPlace } from "../api/types";

/** What is needed of a building to place it. */
export interface Placed {
  id: string;
  parts: number; // 0: it has no model
  confidence: number | null; // null: edited since, or made without a scan
  rmse: number | null; // m
}

/** Ids, the worst first: those without a model; then by the probability that the model is right; then those of which none is
 *  known, the largest error first. Equal ones keep their order. */
export function worstFirst(rows: readonly Placed[]): string[] {
  const group = (r: Placed) => (r.parts === 0 ? 0 : r.confidence !== null ? 1 : 2);
  const value = (r: Placed) => r.confidence ?? -(r.rmse ?? -1);
  return [...rows]
    .sort((a, b) => group(a) - group(b) || (group(a) > 0 ? value(a) - value(b) : 0))
    .map((r) => r.id);
}

export type Standing = "open" | "lapsed" | "later" | "right" | "wrong";
type Decisions = ReadonlyMap<string, ReviewDecision>;

export function standing(decision: ReviewDecision | undefined): Standing {
  if (!decision) return "open";
  return decision.lapsed ? "lapsed" : decision.decision;
}

/** How many of the ids are in each standing. */
export function progress(ids: readonly string[], decisions: Decisions): Record<Standing, number> {
  const out: Record<Standing, number> = { open: 0, lapsed: 0, later: 0, right: 0, wrong: 0 };
  for (const id of ids) ++out[standing(decisions.get(id))];
  return out;
}

/** The next ids to decide after `from`, at most `most`, from the beginning again after the end: those without a decision that
 *  holds; when there are none, those that were put off. `from` itself is left out. */
export function nextOpen(ids: readonly string[], decisions: Decisions, from: string | null, most = 1): string[] {
  const at = from === null ? -1 : ids.indexOf(from);
  const around = [...ids.slice(at + 1), ...ids.slice(0, Math.max(0, at))];
  const find = (wanted: readonly Standing[]) => {
    const out: string[] = [];
    for (const id of around) {
      if (out.length === most) break;
      if (id !== from && wanted.includes(standing(decisions.get(id)))) out.push(id);
    }
    return out;
  };
  const open = find(["open", "lapsed"]);
  return open.length ? open : find(["later"]);
}

/** A difference that nobody sees, m. */
const hardly = 0.05;
/** Whether the place is worth a mark. */
export const isMarked = ({ difference }: ReviewPlace) => difference === null || Math.abs(difference) >= hardly;

const wheres = {
  roof: "The largest difference on the roof",
  inside: "The largest difference just inside of the outline",
};

/** Where to look first, as a sentence. */
export function placeInWords(place: ReviewPlace): string {
  if (place.what === "unseen" || place.difference === null) return "The mark is in the middle of what the scan does not cover.";
  if (!isMarked(place)) return "On the roof, scan and model differ by less than 0.05 m.";
  const by = Math.abs(place.difference);
  if (place.what === "outside")
    return `Just outside of the outline, at the mark, the scan is ${by.toFixed(1)} m ${place.difference < 0 ? "above" : "below"} the ground.`;
  return `${wheres[place.what]} is at the mark: the model is ${by.toFixed(by < 1 ? 2 : 1)} m ${place.difference > 0 ? "above" : "below"} the scan.`;
}

/** The probability as the table has it. */
export const sureInWords = (b: Pick<Building, "confidence" | "edited" | "parts">) =>
  b.parts.length === 0
    ? "no model"
    : b.confidence === null
      ? b.edited
        ? "edited, so that no probability is known"
        : "no probability is known"
      : `right with a probability of ${Math.floor(100 * b.confidence)} %`;
