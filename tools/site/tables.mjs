// The program's own lists as HTML: verbs, options, presets, codes, attributes.

export const escape = (text) =>
  text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");
const code = (text) => `<code>${escape(text)}</code>`;
const dashed = (text) => text.replaceAll("_", "-");

/// Rows are { id, cells }; cells are HTML.
function table(header, rows) {
  const head = header.map((cell) => `<th>${cell}</th>`).join("");
  const body = rows.map(({ id, cells }) =>
    `<tr${id ? ` id="${id}"` : ""}>${cells.map((cell) => `<td>${cell}</td>`).join("")}</tr>`);
  return `<table class="made"><thead><tr>${head}</tr></thead><tbody>${body.join("\n")}</tbody></table>`;
}

function range_of(option) {
  if (option.kind === "choice") return option.choices.map(code).join(", ");
  if (option.kind === "boolean") return "yes or no";
  return option.minimum === null && option.maximum === null ? "" : `${option.minimum ?? "…"} to ${option.maximum ?? "…"}`;
}

const option_table = (options) =>
  table(["option", "default", "unit", "range", "meaning"], options.map((option) => {
    const names = [`${option.module}-${option.name}`, ...(option.alias ? [option.alias] : [])];
    const typed = names.map((name) => code(`--${dashed(name)}`)).join(", ");
    return {
      id: `option-${option.module}-${option.name}`,
      cells: [`${code(option.name)}<br><small>${typed}</small>`, option.default === "" ? "–" : code(option.default),
        escape(option.unit), range_of(option), escape(option.meaning)],
    };
  }));

const code_table = (codes) =>
  table(["code", "cause", "remedy", "exit code"], codes.map((entry) => ({
    id: `code-${entry.code}`,
    cells: [code(entry.code), escape(entry.cause), escape(entry.remedy), String(entry.exit_code)],
  })));

const attribute_table = (attributes) =>
  table(["attribute", "of", "type", "unit", "meaning"], attributes.map((attribute) => ({
    id: `attribute-${attribute.name}`,
    cells: [code(attribute.name), attribute.of.map(code).join(", "), escape(attribute.type), escape(attribute.unit),
      escape(attribute.meaning)],
  })));

const preset_table = (presets) =>
  table(["preset", "meaning", "values"], presets.map((preset) => ({
    cells: [code(preset.name), escape(preset.meaning),
      Object.entries(preset.values).map(([option, value]) => code(`${option} = ${value}`)).join("<br>")],
  })));

const exit_table = (exits) =>
  table(["exit code", "when"], exits.map((exit) => ({ cells: [String(exit.exit_code), escape(exit.when)] })));

function verb_section(verb) {
  const own = [...verb.arguments, ...verb.options.filter((entry) => entry.module === "")];
  const modules = [...new Set(verb.options.map((entry) => entry.module).filter((module) => module !== ""))];
  const rows = own.map((entry) => ({
    id: entry.names.length > 0 ? `${verb.verb}${entry.names[0]}` : undefined,
    cells: [`${entry.names.map(code).join(", ")} ${escape(entry.value)}${entry.required ? " (required)" : ""}`.trim(),
      escape(entry.meaning)],
  }));
  const links = modules.map((module) => `<a href="options.html#${module}">${module}</a>`).join(", ");
  return `<h2 id="${verb.verb}">mansard ${verb.verb}</h2><p>${escape(verb.meaning)}.</p>` +
    table(["", "meaning"], rows) + (modules.length > 0 ? `<p>And the options of ${links}.</p>` : "");
}

export class Tables {
  constructor(modules, known) {
    this.modules = modules;
    this.known = known;
  }

  /// What a code belongs to: the module that it begins with, else what is under all modules.
  #module_of(entry) { return this.modules.find((module) => entry.code.startsWith(`${module}-`)) ?? "base"; }

  /// By the heading of the section that each belongs to; nothing for what the module does not have.
  of_module(module) {
    const { options, codes, attributes } = this.known;
    const own = {
      Options: [option_table, options.filter((option) => option.module === module)],
      Codes: [code_table, codes.filter((entry) => this.#module_of(entry) === module)],
      Attributes: [attribute_table, attributes.filter((attribute) => attribute.module === module)],
    };
    return Object.fromEntries(Object.entries(own).filter(([, [, list]]) => list.length > 0)
      .map(([heading, [make, list]]) => [heading, make(list)]));
  }

  /// The pages that are nothing else: title and body by address.
  pages() {
    const { verbs, options, presets, simulate_presets, attributes, codes, exit_codes } = this.known;
    const of_options = [...new Set(options.map((option) => option.module))].map((module) =>
      `<h2 id="${module}">${module}</h2>${option_table(options.filter((option) => option.module === module))}`);
    return {
      "verbs.html": ["Verbs", verbs.map(verb_section).join("\n")],
      "options.html": ["Options", `<p>Option ${code("name")} of module ${code("module")} is ${code("--module-name")} on the
        command line, and ${code("name")} in the table ${code("[module]")} of a file for ${code("--config")}.</p>
        ${of_options.join("\n")}
        <h2 id="presets">Presets</h2>${preset_table(presets)}
        <h2 id="simulate_presets">Presets of simulate</h2>${preset_table(simulate_presets)}`],
      "attributes.html": ["Attributes", `<p>What models carry, beside the attributes of their source.</p>
        ${attribute_table(attributes)}`],
      "codes.html": ["Diagnostic codes", exit_table(exit_codes) + code_table(codes)],
    };
  }
}
