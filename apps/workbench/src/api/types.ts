// What passes between the page and the server. The names are those of the schemas in apps/server/openapi.json.
// Lengths are metres, z up, coordinates local: add the scene's origin for those of the files.

export type Point2 = [number, number];
export type ProfilePoint = [inward: number, height: number];

/** One ring: edge i goes from points[i] to points[i + 1] and rises along profiles[profile_of_edge[i]]. */
export interface PlanRing {
  points: Point2[];
  profile_of_edge: number[];
}
/** The editable source of one part, exactly as in a plans.json. Outer ring counter-clockwise, holes clockwise. */
export interface Plan {
  base: number; // z
  cap: number; // above base
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

/** A solid ready to draw: triangles by face, and the outlines of its faces. */
export interface Geometry {
  positions: number[]; // x y z …, local, doubles
  triangles: number[]; // three vertex indices each, outward
  face_of: number[]; // per triangle
  faces: GeometryFace[];
}
export interface GeometryFace {
  loops: number[][]; // vertex indices; outer first
  class: SurfaceClass;
  ring: number | null; // the plan's edge it comes from; null for cap and base
  edge: number | null;
}

export interface RaisedPart {
  id: string;
  plan: Plan;
  geometry: Geometry | null; // null: it could not be raised; diagnostics say why
  outcome: "full" | "simplified" | "two_part" | "prism";
  diagnostics: Diagnostic[];
  mse: number | null; // m², vertical, over its polygon
  volume: number; // m³
}

export interface RaisedBuilding {
  id: string;
  revision: number; // what an edit of it must name
  valid: boolean;
  parts: RaisedPart[];
  diagnostics: Diagnostic[];
  mse: number | null;
}

export interface Building extends RaisedBuilding {
  block: string;
  outcome: "full" | "fallback" | "covered" | "refused"; // of the run, before edits
  reasons: Diagnostic[]; // of the run
  edited: boolean; // its plans are not those of the run
  ground: number; // z
}

export interface InputFile {
  path: string;
  bytes: number;
  sha256: string;
  changed: boolean; // the file on disk is missing or is no longer the one that was read
}

export type RunState = "queued" | "running" | "done" | "failed" | "cancelled" | "interrupted";

export interface Scores {
  mse: number; // m², the paper's
  footprint_mse: number; // m², over the footprints
  footprint_median_absolute: number; // m
  inside_mse: number; // m²
  missed: number; // m²
  invented: number; // m²
}

export interface StageTime {
  stage: string;
  seconds: number;
}

export interface RunSummary {
  id: string; // "run-3"
  label: string;
  state: RunState;
  failure: Diagnostic | null;
  created: string; // ISO 8601
  preset: string; // "" for none
  options: Record<string, string>; // "room.name" → value, those that differ from the defaults
  blocks: string[]; // empty: all
  scores: Scores | null;
  times: StageTime[];
  buildings: number;
  full: number;
  parts: number;
  faces: number;
  edits: number; // that stand
}

export interface Project {
  name: string;
  folder: string;
  inputs: {
    given: { meshes: string[]; footprints: string }; // as asked for; a database's password is ***
    meshes: InputFile[];
    terrain: InputFile[];
    footprints: InputFile[];
  } | null;
  reading: Record<string, string>; // options of "ingest" and "block" the scene is read with, those given
  runs: RunSummary[];
  sample: boolean; // a sample is at hand: POST /api/project/sample
}

export interface Option {
  room: string;
  name: string;
  kind: "flag" | "whole" | "number" | "text" | "choice";
  unit: string;
  least: number | null;
  most: number | null;
  choices: string[];
  default: string;
  alias: string;
  meaning: string;
}
export interface Preset {
  name: string;
  meaning: string;
  values: Record<string, string>;
}
/** Models can be taken away in it. */
export interface Format {
  name: string; // "cityjson", as on the command line
  files: string[]; // GET /api/runs/{run}/export/{file}; of a folder, a ZIP of it
  meaning: string;
}
export interface Options {
  options: Option[];
  presets: Preset[];
  formats: Format[];
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

/** Level 0 is the mesh as it is; each further level has about a quarter of the triangles. */
export interface TileIndex {
  levels: number;
  tiles: TileInfo[];
}
export interface TileInfo {
  id: string; // GET /api/scene/tiles/{id}: little-endian uint32 vertices, uint32 triangles, float32 xyz…, uint32 indices…
  level: number;
  column: number; // the tile at (column >> 1, row >> 1) one level up covers this one
  row: number;
  low: [number, number, number];
  high: [number, number, number];
  centre: [number, number, number]; // what positions are relative to
  vertices: number;
  triangles: number;
}

/** Why walls are where they are, per run. Costs are the objective's units. */
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
  part: number | null; // of the block
}
export interface FractureEdge {
  block: string;
  lines: Point2[][];
  chosen: boolean;
  cost_cut: number;
  cost_uncut: number;
}

/** GET /api/runs/{run}/error/{block}: float32 little-endian, row by row from the south, NaN for none; metres, model − mesh. */
export interface ErrorMap {
  block: string;
  origin: Point2; // centre of cell (0, 0)
  grid: number;
  columns: number;
  rows: number;
}

/** Across one edge, (inward, height) from its foot. */
export interface Section {
  share: number; // 0 … 1 along the edge
  pieces: [ProfilePoint, ProfilePoint][]; // the mesh
  climbs: ProfilePoint[][]; // raw profiles along the edge, from its slices
}

export interface Change {
  building: string;
  revision: number;
  parts: NamedPlan[]; // all of the building's parts, as they shall be
}
export interface Edit {
  what: string;
  changes: Change[];
}
export interface Proposal {
  changes: Change[]; // not applied: preview and send as an edit
}
export interface Applied {
  buildings: Building[]; // those that changed
  history: History;
}
export interface History {
  edits: string[]; // what was done, oldest first
  done: number; // the first so many stand; the rest can be redone
}

export interface Job {
  id: string;
  kind: "read" | "run" | "export";
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
  | { type: "ping" };

/** Every refusal: HTTP status ≥ 400 with this body. 409 for "edit-stale". */
export interface Refusal {
  error: Diagnostic;
}
