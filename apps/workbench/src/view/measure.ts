// Measuring in the view: distances, heights, angles and areas between points on models, scan and ground.
import { signal } from "@preact/signals";
import { fixed } from "../panels/words";
import type { Vector } from "./camera";

export type Tool = "distance" | "height" | "angle" | "area";
export const tools: { tool: Tool; name: string; hint: string; most: number }[] = [
  { tool: "distance", name: "Distance", hint: "Click two points or more", most: Infinity },
  { tool: "height", name: "Height", hint: "Click two points", most: 2 },
  { tool: "angle", name: "Angle", hint: "Click three points: the angle is at the second", most: 3 },
  { tool: "area", name: "Area", hint: "Click the corners of a surface, three or more", most: Infinity },
];

/** The tool in use, and its points in the frame of the scene. */
export const measuring = signal<Tool | null>(null);
export const points = signal<Vector[]>([]);

export function measure(tool: Tool | null) {
  measuring.value = tool;
  points.value = [];
}
/** After the last point of a tool, the next click begins again. */
export function addPoint(p: Vector) {
  const most = tools.find((t) => t.tool === measuring.value)?.most ?? 0;
  points.value = points.value.length >= most ? [p] : [...points.value, p];
}
export const removePoint = () => (points.value = points.value.slice(0, -1));

const minus = (a: Vector, b: Vector) => a.map((x, i) => x - b[i]!) as Vector;
const dot = (a: Vector, b: Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Sum of the lengths of the segments. */
export const lengthOf = (line: readonly Vector[]) =>
  line.slice(1).reduce((sum, p, i) => sum + Math.hypot(...minus(p, line[i]!)), 0);
const flatLengthOf = (line: readonly Vector[]) => lengthOf(line.map(([x, y]) => [x, y, 0]));

/** Twice the area as a vector along the normal (Newell). */
function areaVector(ring: readonly Vector[]): Vector {
  const sum: Vector = [0, 0, 0];
  const start = ring[0]!;
  for (let i = 1; i + 1 < ring.length; ++i) {
    const [a, b] = [minus(ring[i]!, start), minus(ring[i + 1]!, start)];
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}
/** Of the ring in its mean plane; for points in one plane, its area. */
export const areaOf = (ring: readonly Vector[]) => Math.hypot(...areaVector(ring)) / 2;
const planAreaOf = (ring: readonly Vector[]) => Math.abs(areaVector(ring)[2]) / 2;

/** In degrees, at the second of three points. */
export function angleOf(a: Vector, b: Vector, c: Vector): number {
  const [u, v] = [minus(a, b), minus(c, b)];
  const length = Math.hypot(...u) * Math.hypot(...v);
  return length > 0 ? (Math.acos(Math.min(1, Math.max(-1, dot(u, v) / length))) * 180) / Math.PI : 0;
}

/** The results as names and texts; none while there are too few points. */
export function results(tool: Tool, at: readonly Vector[]): [name: string, value: string][] {
  const m = (x: number) => `${fixed(x, 2)} m`;
  const [a, b, c] = at as [Vector?, Vector?, Vector?];
  if (tool === "distance" && at.length > 1) {
    const rows: [string, string][] = [
      ["Distance", m(lengthOf(at))],
      ["In plan", m(flatLengthOf(at))],
    ];
    if (at.length === 2) rows.push(["Height difference", m(b![2] - a![2])]);
    return rows;
  }
  if (tool === "height" && a && b) {
    const flat = flatLengthOf([a, b]);
    const rise = b[2] - a[2];
    return [
      ["Height difference", m(rise)],
      ["In plan", m(flat)],
      ["Slope", `${fixed((Math.atan2(Math.abs(rise), flat) * 180) / Math.PI, 1)}°`],
    ];
  }
  if (tool === "angle" && a && b && c) return [["Angle", `${fixed(angleOf(a, b, c), 1)}°`]];
  if (tool === "area" && at.length > 2)
    return [
      ["Area", `${fixed(areaOf(at), 2)} m²`],
      ["In plan", `${fixed(planAreaOf(at), 2)} m²`],
      ["Perimeter", m(lengthOf([...at, at[0]!]))],
    ];
  return [];
}
