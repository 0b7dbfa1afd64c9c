// The guided first run: three steps on the sample, until they are done or closed.
import { signal } from "@preact/signals";
import * as actions from "../actions";
import { keep, kept } from "../keep";
import * as state from "../state";
import { section } from "../view/layers";
import { measuring } from "../view/measure";
import { Icon } from "./icons";

const closed = signal(kept("local", "steps closed", false));
const close = () => {
  closed.value = true;
  keep("local", "steps closed", true);
};
/** Whether this tab opened the sample: others need no guide. */
export const guided = signal(kept("session", "guided", false));
export function guide() {
  guided.value = true;
  keep("session", "guided", true);
}

export function Steps() {
  const runs = state.project.value?.runs.filter((r) => r.state === "done") ?? [];
  if (closed.value || !guided.value || !state.scene.value || state.changingInputs.value || state.busyJob.value) return null;
  if (measuring.value || section.value) return null; // their controls are in the same place
  const run = state.run.value;
  const edited = (run?.history.done ?? 0) > 0;
  const step = !runs.length ? 1 : !state.selection.value ? 2 : 3;
  if (edited) return null;
  return (
    <section class="steps" aria-label="First steps">
      <header>
        <b>Step {step} of 3</b>
        <button type="button" class="plain" aria-label="Close the first steps" onClick={close}>
          <Icon name="close" />
        </button>
      </header>
      {step === 1 && (
        <p>
          The scan is blue, the footprints are orange.{" "}
          <button type="button" class="small" onClick={() => void actions.startRun({ label: "", preset: "", options: {}, blocks: [] })}>
            Make all models
          </button>
        </p>
      )}
      {step === 2 && (
        <p>
          The models have red roofs.{" "}
          <button type="button" class="small" onClick={() => actions.selectNext(1)}>
            Select a building
          </button>{" "}
          or click one in the view.
        </p>
      )}
      {step === 3 && (
        <p>
          Change its roof: drag a point of the profile,{" "}
          {state.tab.value !== "edit" && (
            <>
              in the panel{" "}
              <button type="button" class="small" onClick={() => (state.tab.value = "edit")}>
                Edit
              </button>
              ,{" "}
            </>
          )}
          and see volume and error change. “?” has the manual.
        </p>
      )}
    </section>
  );
}
