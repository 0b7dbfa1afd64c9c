// The keys of the panel Review. They work while it is open, and nowhere else.
import * as state from "../state";
import * as review from "./review";

export const reviewKeys: [keys: string, does: string][] = [
  ["v", "open the panel Review, from anywhere"],
  ["r  w  d", "the model is right, wrong, or to be decided later"],
  ["n  b", "next building, building before"],
  ["1  2  3", "take one of the other models"],
  ["c", "write a note; Enter goes back"],
  ["e", "edit the building; v comes back"],
];

/** Whether the key was one of the review's. `since`: when it was pressed, ms. */
export function reviewPressed(key: string, since: number): boolean {
  if (state.tab.value !== "review" || !state.run.value) return false;
  const acts: Record<string, () => void> = {
    r: () => review.decide("right", since),
    w: () => review.decide("wrong", since),
    d: () => review.decide("later", since),
    n: () => review.step(1, since),
    b: () => review.step(-1, since),
    e: () => review.openEditor(),
    c: () => document.querySelector<HTMLElement>(".review-note input")?.focus(),
    "1": () => review.takeModel(1),
    "2": () => review.takeModel(2),
    "3": () => review.takeModel(3),
  };
  acts[key]?.();
  return key in acts;
}
