// The legend of the visible layers.
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
        <div class={"legend-error" + (state.outdatedMaps.value.has(run.id) ? " outdated" : "")}>
          <div>
            model − mesh, m
            {!maps
              ? " (loading)"
              : maps.length === 0
                ? " (not measured)"
                : state.outdatedMaps.value.has(run.id)
                  ? " · before the last edits"
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
            <i class="stroke cut" /> cut costs less
          </span>
          <span>
            <i class="stroke join" /> joining costs less
          </span>
        </div>
      )}
      {faces.shown && <div>partition faces: one colour per part</div>}
    </div>
  );
}
