// Scale and position of a drawing as a hook: zooms with the wheel, follows the size of its element.
import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { Point2 } from "../api/types";
import { session } from "./here";
import { fitted, zoomed, type Sheet } from "./sheet";

export interface UsedSheet {
  svg: { current: SVGSVGElement | null };
  sheet: Signal<Sheet>;
  /** Pixels from the upper left corner of the drawing. */
  pixels(event: { clientX: number; clientY: number }): Point2;
}

/** `points` are fitted into the drawing when `key` changes, and when it first has a size. */
export function useSheet(key: string, points: () => Point2[], margin: number): UsedSheet {
  const svg = useRef<SVGSVGElement | null>(null);
  const sheet = useSignal<Sheet>({ centre: [0, 0], scale: 20, width: 0, height: 0 });
  const fittedTo = useRef<{ key: string | null; centre: Point2; scale: number }>({
    key: null,
    centre: [0, 0],
    scale: 0,
  });
  const pointsNow = useRef(points);
  pointsNow.current = points;

  const fit = (now: Sheet) => {
    const last = fittedTo.current;
    // A drawing that was panned or zoomed by hand stays as it is; so does one during a drag.
    const asFitted = last.key === key && last.centre === now.centre && last.scale === now.scale && !session.active;
    if ((last.key === key && !asFitted) || now.width === 0) return now;
    const all = pointsNow.current();
    if (all.length === 0) return now;
    const next = fitted(now, all, margin);
    fittedTo.current = { key, centre: next.centre, scale: next.scale };
    return next;
  };
  const fitNow = useRef(fit);
  fitNow.current = fit;

  useEffect(() => {
    const element = svg.current;
    if (!element) return;
    const observer = new ResizeObserver(() => {
      const { width, height } = element.getBoundingClientRect();
      if (width === 0 || height === 0) return;
      sheet.value = fitNow.current({ ...sheet.value, width, height });
    });
    observer.observe(element);
    const wheel = (event: WheelEvent) => {
      event.preventDefault();
      const box = element.getBoundingClientRect();
      const lines = event.deltaMode === 1 ? 30 : 1;
      const factor = Math.exp(-Math.max(-200, Math.min(200, event.deltaY * lines)) * 0.002);
      sheet.value = zoomed(sheet.value, [event.clientX - box.left, event.clientY - box.top], factor);
    };
    element.addEventListener("wheel", wheel, { passive: false });
    return () => {
      observer.disconnect();
      element.removeEventListener("wheel", wheel);
    };
  }, []);

  useEffect(() => {
    sheet.value = fit(sheet.value);
  }, [key]);

  return {
    svg,
    sheet,
    pixels: (event) => {
      const box = svg.current!.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    },
  };
}
