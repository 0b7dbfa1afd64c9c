// The keys that work everywhere, and the sheet that lists them.
import { useEffect, useRef } from "preact/hooks";
import * as actions from "../actions";
import { reviewKeys, reviewPressed } from "../review/keys";
import * as state from "../state";
import { align, aligning, takeBack } from "../view/align";
import { measure, measuring, removePoint } from "../view/measure";
import { toggleSection } from "../view/toolbar";
import { Icon } from "./icons";
import { Manual } from "./manual";

const keys: [keys: string, does: string][] = [
  ["f", "zoom to the selection"],
  ["h", "show all"],
  ["t", "view from above; press again to show all from above"],
  ["l", "show or hide the layers"],
  ["x", "section plane through the selection"],
  ["m", "measure"],
  ["p", "picture and link"],
  ["/", "search buildings"],
  ["[  ]", "previous building, next building"],
  ["Ctrl Z", "undo"],
  ["Ctrl Shift Z", "redo"],
  ["Esc", "close, or clear the selection"],
  ["?", "show or hide this list and the manual"],
];
const pointer: [what: string, does: string][] = [
  ["drag", "rotate"],
  ["right drag, Ctrl drag", "move"],
  ["wheel, pinch", "zoom at the pointer"],
  ["click", "select a building, part and edge"],
  ["Shift click", "select another part: to merge them, or to change all of them"],
  ["drag a handle of the roof", "move a ridge, an eave or a face"],
  ["drag a dashed line of the plan", "turn the roof plane that rises from that corner"],
  ["arrows on a roof shape", "show the next shape; Enter keeps it, Esc goes back"],
  ["arrows, Shift arrows, + −", "move, rotate and zoom while the view has the focus"],
];

export function HelpSheet() {
  const close = useRef<HTMLButtonElement>(null);
  useEffect(() => close.current?.focus(), []);
  return (
    <div class="sheet-back" onClick={() => (state.keyboardHelp.value = false)}>
      <div
        class={"sheet" + (state.helpPage.value === "manual" ? " wide" : "")}
        role="dialog"
        aria-modal="true"
        aria-label={state.helpPage.value === "keys" ? "Keyboard" : "Manual"}
        onClick={(e) => e.stopPropagation()}
      >
        <div class="sheet-head">
          <div class="help-pages">
            {(["keys", "manual"] as const).map((page) => (
              <button
                key={page}
                type="button"
                class="small"
                aria-pressed={state.helpPage.value === page}
                onClick={() => (state.helpPage.value = page)}
              >
                {page === "keys" ? "Keyboard and mouse" : "Manual"}
              </button>
            ))}
          </div>
          <button
            ref={close}
            type="button"
            class="plain"
            aria-label="Close"
            onClick={() => (state.keyboardHelp.value = false)}
          >
            <Icon name="close" />
          </button>
        </div>
        {state.helpPage.value === "manual" && <Manual />}
        {state.helpPage.value === "keys" && [keys, pointer, reviewKeys].map((rows, i) => (
          <dl key={i} aria-label={["Keys", "Pointer", "Keys of the panel Review"][i]}>
            {rows.map(([what, does]) => (
              <>
                <dt>
                  {i !== 1
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

/** Handles keys that no field or editor has handled. */
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
  if (!state.keyboardHelp.value && !state.pictureOpen.value && reviewPressed(e.key, e.timeStamp)) {
    e.preventDefault();
    return;
  }
  const acts: Record<string, () => void> = {
    f: () => actions.fly("selection"),
    h: () => actions.fly("home"),
    t: () => actions.fly("top"),
    l: () => (state.layersOpen.value = !state.layersOpen.value),
    x: () => toggleSection(),
    m: () => {
      align(false);
      measure(measuring.value ? null : "distance");
    },
    p: () => (state.pictureOpen.value = !state.pictureOpen.value),
    v: () => (state.tab.value = "review"),
    "/": () => {
      state.tab.value = "buildings";
      requestAnimationFrame(() => document.querySelector<HTMLElement>("[aria-label='Filter buildings']")?.focus());
    },
    Backspace: () => (aligning.value ? takeBack() : measuring.value && removePoint()),
    "[": () => actions.selectNext(-1),
    "]": () => actions.selectNext(1),
    "?": () => (state.keyboardHelp.value = !state.keyboardHelp.value),
    Escape: () => {
      if (state.keyboardHelp.value) state.keyboardHelp.value = false;
      else if (state.changingInputs.value) state.changingInputs.value = false;
      else if (state.pictureOpen.value) state.pictureOpen.value = false;
      else if (measuring.value) measure(null);
      else if (aligning.value) align(false);
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
