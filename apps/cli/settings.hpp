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

/// "0.01 to 10"; empty where any value will do.
[[nodiscard]] auto range_text(const base::Option& option) -> std::string;

/// What can be set: the options, bound to where they are kept, and the presets over them.
struct Menu {
  std::vector<base::OptionList> lists;
  std::vector<pipeline::Preset> presets;
};

/// The options of the modules that a verb reads as `--module-name VALUE` (and the alias), with `--config` and, where a
/// preset changes one of them, `--preset`. A configuration file may have tables of the other modules too: verbs share
/// it.
class Settings {
 public:
  /// Adds the options to a verb of the catalogue. The values are kept as text until apply().
  void add_to(CLI::App& verb);
  /// The same for a verb whose options are not those of the pipeline.
  void add_to(CLI::App& verb, const Menu& menu);

  /// Preset, then configuration file, then command line; reports everything that is wrong. Fails with
  /// "option-unknown", "option-value", "config", "file-…".
  [[nodiscard]] auto apply(pipeline::Options& options) const -> base::Result<void>;
  [[nodiscard]] auto apply(Menu menu) const -> base::Result<void>;

  /// The options that were typed, " --layer buildings --up y", as a shell takes them; without those of the named keys
  /// ("ingest.crs").
  [[nodiscard]] auto typed(const std::vector<std::string>& without) const -> std::string;

 private:
  struct Given {
    std::string key;  // module.name
    std::vector<std::string> words;
    bool flag = false;
    CLI::Option* option = nullptr;
  };
  void add_list(CLI::App& verb, const base::OptionList& list);

  std::deque<Given> given_;  // stable addresses: CLI11 writes into them
  std::string config_, preset_;
};

}  // namespace mansard::cli
