// The models of a run: many buildings per buffer; changed buildings have their own buffers.
import * as THREE from "three";
import type { Building, RaisedBuilding } from "../api/types";
import type { Vector } from "./camera";
import { type Buffers, buffersOf, solidsOf } from "./geometry";
import { colours, fade, modelLook, modelMaterial } from "./materials";
import type { Colour } from "./styling";
import { ModelTextures } from "./textures";

const buildingsPerChunk = 48;
type Paint = [number, number, number, number]; // 0 … 255; the last: whether it is painted

interface Range {
  from: number; // numbers of the position attributes
  to: number;
  lineFrom: number;
  lineTo: number;
}

/** Unchanged buildings that share buffers. */
class Chunk {
  readonly ranges = new Map<string, Range>();
  constructor(
    readonly solid: THREE.Mesh,
    readonly lines: THREE.LineSegments,
  ) {}
  /** Hides a building: its triangles and lines become degenerate. */
  hide(id: string) {
    const range = this.ranges.get(id);
    if (!range) return;
    blank(this.solid.geometry, range.from, range.to);
    blank(this.lines.geometry, range.lineFrom, range.lineTo);
    this.ranges.delete(id);
  }
}

function blank(geometry: THREE.BufferGeometry, from: number, to: number) {
  const position = geometry.getAttribute("position") as THREE.BufferAttribute;
  (position.array as Float32Array).fill(0, from, to);
  position.addUpdateRange(from, to - from);
  position.needsUpdate = true;
}

/** A changed building. Its buffers grow when needed and are reused. */
class Loose {
  readonly solid: THREE.Mesh;
  readonly lines: THREE.LineSegments;
  constructor(
    readonly material: THREE.ShaderMaterial,
    lineMaterial: THREE.Material,
  ) {
    this.solid = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), lineMaterial);
    this.solid.frustumCulled = this.lines.frustumCulled = false;
  }
  set(buffers: Buffers) {
    put(this.solid.geometry, "position", buffers.positions, 3);
    put(this.solid.geometry, "normal", buffers.normals, 3);
    put(this.solid.geometry, "kind", buffers.kinds, 1);
    this.solid.geometry.setDrawRange(0, buffers.kinds.length);
    put(this.lines.geometry, "position", buffers.lines, 3);
    this.lines.geometry.setDrawRange(0, buffers.lines.length / 3);
  }
  paint(colour: Paint) {
    const count = (this.solid.geometry.getAttribute("position")?.count ?? 0) * 4;
    let attribute = this.solid.geometry.getAttribute("paint") as THREE.BufferAttribute | undefined;
    if (attribute?.array.length !== count) {
      if (attribute) this.solid.geometry.dispose();
      attribute = new THREE.BufferAttribute(new Uint8Array(count), 4, true);
      this.solid.geometry.setAttribute("paint", attribute);
    }
    for (let i = 0; i < count; i += 4) (attribute.array as Uint8Array).set(colour, i);
    attribute.needsUpdate = true;
  }
  dispose() {
    this.solid.removeFromParent();
    this.lines.removeFromParent();
    this.solid.geometry.dispose();
    this.lines.geometry.dispose();
    this.material.dispose();
  }
}

export function put(geometry: THREE.BufferGeometry, name: string, values: Float32Array, size: number) {
  const known = geometry.getAttribute(name) as THREE.BufferAttribute | undefined;
  if (known && known.array.length >= values.length) {
    (known.array as Float32Array).set(values);
    known.clearUpdateRanges();
    known.addUpdateRange(0, values.length);
    known.needsUpdate = true;
    return;
  }
  // three.js caches GPU buffers per geometry: they must be freed before an attribute gets longer.
  if (known) geometry.dispose();
  const grown = new Float32Array(Math.ceil((values.length * (known ? 1.5 : 1)) / size) * size);
  grown.set(values);
  geometry.setAttribute(name, new THREE.BufferAttribute(grown, size).setUsage(THREE.DynamicDrawUsage));
}

export class Output {
  readonly group = new THREE.Group();
  readonly look = modelLook();
  private readonly material = modelMaterial(this.look);
  private readonly lineMaterial = new THREE.LineBasicMaterial({ color: colours.line });
  private chunks: Chunk[] = [];
  private readonly loose = new Map<string, Loose>();
  private drawn = new Map<string, RaisedBuilding>(); // as it is in the buffers
  private given: ReadonlyMap<string, Building> | null = null;

