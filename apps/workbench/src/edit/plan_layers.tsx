// The layers of the plan editor.
import type { Plan, Point2, SceneFootprint, SweepEdgeLine } from "../api/types";
import * as state from "../state";
import { metres } from "./numbers";
import type { Neighbour } from "./neighbours";
import { before, cornerEdgesOf, edgesOf, endsOf, isCorner, profileOf, ringOf, ringsOf, sameEdge, wallsOf, type EdgeAt } from "./plan";
import { degreesOf, kindOf, pitchOf } from "./profile";
import { gripRadius, toPixels, type Sheet } from "./sheet";
import type { Guide } from "./snap";
import { bearingOf, turnedAt, type TurnedAt } from "./turned_roof";
import { cornerAt } from "./corner_edges";
import { cross, distance, middle, minus, plus, times, turnedLeft, unit } from "./vector";

/** A label at a position: a length or an angle. */
export interface Dimension {
  at: Point2;
  text: string;
}

/** What can be dragged; a roof structure also as a whole; a corner edge turns. */
export type Grip = "corner" | "edge" | "whole" | "turn";

/** The handlers of an edge, a corner or a whole part. */
export interface Grips {
  down(event: PointerEvent, kind: Grip, at: EdgeAt): void;
  doubleClick(event: MouseEvent, at: EdgeAt): void;
  key(event: KeyboardEvent, at: EdgeAt, kind: Grip): void;
  settle(): void;
}

export const ringPoints = (plan: Plan): Point2[][] => ringsOf(plan).map((r) => r.points);

const pathOf = (sheet: Sheet, rings: Point2[][]) =>
  rings.map((ring) => `M${ring.map((p) => pixelText(sheet, p, " ")).join("L")}Z`).join("");
const pixelText = (sheet: Sheet, p: Point2, between: string) =>
  toPixels(sheet, p)
    .map((v) => v.toFixed(1))
    .join(between);
const lineOf = (sheet: Sheet, a: Point2, b: Point2) => {
  const [x1, y1] = toPixels(sheet, a);
  const [x2, y2] = toPixels(sheet, b);
  return { x1, y1, x2, y2 };
};

function Label({ sheet, at, text, kind }: { sheet: Sheet; at: Point2; text: string; kind: string }) {
  const [x, y] = toPixels(sheet, at);
  return (
    <text class={kind} x={x} y={y}>
      {text}
    </text>
  );
}

export function Backdrop(props: {
  sheet: Sheet;
  building: string;
  neighbours: Neighbour[];
  footprint: SceneFootprint | undefined;
  sweepEdges: SweepEdgeLine[];
  onPick(neighbour: Neighbour): void;
  onAdd(neighbour: Neighbour): void;
}) {
  const { sheet, building, neighbours, footprint, sweepEdges, onPick, onAdd } = props;
  const kind = (n: Neighbour) => {
    if (n.building === building) return "sibling";
    return state.also.value.some((a) => a.building === n.building && a.part === n.part) ? "also" : "neighbour";
  };
  return (
    <>
      {neighbours.map((n) => (
        <path
          key={`${n.building} ${n.part}`}
          class={kind(n)}
          d={pathOf(sheet, ringPoints(n.plan))}
          onClick={(event) => event.shiftKey && onAdd(n)}
          onDblClick={() => onPick(n)}
        >
          <title>{`${n.part}: double-click to edit it, Shift and click to select it for merging`}</title>
        </path>
      ))}
      {footprint?.polygons.map((p, i) => <path key={i} class="footprint" d={pathOf(sheet, [p.outer, ...p.holes])} />)}
      {sweepEdges.map((s, i) => (
        <line key={i} class="sweep-edge" {...lineOf(sheet, s.from, s.to)} />
      ))}
    </>
  );
}

export function Edges(props: {
  sheet: Sheet;
  plan: Plan;
  hidden: ReadonlySet<number>; // rings that roof structures fill: they are moved with these
  whole: string | null; // what the part is called, if it can be moved as a whole
  selected: EdgeAt | null;
  chosen: EdgeAt[];
  labelled: boolean;
  grips: Grips;
}) {
  const { sheet, plan, hidden, whole, selected, chosen, labelled, grips } = props;
  const place: EdgeAt = { ring: 0, edge: 0 };
  return (
    <>
      <path
        class={`part${whole ? " movable" : ""}`}
        d={pathOf(sheet, ringPoints(plan))}
        onPointerDown={(event) => whole && grips.down(event, "whole", place)}
      />
      {wallsOf(plan).filter((at) => !hidden.has(at.ring)).map((at) => {
        const [a, b] = endsOf(plan, at)!;
        const { kind, said, seen } = wordsOf(plan, at);
        const inwards = turnedLeft(unit(minus(b, a)) ?? [1, 0]);
        const [x, y] = toPixels(sheet, middle(a, b));
        const isSelected = selected !== null && sameEdge(selected, at);
        const isChosen = chosen.some((c) => sameEdge(c, at));
        const classes = `edge ${kind}${isSelected ? " selected" : ""}${isChosen ? " chosen" : ""}`;
        return (
          <g key={`${at.ring} ${at.edge}`} class={classes}>
            <line class="seen" {...lineOf(sheet, a, b)} />
            <line
              class="grip"
              {...lineOf(sheet, a, b)}
              tabindex={0}
              role="button"
              aria-pressed={isSelected}
              aria-label={`edge ${at.edge}${inHole(at)}, ${distance(a, b).toFixed(2)} metres, ${said}`}
              onPointerDown={(event) => grips.down(event, "edge", at)}
              onDblClick={(event) => grips.doubleClick(event, at)}
              onKeyDown={(event) => grips.key(event, at, "edge")}
              onKeyUp={grips.settle}
              onBlur={grips.settle}
            />
            {labelled && distance(a, b) * sheet.scale > 34 && (
              <text class="pitch" x={x + inwards[0] * 14} y={y - inwards[1] * 14}>
                {seen}
              </text>
            )}
          </g>
        );
      })}
      {whole && <Whole sheet={sheet} plan={plan} name={whole} grips={grips} place={place} />}
    </>
  );
}

