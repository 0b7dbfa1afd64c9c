// The pairs of points that align mesh and footprints, their offset and what it leaves.
import { openInputs } from "../actions";
import { Icon } from "../panels/icons";
import { fixed } from "../panels/words";
import * as state from "../state";
import { align, aligning, fitted, offsetOption, removePair, takeBack } from "./align";

const key = "ingest.mesh_offset";

/** Reads the inputs again with the offset. */
async function apply(offset: readonly [number, number]) {
  const project = state.project.value;
  if (!project?.inputs) return;
  const reading = { ...project.reading, [key]: offsetOption(project.reading[key], offset) };
  const job = await openInputs({ ...project.inputs.given, reading });
  if (job) align(false);
}

export function AlignBox() {
  const now = aligning.value;
  if (!now) return null;
  const fit = fitted(now.pairs);
  const runs = state.project.value?.runs.length ?? 0;
  return (
    <section class="measure align" aria-label="Align mesh and footprints">
      <div class="measure-tools">
        <b>Align mesh and footprints</b>
        <span class="spring" />
        <button type="button" class="plain" aria-label="Take back the last point" title="Take back the last point (Backspace)" disabled={!now.scan && !now.pairs.length} onClick={takeBack}>
          <Icon name="undo" />
        </button>
        <button type="button" class="plain" aria-label="Stop aligning" title="Stop aligning (Esc)" onClick={() => align(false)}>
          <Icon name="close" />
        </button>
      </div>
      <div role="status">
        <p class="quiet">
          {now.scan
            ? "Click the corner of a footprint where this point should be."
            : now.pairs.length < 2
              ? "Click a point of the scan: the corner of a house, on its wall or eave. Two pairs or more."
              : "Click another point of the scan, or use the offset."}
        </p>
        {fit && (
          <table>
            <thead>
              <tr>
                <th>Pair</th>
                <th>East m</th>
                <th>North m</th>
                <th>Residual m</th>
                <th aria-label="Remove" />
              </tr>
            </thead>
            <tbody>
              {now.pairs.map(({ scan, corner }, i) => (
                <tr key={i}>
                  <td>{i + 1}</td>
                  <td>{fixed(corner[0] - scan[0], 2)}</td>
                  <td>{fixed(corner[1] - scan[1], 2)}</td>
                  <td>{fit.rms === null ? "–" : fixed(fit.residuals[i]!, 2)}</td>
                  <td>
                    <button type="button" class="plain" aria-label={`Remove pair ${i + 1}`} onClick={() => removePair(i)}>
                      <Icon name="close" />
                    </button>
                  </td>
                </tr>
              ))}
            </tbody>
            <tfoot>
              <tr>
                <th>Offset</th>
                <td>{fixed(fit.offset[0], 2)}</td>
                <td>{fixed(fit.offset[1], 2)}</td>
                <td>{fit.rms === null ? "–" : fixed(fit.rms, 2)}</td>
                <td />
              </tr>
            </tfoot>
          </table>
        )}
      </div>
      {fit?.rms != null && (
        <p>
          <button type="button" class="small" disabled={runs > 0} onClick={() => void apply(fit.offset)}>
            Read the inputs again with this offset
          </button>
          {runs > 0 && <span class="quiet"> The project has runs, which keep their inputs: delete them first.</span>}
        </p>
      )}
    </section>
  );
}
