#include "lab/explore/detail/drawings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/explore/detail/charts.hpp"
#include "lab/explore/detail/svg.hpp"
#include "mansard/base/text.hpp"

namespace mansard::explore::detail {
namespace {

using geometry::Point2;

/// A number per part that none before it nearby has: boxes that touch count as near.
auto colours_of(const std::vector<geometry::Polygon>& parts) -> std::vector<std::size_t> {
  constexpr double near = 0.5;  // m
  std::vector<geometry::Box2> boxes;
  for (const auto& part : parts) boxes.push_back(geometry::bounds(part.outer).grown(near));
  std::vector<std::size_t> colours;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<std::size_t> taken;
    for (std::size_t j = 0; j < i; ++j)
      if (boxes[i].overlaps(boxes[j])) taken.push_back(colours[j]);
    std::size_t colour = 0;
    while (std::ranges::find(taken, colour) != taken.end()) ++colour;
    colours.push_back(colour);
  }
  return colours;
}

/// A part of a profile that runs inward less than this is wall.
constexpr double least_run = 0.05;  // m

}  // namespace

auto plan_drawing(const std::vector<geometry::Polygon>& parts, const std::vector<geometry::Polygon>& footprints,
                  double size, std::string_view label) -> std::string {
  constexpr double margin = 4;  // pixels
  const auto box = geometry::bounds(footprints.empty() ? parts : footprints);
  const Point2 extent = box.empty() ? Point2{1, 1} : box.most - box.least;
  const double height = std::clamp(size * extent.y / std::max(extent.x, 1e-9), size / 3, size * 1.5);
  const Frame frame(box, size - 2 * margin, height - 2 * margin);
  const auto placed = [&](const geometry::Polygon& polygon) {
    auto out = frame(polygon);
    const auto shift = [&](geometry::Ring& ring) {
      for (auto& p : ring) p = p + Point2{margin, margin};
    };
    shift(out.outer);
    std::ranges::for_each(out.holes, shift);
    return out;
  };
  Svg svg(size, height, label);
  const auto colours = colours_of(parts);
  for (std::size_t i = 0; i < parts.size(); ++i)
    svg.polygon(placed(parts[i]), {{"fill", series_colour(colours[i])}, {"class", "part"}});
  for (const auto& footprint : footprints) svg.polygon(placed(footprint), {{"class", "gis"}});
  return std::move(svg).done();
}

auto kind_of(const model::Profile& profile) -> ProfileKind {
  std::size_t pitches = 0;
  for (std::size_t i = 1; i < profile.size(); ++i)
    pitches += profile[i].inward - profile[i - 1].inward > least_run ? 1 : 0;
  return pitches == 0 ? ProfileKind::vertical : pitches == 1 ? ProfileKind::one_pitch : ProfileKind::more;
}

auto shares_of(const std::vector<Rise>& rises) -> ProfileShares {
  ProfileShares shares;
  shares.profiles = rises.size();
  for (const auto& rise : rises) {
    shares.length += rise.length;
    shares.slices += rise.slices;
    shares.attempted += rise.attempted;
    shares.of_kind[static_cast<std::size_t>(kind_of(rise.profile))] += rise.length;
    if (rise.slices == 0) shares.unseen += rise.length;
  }
  return shares;
}

auto profile_drawing(const std::vector<Rise>& rises, std::string_view label) -> std::string {
  constexpr double left = 46, bottom = 40, top = 12, right = 16, most_width = 900, most_height = 460;
  double run = 1, height = 1;
  for (const auto& rise : rises)
    for (const auto& p : rise.profile) run = std::max(run, p.inward), height = std::max(height, p.height);
  const double scale = std::min((most_width - left - right) / run, (most_height - top - bottom) / height);
  const double width = std::max(360.0, left + right + run * scale), below = top + height * scale;
  const auto at = [&](double inward, double up) { return Point2{left + inward * scale, below - up * scale}; };

  Svg svg(width, below + bottom, label);
  const auto upward = ticks(0, height, 8), inward = ticks(0, run, 2 + static_cast<std::size_t>(run * scale / 60));
  for (const double z : upward) {
    if (z > height) continue;
    svg.line(at(0, z), {width - right, at(0, z).y}, {{"class", "grid"}});
    svg.text({left - 6, at(0, z).y + 4}, base::to_text(z), {{"text-anchor", "end"}});
  }
  for (const double x : inward) {
    if (x > run) continue;
    svg.line(at(x, 0), at(x, 0) + Point2{0, 4}, {{"class", "axis"}});
    svg.text(at(x, 0) + Point2{0, 17}, base::to_text(x), {{"text-anchor", "middle"}});
  }
  svg.text({left, below + 34}, "inward, m →, height, m ↑");
  const double opacity = std::clamp(30.0 / static_cast<double>(std::max<std::size_t>(1, rises.size())), 0.2, 0.8);
  for (const auto kind : {ProfileKind::vertical, ProfileKind::one_pitch, ProfileKind::more})
    for (const auto& rise : rises) {
      if (kind_of(rise.profile) != kind) continue;
      std::vector<Point2> points;
      for (const auto& p : rise.profile) points.push_back(at(p.inward, p.height));
      svg.polyline(points, {{"stroke", series_colour(static_cast<std::size_t>(kind))},
                            {"stroke-width", "1.5"},
                            {"stroke-opacity", base::to_text(opacity, 3)}});
    }
  return std::move(svg).done();
}

}  // namespace mansard::explore::detail
