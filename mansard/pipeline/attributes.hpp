// What the attributes of a reconstruction's models mean.
#pragma once

#include "mansard/formats/attributes.hpp"

namespace mansard::pipeline {

/// Those of `write`, and those that tell how a model was made and what it measures.
[[nodiscard]] auto attributes() -> std::vector<formats::Attribute>;

}  // namespace mansard::pipeline
