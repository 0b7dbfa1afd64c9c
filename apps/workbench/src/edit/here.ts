// The edit session of this tab.
import { effect } from "@preact/signals";
import { client, select, showMessage, take } from "../actions";
import { keep, kept } from "../keep";
import * as state from "../state";
import { drawnLatencies, latencies, measureShown } from "./latency";
import { EditSession } from "./session";

export const session = new EditSession(client, {
  run: state.run,
  draft: state.draft,
  take,
  showMessage,
  keep: (draft) => keep("session", "draft", draft),
  kept: () => kept("session", "draft", null),
  shown: measureShown,
});

/** Selects the building of the draft. */
export function showDraft() {
  const change = state.draft.value?.changes[0];
  if (change) select({ building: change.building, part: change.parts[0]?.id ?? null, ring: 0, edge: null });
}

let last: string | null = null;
effect(() => {
  const run = state.run.value?.id ?? null;
  if (run === last) return;
  last = run;
  if (run)
    queueMicrotask(() => {
      session.restore();
      if (!state.selection.value) showDraft();
    });
});

if (typeof window !== "undefined") {
  const page = window as unknown as { mansard?: Record<string, unknown> };
  page.mansard = { ...page.mansard, latency: latencies, drawn: drawnLatencies };
}
