import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type * as api from "../api/types";
import type { Point2, ProfilePoint } from "../api/types";
import { showMessage } from "../actions";
import * as state from "../state";
import {
  arrow,
  chosen,
  edgeShown,
  grid,
  keyStep,
  partBefore,
  partsOf,
  raisedPart,
  ridgeOf,
  scope,
  snapping,
  withPlan,
} from "./desk";
import { session } from "./here";
import { capOver } from "./handles";
import { cubicMetres, metres } from "./numbers";
import { changeProfiles, collinear, depthBehind, edgeName, edgesOf, inScope, opposite, profileOf, ringOf, setProfile, type EdgeAt, type Scope } from "./plan";
import {
  continued,
  degreesOf,
  deletePoint,
  gutterOf,
  gutterPoint,
  held,
  insertPoint,
  lifted,
  movePoint,
  onPart,
  pitchOf,
  same,
  slopes,
  slopeTo,
  withGutter,
  type Profile,
} from "./profile";
import { Backdrop, lineOf } from "./profile_backdrop";
import { ProfileFields } from "./profile_fields";
import { onSeveral, type Change, type PartAt } from "./several";
import { fitted, gripRadius, panned, toMetres, toPixels, zoomed } from "./sheet";
import { known, rounded, snapProfilePoint, type ProfileSnap } from "./snap";
import { count, rmse } from "../panels/words";
import { bearingOf, capAbove, liftOf, turnedAt, turnedTo, wallBeside } from "./turned_roof";
import { useSection } from "./use_section";
import { useSheet } from "./use_sheet";
import { distance, minus } from "./vector";

type CopyTo = "all" | "opposite" | "collinear" | "chosen";

interface Drag {
  kind: "pan" | "point" | "part" | "cap";
  i: number;
  down: Point2; // pixels of the window: the drawing may move when messages appear
  last: Point2;
  plan: api.Plan;
  parts: api.NamedPlan[]; // of the building, at the start of the drag
  profile: Profile;
  ridge: number; // of the part
  began: boolean;
}

const reachPixels = 8;

