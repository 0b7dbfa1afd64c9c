// Latency from a pointer event to the geometry that it requested, as measured by the browser; for tests.
const most = 500;
const values: number[] = [];

/** The latest latencies in milliseconds, oldest first. */
export const latencies: readonly number[] = values;

/** `pointer`: time of the event, ms since the page was opened. */
export function measureShown(pointer: number) {
  if (pointer <= 0) return; // typed or proposed changes have no pointer event
  const now = performance.now();
  performance.mark("mansard:pointer", { startTime: pointer });
  performance.mark("mansard:geometry", { startTime: now });
  performance.measure("mansard:pointer→geometry", { start: pointer, end: now });
  values.push(now - pointer);
  if (values.length > most) values.splice(0, values.length - most);
  // The browser keeps every entry until it is cleared.
  if (performance.getEntriesByName("mansard:pointer→geometry").length > most) {
    performance.clearMarks("mansard:pointer");
    performance.clearMarks("mansard:geometry");
    performance.clearMeasures("mansard:pointer→geometry");
  }
}
