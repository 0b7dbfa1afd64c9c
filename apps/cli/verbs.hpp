// The verbs of the command line. Each adds itself to the app; the returned function runs it and gives the exit code.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "mansard/base/run.hpp"

namespace mansard::cli {

struct Verb {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

/// `words` are the whole command line, here and below: messages and reports repeat it.
[[nodiscard]] auto reconstruct_verb(CLI::App& app, std::vector<std::string> words, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto segment_verb(CLI::App& app, std::vector<std::string> words, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto extrude_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto simulate_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto evaluate_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto compare_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto report_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto label_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto explore_verb(CLI::App& app, std::vector<std::string> words, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto convert_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto info_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto doctor_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto new_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto serve_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto review_verb(CLI::App& app) -> Verb;
[[nodiscard]] auto cluster_verb(CLI::App& app) -> Verb;
[[nodiscard]] auto status_verb(CLI::App& app) -> Verb;
[[nodiscard]] auto options_verb(CLI::App& app) -> Verb;
[[nodiscard]] auto explain_verb(CLI::App& app) -> Verb;
/// These two tell of the whole app, once every verb is in it.
[[nodiscard]] auto completion_verb(CLI::App& app) -> Verb;
[[nodiscard]] auto manual_verb(CLI::App& app) -> Verb;

}  // namespace mansard::cli