/** What the profile of an edge is, for the drawing and for screen readers. */
function wordsOf(plan: Plan, at: EdgeAt) {
  const profile = profileOf(plan, at) ?? [];
  const kind = kindOf(profile);
  const pitch = kind === "pitched" ? degreesOf(pitchOf(profile)!) : 0;
  const said = { pitched: `pitch ${pitch.toFixed(0)} degrees`, wall: "wall up to the cap", terrace: "terrace" }[kind];
  const seen = { pitched: `${pitch.toFixed(0)}°`, wall: "wall", terrace: "flat" }[kind];
  return { kind, said, seen };
}

/** Pixels from its corner to the ends of the line of a corner edge. */
const arm = 44;

/** The end of the line that is further from the walls beside it: there its handle is. */
export const isForward = (t: TurnedAt) => cross(t.along, t.after) > cross(t.before, t.along);

/** Corner edges: a line through the corner in the direction of the eaves, with a handle that turns it. */
export function CornerEdges(props: {
  sheet: Sheet;
  plan: Plan;
  hidden: ReadonlySet<number>;
  selected: EdgeAt | null;
  chosen: EdgeAt[];
  held: { at: EdgeAt; forward: boolean } | null; // the one that is dragged: its handle stays at the same end
  labelled: boolean;
  grips: Grips;
}) {
  const { sheet, plan, hidden, selected, chosen, held, labelled, grips } = props;
  return (
    <>
      {cornerEdgesOf(plan).filter((at) => !hidden.has(at.ring)).map((at) => {
        const turned = turnedAt(plan, at);
        if (!turned) return null;
        const { corner, along } = turned;
        const { kind, said, seen } = wordsOf(plan, at);
        const forward = held && sameEdge(held.at, at) ? held.forward : isForward(turned);
        const reach = times(along, (forward ? arm : -arm) / sheet.scale);
        const [handle, end] = [plus(corner, reach), minus(corner, reach)];
        const [cx, cy] = toPixels(sheet, handle);
        const [x, y] = toPixels(sheet, plus(corner, times(reach, 1.4)));
        const isSelected = selected !== null && sameEdge(selected, at);
        const isChosen = chosen.some((c) => sameEdge(c, at));
        const bearing = bearingOf(along);
        const direction = `direction ${bearing.toFixed(1)} degrees`;
        const grip = (event: PointerEvent) => grips.down(event, "turn", at);
        return (
          <g
            key={`${at.ring} ${at.edge}`}
            class={`edge turned ${kind}${isSelected ? " selected" : ""}${isChosen ? " chosen" : ""}`}
          >
            <line class="seen" {...lineOf(sheet, end, handle)} />
            <line
              class="grip"
              {...lineOf(sheet, end, handle)}
              tabindex={0}
              role="button"
              aria-pressed={isSelected}
              aria-label={`corner edge ${at.edge}${inHole(at)}, ${direction}, ${said}`}
              onPointerDown={grip}
              onKeyDown={(event) => grips.key(event, at, "turn")}
              onKeyUp={grips.settle}
              onBlur={grips.settle}
            >
              <title>Direction of the eaves of a roof plane: drag it to turn the plane</title>
            </line>
            <circle class="seen" cx={cx} cy={cy} r={5} />
            <circle
              class="grip"
              cx={cx}
              cy={cy}
              r={10}
              tabindex={0}
              role="slider"
              aria-label={`Direction of corner edge ${at.edge}${inHole(at)}, degrees`}
              aria-valuenow={Number(bearing.toFixed(2))}
              aria-valuetext={`${bearing.toFixed(1)} degrees`}
              onPointerDown={grip}
              onKeyDown={(event) => grips.key(event, at, "turn")}
              onKeyUp={grips.settle}
              onBlur={grips.settle}
            >
              <title>Drag it to turn the roof plane. Arrow keys turn it by 0.5°</title>
            </circle>
            {labelled && (
              <text class="pitch" x={x} y={y}>
                {seen}
              </text>
            )}
          </g>
        );
      })}
    </>
  );
}

