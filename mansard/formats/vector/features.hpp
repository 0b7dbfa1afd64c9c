// Features as the vector source has them, in its coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/files/address.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/attributes.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// The shell, then the holes, in any orientation and state; ends may repeat starts.
using RawPolygon = std::vector<geometry::Ring>;

struct RawFeature {
  std::int64_t number = 0;  ///< the source's own number of the feature (OGR's FID)
  std::string own_id;       ///< where the kind of source itself has names for its features; else empty
  model::Attributes attributes;
  std::vector<RawPolygon> parts;
  std::optional<double> lowest;  ///< z of the lowest corner; none in two dimensions, and where all are 0
  std::string geometry;          ///< what kind it has in the source, "NONE" for none
  bool other_geometry = false;   ///< there are points, lines or solids in it
  std::string failure;           ///< what went wrong when it was read; empty for nothing
  bool passes = true;            ///< the filter of the query
};

struct FeatureFile {
  std::vector<RawFeature> features;
  std::string crs;  ///< WKT; empty when the source has none
  /// GeoJSON without a "crs" member: its CRS is WGS 84 by RFC 7946, but many such files hold local metres.
  bool assumed_crs = false;
  std::string crs_failure;  ///< why the CRS that the file names is not known; empty when it is, or none is named
  std::vector<model::InputFile> inputs;
  std::vector<base::Diagnostic> warnings;
};

/// What is wanted of a vector source.
struct FeatureQuery {
  std::string layer;    ///< empty: its only or first one
  std::string where;    ///< OGR SQL attribute filter
  bool others = false;  ///< also what does not pass the filter, with RawFeature::passes false; fails where nothing does
  std::string crs;      ///< the working CRS that was asked for, in which `bbox` is given; empty: the source's own
  std::array<double, 4> bbox{0, 0, 0, 0};  ///< xmin ymin xmax ymax; all zero: everything
  std::string encoding{};                  ///< of texts that are not UTF-8; empty: what the source says
};

/// Reads the chosen layer of any OGR vector source: polygons with curves as segments, and of their
/// heights the lowest. With `options.bbox`, features that cannot meet it may be left out already, but never all. A
/// database and what lies on a server is known by the hash of its features, in the order of their numbers.
/// Fails with "file-missing", "file-read", "ingest-footprints-format", "ingest-footprints-none",
/// "ingest-footprints-geometry", "ingest-layer", "ingest-where", "ingest-encoding", "cancelled".
[[nodiscard]] auto read_features(const std::filesystem::path& path, const FeatureQuery& options, const base::Run& run)
    -> base::Result<FeatureFile>;

/// Of all points that are on the earth, in the source's coordinates.
[[nodiscard]] auto bounds(const RawFeature& feature) -> geometry::Box2;
[[nodiscard]] auto bounds(const std::vector<RawFeature>& features) -> geometry::Box2;

}  // namespace mansard::formats
