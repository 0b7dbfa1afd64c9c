// `mansard options` and `mansard explain`: the product describes itself.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/cli/exit.hpp"
#include "apps/cli/grammar.hpp"
#include "apps/cli/settings.hpp"
#include "apps/cli/verbs.hpp"
#include "lab/simulate/attributes.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/edit/attributes.hpp"
#include "mansard/pipeline/attributes.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::cli {
namespace {

using Json = nlohmann::ordered_json;

auto kind_name(base::Option::Kind kind) -> const char* {
  switch (kind) {
    case base::Option::Kind::flag: return "flag";
    case base::Option::Kind::integer: return "whole";
    case base::Option::Kind::number: return "number";
    case base::Option::Kind::string: return "text";
    case base::Option::Kind::choice: return "choice";
  }
  return "";
}

auto range_text(const base::Option& option) -> std::string {
  if (option.kind == base::Option::Kind::choice || option.kind == base::Option::Kind::flag) {
    std::string all;
    for (const auto& word : option.choices) all += (all.empty() ? "" : "|") + word;
    return all;
  }
  const auto& [least, most] = option.range;
  const auto bound = [](double value) { return std::isfinite(value) ? base::to_text(value) : std::string(); };
  if (!std::isfinite(least) && !std::isfinite(most)) return "";
  return bound(least) + ".." + bound(most);
}

/// The options of the rooms that make models, and those of `simulate`.
struct Known {
  pipeline::Options pipeline;
  simulate::Options simulate;
  std::vector<base::OptionList> lists = pipeline::option_lists(pipeline);
  std::vector<pipeline::Preset> presets = pipeline::presets(), simulate_presets;

  Known() {
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

void print_text(const Known& known) {
  for (const auto& list : known.lists) {
    if (list.options().empty()) continue;
    std::printf("[%s]\n", list.module().c_str());
    for (const auto& option : list.options())
      std::printf("  %-16s %-10s %-4s %-18s %s%s\n", option.name.c_str(),
                  option.get().empty() ? "-" : option.get().c_str(), option.unit.c_str(), range_text(option).c_str(),
                  option.meaning.c_str(), option.alias.empty() ? "" : ("  (--" + dashed(option.alias) + ")").c_str());
  }
  print_presets("presets", known.presets);
  print_presets("presets of simulate", known.simulate_presets);
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
  return {{"names", term.names},
          {"value", term.value},
          {"required", term.required},
          {"meaning", term.meaning},
          {"room", term.room}};
}

auto json_of(const std::vector<Form>& forms) -> Json {
  Json out = Json::array();
  for (const auto& form : forms) {
    Json entry{
        {"verb", form.verb}, {"meaning", form.meaning}, {"arguments", Json::array()}, {"options", Json::array()}};
    for (const auto& term : form.arguments) entry["arguments"].push_back(json_of(term));
    for (const auto& term : form.options) entry["options"].push_back(json_of(term));
    out.push_back(std::move(entry));
  }
  return out;
}

void print_json(const Known& known, const CLI::App& app) {
  Json out;
  Json options = Json::array();
  for (const auto& list : known.lists)
    for (const auto& option : list.options()) {
      const auto bound = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
      options.push_back({{"room", list.module()},
                         {"name", option.name},
                         {"kind", kind_name(option.kind)},
                         {"unit", option.unit},
                         {"least", bound(option.range.minimum)},
                         {"most", bound(option.range.maximum)},
                         {"choices", option.choices},
                         {"default", option.get()},
                         {"alias", option.alias},
                         {"meaning", option.meaning}});
    }
  out["options"] = options;
  out["presets"] = json_of(known.presets);
  out["simulate_presets"] = json_of(known.simulate_presets);
  out["verbs"] = json_of(forms_of(app));
  std::puts(out.dump(1).c_str());
}

auto all_attributes() -> std::vector<formats::Attribute> {
  auto all = pipeline::attributes();
  for (const auto& own : {edit::attributes(), simulate::attributes()}) all.insert(all.end(), own.begin(), own.end());
  return all;
}

void print_attributes(bool as_json) {
  Json out;
  for (const auto& attribute : all_attributes()) {
    std::string objects;
    for (const auto& object : attribute.of) objects += (objects.empty() ? "" : ", ") + object;
    out["attributes"].push_back({{"name", attribute.name},
                                 {"room", attribute.room},
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
        {{"code", code.code}, {"means", code.cause}, {"to_do", code.remedy}, {"exit_code", code.exit_code}});
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
    return give_up(base::error("code-unknown", "there is no such code" + base::did_you_mean(nearest), word));
  }
  std::printf("%s\n  means: %s\n  to do: %s\n  exit code: %d\n", at->code.c_str(), at->cause.c_str(),
              at->remedy.c_str(), at->exit_code);
  return all_done;
}

}  // namespace

auto options_verb(CLI::App& app) -> Verb {
  auto* verb = app.add_subcommand("options", "List every option with unit, range and default");
  auto json = std::make_shared<bool>(false), attributes = std::make_shared<bool>(false);
  verb->add_flag("--json", *json, "As JSON, with what every verb takes");
  verb->add_flag("--attributes", *attributes, "The attributes of models instead, with type, unit and meaning");
  return {verb, [json, attributes, &app] {
            const Known known;
            if (*attributes) print_attributes(*json);
            else if (*json) print_json(known, app);
            else print_text(known);
            return static_cast<int>(all_done);
          }};
}

auto explain_verb(CLI::App& app) -> Verb {
  auto* verb = app.add_subcommand("explain", "Say what a diagnostic code means and what to do");
  auto code = std::make_shared<std::string>();
  auto* argument = verb->add_option("CODE", *code, "The code; without it, all codes are listed");
  auto json = std::make_shared<bool>(false);
  auto* as_json = verb->add_flag("--json", *json, "All codes, and the exit codes, as JSON");
  as_json->excludes(argument);
  return {verb, [code, json] {
            if (!*json) return explain(*code);
            print_json(all_codes());
            return static_cast<int>(all_done);
          }};
}

}  // namespace mansard::cli
