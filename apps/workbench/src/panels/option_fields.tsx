// A form made from the list of options that the server sends.
import { signal } from "@preact/signals";
import type { Option, Preset } from "../api/types";
import { keep, kept } from "../keep";
import { fault, found, grouped, isChanged, key, shownRange, usual, visible } from "./options";
import { SearchField } from "./search_field";
import { count } from "./words";

interface Props {
  options: readonly Option[];
  values: Record<string, string>;
  preset?: Preset;
  onChange: (values: Record<string, string>) => void;
}

const advanced = signal(kept("local", "advanced options", false));

/** Options by module, with a search. Advanced options are shown on request only. */
export function OptionFields(props: Props & { search: string; onSearch: (search: string) => void }) {
  const { options, values, preset, search, onSearch, onChange } = props;
  const matching = found(options, search);
  const { shown, hidden } = visible(matching, advanced.value, values, preset);
  const all = options.filter((o) => o.advanced).length;
  const show = (value: boolean) => {
    advanced.value = value;
    keep("local", "advanced options", value);
  };
  return (
    <>
      <div class="option-search">
        <SearchField label="Search options" value={search} onValue={onSearch} />
        <button
          type="button"
          class="small"
          disabled={!options.some((o) => isChanged(o, values, preset))}
          onClick={() => onChange({})}
        >
          Reset all
        </button>
      </div>
      {matching.length === 0 && <p class="quiet">No option matches the search.</p>}
      <div class="options">
        {grouped(shown).map(([module, of]) => {
          const changes = of.filter((o) => isChanged(o, values, preset)).length;
          return (
            <details key={module} open={search !== ""}>
              <summary>
                {module}
                {changes > 0 && <span class="badge">{changes} changed</span>}
              </summary>
              <PlainOptionFields options={of} values={values} preset={preset} onChange={onChange} />
            </details>
          );
        })}
      </div>
      {hidden > 0 && (
        <button type="button" class="small advanced" onClick={() => show(true)}>
          Show advanced options ({hidden})
        </button>
      )}
      {hidden === 0 && advanced.value && all > 0 && (
        <button type="button" class="small advanced" onClick={() => show(false)}>
          Hide {count(all, "advanced option")}
        </button>
      )}
    </>
  );
}

/** The fields of some options, without groups or search. */
export function PlainOptionFields({ options, values, preset, onChange }: Props) {
  return (
    <div>
      {options.map((o) => (
        <OptionField key={key(o)} option={o} values={values} preset={preset} onChange={onChange} />
      ))}
    </div>
  );
}

type FieldProps = Omit<Props, "options"> & { option: Option };

function OptionField({ option, values, preset, onChange }: FieldProps) {
  const name = key(option);
  const value = values[name] ?? usual(option, preset);
  const wrong = fault(option, value);
  const different = isChanged(option, values, preset);
  const id = `option-${name}`;
  const set = (text: string) => onChange({ ...values, [name]: text });
  const reset = () => {
    const { [name]: _, ...rest } = values;
    onChange(rest);
  };
  const range = shownRange(option);
  const help = [option.meaning, !wrong && range && `Range: ${range}${option.unit && ` ${option.unit}`}.`]
    .filter(Boolean)
    .join(" ");
  const shared = { id, "aria-describedby": `${id}-help`, "aria-invalid": wrong ? true : undefined };
  return (
    <div class={"option" + (different ? " different" : "")}>
      <label for={id}>{option.name.replaceAll("_", " ")}</label>
      {option.kind === "boolean" ? (
        <input
          {...shared}
          type="checkbox"
          checked={value === "true"}
          onChange={(e) => set(e.currentTarget.checked ? "true" : "false")}
        />
      ) : option.kind === "choice" ? (
        <select {...shared} value={value} onChange={(e) => set(e.currentTarget.value)}>
          {option.choices.map((c) => (
            <option key={c}>{c}</option>
          ))}
        </select>
      ) : (
        <input
          {...shared}
          type="text"
          inputMode={option.kind === "string" ? "text" : "decimal"}
          spellcheck={false}
          value={value}
          onInput={(e) => set(e.currentTarget.value)}
        />
      )}
      <span class="unit">{option.unit}</span>
      {different ? (
        <button
          type="button"
          class="plain reset"
          title={`Reset to ${usual(option, preset) || "no value"}`}
          aria-label={`Reset ${option.name}`}
          onClick={reset}
        >
          ↺
        </button>
      ) : (
        <span />
      )}
      <p class="option-help" id={`${id}-help`}>
        {wrong && <span class="wrong">The value {wrong}. </span>}
        {help}
        {option.source && <span class="option-source"> Source: {option.source.replace(/\.$/, "")}.</span>}
      </p>
    </div>
  );
}
