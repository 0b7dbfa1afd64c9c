// The canonical footprint: few exact lines instead of many rounded points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/extrude/detail/direction.hpp"
#include "mansard/extrude/detail/numbers.hpp"
#include "mansard/extrude/extrude.hpp"

namespace mansard::extrude::detail {

/// A part of a profile, from its lower knot on. The last part of a track is never horizontal and has no end.
struct TrackPart {
  Rational inward, height;  ///< the lower knot, metres
  Rational slope;           ///< run over rise; 0 for a vertical part
  bool horizontal = false;
  Rational run;            ///< of a horizontal part
  std::uint32_t part = 0;  ///< in the input profile
  friend auto operator==(const TrackPart&, const TrackPart&) -> bool = default;
};
using Track = std::vector<TrackPart>;

/// Quantised, knots on a straight run taken out.
[[nodiscard]] auto track_of(const geometry::Profile& profile) -> Track;

/// All horizontal distances less by one part in 1024.
void shorten_runs(std::vector<Track>& tracks);

struct CanonicalEdge {
  Direction direction;
  Rational offset;  ///< n · x = offset on the edge's line, n = direction turned left, from the footprint's origin
  std::uint32_t track = 0;
  Provenance provenance;            ///< part is not used here
  std::optional<ExactPoint> joint;  ///< the start point where the predecessor lies on the same line
};

struct Footprint {
  std::vector<std::vector<CanonicalEdge>> rings;
  std::vector<std::vector<ExactPoint>> corners;  ///< start point of each edge
  std::vector<Track> tracks;
  geometry::Point2 origin;  ///< whole metres, taken off all coordinates
  double moved = 0;         ///< m; how far the outline moved at its corners, those straightened away included
};

/// A ring of the plan prepared for the kernel: oriented, repeated points dropped, the plan's edges remembered.
struct SourceRing {
  std::vector<geometry::Point2> points;
  std::vector<std::uint32_t> profile;  ///< of edge i
  std::vector<std::uint32_t> edge;     ///< the plan's edge index
};
struct Source {
  std::vector<SourceRing> rings;  ///< outer first
  std::vector<geometry::Profile> profiles;
};

/// Lines, directions and joints for the source; nothing, and why, when the result would not be a simple polygon within
/// tolerance of the source.
[[nodiscard]] auto canonical(const Source& source, const Options& options, std::string& why)
    -> std::optional<Footprint>;

}  // namespace mansard::extrude::detail
