// The section of the mesh across an edge. It is fetched when the edge or the position changes; the latest request counts.
import { useSignal, type ReadonlySignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { client } from "../actions";
import type * as api from "../api/types";
import * as state from "../state";
import { endsOf, isCorner, type EdgeAt } from "./plan";
import { acrossTurned } from "./turned_roof";

/** Milliseconds without changes before it is fetched. */
const pause = 60;

export function useSection(
  plan: api.Plan | null,
  at: EdgeAt | null,
  share: number,
): ReadonlySignal<api.Section | null> {
  const section = useSignal<api.Section | null>(null);
  const run = state.run.value?.id ?? null;
  const selection = state.selection.value;
  const ends = plan && at && endsOf(plan, at);
  // A section needs the mesh: it is fetched once the scene has been loaded.
  const there = state.sceneRead.value;
  const key = run && plan && at && ends && there ? JSON.stringify([run, at, ends, plan.base, share]) : "";

  useEffect(() => {
    if (!run || !plan || !at || !selection?.part || !key) {
      section.value = null;
      return;
    }
    let wanted = true;
    const { building, part } = selection;
    const timer = setTimeout(() => {
      const drafted = state.draft.value?.changes.some((c) => c.building === building);
      // A corner edge has no extent: the section is taken along the eaves of its plane.
      const eaves = isCorner(plan, at) ? acrossTurned(plan, at) : null;
      const asked = eaves
        ? client.sectionOf(run, { plan: eaves, ring: 0, edge: 0, share })
        : drafted
        ? client.sectionOf(run, { plan, ring: at.ring, edge: at.edge, share })
        : client.section(run, { building, part: part!, ring: at.ring, edge: at.edge, share });
      asked.then(
        (answer) => wanted && (section.value = answer),
        () => wanted && (section.value = null), // the drawing shows that there is no section
      );
    }, pause);
    return () => {
      wanted = false;
      clearTimeout(timer);
    };
  }, [key]);
  return section;
}
