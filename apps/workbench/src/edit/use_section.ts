// The mesh's slice across an edge, asked for when the edge or the place on it changes; the latest wins.
import { useSignal, type ReadonlySignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { client } from "../actions";
import type * as api from "../api/types";
import * as state from "../state";
import { endsOf, type EdgeAt } from "./plan";

/** Milliseconds that the edge has to stand still before it is asked for. */
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
  // A section needs the mesh: without the scene there is none, and it comes when the scene does.
  const there = state.scene.value !== null;
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
      const asked = drafted
        ? client.sectionOf(run, { plan, ring: at.ring, edge: at.edge, share })
        : client.section(run, { building, part: part!, ring: at.ring, edge: at.edge, share });
      asked.then(
        (answer) => wanted && (section.value = answer),
        () => wanted && (section.value = null), // a drawing without its slice says so by itself
      );
    }, pause);
    return () => {
      wanted = false;
      clearTimeout(timer);
    };
  }, [key]);
  return section;
}
