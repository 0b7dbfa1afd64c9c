// The 3D view as a component: passes signals to the viewer, and clicks and motions to the actions.
import { computed, effect, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as actions from "../actions";
import type * as api from "../api/types";
import { measureDrawn } from "../edit/latency";
import { keep, kept } from "../keep";
import * as state from "../state";
import { addPlace, aligning } from "./align";
import { AlignBox } from "./align_box";
import type { Pose, Vector } from "./camera";
import { reasonsOf } from "../panels/reasons";
import { nameOf } from "../panels/words";
import { viewer } from "./current";
import type { RawClimbs } from "./highlight";
import { Attribution, Furniture } from "./furniture";
import { Handles } from "../edit/handles_layer";
import { caseDrawn } from "../review/pace";
import { current, decisions, queue, shownCase } from "../review/review";
import { isMarked, nextOpen } from "../review/queue";
import { type Choices, besideWanted, choices, choose, divided, errorLimit, lod, section } from "./layers";
import { LayersPopover } from "./layers_panel";
import { Legend } from "./legend";
import { linkedPose } from "./link";
import { MeasureBox } from "./measure_box";
import { addPoint, measuring, points } from "./measure";
import { PictureDialog } from "./picture_dialog";
import { scale } from "./styled";
import { dark } from "./theme";
import type { Hit } from "./pick";
import { Toolbar } from "./toolbar";
import { Viewer } from "./viewer";

/** For tests and screenshots: `window.mansard.view`. */
export interface ViewHandle {
  project(building: string): { x: number; y: number } | null;
  /** Triangles that fill the cut of the section plane. */
  filled(): number;
  /** Tiles and buildings that are drawn with the pictures of the scan. */
  pictures(): [number, number];
  /** The place of a point of the scene's frame on the page. */
  place(at: [number, number, number]): { x: number; y: number } | null;
  /** Whether a picture of the ground is drawn. */
  basemap(): boolean;
  /** Triangles of the terrain that are drawn. */
  terrain(): number;
  idle(): Promise<void>;
}
const failure = signal("");
const images = signal(0); // that were drawn

export const handle: ViewHandle = {
  project: (building) => viewer.value?.project(building) ?? null,
  filled: () => viewer.value?.filled ?? 0,
  place: (at) => viewer.value?.placeOf(at) ?? null,
  basemap: () => viewer.value?.basemapThere ?? false,
  terrain: () => viewer.value?.terrainTriangles ?? 0,
  pictures: () => viewer.value?.pictures ?? [0, 0],
  idle: async () => {
    while (state.opening.value || rawBusy) await new Promise((resolve) => setTimeout(resolve, 25));
    await viewer.value?.idle();
  },
};

const poseKey = () => `camera ${state.project.value?.folder ?? ""}`;

/** The buildings as they are drawn: at the chosen level of detail. */
const drawnBuildings = computed((): Map<string, api.Building> | null => {
  const run = state.run.value;
  if (!run || lod.value === "2.2") return run?.buildings ?? null;
  const level = state.levels.value.get(`${run.id} ${lod.value}`);
  if (!level) return run.buildings;
  const solids = new Map(level.buildings.map((b) => [b.id, b.solids]));
  const at = (b: api.Building): api.Building => ({
    ...b,
    parts: (solids.get(b.id) ?? []).flatMap((geometry, i) => {
      const part = b.parts[Math.min(i, b.parts.length - 1)];
      return part ? [{ ...part, geometry }] : [];
    }),
  });
  return new Map([...run.buildings].map(([id, b]) => [id, at(b)]));
});

/** Two panes: the scan on the left, the models on the right. */
const beside = computed(
  () => state.tab.value === "review" && besideWanted.value && state.tiles.value !== null && state.run.value !== null && !state.other.value,
);

function clicked(
  hit: Hit | null,
  footprint: api.SceneFootprint | null,
  more: boolean,
  place: Vector | null,
  corner: Vector | null,
) {
  if (aligning.value) {
    const begun = aligning.value.scan !== null;
    if (!addPlace(place, corner))
      actions.showMessage({
        severity: "warning",
        code: "align-place",
        message: begun ? "no corner of a footprint is near this place; move the camera, or click nearer to one" : "there is no scan at this place",
        subject: "",
      });
    return;
  }
  if (measuring.value) {
    if (place) addPoint(place);
    return;
  }
  if (state.choosing.value) {
    const name = blockOf(hit?.building) ?? footprint?.block;
    if (!name) return;
    const blocks = new Set(state.chosenBlocks.value);
    if (!blocks.delete(name)) blocks.add(name);
    state.chosenBlocks.value = blocks;
    return;
  }
  if (hit?.part && more) return actions.selectAlso(hit.building, hit.part);
  if (hit) return actions.select({ building: hit.building, part: hit.part, ring: hit.ring, edge: hit.edge });
  const known = footprint && state.run.value?.buildings.has(footprint.id);
  actions.select(known ? { building: footprint.id, part: null, ring: 0, edge: null } : null);
}
const blockOf = (building: string | undefined) =>
  building === undefined ? undefined : (state.run.value?.buildings.get(building)?.block ?? undefined);

let rawBusy = false;

/** Fetches the raw profiles of the selected part, edge by edge; stops when the selection changes. */
function watchRaw(to: Viewer) {
  let last = "";
  let stop = new AbortController();
  return effect(() => {
    const run = state.run.value;
    const at = state.selection.value;
    const building = at && run?.buildings.get(at.building);
    const part = building?.parts.find((p) => p.id === at!.part);
    const wanted =
      choices.value.raw.shown && state.sceneRead.value && run && part ? `${run.id} ${building!.id} ${building!.revision} ${part.id}` : "";
    if (wanted === last) return;
    last = wanted;
    stop.abort();
    stop = new AbortController();
    to.setRaw(undefined, []);
    if (wanted) void fetchRaw(to, run!.id, building!.id, part!, stop.signal);
  });
}
async function fetchRaw(to: Viewer, run: string, building: string, part: api.RaisedPart, stop: AbortSignal) {
  rawBusy = true;
  const climbs: RawClimbs[] = [];
  const rings = [part.plan.outer, ...part.plan.holes];
  const places = rings.flatMap((ring, r) => ring.points.map((_, edge) => ({ ring: r, edge }))).slice(0, 60);
  for (const place of places) {
    const answer = await actions.attempt(
      actions.client.section(run, { building, part: part.id, ...place, share: 0.5 }),
    );
    if (stop.aborted) return;
    if (!answer) break;
    climbs.push({ ...place, climbs: answer.climbs });
  }
  rawBusy = false;
  to.setRaw(part, climbs);
}

function connect(to: Viewer): () => void {
  let placed = "";
  let asked = state.flight.peek()?.at ?? 0;
  const stops = [
    effect(() => {
      const key = poseKey();
      if (!state.project.value || placed === key) return;
      placed = key;
      const pose = linkedPose() ?? kept<Pose | null>("session", key, null) ?? kept<Pose | null>("local", key, null);
      if (pose) to.look(pose);
    }),
    effect(() => to.setScene(state.scene.value)),
    effect(() => to.setTiles(state.tiles.value)),
    effect(() => to.setLarge(state.run.value?.large ?? null)),
    effect(() => {
      const draft = state.draft.value;
      to.setRun(0, drawnBuildings.value, draft?.raised, draft?.invalid);
    }),
    effect(() => {
      const run = state.run.value;
      if (run?.large && lod.value !== "2.2") {
        lod.value = "2.2";
        actions.warn("lod-large", "runs of more than 5,000 buildings are shown at LoD 2.2 only");
      } else if (run && lod.value !== "2.2" && !state.levels.value.has(`${run.id} ${lod.value}`)) void actions.needLevel(run.id, lod.value);
    }),
    effect(() => {
      const wanted = choices.value.texture.shown && state.sceneRead.value;
      if (!wanted || state.texturesRead.value) return;
      void actions.needTextures().then((there) => {
        if (!there) choose("texture", { shown: false });
      });
    }),
    effect(() => {
      const on = choices.value.texture.shown && state.texturesRead.value;
      to.setTextured(on, on && lod.value === "2.2" && scale.value === null);
    }),
    effect(() => {
      const run = state.run.value?.id;
      if (!choices.value.terrain.shown || !run || !state.sceneRead.value || state.terrains.value.has(run)) return;
      void actions.needTerrain(run).then((made) => {
        if (!made) choose("terrain", { shown: false });
      });
    }),
    effect(() => {
      const terrain = state.terrains.value.get(state.run.value?.id ?? "");
      if (terrain || !state.run.value) to.setTerrain(terrain ?? null); // after an edit the old one stays until the new one is there
    }),
    effect(() => {
      const run = state.run.value?.id;
      if (!choices.value.basemap.shown || !run || state.basemaps.value.has(run)) return;
      void actions.needBasemap(run).then((there) => {
        if (!there) choose("basemap", { shown: false });
      });
    }),
    effect(() => to.setBasemap(state.basemaps.value.get(state.run.value?.id ?? "") ?? null)),
    effect(() => to.setPaint(scale.value?.colours ?? null)),
    effect(() => to.setOthers(state.others.value.map((o) => o.model))),
    effect(() => to.setMeasure(points.value, measuring.value === "area")),
    effect(() => to.setPairs(aligning.value?.pairs ?? [], aligning.value?.scan ?? null)),
    effect(() => to.setDark(dark.value)),
    effect(() => to.setDivided(divided.value)),
    effect(() => to.setBeside(beside.value)),
    effect(() => {
      const place = state.tab.value === "review" ? shownCase.value?.place : null;
      to.setPin(place && isMarked(place) ? place.at : null);
    }),
    effect(() => {
      const id = state.tab.value === "review" ? current.value : null;
      to.setCase(id === null ? null : (state.run.value?.buildings.get(id) ?? null));
    }),
    effect(() => {
      const at = state.selection.value?.building;
      to.setNext(state.tab.value === "review" && at !== undefined ? nextOpen(queue.value, decisions.value, at, 2) : []);
    }),
    effect(() => to.setRun(1, state.other.value?.buildings ?? null)),
    ...([0, 1] as const).flatMap((which) => {
      const id = () => (which ? state.other : state.run).value?.id;
      const needsSegmentation = () => choices.value.sweep.shown || choices.value.faces.shown || choices.value.cuts.shown;
      return [
        effect(() => {
          const run = id();
          if (run && !state.isBefore(run) && needsSegmentation()) void actions.needLayers(run);
        }),
        effect(() => {
          const run = id();
          if (run && !state.isBefore(run) && choices.value.error.shown && !state.outdatedMaps.value.has(run) && state.hasMaps((which ? state.other : state.run).value)) void actions.needErrorMaps(run);
        }),
        effect(() => to.setSegmentation(which, state.segmentations.value.get(id() ?? "") ?? null)),
        effect(() => to.setErrorMaps(which, state.errorMaps.value.get(id() ?? "") ?? null)),
      ];
    }),
    effect(() => to.setChoices(state.tab.value === "review" ? withoutMarks(choices.value) : choices.value)),
    effect(() => to.setErrorLimit(errorLimit.value)),
    effect(() => to.setSection(section.value)),
    effect(() => {
      // All parts of a building under review.
      const id = state.tab.value === "review" ? current.value : null;
      const parts = id === null ? [] : (state.run.value?.buildings.get(id)?.parts ?? []);
      to.setSelection(state.selection.value, [...state.also.value, ...parts.map((p) => ({ building: id!, part: p.id }))]);
    }),
    effect(() => to.setHover(state.hovered.value?.right ? null : state.hovered.value)),
    effect(() => {
      void state.scene.value;
      to.setChosen(state.choosing.value ? state.chosenBlocks.value : none);
    }),
    effect(() => {
      const request = state.flight.value;
      if (!request || request.at === asked) return;
      asked = request.at;
      if (request.to === "home") to.home();
      else if (request.to === "top") to.top();
      else if (state.selection.peek()) to.flyTo(state.selection.peek()!.building, request.to === "case");
    }),
    watchRaw(to),
  ];
  return () => stops.forEach((stop) => stop());
}
const none: ReadonlySet<string> = new Set();
/** Marks and profiles hide what a review is about. */
const withoutMarks = (all: Choices): Choices => ({
  ...all,
  diagnostics: { ...all.diagnostics, shown: false },
  clean: { ...all.clean, shown: false },
});

export function View() {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    let made: Viewer;
    try {
      made = new Viewer(
        canvas.current!,
        {
          click: clicked,
          hover: (hit, right) => {
            const was = state.hovered.peek();
            const same = hit?.building === was?.building && hit?.part === was?.part && hit?.edge === was?.edge;
            if (same && right === (was?.right ?? false)) return;
            state.hovered.value =
              hit && { building: hit.building, part: hit.part, ring: hit.ring, edge: hit.edge, right };
          },
          point: (place) => (state.pointer.value = place),
          drawn: (azimuth, metresPerPixel) => {
            measureDrawn();
            caseDrawn();
            ++images.value;
            const was = state.compass.peek();
            if (was?.azimuth !== azimuth || was.metresPerPixel !== metresPerPixel)
              state.compass.value = { azimuth, metresPerPixel };
          },
          moved: (pose) => {
            keep("session", poseKey(), pose);
            keep("local", poseKey(), pose);
          },
          near: (tiles) => {
            const run = state.run.peek();
            if (run?.large) void actions.needTiles(run.id, tiles);
          },
          loadTile: (id, signal) => actions.client.tile(id, signal),
          loadTilePicture: (id, signal) => actions.client.tileTexture(id, signal),
          loadBuildingPicture: (which, building) =>
            actions.client.buildingTexture(state.runOf((which ? state.other : state.run).value?.id ?? ""), building),
        },
        choices.peek(),
      );
    } catch {
      failure.value = "The 3D view needs WebGL 2, which this browser does not support or has disabled. Everything else works.";
      return;
    }
    const sized = new ResizeObserver(() => made.resize(box.current!.clientWidth, box.current!.clientHeight));
    sized.observe(box.current!);
    made.resize(box.current!.clientWidth, box.current!.clientHeight);
    const disconnect = connect(made);
    viewer.value = made;
    return () => {
      viewer.value = null;
      disconnect();
      sized.disconnect();
      made.dispose();
    };
  }, []);
  return (
    <div class={"view" + (state.choosing.value || measuring.value || aligning.value ? " choosing" : "")} ref={box}>
      <canvas
        ref={canvas}
        tabIndex={0}
        aria-label="3D view. Arrow keys move the camera, with Shift they rotate it, plus and minus zoom. Buildings can also be selected in the list of buildings."
      />
      {failure.value && <p class="view-failure">{failure.value}</p>}
      <Handles images={images} />
      <Toolbar />
      {state.layersOpen.value && <LayersPopover />}
      <div class="view-corner">
        <Legend />
        <Furniture />
        <Attribution />
      </div>
      <Sides />
      <Divider />
      <div class="view-corner-left">
        <MeasureBox />
        <AlignBox />
        <Under />
        <Coordinates />
      </div>
      {state.pictureOpen.value && <PictureDialog />}
    </div>
  );
}

