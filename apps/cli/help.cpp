#include "apps/cli/help.hpp"

#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <cstdlib>

#include "apps/cli/catalogue.hpp"
#include "apps/cli/layout.hpp"
#include "mansard/base/text.hpp"

namespace mansard::cli {
namespace {

/// Of lines: those of the terminal, or what COLUMNS says, within limits; 100 where neither is known.
auto width() -> std::size_t {
  constexpr std::size_t least = 60, most = 100;
  winsize size{};
  if (::isatty(STDOUT_FILENO) == 1 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    return std::clamp<std::size_t>(size.ws_col, least, most);
  const auto* given = std::getenv("COLUMNS");
  const auto columns = given == nullptr ? std::nullopt : base::to_integer(given);
  return columns && *columns > 0 ? std::clamp(static_cast<std::size_t>(*columns), least, most) : most;
}

/// Of the column of terms: a third of the line at most.
auto widest_margin() -> std::size_t { return width() * 34 / 100; }

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
  margin = std::min(margin, widest_margin());
  std::string text;
  for (const auto* term : terms)
    text += term_and_text("  " + typed(*term, full), explained(*term, full), margin, width());
  return text;
}

auto on_lines(const std::string& sentences) -> std::string {
  std::string text;
  for (const auto& line : wrapped(sentences, width())) text += line + "\n";
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
  text += on_lines(entry.meaning + ".");
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
         "  mansard new PROJECT MESH FOOTPRINTS            check your data, make a project\n"
         "  mansard reconstruct MESH FOOTPRINTS -o models  make the models\n"
         "  mansard doctor MESH FOOTPRINTS                 which options your data need\n"
         "  mansard info FILE                              what a file contains\n"
         "  mansard serve PROJECT --open                   everything in the browser\n\n"
         "'mansard --help' lists all verbs.\n";
}

auto overview() -> std::string {
  std::string text =
      "Usage: mansard VERB [arguments] [options]\n\n" +
      on_lines("Building models from city meshes and footprints: watertight, labelled as wall, roof and ground.");
  std::size_t margin = 0;
  for (const auto& entry : catalogue()) margin = std::max(margin, entry.name.size() + 4);
  std::string task;
  for (const auto& entry : catalogue()) {
    if (entry.task != task) text += "\n" + entry.task + ":\n";
    task = entry.task;
    text += term_and_text("  " + entry.name, entry.meaning, margin, width());
  }
  return text + "\n" +
         on_lines(
             "'mansard VERB --help' shows how to call a verb, 'mansard explain CODE' what a message means. "
             "'mansard --version' prints the version.");
}

auto short_help(const Form& form) -> std::string {
  std::string text = start_of(form) + section("Options", table_of(featured(form), false)) + examples_of(form);
  if (entry_of(form.verb).modules.empty()) return text;
  return text + "\n" +
         on_lines("All options of this verb: 'mansard " + form.verb + " --help-all'. All options: 'mansard options'.");
}

auto full_help(const Form& form) -> std::string {
  std::string text = start_of(form) + section("Options", table_of(of_module(form, ""), true));
  for (const auto& module : entry_of(form.verb).modules)
    text += section("Options of the module " + module, table_of(of_module(form, module), true));
  const auto advanced = std::ranges::count_if(form.options, &Term::advanced);
  if (advanced > 0)
    text += "\n" +
            on_lines(std::to_string(advanced) + " advanced options are not shown; 'mansard options --all' lists them.");
  return text + examples_of(form);
}

}  // namespace mansard::cli
