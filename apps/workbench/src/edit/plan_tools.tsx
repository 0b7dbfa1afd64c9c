import type { Signal } from "@preact/signals";
import { grid, shortId, shortName, snapping } from "./desk";
import type { Neighbour } from "./neighbours";

export type Tool = "move" | "hole" | "cut";

/** What can be done to a part but drag it. */
export function PlanTools(props: {
  tool: Tool;
  building: string;
  drafted: boolean; // the server cuts and merges what it has, not what is being drawn
  hole: boolean; // an edge of one is selected
  touching: Neighbour[];
  partner: Neighbour | undefined;
  onTool(tool: Tool): void;
  onFill(): void;
  onPartner(partner: Neighbour): void;
  onMerge(): void;
}) {
  const { tool, building, drafted, touching, partner } = props;
  const key = (n: Neighbour | undefined) => (n ? `${n.building} ${n.part}` : "");
  const first = "Write or drop the change first";
  return (
    <div class="edit-tools" role="toolbar" aria-label="Plan">
      <button
        type="button"
        aria-pressed={tool === "hole"}
        onClick={() => props.onTool("hole")}
        title="Draw a courtyard: click its corners; Enter or the first corner again closes it"
      >
        Courtyard
      </button>
      <button
        type="button"
        aria-pressed={tool === "cut"}
        disabled={drafted}
        onClick={() => props.onTool("cut")}
        title={drafted ? first : "Cut the part in two: click along the cut from outside to outside; Enter ends it"}
      >
        Cut
      </button>
      {props.hole && (
        <button type="button" onClick={props.onFill} title="Fill the courtyard of the selected edge">
          Fill
        </button>
      )}
      {touching.length > 0 && (
        <span class="edit-group">
          <button
            type="button"
            disabled={drafted}
            onClick={props.onMerge}
            title={drafted ? first : "Make one part of the two; Shift and a click in the 3D view picks another"}
          >
            Merge with
          </button>
          <select
            aria-label="Part to merge with"
            value={key(partner)}
            onChange={(event) => {
              const picked = touching.find((n) => key(n) === event.currentTarget.value);
              if (picked) props.onPartner(picked);
            }}
          >
            {touching.map((n) => (
              <option key={key(n)} value={key(n)}>
                {n.building === building ? shortName(building, n.part) : shortId(n.part)}
              </option>
            ))}
          </select>
        </span>
      )}
      <span class="edit-space" />
      <label title="To corners, right angles, neighbours' walls. Alt switches it off while dragging">
        <input
          type="checkbox"
          checked={snapping.value}
          onChange={(event) => (snapping.value = event.currentTarget.checked)}
        />
        Snap
      </label>
    </div>
  );
}

/** Below the plan: what is going on, in words, and what else is shown. */
export function PlanHint({ words, sweeps }: { words: string; sweeps: Signal<boolean> }) {
  return (
    <div class="edit-hint">
      <span aria-live="polite" title={words}>
        {words}
      </span>
      <select
        aria-label="Grid"
        title="Grid to snap to"
        value={String(grid.value)}
        onChange={(event) => (grid.value = Number(event.currentTarget.value))}
      >
        <option value="0">no grid</option>
        <option value="0.1">0.1 m</option>
        <option value="0.5">0.5 m</option>
        <option value="1">1 m</option>
      </select>
      <label title="Lines the walls were chosen from">
        <input
          type="checkbox"
          checked={sweeps.value}
          onChange={(event) => (sweeps.value = event.currentTarget.checked)}
        />
        Sweep-edges
      </label>
    </div>
  );
}
