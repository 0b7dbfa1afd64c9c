// The command line as data: what the help, the manual page and the shells' completions are made of.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mansard::cli {

/// What is typed behind an option, or in the place of an argument.
enum class Takes { nothing, text, words, path, folder };

/// An option, or an argument without dashes.
struct Term {
  std::vector<std::string> names;  ///< "--output", "-o": long names first; empty of an argument
  std::string value;               ///< what its value is called ("OUTDIR"); empty where nothing is typed
  std::string meaning;             ///< a sentence
  std::string module;              ///< the module whose option it is; empty of a verb's own
  std::string unit, range;         ///< "m²", "0 to 1e6"; empty for none
  std::string initial;             ///< the value without this option; empty for none
  Takes takes = Takes::nothing;
  std::vector<std::string> words;  ///< of Takes::words: all that can be typed
  std::size_t values = 0;          ///< how many words it takes at most
  bool needs_value = false;        ///< whether a word has to follow: a flag of a module takes "true" or none
  bool required = false;
  bool advanced = false;  ///< accepted, but listed by `mansard options --all` only
};

struct Form {
  std::string verb, meaning;
  std::vector<Term> arguments, options;
};

/// Every verb of the program in its order, with all that it takes.
[[nodiscard]] auto forms_of(const CLI::App& app) -> std::vector<Form>;
[[nodiscard]] auto form_of(const CLI::App& verb) -> Form;

/// The meaning with unit and default behind it. Where `full`, with the range and the words that can be typed too; else,
/// of a verb's own option, without what its meaning has in parentheses.
[[nodiscard]] auto explained(const Term& term, bool full) -> std::string;

}  // namespace mansard::cli
