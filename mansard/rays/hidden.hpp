// Parts of buildings of which a look from above sees hardly more than the crown of a tree.
#pragma once

#include <optional>
#include <span>

namespace mansard::rays {

/// The height of a part of a building that crowns hide for four fifths or more: that from which they rise, which is the
/// tenth percentile, since a crown is highest in its middle. `seen`: heights in metres above the ground, rising, of the
/// samples that no crown hides; `all`: of all samples as they were scanned. None where more is seen, or where less than
/// a quarter of what is seen is ground beside the part, lower than half of that height: then what is seen is roof.
/// Source: docs/decisions/0118.
[[nodiscard]] auto hidden_height(std::span<const double> seen, std::span<const double> all) -> std::optional<double>;

}  // namespace mansard::rays
