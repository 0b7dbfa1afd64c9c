// The profiles of a block or a run (Figure 10 of the paper), its histogram of errors, and its totals.
import { computed, signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { needErrorMaps } from "../actions";
import * as state from "../state";
import { rowOf } from "./table";
import { type Cluster, clusters, edgeProfiles, histogram, ticks } from "./plots";
import { count, fixed, grouped, seconds, signed } from "./words";

const block = signal(""); // "": all
const clustered = signal(true);
const limit = 2; // m

const blocks = computed(() =>
  [...new Set([...(state.run.value?.buildings.values() ?? [])].map((b) => b.block))].sort(),
);
const within = computed(() => (blocks.value.includes(block.value) ? block.value : ""));
const buildings = computed(() =>
  [...(state.run.value?.buildings.values() ?? [])].filter((b) => !within.value || b.block === within.value),
);
const profiles = computed(() => edgeProfiles(buildings.value));
const drawn = computed((): Cluster[] =>
  clustered.value ? clusters(profiles.value) : profiles.value.slice(0, 4000).map((p) => ({ ...p, edges: 1 })),
);
const errors = computed(() => {
  const maps = state.errorMaps.value.get(state.run.value?.id ?? "");
  return (
    maps &&
    histogram(
      maps.filter((m) => !within.value || m.block === within.value),
      limit,
    )
  );
});

export function PlotsPanel() {
  const run = state.run.value;
  const measured = state.hasMaps(run);
  useEffect(() => {
    if (run && measured) void needErrorMaps(run.id);
  }, [run?.id, measured]);
  if (!run) return <p class="quiet pad">No run is open.</p>;
  return (
    <div class="panel">
      <label class="field row">
        Scope
        <select value={within.value} onChange={(e) => (block.value = e.currentTarget.value)}>
          <option value="">whole run</option>
          {blocks.value.map((b) => (
            <option key={b}>{b}</option>
          ))}
        </select>
      </label>
      <section class="card">
        <h2>Characteristic profiles</h2>
        <Profiles />
      </section>
      <section class="card">
        <h2>Vertical error</h2>
        <Errors />
      </section>
      <section class="card">
        <h2>Totals</h2>
        <Totals />
      </section>
    </div>
  );
}

const box = { left: 34, right: 392, top: 8, bottom: 236 };

function Profiles() {
  const lines = drawn.value;
  const total = profiles.value.reduce((sum, p) => sum + p.length, 0);
  const inward = Math.max(2, ...lines.map((l) => Math.max(...l.points.map(([x]) => x))));
  const outward = Math.min(0, ...lines.map((l) => Math.min(...l.points.map(([x]) => x))));
  const high = Math.max(2, ...lines.map((l) => l.points.at(-1)?.[1] ?? 0));
  // Both axes have the same scale, so that slopes are true.
  const scale = Math.min((box.right - box.left) / (inward - outward), (box.bottom - box.top) / high);
  const x = (m: number) => box.left + (m - outward) * scale;
  const y = (m: number) => box.bottom - m * scale;
  const most = Math.max(...lines.map((l) => l.length), 1);
  return (
    <>
      <svg
        viewBox="0 0 400 262"
        class="plot"
        role="img"
        aria-label={`${lines.length} profiles of ${profiles.value.length} edges`}
      >
        {ticks(high).map((h) => (
          <g key={h}>
            <line class="grid" x1={box.left} x2={box.right} y1={y(h)} y2={y(h)} />
            <text x={box.left - 5} y={y(h) + 3.5} class="end">
              {h}
            </text>
          </g>
        ))}
        {ticks((box.right - box.left) / scale + outward, 6).map((m) => (
          <text key={m} x={x(m)} y={box.bottom + 14} class="middle">
            {m}
          </text>
        ))}
        <text x={box.right} y={box.bottom + 24} class="end">
          inward, m
        </text>
        {lines.map((l, i) => (
          <polyline
            key={i}
            class="profile-line"
            points={l.points.map(([a, h]) => `${x(a).toFixed(1)},${y(h).toFixed(1)}`).join(" ")}
            style={{
              strokeWidth: `${clustered.value ? 0.7 + 4 * Math.sqrt(l.length / most) : 0.9}px`,
              opacity: clustered.value
                ? 0.3 + 0.6 * Math.sqrt(l.length / most)
                : Math.max(0.06, Math.min(0.5, 60 / lines.length)),
            }}
          >
            <title>{`${count(l.edges, "edge")}, ${l.length.toFixed(0)} m`}</title>
          </polyline>
        ))}
      </svg>
      <div class="plot-foot">
        <label>
          <input
            type="checkbox"
            checked={clustered.value}
            onChange={(e) => (clustered.value = e.currentTarget.checked)}
          />
          cluster similar profiles
        </label>
        <span class="quiet">
          {clustered.value ? `${count(lines.length, "cluster")} of ` : ""}
          {count(profiles.value.length, "edge")}, {grouped(total)} m; line width by length
        </span>
      </div>
    </>
  );
}

function Errors() {
  const spread = errors.value;
  if (spread === undefined) return <p class="quiet">Loading the error map …</p>;
  if (spread === null) return <p class="quiet">No error was measured here.</p>;
  const tall = Math.max(...spread.bins);
  const wide = (box.right - box.left) / spread.bins.length;
  const [base, top] = [118, 6];
  const colour = (i: number) => {
    const t = ((i + 0.5) / spread.bins.length) * 2 - 1;
    const s = Math.min(1, Math.abs(t) * 1.2 + 0.15);
    const [r, g, b] = t > 0 ? [178, 44, 58] : [44, 96, 176];
    return `rgb(${[r, g, b].map((c) => Math.round(215 + (c - 215) * s)).join(",")})`;
  };
  return (
    <>
      <svg viewBox="0 0 400 150" class="plot" role="img" aria-label="Histogram of vertical errors">
        {spread.bins.map((share, i) => {
          const height = (share / tall) * (base - top);
          return (
            <rect
              key={i}
              x={box.left + i * wide + 0.5}
              y={base - height}
              width={wide - 1}
              height={height}
              fill={colour(i)}
            >
              <title>{`${(share * 100).toFixed(1)} %`}</title>
            </rect>
          );
        })}
        <line class="axis" x1={box.left} x2={box.right} y1={base} y2={base} />
        {[-2, -1, 0, 1, 2].map((m) => (
          <text
            key={m}
            x={box.left + ((m + limit) / (2 * limit)) * (box.right - box.left)}
            y={base + 14}
            class="middle"
          >
            {signed(m, 0)}
          </text>
        ))}
        <text x={box.right} y={base + 27} class="end">
          model − mesh, m
        </text>
      </svg>
      <dl class="numbers">
        <dt>RMSE</dt>
        <dd>{fixed(spread.rmse, 3)} m</dd>
        <dt>Mean</dt>
        <dd>{signed(spread.mean, 3)} m</dd>
        <dt>Median absolute</dt>
        <dd>{fixed(spread.medianAbsolute, 3)} m</dd>
        <dt>Within 0.25 m</dt>
        <dd>{(spread.within * 100).toFixed(1)} %</dd>
        <dt>Cells</dt>
        <dd>{grouped(spread.cells)}</dd>
      </dl>
      {state.outdatedMaps.value.has(state.run.value!.id) && (
        <p class="quiet">Errors before the last edits; they are being measured again.</p>
      )}
    </>
  );
}

function Totals() {
  const parts = buildings.value.flatMap((b) => b.parts);
  // Of a large run the list has all buildings; faces are known of those that are loaded.
  const large = state.run.value?.large;
  const rows = large?.rows.filter((r) => !within.value || r.block === within.value) ?? buildings.value.map(rowOf);
  const summary = state.runSummary(state.run.value?.id);
  const outcomes = new Map<string, number>();
  for (const b of rows) outcomes.set(b.outcome, (outcomes.get(b.outcome) ?? 0) + 1);
  return (
    <dl class="numbers">
      <dt>Buildings</dt>
      <dd>{grouped(rows.length)}</dd>
      {[...outcomes].map(([outcome, n]) => (
        <>
          <dt class="sub">{outcome}</dt>
          <dd>{grouped(n)}</dd>
        </>
      ))}
      <dt>Edited</dt>
      <dd>{grouped(rows.filter((r) => r.edited).length)}</dd>
      <dt>Parts</dt>
      <dd>{grouped(rows.reduce((sum, r) => sum + r.parts, 0))}</dd>
      <dt>{large ? `Faces of the ${grouped(buildings.value.length)} loaded` : "Faces"}</dt>
      <dd>{grouped(parts.reduce((sum, p) => sum + (p.geometry?.faces.length ?? 0), 0))}</dd>
      <dt>Volume</dt>
      <dd>{grouped(rows.reduce((sum, r) => sum + r.volume, 0))} m³</dd>
      {!within.value &&
        summary?.times.stages.map((t) => (
          <>
            <dt class="sub">Elapsed in {t.stage}</dt>
            <dd title={`${seconds(t.cpu_seconds)} of CPU time`}>{seconds(t.wall_seconds)}</dd>
          </>
        ))}
    </dl>
  );
}
