// Roofs of a part, of selected parts or of a row: shown in the view with their error, and saved when they are kept.
import { useEffect, useRef } from "preact/hooks";
import { count, rmse, said } from "../panels/words";
import * as state from "../state";
import { edgeShown, partsOf, shortId } from "./desk";
import { planeOf } from "./fitting";
import { session } from "./here";
import { metres } from "./numbers";
import { type Choice, type Reach, chosenOffer, discardShown, keepShown, leave, losing, making, reach, show, shownChoice } from "./offers";
import { edgeName, isCorner, profileOf } from "./plan";
import { gutterOf, slopes } from "./profile";
import { shapes } from "./shapes";
import { structureAt } from "./structures";

const restMilliseconds = 120; // of the pointer over a shape, until its roof is shown

/** Roof shapes for the selected part, for all selected parts, or for the row that the part is in. */
export function Roofs() {
  const at = state.selection.value!;
  const also = state.also.value;
  const box = useRef<HTMLDivElement>(null);
  const resting = useRef<ReturnType<typeof setTimeout>>();
  const entered = useRef<Choice | null>(null); // under the pointer, which has not moved since
  if (reach.value === "selected" && !also.length) reach.value = "part";
  const key = `${state.run.value?.id} ${at.building} ${at.part} ${also.map((a) => a.part).join(" ")} ${reach.value}`;
  // A roof that is shown is that of the parts that were selected: it ends with the selection, and with the panel.
  useEffect(
    () => () => {
      clearTimeout(resting.current);
      discardShown();
    },
    [key],
  );
  const structure = structureAt(partsOf(at.building), at.part);
  const alone = structure !== null;
  const scanned = state.sceneRead.value;
  const edge = at.edge === null ? null : edgeShown.value;
  const profile = edge && state.selectedPlan.value ? profileOf(state.selectedPlan.value, edge) : null;
  const sides = edge && profile ? planeOf(state.selectedPlan.value!, edge).length : 0;
  const choices: { choice: Choice; name: string; meaning: string }[] = shapes.map(({ shape, name, meaning }) => ({ choice: shape, name, meaning }));
  if (scanned && (!alone || structure.dormer))
    choices.push({
      choice: "fitted",
      name: "Fit",
      meaning: alone ? "Move the dormer to where the scan has it: its place on the slope, its width, height and pitch" : "Move the roof as it is to where the scan has it: gutters, pitches and height",
    });
  if (scanned && !alone && profile && gutterOf(profile) !== null && slopes(profile).length)
    choices.push({
      choice: "plane",
      name: "Fit plane",
      meaning: `Move the roof plane of ${edgeName(state.selectedPlan.value!, edge!)} to where the scan has it: its ${isCorner(state.selectedPlan.value!, edge!) ? "gutter, pitch and direction" : "gutter and pitch"}. Other planes stay${sides > 1 ? `. It goes along ${sides} edges on one line` : ""}`,
    });
  const shown = shownChoice.value;
  const current = making.value ?? chosenOffer.value?.choice ?? choices[0]!.choice;

  const over = (event: PointerEvent, choice: Choice) => {
    // Fitting by measuring takes seconds: only on request.
    if (event.pointerType !== "mouse" || event.buttons || choice === "plane" || (alone && choice === "fitted")) return;
    if (event.type === "pointerenter") entered.current = choice;
    // Not where a panel appears under a pointer that rests.
    if (entered.current !== choice || (event.movementX === 0 && event.movementY === 0)) return;
    entered.current = null;
    clearTimeout(resting.current);
    resting.current = setTimeout(() => {
      if (!making.value && shownChoice.value !== choice) void show(choice, false);
    }, restMilliseconds);
  };
  const gone = () => {
    clearTimeout(resting.current);
    leave();
  };
  const choose = (choice: Choice) => {
    clearTimeout(resting.current);
    void show(choice, true);
  };
  const pressed = (event: KeyboardEvent, choice: Choice) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const by = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (by) {
      const place = choices.findIndex((c) => c.choice === choice);
      const next = choices[(place + by + choices.length) % choices.length]!;
      box.current?.querySelector<HTMLElement>(`[data-choice="${next.choice}"]`)?.focus();
      choose(next.choice);
    } else if (event.key === "Enter" && (making.value ?? chosenOffer.value?.choice) === choice) keepShown();
    else if (event.key === "Escape" && making.value) discardShown();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div class="shapes" role="group" aria-label="Roof shape" ref={box} onPointerLeave={gone}>
      <span class="quiet">Roof</span>
      {choices.map(({ choice, name, meaning }) => (
        <button
          key={choice}
          type="button"
          class="small"
          data-choice={choice}
          title={`${meaning}. Shown first, with its error; Enter or “Keep” saves it`}
          aria-pressed={shown === choice}
          aria-busy={making.value === choice}
          tabIndex={current === choice || (!choices.some((c) => c.choice === current) && choice === choices[0]!.choice) ? 0 : -1}
          onPointerEnter={(event) => over(event, choice)}
          onPointerMove={(event) => over(event, choice)}
          onPointerLeave={() => clearTimeout(resting.current)}
          onClick={() => choose(choice)}
          onKeyDown={(event) => pressed(event, choice)}
        >
          {name}
        </button>
      ))}
      {!alone && <select
        aria-label="Parts that get the roof"
        title="A row is what is joined by walls; its ridge runs through all houses"
        value={reach.value}
        onChange={(e) => (reach.value = e.currentTarget.value as Reach)}
      >
        <option value="part">this part</option>
        {also.length > 0 && <option value="selected">selected parts ({also.length + 1})</option>}
        <option value="row">the whole row</option>
      </select>}
      {!alone && also.length > 0 && (
        <button
          type="button"
          class="small"
          title="Give the other selected parts the roof of this part: with as many corners, its profiles edge by edge; else its shape, eaves and pitch"
          aria-pressed={shown === "alike"}
          data-choice="alike"
          onClick={() => choose("alike")}
          onKeyDown={(event) => {
            if (event.key !== "Enter" || (making.value ?? chosenOffer.value?.choice) !== "alike") return;
            event.preventDefault();
            keepShown();
          }}
        >
          Make alike
        </button>
      )}
    </div>
  );
}

