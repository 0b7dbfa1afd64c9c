// The types of requests and answers, with the names of the schemas in apps/server/openapi.json. Lengths are in metres, z
// is up, coordinates are local: add the origin of the scene for the coordinates of the files.

export type Point2 = [number, number];
export type ProfilePoint = [inward: number, height: number];

/** A ring: edge i goes from points[i] to points[i + 1] and has the profile profiles[profile_of_edge[i]]. */
export interface PlanRing {
  points: Point2[];
  profile_of_edge: number[];
  overhang_of_edge?: number[]; // of the eaves; absent: nowhere
}
/** The editable source of a part, as in plans.json. The outer ring is counter-clockwise, holes are clockwise. */
export interface Plan {
  base: number; // z
  cap: number; // height above the base
  outer: PlanRing;
  holes: PlanRing[];
  profiles: ProfilePoint[][];
}

export interface Diagnostic {
  severity: "warning" | "error";
  code: string;
  message: string;
  subject: string;
}

export interface NamedPlan {
  id: string;
  plan: Plan;
}

export type SurfaceClass = "wall" | "party_wall" | "roof" | "ground" | "soffit";

/** A solid to draw: its triangles and the outlines of its faces. */
export interface Geometry {
  positions: number[]; // x y z …, local, doubles
  triangles: number[]; // three vertex indices each, counter-clockwise seen from outside
  face_of: number[]; // per triangle: index of its face
  faces: GeometryFace[];
}
export interface GeometryFace {
  loops: number[][]; // vertex indices; the outer loop first
  class: SurfaceClass;
  ring: number | null; // ring of the plan's edge that it was extruded from; null for cap and base
  edge: number | null;
}

export interface RaisedPart {
  id: string;
  plan: Plan;
  geometry: Geometry | null; // null: extruding failed; diagnostics say why
  outcome: "full" | "simplified" | "two_part" | "prism";
  diagnostics: Diagnostic[];
  mse: number | null; // mean squared vertical error over its polygon, m²
  volume: number; // m³
}

export interface RaisedBuilding {
  id: string;
  revision: number; // an edit has to name it
  valid: boolean;
  parts: RaisedPart[];
  diagnostics: Diagnostic[];
  mse: number | null;
}

export interface Building extends RaisedBuilding {
  block: string;
  outcome: "full" | "fallback" | "covered" | "refused"; // of the run, before edits
  reasons: Diagnostic[]; // of the run
  edited: boolean; // its plans differ from those of the run
  ground: number; // z
  confidence: number | null; // probability that the model of the run is right; null where edited since, or without a scan
}

/** Every building of a run without plans and models, column by column: of large runs, whose models are asked for by tile. */
export interface BuildingList {
  tile_size: number; // m; a building is in the tile of the centre of its box in plan: floor(centre / size)
  ids: string[];
  blocks: string[];
  outcomes: ("full" | "fallback" | "covered" | "refused")[];
  volumes: number[]; // m³
  errors: (number | null)[]; // mse, m²: of unedited buildings as the run measured it over their parts
  confidences: (number | null)[]; // probability that the model is right
  edited: boolean[];
  attributes: AttributeMeaning[]; // that some building or part has
  shapes: number[][][]; // of each part: base, height of a prism in place of its model, x, y, x, y …, in centimetres
  reasons: Record<string, Diagnostic[]>; // by id, of those that have some
  history: History;
}

export interface InputFile {
  path: string;
  bytes: number;
  sha256: string;
  changed: boolean; // the file on disk is missing, or its contents changed since it was read
}

export type RunState = "queued" | "running" | "done" | "failed" | "cancelled" | "interrupted";

export interface Scores {
  mse: number; // m², as in the paper
  footprint_mse: number; // m², over the footprints
  footprint_median_absolute: number; // m
  inside_mse: number; // m²
  missed: number; // m²
  invented: number; // m²
}

export interface CarriedOver {
  carried: string[]; // buildings
  refused: Diagnostic[]; // why others could not be; the subject names the buildings
}

export type AttributeValue = string | number | boolean | null;
export interface AttributeMeaning {
  name: string;
  source: boolean; // of the footprints, not computed by mansard
  unit: string; // empty for none
  meaning: string; // empty for attributes of the source
}
export interface PartAttributes {
  id: string;
  values: Record<string, AttributeValue>;
}
export interface BuildingAttributes {
  id: string;
  values: Record<string, AttributeValue>;
  parts: PartAttributes[];
}
/** Attributes of all buildings and parts as they are now. */
export interface AttributeTable {
  attributes: AttributeMeaning[];
  buildings: BuildingAttributes[];
}

/** One attribute of all buildings, in the order of the list; null also where a computed one is of before an edit. */
export interface AttributeColumn {
  attribute: AttributeMeaning;
  values: AttributeValue[];
}

/** The buildings at a lower level of detail. */
export interface LevelOfDetail {
  buildings: LevelSolids[];
}
export interface LevelSolids {
  id: string;
  solids: Geometry[];
}

