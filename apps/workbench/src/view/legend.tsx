// The legend of the visible layers.
import * as state from "../state";
import { choices, errorLimit } from "./layers";
import { scale } from "./styled";
import { type Scale, css, missing, ramp } from "./styling";

/** The colours of the attribute by which buildings are coloured. */
function Styled({ scale: { name, unit, range, categories, missing: without } }: { scale: Scale }) {
  const digits = range && Math.abs(range.high - range.low) < 20 ? 2 : 0;
  return (
    <div class="legend-style">
      <div>
        {name}
        {unit && `, ${unit}`}
      </div>
      {range && (
        <>
          <div
            class="legend-ramp"
            aria-hidden="true"
            style={{ background: `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map((t) => css(ramp(t))).join(", ")})` }}
          />
          <div class="legend-ticks">
            <span>{range.low.toFixed(digits)}</span>
            <span>{((range.low + range.high) / 2).toFixed(digits)}</span>
            <span>{range.high.toFixed(digits)}</span>
          </div>
        </>
      )}
      {[...categories, ...(without ? [{ value: "no value", colour: missing, count: without }] : [])].map((c) => (
        <div class="legend-category" key={c.value}>
          <span class="swatch" style={{ background: css(c.colour) }} aria-hidden="true" />
          <span>{c.value}</span> <span class="quiet">{c.count}</span>
        </div>
      ))}
    </div>
  );
}

export function Legend() {
  const { error, cuts, faces } = choices.value;
  const run = state.run.value;
  const maps = run && state.errorMaps.value.get(run.id);
  const styled = scale.value;
  if (!run || (!error.shown && !cuts.shown && !faces.shown && !styled)) return null;
  const limit = errorLimit.value;
  return (
    <div class="legend">
      {styled && <Styled scale={styled} />}
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