/** The boundary between what is shown on the left and on the right; it can be dragged. */
function Divider() {
  const share = divided.value;
  if (share === null) return null;
  const set = (x: number) => (divided.value = Math.min(0.98, Math.max(0.02, x)));
  const other = state.other.value;
  const what = !other ? "the scan and the models" : state.isBefore(other.id) ? "after and before the edits" : "the two runs";
  return (
    <div
      class="divider"
      style={{ left: `${share * 100}%` }}
      role="slider"
      tabIndex={0}
      aria-label={`Boundary between ${what}`}
      aria-valuemin={0}
      aria-valuemax={100}
      aria-valuenow={Math.round(share * 100)}
      onPointerDown={(e) => e.currentTarget.setPointerCapture(e.pointerId)}
      onPointerMove={(e) => {
        if (!e.currentTarget.hasPointerCapture(e.pointerId)) return;
        const area = e.currentTarget.parentElement!.getBoundingClientRect();
        set((e.clientX - area.left) / area.width);
      }}
      onKeyDown={(e) => {
        const by = { ArrowLeft: -0.02, ArrowRight: 0.02 }[e.key];
        if (by === undefined) return;
        e.preventDefault();
        e.stopPropagation();
        set(share + by);
      }}
    />
  );
}

/** The point under the pointer, in the coordinates of the files. */
function Coordinates() {
  const at = state.pointer.value;
  const scene = state.scene.value;
  if (!at) return null;
  const origin = scene?.origin ?? [0, 0, 0];
  const [east, north, height] = at.map((x, i) => (x + origin[i]!).toFixed(2));
  return (
    <div class="under coordinates" aria-label="Coordinates at the pointer">
      E {east} N {north} H {height} <span class="quiet">{scene?.crs || "no CRS"}</span>
    </div>
  );
}

