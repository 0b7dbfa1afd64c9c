// The list of layers with their opacities: in a popover of the view, and in the sidebar.
import { Icon } from "../panels/icons";
import * as state from "../state";
import { closeOther, openOther } from "../actions";
import { type Layer, type Lod, choices, choose, errorLimit, list, lod } from "./layers";
import { own, styledBy } from "./styling";
import { needAttributes } from "../actions";
import { useEffect } from "preact/hooks";
import { signal } from "@preact/signals";

const groups = [...new Set(list.map((l) => l.group))];

export function LayerList() {
  return (
    <div class="layer-list">
      <ModelChoices />
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

/** The attribute that colours the models, their level of detail, and models of other programs. */
function ModelChoices() {
  const run = state.run.value?.id;
  const large = state.run.value?.large;
  useEffect(() => {
    if (run && !large) void needAttributes(run);
  }, [run]);
  if (!run) return null;
  const known = large?.attributes ?? state.attributes.value.get(run)?.attributes;
  const [ours, source] = [false, true].map((s) => known?.filter((a) => a.source === s) ?? []);
  const option = (a: { name: string; unit: string; meaning: string }) => (
    <option key={a.name} value={a.name} title={a.meaning}>
      {a.name}
      {a.unit && ` (${a.unit})`}
    </option>
  );
  return (
    <fieldset>
      <legend>Appearance</legend>
      <label class="field row">
        Colour by
        <select
          aria-label="Colour by"
          value={styledBy.value ?? ""}
          onChange={(e) => (styledBy.value = e.currentTarget.value || null)}
        >
          <option value="">class of faces</option>
          {Object.entries(own).map(([key, name]) => (
            <option key={key} value={`own ${key}`}>
              {name}
            </option>
          ))}
          <optgroup label="Computed by mansard">{ours!.map(option)}</optgroup>
          {source!.length > 0 && <optgroup label="Of the source">{source!.map(option)}</optgroup>}
        </select>
      </label>
      <label class="field row">
        Level of detail
        <select aria-label="Level of detail" value={lod.value} onChange={(e) => (lod.value = e.currentTarget.value as Lod)}>
          <option value="1.2">LoD 1.2</option>
          <option value="1.3">LoD 1.3</option>
          <option value="2.0">LoD 2.0</option>
          <option value="2.2">LoD 2.2 (as edited)</option>
        </select>
      </label>
      <OtherModels />
    </fieldset>
  );
}

const otherPath = signal("");
function OtherModels() {
  return (
    <details>
      <summary>Models of others</summary>
      <form
        class="field row"
        onSubmit={(e) => {
          e.preventDefault();
          void openOther(otherPath.value.trim()).then((opened) => {
            if (opened) otherPath.value = "";
          });
        }}
      >
        <input
          type="text"
          spellcheck={false}
          aria-label="Path of models of another program"
          placeholder="/data/city/3dbag.city.json"
          value={otherPath.value}
          onInput={(e) => (otherPath.value = e.currentTarget.value)}
        />
        <button type="submit" class="small" disabled={!otherPath.value.trim()}>
          Show
        </button>
      </form>
      {state.others.value.map(({ name, model }) => (
        <div class="layer-row" key={name}>
          <span class="swatch" style={{ background: "#5b8c5a" }} aria-hidden="true" />
          <span>{name}</span> <span class="quiet">{model.buildings.length} buildings{model.lod && `, LoD ${model.lod}`}</span>
          <span class="spring" />
          <button type="button" class="plain" aria-label={`Close ${name}`} onClick={() => closeOther(name)}>
            <Icon name="close" />
          </button>
        </div>
      ))}
    </details>
  );
}
