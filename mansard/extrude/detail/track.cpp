// Profiles on the grid: what the sweep climbs along, and the same as a profile again.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mansard/extrude/detail/footprint.hpp"

namespace mansard::extrude::detail {
namespace {

struct Knot {
  std::int64_t inward = 0, height = 0;  ///< quanta
  std::size_t index = 0;                ///< in the input
  [[nodiscard]] auto point() const -> geometry::Point2 {
    return {static_cast<double>(inward), static_cast<double>(height)};
  }
};

/// Error bound, quanta, of a knot on a chord past it: rounding moves the knot and both ends by half a quantum in each
/// coordinate, √2 / 2 each, so that knot and chord are apart by √2 at most. Knots within 4 (61 µm) are rounding, not
/// design.
constexpr double straight = 4;

/// Without the knots that are on a chord past them.
auto thinned(const std::vector<Knot>& knots) -> std::vector<Knot> {
  std::vector<Knot> kept{knots.front()};
  for (std::size_t from = 0; from + 1 < knots.size();) {
    const auto chord_holds = [&](std::size_t to) {
      for (std::size_t i = from + 1; i < to; ++i)
        if (geometry::distance({knots[from].point(), knots[to].point()}, knots[i].point()) > straight) return false;
      return true;
    };
    std::size_t to = from + 1;
    while (to + 1 < knots.size() && chord_holds(to + 1)) ++to;
    kept.push_back(knots[to]);
    from = to;
  }
  return kept;
}

/// A fraction; the denominator is positive.
auto in_lowest_terms(std::int64_t numerator, std::int64_t denominator) -> Rational {
  const auto common = std::gcd(numerator, denominator);
  return {static_cast<long>(numerator / common), static_cast<unsigned long>(denominator / common)};
}

}  // namespace

auto in_metres(std::int64_t quanta) -> Rational { return in_lowest_terms(quanta, quanta_per_metre); }

auto track_of(const model::Profile& profile) -> Track { return canonical_profile(profile).track; }

auto canonical_profile(const model::Profile& profile) -> CanonicalProfile {
  CanonicalProfile out;
  std::vector<Knot> knots{{0, 0, 0}};
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const Knot before = knots.back();
    // Rounding may not make a profile lean outwards or go down.
    const Knot knot{std::max<std::int64_t>(before.inward, std::llrint(profile[i].inward / quantum)),
                    std::max<std::int64_t>(before.height, std::llrint(profile[i].height / quantum)), i};
    if (knot.inward == before.inward && knot.height == before.height) {
      knots.back().index = i;  // a part without extent: the next part begins here
      ++out.empty_parts;
    } else {
      knots.push_back(knot);
    }
  }
  // A knot dropped can make its neighbours' chord straight in turn.
  for (std::size_t before = 0; before != knots.size();) {
    before = knots.size();
    auto fewer = thinned(knots);
    out.straight_knots += knots.size() - fewer.size();
    knots = std::move(fewer);
  }
  for (const Knot& knot : knots)
    out.profile.push_back({static_cast<double>(knot.inward) * quantum, static_cast<double>(knot.height) * quantum});
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const std::int64_t run = knots[i + 1].inward - knots[i].inward, rise = knots[i + 1].height - knots[i].height;
    TrackPart part{in_metres(knots[i].inward),
                   in_metres(knots[i].height),
                   0,
                   rise == 0,
                   0,
                   static_cast<std::uint32_t>(knots[i].index)};
    if (part.horizontal) {
      part.run = in_metres(run);
    } else if (run != 0) {
      part.slope = in_lowest_terms(run, rise);
    }
    out.track.push_back(std::move(part));
  }
  if (out.track.empty()) out.profile = {{0, 0}, {0, 1}};  // nothing left of it: a vertical wall
  if (out.track.empty() || out.track.back().horizontal)
    out.track.push_back({in_metres(knots.back().inward), in_metres(knots.back().height), 0, false, 0,
                         static_cast<std::uint32_t>(profile.size() - 2)});
  return out;
}

auto same_shape(const Track& p, const Track& q) -> bool {
  return std::ranges::equal(p, q, [](const TrackPart& a, const TrackPart& b) {
    return a.inward == b.inward && a.height == b.height && a.slope == b.slope && a.horizontal == b.horizontal &&
           a.run == b.run;
  });
}

void shorten_runs(Track& track, int parts) {
  std::vector<std::int64_t> inward;
  for (const TrackPart& part : track) {
    const double quanta = part.inward.get_d() / quantum;
    inward.push_back(std::llrint(quanta - quanta * parts / 4096));
    if (inward.size() > 1 && part.inward != (&part - 1)->inward)
      inward.back() = std::max(inward.back(), inward[inward.size() - 2] + 1);
  }
  for (std::size_t i = 0; i < track.size(); ++i) {
    TrackPart& part = track[i];
    part.inward = in_metres(inward[i]);
    if (i + 1 == track.size()) continue;
    const Rational run = in_metres(inward[i + 1] - inward[i]);
    if (part.horizontal) part.run = run;
    else part.slope = run / (track[i + 1].height - part.height);
  }
}

}  // namespace mansard::extrude::detail
