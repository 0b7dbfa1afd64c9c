// The command line as data: what the manual page and the shells' completions are made of.
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
  std::string room;                ///< the room whose option it is; empty of a verb's own
  Takes takes = Takes::nothing;
  std::vector<std::string> words;  ///< of Takes::words: all that can be typed
  std::size_t values = 0;          ///< how many words it takes at most
  bool needs_value = false;        ///< whether a word has to follow: a flag of a room takes "true" or none
  bool required = false;
};

struct Form {
  std::string verb, meaning;
  std::vector<Term> arguments, options;
};

/// Every verb of the program in its order, with all that it takes.
[[nodiscard]] auto forms_of(const CLI::App& app) -> std::vector<Form>;

}  // namespace mansard::cli
