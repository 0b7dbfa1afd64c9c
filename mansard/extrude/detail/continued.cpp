// Holes behind which a slope goes on. A plan says so in rounded numbers, twice: by the slope's profile from the eaves
// on, and by that of the hole's back edge. Rounded each for itself, they are two planes that cross or miss each other
// by micrometres, and a strip between them over the whole slope.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/lines.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

/// m. Lines and heights on the grid are off by a quantum each. A line that shares another's direction is off by up to
/// `Options::Lines::share_move` at its ends, by more beyond them. What is farther off is another roof.
constexpr double rounding = 2e-3;

/// Where the track is at a height above its base, inward of its edge, after any terrace there; m.
auto inward_at(const Track& track, const Rational& height) -> Rational {
  const auto above = std::ranges::find_if(track, [&](const TrackPart& part) { return part.height > height; });
  const TrackPart& part = *std::prev(above);
  return part.inward + part.slope * (height - part.height);
}

/// A hole's edge with a roof on a wall.
struct Place {
  std::size_t ring, edge;
};

class Continuing {
 public:
  Continuing(const Footprint& footprint, double near) : given_(footprint), near_(near) {}

  auto run() -> std::optional<Footprint> {
    for (const Place& at : candidates())
      if (const auto roof = found(at)) move(at, *roof);
    if (out_ && clash_in(out_->corners)) return std::nullopt;
    return std::move(out_);
  }

 private:
  [[nodiscard]] auto now() const -> const Footprint& { return out_ ? *out_ : given_; }
  [[nodiscard]] auto track_of(const CanonicalEdge& edge) const -> const Track& { return given_.tracks[edge.track]; }

