// Layers once more, and everything that the scene, the run and its buildings have to say.
import { computed, signal } from "@preact/signals";
import { fly, select } from "../actions";
import type { Diagnostic } from "../api/types";
import * as state from "../state";
import { LayerList } from "../view/layers_panel";
import { grouped } from "./words";

interface Said extends Diagnostic {
  building: string | null;
}
const search = signal("");
const most = 400; // rows made at once

const said = computed((): Said[] => {
  const all: Said[] = [];
  const add = (building: string | null, of: readonly Diagnostic[]) => {
    for (const d of of) all.push({ ...d, building });
  };
  const scene = state.scene.value;
  add(null, scene?.warnings ?? []);
  const open = state.run.value;
  for (const f of scene?.footprints ?? []) if (f.defect) add(open?.buildings.has(f.id) ? f.id : null, [f.defect]);
  for (const b of open?.buildings.values() ?? []) {
    add(b.id, [...b.reasons, ...b.diagnostics, ...b.parts.flatMap((p) => p.diagnostics)]);
  }
  return all.sort((a, b) => Number(b.severity === "error") - Number(a.severity === "error"));
});

export function LayersTab() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  const text = (d: Said) => `${d.code} ${d.message} ${d.subject} ${d.building ?? ""}`.toLowerCase();
  const rows = said.value.filter((d) => words.every((w) => text(d).includes(w)));
  return (
    <div class="panel">
      <section class="card">
        <h2>Layers</h2>
        <LayerList />
      </section>
      <section class="card">
        <h2>
          Diagnostics <span class="quiet">{grouped(said.value.length)}</span>
        </h2>
        {said.value.length === 0 ? (
          <p class="quiet">Nothing to say: every building was made in full.</p>
        ) : (
          <>
            <input
              type="search"
              placeholder="Filter diagnostics"
              aria-label="Filter diagnostics"
              value={search.value}
              onInput={(e) => (search.value = e.currentTarget.value)}
            />
            <ul class="said">
              {rows.slice(0, most).map((d, i) => (
                <li key={i} class={d.severity}>
                  <div>
                    <code>{d.code}</code>
                    {d.building !== null ? (
                      <button
                        type="button"
                        class="plain link"
                        onClick={() => {
                          select({ building: d.building!, part: null, ring: 0, edge: null });
                          fly("selection");
                        }}
                      >
                        {d.building}
                      </button>
                    ) : (
                      <span class="quiet">{d.subject}</span>
                    )}
                  </div>
                  {d.message}
                </li>
              ))}
            </ul>
            {rows.length > most && <p class="quiet">and {grouped(rows.length - most)} more: filter to see them</p>}
          </>
        )}
      </section>
    </div>
  );
}
