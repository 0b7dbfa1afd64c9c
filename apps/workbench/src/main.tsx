import { effect } from "@preact/signals";
import { render } from "preact";
import { begin, newLink } from "./actions";
import { App } from "./app";
import { keep, kept } from "./keep";
import * as state from "./state";
import "./style.css";
import { type ViewHandle, handle } from "./view/view";

declare global {
  interface Window {
    /** For tests and screenshots: the page's signals, and the view. `view.project(building)` gives the place on the page
     *  of the top of a building; `view.idle()` resolves when nothing moves, loads or waits to be drawn. */
    mansard: { state: typeof state; view: ViewHandle };
  }
}
window.mansard = Object.assign(window.mansard ?? {}, { state, view: handle });

state.tab.value = kept<state.Tab>("session", "tab", "run");
effect(() => keep("session", "tab", state.tab.value));

window.addEventListener("hashchange", newLink);
render(<App />, document.getElementById("app")!);
void begin(new AbortController().signal);
