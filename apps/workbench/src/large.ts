// Large runs: every building is listed at once, without its models. Those of the tiles near the camera are loaded.
import type { AttributeMeaning, BuildingList, Diagnostic } from "./api/types";
import { said } from "./panels/words";
import type { Row } from "./panels/table";

type Vector = [number, number, number];

/** Runs with more buildings than this are large, as on the server. */
export const mostAtOnce = 5_000;
/** Buildings whose models are in memory at most, if the tiles around the camera have no more. */
export const mostLoaded = 6_000;
/** Buildings whose models are loaded around the camera. */
export const mostWanted = 3_000;

/** The ground rings of the parts, as [base, height, x, y, x, y …] in metres. */
export type Shape = readonly number[];

export interface Tile {
  buildings: number[]; // indices
  low: Vector;
  high: Vector;
}

export interface Large {
  rows: readonly Row[]; // by index
  index: ReadonlyMap<string, number>; // by id
  shapes: readonly (readonly Shape[])[];
  tileOf: readonly string[];
  tiles: ReadonlyMap<string, Tile>;
  reasons: ReadonlyMap<string, readonly Diagnostic[]>;
  attributes: readonly AttributeMeaning[];
  low: Vector;
  high: Vector;
  loaded: ReadonlySet<string>; // tiles
}

const grown = (box: { low: Vector; high: Vector }, x: number, y: number, z: number) => {
  const at = [x, y, z];
  for (let i = 0; i < 3; ++i) {
    box.low[i] = Math.min(box.low[i]!, at[i]!);
    box.high[i] = Math.max(box.high[i]!, at[i]!);
  }
};
const empty = (): { low: Vector; high: Vector } => ({
  low: [Infinity, Infinity, Infinity],
  high: [-Infinity, -Infinity, -Infinity],
});

/** The box of a building: of the ground rings of its parts, up to their heights. */
export function boxOfShapes(shapes: readonly Shape[]): { low: Vector; high: Vector } {
  const box = empty();
  for (const [base, height, ...ring] of shapes)
    for (let i = 0; i < ring.length; i += 2) {
      grown(box, ring[i]!, ring[i + 1]!, base!);
      grown(box, ring[i]!, ring[i + 1]!, base! + height!);
    }
  return box;
}

export function largeOf(list: BuildingList): Large {
  const shapes = list.shapes.map((parts) => parts.map((part) => part.map((x) => x / 100)));
  const tiles = new Map<string, Tile>();
  const all = empty();
  const tileOf = shapes.map((parts, i) => {
    const { low, high } = boxOfShapes(parts);
    const there = parts.length > 0;
    const along = (k: 0 | 1) => (there ? Math.floor((low[k] + high[k]) / 2 / list.tile_size) : 0);
    const key = `${along(0)}_${along(1)}`;
    const tile = tiles.get(key) ?? { buildings: [], ...empty() };
    tiles.set(key, tile);
    tile.buildings.push(i);
    if (there)
      for (const corner of [low, high])
        for (const box of [tile, all]) grown(box, ...corner);
    return key;
  });
  const rows = list.ids.map((id, i): Row => ({
    id,
    block: list.blocks[i]!,
    outcome: list.outcomes[i]!,
    reasons: [...new Set((list.reasons[id] ?? []).map((r) => said(r)))],
    parts: shapes[i]!.length,
    rmse: list.errors[i] === null ? null : Math.sqrt(list.errors[i]!),
    volume: list.volumes[i]!,
    confidence: list.edited[i]! ? null : (list.confidences[i] ?? null),
    edited: list.edited[i]!,
  }));
  return {
    rows,
    index: new Map(list.ids.map((id, i) => [id, i])),
    shapes,
    tileOf,
    tiles,
    reasons: new Map(Object.entries(list.reasons)),
    attributes: list.attributes,
    ...all,
    loaded: new Set(),
  };
}

/** The tiles within a distance of a point in plan, the nearest first, until they have enough buildings. */
export function tilesNear(large: Large, [x, y]: readonly number[], distance: number, most = mostWanted): string[] {
  const outside = (low: number, high: number, at: number) => Math.max(low - at, at - high, 0);
  const near = [...large.tiles].flatMap(([key, tile]) => {
    if (tile.low[0] > tile.high[0]) return [];
    const away = Math.hypot(outside(tile.low[0], tile.high[0], x!), outside(tile.low[1], tile.high[1], y!));
    const middle = Math.hypot((tile.low[0] + tile.high[0]) / 2 - x!, (tile.low[1] + tile.high[1]) / 2 - y!);
    return away <= distance ? [{ key, middle, count: tile.buildings.length }] : [];
  });
  near.sort((a, b) => a.middle - b.middle);
  const out: string[] = [];
  let count = 0;
  for (const tile of near) {
    count += tile.count;
    if (out.length && count > most) break;
    out.push(tile.key);
  }
  return out;
}

/** The tile of a building, then those around it. */
export function tilesAround(large: Large, building: string): string[] {
  const at = large.index.get(building);
  if (at === undefined) return [];
  const own = large.tileOf[at]!;
  const [column, row] = own.split("_").map(Number) as [number, number];
  const around = [-1, 0, 1].flatMap((i) => [-1, 0, 1].map((j) => `${column + i}_${row + j}`));
  return [own, ...around.filter((key) => key !== own && large.tiles.has(key))];
}
