#include "apps/cli/exit.hpp"

#include <algorithm>
#include <cstdio>

#include "mansard/explore/explore.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/simulate/simulate.hpp"

namespace mansard::cli {

auto give_up(const base::Diagnostic& diagnostic) -> int {
  std::fprintf(stderr, "mansard: %s\n", base::to_string(diagnostic).c_str());
  const auto codes = all_codes();
  const auto at = std::ranges::find(codes, diagnostic.code, &base::Code::code);
  return at == codes.end() || at->exit_code == all_done ? bug : at->exit_code;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"usage", "The command line could not be understood.", "'mansard --help' and 'mansard VERB --help' show the forms.",
       usage},
      {"output-exists", "The output folder holds results already, and nothing is overwritten silently.",
       "Choose another folder, or say --overwrite.", usage},
      {"output-input", "A result would take the place of an input, or lie among the meshes of an input folder.",
       "Choose an output folder apart from the inputs.", usage},
      {"config", "The configuration file is not TOML, or a value in it has the wrong kind.",
       "Options are keys in a table per room: [sweep] gamma = 10.", option_invalid},
      {"code-unknown", "There is no such diagnostic code.", "'mansard explain' alone lists them all.", usage},
  };
}

auto all_codes() -> std::vector<base::Code> {
  auto all = pipeline::codes();
  for (const auto& own : {simulate::codes(), explore::codes(), codes()}) all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace mansard::cli
