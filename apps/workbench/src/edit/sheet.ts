// Scale and position of a drawing: metres to pixels and back. The second coordinate points up in metres, down in pixels.
import type { Point2 } from "../api/types";
import { distance } from "./vector";

export interface Sheet {
  centre: Point2; // metres, in the middle of the drawing
  scale: number; // pixels per metre
  width: number;
  height: number;
}

const least = 0.2;
const most = 4000;

export const toPixels = (sheet: Sheet, p: Point2): Point2 => [
  sheet.width / 2 + (p[0] - sheet.centre[0]) * sheet.scale,
  sheet.height / 2 - (p[1] - sheet.centre[1]) * sheet.scale,
];
export const toMetres = (sheet: Sheet, p: Point2): Point2 => [
  sheet.centre[0] + (p[0] - sheet.width / 2) / sheet.scale,
  sheet.centre[1] - (p[1] - sheet.height / 2) / sheet.scale,
];

/** Zooms; the point `at` stays at its position. */
export function zoomed(sheet: Sheet, at: Point2, factor: number): Sheet {
  const scale = Math.min(most, Math.max(least, sheet.scale * factor));
  const fixed = toMetres(sheet, at);
  const moved = toMetres({ ...sheet, scale }, at);
  return { ...sheet, scale, centre: [sheet.centre[0] + fixed[0] - moved[0], sheet.centre[1] + fixed[1] - moved[1]] };
}

export const panned = (sheet: Sheet, by: Point2): Sheet => ({
  ...sheet,
  centre: [sheet.centre[0] - by[0] / sheet.scale, sheet.centre[1] + by[1] / sheet.scale],
});

/** Fits all points into the drawing, with a margin in pixels on each side. */
export function fitted(sheet: Sheet, points: Point2[], margin: number): Sheet {
  if (points.length === 0 || sheet.width === 0 || sheet.height === 0) return sheet;
  const low: Point2 = [Math.min(...points.map((p) => p[0])), Math.min(...points.map((p) => p[1]))];
  const high: Point2 = [Math.max(...points.map((p) => p[0])), Math.max(...points.map((p) => p[1]))];
  const available = (size: number) => Math.max(20, size - 2 * margin);
  const scale = Math.min(
    available(sheet.width) / Math.max(high[0] - low[0], 0.5),
    available(sheet.height) / Math.max(high[1] - low[1], 0.5),
  );
  return {
    ...sheet,
    scale: Math.min(most, Math.max(least, scale)),
    centre: [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2],
  };
}

/** Spacing of ruler lines, at least `apart` pixels: 1, 2 or 5 times a power of ten. */
export function ruling(scale: number, apart: number): number {
  const needed = apart / scale;
  const power = 10 ** Math.floor(Math.log10(needed));
  return power * ([1, 2, 5].find((m) => m * power >= needed) ?? 10);
}

/** Radius in pixels in which a handle takes the pointer: half the way to the next one where that is less than `reach`. */
export const gripRadius = (at: Point2, handles: Point2[], reach: number) =>
  Math.min(reach, ...handles.map((h) => distance(h, at) / 2).filter((half) => half > 0));
