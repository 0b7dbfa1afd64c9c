// `mansard options` and `mansard explain`: the program describes itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <variant>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/exit.hpp"
#include "apps/cli/grammar.hpp"
#include "apps/cli/layout.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "lab/simulate/attributes.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/edit/attributes.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/attributes.hpp"
#include "mansard/report/changes.hpp"
#include "mansard/report/review.hpp"

namespace mansard::cli {
namespace {

using Json = nlohmann::ordered_json;

auto kind_name(base::Option::Kind kind) -> const char* {
  switch (kind) {
    case base::Option::Kind::flag: return "boolean";
    case base::Option::Kind::integer: return "integer";
    case base::Option::Kind::number: return "number";
    case base::Option::Kind::string: return "string";
    case base::Option::Kind::choice: return "choice";
  }
  return "";
}

/// The options of all modules: those that make models, then `compare` and `simulate`.
struct Known {
  pipeline::Options pipeline;
  compare::Options compare;
  simulate::Options simulate;
  std::vector<base::OptionList> lists = pipeline::option_lists(pipeline);
  std::vector<pipeline::Preset> presets = pipeline::presets(), simulate_presets;

  Known() {
    lists.push_back(compare::option_list(compare));
    lists.push_back(simulate::option_list(simulate));
    for (const auto& preset : simulate::presets())
      simulate_presets.push_back({preset.name, preset.meaning, preset.values});
  }
};

void print_presets(const char* of, const std::vector<pipeline::Preset>& presets) {
  std::printf("\n%s:\n", of);
  for (const auto& preset : presets) {
    std::printf("  %-14s %s\n", preset.name.c_str(), preset.meaning.c_str());
    for (const auto& [key, value] : preset.values) std::printf("    %s = %s\n", key.c_str(), value.c_str());
  }
}

/// Name, default, unit, range, meaning.
using Row = std::array<std::string, 5>;

auto or_dash(const std::string& text) -> std::string { return text.empty() ? "-" : text; }

auto row_of(const base::Option& option) -> Row {
  std::string meaning = option.meaning;
  if (option.kind == base::Option::Kind::choice) meaning += " Values: " + listed(option.choices, "or") + ".";
  if (!option.alias.empty()) meaning += " Short: --" + dashed(option.alias) + ".";
  const std::string range = option.kind == base::Option::Kind::flag ? "true, false" : range_text(option);
  return {option.name, or_dash(option.get()), or_dash(option.unit), or_dash(range), meaning};
}

/// Rows whose columns are as wide as the widest of all of them, under lines of their own.
class Table {
 public:
  void add(std::string heading) { lines_.emplace_back(std::move(heading)); }
  void add(Row row) {
    for (std::size_t c = 0; c < widths_.size(); ++c) widths_[c] = std::max(widths_[c], columns_of(row[c]));
    lines_.emplace_back(std::move(row));
  }
  void print() const {
    for (const auto& line : lines_) {
      if (const auto* heading = std::get_if<std::string>(&line)) {
        std::printf("%s\n", heading->c_str());
        continue;
      }
      const auto& row = std::get<Row>(line);
      std::string text;
      for (std::size_t c = 0; c < widths_.size(); ++c) text += "  " + padded(row[c], widths_[c]);
      std::printf("%s  %s\n", text.c_str(), row.back().c_str());
    }
  }

