// The 3D view: owns the canvas and draws only when something changed. It does not use signals; view.tsx passes them on.
import * as THREE from "three";
import type * as api from "../api/types";
import type { LoadedMap, Selection } from "../state";
import type { Pair } from "./align";
import * as camera from "./camera";
import type { Pose, Vector } from "./camera";
import { attach, type Gestures } from "./controls";
import { combine, textureOf } from "./errormap";
import { Basemap } from "./basemap";
import { Far } from "./far";
import { type Box, boxOf, emptyBox, grow, isEmpty } from "./geometry";
import { Highlight, type RawClimbs } from "./highlight";
import type { Choices } from "./layers";
import type { Eye } from "./levels";
import { Cap, capNearer, Marks, Segments, Sheet, WideLines, flat } from "./lines";
import { colours, modelLook } from "./materials";
import { type Large, boxOfShapes, tilesNear } from "../large";
import { Output } from "./output";
import { Others } from "./others";
import { type Hit, type Ray, covers, pick, pickFootprint } from "./pick";
import { Terrain } from "./terrain";
import { Tiles } from "./tiles";
import { type Rectangle, Smooth, Still, both, changing, isSoftware, seenAt } from "./still";
import { type SectionPlane, cutLines, filling, planeOf, reach } from "./section";
import { SegmentationLayers } from "./segmentation";
import type { Colour } from "./styling";

export interface Listener {
  /** `corner`: of a footprint, near the pointer on the page. */
  click(hit: Hit | null, footprint: api.SceneFootprint | null, more: boolean, place: Vector | null, corner: Vector | null): void;
  hover(hit: Hit | null, right: boolean): void; // right: over the run to compare with
  moved(pose: Pose): void; // called when the camera stops; in the frame of the scene
  point(place: Vector | null): void; // under the resting pointer, in the frame of the scene
  drawn(azimuth: number, metresPerPixel: number): void; // after each image
  /** Tiles of a large run whose models are near the camera. */
  near(tiles: string[]): void;
  loadTile(id: string, signal: AbortSignal): Promise<ArrayBuffer>;
  loadTilePicture(id: string, signal: AbortSignal): Promise<ArrayBuffer>;
  loadBuildingPicture(which: 0 | 1, building: string): Promise<ArrayBuffer>;
}

/** A drawn run. */
class Side {
  segmentation: SegmentationLayers | null = null;
  maps: readonly LoadedMap[] | null = null;
  buildings: ReadonlyMap<string, api.Building> = new Map();
  drafts: ReadonlyMap<string, api.RaisedBuilding> = new Map();
  constructor(readonly output: Output) {}
  *shown(): Iterable<api.RaisedBuilding> {
    for (const [id, building] of this.buildings) yield this.drafts.get(id) ?? building;
  }
  building = (id: string): api.RaisedBuilding | undefined => this.drafts.get(id) ?? this.buildings.get(id);
  dispose() {
    this.output.dispose();
    this.segmentation?.dispose();
  }
}

const followSeconds = 0.055; // delay of the camera behind the pointer
const flightSeconds = 0.6;
const background = { light: 0xf6f6f3, dark: 0x1b1e23 };
const nearCorner = 14; // pixels between a click and the corner of a footprint
const coarseTolerance = 5; // pixels; of the scan in such an image, whose triangles take most of its time
const calmMilliseconds = 200; // after which the image of a building that was shown at once is drawn with smooth edges
const restMilliseconds = 60; // after which the point under the pointer is looked for in the scan
const mostVisible = 2000; // m; with more of a large run in view, its models would be a few pixels each
const pinHeight = 2.5; // m; so that a pin is seen beside a ridge
const underFeet = 0.05; // m; the basemap is below the models, whose ground faces would flicker with it
const inside = 0.05; // m; by which the outlines of a cut are behind its plane, which would hide them

