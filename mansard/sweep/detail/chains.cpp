#include "mansard/sweep/detail/chains.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "mansard/sweep/detail/units.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

auto join(std::vector<Segment2> segments) -> std::vector<Chain> {
  std::erase_if(segments, [](const Segment2& s) {
    return s.start == s.end ||
           !(std::isfinite(s.start.x) && std::isfinite(s.start.y) && std::isfinite(s.end.x) && std::isfinite(s.end.y));
  });
  const auto before = [](const Segment2& a, const Segment2& b) {
    return a.start < b.start || (a.start == b.start && a.end < b.end);
  };
  std::sort(segments.begin(), segments.end(), before);
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());

  std::vector<Point2> ends;
  ends.reserve(segments.size());
  for (const auto& s : segments) ends.push_back(s.end);
  std::sort(ends.begin(), ends.end());

  std::vector<char> used(segments.size(), 0);
  const auto straightest_from = [&](const Segment2& last) -> std::size_t {
    const Point2 heading = normalised(last.end - last.start);
    auto at = static_cast<std::size_t>(std::lower_bound(segments.begin(), segments.end(), last.end,
                                                        [](const Segment2& s, Point2 p) { return s.start < p; }) -
                                       segments.begin());
    std::size_t best = segments.size();
    double best_cosine = -2;
    for (; at < segments.size() && segments[at].start == last.end; ++at) {
      if (used[at] != 0) continue;
      const double cosine = dot(heading, normalised(segments[at].end - segments[at].start));
      if (cosine > best_cosine) best = at, best_cosine = cosine;
    }
    return best;
  };

  std::vector<Chain> chains;
  const auto follow = [&](std::size_t first) {
    Chain chain{segments[first].start};
    for (auto at = first; at < segments.size(); at = straightest_from(segments[at])) {
      used[at] = 1;
      chain.push_back(segments[at].end);
    }
    chains.push_back(std::move(chain));
  };
  for (std::size_t i = 0; i < segments.size(); ++i)  // open chains from their loose ends, so that none is broken
    if (used[i] == 0 && !std::binary_search(ends.begin(), ends.end(), segments[i].start)) follow(i);
  // Closed ones from their westernmost point. Vertices of a raster have one x, so that rounding would choose among
  // them.
  std::vector<std::tuple<std::int64_t, std::int64_t, std::size_t>> rest;
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (used[i] == 0) rest.emplace_back(in_units(segments[i].start.x), in_units(segments[i].start.y), i);
  std::sort(rest.begin(), rest.end());
  for (const auto& [x, y, i] : rest)
    if (used[i] == 0) follow(i);
  return chains;
}

}  // namespace mansard::sweep::detail
