// The scale of the attribute by which the buildings of the open run are coloured.
import { computed, effect } from "@preact/signals";
import { needAttributes, needColumn } from "../actions";
import * as state from "../state";
import { type Scale, scaleOf, styledBy, valuesOf, valuesOfLarge, whatIs } from "./styling";

/** Of a large run what is coloured does not depend on which models are loaded. */
const large = computed((): Scale | null => {
  const run = listed.value;
  const name = styledBy.value;
  if (!run || name === null) return null;
  const column = state.columns.value.get(`${run.id} ${name}`);
  const values = valuesOfLarge(name, run, column);
  return values && scaleOf(values, column?.attribute ?? whatIs(name, undefined));
});
/** The list of a large run, which stays the same while models are loaded. */
const listed = computed((): { id: string; rows: NonNullable<state.OpenRun["large"]>["rows"] } | null => {
  const run = state.run.value;
  if (!run?.large) return null;
  if (last?.id === run.id && last.rows === run.large.rows) return last;
  return (last = { id: run.id, rows: run.large.rows });
});
let last: { id: string; rows: NonNullable<state.OpenRun["large"]>["rows"] } | null = null;

export const scale = computed((): Scale | null => {
  const run = state.run.value;
  const name = styledBy.value;
  if (!run || name === null) return null;
  if (run.large) return large.value;
  const table = state.attributes.value.get(run.id);
  return scaleOf(valuesOf(name, run.buildings, table), whatIs(name, table));
});

effect(() => {
  const run = state.run.value;
  const name = styledBy.value;
  if (!run || name === null) return;
  if (!run.large) {
    if (!state.outdatedAttributes.value.has(run.id)) void needAttributes(run.id);
  } else if (!name.startsWith("own ") && !state.columns.value.has(`${run.id} ${name}`)) void needColumn(run.id, name);
});
