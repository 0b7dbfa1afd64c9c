// Highlights: the selection, additionally selected parts, and the part under the pointer.
import * as THREE from "three";
import type { RaisedBuilding, RaisedPart } from "../api/types";
import type { Selection } from "../state";
import type { Vector } from "./camera";
import { buffersOf, reaches, ringOf, standing, upright } from "./geometry";
import type { Choices } from "./layers";
import { Segments, Sheet, WideLines } from "./lines";
import { colours } from "./materials";

/** Raw profiles across one edge, from the server. */
export interface RawClimbs {
  ring: number;
  edge: number;
  climbs: [number, number][][];
}

export class Highlight {
  readonly group = new THREE.Group();
  private readonly part = new Sheet(colours.accent, 0.16);
  private readonly outline = new WideLines(colours.accent, 2);
  private readonly edgeFaces = new Sheet(colours.accent, 0.42, -3);
  private readonly edge = new WideLines(colours.accent, 5);
  private readonly alsoSheet = new Sheet(0x9333a8, 0.3);
  private readonly alsoOutline = new WideLines(0x9333a8, 2);
  private readonly under = new Sheet(colours.accent, 0.12);
  private readonly clean = new WideLines(0x0b8074, 2.5, true);
  private readonly cleanEdge = new WideLines(0x06443e, 4, true);
  private readonly raw = new WideLines(0x2563eb, 1, true);

  constructor(private readonly centre: Vector) {
    this.group.add(...this.all.map((p) => p.object));
  }

  /** Profiles are drawn at close range only. */
  set detailed(value: boolean) {
    for (const lines of [this.clean, this.cleanEdge]) lines.opacity = value ? 1 : 0;
    this.raw.opacity = value ? 0.55 : 0;
  }

  select(at: Selection | null, building: RaisedBuilding | undefined, choices: Choices) {
    const parts = building?.parts.filter((p) => at?.part == null || p.id === at.part) ?? [];
    this.solid(parts, this.part, this.outline);
    const part = at?.part && at.edge !== null ? parts[0] : undefined;
    const ring = part && ringOf(part.plan, at!.ring);
    const faces = part?.geometry
      ? buffersOf([part.geometry], this.centre, (f) => f.ring === at!.ring && f.edge === at!.edge).positions
      : [];
    this.edgeFaces.set(faces);
    const foot = new Segments(this.centre);
    if (part && ring && at!.edge! < ring.points.length) {
      const [a, b] = [ring.points[at!.edge!]!, ring.points[(at!.edge! + 1) % ring.points.length]!];
      foot.add([...a, part.plan.base + 0.03], [...b, part.plan.base + 0.03]);
    }
    this.edge.set(foot);
    this.profiles(choices.clean.shown && at?.part ? parts[0] : undefined, at);
  }

  selectAlso(parts: RaisedPart[]) {
    this.solid(parts, this.alsoSheet, this.alsoOutline);
  }

  hover(part: RaisedPart | undefined) {
    this.under.set(part?.geometry ? buffersOf([part.geometry], this.centre).positions : []);
  }

  showRaw(part: RaisedPart | undefined, climbs: RawClimbs[]) {
    const lines = new Segments(this.centre);
    for (const { ring, edge, climbs: of } of part ? climbs : []) {
      // Raw profiles are distributed evenly along the edge.
      of.forEach((climb, i) =>
        lines.path(upright(part!.plan, ring, edge, (i + 0.5) / of.length, below(climb, part!.plan.cap + 6))),
      );
    }
    this.raw.set(lines);
  }

  dispose() {
    for (const part of this.all) part.dispose();
    this.group.removeFromParent();
  }

  private solid(parts: RaisedPart[], sheet: Sheet, outline: WideLines) {
    const geometries = parts.flatMap((p) => (p.geometry ? [p.geometry] : []));
    const { positions, lines } = buffersOf(geometries, this.centre);
    const rings = new Segments(this.centre);
    for (const { plan, geometry } of parts) {
      if (geometry) continue;
      for (const ring of [plan.outer, ...plan.holes]) rings.ring(ring.points, plan.base + 0.03);
    }
    sheet.set(positions);
    outline.set({ positions: [...lines, ...rings.positions] });
  }

  private profiles(part: RaisedPart | undefined, at: Selection | null) {
    const [usual, chosen] = [new Segments(this.centre), new Segments(this.centre)];
    if (part) {
      const { plan } = part;
      const reach = reaches(part);
      [plan.outer, ...plan.holes].forEach((ring, r) =>
        ring.profile_of_edge.forEach((profile, e) => {
          const is = at?.ring === r && at.edge === e;
          (is ? chosen : usual).path(standing({ ...plan, cap: reach(r, e) }, r, e, 0.5, plan.profiles[profile] ?? []));
        }),
      );
    }
    this.clean.set(usual);
    this.cleanEdge.set(chosen);
  }

  private get all() {
    const { part, outline, edgeFaces, edge, alsoSheet, alsoOutline, under, clean, cleanEdge, raw } = this;
    return [part, outline, edgeFaces, edge, alsoSheet, alsoOutline, under, clean, cleanEdge, raw];
  }
}

/** Without points far above the model, such as trees. */
const below = (climb: [number, number][], height: number) => climb.filter(([, h]) => h <= height);
