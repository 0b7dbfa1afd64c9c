// The panel Review: one building after the other, the worst first.
import { useEffect, useRef } from "preact/hooks";
import { attempt, client, offer } from "../actions";
import type * as api from "../api/types";
import { reasonsOf } from "../panels/reasons";
import { count, fixed, grouped, metres, rmse, sentence } from "../panels/words";
import * as state from "../state";
import { besideWanted } from "../view/layers";
import { placeInWords, progress, standing, sureInWords } from "./queue";
import * as review from "./review";
import "./review.css";

const orders: { order: review.Order; name: string }[] = [
  { order: "worst", name: "worst first" },
  { order: "list", name: "as in the list of buildings" },
  { order: "view", name: "in the view, worst first" },
];

export function ReviewPanel() {
  if (!state.run.value) return <p class="quiet pad">No run is open.</p>;
  return (
    <section class="panel review" aria-label="Review">
      <Head />
      <Case />
      <Files />
    </section>
  );
}

function Head() {
  const ids = review.queue.value;
  const { open, lapsed, later, right, wrong } = progress(ids, review.decisions.value);
  const left = open + lapsed + later;
  const parts = [later > 0 && `${grouped(later)} later`, lapsed > 0 && `${grouped(lapsed)} lapsed`].filter(Boolean);
  return (
    <header class="review-head">
      <label>
        Order{" "}
        <select
          aria-label="Order of the review"
          value={review.order.value}
          onChange={(e) => review.setOrder(e.currentTarget.value as review.Order)}
        >
          {orders.map(({ order, name }) => (
            <option key={order} value={order}>
              {name}
            </option>
          ))}
        </select>
      </label>
      <label class="review-beside">
        <input
          type="checkbox"
          checked={besideWanted.value}
          onChange={(e) => (besideWanted.value = e.currentTarget.checked)}
        />{" "}
        Scan beside the model
      </label>
      <p class="review-count" role="status">
        <b>{grouped(right + wrong)}</b> done ({grouped(right)} right, {grouped(wrong)} wrong), <b>{grouped(left)}</b> left
        {parts.length > 0 && ` (${parts.join(", ")})`}
      </p>
      <progress aria-label="Decided buildings" max={Math.max(1, ids.length)} value={right + wrong} />
    </header>
  );
}

const key = (k: string) => <kbd aria-hidden="true">{k}</kbd>;

function Case() {
  const id = review.current.value;
  const ids = review.queue.value;
  if (id === null)
    return (
      <p class="quiet pad">
        {ids.length === 0 ? "No building is in this order." : "The selected building is not in this order: n goes to the first that is."}
      </p>
    );
  const building = state.run.value!.buildings.get(id);
  const decision = review.decisions.value.get(id);
  return (
    <section class="card review-case" aria-label="Building under review">
      <h2>
        {id} <span class="quiet">{`${grouped(ids.indexOf(id) + 1)} of ${grouped(ids.length)}`}</span>
      </h2>
      {building ? <Doubt building={building} /> : <p role="status">Loading …</p>}
      <Decided decision={decision} />
      <div class="review-keys" role="group" aria-label="Decision">
        <button type="button" class="right" onClick={() => review.decide("right")} aria-keyshortcuts="r" disabled={!building}>
          Right {key("r")}
        </button>
        <button type="button" class="wrong" onClick={() => review.decide("wrong")} aria-keyshortcuts="w" disabled={!building}>
          Wrong {key("w")}
        </button>
        <button type="button" onClick={() => review.decide("later")} aria-keyshortcuts="d" disabled={!building}>
          Later {key("d")}
        </button>
      </div>
      <div class="review-keys" role="group" aria-label="Case">
        <button type="button" onClick={() => review.step(-1)} aria-keyshortcuts="b">
          Back {key("b")}
        </button>
        <button type="button" onClick={() => review.step(1)} aria-keyshortcuts="n">
          Next {key("n")}
        </button>
        <button type="button" onClick={() => review.openEditor()} aria-keyshortcuts="e" disabled={!building?.parts.length}>
          Edit {key("e")}
        </button>
        <button type="button" onClick={() => review.takeBack()} disabled={!decision}>
          Take back
        </button>
      </div>
      <Note key={id} id={id} />
      {building && <Alternatives building={building} />}
    </section>
  );
}

