// The inputs, the form of a new run with its options, and the list of runs.
import { effect, signal } from "@preact/signals";
import * as actions from "../actions";
import type { RunSummary } from "../api/types";
import { keep, kept } from "../keep";
import * as state from "../state";
import { Icon } from "./icons";
import { OptionFields } from "./option_fields";
import { changed, faulty, forRuns } from "./options";
import { Progress } from "./progress";
import { changeInputs } from "./start";
import { bytes, count, fixed, grouped, nameOf, rmse, said, seconds } from "./words";

/** The contents of the form; kept across reloads. */
interface Form {
  label: string;
  preset: string;
  values: Record<string, string>;
  some: boolean; // only the chosen blocks
}
const form = signal<Form>({
  label: "",
  preset: "",
  values: {},
  some: false,
  ...kept<Partial<Form>>("session", "form", {}),
});
const search = signal("");
effect(() => keep("session", "form", form.value));
const change = (by: Partial<Form>) => (form.value = { ...form.value, ...by });

export function RunPanel() {
  return (
    <div class="panel">
      <Inputs />
      <CarryOver />
      <NewRun />
      <RunList />
    </div>
  );
}

function Inputs() {
  const inputs = state.project.value?.inputs;
  const scene = state.scene.value;
  if (!inputs) return null;
  const files = [...inputs.meshes, ...inputs.terrain, ...inputs.footprints];
  const changes = files.filter((f) => f.changed).length;
  return (
    <details class="card">
      <summary>
        Inputs
        <span class="quiet">
          {count(files.length, "file")}
          {scene && ` · ${grouped(scene.triangles)} triangles · ${count(scene.footprints.length, "footprint")}`}
        </span>
        {changes > 0 && <span class="badge warn">{count(changes, "file")} changed on disk</span>}
      </summary>
      <ul class="files">
        {files.map((f) => (
          <li key={f.path}>
            <span title={f.path}>{f.path.slice(f.path.lastIndexOf("/") + 1)}</span>
            <span class="quiet">{bytes(f.bytes)}</span>
            {f.changed && <span class="wrong">missing, or changed since it was read</span>}
          </li>
        ))}
      </ul>
      {scene && (
        <p class="quiet">
          {scene.crs || "no CRS"} · origin {scene.origin.join(", ")} m
        </p>
      )}
      <button type="button" onClick={changeInputs}>
        Change inputs …
      </button>
    </details>
  );
}

function NewRun() {
  const { options = [], presets = [] } = state.options.value ?? {};
  const { label, preset: name, values, some } = form.value;
  const preset = presets.find((p) => p.name === name);
  const usable = forRuns(options);
  const given = changed(usable, values, preset);
  const wrong = faulty(usable, values);
  const blocks = state.scene.value?.blocks ?? [];
  const chosen = [...state.chosenBlocks.value].filter((b) => blocks.some((known) => known.name === b));
  const none = some && chosen.length === 0;
  const job = state.busyJob.value;
  const start = async (e: Event) => {
    e.preventDefault();
    const request = { label: label.trim(), preset: name, options: given, blocks: some ? chosen : [] };
    if (!(await actions.startRun(request))) return;
    state.choosing.value = false;
    change({ label: "" });
  };
  return (
    <form class="card" onSubmit={(e) => void start(e)}>
      <h2>New run</h2>
      <div class="two">
        <label class="field">
          Label
          <input
            type="text"
            placeholder="optional"
            value={label}
            onInput={(e) => change({ label: e.currentTarget.value })}
          />
        </label>
        <label class="field">
          Preset
          <select value={name} title={preset?.meaning} onChange={(e) => change({ preset: e.currentTarget.value })}>
            <option value="">none (defaults)</option>
            {presets.map((p) => (
              <option key={p.name} value={p.name} title={p.meaning}>
                {p.name}
              </option>
            ))}
          </select>
        </label>
      </div>
      <fieldset class="inline">
        <legend>Blocks</legend>
        <label>
          <input
            type="radio"
            name="blocks"
            checked={!some}
            onChange={() => {
              change({ some: false });
              state.choosing.value = false;
            }}
          />
          all{blocks.length > 0 && ` (${blocks.length})`}
        </label>
        <label>
          <input
            type="radio"
            name="blocks"
            checked={some}
            onChange={() => {
              change({ some: true });
              state.choosing.value = true;
            }}
          />
          selected ({chosen.length})
        </label>
        {some && (
          <button
            type="button"
            class="small"
            aria-pressed={state.choosing.value}
            onClick={() => (state.choosing.value = !state.choosing.value)}
          >
            {state.choosing.value ? "Finish selection" : "Select in the 3D view"}
          </button>
        )}
        {some && (
          <select
            aria-label="Select or deselect a block by name"
            value=""
            onChange={(e) => {
              const set = new Set(state.chosenBlocks.value);
              if (!set.delete(e.currentTarget.value)) set.add(e.currentTarget.value);
              state.chosenBlocks.value = set;
              e.currentTarget.value = "";
            }}
          >
            <option value="">by name …</option>
            {blocks.map((b) => (
              <option key={b.name} value={b.name}>
                {chosen.includes(b.name) ? "✓ " : ""}
                {b.name} · {count(b.buildings.length, "building")}
              </option>
            ))}
          </select>
        )}
      </fieldset>
      <details>
        <summary>
          Options
          {Object.keys(given).length > 0 && <span class="badge">{Object.keys(given).length} changed</span>}
        </summary>
        <OptionFields
          options={usable}
          values={values}
          preset={preset}
          search={search.value}
          onSearch={(text) => (search.value = text)}
          onChange={(v) => change({ values: v })}
        />
      </details>
      <div class="go">
        <button type="submit" class="primary" disabled={!!wrong || none || !state.project.value?.inputs}>
          Reconstruct
        </button>
        {wrong && <span class="wrong">{wrong}</span>}
        {none && <span class="quiet">select at least one block</span>}
      </div>
      {job && <Progress job={job} />}
    </form>
  );
}

