// Values that the browser stores for the page: for this tab (session) or permanently (local). If the browser refuses, as in
// some private windows, nothing is stored.
type Where = "session" | "local";

const store = (where: Where): Storage | null => {
  try {
    return where === "session" ? globalThis.sessionStorage : globalThis.localStorage;
  } catch {
    return null;
  }
};

/** The value stored under `key`; `otherwise` if there is none or it cannot be read. */
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
    // The storage is full or forbidden: the page works without it.
  }
}
