// The attributes of the selected building: those of the source and those that mansard computed, with units and meanings.
import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt, client, copy, needAttributes, showSuccess } from "../actions";
import type { AttributeMeaning, AttributeTable, AttributeValue } from "../api/types";
import * as state from "../state";
import { styledBy } from "../view/styling";
import { attributeText, matching } from "./attribute_text";
import { SearchField } from "./search_field";

const search = signal("");
/** Of one building of a large run. */
const single = signal<{ key: string; table: AttributeTable } | null>(null);

export function AttributesPanel() {
  const run = state.run.value?.id;
  const building = state.selectedBuilding.value;
  const large = state.run.value?.large !== undefined;
  const key = large && building ? `${run} ${building.id} ${building.revision}` : "";
  useEffect(() => {
    if (run && !large) void needAttributes(run);
    else if (key)
      void attempt(client.attributes(run!, building!.id)).then((table) => {
        if (table) single.value = { key, table };
      });
  }, [run, key]);
  if (!building)
    return <p class="quiet pad">{run ? "Select a building to see its attributes." : "No run is open."}</p>;
  const table = !large ? state.attributes.value.get(run!) : single.value?.key === key ? single.value.table : undefined;
  if (!table)
    return (
      <p class="quiet pad" role="status">
        Loading …
      </p>
    );
  const row = table.buildings.find((b) => b.id === building.id);
  const part = row?.parts.find((p) => p.id === state.selection.value?.part) ?? row?.parts[0];
  const list = table.attributes.filter((a) => matching(a, search.value));
  const of = (values: Record<string, AttributeValue> | undefined, source: boolean) =>
    list.filter((a) => a.source === source && values && a.name in values);
  const sections: [title: string, values: Record<string, AttributeValue> | undefined, source: boolean][] = [
    ["Of the source", row?.values, true],
    ["Of the building, computed by mansard", row?.values, false],
    [`Of the part ${part?.id ?? ""}`, part?.values, false],
  ];
  return (
    <div class={"panel" + (state.outdatedAttributes.value.has(run!) ? " outdated" : "")}>
      <div class="attribute-head">
        <b>{building.id}</b>
        <div class="table-head">
        <SearchField label="Filter attributes" value={search.value} onValue={(text) => (search.value = text)} />
        <button
          type="button"
          class="small"
          onClick={() =>
            void copy(JSON.stringify({ id: building.id, ...row?.values }, null, 1)).then((done) => {
              if (done) showSuccess("copied", "the attributes were copied as JSON");
            })
          }
        >
          Copy
        </button>
        </div>
      </div>
      {sections.map(([title, values, source]) => {
        const rows = of(values, source);
        return (
          rows.length > 0 && (
            <section class="card" key={title} aria-label={title}>
              <h2>{title}</h2>
              <dl class="attribute-list">
                {rows.map((a) => (
                  <Row key={a.name} attribute={a} value={values![a.name]!} />
                ))}
              </dl>
            </section>
          )
        );
      })}
    </div>
  );
}

function Row({ attribute: a, value }: { attribute: AttributeMeaning; value: AttributeValue }) {
  return (
    <div>
      <dt>
        {a.name}
        <button
          type="button"
          class="plain link"
          title="Colour the buildings by this attribute"
          aria-label={`Colour the buildings by ${a.name}`}
          aria-pressed={styledBy.value === a.name ? true : undefined}
          onClick={() => (styledBy.value = styledBy.value === a.name ? null : a.name)}
        >
          colour
        </button>
      </dt>
      <dd>
        {attributeText(value)} {value !== null && a.unit}
      </dd>
      {a.meaning && <dd class="meaning">{a.meaning}</dd>}
    </div>
  );
}