const rootMetres = (mse: number | null | undefined) => metres(rmse(mse), 3);

/** The roof that is shown, for screen readers: an element that is always there, so that its changes are read. */
export function OfferedWords() {
  const draft = state.draft.value;
  const shown = shownChoice.value;
  let words = making.value && !shown ? "fitting to the scan" : "";
  if (session.phase.value === "offered" && draft && shown && !draft.pending) {
    const errors = draft.changes.map(({ building }) => {
      const [was, is] = [state.run.value?.buildings.get(building)?.mse, draft.raised.get(building)?.mse];
      return was == null || is == null ? "" : `error ${rootMetres(was)}, then ${rootMetres(is)}`;
    });
    const doubts = session.doubts.map(said).join(". ");
    words = `${draft.what}, not saved: ${errors.length === 1 ? errors[0] : count(errors.length, "building")}. ${session.reason.value ? said(session.reason.value) : doubts}`;
  }
  return (
    <div class="edit-live" role="status">
      {words}
    </div>
  );
}

/** The roof that is shown: the error of each building before and after, what is worse for the scan, and the choice. */
export function Offered() {
  const draft = state.draft.value;
  const shown = shownChoice.value;
  if (making.value && !shown)
    return (
      <div class="edit-reason offered">
        <span>fitting to the scan …</span>
        <button type="button" onClick={discardShown}>
          Cancel
        </button>
      </div>
    );
  if (session.phase.value !== "offered" || !draft || !shown) return null;
  const rows = draft.changes.map(({ building }) => ({
    building,
    before: state.run.value?.buildings.get(building)?.mse,
    after: draft.pending ? undefined : draft.raised.get(building)?.mse,
  }));
  const worse = rows.filter((r) => r.before != null && r.after != null && rmse(r.after)! > rmse(r.before)! + 0.0005).length;
  const better = rows.filter((r) => r.before != null && r.after != null && rmse(r.after)! < rmse(r.before)! - 0.0005).length;
  const doubts = session.doubts;
  const halves = doubts.filter((d) => d.code === "edit-error").length;
  const gain = (r: (typeof rows)[number]) => (rmse(r.after) ?? 0) - (rmse(r.before) ?? 0);
  rows.sort((a, b) => gain(b) - gain(a));
  const reason = session.reason.value;
  const chosen = chosenOffer.value?.choice === shown;
  const done = (act: () => void) => () => {
    const last = document.querySelector<HTMLElement>(`.shapes [data-choice="${shown}"]`);
    act();
    last?.focus();
  };
  return (
    <div class={`edit-reason offered${doubts.length || reason ? " doubtful" : ""}`}>
      <div class="offered-text">
        <b>{draft.what.slice(0, 1).toUpperCase() + draft.what.slice(1)}:</b>{" "}
        {rows.length === 1 ? (
          <ErrorChange {...rows[0]!} />
        ) : draft.pending ? (
          <span>…</span>
        ) : (
          <span>
            {count(rows.length, "building")}: {better} with a smaller error, {worse} with a larger one
          </span>
        )}
        {reason && <p>{said(reason)}</p>}
        {doubts
          .filter((d) => rows.length === 1 || d.code !== "edit-error")
          .map((d) => (
            <p key={d.subject + d.message}>
              {said(d)}
              {rows.length > 1 && ` (${d.subject})`}
            </p>
          ))}
        {rows.length > 1 && halves > 0 && <p>The error rises by half or more for {count(halves, "building")}.</p>}
        {losing.value.length > 0 && <p>{count(losing.value.length, "dormer")} would be removed: the roof has no slope for {losing.value.length > 1 ? "them" : "it"} any more.</p>}
      </div>
      {rows.length > 1 && !draft.pending && (
        <ul class="offered-list" tabIndex={0} aria-label="Error of each building before and after">
          {rows.map((row) => (
            <li key={row.building}>
              <span title={row.building}>{shortId(row.building)}</span> <ErrorChange {...row} />
            </li>
          ))}
        </ul>
      )}
      {chosen ? (
        <span class="edit-group">
          <button type="button" class="keep" disabled={draft.invalid} onClick={done(keepShown)} title="Save this roof (Enter)" aria-keyshortcuts="Enter">
            {doubts.some((d) => d.code === "edit-above") ? "Keep all the same" : "Keep"}
          </button>
          <button type="button" onClick={done(discardShown)} title="Go back to the roof before (Esc)" aria-keyshortcuts="Escape">
            Discard
          </button>
        </span>
      ) : (
        <span class="quiet">not saved; click to choose it</span>
      )}
    </div>
  );
}

function ErrorChange({ before, after }: { before: number | null | undefined; after: number | null | undefined }) {
  if (before == null && after == null) return <span class="offered-error">{after === undefined ? "…" : "no scan there to measure the error"}</span>;
  const [was, is] = [rmse(before), rmse(after)];
  const sign = was == null || is == null || Math.abs(is - was) < 0.0005 ? "" : is < was ? " falls" : " rises";
  return (
    <span class={`offered-error${sign}`} title="Root mean squared vertical error of the building over its footprint, before and after">
      RMSE {rootMetres(before).replace(/ m$/, "")} → {after === undefined ? "…" : rootMetres(after)}
    </span>
  );
}