export function ProfileEditor() {
  const plan = state.selectedPlan.value;
  const at = edgeShown.value;
  const selection = state.selection.value;
  const profile = plan && at ? profileOf(plan, at) : null;
  const point = useSignal<number | null>(null);
  const share = useSignal(0.5);
  const copyTo = useSignal<CopyTo>("all");
  const words = useSignal("");
  const drag = useRef<Drag | null>(null);
  const nudging = useRef(false);
  const section = useSection(plan, at, share.value);
  const key = `${state.run.value?.id} ${selection?.building} ${selection?.part} ${at?.ring} ${at?.edge}`;

  const ridge = ridgeOf(raisedPart.value);
  const extent = (): Point2[] => {
    if (!plan || !profile) return [];
    const top = Math.max(Math.min(plan.cap, ridge ?? plan.cap), profile.at(-1)![1]);
    const end = profile.at(-1)![0];
    // A roof of two degrees reaches the height of the ridge far outside the part.
    const reach = Math.max(end, Math.min(continued(profile, top)?.[0] ?? end, depthBehind(plan, at!)));
    return [
      [-1.5, 0],
      [Math.max(reach, 2), top],
    ];
  };
  const { svg, sheet, pixels } = useSheet(key, extent, 34);

  useSignalEffect(() => {
    if (session.cancelled.value > 0) words.value = "";
  });
  useEffect(() => {
    point.value = null;
  }, [key]);

  if (!plan || !at || !profile || !selection?.part) return null;
  const part = selection.part;
  const now = sheet.value;
  const invalid = state.draft.value?.invalid ?? false;
  const drafted = state.draft.value?.changes.some((c) => c.building === selection.building) ?? false;
  const before = partBefore.value;
  const shownBuilding = state.shown(selection.building);
  const after = raisedPart.value;
  const old = drafted && before ? profileOf(before.plan, at) : null;
  const ghost = old && !same(old, profile) ? old : null;
  const targets = inScope(plan, at, scope.value);
  const sharing = inScope(plan, at, "sharing").length;

  // ---- changes of the plan

  const withProfile = (from: api.Plan, changed: Profile) => setProfile(from, inScope(from, at, scope.value), changed);
  const who = targets.length === 1 ? `${edgeName(plan, at)} of ${part}` : `${targets.length} edges of ${part}`;
  const typed = (what: string, changed: api.Plan) => session.propose(what, withPlan(changed));
  const typedProfile = (what: string, changed: Profile) => typed(what, withProfile(plan, changed));
  const others = state.also.value.filter((a) => a.building !== selection.building || a.part !== part);
  /** A typed value, for all selected parts. */
  const typedValue = (what: string, change: Change) => {
    const first = { building: selection.building, part, edges: inScope(plan, at, scope.value) };
    const { parts, changed, left } = onSeveral(first, others, scope.value === "part", change, partsOf);
    if (!session.propose(changed > 1 ? `${what} and ${count(changed - 1, "other part")}` : what, parts)) return;
    if (left.length)
      showMessage({
        severity: "warning",
        code: "edit-several",
        message: `${count(left.length, "selected part")} ${left.length === 1 ? "stays" : "stay"} as before: no edge that faces the same way has this value`,
        subject: left.join(", "),
      });
  };
  const ridgeAt = (of: PartAt) => ridgeOf(state.shown(of.building)?.parts.find((p) => p.id === of.part)) ?? 0;
  const typedProfiles = (what: string, change: (profile: Profile) => Profile | null) =>
    typedValue(what, (from, edges, of) => {
      // The edges of this part get the same profile, as when it is dragged.
      const changed = change(profile);
      const next = from !== plan ? changeProfiles(from, edges, change) : changed ? setProfile(from, edges, changed) : from;
      // A steeper slope rises over its run to the ridge.
      const ridge = ridgeAt(of);
      const rises = edges.map((e) => {
        const [was, is] = [profileOf(from, e)!, profileOf(next, e)!];
        const [pitch, gutter] = [pitchOf(was), gutterOf(was)];
        return gutter !== null && pitch ? ((pitchOf(is) ?? pitch) / pitch - 1) * (ridge - gutter) + (gutterOf(is) ?? gutter) - gutter : 0;
      });
      return { ...next, cap: capOver(from, ridge, Math.max(0, ...rises.filter(Number.isFinite))) };
    });
  const typedGutter = (height: number) =>
    typedValue(gutterWords(height), (from, edges, of) => {
      const changed = changeProfiles(from, edges, (p) => (gutterOf(p) === null ? null : withGutter(p, height)));
      const rises = edges.map((e) => height - (gutterOf(profileOf(from, e)!) ?? height));
      return { ...changed, cap: capOver(from, ridgeAt(of), Math.max(0, ...rises)) };
    });

  const direction = turnedAt(plan, at);
  const typedDirection = (bearing: number) => {
    const next = turnedTo(plan, at, bearing);
    const is = turnedAt(next, at)!;
    const cap = capAbove(plan, ridge ?? 0, liftOf(next, at, direction!.along, is.along));
    typed(`roof of ${who} turned to ${bearingOf(is.along).toFixed(1)}°`, { ...next, cap });
  };

  const snap = (event: { altKey: boolean }, from: api.Plan): ProfileSnap => {
    const changing = inScope(from, at, scope.value);
    const gutters = (p: Profile) => [gutterOf(p)].filter((h): h is number => h !== null);
    return {
      reach: snapping.value && !event.altKey ? reachPixels / now.scale : 0,
      step: event.altKey ? 0.001 : 0.01,
      grid: grid.value,
      slopes: known(from, at, changing, slopes),
      heights: known(from, at, changing, gutters),
    };
  };
  /** The gutter of all edges in scope, whether it is typed, dragged or moved with the keyboard: the roof moves along. */
  const withGutters = (from: api.Plan, height: number, top: number) => ({
    ...changeProfiles(from, inScope(from, at, scope.value), (p) => (gutterOf(p) === null ? null : withGutter(p, height))),
    cap: capOver(from, top, height - Math.min(height, ...inScope(from, at, scope.value).flatMap((e) => gutterOf(profileOf(from, e)!) ?? []))),
  });
  const gutterWords = (height: number) => `gutter of ${who} to ${metres(height)}`;
  const gutterMoved = (from: api.Plan, height: number, hints: string[], time: number) => {
    session.change(gutterWords(height), withPlan(withGutters(from, height, drag.current?.ridge ?? ridge ?? 0), drag.current?.parts), time);
    words.value = `gutter at ${metres(height)}; the roof moves along${hints.length ? ` · ${hints.join(", ")}` : ""}`;
  };
  const describe = (changed: Profile, i: number, hints: string[] = []) => {
    const p = changed[i]!;
    const slope = slopeTo(changed, i);
    const pitch = slope === null ? "" : slope === Infinity ? ", wall" : `, ${degreesOf(slope).toFixed(1)}°`;
    const snapped = hints.length ? ` · ${hints.join(", ")}` : "";
    words.value = `point ${i}: ${metres(p[0])} inward, ${metres(p[1])} high${pitch}${snapped}`;
  };

  // ---- pointer

  const down = (event: PointerEvent, kind: Drag["kind"], i: number) => {
    if (event.button > 1) return;
    event.stopPropagation();
    const p: Point2 = [event.clientX, event.clientY];
    drag.current = { kind: event.button === 1 ? "pan" : kind, i, down: p, last: p, plan, parts: partsOf(selection.building), profile, ridge: ridge ?? 0, began: false };
  };
  const move = (event: PointerEvent) => {
    const d = drag.current;
    if (!d) return;
    const p: Point2 = [event.clientX, event.clientY];
    if (!d.began) {
      if (distance(p, d.down) <= 3) return;
      if (d.kind !== "pan" && !session.begin([selection.building])) {
        drag.current = null;
        return;
      }
      d.began = true;
      svg.current!.setPointerCapture(event.pointerId);
    }
    if (d.kind === "pan") {
      sheet.value = panned(now, minus(p, d.last));
      d.last = p;
      return;
    }
    if (!session.active) {
      drag.current = null; // cancelled with Esc, undone, or replaced by an edit of another page
      words.value = "";
      return;
    }
    const by: Point2 = [(p[0] - d.down[0]) / now.scale, (d.down[1] - p[1]) / now.scale];
    if (d.kind === "cap") {
      const cap = Math.max(0.01, rounded(d.plan.cap + by[1], snap(event, d.plan).step));
      session.change(`cap of ${part} to ${metres(cap)}`, withPlan({ ...d.plan, cap }, d.parts), event.timeStamp);
      words.value = `cap at ${metres(cap)}`;
      return;
    }
    if (d.kind === "part") {
      const up = rounded(by[1], snap(event, d.plan).step);
      const changed = lifted(d.profile, d.i - 1, up);
      const height = changed[d.i - 1]![1];
      session.change(`roof of ${who} moved up by ${metres(up)}`, withPlan(withProfile(d.plan, changed), d.parts), event.timeStamp);
      words.value = `roof moved up by ${metres(height - d.profile[d.i - 1]![1])}; it starts at ${metres(height)}`;
      return;
    }
    const from = d.profile[d.i]!;
    const snapped = snapProfilePoint(d.profile, d.i, [from[0] + by[0], from[1] + by[1]], snap(event, d.plan));
    if (d.i === gutterPoint(d.profile)) {
      // Up and down only, and beyond the points above: they move along.
      const free = snapProfilePoint(d.profile.slice(0, d.i + 1), d.i, [from[0], from[1] + by[1]], snap(event, d.plan));
      gutterMoved(d.plan, Math.max(free.at[1], d.profile[d.i - 1]![1] + 0.01), free.words, event.timeStamp);
      return;
    }
    pointMoved(d.plan, movePoint(d.profile, d.i, snapped.at), d.i, snapped.words, event.timeStamp);
  };
  const pointMoved = (from: api.Plan, changed: Profile, i: number, hints: string[], time: number) => {
    session.change(`profile of ${who}`, withPlan(withProfile(from, changed), drag.current?.parts), time);
    describe(changed, i, hints);
  };
  const up = () => {
    const d = drag.current;
    drag.current = null;
    if (!d) return;
    if (d.kind === "point") point.value = d.i;
    if (d.kind === "pan") svg.current!.focus({ preventScroll: true }); // to receive Esc
    if (d.began && d.kind !== "pan") session.commit();
  };
  const broken = () => {
    if (drag.current?.began && drag.current.kind !== "pan") session.cancel();
    drag.current = null;
  };

  // ---- keyboard

  const nudge = (event: KeyboardEvent, change: (by: Point2) => void): boolean => {
    const by = arrow(event);
    if (!by || event.ctrlKey || event.metaKey) return false;
    event.preventDefault();
    event.stopPropagation();
    if (!nudging.current) {
      if (!session.begin([selection.building])) return true;
      nudging.current = true;
    }
    change(by);
    return true;
  };
  const settleNudge = () => {
    if (!nudging.current) return;
    nudging.current = false;
    session.commit();
  };
  const whole = (value: number) => Math.round(value * 1e9) / 1e9;
  const pointKey = (event: KeyboardEvent, i: number) => {
    const nudged = nudge(event, (by) => {
      const p = profile[i]!;
      if (i === gutterPoint(profile)) {
        const height = Math.max(whole(p[1] + by[1]), profile[i - 1]![1] + 0.01);
        if (by[1] !== 0) gutterMoved(plan, height, [], event.timeStamp);
        return;
      }
      const to = held(profile, i, [whole(p[0] + by[0]), whole(p[1] + by[1])], keyStep(event));
      pointMoved(plan, movePoint(profile, i, to), i, [], event.timeStamp);
    });
    if (nudged) return;
    if (event.key === "Delete" || event.key === "Backspace") remove(i);
    else if (event.key === "Insert") insertAfter(i);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const capKey = (event: KeyboardEvent) =>
    nudge(event, (by) => {
      const cap = Math.max(0.01, whole(plan.cap + by[1]));
      if (by[1] !== 0) session.change(`cap of ${part} to ${metres(cap)}`, withPlan({ ...plan, cap }), event.timeStamp);
      words.value = `cap at ${metres(cap)}`;
    });
  const onSheetKey = (event: KeyboardEvent) => {
    if (event.key === "Escape") {
      const busy = drag.current !== null || nudging.current;
      drag.current = null;
      nudging.current = false;
      if (session.cancel() || busy) event.stopPropagation();
    } else if (event.key === "+" || event.key === "-") {
      event.stopPropagation();
      sheet.value = zoomed(now, [now.width / 2, now.height / 2], event.key === "+" ? 1.25 : 0.8);
    }
  };

  // ---- points

  const remove = (i: number) => {
    const changed = deletePoint(profile, i);
    if (!changed) {
      words.value = "a profile needs at least its foot and one more point";
      return;
    }
    point.value = null;
    typedProfile(`profile point of ${who} removed`, changed);
  };
  const insertAfter = (i: number) => {
    const p = profile[i]!;
    const next = profile[i + 1] ?? continued(profile, p[1] + 1) ?? ([p[0], p[1] + 1] as ProfilePoint);
    const between: ProfilePoint = [(p[0] + next[0]) / 2, (p[1] + next[1]) / 2];
    typedProfile(`profile point added to ${who}`, insertPoint(profile, i + 1, between));
    point.value = i + 1;
  };
  const doubleClick = (event: MouseEvent, i: number) => {
    event.stopPropagation();
    const on = onPart(profile, i, toMetres(now, pixels(event)));
    if (!on) return;
    typedProfile(`profile point added to ${who}`, insertPoint(profile, i, on));
    point.value = i;
  };

  // ---- copying

  const copyTargets: Record<CopyTo, EdgeAt[]> = {
    all: edgesOf(plan),
    opposite: opposite(plan, at),
    collinear: collinear(plan, at),
    chosen: chosen.value.filter((e) => ringOf(plan, e.ring)?.points[e.edge]),
  };
  const copyNames: Record<CopyTo, string> = {
    all: "all edges",
    opposite: "opposite edges",
    collinear: "collinear edges",
    chosen: "selected edges",
  };
  const copy = () => {
    const edges = copyTargets[copyTo.value];
    if (edges.length)
      typed(
        `profile of ${edgeName(plan, at)} of ${part} copied to ${copyNames[copyTo.value]}`,
        setProfile(plan, [...edges, at], profile),
      );
  };

  // ---- drawing

  const top = Math.max(plan.cap, profile.at(-1)![1]);
  const line = (a: ProfilePoint, b: ProfilePoint) => lineOf(now, a, b);
  const [left] = toMetres(now, [0, 0]);
  const [right] = toMetres(now, [now.width, now.height]);
  const extended = continued(profile, top);
  const places = profile.map((p) => toPixels(now, p));
  const ghostEnd = ghost && continued(ghost, top);

  const instructions =
    `Profile of ${edgeName(plan, at)} of ${part}. Tab moves from point to point. Arrow keys move a point by 0.1 metres, with ` +
    "Shift by 1 metre, with Alt by 0.01 metres. Insert adds a point, Delete removes one, Escape cancels.";

  return (
    <div class="edit-sheet">
      <div class="edit-tools" role="toolbar" aria-label="Profile">
        <label>
          Apply to
          <select
            aria-label="Edges that a change of the profile applies to"
            value={scope.value}
            onChange={(event) => (scope.value = event.currentTarget.value as Scope)}
          >
            <option value="edge">{edgeName(plan, at)} only</option>
            <option value="sharing">{count(sharing, "edge")} with this profile</option>
            <option value="part">all {edgesOf(plan).length} edges</option>
          </select>
        </label>
        <span class="edit-group">
          <button
            type="button"
            disabled={copyTargets[copyTo.value].length === 0}
            onClick={copy}
            title="Copy this profile to other edges. Ctrl or Shift and click selects single edges in the plan"
          >
            Copy to
          </button>
          <select
            aria-label="Edges to copy the profile to"
            value={copyTo.value}
            onChange={(event) => (copyTo.value = event.currentTarget.value as CopyTo)}
          >
            {(Object.keys(copyNames) as CopyTo[]).map((to) => (
              <option key={to} value={to}>
                {copyNames[to]} ({copyTargets[to].length})
              </option>
            ))}
          </select>
        </span>
      </div>
      <svg
        ref={svg}
        class={`edit-profile${invalid && drafted ? " invalid" : ""}`}
        role="application"
        tabindex={0}
        aria-label={instructions}
        onPointerDown={(event) => down(event, "pan", 0)}
        onPointerMove={move}
        onPointerUp={up}
        onPointerCancel={broken}
        onKeyDown={onSheetKey}
      >
        <Backdrop
          sheet={now}
          section={section.value}
          ghost={ghost && (ghostEnd ? [...ghost, ghostEnd] : ghost)}
          ridge={ridge !== null && ridge < plan.cap - 0.02 ? ridge : null}
        />
        <g class="cap">
          <line class="seen" {...line([left, plan.cap], [right, plan.cap])} />
          <line
            class="grip"
            {...line([left, plan.cap], [right, plan.cap])}
            tabindex={0}
            role="slider"
            aria-orientation="vertical"
            aria-label="Cap height, metres"
            aria-valuenow={Number(plan.cap.toFixed(2))}
            onPointerDown={(event) => down(event, "cap", 0)}
            onKeyDown={capKey}
            onKeyUp={settleNudge}
            onBlur={settleNudge}
          />
          <text x={now.width - 50} y={toPixels(now, [0, plan.cap])[1] - 4}>
            cap {metres(plan.cap)}
          </text>
        </g>
        {profile.slice(1).map((p, n) => {
          const i = n + 1;
          const a = profile[n]!;
          const slope = slopeTo(profile, i);
          const lifts = slope !== Infinity && i > 1;
          return (
            <g key={i} class={`part${lifts ? " lifts" : ""}`}>
              <line class="seen" {...line(a, p)} />
              <line
                class="grip"
                {...line(a, p)}
                onPointerDown={(event) => lifts && down(event, "part", i)}
                onDblClick={(event) => doubleClick(event, i)}
              />
            </g>
          );
        })}
        {extended && (
          <g class="part onwards">
            <line class="seen" {...line(profile.at(-1)!, extended)} />
            <line
              class="grip"
              {...line(profile.at(-1)!, extended)}
              onDblClick={(event) => doubleClick(event, profile.length)}
            />
          </g>
        )}
        {profile.map((p, i) => {
          const [cx, cy] = places[i]!;
          if (i === 0) return <rect key={i} class="foot" x={cx - 4} y={cy - 4} width={8} height={8} />;
          const slope = slopeTo(profile, i);
          const pitchWords = slope === Infinity ? "top of a wall" : `pitch ${degreesOf(slope!).toFixed(1)} degrees below`;
          return (
            <g key={i} class={`corner${point.value === i ? " selected" : ""}`}>
              <circle class="seen" cx={cx} cy={cy} r={4.5} />
              <circle
                class="grip"
                cx={cx}
                cy={cy}
                r={gripRadius([cx, cy], places, 10)}
                tabindex={0}
                role="button"
                aria-label={`point ${i}, ${p[0].toFixed(2)} metres inward, ${p[1].toFixed(2)} metres high, ${pitchWords}`}
                onPointerDown={(event) => down(event, "point", i)}
                onFocus={() => (point.value = i)}
                onKeyDown={(event) => pointKey(event, i)}
                onKeyUp={settleNudge}
                onBlur={settleNudge}
              />
            </g>
          );
        })}
      </svg>
      <button
        type="button"
        class="edit-fit"
        onClick={() => (sheet.value = fitted(now, extent(), 34))}
        title="Zoom to the profile"
      >
        Fit
      </button>
      <ProfileFields
        plan={plan}
        part={part}
        direction={direction && bearingOf(direction.along)}
        beside={direction && wallBeside(plan, at)}
        onDirection={typedDirection}
        profile={profile}
        who={who}
        point={point.value}
        share={share.value}
        onShare={(value) => (share.value = value)}
        several={others.length + 1}
        onPlan={typedValue}
        onProfile={typedProfiles}
        onMove={(i, to) =>
          i === gutterPoint(profile) && to[0] === profile[i]![0]
            ? typedGutter(to[1])
            : typedProfiles(`profile of ${who}`, (p) => {
                if (p.length !== profile.length) return null;
                const [inward, height] = profile[i]!;
                return movePoint(p, i, [to[0] === inward ? p[i]![0] : to[0], to[1] === height ? p[i]![1] : to[1]]);
              })
        }
        onGutter={typedGutter}
        onRemove={remove}
      />
      <dl class="edit-numbers" aria-live="polite">
        <div>
          <dt>Ridge height</dt>
          <dd>{metres(ridge)}</dd>
        </div>
        <div>
          <dt>Volume</dt>
          <dd>{changed(cubicMetres, drafted ? before?.volume : undefined, after?.volume)}</dd>
        </div>
        <div>
          <dt title="Root mean squared vertical error of the building over its footprint; ground without a model counts as missed">
            RMSE
          </dt>
          <dd>{changed(rootMetres, drafted ? state.selectedBuilding.value?.mse : undefined, shownBuilding?.mse)}</dd>
        </div>
        <div class="edit-said">{words.value}</div>
      </dl>
    </div>
  );
}

const rootMetres = (mse: number | null | undefined) => metres(rmse(mse), 3);

/** "before → after" while there is a draft, with one unit. */
function changed(
  text: (value: number | null | undefined) => string,
  before: number | null | undefined,
  after: number | null | undefined,
) {
  if (before === undefined || before === after) return text(after);
  return `${text(before).replace(/ m[²³]?$/, "")} → ${text(after)}`;
}