  private paints: ReadonlyMap<string, Colour> | null = null;

  readonly textures: ModelTextures;

  constructor(
    private centre: Vector,
    loadTexture: (building: string) => Promise<ArrayBuffer>,
    arrived: () => void,
  ) {
    this.textures = new ModelTextures(centre, this.look, loadTexture, arrived);
    this.group.add(this.textures.group);
  }

  /** Colours buildings; null: by the class of their faces. */
  paint(colours: ReadonlyMap<string, Colour> | null) {
    if (colours === this.paints) return;
    this.paints = colours;
    for (const chunk of this.chunks) {
      const attribute = chunk.solid.geometry.getAttribute("paint") as THREE.BufferAttribute;
      for (const [id, { from, to }] of chunk.ranges) this.fill(attribute.array as Uint8Array, id, from / 3, to / 3);
      attribute.clearUpdateRanges();
      attribute.needsUpdate = true;
    }
    for (const [id, loose] of this.loose) loose.paint(this.paintOf(id));
  }
  private paintOf = (id: string): Paint => {
    const colour = this.paints?.get(id);
    return colour ? [...(colour.map((c) => Math.round(255 * c)) as [number, number, number]), 255] : [0, 0, 0, 0];
  };
  private fill(array: Uint8Array, id: string, from: number, to: number) {
    const paint = this.paintOf(id);
    for (let i = from; i < to; ++i) array.set(paint, 4 * i);
  }

  /** Draws these buildings, replaced by their drafts if they have one. Unchanged buildings keep their buffers. */
  set(buildings: ReadonlyMap<string, Building>, drafts: ReadonlyMap<string, RaisedBuilding>, invalid: boolean) {
    if (buildings !== this.given) {
      const gone = [...this.drawn.keys()].filter((id) => !buildings.has(id));
      if (gone.length === this.drawn.size) this.rebuild(buildings);
      else {
        for (const id of gone) this.forget(id);
        this.add([...buildings.values()].filter((b) => !this.drawn.has(b.id)));
      }
      for (const [id, building] of buildings) this.show(drafts.get(id) ?? building);
    } else {
      // During a drag only drafts change, and buildings that have their own buffers because of one.
      for (const id of this.loose.keys()) this.show(drafts.get(id) ?? buildings.get(id)!);
      for (const [id, building] of drafts) if (buildings.has(id)) this.show(building);
    }
    this.given = buildings;
    this.textures.set(buildings, drafts);
    for (const [id, loose] of this.loose) {
      const wrong = invalid && drafts.has(id);
      loose.material.uniforms.tint!.value.set(0.82, 0.12, 0.12, wrong ? 0.55 : 0);
    }
    if (this.loose.size > 60 && !drafts.size) this.rebuild(buildings);
  }

  /** Puts these buildings into another layer of three.js than all others. They have their own buffers. */
  apart(ids: { has(id: string): boolean }, layer: number) {
    for (const [id, loose] of this.loose) for (const o of [loose.solid, loose.lines]) o.layers.set(ids.has(id) ? layer : 0);
  }

  /** Draws one building in its new state. Only its own buffers change. */
  show(building: RaisedBuilding) {
    if (this.drawn.get(building.id) === building) return;
    this.drawn.set(building.id, building);
    for (const chunk of this.chunks) chunk.hide(building.id);
    let loose = this.loose.get(building.id);
    if (!loose) {
      loose = new Loose(modelMaterial(this.look), this.lineMaterial);
      loose.material.transparent = this.material.transparent;
      loose.material.depthWrite = this.material.depthWrite;
      loose.lines.visible = this.linesShown;
      this.loose.set(building.id, loose);
      this.group.add(loose.solid, loose.lines);
    }
    loose.set(buffersOf(solidsOf(building.parts), this.centre));
    loose.paint(this.paintOf(building.id));
  }

