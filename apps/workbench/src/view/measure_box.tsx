// The tools for measuring and their results.
import { Icon } from "../panels/icons";
import * as state from "../state";
import { measure, measuring, points, removePoint, results, tools } from "./measure";

export function MeasureBox() {
  const tool = measuring.value;
  if (!tool) return null;
  const rows = results(tool, points.value);
  const { hint } = tools.find((t) => t.tool === tool)!;
  const origin = state.scene.value?.origin ?? [0, 0, 0];
  const last = points.value.at(-1);
  return (
    <section class="measure" aria-label="Measure">
      <div class="measure-tools" role="radiogroup" aria-label="What to measure">
        {tools.map((t) => (
          <label key={t.tool}>
            <input type="radio" name="measure" checked={t.tool === tool} onChange={() => measure(t.tool)} />
            {t.name}
          </label>
        ))}
        <span class="spring" />
        <button type="button" class="plain" aria-label="Remove the last point" title="Remove the last point (Backspace)" disabled={!last} onClick={removePoint}>
          <Icon name="undo" />
        </button>
        <button type="button" class="plain" aria-label="Stop measuring" title="Stop measuring (Esc)" onClick={() => measure(null)}>
          <Icon name="close" />
        </button>
      </div>
      <div role="status">
        {rows.length ? (
          <dl class="numbers">
            {rows.map(([name, value]) => (
              <>
                <dt>{name}</dt>
                <dd>{value}</dd>
              </>
            ))}
          </dl>
        ) : (
          <span class="quiet">{hint}</span>
        )}
        {last && (
          <div class="quiet coordinates">
            last point: E {(last[0] + origin[0]).toFixed(2)} N {(last[1] + origin[1]).toFixed(2)} H{" "}
            {(last[2] + origin[2]).toFixed(2)}
          </div>
        )}
      </div>
    </section>
  );
}
