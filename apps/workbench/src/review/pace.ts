// Time from a key to the image of the next building, as measured by the browser; for tests.
const times: number[] = [];
/** The latest times in milliseconds, oldest first. */
export const caseTimes: readonly number[] = times;

let begun = 0; // time of the key whose building has not been drawn yet

export function beginCase(since: number) {
  begun = since;
}
/** An image was drawn, with the camera where it stays. The browser begins the next one when this one has been handed over. */
export function caseDrawn() {
  if (!begun) return;
  const since = begun;
  begun = 0;
  requestAnimationFrame(() => {
    times.push(performance.now() - since);
    if (times.length > 500) times.shift();
  });
}

if (typeof window !== "undefined") {
  const page = window as unknown as { mansard?: Record<string, unknown> };
  page.mansard = { ...page.mansard, caseTimes };
}