 private:
  std::vector<std::variant<std::string, Row>> lines_;
  std::array<std::size_t, 4> widths_{};
};

/// One line for each option; with `all` the advanced ones too, and a second line that says where the default comes
/// from.
void print_text(const Known& known, bool all) {
  Table table;
  table.add(Row{"option", "default", "unit", "range", "meaning"});
  std::size_t hidden = 0;
  for (const auto& list : known.lists) {
    if (!list.options().empty()) table.add("[" + list.module() + "]");
    for (const auto& option : list.options()) {
      if (option.advanced && !all) {
        ++hidden;
        continue;
      }
      table.add(row_of(option));
      const std::string source = option.source.empty() ? "" : "Source: " + option.source;
      const std::string advanced = option.advanced ? "Advanced. " : "";
      if (all && !(advanced + source).empty()) table.add(Row{"", "", "", "", advanced + source});
    }
  }
  table.print();
  if (hidden > 0) std::printf("\n%zu advanced options are not shown; 'mansard options --all' lists them.\n", hidden);
  print_presets("Presets", known.presets);
  print_presets("Presets of simulate", known.simulate_presets);
}

auto json_of(const std::vector<pipeline::Preset>& presets) -> Json {
  Json out = Json::array();
  for (const auto& preset : presets) {
    Json values = Json::object();
    for (const auto& [key, value] : preset.values) values[key] = value;
    out.push_back({{"name", preset.name}, {"meaning", preset.meaning}, {"values", values}});
  }
  return out;
}

auto json_of(const Term& term) -> Json {
  return {{"names", term.names},     {"value", term.value},   {"required", term.required},
          {"meaning", term.meaning}, {"unit", term.unit},     {"default", term.initial},
          {"words", term.words},     {"module", term.module}, {"advanced", term.advanced}};
}

auto json_of(const std::vector<Form>& forms, bool all) -> Json {
  Json out = Json::array();
  for (const auto& form : forms) {
    const auto& described = entry_of(form.verb);
    Json entry{{"verb", form.verb},          {"task", described.task},         {"meaning", form.meaning},
               {"usage", described.usage},   {"examples", described.examples}, {"modules", described.modules},
               {"arguments", Json::array()}, {"options", Json::array()}};
    for (const auto& term : form.arguments) entry["arguments"].push_back(json_of(term));
    for (const auto& term : form.options)
      if (all || !term.advanced) entry["options"].push_back(json_of(term));
    out.push_back(std::move(entry));
  }
  return out;
}

auto json_of(const std::string& module, const base::Option& option) -> Json {
  const auto bound = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  return {{"module", module},
          {"name", option.name},
          {"kind", kind_name(option.kind)},
          {"unit", option.unit},
          {"minimum", bound(option.range.minimum)},
          {"maximum", bound(option.range.maximum)},
          {"choices", option.choices},
          {"default", option.get()},
          {"alias", option.alias},
          {"meaning", option.meaning},
          {"advanced", option.advanced},
          {"source", option.source}};
}

void print_json(const Known& known, const CLI::App& app, bool all) {
  Json out;
  Json options = Json::array();
  for (const auto& list : known.lists)
    for (const auto& option : list.options())
      if (all || !option.advanced) options.push_back(json_of(list.module(), option));
  out["options"] = options;
  out["presets"] = json_of(known.presets);
  out["simulate_presets"] = json_of(known.simulate_presets);
  out["verbs"] = json_of(forms_of(app), all);
  std::puts(out.dump(1).c_str());
}

auto all_attributes() -> std::vector<formats::Attribute> {
  auto all = report::attributes();
  for (const auto& own :
       {report::change_attribute_list(), edit::attributes(), report::review_attributes(), simulate::attributes()})
    all.insert(all.end(), own.begin(), own.end());
  return all;
}

void print_attributes(bool as_json) {
  Json out;
  for (const auto& attribute : all_attributes()) {
    std::string objects;
    for (const auto& object : attribute.of) objects += (objects.empty() ? "" : ", ") + object;
    out["attributes"].push_back({{"name", attribute.name},
                                 {"module", attribute.module},
                                 {"of", attribute.of},
                                 {"type", attribute.type},
                                 {"unit", attribute.unit},
                                 {"meaning", attribute.meaning}});
    if (!as_json)
      std::printf("%-20s %-8s %-3s %s  (%s)\n", attribute.name.c_str(), attribute.type.c_str(), attribute.unit.c_str(),
                  attribute.meaning.c_str(), objects.c_str());
  }
  if (as_json) std::puts(out.dump(1).c_str());
}

void print_json(const std::vector<base::Code>& codes) {
  Json out;
  for (const auto& code : codes)
    out["codes"].push_back(
        {{"code", code.code}, {"cause", code.cause}, {"remedy", code.remedy}, {"exit_code", code.exit_code}});
  for (const auto& exit : exits()) out["exit_codes"].push_back({{"exit_code", exit.code}, {"when", exit.when}});
  std::puts(out.dump(1).c_str());
}

auto explain(const std::string& word) -> int {
  const auto codes = all_codes();
  if (word.empty()) {
    for (const auto& code : codes) std::printf("%-28s %s\n", code.code.c_str(), code.cause.c_str());
    return all_done;
  }
  const auto at = std::ranges::find(codes, word, &base::Code::code);
  if (at == codes.end()) {
    std::vector<std::string> known;
    for (const auto& code : codes) known.push_back(code.code);
    const auto nearest = base::nearest_word(word, known);
    return give_up(
        base::error("code-unknown", "unknown code; see 'mansard explain'" + base::did_you_mean(nearest), word));
  }
  std::printf("%s\n  cause: %s\n  remedy: %s\n  exit code: %d\n", at->code.c_str(), at->cause.c_str(),
              at->remedy.c_str(), at->exit_code);
  return all_done;
}

}  // namespace

auto options_verb(CLI::App& app) -> Verb {
  auto* verb = add_verb(app, "options");
  struct Request {
    bool all = false, json = false, attributes = false;
  };
  auto request = std::make_shared<Request>();
  auto* all = verb->add_flag("--all", request->all, "Also list advanced options, and where each default comes from");
  verb->add_flag("--json", request->json, "Print JSON, with the presets and with the options of each verb");
  verb->add_flag("--attributes", request->attributes, "List the attributes of models instead, with type and unit")
      ->excludes(all);
  return {verb, [request, &app] {
            const Known known;
            if (request->attributes) print_attributes(request->json);
            else if (request->json) print_json(known, app, request->all);
            else print_text(known, request->all);
            return static_cast<int>(all_done);
          }};
}

auto explain_verb(CLI::App& app) -> Verb {
  auto* verb = add_verb(app, "explain");
  auto code = std::make_shared<std::string>();
  auto* argument = verb->add_option(
      "CODE", *code, "Diagnostic code, as an error names it in brackets; without it, all codes are listed");
  auto json = std::make_shared<bool>(false);
  auto* as_json = verb->add_flag("--json", *json, "Print all codes and all exit codes as JSON");
  as_json->excludes(argument);
  return {verb, [code, json] {
            if (!*json) return explain(*code);
            print_json(all_codes());
            return static_cast<int>(all_done);
          }};
}

}  // namespace mansard::cli
