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
[[nodiscard]] auto in_metres(std::int64_t quanta) -> Rational;

/// A profile on the grid: parts without extent left out, knots within four quanta of a straight run taken out. The
/// profile of a canonical profile is that profile.
struct CanonicalProfile {
  Track track;
  model::Profile profile;
  std::size_t empty_parts = 0, straight_knots = 0;
};
[[nodiscard]] auto canonical_profile(const model::Profile& profile) -> CanonicalProfile;
[[nodiscard]] auto track_of(const model::Profile& profile) -> Track;
/// Whether they climb alike, whatever the parts are called.
[[nodiscard]] auto same_shape(const Track& p, const Track& q) -> bool;

/// All runs between knots less by `parts` 4096ths, and on the grid again.
void shorten_runs(Track& track, int parts);

/// What a hole's edge goes on with above its wall: the roof of another edge, from a part of its track on.
struct Continues {
  std::uint32_t ring = 0, edge = 0, part = 0;
  friend auto operator==(const Continues&, const Continues&) -> bool = default;
};

struct CanonicalEdge {
  Direction direction;
  Rational offset;  ///< n · x = offset on the edge's line, n = direction turned left, from the footprint's origin
  std::uint32_t track = 0;
  model::Provenance provenance;        ///< part is not used here
  std::optional<ExactPoint> joint;     ///< the start point where the predecessor lies on the same line
  std::optional<Continues> roof = {};  ///< set by continued() alone
};

/// What the canonicaliser did.
struct Tally {
  std::size_t straightened = 0;  ///< corners at shallow turns that are no more
  std::size_t collinear = 0;     ///< the same, exactly between their neighbours
  std::size_t joints = 0;        ///< between neighbours on one line with different profiles
  std::size_t slivers = 0;       ///< edges too short to be one on exact lines, and stretches between joints
};

struct Footprint {
  std::vector<std::vector<CanonicalEdge>> rings;
  std::vector<std::vector<ExactPoint>> corners;  ///< start point of each edge
  std::vector<Track> tracks;
  geometry::Point2 origin;  ///< half metres, taken off all coordinates
  double moved = 0;         ///< m; bound on the Hausdorff distance between this outline and the source's, both ways
  Tally tally;
  bool by_profiles = false;  ///< whether other profiles on the same outline could give other lines
};

/// A ring of the plan prepared for the kernel: oriented, repeated points dropped, the plan's edges remembered.
struct SourceRing {
  std::uint32_t ring = 0;  ///< the plan's: 0 the outer one, 1 … its holes
  std::vector<geometry::Point2> points;
  std::vector<std::uint32_t> profile;  ///< of edge i
  std::vector<std::uint32_t> edge;     ///< the plan's edge index
  friend auto operator==(const SourceRing&, const SourceRing&) -> bool = default;
};
/// An edge of the plan that is no wall (corner_edges.hpp), taken off its ring.
struct CornerEdge {
  std::size_t ring = 0;                 ///< of the source
  geometry::Point2 corner, along;       ///< metres; unit
  std::uint32_t profile = 0, edge = 0;  ///< the plan's edge index
};
struct Source {
  std::vector<SourceRing> rings;  ///< outer first
  std::vector<model::Profile> profiles;
  std::vector<CornerEdge> corner_edges;
  std::size_t repeated_points = 0;  ///< dropped
};

/// Lines, directions and joints for the source; nothing, and why, when the result would not be a simple polygon within
/// tolerance of the source. A source that lies on exact lines already stays as it is. Mirrored in an axis, turned by
/// quarters, shifted by whole metres or started at another corner the source gives the same footprint so treated,
/// exactly (but see bearing_of).
[[nodiscard]] auto canonical(const Source& source, const Options& options, std::string& why)
    -> std::optional<Footprint>;

/// The footprint a little different, for when vertical walls met in one line exactly: attempts 0, 1, … are other
/// combinations of shorter runs and of edges moved inward by a few quanta, each line by another number of them. `how`
/// says so in words. Nothing when the outline would not be simple or would move beyond tolerance.
inline constexpr int most_nudges = 6;
[[nodiscard]] auto nudged(const Footprint& footprint, int attempt, const Options& options, std::string& how)
    -> std::optional<Footprint>;

/// With the edges of holes whose roof is, to within 2 mm, what the slope of another edge does behind them, the
/// outline's or a courtyard's: moved to where they begin exactly in that slope's plane, which need not be a multiple of
/// the grid. Nothing where there are none. `moved`: m, that lines were moved before, each by another distance.
[[nodiscard]] auto continued(const Footprint& footprint, double moved = 0) -> std::optional<Footprint>;

/// The corner where two lines meet that are not parallel.
[[nodiscard]] auto corner_of(const CanonicalEdge& before, const CanonicalEdge& after) -> ExactPoint;
/// Two edges of the outline that cross or touch; exact where doubles leave it open. Places are (ring, edge).
struct Clash {
  std::size_t ring = 0, edge = 0, other_ring = 0, other_edge = 0;
};
[[nodiscard]] auto clash_in(const std::vector<std::vector<ExactPoint>>& corners) -> std::optional<Clash>;

}  // namespace mansard::extrude::detail
