// What the browser keeps for the page: for this tab (session) or for good (local). Private windows may refuse: then nothing
// is kept, and nothing else is lost.
type Where = "session" | "local";

const store = (where: Where): Storage | null => {
  try {
    return where === "session" ? globalThis.sessionStorage : globalThis.localStorage;
  } catch {
    return null;
  }
};

/** What was kept under `key`, or `otherwise` where there is none or it can no longer be read. */
export function kept<T>(where: Where, key: string, otherwise: T): T {
  try {
    const text = store(where)?.getItem(`mansard.${key}`);
    return text == null ? otherwise : (JSON.parse(text) as T);
  } catch {
    return otherwise;
  }
}

export function keep(where: Where, key: string, value: unknown) {
  try {
    store(where)?.setItem(`mansard.${key}`, JSON.stringify(value));
  } catch {
    // A full or forbidden store is no reason to stop.
  }
}
