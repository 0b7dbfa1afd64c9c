// The layers of the segmentation: sweep-edges, faces of the partition, and the costs of its edges.
import * as THREE from "three";
import type { FractureEdge, Layers } from "../api/types";
import type { Vector } from "./camera";
import { Segments, Sheet, WideLines, flat } from "./lines";
import type { Choices } from "./layers";

/** −1: joining costs much less; 1: cutting costs much less. */
export function leaning({ cost_cut, cost_uncut }: Pick<FractureEdge, "cost_cut" | "cost_uncut">): number {
  const sum = Math.abs(cost_cut) + Math.abs(cost_uncut);
  return sum > 0 ? (cost_uncut - cost_cut) / sum : 0;
}

const cheapCut = new THREE.Color(0xd9480f);
const even = new THREE.Color(0x9a9aa4);
const cheapJoin = new THREE.Color(0x1c5fb8);
export const leaningColour = (t: number) => even.clone().lerp(t > 0 ? cheapCut : cheapJoin, Math.min(1, Math.abs(t)));

/** Consecutive numbers have clearly different colours. */
export const partColour = (part: number) => new THREE.Color().setHSL((part * 0.381966 + 0.09) % 1, 0.45, 0.58);

/** Height at which the partition of each block is drawn: 3 m above its highest face. */
export function sheetHeights(layers: Layers, otherwise: number): Map<string, number> {
  const heights = new Map<string, number>();
  for (const { block, height } of layers.faces) {
    heights.set(block, Math.max(heights.get(block) ?? -Infinity, height ?? -Infinity));
  }
  for (const [block, height] of heights) heights.set(block, (Number.isFinite(height) ? height : otherwise) + 3);
  return heights;
}

export class SegmentationLayers {
  readonly group = new THREE.Group();
  private readonly sweep = new WideLines(0x7d3fb4, 1.5);
  private readonly sweepSheet = new Sheet(0x7d3fb4, 0.22);
  private readonly faces = new Sheet(0xffffff, 0.75);
  private readonly joined = new WideLines(0x9a9aa4, 1.2);
  private readonly cut = new WideLines(0xd9480f, 3.2);

  constructor(layers: Layers, centre: Vector, otherwise: number) {
    const heights = sheetHeights(layers, otherwise);
    const heightOf = (block: string) => heights.get(block) ?? otherwise;

    const sweep = new Segments(centre);
    const upright: number[] = [];
    for (const { from, to, low, high } of layers.sweep_edges) {
      const corners = [
        [...from, low],
        [...to, low],
        [...to, high],
        [...from, high],
      ] as Vector[];
      corners.forEach((corner, i) => sweep.add(corner, corners[(i + 1) % 4]!));
      for (const i of [0, 1, 2, 0, 2, 3]) for (let k = 0; k < 3; ++k) upright.push(corners[i]![k]! - centre[k]!);
    }
    this.sweep.set(sweep);
    this.sweepSheet.set(upright);

    const ground: number[] = [];
    const tints: number[] = [];
    const outside = new THREE.Color(0xe4e4e2);
    for (const face of layers.faces) {
      if (!face.inside) continue;
      const triangles = flat(face.outer, face.holes, heightOf(face.block), centre);
      const colour = face.part === null ? outside : partColour(face.part);
      for (let i = 0; i < triangles.length; i += 3) tints.push(colour.r, colour.g, colour.b);
      for (const x of triangles) ground.push(x);
    }
    this.faces.set(ground, tints);

    const [cut, joined] = [new Segments(centre), new Segments(centre)];
    for (const edge of layers.edges) {
      const z = heightOf(edge.block) + 0.05;
      const colour = leaningColour(leaning(edge));
      for (const line of edge.lines)
        (edge.chosen ? cut : joined).path(
          line.map(([x, y]) => [x, y, z]),
          colour,
        );
    }
    this.cut.set(cut);
    this.joined.set(joined);
    this.group.add(...this.parts.map((p) => p.object));
  }

  show({ sweep, faces, cuts }: Choices) {
    this.sweep.opacity = this.sweepSheet.opacity = sweep.shown ? sweep.opacity : 0;
    this.faces.opacity = faces.shown ? faces.opacity : 0;
    this.cut.opacity = this.joined.opacity = cuts.shown ? cuts.opacity : 0;
  }

  dispose() {
    for (const part of this.parts) part.dispose();
    this.group.removeFromParent();
  }
  private get parts() {
    return [this.sweep, this.sweepSheet, this.faces, this.joined, this.cut];
  }
}
