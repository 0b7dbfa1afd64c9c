// The error maps of all blocks of a run, combined in one texture.
import * as THREE from "three";
import type { LoadedMap } from "../state";

export interface Combined {
  columns: number;
  rows: number;
  cell: number; // m
  low: [number, number]; // outer corner of the cell (0, 0)
  cells: Uint16Array<ArrayBuffer>; // half floats
}

const none = THREE.DataUtils.toHalfFloat(20_000);

/** Combines maps on the finest of their grids, or on a multiple of it that has at most `most` cells per side. */
export function combine(maps: readonly LoadedMap[], most = 4096): Combined | null {
  const used = maps.filter((m) => m.columns > 0 && m.rows > 0);
  if (!used.length) return null;
  const low: [number, number] = [0, 1].map((i) => Math.min(...used.map((m) => m.origin[i]! - m.grid / 2))) as [
    number,
    number,
  ];
  const high = [
    Math.max(...used.map((m) => m.origin[0] + (m.columns - 0.5) * m.grid)),
    Math.max(...used.map((m) => m.origin[1] + (m.rows - 0.5) * m.grid)),
  ];
  const fine = Math.min(...used.map((m) => m.grid));
  const extent = Math.max(high[0]! - low[0], high[1]! - low[1]);
  const cell = fine * Math.max(1, Math.ceil(extent / fine / most));
  const columns = Math.max(1, Math.ceil((high[0]! - low[0]) / cell - 1e-6));
  const rows = Math.max(1, Math.ceil((high[1]! - low[1]) / cell - 1e-6));
  const sums = new Float32Array(columns * rows);
  const counts = new Uint16Array(columns * rows);
  for (const map of used) {
    for (let row = 0; row < map.rows; ++row) {
      const y = Math.floor((map.origin[1] + row * map.grid - low[1]) / cell);
      for (let column = 0; column < map.columns; ++column) {
        const error = map.cells[row * map.columns + column]!;
        if (Number.isNaN(error)) continue;
        const x = Math.floor((map.origin[0] + column * map.grid - low[0]) / cell);
        const at = Math.min(y, rows - 1) * columns + Math.min(x, columns - 1);
        sums[at] = sums[at]! + error;
        counts[at] = counts[at]! + 1;
      }
    }
  }
  const cells = new Uint16Array(columns * rows);
  cells.forEach((_, i) => (cells[i] = counts[i] ? THREE.DataUtils.toHalfFloat(clamp(sums[i]! / counts[i]!)) : none));
  return { columns, rows, cell, low, cells };
}

const clamp = (x: number) => Math.max(-1000, Math.min(1000, x)); // far below the value for "none"

export function textureOf(map: Combined): THREE.DataTexture {
  const texture = new THREE.DataTexture(map.cells, map.columns, map.rows, THREE.RedFormat, THREE.HalfFloatType);
  texture.magFilter = texture.minFilter = THREE.NearestFilter;
  texture.unpackAlignment = 2;
  texture.needsUpdate = true;
  return texture;
}
