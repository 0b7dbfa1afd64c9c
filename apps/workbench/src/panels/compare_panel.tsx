// The numbers of the two runs that the view shows side by side.
import { computed } from "@preact/signals";
import { compareWith, fly, openRun, select } from "../actions";
import * as state from "../state";
import { type NumberRow, buildingDifferences, difference, numbers } from "./compare";
import { differences } from "./options";
import { fixed, nameOf, signed } from "./words";

const most = 200; // maximum number of rendered rows

const changes = computed(() =>
  state.run.value && state.other.value
    ? buildingDifferences(state.run.value.buildings, state.other.value.buildings)
    : [],
);

export function ComparePanel() {
  const [first, second] = [state.runSummary(state.run.value?.id), state.runSummary(state.other.value?.id)];
  if (!first || !second) return <p class="quiet pad">Select a run under “Compare with” in the bar at the top.</p>;
  const [left, right] = [nameOf(first), nameOf(second)];
  const options = differences(first, second, state.options.value?.options ?? []);
  const swap = async () => {
    await openRun(second.id);
    await compareWith(first.id);
  };
  return (
    <div class="panel">
      <div class="compare-head">
        <span>
          <b>{left}</b> left, <b>{right}</b> right
        </span>
        {!state.isBefore(second.id) && (
          <button type="button" class="small" onClick={() => void swap()}>
            Swap
          </button>
        )}
        <button type="button" class="small" onClick={() => void compareWith(null)}>
          End comparison
        </button>
      </div>
      <section class="card">
        <h2>Numbers</h2>
        {[first, second].some((r) => state.scoresOf(r).outdated) && (
          <p class="quiet">Some errors are those before the last edits; they are being measured again.</p>
        )}
        <table class="plain-table">
          <thead>
            <tr>
              <th scope="col" />
              <th scope="col">{left}</th>
              <th scope="col">{right}</th>
              <th scope="col">change</th>
            </tr>
          </thead>
          <tbody>
            {numbers(first, second).map((row) => (
              <Numbers key={row.name} row={row} />
            ))}
          </tbody>
        </table>
      </section>
      <section class="card">
        <h2>Options that differ</h2>
        {options.length === 0 && first.preset === second.preset ? (
          <p class="quiet">None.</p>
        ) : (
          <table class="plain-table">
            <tbody>
              {first.preset !== second.preset && (
                <tr>
                  <th scope="row">preset</th>
                  <td>{first.preset || "none"}</td>
                  <td>{second.preset || "none"}</td>
                </tr>
              )}
              {options.map((o) => (
                <tr key={o.option}>
                  <th scope="row">{o.option}</th>
                  <td>{o.first || "–"}</td>
                  <td>{o.second || "–"}</td>
                </tr>
              ))}
            </tbody>
          </table>
        )}
      </section>
      <section class="card">
        <h2>
          Buildings that differ <span class="quiet">{changes.value.length}</span>
        </h2>
        {changes.value.length > 0 && (
          <table class="plain-table">
            <thead>
              <tr>
                <th scope="col">building</th>
                <th scope="col">RMSE m</th>
                <th scope="col">change</th>
                <th scope="col">parts</th>
                <th scope="col">m³</th>
              </tr>
            </thead>
            <tbody>
              {changes.value.slice(0, most).map((d) => {
                const by = difference({ first: d.rmse[0], second: d.rmse[1] });
                return (
                  <tr key={d.id}>
                    <th scope="row">
                      <button
                        type="button"
                        class="plain link"
                        onClick={() => {
                          select({ building: d.id, part: null, ring: 0, edge: null });
                          fly("selection");
                        }}
                      >
                        {d.id}
                      </button>
                    </th>
                    <td>{d.only ? `only ${d.only === "first" ? "left" : "right"}` : fixed(d.rmse[0], 2)}</td>
                    <td class={tone(by, true, 2)}>{signed(by, 2)}</td>
                    <td>{d.parts[0] === d.parts[1] ? d.parts[0] : `${d.parts[0]} → ${d.parts[1]}`}</td>
                    <td>{signed(d.volume[1] - d.volume[0], 0)}</td>
                  </tr>
                );
              })}
            </tbody>
          </table>
        )}
        {changes.value.length > most && <p class="quiet">{changes.value.length - most} more with smaller differences</p>}
      </section>
    </div>
  );
}

function Numbers({ row }: { row: NumberRow }) {
  const by = difference(row);
  return (
    <tr>
      <th scope="row">
        {row.name}
        {row.unit && <span class="quiet"> {row.unit}</span>}
      </th>
      <td>{fixed(row.first, row.digits)}</td>
      <td>{fixed(row.second, row.digits)}</td>
      <td class={tone(by, row.less, row.digits)}>{signed(by, row.digits)}</td>
    </tr>
  );
}

/** The class "better" or "worse"; none for changes below the displayed digits. */
function tone(by: number | null, less: boolean | null, digits: number): string {
  if (by === null || less === null || Number(by.toFixed(digits)) === 0) return "";
  return by < 0 === less ? "better" : "worse";
}