/** Models of any producer as triangles. */
export interface OtherModel {
  lod: string; // "2.2", or several; empty if the format has none
  buildings: string[]; // ids
  positions: number[]; // x y z …, local
  triangles: number[]; // three vertex indices each
  classes: string[]; // per triangle
  building_of: number[]; // per triangle: index into buildings
  warnings: Diagnostic[];
}

/** Options that make mesh and footprints match. */
export interface Placing {
  reading: Record<string, string>; // options to read the inputs with; empty: they match as they are
  reason: string;
  correlation: number; // of high cells with footprints, −1 to 1
  next: number; // correlation at the best other place
  inside: number; // share of the footprints that is high, 0 to 1
}
export interface Alignment {
  proposal: Placing | null; // null: nothing was found
}

/** Of the run as it is now. */
export interface ScoresNow {
  edits: number; // that the scores count
  scores: Scores | null; // null for imported models
}

export interface StageTime {
  stage: string;
  cpu_seconds: number;
  wall_seconds: number; // during which at least one block was in the stage
}

// without reading and writing files
export interface Times {
  cpu_seconds: number; // on all threads
  wall_seconds: number; // from beginning to end
  stages: StageTime[];
}

export interface RunSummary {
  id: string; // "run-3"
  label: string;
  state: RunState;
  failure: Diagnostic | null;
  created: string; // ISO 8601
  preset: string; // "" for none
  options: Record<string, string>; // "module.name" → value, for values that differ from the defaults
  blocks: string[]; // empty: all
  scores: Scores | null;
  times: Times;
  buildings: number;
  full: number;
  parts: number;
  faces: number;
  edits: number; // applied edits
}

export interface Project {
  name: string;
  folder: string;
  inputs: {
    given: { meshes: string[]; footprints: string }; // names as given; *** in place of a database's password
    meshes: InputFile[];
    terrain: InputFile[];
    footprints: InputFile[];
  } | null;
  reading: Record<string, string>; // options that the scene was read with, as given
  runs: RunSummary[];
  scene: boolean; // GET /api/scene answers: the inputs have been read, or their scene was kept from the last time
  sample: boolean; // a sample is available: POST /api/project/sample
  basemap_attribution: string; // to be shown with the basemap; empty if none was given
}

export interface Option {
  module: string;
  name: string; // unique in its module
  used_in: "inputs" | "runs" | "other"; // inputs: all runs share it; other: runs ignore it
  kind: "boolean" | "integer" | "number" | "string" | "choice";
  unit: string; // "" for none
  minimum: number | null;
  maximum: number | null;
  choices: string[];
  default: string; // as text; several numbers separated by blanks
  alias: string; // short name on the command line; "" for none
  meaning: string;
  source: string; // where the default comes from; "" if not stated
  advanced: boolean; // few users have a reason to change it
}
export interface Preset {
  name: string;
  meaning: string;
  values: Record<string, string>;
}
/** raster: heights on a grid, as a mesh or as the terrain. models: models that mansard wrote. */
export type InputKind = "mesh" | "raster" | "footprints" | "models";
/** A file format that can be opened or exported. */
export interface Format {
  name: string; // "cityjson", as on the command line
  title: string; // "CityJSON"
  description: string;
  extensions: string[]; // in lower case, with the dot
  sidecars: string[]; // extensions of files that are read along with a file of this format
  reads: InputKind[]; // what can be read from it; empty: export only
  files: string[]; // for GET /api/runs/{run}/export/{file}; a folder is exported as a ZIP; empty: no export
}
export interface Options {
  options: Option[];
  presets: Preset[];
  formats: Format[];
  compressed_extensions: string[]; // such as ".gz": the format is that of the name without it
}

export interface SceneBlock {
  name: string;
  buildings: string[];
  low: [number, number, number];
  high: [number, number, number];
  triangles: number;
}
export interface SceneFootprint {
  id: string;
  block: string | null;
  polygons: { outer: Point2[]; holes: Point2[][] }[];
  ground: number; // z
  defect: Diagnostic | null;
}
export interface Scene {
  origin: [number, number, number];
  crs: string;
  triangles: number;
  low: [number, number, number];
  high: [number, number, number];
  blocks: SceneBlock[];
  footprints: SceneFootprint[];
  warnings: Diagnostic[];
}

/** Level 0 is the unsimplified mesh; each higher level has about a quarter of the triangles. */
export interface TileIndex {
  levels: number;
  tiles: TileInfo[];
}
export interface TileInfo {
  id: string; // GET /api/scene/tiles/{id}: little-endian uint32 vertices, uint32 triangles, float32 xyz…, uint32 indices…
  level: number;
  column: number; // the tile (column >> 1, row >> 1) one level higher covers this one
  row: number;
  low: [number, number, number];
  high: [number, number, number];
  centre: [number, number, number]; // origin of the positions
  vertices: number;
  triangles: number;
}

