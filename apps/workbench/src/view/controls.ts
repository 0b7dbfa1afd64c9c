// Pointer, wheel and keys on the view: drag rotates, right or middle drag (or Ctrl) moves, wheel or pinch zooms.
export interface Gestures {
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  zoom(factor: number, x: number, y: number): void; // at a point of the canvas
  click(x: number, y: number, more: boolean): void;
  hover(x: number, y: number): void;
  leave(): void;
}

const slack = 4; // pixels that a click may move

export function attach(canvas: HTMLElement, gestures: Gestures, signal: AbortSignal) {
  const down = new Map<number, { x: number; y: number }>();
  let moved = 0;
  let pans = false;
  let spread = 0;

  const place = (e: MouseEvent) => {
    const box = canvas.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  };
  const span = () => {
    const [a, b] = [...down.values()];
    return a && b ? { size: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 } : null;
  };

  const on = <K extends keyof HTMLElementEventMap>(type: K, act: (e: HTMLElementEventMap[K]) => void, passive = true) =>
    canvas.addEventListener(type, act, { signal, passive });

  on("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    down.set(e.pointerId, place(e));
    moved = 0;
    pans = e.button !== 0 || e.ctrlKey || e.metaKey;
    spread = span()?.size ?? 0;
  });
  on("pointermove", (e) => {
    const at = place(e);
    const before = down.get(e.pointerId);
    if (!before) return gestures.hover(at.x, at.y);
    const [dx, dy] = [at.x - before.x, at.y - before.y];
    moved += Math.abs(dx) + Math.abs(dy);
    down.set(e.pointerId, at);
    const two = span();
    if (two) {
      gestures.pan(dx / 2, dy / 2);
      if (two.size > 0 && spread > 0) gestures.zoom(spread / two.size, two.x, two.y);
      spread = two.size;
    } else if (moved > slack) {
      if (pans) gestures.pan(dx, dy);
      else gestures.orbit(dx, dy);
    }
  });
  const up = (e: PointerEvent) => {
    if (!down.delete(e.pointerId)) return;
    const at = place(e);
    if (e.type === "pointerup" && moved <= slack && e.button === 0) gestures.click(at.x, at.y, e.shiftKey);
    spread = 0;
  };
  on("pointerup", up);
  on("pointercancel", up);
  on("pointerleave", () => gestures.leave());
  on("contextmenu", (e) => e.preventDefault(), false);
  on(
    "wheel",
    (e) => {
      e.preventDefault();
      const lines =
        e.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : e.deltaMode === WheelEvent.DOM_DELTA_PAGE ? 400 : 1;
      const at = place(e);
      gestures.zoom(
        Math.exp(Math.max(-240, Math.min(240, e.deltaY * lines)) * (e.ctrlKey ? 0.008 : 0.0016)),
        at.x,
        at.y,
      );
    },
    false,
  );
  on(
    "keydown",
    (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      const directions: Record<string, [number, number]> = {
        ArrowLeft: [1, 0],
        ArrowRight: [-1, 0],
        ArrowUp: [0, 1],
        ArrowDown: [0, -1],
      };
      const arrow = directions[e.key];
      const { width, height } = canvas.getBoundingClientRect();
      if (arrow && e.shiftKey) gestures.orbit(arrow[0] * -26, arrow[1] * 26);
      else if (arrow) gestures.pan(arrow[0] * 60, arrow[1] * 60);
      else if (e.key === "+" || e.key === "=") gestures.zoom(0.8, width / 2, height / 2);
      else if (e.key === "-") gestures.zoom(1.25, width / 2, height / 2);
      else return;
      e.preventDefault();
    },
    false,
  );
}
