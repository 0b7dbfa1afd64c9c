// Numbers and names as text.
export const metres = (x: number, digits = 2) => `${x.toFixed(digits)} m`;
export const fixed = (x: number | null | undefined, digits: number) =>
  x === null || x === undefined || Number.isNaN(x) ? "–" : x.toFixed(digits).replace("-", "−");
/** With a sign, unless it rounds to zero. */
export function signed(x: number | null, digits: number): string {
  if (x === null || Number.isNaN(x)) return "–";
  const text = Math.abs(x).toFixed(digits);
  return Number(text) === 0 ? text : `${x < 0 ? "−" : "+"}${text}`;
}
/** Root of a mean square; null where there is none. */
export const rmse = (mse: number | null | undefined) => (mse === null || mse === undefined ? null : Math.sqrt(mse));
export const count = (n: number, one: string, many = `${one}s`) => `${grouped(n)} ${n === 1 ? one : many}`;
/** 12345 → 12,345. */
export const grouped = (n: number) =>
  Math.round(n)
    .toString()
    .replace(/\B(?=(\d{3})+(?!\d))/g, ",");
export function seconds(s: number): string {
  if (s < 10) return `${s.toFixed(1)} s`;
  if (s < 100) return `${Math.round(s)} s`;
  const whole = Math.round(s);
  return `${Math.floor(whole / 60)} min ${(whole % 60).toString().padStart(2, "0")} s`;
}
export function bytes(n: number): string {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let i = 0;
  while (n >= 1000 && i < units.length - 1) {
    n /= 1000;
    ++i;
  }
  return `${n.toFixed(i && n < 100 ? 1 : 0)} ${units[i]}`;
}
/** Shortens long names in a sentence, such as ids of 36 characters, to their beginnings and ends. */
export const brief = (text: string) => text.replace(/[^\s]{20,}/g, (name) => `${name.slice(0, 9)}…${name.slice(-4)}`);
/** Options as the form of options names them: messages of the program give them as on a command line, such as --mesh-offset. */
export const inPage = (text: string) =>
  text.replace(
    /(^|[^\w-])--([a-z][a-z0-9.]*(?:-[a-z0-9]+)*)/g,
    (_, before: string, name: string) => `${before}the option “${name.replaceAll("-", " ")}”`,
  );
/** With a capital first letter. */
export const sentence = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
/** What the page itself has for what a message is about. */
const here: Record<string, string> = {
  "ingest-no-overlap": "“Find an offset” in the form of the inputs looks for a CRS or an offset with which they do.",
};
/** The message of a diagnostic as the page shows it. */
export const said = ({ message, code }: { message: string; code?: string }) =>
  sentence(inPage(message)) + (code !== undefined && Object.hasOwn(here, code) ? `. ${here[code]}` : "");
/** The name of a run: its label, or its id if it has none. */
export const nameOf = (run: { id: string; label: string }) => run.label || run.id;
/** The name of a run, followed by its id if they differ. */
export const fullNameOf = (run: { id: string; label: string }) =>
  run.label && run.label !== run.id ? `${run.label} (${run.id})` : run.id;
