/** A search field whose label is also its placeholder. */
export function SearchField(props: {
  label: string;
  placeholder?: string;
  value: string;
  onValue: (value: string) => void;
}) {
  return (
    <input
      type="search"
      placeholder={props.placeholder ?? props.label}
      aria-label={props.label}
      value={props.value}
      onInput={(e) => props.onValue(e.currentTarget.value)}
    />
  );
}
