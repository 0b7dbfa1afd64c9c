// Which CRS to work in, and how the footprints get there.
#pragma once

#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/vector/features.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::ingest::detail {

/// From the source's CRS to the working one; both empty when coordinates stay as they are.
struct Way {
  std::string name;  ///< of the working CRS, for Frame::crs
  std::string from, to;
  std::vector<base::Diagnostic> warnings;
};

/// Decides by what the source says, the option, and, for GeoJSON that says nothing, where the mesh lies.
/// `mesh` is the box of the mesh with its offset, as its files have it; `mesh_crs` names the projected CRS that the
/// mesh says it is in, or is empty: footprints in degrees or feet go there. Fails with "ingest-crs-unknown",
/// "ingest-crs-unit", "ingest-crs-option".
[[nodiscard]] auto choose_way(const formats::FeatureFile& file, const std::string& option, const geometry::Box2& mesh,
                              const std::string& mesh_crs, const std::string& subject) -> base::Result<Way>;

/// The same for a mesh alone: by the option, else what the mesh says, else none. Fails with "ingest-crs-option".
[[nodiscard]] auto way_without_features(const std::string& option, const std::string& mesh_crs) -> base::Result<Way>;

/// Takes all points along; where that is not possible they become NaN. Fails with "ingest-crs-unknown".
[[nodiscard]] auto go(const Way& way, std::vector<formats::RawFeature>& features, const std::string& subject)
    -> base::Result<void>;

}  // namespace mansard::ingest::detail