  /// Those that begin lower first: what goes on with another's roof is no roof that others go on with.
  [[nodiscard]] auto candidates() const -> std::vector<Place> {
    std::vector<Place> out;
    for (std::size_t r = 1; r < given_.rings.size(); ++r) {
      const auto& ring = given_.rings[r];
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Track& own = track_of(ring[i]);
        const bool upright = own[0].slope == 0 && !own[0].horizontal;
        if (upright && own.size() > 1 && !own[1].horizontal && own[1].slope > 0 && !ring[i].joint &&
            !ring[(i + 1) % ring.size()].joint)
          out.push_back({r, i});
      }
    }
    std::ranges::stable_sort(out, [&](const Place& a, const Place& b) {
      return track_of(given_.rings[a.ring][a.edge])[1].height < track_of(given_.rings[b.ring][b.edge])[1].height;
    });
    return out;
  }

  /// Of the roofs that are the hole's where that begins, the one that begins lowest.
  [[nodiscard]] auto found(const Place& hole) const -> std::optional<Continues> {
    const CanonicalEdge& edge = given_.rings[hole.ring][hole.edge];
    const auto& corners = given_.corners[hole.ring];
    const Point2 start = corners[hole.edge].approximate(),
                 end = corners[(hole.edge + 1) % corners.size()].approximate();
    const Rational& from = track_of(edge)[1].height;
    std::optional<Continues> best;
    std::tuple<double, double> least{HUGE_VAL, HUGE_VAL};
    for (std::uint32_t r = 0; r < given_.rings.size(); ++r)
      for (std::uint32_t f = 0; f < given_.rings[r].size(); ++f) {
        const CanonicalEdge& host = now().rings[r][f];
        if (host.roof || dot(host.direction.approximate(), end - start) <= 0) continue;
        const Track& track = track_of(host);
        std::size_t part = track.size() - 1;
        while (part > 0 && track[part].height > from) --part;
        if (track[part].horizontal || track[part].slope <= 0 || track[part].height >= from) continue;
        const Point2 inward = left_of(host.direction.approximate());
        const auto off_from = [&](double there) {
          return std::max(std::abs(dot(inward, start) - there), std::abs(dot(inward, end) - there));
        };
        // Mostly it is far off, which doubles tell: they are within a micrometre of what is exact.
        constexpr double certain = 1e-6;
        const TrackPart& below = track[part];
        if (off_from(host.offset.get_d() + below.inward.get_d() +
                     below.slope.get_d() * (from.get_d() - below.height.get_d())) > near_ + certain)
          continue;
        const double off = off_from(Rational(host.offset + inward_at(track, from)).get_d());
        if (off > near_ || !same_above(from, track_of(edge), track)) continue;
        const std::tuple rank(track[part].height.get_d(), off);
        if (rank >= least) continue;
        least = rank;
        best = Continues{r, f, static_cast<std::uint32_t>(part)};
      }
    return best;
  }

  /// Whether two roofs that are in one place at a height remain so: at every knot above, and 1 m above the last.
  [[nodiscard]] auto same_above(const Rational& from, const Track& own, const Track& track) const -> bool {
    const Rational apart = inward_at(track, from) - inward_at(own, from);
    const auto same_at = [&](const Rational& height) {
      const Rational off = inward_at(track, height) - inward_at(own, height) - apart;
      return height < from || std::abs(off.get_d()) <= near_;
    };
    const auto at_knot = [&](const TrackPart& knot) { return same_at(knot.height); };
    return same_at(std::max(own.back().height, track.back().height) + 1) && std::ranges::all_of(own, at_knot) &&
           std::ranges::all_of(track, at_knot);
  }

  /// The edge to where that roof is at the height at which the edge's own begins.
  void move(const Place& at, const Continues& roof) {
    const CanonicalEdge& host = now().rings[roof.ring][roof.edge];
    const Rational& from = track_of(given_.rings[at.ring][at.edge])[1].height;
    CanonicalEdge moved = given_.rings[at.ring][at.edge];
    moved.direction = host.direction;
    moved.offset = host.offset + inward_at(track_of(host), from);
    moved.roof = roof;
    if (!out_) out_ = given_;
    auto& ring = out_->rings[at.ring];
    auto& corners = out_->corners[at.ring];
    const std::size_t n = ring.size(), before = (at.edge + n - 1) % n, next = (at.edge + 1) % n;
    const auto was = std::tuple(ring[at.edge], corners[at.edge], corners[next]);
    ring[at.edge] = std::move(moved);
    const bool crosses = cross(ring[before].direction, ring[at.edge].direction) != 0 &&
                         cross(ring[at.edge].direction, ring[next].direction) != 0;
    if (crosses) {
      corners[at.edge] = corner_of(ring[before], ring[at.edge]);
      corners[next] = corner_of(ring[at.edge], ring[next]);
      const auto goes_on = [&](std::size_t k) {
        const Point2 along = corners[(k + 1) % n].approximate() - corners[k].approximate();
        return dot(ring[k].direction.approximate(), along) >= shortest;
      };
      const double by = std::max(length(corners[at.edge].approximate() - std::get<1>(was).approximate()),
                                 length(corners[next].approximate() - std::get<2>(was).approximate()));
      constexpr double slanting = 4;  // times the move, along neighbours that meet the edge at an angle
      if (goes_on(before) && goes_on(at.edge) && goes_on(next) && by <= slanting * near_) {
        out_->moved = std::max(out_->moved, given_.moved + by);
        return;
      }
    }
    std::tie(ring[at.edge], corners[at.edge], corners[next]) = was;
  }

  const Footprint& given_;
  double near_;  ///< m
  std::optional<Footprint> out_;
};

}  // namespace

auto continued(const Footprint& footprint, double moved) -> std::optional<Footprint> {
  if (footprint.rings.size() < 2) return std::nullopt;
  auto out = Continuing(footprint, rounding + moved).run();
  const auto goes_on = [](const CanonicalEdge& edge) { return edge.roof.has_value(); };
  if (!out || std::ranges::none_of(out->rings, [&](const auto& ring) { return std::ranges::any_of(ring, goes_on); }))
    return std::nullopt;
  return out;
}

}  // namespace mansard::extrude::detail
