// The viewer there is, once the page has made it.
import { signal } from "@preact/signals";
import type { Viewer } from "./viewer";

export const viewer = signal<Viewer | null>(null);
