// What can be shown, hidden and made see-through. The choices are kept for good.
import { computed, effect, signal } from "@preact/signals";
import { keep, kept } from "../keep";

export type LayerId =
  | "mesh"
  | "meshWithin"
  | "footprints"
  | "walls"
  | "roofs"
  | "parties"
  | "outlines"
  | "error"
  | "sweep"
  | "faces"
  | "cuts"
  | "clean"
  | "raw"
  | "diagnostics";

export interface Layer {
  id: LayerId;
  name: string;
  group: string;
  colour: string; // css
  meaning: string;
  shown: boolean; // at first
  fade: boolean; // has an opacity
}

const layer = (group: string, id: LayerId, name: string, colour: string, meaning: string, shown = true, fade = true) =>
  ({ group, id, name, colour, meaning, shown, fade }) satisfies Layer;

export const list: readonly Layer[] = [
  layer("Input", "mesh", "Photogrammetric mesh", "#7a9acc", "The scan; coarse at first, finer where one is near."),
  layer(
    "Input",
    "meshWithin",
    "… also where models stand",
    "#7a9acc",
    "Off: the scan is left out where a model stands, so that the model can be seen.",
    false,
    false,
  ),
  layer("Input", "footprints", "Footprints", "#f08c1e", "Outlines of the map, at the height of the ground."),
  layer("Models", "walls", "Walls", "#d8d4cc", "Faces that came from vertical parts of profiles."),
  layer("Models", "roofs", "Roofs", "#b06250", "Everything sloping or flat on top."),
  layer("Models", "parties", "Party walls", "#96969e", "Walls that another part stands against."),
  layer("Models", "outlines", "Edges", "#26282e", "Outlines of the models' faces."),
  layer("Models", "error", "Vertical error", "#b2182b", "Model above (red) or below (blue) the scan, on roofs.", false),
  layer(
    "Why",
    "sweep",
    "Sweep-edges",
    "#7d3fb4",
    "Walls' lines found in the scan, from their lowest to their highest evidence.",
    false,
  ),
  layer(
    "Why",
    "faces",
    "Fractured ground",
    "#4f9d69",
    "The pieces the ground was cut into, tinted by the part they went to; a plan above the roofs.",
    false,
  ),
  layer(
    "Why",
    "cuts",
    "Cuts and their costs",
    "#c2410c",
    "Between the pieces: bold where cut; orange where the cut was cheaper, blue where joining was.",
    false,
  ),
  layer(
    "Profiles",
    "clean",
    "Clean profiles",
    "#0f766e",
    "Of the selected part, standing in the middle of its edges.",
    true,
    false,
  ),
  layer("Profiles", "raw", "Raw profiles", "#2563eb", "What the scan shows across the same edges.", false, false),
  layer("Marks", "diagnostics", "Diagnostics", "#b45309", "Buildings with something to say about them.", true, false),
];

export interface Choice {
  shown: boolean;
  opacity: number; // 0 … 1
}
export type Choices = Record<LayerId, Choice>;

export function choicesFrom(stored: Partial<Record<string, Partial<Choice>>>): Choices {
  const one = (l: Layer): Choice => {
    const { shown, opacity } = stored[l.id] ?? {};
    return {
      shown: typeof shown === "boolean" ? shown : l.shown,
      opacity: typeof opacity === "number" && opacity >= 0 && opacity <= 1 ? opacity : 1,
    };
  };
  return Object.fromEntries(list.map((l) => [l.id, one(l)])) as Choices;
}

export const choices = signal<Choices>(choicesFrom(kept("local", "layers", {})));
export const errorLimit = signal(kept("local", "error limit", 2)); // m: full colour
effect(() => keep("local", "layers", choices.value));
effect(() => keep("local", "error limit", errorLimit.value));

export const choose = (id: LayerId, change: Partial<Choice>) =>
  (choices.value = { ...choices.value, [id]: { ...choices.value[id], ...change } });

/** 0 where hidden. */
export const opacity = (id: LayerId) => computed(() => (choices.value[id].shown ? choices.value[id].opacity : 0));

/** A vertical or level plane that hides one side of everything. */
export interface SectionPlane {
  axis: "x" | "y" | "z";
  share: number; // 0 … 1 of the extent
  flipped: boolean;
}
export const section = signal<SectionPlane | null>(null);
