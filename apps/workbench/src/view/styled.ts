// The scale of the attribute by which the buildings of the open run are coloured.
import { computed, effect } from "@preact/signals";
import { needAttributes, warn } from "../actions";
import * as state from "../state";
import { type Scale, scaleOf, styledBy, valuesOf, whatIs } from "./styling";

export const scale = computed((): Scale | null => {
  const run = state.run.value;
  const name = styledBy.value;
  if (!run || name === null) return null;
  const table = state.attributes.value.get(run.id);
  return scaleOf(valuesOf(name, run.buildings, table), whatIs(name, table));
});

effect(() => {
  const run = state.run.value;
  if (run?.large && styledBy.value !== null && !styledBy.value.startsWith("own ")) {
    styledBy.value = null;
    warn("style-large", "the attributes of runs of more than 5,000 buildings stay on the server, and cannot colour the view; search for them in the table");
  } else if (run && styledBy.value !== null && !state.outdatedAttributes.value.has(run.id)) void needAttributes(run.id);
});
