// The search of the docs site: a plain script, for pages opened from disk as well as from a server. The index is
// search-data.js, an array of { page, heading, to, text }, loaded when somebody first searches. Node runs it in the checks.
(() => {
  const fold = (text) => text.toLowerCase().normalize("NFKD").replace(/\p{M}/gu, "");
  const words_of = (text) => fold(text).match(/[\p{L}\p{N}_.-]*[\p{L}\p{N}]/gu) ?? [];

  /// How well one word of the query matches a text: 3 as a word, 2 as the beginning of one, 1 inside one, 0 not.
  function match(text, word) {
    let best = 0;
    for (let at = text.indexOf(word); at >= 0 && best < 3; at = text.indexOf(word, at + 1)) {
      const starts = at === 0 || !/[\p{L}\p{N}]/u.test(text[at - 1]);
      const ends = at + word.length === text.length || !/[\p{L}\p{N}]/u.test(text[at + word.length]);
      best = Math.max(best, starts && ends ? 3 : starts ? 2 : 1);
    }
    return best;
  }

  /// The entries that have every word of the query, the best first.
  function search(entries, query, limit = 20) {
    const words = [...new Set(words_of(query))];
    if (words.length === 0) return [];
    const phrase = fold(query).trim().replace(/\s+/g, " ");
    const found = [];
    entries.forEach((entry, order) => {
      entry.folded ??= { page: fold(entry.page), heading: fold(entry.heading), text: fold(entry.text) };
      const { page, heading, text } = entry.folded;
      let score = 0;
      for (const word of words) {
        const of_word = 4 * match(page, word) + 6 * match(heading, word) + match(text, word);
        if (of_word === 0) return;
        score += of_word;
      }
      if (words.length > 1) score += heading.includes(phrase) ? 12 : text.includes(phrase) ? 6 : 0;
      if (heading === phrase) score += 20;
      if (page === phrase && heading === page) score += 10;
      if (entry.to.includes("decisions/")) score *= 0.7;  // the pages say what holds, decisions why
      found.push({ entry, score, order });
    });
    return found.sort((a, b) => b.score - a.score || a.order - b.order).slice(0, limit).map(({ entry }) => entry);
  }

  /// A piece of the text around the first word that is in it.
  function excerpt(entry, query) {
    const places = words_of(query).map((word) => entry.folded.text.indexOf(word)).filter((at) => at >= 0);
    const from = Math.max(0, Math.min(...places, entry.text.length) - 40);
    const start = from === 0 ? 0 : entry.text.indexOf(" ", from) + 1;
    return (start > 0 ? "… " : "") + entry.text.slice(start, start + 110) + (start + 110 < entry.text.length ? " …" : "");
  }

  globalThis.mansard_search = { search };
  if (typeof document === "undefined") return;

  const base = document.currentScript.src.replace(/[^/]*$/, "");
  const make = (tag, properties = {}, ...inside) => {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...inside);
    return made;
  };
  const input = make("input", { type: "search", placeholder: "Search  ( / )", autocomplete: "off", spellcheck: false });
  input.setAttribute("aria-label", "Search the documentation");
  const status = make("p", { className: "status" });
  status.setAttribute("role", "status");
  const list = make("ol");
  const results = make("div", { className: "results", hidden: true }, status, list);
  const form = make("form", { className: "search" }, input, results);
  form.setAttribute("role", "search");
  document.querySelector("nav").prepend(form);

  let loading;
  const load = () => (loading ??= new Promise((resolve, reject) => {
    document.head.append(make("script", { src: `${base}search-data.js`, onload: () => resolve(globalThis.mansard_pages),
      onerror: () => reject(new Error("search-data.js cannot be loaded")) }));
  }));

  async function show() {
    const query = input.value;
    let found = [];
    let said = "";
    if (words_of(query).length > 0) {
      try {
        found = search(await load(), query);
        said = found.length === 0 ? "Nothing found" : `${found.length} result${found.length === 1 ? "" : "s"}`;
      } catch (error) {
        said = error.message;
      }
    }
    if (query !== input.value) return;  // typed on meanwhile
    status.textContent = said;
    list.replaceChildren(...found.map((entry) => make("li", {}, make("a", { href: base + entry.to },
      make("strong", { textContent: entry.heading || entry.page }),
      ...(entry.heading && entry.heading !== entry.page ? [make("small", { textContent: entry.page })] : []),
      make("span", { textContent: excerpt(entry, query) })))));
    results.hidden = said === "";
  }

  const links = () => [...list.querySelectorAll("a")];
  const close = () => {
    results.hidden = true;
    input.focus();
  };
  input.addEventListener("input", show);
  input.addEventListener("focus", () => {
    load().catch(() => {});
    results.hidden = status.textContent === "" || input.value === "";
  });
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    links()[0]?.click();
  });
  form.addEventListener("keydown", (event) => {
    const all = links();
    const at = all.indexOf(document.activeElement);
    if (event.key === "Escape") close();
    else if (event.key === "ArrowDown") (all[at + 1] ?? all[0])?.focus();
    else if (event.key === "ArrowUp") (at <= 0 ? input : all[at - 1]).focus();
    else return;
    event.preventDefault();
  });
  list.addEventListener("click", () => { results.hidden = true; });
  document.addEventListener("click", (event) => { if (!form.contains(event.target)) results.hidden = true; });
  document.addEventListener("keydown", (event) => {
    const typing = /^(INPUT|TEXTAREA|SELECT)$/.test(document.activeElement?.tagName ?? "");
    if (event.key !== "/" || typing || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    input.focus();
    input.select();
  });
})();
