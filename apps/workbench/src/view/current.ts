// The viewer of the page; null until it has been created.
import { signal } from "@preact/signals";
import type { Viewer } from "./viewer";

export const viewer = signal<Viewer | null>(null);
