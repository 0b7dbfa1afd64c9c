// The buttons of the view: camera, section plane, layers.
import { fly } from "../actions";
import { Icon } from "../panels/icons";
import * as state from "../state";
import { viewer } from "./current";
import { type SectionPlane, section } from "./layers";

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
        title="Section plane"
        aria-label="Section plane"
        aria-pressed={cut !== null}
        onClick={() => (section.value = cut ? null : { axis: "x", share: 0.5, flipped: false })}
      >
        <Icon name="section" />
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

function SectionControls({ cut }: { cut: SectionPlane }) {
  const at = viewer.value?.sectionAt(cut);
  const name = { x: "east", y: "north", z: "height" }[cut.axis];
  return (
    <div class="section-controls">
      <select
        aria-label="Axis of the section plane"
        value={cut.axis}
        onChange={(e) => (section.value = { ...cut, axis: e.currentTarget.value as SectionPlane["axis"] })}
      >
        <option value="x">East–west</option>
        <option value="y">North–south</option>
        <option value="z">Height</option>
      </select>
      <input
        type="range"
        min="0"
        max="1"
        step="0.002"
        value={cut.share}
        aria-label="Position of the section plane"
        aria-valuetext={at === undefined ? undefined : `${name} ${at.toFixed(1)} metres`}
        onInput={(e) => (section.value = { ...cut, share: Number(e.currentTarget.value) })}
      />
      <output>{at === undefined ? "" : `${at.toFixed(1)} m`}</output>
      <button
        type="button"
        title="Show the other side"
        aria-label="Show the other side"
        aria-pressed={cut.flipped}
        onClick={() => (section.value = { ...cut, flipped: !cut.flipped })}
      >
        <Icon name="flip" />
      </button>
    </div>
  );
}
