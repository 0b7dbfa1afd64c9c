// Light and dark colours of the page: as the browser has it, or as chosen.
import { computed, effect, signal } from "@preact/signals";
import { keep, kept } from "../keep";

export type Theme = "auto" | "light" | "dark";
export const theme = signal<Theme>(kept("local", "theme", "auto"));
const system = globalThis.matchMedia?.("(prefers-color-scheme: dark)");
const systemDark = signal(system?.matches ?? false);
system?.addEventListener?.("change", (e) => (systemDark.value = e.matches));

export const dark = computed(() => (theme.value === "auto" ? systemDark.value : theme.value === "dark"));
effect(() => keep("local", "theme", theme.value));
effect(() => {
  if (typeof document !== "undefined") document.documentElement.dataset.theme = dark.value ? "dark" : "light";
});
