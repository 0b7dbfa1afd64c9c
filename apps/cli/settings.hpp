// Options from the command line over a config file over a preset over the defaults.
#pragma once

#include <CLI/CLI.hpp>
#include <deque>
#include <string>
#include <vector>

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::cli {

/// An option's name as it is typed: with dashes.
[[nodiscard]] auto dashed(std::string text) -> std::string;

/// What can be set: the options, bound to where they are kept, and the presets over them.
struct Menu {
  std::vector<base::OptionList> lists;
  std::vector<pipeline::Preset> presets;
};

/// Every option of every room as `--room-name VALUE` (and its alias), with `--config` and `--preset`.
class Settings {
 public:
  /// Adds the options to a verb. The values are kept as text until apply().
  void add_to(CLI::App& verb);
  /// The same for a verb whose options are none of the pipeline's.
  void add_to(CLI::App& verb, const Menu& menu);

  /// Preset, then config file, then command line. Gives up with "option-unknown", "option-value", "config", "file-…".
  [[nodiscard]] auto apply(pipeline::Options& options) const -> base::Result<void>;
  [[nodiscard]] auto apply(Menu menu) const -> base::Result<void>;

  /// Every name the verb knows, for suggestions.
  [[nodiscard]] static auto names(const CLI::App& verb) -> std::vector<std::string>;

 private:
  struct Given {
    std::string key;  // room.name
    std::vector<std::string> words;
    bool flag = false;
    CLI::Option* option = nullptr;
  };
  std::deque<Given> given_;  // stable addresses: CLI11 writes into them
  std::string config_, preset_;
};

}  // namespace mansard::cli
