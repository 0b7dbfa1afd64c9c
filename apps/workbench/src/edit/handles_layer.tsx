// Handles over the 3D view at the eaves, ridges and faces of the selected part; dragged with the pointer, or moved with arrow keys.
import { type ReadonlySignal, effect, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { NamedPlan, Plan, Point2 } from "../api/types";
import { rmse } from "../panels/words";
import * as state from "../state";
import { aligning } from "../view/align";
import { viewer } from "../view/current";
import { choices, lod } from "../view/layers";
import { measuring } from "../view/measure";
import { arrow, keyStep, partsOf, raisedPart, ridgeOf, selectEdge, withPlan } from "./desk";
import { handlesOf, moved, pitchesOf, type Handle } from "./handles";
import { session } from "./here";
import { metres } from "./numbers";
import { isCorner } from "./plan";
import { filledRings } from "./structures";

type Axis = "up" | "aside";
type Vector = [number, number, number];
interface Start {
  handle: Handle;
  plan: Plan; // as are the parts: before the drag
  parts: NamedPlan[];
  ridge: number;
}
interface Drag extends Start {
  down: Point2; // pixels
  pixels: Record<Axis, Point2 | null>; // that a metre is; null: seen from its end
  axis: Axis | null;
  began: boolean;
}

const apart = 25; // pixels between two handles, which are 24 pixels wide
const smallest = 50; // pixels; of the part, so that it has handles
const foreshortened = 0.25; // of its length: an axis that is seen so is no direction to drag in

const numbers = (plan: Plan, handle: Handle) => {
  if (handle.kind === "top") return "";
  const sides = handle.kind === "ridge" ? handle.sides : [handle.side];
  const edges = sides.map((s) => s.edges.map((e) => e.edge).join(", "));
  if (sides.some((s) => isCorner(plan, s.edges[0]!)))
    return sides.map((s, i) => `${isCorner(plan, s.edges[0]!) ? "corner edge" : "edge"} ${edges[i]}`).join(" and ");
  return edges.length === 2 ? `edges ${edges[0]} and ${edges[1]}` : `edge ${edges[0]}`;
};
const nameIn = (plan: Plan, handle: Handle): string =>
  ({ eave: "eave of ", ridge: "ridge between ", face: "roof plane of ", top: "flat top" })[handle.kind] + numbers(plan, handle);
const uses: Record<Handle["kind"], string> = {
  eave: "Drag it up or down: the roof moves along",
  ridge: "Drag it up or down: the pitches change, the eaves stay. Drag it sideways: it moves over the plan",
  face: "Drag it along its normal: the plane moves, its pitch stays",
  top: "Drag it up or down",
};

/** With numbers and their units on one line. */
const unbroken = (text: string) => text.replaceAll(/(\d) m\b/g, "$1\u00a0m");

/** What the view itself makes of the pointer over a handle. */
const passOn = (event: Event) => document.querySelector(".view canvas")?.dispatchEvent(event);

export function Handles({ images }: { images: ReadonlySignal<number> }) {
  const at = state.selection.value;
  const part = raisedPart.value;
  const drag = useRef<Drag | null>(null);
  const nudge = useRef<(Start & { up: number; aside: number }) | null>(null);
  const held = useRef<Handle | null>(null); // stays while it is moved, also where its ridge is gone
  const box = useRef<HTMLDivElement>(null);
  const words = useSignal("");
  const said = useRef<string>(""); // the handle that `words` are beside
  const wanted =
    state.tab.value === "edit" &&
    at?.part != null &&
    lod.value === "2.2" &&
    choices.value.roofs.shown &&
    !measuring.value &&
    !aligning.value &&
    !state.choosing.value;
  const found = useMemo(
    () => (wanted && part && at ? handlesOf(part, filledRings(partsOf(at.building), part.id)) : []),
    [wanted, part, at?.building],
  );
  const handles = held.current && !found.some((h) => h.key === held.current!.key) ? [...found, held.current] : found;

  const list = useRef(handles);
  list.current = handles;
  const place = () => {
    const view = viewer.peek();
    if (!view || !box.current) return;
    const all = list.current;
    const places = view.inView(all.map((h) => h.at));
    const eye = view.eyeAt;
    const free: Point2[] = [];
    const shown = places.filter((p) => p !== null) as Point2[];
    const span = ([0, 1] as const).map((k) => Math.max(...shown.map((p) => p[k])) - Math.min(...shown.map((p) => p[k])));
    const tooSmall = shown.length > 1 && Math.max(...span) < smallest;
    for (const [i, child] of [...box.current.querySelectorAll<HTMLElement>("button")].entries()) {
      const [handle, p] = [all[i], places[i]];
      const used = handle && held.current?.key === handle.key;
      const faces = handle?.normals.some((n) => n.reduce((sum, x, k) => sum + x * (eye[k]! - handle.at[k]!), 0) > 0);
      const clear = p && free.every((q) => Math.hypot(p[0] - q[0], p[1] - q[1]) > apart);
      const visible = p && (used || (faces && clear && !tooSmall));
      child.style.visibility = visible ? "" : "hidden";
      if (!visible) continue;
      free.push(p);
      child.style.transform = `translate(${p[0].toFixed(1)}px, ${p[1].toFixed(1)}px)`;
      const note = box.current.querySelector<HTMLElement>("output")!;
      if (handle!.key !== said.current) continue;
      // On the left of a handle that is near the right edge of the view.
      const beside = box.current.clientWidth - p[0] - 16;
      const left = note.offsetWidth < beside ? p[0] + 16 : Math.max(4, p[0] - 16 - note.offsetWidth);
      note.style.transform = `translate(${left.toFixed(1)}px, ${Math.max(4, p[1] - 30).toFixed(1)}px)`;
    }
  };
  useEffect(
    () =>
      effect(() => {
        void images.value;
        place();
      }),
    [],
  );
  useEffect(place);
  useSignalEffect(() => {
    if (session.cancelled.value > 0) words.value = "";
  });
  useEffect(() => {
    words.value = "";
  }, [at?.building, at?.part, wanted]);

  if (!wanted || !part || !at?.part) return null;
  const building = at.building;
  const nameOf = (handle: Handle) => nameIn(part.plan, handle);

  const start = (handle: Handle): Start => ({
    handle,
    plan: partsOf(building).find((p) => p.id === part.id)!.plan,
    parts: partsOf(building).map(({ id, plan }) => ({ id, plan })),
    ridge: ridgeOf(part) ?? 0,
  });
  /** The change of a handle that was moved from where it was. */
  const change = (from: Start, up: number, aside: number, time: number): boolean => {
    const { handle } = from;
    const plan = moved(from.plan, from.ridge, handle, { up, aside });
    said.current = handle.key;
    if (!plan) {
      words.value = `${nameOf(handle)}: that is as far as it goes`;
      return false;
    }
    const by = aside ? `moved aside by ${metres(Math.abs(aside))}` : handle.kind === "face" ? `moved ${up < 0 ? "in" : "out"} by ${metres(Math.abs(up))}` : `${up < 0 ? "lowered" : "raised"} by ${metres(Math.abs(up))}`;
    session.change(`${nameOf(handle)} of ${part.id} ${by}`, withPlan(plan, from.parts), time);
    const height = "height" in handle ? `, ${metres(handle.height + up)} high` : "";
    const pitches = pitchesOf(plan, handle).map((p) => `${p.toFixed(1)}°`);
    words.value = `${nameOf(handle)} ${by}${height}${pitches.length ? `, pitch ${pitches.join(" and ")}` : ""}`;
    return true;
  };

  // ---- pointer

  const axesOf = (handle: Handle): Record<Axis, Vector | null> => ({
    up: handle.kind === "face" ? handle.normal : [0, 0, 1],
    aside: handle.kind === "ridge" ? [...handle.sides[0].inward, 0] : null,
  });
  const pixelsOf = (handle: Handle): Record<Axis, Point2 | null> => {
    const axes = axesOf(handle);
    const length = 0.2; // m
    const mpp = state.compass.peek()?.metresPerPixel ?? 0.05;
    const along = (axis: Vector | null): Point2 | null => {
      if (!axis) return null;
      const [p, q] = viewer.peek()?.inView([handle.at, handle.at.map((x, k) => x + length * axis[k]!) as Vector]) ?? [];
      if (!p || !q) return null;
      const v: Point2 = [(q[0] - p[0]) / length, (q[1] - p[1]) / length];
      return Math.hypot(...v) * mpp < foreshortened ? null : v;
    };
    const aside = along(axes.aside);
    // Where nothing else can be dragged, up on the page is up.
    return { up: along(axes.up) ?? (aside ? null : [0, -1 / mpp]), aside };
  };
  const down = (event: PointerEvent, handle: Handle) => {
    if (event.button !== 0) return;
    event.stopPropagation();
    const from: Point2 = [event.clientX, event.clientY];
    drag.current = { ...start(handle), down: from, pixels: pixelsOf(handle), axis: null, began: false };
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
  };
  const move = (event: PointerEvent) => {
    const d = drag.current;
    if (!d) {
      passOn(new PointerEvent("pointermove", event)); // what is under the pointer
      return;
    }
    const by: Point2 = [event.clientX - d.down[0], event.clientY - d.down[1]];
    if (!d.began) {
      if (Math.hypot(...by) <= 3) return;
      const along = (v: Point2 | null) => (v ? Math.abs(by[0] * v[0] + by[1] * v[1]) / Math.hypot(...v) : -1);
      d.axis = along(d.pixels.aside) > along(d.pixels.up) ? "aside" : "up";
      if (!session.begin([building])) {
        drag.current = null;
        return;
      }
      d.began = true;
      held.current = d.handle;
    }
    if (!session.active) {
      release(); // cancelled with Esc, undone, or replaced by an edit of another page
      return;
    }
    const v = d.pixels[d.axis!] ?? [0, -20];
    const fine = event.altKey ? 1000 : 100;
    const amount = Math.round(((by[0] * v[0] + by[1] * v[1]) / (v[0] ** 2 + v[1] ** 2)) * fine) / fine;
    change(d, d.axis === "up" ? amount : 0, d.axis === "aside" ? amount : 0, event.timeStamp);
  };
  const release = () => {
    drag.current = null;
    nudge.current = null;
    held.current = null;
    words.value = "";
  };
  const up = (handle: Handle) => {
    const d = drag.current;
    if (!d) return;
    release();
    if (d.began) session.commit();
    else if (handle.kind === "eave" || handle.kind === "face") selectEdge(handle.side.edges[0]!);
  };
  const broken = () => {
    if (drag.current?.began) session.cancel();
    if (drag.current) release();
  };

  // ---- keyboard

  const key = (event: KeyboardEvent, handle: Handle) => {
    const by = arrow(event);
    if (!by || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    if (nudge.current && !session.active) nudge.current = null;
    if (!nudge.current) {
      if (!session.begin([building])) return;
      nudge.current = { ...start(handle), up: 0, aside: 0 };
      held.current = handle;
    }
    const n = nudge.current;
    const sideways = by[0] !== 0 && handle.kind === "ridge";
    // To the right on the page.
    const right = Math.sign(pixelsOf(handle).aside?.[0] ?? 1) || 1;
    const step = Math.sign(by[0] + by[1]) * keyStep(event) * (sideways ? right : 1);
    const next = { up: n.up + (sideways ? 0 : step), aside: n.aside + (sideways ? step : 0) };
    const whole = (x: number) => Math.round(x * 1e6) / 1e6;
    if (change(n, whole(next.up), whole(next.aside), event.timeStamp)) Object.assign(n, next);
  };
  const settle = () => {
    if (!nudge.current) return;
    const text = words.value;
    release();
    words.value = text;
    session.commit();
  };

  const before = state.run.value?.buildings.get(building)?.mse;
  const after = state.draft.value?.raised.get(building)?.mse;
  const error = before == null || after == null ? "" : ` · RMSE ${metres(rmse(before), 3).replace(/ m$/, "")} → ${metres(rmse(after), 3)}`;

  return (
    <div class="edit-handles" role="group" aria-label={`Handles of the roof of ${part.id}`} ref={box}>
      {handles.map((handle) => (
        <button
          key={handle.key}
          type="button"
          class={`edit-handle ${handle.kind}`}
          aria-label={`${nameOf(handle)}${"height" in handle ? `, ${metres(handle.height)} high` : ""}. Arrow keys move it by 0.1 metres, with Shift by 1 metre, with Alt by 0.01 metres`}
          title={`${nameOf(handle)}. ${uses[handle.kind]}`}
          style={{ visibility: "hidden" }}
          onPointerDown={(event) => down(event, handle)}
          onPointerMove={move}
          onPointerLeave={(event) => !drag.current && !(event.relatedTarget instanceof HTMLCanvasElement) && passOn(new PointerEvent("pointerleave", event))}
          onPointerUp={() => up(handle)}
          onPointerCancel={broken}
          onLostPointerCapture={broken}
          onKeyDown={(event) => key(event, handle)}
          onKeyUp={settle}
          onBlur={settle}
          onWheel={(event) => passOn(new WheelEvent("wheel", event))}
        />
      ))}
      <output class="edit-handle-words" hidden={!words.value}>
        {words.value && unbroken(words.value + error)}
      </output>
    </div>
  );
}
