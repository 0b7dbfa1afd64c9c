import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { compareWith, select } from "../actions";
import { keep, kept } from "../keep";
import * as state from "../state";
import { said } from "../panels/words";
import "./edit.css";
import { selectEdge, shortId, shortName } from "./desk";
import { session, showDraft } from "./here";
import { edgeName } from "./plan";
import { PlanEditor } from "./plan_editor";
import { ProfileEditor } from "./profile_editor";
import { keepShown } from "./offers";
import { Offered, OfferedWords, Roofs } from "./roofs";
import { structuresOf } from "./structures";
import { divided } from "../view/layers";

/** The editors of the selected part: its plan above, the profile of its selected edge below. */
export function EditPanel() {
  const share = useSignal(Math.min(0.8, Math.max(0.2, kept("local", "editSplit", 0.47))));
  const box = useRef<HTMLDivElement | null>(null);
  const dragging = useSignal(false);

  useEffect(() => {
    const escape = (event: KeyboardEvent) => {
      // Enter keeps a roof that is shown, unless the element that has the focus has another use for it.
      if (event.key === "Enter" && session.phase.value === "offered" && (event.target === document.body || event.target instanceof HTMLCanvasElement)) {
        event.stopPropagation();
        keepShown();
        return;
      }
      // Esc cancels a drag whatever has the focus, and takes back a roof that is shown; it discards an unsaved draft only if no
      // element has the focus.
      const free = event.target === document.body || box.current?.contains(event.target as Node);
      if (event.key !== "Escape") return;
      const typing = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
      if (
        session.phase.value === "changing" || (session.phase.value === "offered" && !typing)
          ? session.cancel()
          : free && event.target === document.body && session.cancel()
      )
        event.stopPropagation();
    };
    window.addEventListener("keydown", escape, true);
    return () => window.removeEventListener("keydown", escape, true);
  }, []);

  const put = (value: number) => {
    share.value = Math.min(0.8, Math.max(0.2, value));
    keep("local", "editSplit", share.value);
  };
  const at = state.selection.value;
  const building = state.selectedBuilding.value;
  if (!at || !building)
    return (
      <section class="edit-panel empty">
        {state.draft.value && (
          <header class={`edit-bar${state.draft.value.invalid ? " invalid" : " held"}`}>
            <Held />
          </header>
        )}
        <p>
          {state.run.value
            ? "Select a building in the 3D view or in the list of buildings to edit its plan and profiles."
            : "Run a reconstruction first. Its buildings can be edited here."}
        </p>
      </section>
    );
  if (!at.part || building.parts.length === 0)
    return (
      <section class="edit-panel empty">
        <p>
          {building.id} has no model. {building.reasons[0] && said(building.reasons[0])}
        </p>
      </section>
    );
  return (
    <section class="edit-panel" aria-label="Plan and profile">
      <EditBar />
      <div class="edit-split" ref={box} style={{ gridTemplateRows: `${share.value}fr 9px ${1 - share.value}fr` }}>
        <PlanEditor />
        <div
          class={`edit-splitter${dragging.value ? " dragging" : ""}`}
          role="separator"
          aria-orientation="horizontal"
          aria-label="Height of the plan"
          aria-valuenow={Math.round(share.value * 100)}
          aria-valuemin={20}
          aria-valuemax={80}
          tabIndex={0}
          onPointerDown={(event) => {
            event.currentTarget.setPointerCapture(event.pointerId);
            dragging.value = true;
          }}
          onPointerMove={(event) => {
            const area = box.current?.getBoundingClientRect();
            if (dragging.value && area) put((event.clientY - area.top) / area.height);
          }}
          onPointerUp={() => (dragging.value = false)}
          onPointerCancel={() => (dragging.value = false)}
          onKeyDown={(event) => {
            if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
            event.preventDefault();
            put(share.value + (event.key === "ArrowUp" ? -0.03 : 0.03));
          }}
        />
        <ProfileEditor />
      </div>
    </section>
  );
}

const words = {
  idle: "",
  changing: "",
  offered: "not saved",
  checking: "checking …",
  saving: "saving …",
  held: "",
};

/** Divides the view between the run and what it was before its edits, or shows the run alone. */
async function showBefore(on: boolean) {
  await compareWith(on ? state.beforeOf(state.run.value!.id) : null);
  divided.value = state.isBefore(state.other.value?.id) ? 0.5 : null;
}

/** The selected part, and the state of its change. */
function EditBar() {
  const at = state.selection.value!;
  const building = state.selectedBuilding.value!;
  const draft = state.draft.value;
  const plan = state.selectedPlan.value;
  const phase = session.phase.value;
  const held = phase === "held";
  const compared = state.isBefore(state.other.value?.id);
  const dormers = new Set(structuresOf(building.parts).flatMap((s) => (s.dormer ? [s.id] : [])));
  return (
    <header class={`edit-bar${draft?.invalid ? " invalid" : held ? " held" : ""}`}>
      <div class="edit-what">
        <b title={building.id}>{shortId(building.id)}</b>
        {building.parts.length > 1 ? (
          <select
            aria-label="Part"
            value={at.part ?? ""}
            onChange={(event) => {
              select({ building: at.building, part: event.currentTarget.value, ring: 0, edge: null });
            }}
          >
            {building.parts.map((p) => (
              <option key={p.id} value={p.id}>
                {shortName(building.id, p.id) + (dormers.has(p.id) ? ", dormer" : "")}
              </option>
            ))}
          </select>
        ) : (
          <span title={at.part ?? undefined}>{shortName(building.id, at.part ?? "")}</span>
        )}
        {building.edited && <span class="edit-mark">edited</span>}
        {(compared || (building.edited && !state.run.value!.large)) && (
          <button
            type="button"
            aria-pressed={compared}
            title="Models after the edits on the left, before them on the right of a boundary that can be dragged"
            onClick={() => void showBefore(!compared)}
          >
            Before edits
          </button>
        )}
        <span class="edit-state" aria-live="polite">
          {words[phase]}
        </span>
        {at.edge !== null && (
          <button type="button" class="edit-quiet" onClick={() => selectEdge(null)} title="Deselect the edge">
            {plan ? edgeName(plan, { ring: at.ring, edge: at.edge }) : `edge ${at.edge}`} ×
          </button>
        )}
      </div>
      <Roofs />
      <Held />
      <Offered />
      <OfferedWords />
    </header>
  );
}

/** Why a change is not saved, and what can be done. */
function Held() {
  const draft = state.draft.value;
  const reason = session.reason.value;
  const held = session.phase.value === "held";
  if (!draft || (!reason && !held) || session.phase.value === "offered") return null;
  const selected = state.selection.value?.building;
  const elsewhere = draft.changes.every((c) => c.building !== selected);
  return (
    <div class="edit-reason" role="alert">
      <span>
        {elsewhere && <b>{draft.changes.map((c) => shortId(c.building)).join(", ")}: </b>}
        {reason ? (
          <>
            {said(reason)} <code>{reason.code}</code>
          </>
        ) : (
          "This change is not saved yet."
        )}
      </span>
      {held && (
        <span class="edit-group">
          {elsewhere && (
            <button type="button" onClick={() => showDraft()}>
              Show
            </button>
          )}
          {!draft.invalid && (
            <button type="button" onClick={() => session.again()}>
              Save
            </button>
          )}
          <button type="button" onClick={() => session.cancel()} title="Discard the change (Esc)">
            Discard
          </button>
        </span>
      )}
    </div>
  );
}
