// What is peculiar about OpenStreetMap's files as OGR shows them.
#pragma once

#include <string_view>

#include "mansard/formats/vector/features.hpp"

namespace mansard::formats {

/// The tags that OGR puts into one attribute, `other_tags`, become attributes each, in its place and in their order.
/// Text that is not as OGR writes it stays as it is.
void split_tags(model::Attributes& attributes);

/// "way/17" or "relation/4", as OpenStreetMap names its own; empty where the feature says neither.
[[nodiscard]] auto osm_name(const model::Attributes& attributes) -> std::string;

}  // namespace mansard::formats
