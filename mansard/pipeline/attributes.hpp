// What the attributes of a reconstruction's models mean.
#pragma once

#include "mansard/write/attributes.hpp"

namespace mansard::pipeline {

/// Those of `write`, and those that tell how a model was made and what it measures.
[[nodiscard]] auto attributes() -> std::vector<write::Attribute>;

}  // namespace mansard::pipeline
