import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { attempt, client, needLayers, select, selectAlso, showMessage } from "../actions";
import type * as api from "../api/types";
import type { Point2 } from "../api/types";
import { count } from "../panels/words";
import * as state from "../state";
import {
  arrow,
  chosen,
  edgeShown,
  grid,
  keyStep,
  raisedPart,
  renumber,
  ridgeOf,
  selectAfresh,
  selectEdge,
  snapping,
  partsOf,
  toggleChosen,
  withPlan,
} from "./desk";
import { annex } from "./alike";
import { session } from "./here";
import { useNeighbours } from "./neighbours";
import { metres } from "./numbers";
import {
  addHole,
  after,
  before,
  cornerEdgesOf,
  deleteVertex,
  edgeName,
  endsOf,
  insertVertex,
  isCorner,
  moveAll,
  moveEdge,
  moveVertex,
  planArea,
  removeHole,
  profileOf,
  ringOf,
  wallsOf,
  type EdgeAt,
} from "./plan";
import { slopes } from "./profile";
import { apart } from "./corner_edges";
import { Backdrop, CornerEdges, Corners, Edges, isForward, Marks, ringPoints, ScaleBar, type Dimension, type Grip, type Grips } from "./plan_layers";
import { PlanHint, PlanTools, type Tool } from "./plan_tools";
import { fitted, panned, ruling, toMetres, zoomed } from "./sheet";
import { bare, nearestDormer, removed, structuresOf, withStructure } from "./structures";
import { bearingOf, capAbove, liftOf, turned, turnedAt, turnedBy, wallBeside, withoutTurnedRoof } from "./turned_roof";
import { turning, turnRoof } from "./turning";
import { snapDrawn, snapEdge, snapMove, snapTurn, snapVertex, surroundings, type Guide, type Snap, type Surroundings } from "./snap";
import { useSheet } from "./use_sheet";
import { contains, cross, distance, dot, middle, minus, nearestOn, plus, rotated, times, turnedLeft, unit } from "./vector";

interface Drag {
  kind: "pan" | Grip;
  at: EdgeAt;
  down: Point2; // pixels of the window: the drawing may move when messages appear
  last: Point2;
  plan: api.Plan; // at the start of the drag, as are the parts of the building
  parts: api.NamedPlan[];
  around: Surroundings;
  ridge: number; // of the part, above its base
  began: boolean;
}
/** The part as it was before a corner edge is turned. */
interface BeforeTurn {
  plan: api.Plan;
  parts: api.NamedPlan[];
  ridge: number;
}