/** The handle that moves a roof structure. */
function Whole(props: { sheet: Sheet; plan: Plan; name: string; grips: Grips; place: EdgeAt }) {
  const { sheet, plan, name, grips, place } = props;
  const { points } = plan.outer;
  const sum = points.reduce((a, b): Point2 => [a[0] + b[0], a[1] + b[1]], [0, 0] as Point2);
  const [x, y] = toPixels(sheet, [sum[0] / points.length, sum[1] / points.length]);
  return (
    <g class="whole" transform={`translate(${x} ${y})`}>
      <circle
        class="grip"
        r={12}
        tabindex={0}
        role="button"
        aria-label={`${name}: move it as a whole. Delete removes it`}
        onPointerDown={(event) => grips.down(event, "whole", place)}
        onKeyDown={(event) => grips.key(event, place, "whole")}
        onKeyUp={grips.settle}
        onBlur={grips.settle}
      />
      <path class="seen" d="M-8 0H8M0 -8V8M-5 -3L-8 0L-5 3M5 -3L8 0L5 3M-3 -5L0 -8L3 -5M-3 5L0 8L3 5" />
    </g>
  );
}

export function Corners(props: {
  sheet: Sheet;
  plan: Plan;
  hidden: ReadonlySet<number>;
  selected: EdgeAt | null;
  onFocus(at: EdgeAt): void;
  grips: Grips;
}) {
  const { sheet, plan, hidden, selected, onFocus, grips } = props;
  const corners = edgesOf(plan).flatMap((at) => {
    const ring = ringOf(plan, at.ring)!;
    // Both ends of a corner edge are one corner.
    if (hidden.has(at.ring) || isCorner(plan, { ring: at.ring, edge: before(ring, at.edge) })) return [];
    const p = isCorner(plan, at) ? cornerAt(ring, at.edge) : ring.points[at.edge]!;
    return [{ at, p, place: toPixels(sheet, p) }];
  });
  const places = corners.map((c) => c.place);
  return (
    <>
      {corners.map(({ at, p, place: [cx, cy] }) => {
        const isSelected = selected !== null && sameEdge(selected, at);
        return (
          <g key={`${at.ring} ${at.edge}`} class={`corner${isSelected ? " selected" : ""}`}>
            <circle class="seen" cx={cx} cy={cy} r={4} />
            <circle
              class="grip"
              cx={cx}
              cy={cy}
              r={gripRadius([cx, cy], places, 9)}
              tabindex={0}
              role="button"
              aria-label={`corner ${at.edge}${inHole(at)} at ${p[0].toFixed(2)}, ${p[1].toFixed(2)}`}
              onPointerDown={(event) => grips.down(event, "corner", at)}
              onFocus={() => onFocus(at)}
              onKeyDown={(event) => grips.key(event, at, "corner")}
              onKeyUp={grips.settle}
              onBlur={grips.settle}
            />
          </g>
        );
      })}
    </>
  );
}

const inHole = (at: EdgeAt) => (at.ring > 0 ? ` of hole ${at.ring}` : "");

/** The line that is being drawn, its length, and what it snaps to. */
export function Marks(props: {
  sheet: Sheet;
  guides: Guide[];
  dimensions: Dimension[];
  drawn: Point2[];
  closed: boolean;
}) {
  const { sheet, guides, dimensions, drawn, closed } = props;
  const last = drawn.length > 1 ? ([drawn.at(-2)!, drawn.at(-1)!] as const) : null;
  return (
    <>
      {guides.map((g, i) => (
        <g key={i} class="guide">
          <line {...lineOf(sheet, g.from, g.to)} />
          <Label sheet={sheet} at={g.from} text={g.words} kind="guide-words" />
        </g>
      ))}
      {drawn.length > 0 && (
        <g class="drawn">
          <polyline class={closed ? "hole" : "split"} points={drawn.map((p) => pixelText(sheet, p, ",")).join(" ")} />
          {drawn.map((p, i) => {
            const [cx, cy] = toPixels(sheet, p);
            return <circle key={i} cx={cx} cy={cy} r={3} />;
          })}
          {last && distance(...last) > 0 && (
            <Label sheet={sheet} at={middle(...last)} text={metres(distance(...last))} kind="dimension" />
          )}
        </g>
      )}
      {dimensions.map((d, i) => (
        <Label key={i} sheet={sheet} at={d.at} text={d.text} kind="dimension" />
      ))}
    </>
  );
}

/** The scale bar at the lower left. */
export function ScaleBar({ sheet, length }: { sheet: Sheet; length: number }) {
  const long = length * sheet.scale;
  return (
    <g class="scale" transform={`translate(10 ${sheet.height - 10})`}>
      <path d={`M0 -4V0H${long}V-4`} />
      <text x={long + 5} y={1}>
        {length} m
      </text>
    </g>
  );
}
