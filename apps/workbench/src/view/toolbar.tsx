// The buttons of the view: camera, section plane, measuring, layers, pictures.
import { fly } from "../actions";
import { Icon } from "../panels/icons";
import * as state from "../state";
import { align, aligning } from "./align";
import { viewer } from "./current";
import { divided, section } from "./layers";
import { measure, measuring } from "./measure";
import { type Vector, gaze } from "./camera";
import { type SectionPlane, across, normalOf } from "./section";

/** Through the selected building, across its longest edge; through the target of the camera if none is selected. */
function atSelection(): SectionPlane {
  const at = state.selection.value;
  const building = at && state.shown(at.building);
  const pose = viewer.value?.seenFrom;
  const plane = building?.parts.length
    ? across(building)
    : { origin: pose?.target ?? ([0, 0, 0] as Vector), azimuth: 0, tilt: 0, offset: 0, flipped: false };
  // What is hidden is in front of the plane, so that the cut can be seen.
  const normal = normalOf(plane);
  const towards = pose ? gaze(pose) : normal;
  return { ...plane, flipped: normal.reduce((sum, n, i) => sum + n * towards[i]!, 0) > 0 };
}

export function Toolbar() {
  const open = state.layersOpen.value;
  const cut = section.value;
  return (
    <div class="toolbar" role="toolbar" aria-label="View">
      <button type="button" title="Show all (h)" aria-label="Show all" onClick={() => fly("home")}>
        <Icon name="home" />
      </button>
      <button type="button" title="View from above (t)" aria-label="View from above" onClick={() => fly("top")}>
        <Icon name="top" />
      </button>
      <button
        type="button"
        title="Zoom to the selection (f)"
        aria-label="Zoom to the selection"
        disabled={!state.selection.value}
        onClick={() => fly("selection")}
      >
        <Icon name="focus" />
      </button>
      <button
        type="button"
        title="Section plane through the selection (x)"
        aria-label="Section plane"
        aria-pressed={cut !== null}
        onClick={toggleSection}
      >
        <Icon name="section" />
      </button>
      <button
        type="button"
        title="Measure (m)"
        aria-label="Measure"
        aria-pressed={measuring.value !== null}
        onClick={() => {
          align(false);
          measure(measuring.value ? null : "distance");
        }}
      >
        <Icon name="ruler" />
      </button>
      {state.scene.value && (
        <button
          type="button"
          title="Align mesh and footprints by pairs of points"
          aria-label="Align mesh and footprints"
          aria-pressed={aligning.value !== null}
          onClick={() => {
            measure(null);
            align(aligning.value === null);
          }}
        >
          <Icon name="pairs" />
        </button>
      )}
      <button
        type="button"
        title={state.other.value ? "Drag a boundary between what is compared" : "Drag a boundary between the scan and the models"}
        aria-label="Divide the view"
        aria-pressed={divided.value !== null}
        onClick={() => (divided.value = divided.value === null ? 0.5 : null)}
      >
        <Icon name="divide" />
      </button>
      <button
        type="button"
        title="Picture and link (p)"
        aria-label="Picture and link"
        aria-expanded={state.pictureOpen.value}
        onClick={() => (state.pictureOpen.value = !state.pictureOpen.value)}
      >
        <Icon name="camera" />
      </button>
      <button
        type="button"
        title="Layers (l)"
        aria-label="Layers"
        aria-expanded={open}
        onClick={() => (state.layersOpen.value = !open)}
      >
        <Icon name="layers" />
      </button>
      {cut && <SectionControls cut={cut} />}
    </div>
  );
}

export const toggleSection = () => (section.value = section.value ? null : atSelection());

const directions = [
  { name: "looking east or west", azimuth: 90, tilt: 0 },
  { name: "looking north or south", azimuth: 0, tilt: 0 },
  { name: "horizontal", azimuth: 0, tilt: 90 },
] as const;

function SectionControls({ cut }: { cut: SectionPlane }) {
  // The range depends on what is shown.
  void state.run.value;
  const [least, most] = viewer.value?.reachOf(cut) ?? [-10, 10];
  const named = directions.findIndex((d) => d.tilt === cut.tilt && (cut.tilt === 90 || d.azimuth === cut.azimuth));
  const change = (by: Partial<SectionPlane>) => (section.value = { ...cut, ...by });
  return (
    <div class="section-controls" role="group" aria-label="Section plane">
      <button type="button" class="wide" title="Put the plane across the selected building" onClick={() => (section.value = atSelection())}>
        At the selection
      </button>
      <select
        aria-label="Direction of the section plane"
        value={named >= 0 ? String(named) : "free"}
        onChange={(e) => {
          const chosen = directions[Number(e.currentTarget.value)];
          if (chosen) change({ azimuth: chosen.azimuth, tilt: chosen.tilt, offset: 0 });
        }}
      >
        {directions.map((d, i) => (
          <option key={d.name} value={String(i)}>
            {d.name}
          </option>
        ))}
        <option value="free">any direction</option>
      </select>
      {cut.tilt < 90 && (
        <label>
          <span class="quiet">turn</span>
          <input
            type="range"
            min="0"
            max="179"
            step="1"
            value={cut.azimuth}
            aria-label="Direction of the plane's normal"
            aria-valuetext={`${cut.azimuth} degrees from north`}
            onInput={(e) => change({ azimuth: Number(e.currentTarget.value) })}
          />
          <output>{cut.azimuth}°</output>
        </label>
      )}
      <label>
        <span class="quiet">tilt</span>
        <input
          type="range"
          min="0"
          max="90"
          step="1"
          value={cut.tilt}
          aria-label="Tilt of the plane's normal"
          aria-valuetext={`${cut.tilt} degrees`}
          onInput={(e) => change({ tilt: Number(e.currentTarget.value) })}
        />
      </label>
      <label>
        <span class="quiet">move</span>
        <input
          type="range"
          min={least.toFixed(2)}
          max={most.toFixed(2)}
          step="0.05"
          value={cut.offset}
          aria-label="Position of the section plane"
          aria-valuetext={`${cut.offset.toFixed(1)} metres from its origin`}
          onInput={(e) => change({ offset: Number(e.currentTarget.value) })}
        />
        <output>{cut.offset.toFixed(1)} m</output>
      </label>
      <button
        type="button"
        title="Show the other side"
        aria-label="Show the other side"
        aria-pressed={cut.flipped}
        onClick={() => change({ flipped: !cut.flipped })}
      >
        <Icon name="flip" />
      </button>
    </div>
  );
}
