import type { ProfilePoint, Section } from "../api/types";
import { metres } from "./numbers";
import { ruling, toMetres, toPixels, type Sheet } from "./sheet";

export const pixelsOf = (sheet: Sheet, points: ProfilePoint[]) =>
  points
    .map((p) =>
      toPixels(sheet, p)
        .map((v) => v.toFixed(1))
        .join(","),
    )
    .join(" ");
export const lineOf = (sheet: Sheet, a: ProfilePoint, b: ProfilePoint) => {
  const [x1, y1] = toPixels(sheet, a);
  const [x2, y2] = toPixels(sheet, b);
  return { x1, y1, x2, y2 };
};

/** The background of the profile editor: ruler, raw profiles, section of the mesh, profile before the change, ridge height. */
export function Backdrop(props: {
  sheet: Sheet;
  section: Section | null;
  ghost: ProfilePoint[] | null;
  ridge: number | null;
}) {
  const { sheet, section, ghost, ridge } = props;
  const [left] = toMetres(sheet, [0, 0]);
  const [right] = toMetres(sheet, [sheet.width, 0]);
  const slice = (section?.pieces ?? []).map(([a, b]) => `M${pixelsOf(sheet, [a])}L${pixelsOf(sheet, [b])}`).join("");
  return (
    <>
      <Ruler sheet={sheet} />
      <g class="climbs">{section?.climbs.map((climb, i) => <polyline key={i} points={pixelsOf(sheet, climb)} />)}</g>
      <path class="slice" d={slice} />
      {section === null && (
        <text class="note" x={sheet.width / 2} y={16}>
          no section of the mesh
        </text>
      )}
      {ghost && <polyline class="ghost" points={pixelsOf(sheet, ghost)} />}
      {ridge !== null && (
        <g class="ridge">
          <line {...lineOf(sheet, [left, ridge], [right, ridge])} />
          <text x={sheet.width - 50} y={toPixels(sheet, [0, ridge])[1] + 12}>
            ridge {metres(ridge)}
          </text>
        </g>
      )}
    </>
  );
}

function Ruler({ sheet }: { sheet: Sheet }) {
  if (sheet.width === 0) return null;
  const [left, high] = toMetres(sheet, [0, 0]);
  const [right, low] = toMetres(sheet, [sheet.width, sheet.height]);
  const every = ruling(sheet.scale, 36);
  const ticks = (from: number, to: number) => {
    const first = Math.ceil(from / every);
    return Array.from({ length: Math.max(0, Math.floor(to / every) - first + 1) }, (_, i) => (first + i) * every);
  };
  const text = (v: number) => String(Math.round(v * 1000) / 1000).replace("-", "−");
  return (
    <g class="ruler">
      {ticks(left, right).map((v) => (
        <g key={`in ${v}`}>
          <line class={v === 0 ? "axis" : ""} {...lineOf(sheet, [v, low], [v, high])} />
          <text x={toPixels(sheet, [v, 0])[0]} y={sheet.height - 4} class="along">
            {text(v)}
          </text>
        </g>
      ))}
      {ticks(low, high).map((v) => (
        <g key={`up ${v}`}>
          <line class={v === 0 ? "axis" : ""} {...lineOf(sheet, [left, v], [right, v])} />
          <text x={4} y={toPixels(sheet, [0, v])[1] - 3}>
            {text(v)}
          </text>
        </g>
      ))}
    </g>
  );
}
