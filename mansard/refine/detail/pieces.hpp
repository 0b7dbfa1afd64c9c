// Plans cut in two and joined: each with the profiles of the edges that it keeps.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mansard/refine/detail/site.hpp"

namespace mansard::refine::detail {

/// Both polygons with common corners where they meet: corners of the second that are near to one of the first take its
/// place, and edges of each pass through the corners of the other that are near to them. Their edges are then equal
/// instead of crossing or missing each other as rounding has it.
[[nodiscard]] auto fitted(const geometry::Polygon& a, const geometry::Polygon& b, const Options::Pieces& options)
    -> std::pair<geometry::Polygon, geometry::Polygon>;

/// What a polygon operation leaves, without slivers narrower than `slit`, without corners and spikes nearer than
/// `straight` to the line between their neighbours, and in two where it has a neck of no width: whether those are there
/// is a matter of rounding.
[[nodiscard]] auto tidied(std::vector<geometry::Polygon> overlay, const Options::Pieces& options)
    -> std::vector<geometry::Polygon>;

/// The part without the structure, then the structure, largest first; empty where a piece would be too small, narrower
/// than `narrowest` (m; else Options::Pieces::min_width) or not simple.
[[nodiscard]] auto cut(const geometry::Polygon& part, const geometry::Polygon& structure, const Options& options,
                       std::optional<double> narrowest = {}) -> std::vector<geometry::Polygon>;

/// Two parts with a common edge as one; none where that is no simple polygon.
[[nodiscard]] auto joined(const geometry::Polygon& a, const geometry::Polygon& b, const Options& options)
    -> std::optional<geometry::Polygon>;

/// A draft with the roof that was found for it.
struct Origin {
  const Draft& draft;
  const model::Plan& roof;
};
/// Edges on the origins' edges carry what those carry and may carry what those may, all others are walls. Caps by the
/// site's heights.
[[nodiscard]] auto draft_of(std::span<const Origin> origins, const Site& piece, const Options& options) -> Draft;

/// m; of all rings.
[[nodiscard]] auto around(const geometry::Polygon& polygon) -> double;
/// m; of the polygon's area over half of its perimeter.
[[nodiscard]] auto mean_width(const geometry::Polygon& polygon) -> double;

}  // namespace mansard::refine::detail
