// The command line of the benchmarks of edits: MESH FOOTPRINTS [MODULE.OPTION=VALUE…].
#pragma once

#include <string>

#include "mansard/pipeline/pipeline.hpp"

namespace bench {

/// Options by their words, those after MESH and FOOTPRINTS.
inline auto options_of(int argc, char** argv) -> mansard::base::Result<mansard::pipeline::Options> {
  mansard::pipeline::Options options;
  auto lists = mansard::pipeline::option_lists(options);
  for (int i = 3; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equals = word.find('=');
    if (auto set = mansard::pipeline::set_option(lists, word.substr(0, equals), word.substr(equals + 1)); !set)
      return set.error();
  }
  return options;
}

}  // namespace bench
