// The ground of a footprint that no part of another one takes.
#pragma once

#include <span>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::pipeline::detail {

struct Uncovered {
  std::vector<geometry::Polygon> polygons;  ///< simple
  std::vector<base::Diagnostic> warnings;   ///< "pipeline-cover-unchecked", without a subject
};

/// What is left of the footprint's polygons once the outlines are taken off, without slivers. A polygon from which an
/// outline cannot be subtracted stays as it is, with a warning: rather two models on the same ground than none.
[[nodiscard]] auto uncovered(std::span<const geometry::Polygon> footprint, std::span<const geometry::Polygon> outlines)
    -> Uncovered;

}  // namespace mansard::pipeline::detail