const reachPixels = 9;
const usualAnnex = 3; // m; the height of an annex, until it is changed
export function PlanEditor() {
  const plan = state.selectedPlan.value;
  const at = state.selection.value;
  const run = state.run.value;
  const tool = useSignal<Tool>("move");
  const corner = useSignal<EdgeAt | null>(null);
  const drag = useRef<Drag | null>(null);
  const guides = useSignal<Guide[]>([]);
  const dimensions = useSignal<Dimension[]>([]);
  const spoken = useSignal("");
  const drawn = useSignal<Point2[]>([]);
  const cursor = useSignal<Point2 | null>(null);
  const sweeps = useSignal(false);
  const partner = useSignal("");
  const nudging = useRef(false);
  const nudged = useRef<BeforeTurn | null>(null);
  const held = useSignal<{ at: EdgeAt; forward: boolean } | null>(null);
  const key = `${run?.id} ${at?.building} ${at?.part}`;
  const { svg, sheet, pixels } = useSheet(key, () => (plan ? ringPoints(plan).flat() : []), 44);

  useEffect(() => {
    corner.value = null;
    chosen.value = [];
    leaveDrawing();
  }, [key]);
  useSignalEffect(() => {
    if (session.cancelled.value > 0) spoken.value = "";
  });
  useSignalEffect(() => {
    if (sweeps.value && state.run.value) void needLayers(state.run.value.id);
  });

  const { all: others, touching: touchingAll } = useNeighbours(plan, key);

  if (!plan || !at?.part || !run) return null;
  const part = at.part;
  const building = at.building;
  const now = sheet.value;
  const invalid = state.draft.value?.invalid ?? false;
  const drafted = state.draft.value?.changes.some((c) => c.building === building) ?? false;
  const structures = structuresOf(partsOf(building));
  const structure = structures.find((s) => s.id === part);
  const filled = new Set(structures.flatMap((s) => (s.host === part ? [s.ring] : [])));
  // A structure and its host are merged by deleting the structure.
  const touching = touchingAll.filter(
    (n) => n.building !== building || !structures.some((s) => (s.id === n.part && s.host === part) || (s.id === part && s.host === n.part)),
  );

  // What to snap to: not to the hole that the part itself fills.
  const solid = others.map((o) =>
    o.building === building && o.part === structure?.host ? bare(partsOf(building), o.part) : o.plan,
  );

  const snap = (event: { altKey: boolean }): Snap => ({
    reach: snapping.value && !event.altKey ? reachPixels / now.scale : 0,
    step: event.altKey ? 0.001 : 0.01,
    grid: grid.value,
  });

  // ---- changes of the plan

  const cornerMoved = (at: EdgeAt, moved: api.Plan, by: number, time: number) => {
    session.change(`corner of ${part} moved by ${metres(by)}`, withPlan(moved, drag.current?.parts), time);
    describeCorner(moved, at);
  };
  const edgeMoved = (at: EdgeAt, moved: api.Plan, by: number, time: number) => {
    session.change(`wall of ${part} moved by ${metres(Math.abs(by))}`, withPlan(moved, drag.current?.parts), time);
    describeEdge(moved, at, by);
  };
  const wholeMoved = (from: api.Plan, by: Point2, time: number) => {
    session.change(`${part} moved by ${metres(Math.hypot(...by))}`, withPlan(moveAll(from, by), drag.current?.parts), time);
    spoken.value = `moved by ${metres(Math.hypot(...by))}${structure?.dormer ? ", along its slope" : ""}`;
  };
  const once = (what: string, changed: api.Plan) => session.propose(what, withPlan(changed));

  const describeCorner = (moved: api.Plan, at: EdgeAt) => {
    const { plan: walls, numberOf } = apart(moved);
    const ring = ringOf(walls, at.ring)!;
    const i = numberOf(at.ring, at.edge);
    const p = ring.points[i]!;
    const a = ring.points[before(ring, i)]!;
    const b = ring.points[after(ring, i)]!;
    const turn = (Math.atan2(cross(minus(b, p), minus(a, p)), dot(minus(b, p), minus(a, p))) * 180) / Math.PI;
    const angle = `${((turn + 360) % 360).toFixed(1)}°`;
    dimensions.value = [
      { at: middle(a, p), text: metres(distance(a, p)) },
      { at: middle(p, b), text: metres(distance(p, b)) },
      { at: p, text: angle },
    ];
    spoken.value = `corner ${at.edge}: edges ${metres(distance(a, p))} and ${metres(distance(p, b))}, angle ${angle}`;
  };
  const describeEdge = (moved: api.Plan, at: EdgeAt, by: number) => {
    const { plan: walls, numberOf } = apart(moved);
    const ring = ringOf(walls, at.ring)!;
    const i = numberOf(at.ring, at.edge);
    const [a, b] = endsOf(walls, { ring: at.ring, edge: i })!;
    const [p] = endsOf(walls, { ring: at.ring, edge: before(ring, i) })!;
    const [, q] = endsOf(walls, { ring: at.ring, edge: after(ring, i) })!;
    const shift = `${metres(Math.abs(by))} ${by < 0 ? "outwards" : "inwards"}`;
    dimensions.value = [
      { at: middle(a, b), text: `${metres(distance(a, b))} · ${shift}` },
      { at: middle(p, a), text: metres(distance(p, a)) },
      { at: middle(b, q), text: metres(distance(b, q)) },
    ];
    spoken.value = `edge ${at.edge}: ${metres(distance(a, b))} long, moved ${shift}`;
  };
  /** The plan with another direction of a corner edge, shown and described. */
  const turnedFrom = (from: BeforeTurn, at: EdgeAt, along: Point2, time: number) => {
    const was = turnedAt(from.plan, at)!;
    const next = turned(from.plan, at, along);
    const is = turnedAt(next, at)!;
    const cap = capAbove(from.plan, from.ridge, liftOf(next, at, was.along, is.along));
    const bearing = `${bearingOf(is.along).toFixed(1)}°`;
    session.change(`roof of ${edgeName(next, at)} of ${part} turned to ${bearing}`, withPlan({ ...next, cap }, from.parts), time);
    const beside = wallBeside(next, at)!;
    // Outside of the corner, where neither its walls nor the handle are.
    const outside = times(turnedLeft(is.along), -20 / now.scale);
    dimensions.value = [{ at: plus(is.corner, outside), text: `${bearing}, ${beside.degrees.toFixed(1)}° from edge ${beside.at.edge}` }];
    spoken.value = `direction of the roof ${bearing}, ${beside.degrees.toFixed(1)}° from edge ${beside.at.edge}`;
  };
  const ridgeNow = () => ridgeOf(raisedPart.value) ?? 0;
  const quiet = () => {
    held.value = null;
    guides.value = [];
    dimensions.value = [];
  };

  const cornersOf = (at: EdgeAt, kind: Grip) => (e: EdgeAt) => {
    if (kind === "whole") return true;
    const ring = ringOf(plan, at.ring)!;
    return e.ring === at.ring && (e.edge === at.edge || (kind === "edge" && e.edge === after(ring, at.edge)));
  };

  // ---- pointer

  const down = (event: PointerEvent, kind: Drag["kind"], at: EdgeAt) => {
    if (event.button > 1) return;
    const p: Point2 = [event.clientX, event.clientY];
    const moves = event.button === 1 ? "pan" : kind;
    if (moves !== "pan" && tool.value !== "move") return;
    event.stopPropagation();
    const around =
      moves === "pan"
        ? { corners: [], edges: [] }
        : surroundings(
            plan,
            solid,
            cornersOf(at, moves),
          );
    drag.current = { kind: moves, at, down: p, last: p, plan, parts: partsOf(building), around, ridge: ridgeNow(), began: false };
  };

  // Only once something is dragged: clicks and double clicks go to their own elements.
  const capture = (event: PointerEvent) => {
    if (!svg.current!.hasPointerCapture(event.pointerId)) svg.current!.setPointerCapture(event.pointerId);
  };

  const move = (event: PointerEvent) => {
    const p: Point2 = [event.clientX, event.clientY];
    const d = drag.current;
    if (!d) {
      if (tool.value !== "move") cursor.value = drawingPoint(event, toMetres(now, pixels(event)));
      return;
    }
    if (d.kind === "pan") {
      if (d.began || distance(p, d.down) > 3) {
        d.began = true;
        capture(event);
        sheet.value = panned(now, minus(p, d.last));
      }
      d.last = p;
      return;
    }
    if (!d.began) {
      if (distance(p, d.down) <= 3) return;
      if (!session.begin([building])) {
        drag.current = null;
        return;
      }
      d.began = true;
      capture(event);
      if (d.kind === "edge" || d.kind === "turn") selectEdge(d.at);
      if (d.kind === "turn") held.value = { at: d.at, forward: isForward(turnedAt(d.plan, d.at)!) };
    }
    if (!session.active) {
      drag.current = null; // cancelled with Esc, undone, or replaced by an edit of another page
      spoken.value = "";
      quiet();
      return;
    }
    const by: Point2 = [(p[0] - d.down[0]) / now.scale, (d.down[1] - p[1]) / now.scale];
    if (d.kind === "turn") {
      const { corner: pivot, along } = turnedAt(d.plan, d.at)!;
      const to = minus(toMetres(now, pixels(event)), pivot);
      const from = minus(to, by);
      if (Math.hypot(...to) * now.scale < 8) return; // there every direction is the same
      const snapped = snapTurn(d.plan, d.at, rotated(along, Math.atan2(cross(from, to), dot(from, to))), snap(event));
      turnedFrom(d, d.at, snapped.along, event.timeStamp);
      const is = turnedAt(turned(d.plan, d.at, snapped.along), d.at)!;
      guides.value = distance(is.along, snapped.along) < 1e-6 ? snapped.guides : [];
    } else if (d.kind === "whole") wholeMoved(d.plan, snapMove(d.plan, by, snap(event)), event.timeStamp);
    else if (d.kind === "corner") {
      const from = ringOf(d.plan, d.at.ring)!.points[d.at.edge]!;
      const snapped = snapVertex(d.plan, d.at, plus(from, by), d.around, snap(event));
      guides.value = snapped.guides;
      cornerMoved(d.at, moveVertex(d.plan, d.at, snapped.at), distance(from, snapped.at), event.timeStamp);
    } else {
      const [a, b] = endsOf(d.plan, d.at)!;
      const along = unit(minus(b, a));
      if (!along) return;
      const snapped = snapEdge(d.plan, d.at, dot(by, turnedLeft(along)), d.around, snap(event));
      guides.value = snapped.guides;
      edgeMoved(d.at, moveEdge(d.plan, d.at, snapped.by), snapped.by, event.timeStamp);
    }
  };

  const up = (event: PointerEvent) => {
    const d = drag.current;
    drag.current = null;
    if (!d) return;
    if (d.kind === "pan") {
      svg.current!.focus({ preventScroll: true }); // to receive Esc and Enter
      if (!d.began && tool.value !== "move") place(drawingPoint(event, toMetres(now, pixels(event))));
      return;
    }
    if (d.began) session.commit();
    else if (d.kind === "edge" || d.kind === "turn") {
      if (event.shiftKey || event.ctrlKey || event.metaKey) toggleChosen(d.at);
      else selectEdge(d.at);
      corner.value = null;
    } else if (d.kind === "corner") corner.value = d.at;
    quiet();
  };
  const broken = () => {
    if (drag.current?.began && drag.current.kind !== "pan") session.cancel();
    drag.current = null;
    quiet();
  };

  // ---- keyboard

  const nudge = (event: KeyboardEvent, at: EdgeAt, kind: Grip): boolean => {
    const by = arrow(event);
    if (!by) return false;
    event.preventDefault();
    event.stopPropagation();
    if (!nudging.current) {
      if (!session.begin([building])) return true;
      nudging.current = true;
    }
    if (kind === "whole") {
      wholeMoved(plan, by, event.timeStamp);
      return true;
    }
    if (kind === "turn") {
      nudged.current ??= { plan, parts: partsOf(building), ridge: ridgeNow() };
      const degrees = event.shiftKey ? 5 : event.altKey ? 0.1 : 0.5;
      const next = turnedBy(plan, at, Math.sign(by[0] + by[1]) * degrees);
      turnedFrom(nudged.current, at, turnedAt(next, at)!.along, event.timeStamp);
      return true;
    }
    if (kind === "corner") {
      const p = ringOf(plan, at.ring)!.points[at.edge]!;
      const to: Point2 = [Math.round((p[0] + by[0]) * 1e9) / 1e9, Math.round((p[1] + by[1]) * 1e9) / 1e9];
      cornerMoved(at, moveVertex(plan, at, to), keyStep(event), event.timeStamp);
      return true;
    }
    const [a, b] = endsOf(plan, at)!;
    const along = unit(minus(b, a));
    const inwards = along ? dot(by, turnedLeft(along)) / keyStep(event) : 0;
    if (Math.abs(inwards) > 0.1) {
      const distanceMoved = Math.sign(inwards) * keyStep(event);
      edgeMoved(at, moveEdge(plan, at, distanceMoved), distanceMoved, event.timeStamp);
    }
    return true;
  };
  const settleNudge = () => {
    if (!nudging.current) return;
    nudging.current = false;
    nudged.current = null;
    session.commit();
    quiet();
  };
  const onKey = (event: KeyboardEvent, at: EdgeAt, kind: Grip) => {
    if (event.ctrlKey || event.metaKey || nudge(event, at, kind)) return;
    const taken = () => {
      event.preventDefault();
      event.stopPropagation();
    };
    if (event.key === "Delete" || event.key === "Backspace") {
      if (kind === "edge") return;
      taken();
      if (kind === "turn") removeTurn(at);
      else if (kind === "corner") removeCorner(at);
      else remove();
    } else if (kind === "whole") return;
    else if (event.key === "Insert" && kind !== "turn") {
      taken();
      insertAt(at, middle(...endsOf(plan, at)!));
    } else if ((event.key === "Enter" || event.key === " ") && (kind === "edge" || kind === "turn")) {
      taken();
      if (event.key === " " && event.shiftKey) toggleChosen(at);
      else selectEdge(at);
    }
  };
  const onSheetKey = (event: KeyboardEvent) => {
    if (event.key === "Escape") {
      if (drag.current || nudging.current) {
        event.stopPropagation();
        nudging.current = false;
        nudged.current = null;
        broken();
        session.cancel();
      } else if (tool.value !== "move") {
        event.stopPropagation();
        leaveDrawing();
      } else if (session.cancel()) event.stopPropagation();
      return;
    }
    if (tool.value === "move") {
      if (event.key === "+" || event.key === "-") {
        event.stopPropagation();
        sheet.value = zoomed(now, [now.width / 2, now.height / 2], event.key === "+" ? 1.25 : 0.8);
      }
      return;
    }
    const by = arrow(event);
    if (by) cursor.value = plus(cursor.value ?? now.centre, by);
    else if (event.key === " ") place(cursor.value ?? now.centre);
    else if (event.key === "Enter") finish();
    else if (event.key === "Backspace") drawn.value = drawn.value.slice(0, -1);
    else return;
    event.preventDefault();
    event.stopPropagation();
    if (by) spoken.value = `at ${cursor.value!.map((v) => v.toFixed(2)).join(", ")}`;
  };

  // ---- corners, courtyards, splitting

  const removeTurn = (at: EdgeAt) => {
    const changed = withoutTurnedRoof(plan, at);
    if (!changed || !once(`corner edge of ${part} removed`, changed.plan)) return;
    selectAfresh(changed.at);
    spoken.value = `corner edge removed; its roof is that of edge ${changed.at.edge}`;
  };
  const removeCorner = (at: EdgeAt) => {
    const changed = deleteVertex(plan, at);
    if (!changed)
      showMessage({
        severity: "warning",
        code: "edit-last-corners",
        message: "an outline needs at least three corners; “Delete part” removes the part",
        subject: part,
      });
    else if (once(`corner of ${part} removed`, changed)) {
      corner.value = null;
      if (cornerEdgesOf(changed).length < cornerEdgesOf(plan).length) selectAfresh(null);
      else renumber(at, false, ringOf(plan, at.ring)!.points.length);
      spoken.value = `corner ${at.edge} removed`;
    }
  };
  const insertAt = (at: EdgeAt, point: Point2) => {
    if (!once(`corner added to ${part}`, insertVertex(plan, at, point))) return;
    corner.value = { ring: at.ring, edge: at.edge + 1 };
    renumber(at, true, 0);
    spoken.value = `corner ${at.edge + 1} added`;
  };
  const doubleClick = (event: MouseEvent, at: EdgeAt) => {
    if (tool.value !== "move") return;
    event.stopPropagation();
    const [a, b] = endsOf(plan, at)!;
    insertAt(at, nearestOn(toMetres(now, pixels(event)), a, b).at);
  };
  const drawingPoint = (event: { altKey: boolean }, p: Point2): Point2 => {
    if (tool.value === "dormer") return p;
    const first = drawn.value[0];
    if (tool.value !== "split" && drawn.value.length > 2 && first && distance(first, p) < reachPixels / now.scale)
      return first;
    const around = surroundings(
      plan,
      solid,
      () => false,
    );
    const snapped = snapDrawn(plan, drawn.value, p, around, snap(event));
    guides.value = snapped.guides;
    return snapped.at;
  };
  const place = (p: Point2) => {
    if (tool.value === "dormer") return addDormer(p);
    const first = drawn.value[0];
    const last = drawn.value.at(-1);
    if (tool.value !== "split" && first && drawn.value.length > 2 && distance(first, p) < 1e-6) return finish();
    if (last && distance(last, p) < 1e-6) {
      if (tool.value === "split" && drawn.value.length > 1) finish(); // the second click of a double click
      return;
    }
    drawn.value = [...drawn.value, p];
    spoken.value = `${drawn.value.length} points`;
  };
  const finish = () => {
    const points = drawn.value;
    const which = tool.value;
    if (points.length < (which === "split" ? 2 : 3)) return;
    leaveDrawing();
    if (which === "annex") add(points);
    else if (which === "hole") once(`courtyard in ${part}`, addHole(plan, points));
    else void split(points);
  };
  function leaveDrawing() {
    tool.value = "move";
    drawn.value = [];
    cursor.value = null;
    guides.value = [];
    spoken.value = "";
  }
  const fillHole = () => {
    if (once(`courtyard of ${part} filled`, removeHole(plan, at.ring))) selectEdge(null);
  };
  const split = async (line: Point2[]) => {
    const proposal = await attempt(client.split(run.id, building, part, line));
    if (proposal) session.propose(`${part} split`, proposal.changes);
  };
  const add = (points: Point2[]) => {
    const parts = partsOf(building).map((p) => ({ id: p.id, plan: p.plan }));
    const geometry = raisedPart.value?.geometry;
    if (geometry && !structure && points.every((p) => contains(plan.outer.points, p))) {
      const { id, parts: all } = withStructure(building, parts, part, geometry, points);
      if (session.propose(`${id} on the roof of ${part}`, [{ building, parts: all }]))
        select({ building, part: id, ring: 0, edge: null });
      return;
    }
    const made = annex(building, parts, points, plan.base, Math.min(usualAnnex, plan.cap));
    if (!session.propose(`annex ${made.id}`, [{ building, parts: [...parts, made] }])) return;
    select({ building, part: made.id, ring: 0, edge: null });
  };
  const addDormer = (p: Point2) => {
    const parts = partsOf(building).map(({ id, plan }) => ({ id, plan }));
    const geometry = raisedPart.value?.geometry;
    const made = geometry ? nearestDormer(building, parts, part, geometry, p) : null;
    leaveDrawing();
    if (!made) {
      showMessage({
        severity: "warning",
        code: "edit-no-dormer",
        message: "a dormer needs a slope of 14° to 63° with free space for it, at least 1.2 m wide; there is none within 3 m of the point that is clicked",
        subject: part,
      });
      return;
    }
    if (!session.propose(`dormer ${made.id} added`, [{ building, parts: made.parts }])) return;
    state.messages.value = state.messages.value.filter((m) => m.code !== "edit-no-dormer");
    select({ building, part: made.id, ring: 0, edge: null });
    if (made.moved > 0)
      showMessage({
        severity: "warning",
        code: "edit-dormer-moved",
        message: `a dormer does not fit at the point that is clicked; it is ${metres(made.moved)} away, at the nearest place where it fits`,
        subject: made.id,
      });
  };
  const remove = () => {
    const rest = removed(partsOf(building), part);
    if (!rest.length && !window.confirm(`This is the only part of building ${building}, which is left without a model. Delete it?`))
      return;
    if (session.propose(`${part} deleted`, [{ building, parts: rest }]))
      select({ building, part: structure?.host ?? rest[0]?.id ?? null, ring: 0, edge: null });
  };
  const mergeable = touching.find((o) => `${o.building} ${o.part}` === partner.value) ?? touching[0];
  const merge = async () => {
    if (!mergeable) return;
    const other = mergeable.building !== building ? run.buildings.get(mergeable.building) : undefined;
    const emptied = other?.parts.length === 1;
    if (other) {
      const loss = emptied
        ? `Building ${other.id} loses its only part and is left without a model`
        : `Building ${other.id} loses the part ${mergeable.part}`;
      if (!window.confirm(`${loss}: it becomes a part of building ${building}. Merge them?`)) return;
    }
    const proposal = await attempt(
      client.merge(run.id, [
        { building, part },
        { building: mergeable.building, part: mergeable.part },
      ]),
    );
    if (proposal && session.propose(
        `${part} and ${mergeable.part} merged${emptied ? `; ${mergeable.building} has no model` : ""}`,
        proposal.changes,
      ))
      state.also.value = [];
  };

  const choose = (next: Tool) => {
    const same = tool.value === next;
    leaveDrawing();
    if (same) return;
    tool.value = next;
    svg.current?.focus();
  };
  const fit = () => (sheet.value = fitted(now, ringPoints(plan).flat(), 44));

  // ---- drawing

  const drawing = tool.value !== "move";
  const preview = cursor.value && drawing ? [...drawn.value, cursor.value] : drawn.value;
  const block = run.buildings.get(building)?.block;
  const sweepEdges = sweeps.value ? (state.segmentations.value.get(run.id)?.sweep_edges ?? []) : [];
  const turns = cornerEdgesOf(plan).length;
  const measures = `${planArea(plan).toFixed(1)} m² · ${wallsOf(plan).length} edges${turns ? ` · ${count(turns, "corner edge")}` : ""}`;
  const shownProfile = at.edge === null ? null : profileOf(plan, { ring: at.ring, edge: at.edge });
  const selectedAt: EdgeAt | null = shownProfile && !filled.has(at.ring) ? { ring: at.ring, edge: at.edge! } : null;
  const turn = !selectedAt ? null : isCorner(plan, selectedAt) ? "remove" : !structure?.dormer && slopes(shownProfile!).length ? "make" : null;
  const hints: Record<Tool, string> = {
    move: spoken.value || measures,
    hole: "Click the corners of the courtyard. Enter: close, Esc: cancel",
    split: "Click points of a line across the part. Enter: split, Esc: cancel",
    annex: "Click the corners of the missing part, beside this one or on its roof. Enter: close, Esc: cancel",
    dormer: "Click where the middle of the dormer's front shall be. Esc: cancel",
  };
  const instructions =
    `Plan of ${part}. Tab moves from edge to edge, ${structure ? "to the handle of the whole part, " : ""}then from corner to corner. Arrow keys move an edge or corner by 0.1 ` +
    "metres, with Shift by 1 metre, with Alt by 0.01 metres; they turn a corner edge by 0.5 degrees, with Shift by 5, with Alt by 0.1. " +
    "Insert adds a corner, Delete removes one or a corner edge, Enter on an edge shows its profile, Escape cancels.";
  const grips: Grips = { down, doubleClick, key: onKey, settle: settleNudge };

  return (
    <div class="edit-sheet">
      <PlanTools
        tool={tool.value}
        building={building}
        drafted={drafted}
        hole={at.ring > 0 && !filled.has(at.ring)}
        structure={structure ? (structure.dormer ? "dormer" : "structure") : null}
        turn={turn}
        turning={turning.value}
        onTurn={() => {
          spoken.value = "";
          if (turn === "remove") removeTurn(selectedAt!);
          else void turnRoof(selectedAt!);
        }}
        touching={touching}
        partner={mergeable}
        onTool={choose}
        onFill={fillHole}
        onDelete={remove}
        onPartner={(n) => (partner.value = `${n.building} ${n.part}`)}
        onMerge={() => void merge()}
      />
      <svg
        ref={svg}
        class={`edit-plan${drawing ? " drawing" : ""}${invalid && drafted ? " invalid" : ""}`}
        role="application"
        tabindex={0}
        aria-label={instructions}
        onPointerDown={(event) => down(event, "pan", { ring: 0, edge: 0 })}
        onPointerMove={move}
        onPointerUp={up}
        onPointerCancel={broken}
        onDblClick={() => drawing && finish()}
        onKeyDown={onSheetKey}
      >
        <Backdrop
          sheet={now}
          building={building}
          neighbours={others}
          footprint={state.scene.value?.footprints.find((f) => f.id === building)}
          sweepEdges={sweepEdges.filter((s) => s.block === block)}
          onPick={(n) => {
            if (!drawing) select({ building: n.building, part: n.part, ring: 0, edge: null });
          }}
          onAdd={(n) => selectAlso(n.building, n.part)}
        />
        <Edges
          sheet={now}
          plan={plan}
          hidden={filled}
          whole={structure ? (structure.dormer ? "dormer" : "structure") : null}
          selected={edgeShown.value}
          chosen={chosen.value}
          labelled={dimensions.value.length === 0}
          grips={grips}
        />
        <CornerEdges
          sheet={now}
          plan={plan}
          hidden={filled}
          selected={edgeShown.value}
          chosen={chosen.value}
          held={held.value}
          labelled={dimensions.value.length === 0}
          grips={grips}
        />
        <Corners sheet={now} plan={plan} hidden={filled} selected={corner.value} onFocus={(at) => (corner.value = at)} grips={grips} />
        <Marks
          sheet={now}
          guides={guides.value}
          dimensions={dimensions.value}
          drawn={preview}
          closed={tool.value === "hole" || tool.value === "annex"}
        />
        <ScaleBar sheet={now} length={ruling(now.scale, 50)} />
      </svg>
      <button type="button" class="edit-fit low" onClick={fit} title="Zoom to the part">
        Fit
      </button>
      <PlanHint words={hints[tool.value]} sweeps={sweeps} />
    </div>
  );
}
