// The list of layers, and all diagnostics of the scene, the run and its buildings.
import { computed, signal } from "@preact/signals";
import { fly, select } from "../actions";
import type { Diagnostic } from "../api/types";
import * as state from "../state";
import { LayerList } from "../view/layers_panel";
import { SearchField } from "./search_field";
import { grouped, said } from "./words";

interface Found extends Diagnostic {
  building: string | null;
}
const search = signal("");
const most = 400; // maximum number of rendered rows

const found = computed((): Found[] => {
  const all: Found[] = [];
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
  for (const [id, reasons] of open?.large?.reasons ?? []) if (!open!.buildings.has(id)) add(id, reasons);
  return all.sort((a, b) => Number(b.severity === "error") - Number(a.severity === "error"));
});

export function LayersTab() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  const text = (d: Found) => `${d.code} ${said(d)} ${d.subject} ${d.building ?? ""}`.toLowerCase();
  const rows = found.value.filter((d) => words.every((w) => text(d).includes(w)));
  return (
    <div class="panel">
      <section class="card">
        <h2>Layers</h2>
        <LayerList />
      </section>
      <section class="card">
        <h2>
          Diagnostics <span class="quiet">{grouped(found.value.length)}</span>
        </h2>
        {found.value.length === 0 ? (
          <p class="quiet">No diagnostics: every building was fully reconstructed.</p>
        ) : (
          <>
            <SearchField label="Filter diagnostics" value={search.value} onValue={(text) => (search.value = text)} />
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
                  {said(d)}
                </li>
              ))}
            </ul>
            {rows.length > most && <p class="quiet">{grouped(rows.length - most)} more; use the filter to find them</p>}
          </>
        )}
      </section>
    </div>
  );
}