/** Offers the edits of another run for the open one, which has none. */
function CarryOver() {
  const open = state.runSummary(state.run.value?.id);
  if (!open || state.editsOf(open) > 0) return null;
  const edited = (state.project.value?.runs ?? []).filter(
    (r) => r.id !== open.id && r.state === "done" && state.editsOf(r) > 0,
  );
  const last = edited.at(-1);
  if (!last) return null;
  return (
    <section class="card carry" aria-label="Carry edits over">
      <p>
        {nameOf(open)} has no edits, {nameOf(last)} has {count(state.editsOf(last), "edit")}. Each edited building keeps its
        plan where it still fits; the others are named and left as they are.
      </p>
      {edited.map((r) => (
        <button
          key={r.id}
          type="button"
          class="small"
          disabled={carrying.value}
          onClick={() => {
            carrying.value = true;
            void actions.carryOver(open.id, r.id).finally(() => (carrying.value = false));
          }}
        >
          Carry over from {nameOf(r)}
        </button>
      ))}
    </section>
  );
}
const carrying = signal(false);

function RunList() {
  const runs = [...(state.project.value?.runs ?? [])].reverse();
  if (!runs.length) return null;
  return (
    <section class="card">
      <h2>Runs</h2>
      <ul class="runs">
        {runs.map((r) => (
          <RunRow key={r.id} run={r} />
        ))}
      </ul>
    </section>
  );
}

const renaming = signal<string | null>(null);
const deleting = signal<string | null>(null);

function RunRow({ run }: { run: RunSummary }) {
  const open = state.run.value?.id === run.id;
  const settings = [
    run.preset && `preset ${run.preset}`,
    ...Object.entries(run.options).map(([k, v]) => `${k} = ${v}`),
  ].filter(Boolean);
  const name = nameOf(run);
  const edits = state.editsOf(run);
  const { scores, outdated } = state.scoresOf(run);
  return (
    <li class={"run-row" + (open ? " open" : "")}>
      <div class="run-head">
        {renaming.value === run.id ? (
          <RenameField run={run} />
        ) : (
          <button
            type="button"
            class="plain run-name"
            disabled={run.state !== "done"}
            aria-current={open || undefined}
            onClick={() => void actions.openRun(run.id)}
          >
            {name}
          </button>
        )}
        {name !== run.id && <span class="quiet">{run.id}</span>}
        <span class={`state ${run.state}`}>{run.state}</span>
        <span class="spring" />
        <button
          type="button"
          class="plain"
          title="Rename"
          aria-label={`Rename ${name}`}
          onClick={() => (renaming.value = run.id)}
        >
          <Icon name="pencil" />
        </button>
        <button
          type="button"
          class="plain"
          title="Delete"
          aria-label={`Delete ${name}`}
          disabled={run.state === "running" || run.state === "queued"}
          onClick={() => (deleting.value = run.id)}
        >
          <Icon name="bin" />
        </button>
      </div>
      {deleting.value === run.id && (
        <div class="ask" role="alertdialog" aria-label={`Delete ${name}?`}>
          Move {name} and its {count(edits, "edit")} to the trash folder of the project?
          <button
            type="button"
            class="small danger"
            onClick={() => {
              deleting.value = null;
              void actions.deleteRun(run.id);
            }}
          >
            Delete
          </button>
          <button type="button" class="small" onClick={() => (deleting.value = null)}>
            Cancel
          </button>
        </div>
      )}
      {run.failure && <p class="wrong">{said(run.failure)}</p>}
      {run.state === "done" && (
        <p class="run-numbers">
          {scores && (
            <span
              class={outdated ? "outdated" : undefined}
              title={
                "Root mean squared vertical error over the footprints" +
                (outdated ? ", before the last edits: it is measured again while the mesh is open" : "")
              }
            >
              RMSE {fixed(rmse(scores.footprint_mse), 3)} m{outdated && " · before edits"}
            </span>
          )}
          <span>
            {run.full} of {count(run.buildings, "building")} fully reconstructed
          </span>
          <span>{count(run.parts, "part")}</span>
          <span>{count(run.faces, "face")}</span>
          <span title={`Elapsed time; ${seconds(run.times.cpu_seconds)} of CPU time`}>{seconds(run.times.wall_seconds)}</span>
          {edits > 0 && <span>{count(edits, "edit")}</span>}
          {run.blocks.length > 0 && <span title={run.blocks.join(", ")}>only {count(run.blocks.length, "block")}</span>}
        </p>
      )}
      {settings.length > 0 && <p class="run-options">{settings.join(" · ")}</p>}
    </li>
  );
}

function RenameField({ run }: { run: RunSummary }) {
  const done = (text: string | null) => {
    renaming.value = null;
    if (text !== null && text.trim() !== nameOf(run)) void actions.renameRun(run.id, text.trim());
  };
  return (
    <input
      type="text"
      aria-label={`New label of ${nameOf(run)}`}
      defaultValue={nameOf(run)}
      ref={(e) => e?.focus()}
      onBlur={(e) => renaming.value === run.id && done(e.currentTarget.value)}
      onKeyDown={(e) => {
        e.stopPropagation();
        if (e.key === "Enter") done(e.currentTarget.value);
        if (e.key === "Escape") done(null);
      }}
    />
  );
}
