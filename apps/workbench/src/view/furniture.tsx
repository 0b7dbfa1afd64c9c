// North arrow and scale bar, and whose the basemap is.
import * as state from "../state";
import { choices } from "./layers";

/** The length of the bar: 1, 2 or 5 times a power of ten, at most `most` pixels wide. */
export function barOf(metresPerPixel: number, most: number): { metres: number; pixels: number } {
  const widest = metresPerPixel * most;
  const power = 10 ** Math.floor(Math.log10(widest));
  const metres = [5, 2, 1].map((m) => m * power).find((m) => m <= widest) ?? power;
  return { metres, pixels: metres / metresPerPixel };
}
const name = (metres: number) =>
  metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m` : `${Math.round(metres * 100)} cm`;

export function Furniture() {
  const seen = state.compass.value;
  if (!seen || !(seen.metresPerPixel > 0)) return null;
  const { metres, pixels } = barOf(seen.metresPerPixel, 110);
  return (
    <div class="furniture">
      <svg viewBox="-12 -12 24 24" width="30" height="30" role="img" aria-label="North arrow">
        <g transform={`rotate(${(-seen.azimuth * 180) / Math.PI})`}>
          <path d="M0-10 5 8 0 4.5-5 8Z" class="needle" />
        </g>
      </svg>
      <div class="scale-bar" role="img" aria-label={`Scale bar: ${name(metres)} at the centre of the view`}>
        <span>{name(metres)}</span>
        <i style={{ width: `${pixels}px` }} />
      </div>
    </div>
  );
}

/** What the licence of the basemap asks for, while it is shown. */
export function attribution(): string {
  const there = choices.value.basemap.shown && state.basemaps.value.has(state.run.value?.id ?? "");
  return there ? (state.project.value?.basemap_attribution ?? "") : "";
}

export function Attribution() {
  const text = attribution();
  return text ? <p class="attribution">{text}</p> : null;
}
