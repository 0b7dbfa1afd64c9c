// The layers of the view. Which are shown, and their opacities, is stored in the browser.
import { computed, effect, signal } from "@preact/signals";
import { keep, kept } from "../keep";
import type { SectionPlane } from "./section";

export type LayerId =
  | "mesh"
  | "texture"
  | "terrain"
  | "basemap"
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
  | "diagnostics"
  | "others";

export interface Layer {
  id: LayerId;
  name: string;
  group: string;
  colour: string; // css
  meaning: string;
  shown: boolean; // by default
  fade: boolean; // whether the opacity can be set
}

const layer = (group: string, id: LayerId, name: string, colour: string, meaning: string, shown = true, fade = true) =>
  ({ group, id, name, colour, meaning, shown, fade }) satisfies Layer;

export const list: readonly Layer[] = [
  layer("Input", "mesh", "Photogrammetric mesh", "#7a9acc", "The input mesh. It is loaded in more detail near the camera."),
  layer(
    "Input",
    "texture",
    "Texture",
    "#8a7f5c",
    "The colours of the scan, on the scan and on the models as they are. They are read when this is shown first.",
    false,
    false,
  ),
  layer(
    "Input",
    "meshWithin",
    "Mesh inside models",
    "#7a9acc",
    "If off, the mesh is hidden where there are models.",
    false,
    false,
  ),
  layer(
    "Input",
    "basemap",
    "Basemap",
    "#7d9a6a",
    "A picture of the ground under the models: a raster or tiles that the server was started with. Tiles of another server are fetched when this is shown.",
    false,
  ),
  layer("Input", "footprints", "Footprints", "#f08c1e", "Input footprints, at ground height."),
  layer(
    "Models",
    "terrain",
    "Terrain",
    "#9aa583",
    "The ground around the models, joined to their outlines. Export writes it too.",
    false,
  ),
  layer("Models", "walls", "Walls", "#d8d4cc", "Faces of vertical profile segments."),
  layer("Models", "roofs", "Roofs", "#b06250", "Sloping and flat roof faces."),
  layer("Models", "parties", "Party walls", "#96969e", "Walls that are shared with another part."),
  layer("Models", "outlines", "Edges", "#26282e", "Outlines of the faces of the models."),
  layer("Models", "others", "Models of others", "#5b8c5a", "Models of another program that were opened beside those of the run."),
  layer("Models", "error", "Vertical error", "#b2182b", "On roofs: model above (red) or below (blue) the mesh.", false),
  layer(
    "Segmentation",
    "sweep",
    "Sweep-edges",
    "#7d3fb4",
    "Lines of walls found in the mesh, from their lowest to their highest evidence.",
    false,
  ),
  layer(
    "Segmentation",
    "faces",
    "Partition faces",
    "#4f9d69",
    "The faces of the partition, coloured by part; drawn above the roofs.",
    false,
  ),
  layer(
    "Segmentation",
    "cuts",
    "Cuts and their costs",
    "#c2410c",
    "The edges of the partition: bold if they separate parts; orange where a cut costs less, blue where joining costs less.",
    false,
  ),
  layer(
    "Profiles",
    "clean",
    "Clean profiles",
    "#0f766e",
    "Profiles of the selected part, at the middle of its edges.",
    true,
    false,
  ),
  layer("Profiles", "raw", "Raw profiles", "#2563eb", "Profiles of the mesh across the same edges.", false, false),
  layer("Marks", "diagnostics", "Diagnostics", "#b45309", "Marks on buildings with diagnostics.", true, false),
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

export const section = signal<SectionPlane | null>(null);
/** The level of detail at which models are drawn. */
export type Lod = "1.2" | "1.3" | "2.0" | "2.2";
export const lod = signal<Lod>("2.2");
/** Share of the width at which the view is divided: the scan or the run on its left, the models or the other run on its
 *  right. Null: it is not. */
export const divided = signal<number | null>(null);
/** Whether a review shows the scan beside the model. */
export const besideWanted = signal(kept("local", "beside", true));
effect(() => keep("local", "beside", besideWanted.value));