/** The reason for doubt in a sentence, the place, and the numbers. */
function Doubt({ building }: { building: api.Building }) {
  const [first, ...more] = reasonsOf(building);
  const shown = review.shownCase.value;
  const error = rmse(building.mse);
  return (
    <>
      <p class="review-reason">
        {first ??
          (building.confidence === null
            ? "No reason for doubt is known: it was edited, or made without a scan."
            : "Nothing speaks against this model.")}
      </p>
      {shown?.place && <p class="review-place">{placeInWords(shown.place)}</p>}
      <p class="quiet">
        {sentence(sureInWords(building))}
        {error !== null && `; RMSE ${metres(error)}`}; {count(building.parts.length, "part")}
      </p>
      {more.length > 0 && (
        <details>
          <summary>{count(more.length, "more reason")}</summary>
          <ul>
            {more.map((r) => (
              <li key={r}>{r}</li>
            ))}
          </ul>
        </details>
      )}
    </>
  );
}

function Decided({ decision }: { decision: api.ReviewDecision | undefined }) {
  if (!decision) return null;
  const who = `${decision.reviewer ? ` by ${decision.reviewer}` : ""}, ${decision.time.slice(0, 10)}`;
  return standing(decision) === "lapsed" ? (
    <p class="review-decided lapsed">
      Lapsed: it was decided {decision.decision}
      {who}, and the model changed since.
    </p>
  ) : (
    <p class={`review-decided ${decision.decision}`}>
      {sentence(decision.decision)}
      {who}
    </p>
  );
}

function Note({ id }: { id: string }) {
  return (
    <label class="review-note">
      <span>Note {key("c")}</span>
      <input
        type="text"
        aria-label="Note"
        maxLength={500}
        value={review.noteOf(id)}
        onInput={(e) => review.setNote(id, e.currentTarget.value)}
        onBlur={() => review.keepNote(id)}
        onKeyDown={(e) => {
          if (e.key !== "Enter" && e.key !== "Escape") return;
          e.preventDefault();
          e.stopPropagation();
          e.currentTarget.blur(); // the keys decide again
        }}
      />
    </label>
  );
}

function Alternatives({ building }: { building: api.Building }) {
  const shown = review.shownCase.value;
  if (!shown)
    return state.sceneRead.value ? (
      <p class="quiet" role="status">
        Looking for other models …
      </p>
    ) : (
      <p class="quiet">Other models and the place of the largest difference need the scan.</p>
    );
  if (shown.alternatives.length === 0) return <p class="quiet">No other model of this building is offered.</p>;
  const own = rmse(building.mse);
  return (
    <div class="review-models">
      <h3>
        Other models <span class="quiet">this one: RMSE {fixed(own, 2)} m</span>
      </h3>
      <ol>
        {shown.alternatives.map((one, i) => {
          const error = rmse(one.mse);
          return (
            <li key={one.what}>
              <button type="button" onClick={() => review.takeModel(i + 1)} aria-keyshortcuts={`${i + 1}`}>
                {key(`${i + 1}`)} {sentence(one.what)}
                <span class={"number" + (error !== null && own !== null && error < own ? " better" : "")}>
                  {error === null ? "" : `RMSE ${fixed(error, 2)} m, `}
                  {count(one.roof_faces, "roof face")}
                </span>
              </button>
            </li>
          );
        })}
      </ol>
    </div>
  );
}

/** Decisions to and from other people. */
function Files() {
  const file = useRef<HTMLInputElement>(null);
  useEffect(() => {
    void review.load();
  }, []);
  return (
    <footer class="review-files">
      <button
        type="button"
        class="small"
        title="Saves the decisions of this project as a file, for another person"
        onClick={() =>
          void attempt(client.reviewFile()).then((all) => {
            if (all) offer(new Blob([JSON.stringify(all, null, 1)], { type: "application/json" }), "review.json");
          })
        }
      >
        Save decisions
      </button>
      <button
        type="button"
        class="small"
        title="Adds the decisions of another person: review.json of their project. Where both decided, the later decision counts"
        onClick={() => file.current?.click()}
      >
        Merge decisions …
      </button>
      <input
        ref={file}
        type="file"
        class="unseen"
        tabIndex={-1}
        accept=".json"
        aria-label="File of decisions to merge"
        onChange={(e) => {
          const chosen = e.currentTarget.files?.[0];
          if (chosen) void review.merge(chosen);
          e.currentTarget.value = "";
        }}
      />
      {review.reviewer.value && <span class="quiet">You decide as {review.reviewer.value}</span>}
    </footer>
  );
}
