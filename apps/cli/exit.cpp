#include "apps/cli/exit.hpp"

#include <algorithm>
#include <cstdio>

#include "apps/cli/last_resort.hpp"
#include "apps/server/server.hpp"
#include "lab/explore/explore.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::cli {

auto give_up(const std::vector<base::Diagnostic>& diagnostics) -> int {
  for (const auto& diagnostic : diagnostics) std::fprintf(stderr, "mansard: %s\n", base::to_string(diagnostic).c_str());
  an_error_is_reported();
  const auto codes = all_codes();
  const auto at = std::ranges::find(codes, diagnostics.front().code, &base::Code::code);
  return at == codes.end() || at->exit_code == all_done ? bug : at->exit_code;
}

auto give_up(const base::Diagnostic& diagnostic) -> int { return give_up(std::vector{diagnostic}); }

auto codes() -> std::vector<base::Code> {
  return {
      {"usage", "The command line is not one that a verb accepts.",
       "'mansard --help' lists the verbs, 'mansard VERB --help' shows how to call one.", usage},
      {"option-verb", "The verb does not read this option, so it would have no effect. Other verbs do.",
       "Leave the option out, or use one of the verbs that the message names. A configuration file may set options of "
       "all modules; a verb ignores those that it does not read.",
       usage},
      {"output-exists", "The output already exists, and nothing is overwritten unless asked for.",
       "Choose another output, or add --overwrite.", usage},
      {"output-input", "The output would replace an input, or would be written among the meshes of an input folder.",
       "Choose an output folder outside the inputs.", usage},
      {"output-busy", "Another run works in this output folder, or writes this file.",
       "Wait for its end, or choose another output. 'mansard status OUT' shows how far it is.", usage},
      {"cluster-submit", "The scheduler did not take the jobs.",
       "The scheduler's own message is printed before; the scripts are written and can be submitted by hand.",
       input_unreadable},
      {"status-none", "No run of 'mansard reconstruct' or 'mansard extrude' has worked there, or it kept nothing.",
       "Give what was its -o.", usage},
      {"new-inputs",
       "Among the files that were given to 'mansard new', a mesh and the footprints were not found, or not "
       "without doubt.",
       "Name the meshes and the one file with the footprints.", usage},
      {"new-match", "Mesh and footprints do not match, and no CRS or offset was found with which they do.",
       "Compare their extents with 'mansard info'. Give --crs or --mesh-offset, or --no-check.", input_unreadable},
      {"config", "The configuration file is not valid TOML, or a value in it has the wrong type.",
       "Options are keys in one table for each module: [sweep] gamma = 10.", option_invalid},
      {"code-unknown", "The diagnostic code is unknown.", "'mansard explain' lists all codes.", usage},
  };
}

auto exits() -> std::vector<ExitMeaning> {
  return {{all_done, "success"},
          {some_fell_back, "finished, but some buildings fell back to a simpler model or could not be used"},
          {usage, "the command line is not valid, the output already exists, or the output is an input"},
          {input_unreadable, "an input could not be read, an output could not be written, or memory ran out"},
          {option_invalid, "an option or the configuration file is not valid"},
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