/** Results of the segmentation of a run. Costs are in units of the objective. */
export interface Layers {
  sweep_edges: SweepEdgeLine[];
  faces: FractureFace[];
  edges: FractureEdge[];
}
export interface SweepEdgeLine {
  block: string;
  from: Point2;
  to: Point2;
  low: number; // z
  high: number; // z
}
export interface FractureFace {
  block: string;
  outer: Point2[];
  holes: Point2[][];
  inside: boolean;
  height: number | null; // z
  part: number | null; // part of the block that the face belongs to
}
export interface FractureEdge {
  block: string;
  lines: Point2[][];
  chosen: boolean;
  cost_cut: number;
  cost_uncut: number;
}

/** GET /api/runs/{run}/error/{block}: float32, little-endian, rows from south to north, NaN where there is no value;
 *  model − mesh in m. */
export interface ErrorMap {
  block: string;
  origin: Point2; // centre of cell (0, 0)
  grid: number;
  columns: number;
  rows: number;
}

/** Section across an edge, as (inward, height) from its foot. */
export interface Section {
  share: number; // 0 … 1 along the edge
  pieces: [ProfilePoint, ProfilePoint][]; // segments of the mesh
  climbs: ProfilePoint[][]; // raw profiles along the edge
}

export interface Change {
  building: string;
  revision: number;
  parts: NamedPlan[]; // all parts of the building after the change
}
export interface Edit {
  what: string;
  changes: Change[];
}
export interface Proposal {
  changes: Change[]; // not applied: preview it and send it as an edit
}
/** A part with the best roof of a kind for the scan. */
export interface FittedRoof {
  building: string;
  part: string;
  plan: Plan | null; // null: it cannot have such a roof
  mse: number | null; // m², with this roof
  mse_before: number | null; // m², with the roof that was sent
  why: Diagnostic | null; // why there is none
}
export interface Applied {
  buildings: Building[]; // the changed buildings
  history: History;
}
export interface History {
  edits: string[]; // descriptions, oldest first
  done: number; // so many of the first edits are applied; the rest can be redone
}

/** What a person decided about a model. */
export type Verdict = "right" | "wrong" | "later";
export interface Decision {
  building: string;
  decision: Verdict;
  note: string; // empty for none
  reviewer: string; // empty where unknown
  time: string; // ISO 8601, UTC
}
export interface ReviewDecision extends Decision {
  lapsed: boolean; // the model is not the one that was looked at any more
}
export interface Review {
  reviewer: string; // who decides on this server; empty where unknown
  decisions: ReviewDecision[];
}
export interface FiledDecision extends Decision {
  model: string; // SHA-256 of the plans that were looked at
}
/** The decisions of a project, as its file review.json has them. */
export interface ReviewFile {
  type: "mansard-review";
  version: number;
  decisions: FiledDecision[];
}
export interface ReviewConflict {
  kept: Decision;
  dropped: Decision;
}
export interface ReviewMerged {
  added: number; // decisions that the project did not have
  replaced: number; // decisions of the project that a later one replaced
  conflicts: ReviewConflict[]; // buildings on which the two disagree
}
export interface ReviewRequest {
  building: string;
  revision: number; // of the building that was looked at
  decision: Verdict | null; // null: the decision is taken back
  note?: string;
}
export interface ReviewPlace {
  at: [number, number, number]; // on the scan, or on the model where the scan does not cover it; local
  what: "roof" | "inside" | "outside" | "unseen"; // roof: away from walls; inside, outside: at the outline; unseen: not covered by the scan
  difference: number | null; // m; model − scan, on average over a square of at most 1 m; null where the scan does not cover it
}
export interface ReviewAlternative {
  what: string; // in words: "gable roof"
  mse: number | null; // m², measured as that of the building
  roof_faces: number;
  parts: NamedPlan[];
}
/** What a person who reviews a building is shown beside it. */
export interface ReviewCase {
  building: string;
  revision: number; // of the building that all of this is about
  place: ReviewPlace | null; // where to look first, by the main reason for doubt: mostly where scan and model differ most; null without a scan
  alternatives: ReviewAlternative[]; // the one with the lowest error first; at most three
}

export interface Job {
  id: string;
  kind: "read" | "run" | "textures";
  run: string | null;
  state: RunState;
  stage: string;
  subject: string;
  fraction: number; // 0 … 1
  failure: Diagnostic | null;
}

/** One server-sent event: `data: {…}`. */
export type Event =
  | { type: "job"; job: Job }
  | { type: "project"; project: Project } // inputs, runs or their states changed
  | { type: "buildings"; run: string; client: string; buildings: Building[]; history: History } // an edit, undo or redo
  | { type: "review"; client: string } // decisions were made, taken back or merged
  | { type: "ping" };

/** The body of every answer with an HTTP status of at least 400. */
export interface Refusal {
  error: Diagnostic;
}
