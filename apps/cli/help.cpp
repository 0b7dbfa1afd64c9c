#include "apps/cli/help.hpp"

#include <algorithm>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/layout.hpp"

namespace mansard::cli {
namespace {

constexpr std::size_t width = 100, widest_margin = 34;

/// "-o, --output OUTDIR". In the short help an option with two long names has the shorter one alone.
auto typed(const Term& term, bool all_names) -> std::string {
  std::vector<std::string> names;
  for (const auto& name : term.names)
    if (!name.starts_with("--")) names.push_back(name);
  std::vector<std::string> long_names;
  for (const auto& name : term.names)
    if (name.starts_with("--")) long_names.push_back(name);
  if (!all_names && long_names.size() > 1) long_names = {std::ranges::min(long_names, {}, &std::string::size)};
  names.insert(names.end(), long_names.begin(), long_names.end());
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  if (!term.value.empty()) text += (text.empty() ? "" : " ") + term.value;
  return text;
}

/// Rows of terms, the explanations in one column.
auto table_of(const std::vector<const Term*>& terms, bool full) -> std::string {
  std::size_t margin = 0;
  for (const auto* term : terms) margin = std::max(margin, columns_of(typed(*term, full)) + 4);
  margin = std::min(margin, widest_margin);
  std::string text;
  for (const auto* term : terms)
    text += term_and_text("  " + typed(*term, full), explained(*term, full), margin, width);
  return text;
}

auto section(const std::string& heading, const std::string& rows) -> std::string {
  return rows.empty() ? "" : "\n" + heading + ":\n" + rows;
}

auto start_of(const Form& form) -> std::string {
  const auto& entry = entry_of(form.verb);
  std::string text;
  for (const auto& line : entry.usage) text += (text.empty() ? "Usage: " : "       ") + line + "\n";
  text += "\n";
  for (const auto& line : wrapped(entry.meaning + ".", width)) text += line + "\n";
  std::vector<const Term*> arguments;
  for (const auto& term : form.arguments) arguments.push_back(&term);
  return text + section("Arguments", table_of(arguments, true));
}

auto examples_of(const Form& form) -> std::string {
  std::string text;
  for (const auto& example : entry_of(form.verb).examples) text += "  " + example + "\n";
  return section("Examples", text);
}

/// Those that the catalogue names, or all of the verb's own.
auto featured(const Form& form) -> std::vector<const Term*> {
  std::vector<const Term*> terms;
  const auto& names = entry_of(form.verb).featured;
  for (const auto& name : names)
    for (const auto& term : form.options)
      if (std::ranges::find(term.names, name) != term.names.end()) terms.push_back(&term);
  if (names.empty())
    for (const auto& term : form.options)
      if (term.module.empty() && term.names.front() != "--help-all") terms.push_back(&term);
  return terms;
}

auto of_module(const Form& form, const std::string& module) -> std::vector<const Term*> {
  std::vector<const Term*> terms;
  for (const auto& term : form.options)
    if (term.module == module && !term.advanced) terms.push_back(&term);
  return terms;
}

}  // namespace

auto first_words() -> std::string {
  return "mansard makes building models of a scan of a city and its building footprints.\n\n"
         "  mansard reconstruct MESH FOOTPRINTS -o models     models of your data\n"
         "  mansard doctor MESH FOOTPRINTS                    whether your data fit together, and with which options\n"
         "  mansard info FILE                                 what a file contains\n"
         "  mansard serve my-project --open                   everything in the browser, with a sample to try\n\n"
         "'mansard --help' lists all verbs.\n";
}

auto overview() -> std::string {
  std::string text =
      "Usage: mansard VERB [arguments] [options]\n\n"
      "Building models from city meshes and footprints: watertight, labelled as wall, roof and ground.\n";
  std::size_t margin = 0;
  for (const auto& entry : catalogue()) margin = std::max(margin, entry.name.size() + 4);
  std::string task;
  for (const auto& entry : catalogue()) {
    if (entry.task != task) text += "\n" + entry.task + ":\n";
    task = entry.task;
    text += term_and_text("  " + entry.name, entry.meaning, margin, width);
  }
  return text +
         "\n'mansard VERB --help' shows how to call a verb, 'mansard explain CODE' what a message means.\n"
         "'mansard --version' prints the version.\n";
}

auto short_help(const Form& form) -> std::string {
  std::string text = start_of(form) + section("Options", table_of(featured(form), false)) + examples_of(form);
  if (entry_of(form.verb).modules.empty()) return text;
  return text + "\nAll options of this verb: 'mansard " + form.verb + " --help-all'. All options: 'mansard options'.\n";
}

auto full_help(const Form& form) -> std::string {
  std::string text = start_of(form) + section("Options", table_of(of_module(form, ""), true));
  for (const auto& module : entry_of(form.verb).modules)
    text += section("Options of the module " + module, table_of(of_module(form, module), true));
  const auto advanced = std::ranges::count_if(form.options, &Term::advanced);
  if (advanced > 0)
    text += "\n" + std::to_string(advanced) + " advanced options are not shown; 'mansard options --all' lists them.\n";
  return text + examples_of(form);
}

}  // namespace mansard::cli