/** The names of the left and the right run. */
function Sides() {
  if (beside.value)
    return (
      <div class="sides" aria-hidden="true">
        <span>scan</span>
        <span>model</span>
      </div>
    );
  if (!state.other.value) return null;
  const name = (id: string) => {
    const run = state.runSummary(id);
    return run ? nameOf(run) : id;
  };
  return (
    <div class="sides" aria-hidden="true">
      <span>{name(state.run.value?.id ?? "")}</span>
      <span>{name(state.other.value.id)}</span>
    </div>
  );
}

/** Describes what is under the pointer. */
function Under() {
  const at = state.hovered.value;
  if (state.choosing.value) {
    return (
      <div class="under">Click blocks to select them for the next run. Selected: {state.chosenBlocks.value.size}</div>
    );
  }
  if (!at) return null;
  const building = (at.right ? state.other : state.run).value?.buildings.get(at.building);
  const reasons = building ? reasonsOf(building) : [];
  return (
    <div class="under">
      <b>{at.building}</b>
      {at.part && at.part !== at.building && ` · part ${at.part.replace(at.building, "").replace(/^-/, "")}`}
      {at.edge !== null && ` · edge ${at.edge}${at.ring ? ` of hole ${at.ring}` : ""}`}
      {reasons.map((r) => (
        <div key={r}>{r}</div>
      ))}
    </div>
  );
}
