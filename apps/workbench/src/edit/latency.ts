// From the pointer's event to the geometry it asked for, measured by the browser: for tests and for the curious.
const most = 500;
const values: number[] = [];

/** The last latencies, milliseconds, oldest first. */
export const latencies: readonly number[] = values;

/** `pointer` is the timestamp of the event, ms since the page was opened. */
export function measureShown(pointer: number) {
  if (pointer <= 0) return; // typed or proposed: no pointer to measure from
  const now = performance.now();
  performance.mark("mansard:pointer", { startTime: pointer });
  performance.mark("mansard:geometry", { startTime: now });
  performance.measure("mansard:pointer→geometry", { start: pointer, end: now });
  values.push(now - pointer);
  if (values.length > most) values.splice(0, values.length - most);
  // The browser keeps every entry; a long day of dragging should not.
  if (performance.getEntriesByName("mansard:pointer→geometry").length > most) {
    performance.clearMarks("mansard:pointer");
    performance.clearMarks("mansard:geometry");
    performance.clearMeasures("mansard:pointer→geometry");
  }
}