export class Viewer {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly world = new THREE.Scene();
  private readonly eye = new THREE.PerspectiveCamera();
  private readonly gone = new AbortController();
  private readonly marks = [new Marks(), new Marks()] as const; // of the left and of the right run
  private readonly footprints = new WideLines(colours.footprint, 2);
  private readonly buried = new WideLines(colours.footprint, 1.5, true); // the same, visible through the mesh
  private readonly chosen = new WideLines(colours.accent, 2.5, true);
  private readonly chosenSheet = new Sheet(colours.accent, 0.25);
  private readonly cap = new Cap(colours.cut);
  private readonly capLines = new WideLines(colours.cutLine, 2);
  private readonly measureLines = new WideLines(0xc2185b, 2.5, true);
  private readonly measureMarks = new Marks();
  private readonly pinLines = new WideLines(0xc2186b, 3, true);
  private readonly pinMarks = new Marks();
  private readonly caseLines = new WideLines(colours.accent, 1.5, true);
  private readonly pairLines = new WideLines(0x2e59b8, 2, true);
  private readonly pairMarks = new Marks();
  private readonly others = new Others();
  private readonly terrain = new Terrain();
  private readonly basemap = new Basemap(() => this.request());
  private basemapBytes: ArrayBuffer | null = null;
  private readonly farLook = modelLook();
  private readonly far = new Far(this.farLook, () => this.request());
  private large: Large | null = null;
  private contents: Box | null = null; // the box of what is shown, until it changes
  private highlight: Highlight;
  // Only where images are slow.
  private readonly still: Still | null;
  private readonly smooth: Smooth | null;
  private dragged: Rectangle | null = null; // what the image before differs in from what is still; null: it may be everywhere
  private tiles: Tiles | null = null;
  private sides: [Side, Side | null];
  private scene: api.Scene | null = null;
  private centre: Vector = [0, 0, 0];
  private readonly marked: { building: string; place: Vector }[][] = [[], []];
  private plane: THREE.Plane | null = null;
  private pose: Pose = camera.home([-50, -50, 0], [50, 50, 20], 1.5); // relative to the centre
  private goal: Pose = this.pose;
  private flight: { from: Pose; started: number } | null = null;
  private framed = false; // whether the camera was placed before
  private frameAsked = 0;
  private last = 0;
  private moving = false;
  private width = 1;
  private height = 1;
  private hoverAsked = false;
  private choices: Choices;
  private selected: { at: Selection | null; also: { building: string; part: string }[] } = { at: null, also: [] };

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly listener: Listener,
    choices: Choices,
  ) {
    this.choices = choices;
    const slow = isSoftware();
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      antialias: !slow,
      preserveDrawingBuffer: slow, // images of a drag replace a part of the one before
      powerPreference: "high-performance",
    });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // see materials.ts: nothing is converted
    this.renderer.setClearColor(background.light);
    this.renderer.autoClear = false;
    this.still = slow ? new Still() : null;
    this.smooth = slow ? new Smooth() : null;
    this.eye.layers.enable(changing);
    this.highlight = new Highlight(this.centre);
    this.sides = [new Side(this.output(0)), null];
    this.world.add(
      this.footprints.object,
      this.buried.object,
      this.chosenSheet.object,
      this.chosen.object,
      this.cap.object,
      this.capLines.object,
      this.measureLines.object,
      this.measureMarks.object,
      this.caseLines.object,
      this.pinLines.object,
      this.pinMarks.object,
      this.pairLines.object,
      this.pairMarks.object,
      this.others.group,
      this.terrain.group,
      this.far.group,
      this.basemap.group,
      ...this.marks.map((m) => m.object),
    );
    this.world.add(this.highlight.group, this.sides[0].output.group);
    Object.assign(this.capLines.material, {
      polygonOffset: true,
      polygonOffsetFactor: 0,
      polygonOffsetUnits: -2 * capNearer,
    });
    attach(canvas, this.gestures, this.gone.signal);
    canvas.addEventListener("webglcontextrestored", () => this.request(), { signal: this.gone.signal });
  }

  dispose() {
    this.gone.abort();
    cancelAnimationFrame(this.frameAsked);
    clearTimeout(this.smoothed);
    this.tiles?.dispose();
    this.far.dispose();
    this.still?.dispose();
    this.smooth?.dispose();
    this.basemap.clear();
    for (const side of this.sides) side?.dispose();
    this.renderer.dispose();
  }

  private output(which: 0 | 1) {
    const output = new Output(
      this.centre,
      (building) => this.listener.loadBuildingPicture(which, building),
      () => this.request(),
    );
    output.textures.show(this.textured.models && which === 0);
    output.textures.lookAt(this.target);
    return output;
  }
  private get target(): Vector {
    return this.goal.target.map((t, i) => t + this.centre[i]!) as Vector;
  }

  // ---- contents

  /** Draws the scan, and the models of the open run, with the pictures of the scan. */
  setTextured(scan: boolean, models: boolean) {
    this.textured = { scan, models };
    if (this.tiles) this.tiles.textures = scan;
    this.sides[0].output.textures.lookAt(this.target);
    this.sides[0].output.textures.show(models);
    this.request();
  }
  private textured = { scan: false, models: false };
  /** Tiles and buildings that are drawn with pictures; for tests. */
  get pictures(): [number, number] {
    return [this.tiles?.pictures ?? 0, this.sides[0].output.textures.count];
  }

  setScene(scene: api.Scene | null) {
    this.contents = null;
    const moved = scene && scene.origin.some((o, i) => o !== this.scene?.origin[i]);
    this.scene = scene;
    if (scene && (moved || !this.framed))
      this.recentre(scene.low.map((l, i) => Math.round((l + scene.high[i]!) / 2)) as Vector);
    const lines = new Segments(this.centre);
    for (const footprint of scene?.footprints ?? []) {
      for (const { outer, holes } of footprint.polygons) {
        for (const ring of [outer, ...holes]) lines.ring(ring, footprint.ground + 0.05);
      }
    }
    this.footprints.set(lines);
    this.buried.set(lines);
    this.place();
    this.request();
  }

  setTiles(index: api.TileIndex | null) {
    this.tiles?.dispose();
    this.tiles = null;
    if (index) {
      this.tiles = new Tiles(index, this.centre, this.listener.loadTile, this.listener.loadTilePicture, () =>
        this.request(),
      );
      this.tiles.textures = this.textured.scan;
      this.world.add(this.tiles.group);
      this.index = index;
      this.showMesh();
      this.maskMesh();
    }
    this.request();
  }
  private index: api.TileIndex | null = null;

  /** The buildings of a large run; those that are not among the models are drawn as prisms. */
  setLarge(large: Large | null) {
    if (large === this.large) return;
    const another = large?.tiles !== this.large?.tiles;
    this.large = large;
    this.contents = null;
    if (another && large && !this.scene && !this.framed)
      this.recentre(large.low.map((l, i) => Math.round((l + large.high[i]!) / 2)) as Vector);
    this.far.set(large, this.centre);
    if (another) {
      this.place();
      this.loadNear();
    }
    this.request();
  }
  private loadNear() {
    const { size, target } = this.goal;
    if (!this.large) return;
    const at = target.map((t, i) => t + this.centre[i]!);
    this.listener.near(size > mostVisible ? [] : tilesNear(this.large, at, Math.max(100, 1.5 * size)));
  }

  setRun(
    which: 0 | 1,
    buildings: ReadonlyMap<string, api.Building> | null,
    drafts: ReadonlyMap<string, api.RaisedBuilding> = new Map(),
    invalid = false,
  ) {
    if (which === 1 && !buildings) {
      this.sides[1]?.dispose();
      this.sides[1] = null;
      this.placeMarks();
      return this.request();
    }
    if (!this.sides[which]) {
      this.sides[which] = new Side(this.output(which));
      this.world.add(this.sides[which]!.output.group);
    }
    this.contents = null;
    const side = this.sides[which]!;
    const another = side.buildings !== (buildings ?? empty);
    side.buildings = buildings ?? empty;
    side.drafts = drafts;
    if (which === 0 && buildings?.size && !this.scene && !this.framed && !this.large) {
      const { low, high } = this.content();
      this.recentre(low.map((l, i) => Math.round((l + high[i]!) / 2)) as Vector);
    } else {
      side.output.set(side.buildings, drafts, invalid);
    }
    this.fadeModels(this.sides[which]!.output);
    if (another) this.placeMarks();
    if (another && which === 0) this.maskMesh();
    side.output.paint(this.paints);
    if (another && this.basemapBytes) this.placeBasemap();
    this.showBuried();
    this.showSelection();
    this.place();
    this.fillCut();
    this.request(another || which === 1);
  }

  /** Colours the buildings of the run; null: by the class of their faces. */
  setPaint(colours: ReadonlyMap<string, Colour> | null) {
    this.paints = colours;
    for (const side of this.sides) side?.output.paint(colours);
    this.far.paint(colours);
    this.request();
  }
  private paints: ReadonlyMap<string, Colour> | null = null;

  /** Models of another program, beside those of the run. */
  setOthers(models: readonly api.OtherModel[]) {
    this.others.set(models, this.centre);
    this.otherModels = models;
    this.showOthers();
    this.request();
  }
  private otherModels: readonly api.OtherModel[] = [];
  private showOthers() {
    const { others } = this.choices;
    this.others.opacity = others.shown ? others.opacity : 0;
  }

  setTerrain(bytes: ArrayBuffer | null) {
    this.terrainBytes = bytes;
    this.terrain.set(bytes, this.centre);
    this.showTerrain();
    this.request();
  }
  private terrainBytes: ArrayBuffer | null = null;
  private showTerrain() {
    const { terrain } = this.choices;
    this.terrain.opacity = terrain.shown ? terrain.opacity : 0;
  }
  /** Triangles of the terrain; for tests. */
  get terrainTriangles() {
    return this.choices.terrain.shown ? this.terrain.triangles : 0;
  }

  setBasemap(bytes: ArrayBuffer | null) {
    this.basemapBytes = bytes;
    this.placeBasemap();
    this.request();
  }
  /** At the foot of the lowest building: above the ground it would hide models on a slope. */
  private placeBasemap() {
    this.basemap.set(this.basemapBytes, this.centre, this.content().low[2] - underFeet);
  }
  get basemapThere() {
    return this.basemap.there;
  }

  setMeasure(points: readonly Vector[], closed: boolean) {
    const lines = new Segments(this.centre);
    lines.path(closed && points.length > 2 ? [...points, points[0]!] : points);
    this.measureLines.set(lines);
    this.measureMarks.set(
      points.flatMap((p) => p.map((x, i) => x - this.centre[i]!)),
      points.flatMap(() => [0.76, 0.09, 0.36]),
    );
    this.measureMarks.object.visible = points.length > 0;
    this.measured = { points, closed };
    this.request();
  }
  private measured: { points: readonly Vector[]; closed: boolean } = { points: [], closed: false };

  /** Marks a place, with a line that stands on it; null: none. */
  setPin(at: Vector | null) {
    if (at === this.pin) return;
    this.pin = at;
    const lines = new Segments(this.centre);
    if (at) lines.path([at, [at[0], at[1], at[2] + pinHeight]]);
    this.pinLines.set(lines);
    this.pinMarks.set(at ? at.map((x, i) => x - this.centre[i]!) : [], at ? [0.76, 0.09, 0.42] : []);
    this.pinMarks.object.visible = at !== null;
    this.request();
  }
  private pin: Vector | null = null;

  /** The building under review: the edges of its roof are drawn over the scan. */
  setCase(building: api.Building | null) {
    if (building === this.caseOf) return;
    this.caseOf = building;
    const lines = new Segments(this.centre);
    for (const { geometry } of building?.parts ?? []) {
      if (!geometry) continue;
      const at = (v: number) => geometry.positions.slice(3 * v, 3 * v + 3);
      for (const face of geometry.faces)
        if (face.class === "roof") for (const loop of face.loops) lines.path([...loop, loop[0]!].map(at));
    }
    this.caseLines.set(lines);
    this.request();
  }
  private caseOf: api.Building | null = null;

  /** The scan and the models side by side, with one camera. */
  setBeside(on: boolean) {
    if (on === this.beside) return;
    this.beside = on;
    if (!this.framed) this.place();
    this.request();
  }
  private beside = false;

  /** Buildings that the camera goes to next: the scan there is loaded. */
  setNext(buildings: readonly string[]) {
    this.next = buildings;
    this.request(false);
  }
  private next: readonly string[] = [];

  /** Points of the scan, and the corners of footprints where they should be. */
  setPairs(pairs: readonly Pair[], begun: Vector | null) {
    this.pairs = { pairs, begun };
    const lines = new Segments(this.centre);
    for (const { scan, corner } of pairs) lines.path([scan, corner]);
    this.pairLines.set(lines);
    const places = [...pairs.flatMap((p) => [p.scan, p.corner]), ...(begun ? [begun] : [])];
    this.pairMarks.set(
      places.flatMap((p) => p.map((x, i) => x - this.centre[i]!)),
      places.flatMap((_, i) => (i % 2 ? [0.94, 0.55, 0.12] : [0.18, 0.35, 0.72])),
    );
    this.pairMarks.object.visible = places.length > 0;
    this.request();
  }
  private pairs: { pairs: readonly Pair[]; begun: Vector | null } = { pairs: [], begun: null };

  setDark(dark: boolean) {
    this.renderer.setClearColor(dark ? background.dark : background.light);
    this.request();
  }

  /** Divides the view at this share of its width; null: not. */
  setDivided(share: number | null) {
    this.divided = share;
    this.request();
  }
  private divided: number | null = null;

  setSegmentation(which: 0 | 1, layers: api.Layers | null) {
    const side = this.sides[which];
    if (!side) return;
    side.segmentation?.dispose();
    side.segmentation = layers && new SegmentationLayers(layers, this.centre, this.scene?.high[2] ?? 0);
    if (side.segmentation) {
      this.world.add(side.segmentation.group);
      side.segmentation.show(this.choices);
    }
    this.layersOf[which] = layers;
    this.request();
  }
  private layersOf: [api.Layers | null, api.Layers | null] = [null, null];

  setErrorMaps(which: 0 | 1, maps: readonly LoadedMap[] | null) {
    const side = this.sides[which];
    if (!side || side.maps === maps) return;
    side.maps = maps;
    this.drapeError(side);
    this.request();
  }

  private drapeError(side: Side) {
    const { look } = side.output;
    look.errorMap.value?.dispose();
    const map = side.maps && combine(side.maps, Math.min(4096, this.renderer.capabilities.maxTextureSize));
    look.errorMap.value = map && textureOf(map);
    if (map) {
      const [x, y] = [map.low[0] - this.centre[0], map.low[1] - this.centre[1]];
      look.errorFrame.value.set(x, y, 1 / (map.columns * map.cell), 1 / (map.rows * map.cell));
    }
    this.fadeModels(side.output);
  }

  setErrorLimit(metres: number) {
    for (const side of this.sides) if (side) side.output.look.errorLimit.value = metres;
    this.errorLimit = metres;
    this.request();
  }
  private errorLimit = 2;

  setChoices(choices: Choices) {
    this.choices = choices;
    for (const side of this.sides) {
      if (!side) continue;
      this.fadeModels(side.output);
      side.segmentation?.show(choices);
    }
    const { footprints, diagnostics } = choices;
    this.footprints.opacity = footprints.shown ? footprints.opacity : 0;
    this.showBuried();
    this.showMarks(0, diagnostics.shown);
    this.showMesh();
    this.maskMesh();
    this.showOthers();
    this.showTerrain();
    this.basemap.opacity = choices.basemap.shown ? choices.basemap.opacity : 0;
    this.showSelection();
    this.request();
  }

  setSelection(at: Selection | null, also: { building: string; part: string }[]) {
    this.selected = { at, also };
    this.showSelection();
    this.request(false);
  }

  setHover(at: { building: string; part: string | null } | null) {
    this.highlight.hover(at ? this.sides[0].building(at.building)?.parts.find((p) => p.id === at.part) : undefined);
    this.request(false);
  }

  setRaw(part: api.RaisedPart | undefined, climbs: RawClimbs[]) {
    this.highlight.showRaw(part, climbs);
    this.request(false);
  }

  setChosen(blocks: ReadonlySet<string>) {
    const lines = new Segments(this.centre);
    const ground: number[] = [];
    for (const footprint of this.scene?.footprints ?? []) {
      if (!footprint.block || !blocks.has(footprint.block)) continue;
      for (const { outer, holes } of footprint.polygons) {
        for (const ring of [outer, ...holes]) lines.ring(ring, footprint.ground + 0.1);
        for (const x of flat(outer, holes, footprint.ground + 0.1, this.centre)) ground.push(x);
      }
    }
    this.chosen.set(lines);
    this.chosenSheet.set(ground);
    this.request();
  }

  setSection(section: SectionPlane | null) {
    this.section = section;
    this.plane = null;
    if (section) {
      const { normal, at } = planeOf(section);
      const sign = section.flipped ? 1 : -1;
      const own = at - normal.reduce((sum, n, i) => sum + n * this.centre[i]!, 0);
      this.plane = new THREE.Plane(new THREE.Vector3(...normal).multiplyScalar(sign), -sign * own);
    }
    this.renderer.clippingPlanes = this.plane ? [this.plane] : [];
    this.fillCut();
    this.request();
  }
  private section: SectionPlane | null = null;

  /** The range of offsets of a section plane that meets the models. */
  reachOf = (section: SectionPlane): [number, number] => reach(section, this.content());

  /** Fills the solids where the section plane cuts them. */
  private fillCut() {
    const positions: number[] = [];
    const outlines = new Segments(this.centre);
    if (this.section) {
      const { normal, at } = planeOf(this.section);
      const by = (this.section.flipped ? inside : -inside) as number;
      for (const building of this.sides[0].shown()) {
        const box = boxOf(building);
        const [least, most] = reach({ ...this.section, offset: 0 }, box);
        if (least > this.section.offset || most < this.section.offset) continue;
        for (const { geometry } of building.parts) {
          if (!geometry) continue;
          const lines = cutLines(geometry, normal, at);
          const filled = filling(lines, normal);
          for (const line of lines) outlines.path([...line, line[0]!].map((p) => p.map((x, i) => x + by * normal[i]!)));
          for (let i = 0; i < filled.length; ++i) positions.push(filled[i]! - this.centre[i % 3]!);
        }
      }
    }
    this.cap.set(positions);
    this.capLines.set(outlines);
    this.filled = positions.length / 9;
  }
  /** Triangles that fill the cut; for tests. */
  filled = 0;

  resize(width: number, height: number) {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.renderer.setPixelRatio(Math.min(2, globalThis.devicePixelRatio || 1));
    this.renderer.setSize(this.width, this.height, false);
    for (const marks of this.marks) marks.material.uniforms.size!.value = 12 * this.renderer.getPixelRatio();
    for (const marks of [this.measureMarks, this.pairMarks, this.pinMarks])
      marks.material.uniforms.size!.value = 10 * this.renderer.getPixelRatio();
    this.place();
    this.draw(); // a resized canvas is empty
  }

  // ---- the camera

  /** Sets the pose, in the frame of the scene. */
  look(pose: Pose) {
    this.goal = this.pose = { ...pose, target: pose.target.map((t, i) => t - this.centre[i]!) as Vector };
    this.framed = true;
    this.loadNear();
    this.request();
  }
  home() {
    const { low, high } = this.centred(this.content());
    this.fly(camera.home(low, high, this.aspect));
  }
  top() {
    const flatPose = camera.top(this.goal);
    if (camera.isTop(this.goal)) {
      const { low, high } = this.centred(this.content());
      this.fly(camera.frame(flatPose, low, high, this.aspect));
    } else this.fly(flatPose);
  }
  /** `atOnce`: without a flight. */
  flyTo(building: string, atOnce = false) {
    const pose = this.poseAt(building);
    if (pose) this.fly(pose, atOnce);
  }
  /** Whether the middle of a building is in the image. */
  sees(building: string): boolean {
    const at = this.project(building);
    if (!at) return false;
    const box = this.canvas.getBoundingClientRect();
    return at.x >= box.left && at.x <= box.left + this.paneWidth && at.y >= box.top && at.y <= box.bottom;
  }
  private poseAt(building: string): Pose | null {
    const found = this.sides[0].building(building);
    const box = found ? boxOf(found) : (this.listed(building) ?? this.footprintBox((f) => f.id === building));
    if (isEmpty(box)) return null;
    const { low, high } = this.centred(box);
    const wide = { low: low.map((x) => x - 3) as Vector, high: high.map((x) => x + 2) as Vector };
    const tilted = camera.isTop(this.goal)
      ? this.goal
      : { ...this.goal, elevation: Math.max(this.goal.elevation, 0.5) };
    return camera.frame(tilted, wide.low, wide.high, this.aspect);
  }
  /** The box of a building of a large run, as the list has it. */
  private listed(building: string): Box | null {
    const at = this.large?.index.get(building);
    return at === undefined ? null : boxOfShapes(this.large!.shapes[at]!);
  }
  private fly(to: Pose, atOnce = false) {
    const still = atOnce || globalThis.matchMedia?.("(prefers-reduced-motion: reduce)").matches;
    this.goal = to;
    this.framed = true;
    this.hurried = atOnce;
    clearTimeout(this.smoothed);
    if (still) this.pose = { ...to }; // another object: the next image is the first of the new pose
    this.flight = still ? null : { from: this.pose, started: performance.now() };
    this.request();
  }

  private coarse = false;
  private hurried = false; // the next image is wanted as soon as possible: its edges are smoothed later
  private smoothed: ReturnType<typeof setTimeout> | undefined;

  /** Position of the top of a building on the page; null if it is behind the camera or unknown. */
  project(building: string): { x: number; y: number } | null {
    const found = this.sides[0].building(building);
    const box = found ? boxOf(found) : this.listed(building);
    if (!box) return null;
    const { low, high } = box;
    return this.placeOf([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2]]);
  }
  /** The place of a point on the page; null if it is behind the camera. */
  placeOf(at: Vector): { x: number; y: number } | null {
    this.aim();
    const p = new THREE.Vector3(...(at.map((x, i) => x - this.centre[i]!) as Vector)).project(this.eye);
    if (p.z > 1) return null;
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + ((p.x + 1) / 2) * this.paneWidth, y: box.top + ((1 - p.y) / 2) * this.height };
  }

  /** Where points are in the left pane, in pixels from its upper left corner; null where they are not in it. */
  inView(points: readonly Vector[]): ([number, number] | null)[] {
    this.aim();
    const p = new THREE.Vector3();
    return points.map((at) => {
      p.set(...(at.map((x, i) => x - this.centre[i]!) as Vector)).project(this.eye);
      if (p.z > 1 || Math.abs(p.x) > 1 || Math.abs(p.y) > 1) return null;
      return [((p.x + 1) / 2) * this.paneWidth, ((1 - p.y) / 2) * this.height];
    });
  }
  /** Where the camera is, in the frame of the scene. */
  get eyeAt(): Vector {
    this.aim();
    return this.eye.position.toArray().map((x, i) => x + this.centre[i]!) as Vector;
  }

  /** The pose of the camera, in the frame of the scene. */
  get seenFrom(): Pose {
    return { ...this.goal, target: this.goal.target.map((t, i) => t + this.centre[i]!) as Vector };
  }

  /** The view as an image of that size, without the marks of the pointer; `note` is written into its lower right corner. */
  async picture(width: number, height: number, note = ""): Promise<Blob | null> {
    const [w, h, ratio] = [this.width, this.height, this.renderer.getPixelRatio()];
    const hovering = this.highlight;
    hovering.hover(undefined);
    try {
      this.renderer.setPixelRatio(1);
      this.renderer.setSize(width, height, false);
      [this.width, this.height] = [width, height];
      this.draw();
      // The canvas is read in the same task: its contents are not kept after that.
      const image = note ? withNote(this.canvas, note) : this.canvas;
      return await new Promise((resolve) => image.toBlob(resolve, "image/png"));
    } finally {
      [this.width, this.height] = [w, h];
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(w, h, false);
      this.draw();
    }
  }
  /** The largest image that the graphics driver can draw, pixels along a side. */
  get largestPicture() {
    return Math.min(8192, this.renderer.capabilities.maxTextureSize);
  }

  /** Resolves when nothing moves, loads or waits to be drawn. */
  async idle(): Promise<void> {
    for (let calm = 0; calm < 3; ) {
      await new Promise((resolve) => setTimeout(resolve, 25));
      calm = this.frameAsked || this.far.busy || this.basemap.busy || this.tiles?.busy || this.sides[0].output.textures.busy ? 0 : calm + 1;
    }
  }

  // ---- picking

  private readonly gestures: Gestures = {
    orbit: (dx, dy) => this.move(camera.orbit(this.goal, dx, dy)),
    pan: (dx, dy) => this.move(camera.pan(this.goal, dx, dy, this.height)),
    zoom: (factor, x, y) => this.move(camera.zoom(this.goal, factor, this.under(x, y))),
    click: (x, y, more) => {
      const { ray, side } = this.rayAt(x, y);
      const marked = this.markAt(x, y);
      const hit = marked
        ? { building: marked, part: null, ring: 0, edge: null, point: ray.origin, distance: 0 }
        : this.hit(ray, side);
      const footprint = pickFootprint(ray, this.scene?.footprints ?? [], this.keeps);
      this.listener.click(
        side === this.sides[0] || !hit ? hit : { ...hit, part: null, edge: null },
        footprint?.footprint ?? null,
        more,
        this.placeAt(x, y),
        this.cornerAt(x, y),
      );
    },
    hover: (x, y) => {
      clearTimeout(this.resting);
      this.resting = setTimeout(() => this.listener.point(this.placeAt(x, y)), restMilliseconds);
      if (this.hoverAsked) return;
      this.hoverAsked = true;
      requestAnimationFrame(() => {
        this.hoverAsked = false;
        const { ray, side } = this.rayAt(x, y);
        const marked = this.markAt(x, y);
        this.listener.hover(
          marked
            ? { building: marked, part: null, ring: 0, edge: null, point: ray.origin, distance: 0 }
            : this.hit(ray, side),
          side === this.sides[1],
        );
      });
    },
    leave: () => {
      clearTimeout(this.resting);
      this.listener.point(null);
      this.listener.hover(null, false);
    },
  };
  private resting: ReturnType<typeof setTimeout> | undefined;

  /** The nearest point under the pointer: of the models, the scan, or the ground of a footprint. */
  /** The corner of a footprint that is nearest to a place on the page, within some pixels. */
  private cornerAt(x: number, y: number): Vector | null {
    let [nearest, least]: [Vector | null, number] = [null, nearCorner];
    const p = new THREE.Vector3();
    this.aim();
    for (const footprint of this.scene?.footprints ?? []) {
      for (const { outer, holes } of footprint.polygons) {
        for (const corner of [outer, ...holes].flat()) {
          const place: Vector = [corner[0], corner[1], footprint.ground];
          p.set(...(place.map((c, i) => c - this.centre[i]!) as Vector)).project(this.eye);
          if (p.z > 1) continue;
          const away = Math.hypot(((p.x + 1) / 2) * this.paneWidth - this.inPane(x), ((1 - p.y) / 2) * this.height - y);
          if (away < least) [nearest, least] = [place, away];
        }
      }
    }
    return nearest;
  }

  private placeAt(x: number, y: number): Vector | null {
    const { ray, side } = this.rayAt(x, y);
    let best = this.modelsHidden(x) ? null : this.hit(ray, side);
    const cast = new THREE.Raycaster(
      new THREE.Vector3(...(ray.origin.map((o, i) => o - this.centre[i]!) as Vector)),
      new THREE.Vector3(...ray.direction),
    );
    for (const p of this.tiles?.meets(cast) ?? []) {
      const place = p.toArray().map((q, i) => q + this.centre[i]!) as Vector;
      const distance = Math.hypot(...place.map((q, i) => q - ray.origin[i]!));
      if (best && best.distance <= distance) break;
      if (!this.keeps(place) || (this.masks(x) && this.isUnderModel(place))) continue;
      best = { building: "", part: null, ring: 0, edge: null, point: place, distance };
      break;
    }
    return best?.point ?? pickFootprint(ray, this.scene?.footprints ?? [], this.keeps)?.point ?? null;
  }
  /** Whether a place on the page shows the scan only. */
  private modelsHidden(x: number) {
    if (this.isBeside) return x < this.paneWidth;
    return this.divided !== null && !this.sides[1] && x < this.divided * this.width;
  }
  private masks(x: number) {
    return (this.tiles?.look.masked.value ?? 0) > 0.5 && !this.modelsHidden(x);
  }
  private isUnderModel([x, y]: Vector): boolean {
    for (const building of this.sides[0].buildings.values()) {
      const { low, high } = boxOf(building);
      if (x < low[0] || x > high[0] || y < low[1] || y > high[1]) continue;
      for (const { plan } of building.parts)
        if (covers({ polygons: [{ outer: plan.outer.points, holes: plan.holes.map((h) => h.points) }] }, x, y)) return true;
    }
    return false;
  }

  private move(goal: Pose) {
    this.flight = null;
    this.goal = goal;
    this.framed = true;
    this.request();
  }

  /** The point under the pointer, relative to the centre; for zooming. */
  private under(x: number, y: number): Vector | null {
    const { ray, side } = this.rayAt(x, y);
    const point = this.hit(ray, side)?.point ?? pickFootprint(ray, this.scene?.footprints ?? [])?.point;
    if (point) return point.map((p, i) => p - this.centre[i]!) as Vector;
    const level = this.goal.target[2] + this.centre[2];
    const t = (level - ray.origin[2]) / ray.direction[2];
    if (!(t > 0) || t > 20 * camera.distance(this.goal)) return null;
    return ray.origin.map((o, i) => o + ray.direction[i]! * t - this.centre[i]!) as Vector;
  }

  private rayAt(x: number, y: number): { ray: Ray; side: Side } {
    this.aim();
    const right = this.isRight(x);
    const share = new THREE.Vector3(
      (this.inPane(x) / this.paneWidth) * 2 - 1,
      1 - (y / this.height) * 2,
      0.5,
    );
    const towards = share.unproject(this.eye).sub(this.eye.position).normalize();
    const origin = this.eye.position.toArray().map((o, i) => o + this.centre[i]!) as Vector;
    return { ray: { origin, direction: towards.toArray() as Vector }, side: right ? this.sides[1]! : this.sides[0] };
  }

  private hit(ray: Ray, side: Side): Hit | null {
    const { walls, roofs, parties } = this.choices;
    const seen = { wall: walls, party_wall: parties, roof: roofs, ground: walls, soffit: roofs };
    const hit = pick(ray, side.shown(), (face) => seen[face.class].shown, this.keeps);
    const far = side === this.sides[0] && walls.shown ? this.far.pick(ray) : null;
    return far && (!hit || far.distance < hit.distance) ? far : hit;
  }
  private readonly keeps = (point: Vector) =>
    !this.plane ||
    this.plane.distanceToPoint(new THREE.Vector3(...(point.map((p, i) => p - this.centre[i]!) as Vector))) >= 0;

  private markAt(x: number, y: number): string | null {
    if (!this.choices.diagnostics.shown) return null;
    const right = this.isRight(x);
    const local = this.inPane(x);
    for (const { building, place } of this.marked[right ? 1 : 0]!) {
      const p = new THREE.Vector3(...place).project(this.eye);
      const [px, py] = [((p.x + 1) / 2) * this.paneWidth, ((1 - p.y) / 2) * this.height];
      if (p.z < 1 && Math.hypot(px - local, py - y) <= 8) return building;
    }
    return null;
  }

  // ---- updates

  private recentre(centre: Vector) {
    const by = centre.map((c, i) => this.centre[i]! - c) as Vector;
    const shift = (pose: Pose) => ({ ...pose, target: pose.target.map((t, i) => t + by[i]!) as Vector });
    this.pose = shift(this.pose);
    this.goal = shift(this.goal);
    this.centre = centre;
    this.highlight.dispose();
    this.highlight = new Highlight(centre);
    this.world.add(this.highlight.group);
    this.sides.forEach((side, i) => {
      if (!side) return;
      const fresh = new Side(this.output(i as 0 | 1));
      Object.assign(fresh, { buildings: side.buildings, drafts: side.drafts, maps: side.maps });
      side.dispose();
      this.sides[i as 0 | 1] = fresh;
      this.world.add(fresh.output.group);
      fresh.output.set(fresh.buildings, fresh.drafts, false);
      fresh.output.look.errorLimit.value = this.errorLimit;
      this.drapeError(fresh);
      this.setSegmentation(i as 0 | 1, this.layersOf[i as 0 | 1]);
    });
    if (this.tiles) this.setTiles(this.index);
    this.placeMarks();
    this.showSelection();
    for (const side of this.sides) side?.output.paint(this.paints);
    this.far.set(this.large, centre);
    this.setBasemap(this.basemapBytes);
    this.setOthers(this.otherModels);
    this.setTerrain(this.terrainBytes);
    this.setMeasure(this.measured.points, this.measured.closed);
    this.setPairs(this.pairs.pairs, this.pairs.begun);
    const [pin, caseOf] = [this.pin, this.caseOf];
    this.setPin(null);
    this.setPin(pin);
    this.setCase(null);
    this.setCase(caseOf);
    this.setSection(this.section);
  }

  private fadeModels(output: Output) {
    const of = ({ shown, opacity }: { shown: boolean; opacity: number }) => (shown ? opacity : 0);
    const { walls, parties, roofs, outlines, error } = this.choices;
    output.fade({ walls: of(walls), parties: of(parties), roofs: of(roofs), outlines: of(outlines) });
    this.farLook.opacities.value = [of(walls), of(walls), of(roofs), of(walls), of(roofs)];
    output.look.errorOn.value = output.look.errorMap.value ? of(error) : 0;
  }

  private showMesh() {
    const { mesh } = this.choices;
    if (this.tiles) this.tiles.opacity = mesh.shown ? mesh.opacity : 0;
  }

  /** Footprints at ground height are hidden by the roofs of the mesh: without models they are drawn through it. */
  private showBuried() {
    const { footprints } = this.choices;
    this.buried.opacity = footprints.shown && this.sides[0].buildings.size === 0 ? 0.75 * footprints.opacity : 0;
  }

  /** Hides the mesh where there are models, unless its layer is shown. */
  private maskMesh() {
    const look = this.tiles?.look;
    if (!look) return;
    const { meshWithin, mesh, walls, roofs } = this.choices;
    const box = this.centred(this.content());
    const any = this.sides[0].buildings.size > 0 && (walls.shown || roofs.shown) && mesh.shown;
    look.masked.value = any && !meshWithin.shown ? 1 : 0;
    if (!look.masked.value || look.mask.value?.userData.of === this.sides[0].buildings) return;
    const [wide, deep] = [box.high[0] - box.low[0] + 2, box.high[1] - box.low[1] + 2];
    const scale = Math.min(5, 4096 / Math.max(wide, deep)); // cells of at least 0.2 m
    const picture = document.createElement("canvas");
    picture.width = Math.ceil(wide * scale);
    picture.height = Math.ceil(deep * scale);
    const draw = picture.getContext("2d")!;
    const [left, bottom] = [box.low[0] - 1 + this.centre[0], box.low[1] - 1 + this.centre[1]];
    draw.fillStyle = draw.strokeStyle = "#fff";
    draw.lineWidth = 0.5 * scale;
    for (const { parts } of this.sides[0].buildings.values()) {
      for (const { plan } of parts) {
        draw.beginPath();
        for (const ring of [plan.outer, ...plan.holes]) {
          ring.points.forEach(([x, y], i) => draw[i ? "lineTo" : "moveTo"]((x - left) * scale, (y - bottom) * scale));
          draw.closePath();
        }
        draw.fill("evenodd");
        draw.stroke();
      }
    }
    look.mask.value?.dispose();
    const texture = new THREE.CanvasTexture(picture);
    texture.flipY = false;
    texture.generateMipmaps = false;
    texture.minFilter = THREE.LinearFilter;
    texture.userData.of = this.sides[0].buildings;
    look.mask.value = texture;
    look.maskFrame.value.set(box.low[0] - 1, box.low[1] - 1, scale / picture.width, scale / picture.height);
  }

  private placeMarks() {
    this.sides.forEach((side, i) => {
      const [positions, tones]: [number[], number[]] = [[], []];
      const marked: { building: string; place: Vector }[] = [];
      for (const building of side?.buildings.values() ?? []) {
        const all = [...building.reasons, ...building.diagnostics, ...building.parts.flatMap((p) => p.diagnostics)];
        if (!all.length) continue;
        const { low, high } = this.centred(
          building.parts.length ? boxOf(building) : this.footprintBox((f) => f.id === building.id),
        );
        if (!Number.isFinite(low[0])) continue;
        const place: Vector = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2] + 1];
        marked.push({ building: building.id, place });
        positions.push(...place);
        tones.push(...(all.some((d) => d.severity === "error") ? [0.82, 0.13, 0.13] : [0.85, 0.5, 0.05]));
      }
      this.marked[i] = marked;
      this.marks[i]!.set(positions, tones);
    });
    this.showMarks(0);
  }

  /** Shows the marks of one run: each pane has its own. */
  private showMarks(side: number, shown = this.choices.diagnostics.shown) {
    this.marks.forEach((marks, i) => (marks.object.visible = i === side && shown && this.marked[i]!.length > 0));
  }

  private showSelection() {
    const { at, also } = this.selected;
    const part = (p: { building: string; part: string }) =>
      this.sides[0].building(p.building)?.parts.filter((q) => q.id === p.part) ?? [];
    this.highlight.select(at, at ? this.sides[0].building(at.building) : undefined, this.choices);
    this.highlight.selectAlso(also.flatMap(part));
  }

  /** Box of the models; of the footprints if there are none; else of the mesh. */
  private content(): Box {
    return (this.contents ??= this.contentNow());
  }
  private contentNow(): Box {
    if (this.large && this.large.low[0] <= this.large.high[0]) return { low: this.large.low, high: this.large.high };
    const box = emptyBox();
    for (const building of this.sides[0].shown()) {
      const { low, high } = boxOf(building);
      if (low[0] > high[0]) continue;
      grow(box, ...low);
      grow(box, ...high);
    }
    if (!isEmpty(box)) return box;
    const ground = this.footprintBox(() => true);
    if (!isEmpty(ground)) return { low: ground.low, high: [ground.high[0], ground.high[1], ground.high[2] + 10] };
    return this.scene ?? { low: [-50, -50, 0], high: [50, 50, 20] };
  }
  private footprintBox(which: (f: api.SceneFootprint) => boolean): Box {
    const box = emptyBox();
    for (const footprint of this.scene?.footprints.filter(which) ?? []) {
      for (const { outer } of footprint.polygons) for (const [x, y] of outer) grow(box, x, y, footprint.ground);
    }
    return box;
  }
  private centred({ low, high }: Box): Box {
    const about = (v: Vector) => v.map((x, i) => x - this.centre[i]!) as Vector;
    return { low: about(low), high: about(high) };
  }

  /** Shows everything, as long as the camera has not been moved. */
  private place() {
    if (this.framed || (!this.scene && !this.sides[0].buildings.size && !this.large)) return;
    const { low, high } = this.centred(this.content());
    this.goal = this.pose = camera.home(low, high, this.aspect);
  }

  private get isBeside() {
    return this.beside && !this.sides[1];
  }
  private get paneWidth() {
    if (this.isBeside) return this.width / 2;
    return this.sides[1] && this.divided === null ? this.width / 2 : this.width;
  }
  private isRight(x: number) {
    return this.sides[1] !== null && x > (this.divided === null ? this.paneWidth : this.divided * this.width);
  }
  private inPane(x: number) {
    if (this.isBeside) return x < this.paneWidth ? x : x - this.paneWidth;
    return this.divided === null && this.isRight(x) ? x - this.paneWidth : x;
  }
  private get aspect() {
    return this.paneWidth / this.height;
  }

  // ---- drawing

  /** Asks for an image. `more`: other things changed than drafts and highlights. */
  request(more = true) {
    if (more) this.still?.forget();
    if (!this.frameAsked && !this.gone.signal.aborted)
      this.frameAsked = requestAnimationFrame((now) => this.frame(now));
  }

  private frame(now: number) {
    this.frameAsked = 0;
    const passed = Math.min(0.1, (now - this.last) / 1000 || 0.016);
    if (this.moving) this.tiles?.budget.took(now - this.last);
    this.last = now;
    if (this.flight) {
      const share = Math.min(1, Math.max(0, (now - this.flight.started) / 1000 / flightSeconds));
      this.pose = camera.mixed(this.flight.from, this.goal, share * share * (3 - 2 * share));
      if (share >= 1) this.flight = null;
    } else if (!camera.same(this.pose, this.goal)) {
      this.pose = camera.mixed(this.pose, this.goal, 1 - Math.exp(-passed / followSeconds));
    }
    const settled = !this.flight && camera.same(this.pose, this.goal);
    if (settled && this.pose !== this.goal) {
      this.pose = this.goal;
      this.sides[0].output.textures.lookAt(this.target);
      this.loadNear();
      if (this.framed)
        this.listener.moved({ ...this.pose, target: this.pose.target.map((t, i) => t + this.centre[i]!) as Vector });
    }
    const quick = this.hurried && this.smooth !== null;
    this.hurried = false;
    this.coarse = quick;
    this.draw(settled && !quick);
    this.coarse = false;
    this.moving = !settled; // the next image follows at once
    if (!settled) this.request(false);
    else if (quick) this.smoothed = setTimeout(() => this.request(false), calmMilliseconds);
  }

  private aim() {
    const { eye, pose } = this;
    const at = camera.eye(pose);
    const box = this.scene ? this.centred(this.scene) : this.centred(this.content());
    const middle = box.low.map((l, i) => (l + box.high[i]!) / 2) as Vector;
    const radius = Math.hypot(...box.low.map((l, i) => box.high[i]! - l)) / 2 + 20;
    const away = Math.hypot(...at.map((p, i) => p - middle[i]!));
    eye.fov = (pose.fov * 180) / Math.PI;
    eye.aspect = this.aspect;
    eye.near = Math.max(away - radius, camera.distance(pose) * 0.02, 0.05);
    eye.far = away + radius + 10;
    eye.position.set(...at);
    eye.up.set(0, 0, 1);
    eye.lookAt(...pose.target);
    eye.updateProjectionMatrix();
    eye.updateMatrixWorld();
  }

  /** `stays`: no other image follows at once. */
  private draw(stays = true) {
    this.aim();
    if (this.drawDrag()) return;
    this.dragged = null;
    if (stays) this.smooth?.begin(this.renderer);
    this.stream();
    this.far.seenFrom(this.eye.position);
    this.highlight.detailed = this.pose.size < 150;
    for (const side of this.sides) side?.output.seenFrom(this.pose.size, this.choices.outlines.opacity);
    const [first, second] = this.sides;
    const { divided } = this;
    const split = divided === null ? null : Math.round(divided * this.width);
    const beside = this.isBeside;
    this.caseLines.object.visible = false; // over the scan alone
    this.renderer.setScissorTest(second !== null || split !== null || beside);
    if ((split !== null || beside) && !second) {
      // The scan on the left, the models on the right.
      const masked = this.tiles?.look.masked.value ?? 0;
      const scan = this.tiles?.look.opacity.value ?? 0;
      const hide = [first.output.group, this.far.group, this.terrain.group, this.highlight.group, this.cap.object, this.capLines.object];
      const visible = hide.map((o) => o.visible);
      hide.forEach((o) => (o.visible = false));
      this.showMarks(-1);
      if (this.tiles) {
        this.tiles.look.masked.value = 0;
        this.tiles.opacity = 1;
      }
      this.caseLines.object.visible = beside && this.caseOf !== null;
      this.pane(0, 0, beside ? this.paneWidth : split!);
      this.caseLines.object.visible = false;
      hide.forEach((o, i) => (o.visible = visible[i]!));
      this.showMarks(0);
      if (this.tiles) {
        this.tiles.look.masked.value = masked;
        this.tiles.opacity = scan;
      }
      if (beside) this.pane(this.paneWidth, this.paneWidth, this.paneWidth);
      else this.pane(0, split!, this.width - split!);
    } else {
      [first, second].forEach((side, i) => {
        if (!side) return;
        for (const other of this.sides) {
          if (!other) continue;
          other.output.group.visible = other === side;
          if (other.segmentation) other.segmentation.group.visible = other === side;
        }
        this.highlight.group.visible = i === 0; // it is of the run on the left
        this.cap.object.visible = this.capLines.object.visible = i === 0 && this.filled > 0;
        this.showMarks(i);
        if (split !== null) this.pane(0, i ? split : 0, i ? this.width - split : split);
        else this.pane(i * this.paneWidth, i * this.paneWidth, this.paneWidth);
      });
    }
    if (stays) this.smooth?.end(this.renderer, this.width, this.height);
    this.listener.drawn(this.pose.azimuth, this.pose.size / this.height);
  }

  /** An image of a drag, of which only the changed buildings and the highlights are new. */
  private drawDrag(): boolean {
    const [{ drafts, output }, second] = this.sides;
    if (!this.still || second || this.divided !== null || this.beside || drafts.size === 0) return false;
    output.apart(drafts, changing);
    for (const object of [this.highlight.group, this.cap.object, this.capLines.object]) object.traverse((o) => o.layers.set(changing));
    this.cap.object.visible = this.capLines.object.visible = this.filled > 0;
    this.highlight.detailed = this.pose.size < 150;
    const { pose, eye, renderer } = this;
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, this.width, this.height);
    const fresh = this.still.draw(renderer, JSON.stringify([pose, [...drafts.keys()]]), () => {
      this.stream();
      this.far.seenFrom(eye.position);
      output.seenFrom(pose.size, this.choices.outlines.opacity);
      eye.layers.set(0);
      renderer.render(this.world, eye);
    });
    const now = seenAt(this.changingBoxes(), eye, this.width, this.height);
    const { left, bottom, right, top } =
      fresh || !this.dragged ? { left: 0, bottom: 0, right: this.width, top: this.height } : both(this.dragged, now);
    this.dragged = now;
    renderer.setScissor(left, bottom, right - left, top - bottom);
    renderer.setScissorTest(true);
    this.still.copy(renderer);
    eye.layers.set(changing);
    renderer.render(this.world, eye);
    eye.layers.enableAll();
    renderer.setScissorTest(false);
    this.listener.drawn(pose.azimuth, pose.size / this.height);
    return true;
  }

  /** The boxes of what a drag changes, in the world of three.js. */
  private *changingBoxes(): Iterable<THREE.Box3> {
    for (const draft of this.sides[0].drafts.values()) {
      const { low, high } = this.centred(boxOf(draft));
      yield new THREE.Box3(new THREE.Vector3(...low), new THREE.Vector3(...high));
    }
    for (const object of [...this.highlight.group.children, this.cap.object, this.capLines.object]) {
      if (!object.visible || !(object instanceof THREE.Mesh)) continue;
      const geometry = object.geometry as THREE.BufferGeometry;
      geometry.computeBoundingBox();
      if (geometry.boundingBox) yield geometry.boundingBox;
    }
  }

  /** Draws one pane: its left edge, and the part of it that is drawn. */
  private pane(left: number, from: number, wide: number) {
    if (wide <= 0) return;
    const { renderer, paneWidth, height } = this;
    renderer.setViewport(left, 0, paneWidth, height);
    renderer.setScissor(from, 0, wide, height);
    const target = renderer.getRenderTarget();
    if (target) {
      const ratio = renderer.getPixelRatio();
      target.viewport.set(left, 0, paneWidth, height).multiplyScalar(ratio).round();
      target.scissor.set(from, 0, wide, height).multiplyScalar(ratio).round();
      target.scissorTest = true;
      renderer.setRenderTarget(target); // takes them over
    }
    renderer.clear();
    renderer.render(this.world, this.eye);
  }

  private stream() {
    if (!this.tiles || (!this.tiles.group.visible && this.divided === null && !this.isBeside)) return;
    const pose = this.pose;
    const ahead = this.next.flatMap((building) => {
      const next = this.poseAt(building);
      if (!next) return [];
      this.pose = next;
      this.aim();
      return [this.eyeNow()];
    });
    this.pose = pose;
    this.aim();
    this.tiles.update(this.eyeNow(), ahead, this.coarse ? coarseTolerance : undefined);
  }

  /** The camera as the tiles of the scan are chosen for it. */
  private eyeNow(): Eye {
    const frustum = new THREE.Frustum().setFromProjectionMatrix(
      new THREE.Matrix4().multiplyMatrices(this.eye.projectionMatrix, this.eye.matrixWorldInverse),
    );
    const box = new THREE.Box3();
    const about = (v: THREE.Vector3, p: Vector) =>
      v.set(p[0] - this.centre[0], p[1] - this.centre[1], p[2] - this.centre[2]);
    return {
      position: this.eye.position.toArray().map((p, i) => p + this.centre[i]!) as Vector,
      pixels: (this.height * this.renderer.getPixelRatio()) / 2 / Math.tan(this.pose.fov / 2),
      sees: (tile) => {
        about(box.min, tile.low);
        about(box.max, tile.high);
        return frustum.intersectsBox(box);
      },
    };
  }
}

/** A copy of the image with a text in its lower right corner. */
function withNote(image: HTMLCanvasElement, note: string): HTMLCanvasElement {
  const copy = document.createElement("canvas");
  copy.width = image.width;
  copy.height = image.height;
  const draw = copy.getContext("2d")!;
  draw.drawImage(image, 0, 0);
  const size = Math.max(11, Math.round(image.height / 80)); // pixels
  draw.font = `${size}px sans-serif`;
  draw.textAlign = "right";
  draw.textBaseline = "bottom";
  draw.fillStyle = "rgb(255 255 255 / 75%)";
  const wide = Math.min(image.width, draw.measureText(note).width + size);
  draw.fillRect(image.width - wide, image.height - 1.5 * size, wide, 1.5 * size);
  draw.fillStyle = "#222";
  draw.fillText(note, image.width - size / 2, image.height - size / 4, image.width - size);
  return copy;
}

const empty: ReadonlyMap<string, api.Building> = new Map();
