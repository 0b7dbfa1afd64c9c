import { useSignal } from "@preact/signals";
import { redo, undo } from "../actions";
import { parsed, shownNumber } from "./numbers";

interface NumberFieldProps {
  label: string;
  unit: string;
  value: number | null;
  /** Called with the typed value, never with a rounded displayed one. */
  onValue: (value: number) => void;
  digits?: number;
  disabled?: boolean;
  title?: string;
}

/** A number field that accepts a decimal comma or point. Enter and leaving the field apply the value, Esc does not; arrow
 *  keys change it in steps. */
export function NumberField({ label, unit, value, onValue, digits = 3, disabled, title }: NumberFieldProps) {
  const typed = useSignal<string | null>(null);
  const shown = value === null ? "" : shownNumber(value, digits, 2);
  const text = typed.value ?? shown;
  const wrong = typed.value !== null && typed.value !== shown && parsed(typed.value) === null;

  const take = () => {
    const now = typed.value;
    if (now === null) return;
    const number = parsed(now);
    if (now === shown || number === null) {
      if (number !== null) typed.value = null;
      return;
    }
    typed.value = null;
    // A number that is shown as the present value is the present value: nobody typed the digits that are not shown.
    if (value === null || shownNumber(number, digits, 2) !== shown) onValue(number);
  };
  const key = (event: KeyboardEvent) => {
    // Nothing is typed that the field itself could take back.
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && (typed.value ?? shown) === shown) {
      event.preventDefault();
      void (event.shiftKey ? redo() : undo());
    } else if (event.key === "Enter") take();
    else if (event.key === "Escape" && typed.value !== null) {
      typed.value = null;
      event.stopPropagation();
    } else if ((event.key === "ArrowUp" || event.key === "ArrowDown") && value !== null) {
      event.preventDefault();
      const by = (event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 1 : event.altKey ? 0.01 : 0.1);
      const from = typed.value === null ? value : (parsed(typed.value) ?? value);
      typed.value = null;
      onValue(Math.round((from + by) * 1e9) / 1e9);
    }
  };
  return (
    <label class="edit-number" title={title}>
      <span>{label}</span>
      <input
        type="text"
        inputMode="decimal"
        autocomplete="off"
        value={text}
        disabled={disabled || value === null}
        placeholder="–"
        aria-invalid={wrong}
        aria-label={`${label}, ${unit === "°" ? "degrees" : "metres"}`}
        onInput={(event) => (typed.value = event.currentTarget.value)}
        onFocus={(event) => event.currentTarget.select()}
        onKeyDown={key}
        onBlur={() => {
          take();
          typed.value = null;
        }}
      />
      <span class="edit-unit">{unit}</span>
    </label>
  );
}
