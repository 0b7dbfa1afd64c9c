// The buildings of the open run as a table. Of thousands of rows only the visible ones are rendered.
import { computed, effect, signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { client, fly, needAttributes, select } from "../actions";
import { Refused } from "../api/client";
import * as state from "../state";
import { searchedOf } from "./attribute_text";
import { SearchField } from "./search_field";
import { type Column, type Order, type Row, columnsOf, filtered, idsFirst, rowOf, sorted, unknownNames, visibleRows } from "./table";
import { fixed, grouped } from "./words";

const filter = signal("");
const order = signal<Order>({ column: "id", down: false });
const all = computed(() => state.run.value?.large?.rows ?? [...(state.run.value?.buildings.values() ?? [])].map(rowOf));
const searched = computed(() => searchedOf(state.attributes.value.get(state.run.value?.id ?? "")));
const inOrder = computed(() => sorted(all.value, order.value));
/** What the server found in a large run. */
const found = signal<{ run: string; words: string; ids: ReadonlySet<string> } | null>(null);
const rows = computed((): readonly Row[] => {
  const answer = found.value;
  const { columns, rest } = columnsOf(filter.value);
  if (answer && state.run.value?.large && answer.run === state.run.value.id && rest && answer.words === rest)
    return idsFirst(filtered(inOrder.value.filter((r) => answer.ids.has(r.id)), columns), rest);
  return filtered(inOrder.value, filter.value, searched.value);
});
const runId = computed(() => state.run.value?.id);
const isLarge = computed(() => state.run.value?.large !== undefined);
// The attributes are needed once something is searched. Those of a large run stay on the server, which searches them.
effect(() => {
  const run = runId.value;
  const words = filter.value;
  if (!run || !words.trim()) return;
  if (!isLarge.value) {
    if (!state.outdatedAttributes.value.has(run)) void needAttributes(run);
    return;
  }
  const { rest } = columnsOf(words);
  if (!rest) return;
  const stop = new AbortController();
  const asked = setTimeout(() => {
    client.search(run, rest, stop.signal).then(
      ({ ids }) => (found.value = { run, words: rest, ids: new Set(ids) }),
      (e: unknown) => {
        if (!(e instanceof Refused) && !stop.signal.aborted) throw e;
      },
    );
  }, 80);
  return () => {
    clearTimeout(asked);
    stop.abort();
  };
});
/** Names in comparisons that no building has. */
const unknown = computed(() => {
  const table = state.attributes.value.get(state.run.value?.id ?? "");
  if (!table || isLarge.value) return null;
  return unknownNames(filter.value, table.attributes.map((a) => a.name));
});
effect(() => {
  state.order.value = rows.value.map((r) => r.id);
});

const rowHeight = 26;
const headHeight = 30;
const columns: { column: Column; name: string; title: string; number?: boolean }[] = [
  { column: "id", name: "Building", title: "Id of the footprint" },
  { column: "block", name: "Block", title: "Block of buildings that touch" },
  { column: "outcome", name: "Outcome", title: "Result of the run: full, or a simpler model" },
  {
    column: "confidence",
    name: "Sure",
    title: "Probability that the model is right, in percent; the least sure first",
    number: true,
  },
  { column: "rmse", name: "RMSE m", title: "Root mean squared vertical error over the footprint; ground without a model counts as missed", number: true },
  { column: "volume", name: "m³", title: "Volume", number: true },
  { column: "edited", name: "✎", title: "Edited by hand" },
];

const go = (row: Row | undefined) => {
  if (!row) return;
  select({ building: row.id, part: null, ring: 0, edge: null });
  fly("selection");
};

export function BuildingsPanel() {
  const box = useRef<HTMLDivElement>(null);
  const [window, setWindow] = useState({ top: 0, height: 600 });
  const list = rows.value;
  const selected = state.selection.value?.building;
  const at = list.findIndex((r) => r.id === selected);

  useEffect(() => {
    const sized = new ResizeObserver(() =>
      setWindow({ top: box.current?.scrollTop ?? 0, height: box.current?.clientHeight ?? 600 }),
    );
    if (box.current) sized.observe(box.current);
    return () => sized.disconnect();
  }, []);
  useEffect(() => {
    const element = box.current;
    if (!element || at < 0) return;
    const top = at * rowHeight;
    if (top < element.scrollTop) element.scrollTop = top;
    else if (top + 2 * rowHeight > element.scrollTop + element.clientHeight - headHeight) {
      element.scrollTop = top + 2 * rowHeight - element.clientHeight + headHeight;
    }
    // Not when the order changes: sortBy shows the first rows then.
  }, [selected, filter.value, runId.value]);

  /** Whoever sorts by error wants to see the largest one, wherever the selected building is. */
  const sortBy = (by: Order) => {
    order.value = by;
    if (box.current) box.current.scrollTop = 0;
    setWindow({ ...window, top: 0 });
  };

  const { from, to } = visibleRows(list.length, rowHeight, window.top, window.height);
  const keys = (e: KeyboardEvent) => {
    const page = Math.max(1, Math.floor(window.height / rowHeight) - 2);
    const steps: Record<string, number> = {
      ArrowDown: at + 1,
      ArrowUp: at - 1,
      PageDown: at + page,
      PageUp: at - page,
    };
    const next = { ...steps, Home: 0, End: list.length - 1 }[e.key];
    if (e.target !== e.currentTarget) return; // of a button in the head
    if (e.key === "Enter") return go(list[at]);
    if (next === undefined || e.ctrlKey || e.metaKey) return;
    e.preventDefault();
    go(list[Math.max(0, Math.min(list.length - 1, next))]);
  };
  return (
    <div class="panel fill">
      <div class="table-head">
        <SearchField
          label="Filter buildings"
          placeholder="Id, block, attribute, measuredHeight>12"
          value={filter.value}
          onValue={(text) => (filter.value = text)}
        />
        <span class="quiet">
          {list.length === all.value.length
            ? grouped(list.length)
            : `${grouped(list.length)} of ${grouped(all.value.length)}`}
        </span>
      </div>
      {unknown.value && (
        <p class="quiet" role="status">
          {unknown.value}
        </p>
      )}
      <div
        class="table"
        ref={box}
        tabIndex={0}
        role="grid"
        aria-label="Buildings"
        aria-rowcount={list.length + 1}
        aria-activedescendant={at >= from && at < to ? `building-${at}` : undefined}
        onKeyDown={keys}
        onScroll={(e) => setWindow({ top: e.currentTarget.scrollTop, height: e.currentTarget.clientHeight })}
      >
        <div class="table-row heads" role="row">
          {columns.map(({ column, name, title, number }) => {
            const by = order.value.column === column;
            return (
              <div
                role="columnheader"
                key={column}
                aria-sort={by ? (order.value.down ? "descending" : "ascending") : "none"}
              >
                <button
                  type="button"
                  class={"plain" + (number ? " number" : "")}
                  title={title}
                  onClick={() => sortBy({ column, down: by ? !order.value.down : !!number && column !== "confidence" })}
                >
                  {name}
                  {by && <span aria-hidden="true">{order.value.down ? " ▾" : " ▴"}</span>}
                </button>
              </div>
            );
          })}
        </div>
        <div class="table-body" role="rowgroup">
          <div style={{ height: `${list.length * rowHeight}px` }}>
            <div style={{ transform: `translateY(${from * rowHeight}px)` }}>
              {list.slice(from, to).map((row, i) => (
                <TableRow key={row.id} row={row} index={from + i} selected={from + i === at} />
              ))}
            </div>
          </div>
          {list.length === 0 && (
            <p class="quiet pad">{all.value.length ? "No building matches the filter." : "No run is open."}</p>
          )}
        </div>
      </div>
    </div>
  );
}

function TableRow({ row, index, selected }: { row: Row; index: number; selected: boolean }) {
  return (
    <div
      class={"table-row" + (selected ? " selected" : "")}
      role="row"
      id={`building-${index}`}
      aria-rowindex={index + 2}
      aria-selected={selected}
      onClick={() => go(row)}
    >
      <div role="gridcell" title={row.id}>
        {row.id}
      </div>
      <div role="gridcell">{row.block}</div>
      <div role="gridcell" class={`outcome ${row.outcome}`} title={row.reasons.join("\n") || undefined}>
        {row.outcome}
        {row.reasons.length > 0 && <span aria-label={row.reasons.join(" ")}> ⓘ</span>}
      </div>
      <div role="gridcell" class="number">
        {row.confidence === null ? "–" : `${Math.floor(100 * row.confidence)} %`}
      </div>
      <div role="gridcell" class="number">
        {fixed(row.rmse, 2)}
      </div>
      <div role="gridcell" class="number">
        {grouped(row.volume)}
      </div>
      <div role="gridcell">{row.edited ? <span aria-label="edited">✎</span> : ""}</div>
    </div>
  );
}
