// A form made of a list of options: whatever the engine's rooms offer is here by itself.
import type { Option, Preset } from "../api/types";
import { fault, grouped, key, tellingRange, usual } from "./options";

interface Props {
  options: readonly Option[];
  values: Record<string, string>;
  preset?: Preset;
  search?: string;
  plain?: boolean; // all rooms open
  onChange: (values: Record<string, string>) => void;
}

export function OptionFields({ options, values, preset, search = "", plain = false, onChange }: Props) {
  const rooms = grouped(options, search);
  if (!rooms.length) return <p class="quiet">No option has these words.</p>;
  return (
    <div class="options">
      {rooms.map(([room, of]) => {
        const changes = of.filter((o) => isChanged(o, values, preset)).length;
        const fields = of.map((o) => (
          <OptionField key={key(o)} option={o} values={values} preset={preset} onChange={onChange} />
        ));
        if (plain) return <div key={room}>{fields}</div>;
        return (
          <details key={room} open={search !== ""}>
            <summary>
              {room}
              {changes > 0 && <span class="badge">{changes} changed</span>}
            </summary>
            {fields}
          </details>
        );
      })}
    </div>
  );
}

const isChanged = (o: Option, values: Record<string, string>, preset: Preset | undefined) =>
  values[key(o)] !== undefined && values[key(o)] !== usual(o, preset);

type FieldProps = Pick<Props, "values" | "preset" | "onChange"> & { option: Option };

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
  const range = tellingRange(option);
  const help = [option.meaning, !wrong && range && `${range}${option.unit && ` ${option.unit}`}.`]
    .filter(Boolean)
    .join(" ");
  const shared = { id, "aria-describedby": `${id}-help`, "aria-invalid": wrong ? true : undefined };
  return (
    <div class={"option" + (different ? " different" : "")}>
      <label for={id}>{option.name.replaceAll("_", " ")}</label>
      {option.kind === "flag" ? (
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
          inputMode={option.kind === "text" ? "text" : "decimal"}
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
          title={`Back to ${usual(option, preset) || "nothing"}`}
          aria-label={`Reset ${option.name}`}
          onClick={reset}
        >
          ↺
        </button>
      ) : (
        <span />
      )}
      <p class="option-help" id={`${id}-help`}>
        {wrong && <span class="wrong">{wrong}. </span>}
        {help}
      </p>
    </div>
  );
}
