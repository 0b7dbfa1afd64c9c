import type { Signal } from "@preact/signals";
import { grid, shortId, shortName, snapping } from "./desk";
import type { Neighbour } from "./neighbours";

export type Tool = "move" | "hole" | "split" | "annex" | "dormer";

/** The tools of the plan editor. */
export function PlanTools(props: {
  tool: Tool;
  building: string;
  drafted: boolean; // splitting and merging need a saved plan
  hole: boolean; // an edge of a courtyard is selected
  structure: "dormer" | "structure" | null; // the part is one on the roof of another part
  touching: Neighbour[];
  partner: Neighbour | undefined;
  turn: "make" | "remove" | null; // what can be done with the selected edge
  turning: boolean; // a direction is being looked for
  onTurn(): void;
  onTool(tool: Tool): void;
  onFill(): void;
  onDelete(): void;
  onPartner(partner: Neighbour): void;
  onMerge(): void;
}) {
  const { tool, building, drafted, touching, partner, structure } = props;
  const key = (n: Neighbour | undefined) => (n ? `${n.building} ${n.part}` : "");
  const first = "Save or discard the change first";
  return (
    <div class="edit-tools" role="toolbar" aria-label="Plan">
      <button
        type="button"
        aria-pressed={tool === "hole"}
        onClick={() => props.onTool("hole")}
        title="Draw a courtyard: click its corners. Enter or a click on the first corner closes it"
      >
        Courtyard
      </button>
      <button
        type="button"
        aria-pressed={tool === "split"}
        disabled={drafted}
        onClick={() => props.onTool("split")}
        title={drafted ? first : "Split the part: click points of a line that starts and ends outside of it, then press Enter"}
      >
        Split
      </button>
      <button
        type="button"
        aria-pressed={tool === "annex"}
        disabled={drafted}
        onClick={() => props.onTool("annex")}
        title={
          drafted
            ? first
            : "Draw a part that is missing, beside this part or on its roof: click its corners. Enter or a click on the first corner closes it"
        }
      >
        Annex
      </button>
      {!structure && (
        <button
          type="button"
          aria-pressed={tool === "dormer"}
          disabled={drafted}
          onClick={() => props.onTool("dormer")}
          title={drafted ? first : "Add a dormer: click where the middle of its front shall be on a slope"}
        >
          Dormer
        </button>
      )}
      <button
        type="button"
        disabled={drafted}
        onClick={props.onDelete}
        title={
          drafted
            ? first
            : structure
              ? "Delete this part, and close the roof under it"
              : "Delete this part, as of a tree that was taken for one, with what stands on its roof"
        }
      >
        {structure === "dormer" ? "Delete dormer" : "Delete part"}
      </button>
      {props.turn === "make" && (
        <button
          type="button"
          disabled={props.turning}
          aria-busy={props.turning}
          onClick={props.onTurn}
          title="Give the roof plane of the selected edge a direction of its own, where its wall is not parallel to the ridge: a corner edge is made, which can be turned, and the wall goes up to the roof"
        >
          Turn roof
        </button>
      )}
      {props.turn === "remove" && (
        <button type="button" onClick={props.onTurn} title="Remove the corner edge: its roof goes back to the wall beside it (Delete)">
          Remove corner edge
        </button>
      )}
      {props.hole && (
        <button type="button" onClick={props.onFill} title="Fill the courtyard of the selected edge">
          Fill courtyard
        </button>
      )}
      {touching.length > 0 && (
        <span class="edit-group">
          <button
            type="button"
            disabled={drafted}
            onClick={props.onMerge}
            title={drafted ? first : "Merge the two parts into one. Shift and click in the 3D view selects another part"}
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
      <label title="Snap to corners, right angles and walls of neighbours. Alt disables snapping while dragging">
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

/** The line below the plan: hints, the grid, and the sweep-edges. */
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
      <label title="Lines of walls that were found in the mesh">
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
