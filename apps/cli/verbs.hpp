// The verbs of the command line. Each adds itself to the app; the returned function runs it and gives the exit code.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "mansard/base/run.hpp"

namespace mansard::cli {

struct Verb {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

[[nodiscard]] auto reconstruct_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto extrude_verb(CLI::App& app, const base::Cancel& cancel) -> Verb;
[[nodiscard]] auto options_verb(CLI::App& app) -> Verb;
[[nodiscard]] auto explain_verb(CLI::App& app) -> Verb;

}  // namespace mansard::cli
