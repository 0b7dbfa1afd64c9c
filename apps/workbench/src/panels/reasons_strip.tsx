// Below the tabs, whichever is open: why the selected building has a simpler model than asked for.
import * as state from "../state";
import { reasonsOf } from "./reasons";

export function ReasonsStrip() {
  const building = state.selectedBuilding.value;
  if (!building || state.tab.value === "review") return null; // which has them itself
  const reasons = reasonsOf(building);
  if (building.outcome === "full" && reasons.length === 0) return null;
  return (
    <section class="reasons" aria-label="Diagnostics of the selected building">
      <b>{building.id}</b> <span class={`outcome ${building.outcome}`}>{building.outcome}</span>
      {reasons.length === 0 ? (
        <p>The run gives no reason.</p>
      ) : (
        <ul>
          {reasons.map((r) => (
            <li key={r}>{r}</li>
          ))}
        </ul>
      )}
    </section>
  );
}
