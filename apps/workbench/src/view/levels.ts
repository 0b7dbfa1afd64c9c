// Chooses the tiles to draw and to fetch: coarse ones far away, fine ones nearby, within a budget of triangles.
import type { TileInfo } from "../api/types";

export interface Eye {
  position: [number, number, number]; // in the tiles' frame
  pixels: number; // per radian at the centre of the image
  sees: (tile: TileInfo) => boolean;
}
export interface Choice {
  draw: TileInfo[];
  fetch: TileInfo[]; // the most important first
}

/** Maximum error of level n in metres: the size of the cells in which vertices were merged. */
export const errorOf = (level: number) => (level === 0 ? 0 : 0.25 * 2 ** (level - 1));

const usualTolerance = 1.5; // pixels
const [fewest, most] = [300_000, 3_000_000];

/** Maximum number of triangles per image: decreased when images take long, increased when they do not. */
export class Budget {
  triangles = 1_500_000;
  private mean = 25;

  /** Milliseconds between two images while the camera moves. */
  took(ms: number) {
    this.mean += (ms - this.mean) / 8; // averaged over several images
    if (this.mean > 40) this.triangles *= 0.92;
    else if (this.mean < 22) this.triangles *= 1.04;
    this.triangles = Math.min(most, Math.max(fewest, this.triangles));
  }
}

const key = (level: number, column: number, row: number) => `${level}/${column}/${row}`;

export class Levels {
  readonly roots: TileInfo[];
  private readonly children = new Map<string, TileInfo[]>();

  constructor(tiles: TileInfo[]) {
    const all = new Set(tiles.map((t) => t.id));
    const at = new Map(tiles.map((t) => [key(t.level, t.column, t.row), t]));
    this.roots = [];
    for (const tile of tiles) {
      const above = at.get(key(tile.level + 1, tile.column >> 1, tile.row >> 1));
      if (!above || !all.has(above.id)) this.roots.push(tile);
      else this.children.set(above.id, [...(this.children.get(above.id) ?? []), tile]);
    }
  }

  /** Replaces the tile with the largest visible error by its children, as long as they are loaded and fit the budget. */
  choose(eye: Eye, has: (id: string) => boolean, budget: number, tolerance = usualTolerance): Choice {
    const wanted: { tile: TileInfo; looks: number }[] = [];
    const draw: TileInfo[] = [];
    const visible = this.roots.filter(eye.sees).map((tile) => ({ tile, looks: this.looks(tile, eye) }));
    let triangles = visible.reduce((sum, { tile }) => sum + tile.triangles, 0);
    let planned = triangles; // with tiles that are still being loaded
    const heap = visible;
    for (const entry of visible) if (!has(entry.tile.id)) wanted.push({ ...entry, looks: Infinity });
    while (heap.length) {
      heap.sort((a, b) => a.looks - b.looks || (a.tile.id < b.tile.id ? 1 : -1));
      const { tile, looks } = heap.pop()!;
      const finer = (this.children.get(tile.id) ?? []).filter(eye.sees);
      const more = finer.reduce((sum, t) => sum + t.triangles, 0) - tile.triangles;
      if (looks <= tolerance || !this.children.has(tile.id) || planned + more > budget) {
        if (has(tile.id)) draw.push(tile);
        continue;
      }
      planned += more;
      const missing = finer.filter((t) => !has(t.id));
      for (const t of missing) wanted.push({ tile: t, looks });
      if (missing.length && has(tile.id)) {
        draw.push(tile);
        continue;
      }
      triangles += more;
      for (const t of finer) heap.push({ tile: t, looks: this.looks(t, eye) });
    }
    wanted.sort((a, b) => b.looks - a.looks || (a.tile.id < b.tile.id ? -1 : 1));
    return { draw, fetch: wanted.map((w) => w.tile) };
  }

  /** Error of the tile in pixels. */
  private looks(tile: TileInfo, eye: Eye): number {
    const away = Math.hypot(...eye.position.map((p, i) => Math.max(tile.low[i]! - p, 0, p - tile.high[i]!)));
    return (errorOf(tile.level) * eye.pixels) / Math.max(away, 0.1);
  }
}
