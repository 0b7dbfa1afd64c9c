// Latency from a pointer event to the geometry that it requested, and to the image that shows it, as measured by the browser; for
// tests.
const most = 500;
const values: number[] = [];
const images: number[] = [];

/** The latest latencies in milliseconds, oldest first: until the geometry is there. */
export const latencies: readonly number[] = values;
/** Until the image with it was handed to the screen. */
export const drawnLatencies: readonly number[] = images;

let waiting = 0; // the event whose geometry has not been drawn yet

function add(to: number[], value: number) {
  to.push(value);
  if (to.length > most) to.splice(0, to.length - most);
}

/** `pointer`: time of the event, ms since the page was opened. */
export function measureShown(pointer: number) {
  if (pointer <= 0) return; // typed or proposed changes have no pointer event
  const now = performance.now();
  performance.mark("mansard:pointer", { startTime: pointer });
  performance.mark("mansard:geometry", { startTime: now });
  performance.measure("mansard:pointer→geometry", { start: pointer, end: now });
  add(values, now - pointer);
  waiting ||= pointer;
  // The browser keeps every entry until it is cleared.
  if (performance.getEntriesByName("mansard:pointer→geometry").length > most) {
    performance.clearMarks("mansard:pointer");
    performance.clearMarks("mansard:geometry");
    performance.clearMeasures("mansard:pointer→geometry");
  }
}

/** An image was drawn. The browser begins the next one when it has been handed over. */
export function measureDrawn() {
  if (!waiting) return;
  const pointer = waiting;
  waiting = 0;
  requestAnimationFrame(() => add(images, performance.now() - pointer));
}
