// The keyboard, on a sheet; and the keys that work everywhere.
import { useEffect, useRef } from "preact/hooks";
import * as actions from "../actions";
import * as state from "../state";
import { Icon } from "./icons";

const keys: [keys: string, does: string][] = [
  ["f", "fly to the selection"],
  ["h", "show everything"],
  ["t", "from above; once more: everything from above"],
  ["l", "layers"],
  ["[  ]", "previous, next building"],
  ["Ctrl Z", "undo"],
  ["Ctrl Shift Z", "redo"],
  ["Esc", "close, or select nothing"],
  ["?", "this sheet"],
];
const pointer: [what: string, does: string][] = [
  ["drag", "turn"],
  ["right drag, Ctrl drag", "move"],
  ["wheel, pinch", "zoom to the pointer"],
  ["click", "select building, part and edge"],
  ["Shift click", "add a part, for merging"],
  ["arrows, Shift arrows, + −", "the same with the view in focus"],
];

export function HelpSheet() {
  const close = useRef<HTMLButtonElement>(null);
  useEffect(() => close.current?.focus(), []);
  return (
    <div class="sheet-back" onClick={() => (state.sheet.value = false)}>
      <div class="sheet" role="dialog" aria-modal="true" aria-label="Keyboard" onClick={(e) => e.stopPropagation()}>
        <header>
          <h2>Keyboard and pointer</h2>
          <button
            ref={close}
            type="button"
            class="plain"
            aria-label="Close"
            onClick={() => (state.sheet.value = false)}
          >
            <Icon name="close" />
          </button>
        </header>
        {[keys, pointer].map((rows, i) => (
          <dl key={i}>
            {rows.map(([what, does]) => (
              <>
                <dt>
                  {i === 0
                    ? what
                        .split(" ")
                        .filter(Boolean)
                        .map((k) => <kbd key={k}>{k}</kbd>)
                    : what}
                </dt>
                <dd>{does}</dd>
              </>
            ))}
          </dl>
        ))}
      </div>
    </div>
  );
}

const typing = (target: EventTarget | null) =>
  target instanceof HTMLElement &&
  target.closest("input:not([type=checkbox]):not([type=radio]):not([type=range]), textarea, select") !== null;

/** Keys that no field or editor took. */
export function pressed(e: KeyboardEvent) {
  if (e.defaultPrevented) return;
  const command = e.ctrlKey || e.metaKey;
  if (command && e.key.toLowerCase() === "z" && !typing(e.target)) {
    e.preventDefault();
    void (e.shiftKey ? actions.redo() : actions.undo());
    return;
  }
  if (command && e.key.toLowerCase() === "y" && !typing(e.target)) {
    e.preventDefault();
    void actions.redo();
    return;
  }
  if (command || e.altKey || typing(e.target)) return;
  const acts: Record<string, () => void> = {
    f: () => actions.fly("selection"),
    h: () => actions.fly("home"),
    t: () => actions.fly("top"),
    l: () => (state.layersOpen.value = !state.layersOpen.value),
    "[": () => actions.selectNext(-1),
    "]": () => actions.selectNext(1),
    "?": () => (state.sheet.value = !state.sheet.value),
    Escape: () => {
      if (state.sheet.value) state.sheet.value = false;
      else if (state.asksInputs.value) state.asksInputs.value = false;
      else if (state.layersOpen.value) state.layersOpen.value = false;
      else if (state.choosing.value) state.choosing.value = false;
      else if (!state.draft.value) actions.select(null);
    },
  };
  const act = acts[e.key];
  if (!act) return;
  e.preventDefault();
  act();
}
