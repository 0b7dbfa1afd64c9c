// What the attributes of a feature and of its parts say of their models.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/model/footprint.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// What the attributes of a feature say, or those of one of its parts.
struct Said {
  roof::Form form;
  roof::Paint paint;
  std::vector<base::Diagnostic> warnings;
};
struct SaidOf {
  Said whole;
  std::vector<Said> parts;   ///< as Footprint::parts
  bool with_outline = true;  ///< whether the outline itself is extruded
};

/// What is said of a feature and of its parts. Where one profile is given for every edge, it is of the outline alone.
[[nodiscard]] auto said_of(const model::Footprint& footprint, const Options& options, bool by_attributes) -> SaidOf;

/// The least sure of what the heights of a building's parts come from.
[[nodiscard]] auto source_of(const SaidOf& said) -> roof::Source;

/// What the parts of an outline leave of it, and what they cover besides, m².
struct Cover {
  double outline = 0, left = 0, beyond = 0;
};
/// None where that cannot be computed.
[[nodiscard]] auto cover_of(const model::Footprint& footprint) -> std::optional<Cover>;
/// What is more than 1 m² and 1 % of the outline; empty for nothing.
[[nodiscard]] auto in_words(const Cover& cover) -> std::string;

/// "#b03020"
[[nodiscard]] auto in_hex(const roof::Colour& colour) -> std::string;

}  // namespace mansard::pipeline::detail
