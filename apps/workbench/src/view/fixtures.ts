// A house for tests: 10 m by 6 m from (0, 0), eaves at 3 m, ridge along x at 6 m, gables at both ends.
import type { Building, Geometry, Plan, RunSummary } from "../api/types";

const positions = [
  [0, 0, 0], [10, 0, 0], [10, 6, 0], [0, 6, 0], // foot
  [0, 0, 3], [10, 0, 3], [10, 6, 3], [0, 6, 3], // eaves
  [0, 3, 6], [10, 3, 6], // ridge
].flat(); // prettier-ignore

export const house: Geometry = {
  positions,
  triangles: [
    [0, 1, 5], [0, 5, 4], // south wall
    [1, 2, 6], [1, 6, 9], [1, 9, 5], // east gable
    [2, 3, 7], [2, 7, 6], // north wall
    [3, 0, 4], [3, 4, 8], [3, 8, 7], // west gable
    [4, 5, 9], [4, 9, 8], // south roof
    [6, 7, 8], [6, 8, 9], // north roof
    [0, 3, 2], [0, 2, 1], // ground
  ].flat(), // prettier-ignore
  face_of: [0, 0, 1, 1, 1, 2, 2, 3, 3, 3, 4, 4, 5, 5, 6, 6],
  faces: [
    { loops: [[0, 1, 5, 4]], class: "wall", ring: 0, edge: 0 },
    { loops: [[1, 2, 6, 9, 5]], class: "party_wall", ring: 0, edge: 1 },
    { loops: [[2, 3, 7, 6]], class: "wall", ring: 0, edge: 2 },
    { loops: [[3, 0, 4, 8, 7]], class: "wall", ring: 0, edge: 3 },
    { loops: [[4, 5, 9, 8]], class: "roof", ring: 0, edge: 0 },
    { loops: [[6, 7, 8, 9]], class: "roof", ring: 0, edge: 2 },
    { loops: [[0, 3, 2, 1]], class: "ground", ring: null, edge: null },
  ],
};

export const plan: Plan = {
  base: 0,
  cap: 9,
  outer: {
    points: [
      [0, 0],
      [10, 0],
      [10, 6],
      [0, 6],
    ],
    profile_of_edge: [0, 1, 0, 1],
  },
  holes: [],
  profiles: [
    [
      [0, 0],
      [0, 3],
      [3, 6],
    ],
    [
      [0, 0],
      [0, 9],
    ],
  ],
};

export const building = (id: string, change: Partial<Building> = {}): Building => ({
  id,
  revision: 0,
  valid: true,
  parts: [{ id: `${id}-1`, plan, geometry: house, outcome: "full", diagnostics: [], mse: 0.04, volume: 270 }],
  diagnostics: [],
  mse: 0.04,
  block: "block-0",
  outcome: "full",
  reasons: [],
  edited: false,
  ground: 0,
  confidence: 0.95,
  ...change,
});

/** A finished run of one house. */
export const summary = (change: Partial<RunSummary> = {}): RunSummary => ({
  id: "run-1",
  label: "",
  state: "done",
  failure: null,
  created: "",
  preset: "",
  options: {},
  blocks: [],
  scores: null,
  times: { cpu_seconds: 0, wall_seconds: 0, stages: [] },
  buildings: 1,
  full: 1,
  parts: 1,
  faces: 7,
  edits: 0,
  ...change,
});
