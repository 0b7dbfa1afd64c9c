// The list of layers with their opacities: in a popover of the view, and in the sidebar.
import { Icon } from "../panels/icons";
import * as state from "../state";
import { type Layer, choices, choose, errorLimit, list } from "./layers";

const groups = [...new Set(list.map((l) => l.group))];

export function LayerList() {
  return (
    <div class="layer-list">
      {groups.map((group) => (
        <fieldset key={group}>
          <legend>{group}</legend>
          {list
            .filter((l) => l.group === group)
            .map((l) => (
              <Row key={l.id} layer={l} />
            ))}
        </fieldset>
      ))}
    </div>
  );
}

function Row({ layer }: { layer: Layer }) {
  const { shown, opacity } = choices.value[layer.id];
  return (
    <div class="layer-row" title={layer.meaning}>
      <label>
        <input type="checkbox" checked={shown} onChange={(e) => choose(layer.id, { shown: e.currentTarget.checked })} />
        <span class="swatch" style={{ background: layer.colour }} aria-hidden="true" />
        {layer.name}
      </label>
      {layer.id === "error" && shown && (
        <select
          aria-label="Error with full colour"
          value={errorLimit.value}
          onChange={(e) => (errorLimit.value = Number(e.currentTarget.value))}
        >
          {[0.25, 0.5, 1, 2, 5].map((m) => (
            <option key={m} value={m}>
              ±{m} m
            </option>
          ))}
        </select>
      )}
      {layer.fade && (
        <input
          type="range"
          min="0.1"
          max="1"
          step="0.05"
          value={opacity}
          disabled={!shown}
          aria-label={`Opacity of ${layer.name}`}
          aria-valuetext={`${Math.round(opacity * 100)} percent`}
          onInput={(e) => choose(layer.id, { opacity: Number(e.currentTarget.value) })}
        />
      )}
    </div>
  );
}

export function LayersPopover() {
  return (
    <div class="popover layers-popover" role="dialog" aria-label="Layers">
      <header>
        <h2>Layers</h2>
        <button
          type="button"
          class="plain"
          aria-label="Close layers"
          onClick={() => (state.layersOpen.value = false)}
        >
          <Icon name="close" />
        </button>
      </header>
      <LayerList />
    </div>
  );
}
