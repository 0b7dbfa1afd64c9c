// Links that restore the view: the run, the selection, the camera, and what is shown. They do not contain the token.
import { effect } from "@preact/signals";
import * as state from "../state";
import type { Pose } from "./camera";
import { viewer } from "./current";
import { type Choices, type Lod, choices, choicesFrom, divided, errorLimit, lod, section } from "./layers";
import type { SectionPlane } from "./section";
import { styledBy } from "./styling";

export interface Linked {
  run?: string;
  other?: string;
  selection?: state.Selection | null;
  tab?: state.Tab;
  pose?: Pose;
  layers?: Partial<Choices>;
  limit?: number;
  section?: SectionPlane | null;
  style?: string | null;
  lod?: Lod;
  divided?: number | null;
}

/** UTF-8 as base64url, which needs no escapes in an address. */
export function encoded(link: Linked): string {
  const bytes = new TextEncoder().encode(JSON.stringify(link));
  return btoa(String.fromCharCode(...bytes)).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}
/** Null for text that is no link. */
export function decoded(text: string): Linked | null {
  try {
    const bytes = Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), (c) => c.charCodeAt(0));
    const link: unknown = JSON.parse(new TextDecoder().decode(bytes));
    return typeof link === "object" && link !== null ? (link as Linked) : null;
  } catch {
    return null;
  }
}

/** The page as it is now. */
export function linkNow(): Linked {
  return {
    run: state.run.value?.id,
    other: state.other.value?.id,
    selection: state.selection.value,
    tab: state.tab.value,
    pose: viewer.value?.seenFrom,
    layers: choices.value,
    limit: errorLimit.value,
    section: section.value,
    style: styledBy.value,
    lod: lod.value,
    divided: divided.value,
  };
}
export const address = () => `${location.origin}${location.pathname}#view=${encoded(linkNow())}`;

let given: Linked | null = null;
/** Takes the link of the address, if there is one, and removes it from there. */
export function takeLink() {
  const fragment = new URLSearchParams(location.hash.slice(1));
  const text = fragment.get("view");
  if (!text) return;
  given = decoded(text);
  history.replaceState(null, "", location.pathname + location.search);
  if (!given) return;
  if (given.layers) choices.value = choicesFrom(given.layers);
  if (typeof given.limit === "number" && given.limit > 0) errorLimit.value = given.limit;
  section.value = given.section ?? null;
  styledBy.value = given.style ?? null;
  if (given.lod && ["1.2", "1.3", "2.0", "2.2"].includes(given.lod)) lod.value = given.lod;
  divided.value = given.divided ?? null;
  if (given.tab) state.tab.value = given.tab;
}
export const linkedPose = () => given?.pose ?? null;

/** Opens the run and the selection of the link, once the project is known. */
export function followLink(open: (run: string, at: state.Selection | null) => Promise<void>, compare: (run: string) => Promise<void>) {
  const link = given;
  if (!link?.run) return;
  let stop = () => {};
  let done = false;
  stop = effect(() => {
    const runs = state.project.value?.runs.filter((r) => r.state === "done");
    if (!runs || done) return;
    // The page opens the run of its last visit first.
    if (runs.length && (state.opening.value || !state.run.value)) return;
    done = true;
    queueMicrotask(async () => {
      stop();
      if (!runs.some((r) => r.id === link.run)) return;
      await open(link.run!, link.selection ?? null);
      if (link.other && runs.some((r) => r.id === state.runOf(link.other!))) await compare(link.other);
    });
  });
}
