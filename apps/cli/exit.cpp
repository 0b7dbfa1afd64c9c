#include "apps/cli/exit.hpp"

#include <algorithm>
#include <cstdio>

#include "apps/server/server.hpp"
#include "lab/explore/explore.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::cli {

auto give_up(const base::Diagnostic& diagnostic) -> int {
  std::fprintf(stderr, "mansard: %s\n", base::to_string(diagnostic).c_str());
  const auto codes = all_codes();
  const auto at = std::ranges::find(codes, diagnostic.code, &base::Code::code);
  return at == codes.end() || at->exit_code == all_done ? bug : at->exit_code;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"usage", "The command line could not be understood.",
       "'mansard --help' and 'mansard VERB --help' show the forms.", usage},
      {"output-exists", "The output folder holds results already, and nothing is overwritten silently.",
       "Choose another folder, or say --overwrite.", usage},
      {"output-input", "A result would take the place of an input, or lie among the meshes of an input folder.",
       "Choose an output folder apart from the inputs.", usage},
      {"config", "The configuration file is not TOML, or a value in it has the wrong kind.",
       "Options are keys in a table per room: [sweep] gamma = 10.", option_invalid},
      {"code-unknown", "There is no such diagnostic code.", "'mansard explain' alone lists them all.", usage},
  };
}

auto exits() -> std::vector<ExitMeaning> {
  return {{all_done, "all done"},
          {some_fell_back, "finished; some buildings fell back to a simpler model or could not be used"},
          {usage, "the command line could not be understood, or the output exists or is an input"},
          {input_unreadable, "an input could not be read, a result not written, or memory ran out"},
          {option_invalid, "an option or the configuration file is invalid"},
          {nothing_reconstructed, "nothing could be reconstructed"},
          {cancelled, "cancelled"},
          {bug, "a bug; please report it"}};
}

auto all_codes() -> std::vector<base::Code> {
  auto all = pipeline::codes();
  for (const auto& own : {edit::codes(), simulate::codes(), explore::codes(), server::codes(), codes()})
    all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace mansard::cli
