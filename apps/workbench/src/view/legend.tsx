// What the colours of the layers shown mean, where that is not plain.
import * as state from "../state";
import { choices, errorLimit } from "./layers";

export function Legend() {
  const { error, cuts, faces } = choices.value;
  const run = state.run.value;
  const maps = run && state.errorMaps.value.get(run.id);
  if (!run || (!error.shown && !cuts.shown && !faces.shown)) return null;
  const limit = errorLimit.value;
  return (
    <div class="legend">
      {error.shown && (
        <div class="legend-error">
          <div>
            model − scan, m
            {!maps
              ? " (coming)"
              : maps.length === 0
                ? " (none measured)"
                : run.history.done > 0
                  ? " · before edits"
                  : ""}
          </div>
          <div class="legend-ramp" aria-hidden="true" />
          <div class="legend-ticks">
            <span>−{limit}</span>
            <span>0</span>
            <span>+{limit}</span>
          </div>
        </div>
      )}
      {cuts.shown && (
        <div class="legend-cuts">
          <span>
            <i class="stroke bold cut" /> cut
          </span>
          <span>
            <i class="stroke" /> not cut
          </span>
          <span>
            <i class="stroke cut" /> cutting cheaper
          </span>
          <span>
            <i class="stroke join" /> joining cheaper
          </span>
        </div>
      )}
      {faces.shown && <div>fractured ground: one tint a part, above the roofs</div>}
    </div>
  );
}