  fade(opacities: { walls: number; parties: number; roofs: number; outlines: number }) {
    const { walls, parties, roofs, outlines } = opacities;
    this.look.opacities.value = [walls, parties, roofs, walls, roofs];
    const least = Math.min(...[walls, parties, roofs].filter((o) => o > 0), 1);
    for (const material of [this.material, ...[...this.loose.values()].map((l) => l.material)]) fade(material, least);
    fade(this.lineMaterial, outlines);
    for (const { lines } of [...this.chunks, ...this.loose.values()]) lines.visible = outlines > 0;
    this.linesShown = outlines > 0;
  }
  private linesShown = true;

  /** Fades outlines when they get dense: `size` is the visible height of the image in metres. */
  seenFrom(size: number, outlines: number) {
    if (!this.linesShown) return;
    const fine = Math.round(Math.min(1, Math.max(0.15, 260 / size)) * 20) / 20; // in steps, so that materials change rarely
    if (this.lineMaterial.opacity !== fine * outlines) fade(this.lineMaterial, fine * outlines);
  }

  clear() {
    for (const { solid, lines } of this.chunks) {
      solid.geometry.dispose();
      lines.geometry.dispose();
      this.group.remove(solid, lines);
    }
    for (const loose of this.loose.values()) loose.dispose();
    this.chunks = [];
    this.loose.clear();
    this.drawn.clear();
    this.given = null;
  }

  dispose() {
    this.clear();
    this.textures.dispose();
    this.material.dispose();
    this.lineMaterial.dispose();
    this.look.errorMap.value?.dispose();
    this.group.removeFromParent();
  }

  private rebuild(buildings: ReadonlyMap<string, Building>) {
    this.clear();
    this.add([...buildings.values()]);
  }

  private add(all: Building[]) {
    for (let i = 0; i < all.length; i += buildingsPerChunk) {
      const chunk = this.chunk(all.slice(i, i + buildingsPerChunk));
      this.chunks.push(chunk);
      this.group.add(chunk.solid, chunk.lines);
    }
    for (const building of all) this.drawn.set(building.id, building);
  }

  private forget(id: string) {
    this.drawn.delete(id);
    this.loose.get(id)?.dispose();
    this.loose.delete(id);
    this.chunks = this.chunks.filter((chunk) => {
      if (!chunk.ranges.has(id)) return true;
      if (chunk.ranges.size > 1) {
        chunk.hide(id);
        return true;
      }
      chunk.solid.geometry.dispose();
      chunk.lines.geometry.dispose();
      this.group.remove(chunk.solid, chunk.lines);
      return false;
    });
  }

  private chunk(buildings: Building[]): Chunk {
    const pieces = buildings.map((b) => buffersOf(solidsOf(b.parts), this.centre));
    const joined = (of: (b: Buffers) => Float32Array) => {
      const whole = new Float32Array(pieces.reduce((sum, b) => sum + of(b).length, 0));
      let at = 0;
      for (const piece of pieces) {
        whole.set(of(piece), at);
        at += of(piece).length;
      }
      return whole;
    };
    const solid = new THREE.BufferGeometry();
    solid.setAttribute(
      "position",
      new THREE.BufferAttribute(
        joined((b) => b.positions),
        3,
      ),
    );
    solid.setAttribute(
      "normal",
      new THREE.BufferAttribute(
        joined((b) => b.normals),
        3,
      ),
    );
    solid.setAttribute(
      "kind",
      new THREE.BufferAttribute(
        joined((b) => b.kinds),
        1,
      ),
    );
    const paint = new Uint8Array((solid.getAttribute("position").count) * 4);
    solid.setAttribute("paint", new THREE.BufferAttribute(paint, 4, true));
    solid.computeBoundingSphere();
    const lines = new THREE.BufferGeometry();
    lines.setAttribute(
      "position",
      new THREE.BufferAttribute(
        joined((b) => b.lines),
        3,
      ),
    );
    lines.computeBoundingSphere();
    const chunk = new Chunk(new THREE.Mesh(solid, this.material), new THREE.LineSegments(lines, this.lineMaterial));
    chunk.lines.visible = this.linesShown;
    let [from, lineFrom] = [0, 0];
    buildings.forEach((building, i) => {
      const [to, lineTo] = [from + pieces[i]!.positions.length, lineFrom + pieces[i]!.lines.length];
      chunk.ranges.set(building.id, { from, to, lineFrom, lineTo });
      this.fill(paint, building.id, from / 3, to / 3);
      [from, lineFrom] = [to, lineTo];
    });
    return chunk;
  }
}
