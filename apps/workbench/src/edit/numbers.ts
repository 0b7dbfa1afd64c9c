// Typed numbers are parsed, and numbers are formatted.

/** "7.4", "7,4", "-0.5", " 12 "; null for anything else, also for thousands separators. */
export function parsed(text: string): number | null {
  const trimmed = text.trim().replace("−", "-");
  if (!/^[+-]?(\d+([.,]\d*)?|[.,]\d+)$/.test(trimmed)) return null;
  const value = Number(trimmed.replace(",", "."));
  return Number.isFinite(value) ? value : null;
}

/** With at most `most` decimals, without trailing zeros beyond `least` decimals. */
export function shownNumber(value: number, most = 3, least = 2): string {
  const text = value.toFixed(most);
  const cut = text.replace(/0+$/, "");
  const digits = cut.length - cut.indexOf(".") - 1;
  const shown = digits >= least ? cut : text.slice(0, text.length - (most - least));
  return Number(shown) === 0 ? shown.replace("-", "") : shown.replace("-", "−");
}

export const metres = (value: number | null | undefined, digits = 2) =>
  value === null || value === undefined ? "–" : `${value.toFixed(digits).replace("-", "−")} m`;
export const cubicMetres = (value: number | null | undefined) =>
  value === null || value === undefined ? "–" : `${value.toFixed(value < 1000 ? 1 : 0)} m³`;
