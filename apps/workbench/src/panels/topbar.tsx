// The bar at the top: the open run, the run to compare with, undo and redo, exports.
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as actions from "../actions";
import * as state from "../state";
import { dark, theme } from "../view/theme";
import { Icon } from "./icons";
import { brief, fullNameOf } from "./words";

const layersOfRun = "segment.gpkg"; // of reconstructed, not imported runs

export function TopBar() {
  const project = state.project.value;
  const finished = project?.runs.filter((r) => r.state === "done") ?? [];
  const run = state.run.value;
  // Of a large run the page does not have all models.
  const edited = run !== null && !run.large && (run.history.done > 0 || state.isBefore(state.other.value?.id));
  return (
    <header class="topbar">
      <h1 class="brand">
        <img src="./icon.svg" alt="" width="20" height="20" /> mansard
      </h1>
      <span class="project" title={project?.folder}>
        {project?.name}
      </span>
      {finished.length > 0 && (
        <>
          <label>
            Run
            <select value={run?.id ?? ""} onChange={(e) => void actions.openRun(e.currentTarget.value)}>
              {!run && <option value="">–</option>}
              {finished.map((r) => (
                <option key={r.id} value={r.id}>
                  {fullNameOf(r)}
                </option>
              ))}
            </select>
          </label>
          <label>
            Compare with
            <select
              value={state.other.value?.id ?? ""}
              disabled={finished.length < 2 && !edited}
              onChange={(e) => {
                const id = e.currentTarget.value || null;
                void actions.compareWith(id);
                if (id) state.tab.value = "compare";
              }}
            >
              <option value="">none</option>
              {run && edited && <option value={state.beforeOf(run.id)}>this run before its edits</option>}
              {finished
                .filter((r) => r.id !== run?.id)
                .map((r) => (
                  <option key={r.id} value={r.id}>
                    {fullNameOf(r)}
                  </option>
                ))}
            </select>
          </label>
        </>
      )}
      <span class="spring" />
      {run && <History />}
      {run && <Export run={run.id} />}
      <button
        type="button"
        class="plain"
        title={dark.value ? "Light colours" : "Dark colours"}
        aria-label="Dark colours"
        aria-pressed={dark.value ? true : undefined}
        onClick={() => (theme.value = dark.value ? "light" : "dark")}
      >
        <Icon name={dark.value ? "sun" : "moon"} />
      </button>
      <button
        type="button"
        class="plain"
        title="Keyboard, mouse and manual (?)"
        aria-label="Keyboard"
        onClick={() => (state.keyboardHelp.value = true)}
      >
        <Icon name="help" />
      </button>
      <span
        class={"dot" + (state.connected.value ? "" : " away")}
        role="status"
        aria-label={state.connected.value ? "Connected to the server" : "The server does not answer"}
        title={state.connected.value ? "Connected" : "The server does not answer"}
      />
    </header>
  );
}

function History() {
  const { edits, done } = state.run.value!.history;
  const [last, next] = [done > 0 ? edits[done - 1] : undefined, edits[done]];
  const held = state.draft.value?.invalid;
  return (
    <div class="history">
      <button
        type="button"
        disabled={last === undefined && !state.draft.value}
        title={held ? "Discard the unsaved change (Ctrl+Z)" : last ? `Undo: ${last} (Ctrl+Z)` : "Nothing to undo"}
        onClick={() => void actions.undo()}
      >
        <Icon name="undo" />
        Undo
        <span class="words">{held ? "unsaved change" : last && brief(last)}</span>
      </button>
      <button
        type="button"
        disabled={next === undefined}
        title={next ? `Redo: ${next} (Ctrl+Shift+Z)` : "Nothing to redo"}
        onClick={() => void actions.redo()}
      >
        <Icon name="redo" />
        Redo
        <span class="words">{next && brief(next)}</span>
      </button>
    </div>
  );
}

const open = signal(false);

function Export({ run }: { run: string }) {
  const close = () => (open.value = false);
  const box = useRef<HTMLDivElement>(null);
  const items = () => [...(box.current?.querySelectorAll<HTMLElement>("[role=menuitem]") ?? [])];
  // The first item has the focus when the menu opens.
  useEffect(() => {
    if (open.value) items()[0]?.focus();
  }, [open.value]);
  const keys = (e: KeyboardEvent) => {
    const all = items();
    const at = all.indexOf(document.activeElement as HTMLElement);
    const next = { ArrowDown: at + 1, ArrowUp: at < 0 ? all.length - 1 : at - 1, Home: 0, End: all.length - 1 }[e.key];
    if (e.key === "Escape" && open.value) {
      close();
      box.current?.querySelector<HTMLElement>("[aria-haspopup]")?.focus();
    } else if (e.key === "ArrowDown" && !open.value) open.value = true;
    else if (next !== undefined && open.value) all[(next + all.length) % all.length]?.focus();
    else return;
    e.preventDefault();
    e.stopPropagation();
  };
  // Files that name each other, such as OBJ and MTL, come as one ZIP.
  const files = (state.options.value?.formats ?? [])
    .filter((f) => f.files.length > 0)
    .map((f): [file: string, what: string] => [f.files.length > 1 ? `${f.files[0]}.zip` : f.files[0]!, f.description]);
  if (state.scene.value)
    files.push(
      ["terrain.city.json", "The ground around the models, joined to them, as CityJSON (a TINRelief)."],
      ["terrain.glb", "The same as GLB."],
      ["terrain.stl", "One closed surface of ground and models, for simulations."],
    );
  if (state.runSummary(run)?.scores) files.push([layersOfRun, "Layers of the segmentation for a GIS, before edits."]);
  return (
    <div
      class="menu"
      ref={box}
      onKeyDown={keys}
      onFocusOut={(e) => {
        if (!e.currentTarget.contains(e.relatedTarget as Node | null)) close();
      }}
    >
      <button type="button" aria-haspopup="menu" aria-expanded={open.value} onClick={() => (open.value = !open.value)}>
        Export
      </button>
      {open.value && (
        <ul role="menu" aria-label="Export">
          {files.map(([file, what]) => (
            <li key={file} role="none">
              <button
                type="button"
                role="menuitem"
                onClick={() => {
                  close();
                  void actions.download(run, file);
                }}
              >
                {file} <span class="quiet">{what}</span>
              </button>
            </li>
          ))}
          <li role="none" class="apart">
            <button
              type="button"
              role="menuitem"
              onClick={() => {
                close();
                void actions.exportAll(run, () => window.confirm("The export folder already has files of this run. Replace them?"));
              }}
            >
              All files <span class="quiet">into the project's folder</span>
            </button>
          </li>
        </ul>
      )}
    </div>
  );
}
