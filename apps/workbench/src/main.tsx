import { effect } from "@preact/signals";
import { render } from "preact";
import { begin, compareWith, newLink, openRun } from "./actions";
import { App } from "./app";
import { keep, kept } from "./keep";
import * as state from "./state";
import "./style.css";
import { followLink, takeLink } from "./view/link";
import { type ViewHandle, handle } from "./view/view";

declare global {
  interface Window {
    /** For tests and screenshots: the signals of the page, and the view. `view.project(building)` is the position of the top
     *  of a building on the page; `view.idle()` resolves when nothing moves, loads or waits to be drawn. */
    mansard: { state: typeof state; view: ViewHandle };
  }
}
window.mansard = Object.assign(window.mansard ?? {}, { state, view: handle });

state.tab.value = kept<state.Tab>("session", "tab", "run");
effect(() => keep("session", "tab", state.tab.value));

window.addEventListener("hashchange", newLink);
takeLink();
render(<App />, document.getElementById("app")!);
followLink(openRun, compareWith);
void begin(new AbortController().signal);
