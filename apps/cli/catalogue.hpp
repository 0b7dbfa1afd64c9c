// The verbs in one table: what each is for, which modules' options it reads, and what its help shows first.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace mansard::cli {

struct VerbEntry {
  std::string name;
  std::string task;                   ///< the heading above it in `mansard --help`
  std::string meaning;                ///< one sentence, without a full stop
  std::vector<std::string> usage;     ///< command lines, one for each form
  std::vector<std::string> modules;   ///< whose options it reads; an option of any other module is refused
  std::vector<std::string> featured;  ///< what `--help` shows of the options, in this order; empty for the verb's own
  std::vector<std::string> examples;
};

/// In the order of `mansard --help`; the verbs of a task stand together.
[[nodiscard]] auto catalogue() -> const std::vector<VerbEntry>&;
/// The verb must be in the catalogue.
[[nodiscard]] auto entry_of(std::string_view verb) -> const VerbEntry&;

/// Adds the verb with its meaning, and with --help and --help-all.
[[nodiscard]] auto add_verb(CLI::App& app, const std::string& name) -> CLI::App*;

}  // namespace mansard::cli
