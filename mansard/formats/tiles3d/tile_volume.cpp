#include "mansard/formats/tiles3d/tile_volume.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace mansard::formats {
namespace {

using geometry::Box2;
using geometry::Point3;
using Json = nlohmann::ordered_json;

template <std::size_t N>
auto numbers_of(const Json& object, const char* key) -> std::optional<std::array<double, N>> {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || found->size() != N) return std::nullopt;
  std::array<double, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!(*found)[i].is_number()) return std::nullopt;
    out[i] = (*found)[i].template get<double>();
  }
  return out;
}

auto corners_of(const TileBox& box) -> std::array<Point3, 8> {
  std::array<Point3, 8> corners{};
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = box.middle;
    for (std::size_t axis = 0; axis < 3; ++axis)
      corners[i] = corners[i] + ((i >> axis & 1U) != 0 ? 1.0 : -1.0) * box.half[axis];
  }
  return corners;
}

/// Of a box on the earth: its corners' box in plan, and some more for what bulges between them.
auto plan_on_earth(const TileBox& box, const crs::WayOfMesh& way) -> std::optional<Box2> {
  constexpr double radius = 6'356'752, largest = 100'000;  // m
  const double reach = length(box.half[0]) + length(box.half[1]) + length(box.half[2]);
  if (!(reach < largest)) return std::nullopt;
  auto corners = corners_of(box);
  way.take(corners);
  Box2 plan;
  for (const Point3 p : corners) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return std::nullopt;
    plan.add(xy(p));
  }
  return plan.grown(1 + reach * reach / radius);
}

}  // namespace

auto volume_of(const Json& object) -> Volume {
  if (!object.is_object()) return {};
  constexpr double degrees = 180 / std::numbers::pi;
  if (const auto r = numbers_of<6>(object, "region")) {
    const auto& [west, south, east, north, low, high] = *r;
    DegreeBox box{west * degrees, south * degrees, east * degrees, north * degrees, low, high};
    if (box.east < box.west) box.east += 360;
    return box;
  }
  if (const auto b = numbers_of<12>(object, "box")) {
    const auto point = [&b](std::size_t i) { return Point3{(*b)[i], (*b)[i + 1], (*b)[i + 2]}; };
    return TileBox{point(0), {point(3), point(6), point(9)}};
  }
  if (const auto s = numbers_of<4>(object, "sphere")) {
    const double r = (*s)[3];
    return TileBox{{(*s)[0], (*s)[1], (*s)[2]}, {Point3{r, 0, 0}, Point3{0, r, 0}, Point3{0, 0, r}}};
  }
  return {};
}

auto placed(const Volume& volume, const Transform& by) -> Volume {
  const auto* box = std::get_if<TileBox>(&volume);
  if (box == nullptr) return volume;
  const Point3 origin = by({0, 0, 0});
  TileBox out{by(box->middle), {}};
  for (std::size_t i = 0; i < 3; ++i) out.half[i] = by(box->half[i]) - origin;
  return out;
}

auto TileFilter::passes(const Volume& placed) const -> bool {
  if (!within_) return true;
  std::optional<Box2> plan;
  if (const auto* region = std::get_if<DegreeBox>(&placed)) {
    if (way_ != nullptr) plan = way_->box_of_degrees(region->west, region->south, region->east, region->north);
  } else if (const auto* box = std::get_if<TileBox>(&placed)) {
    if (way_ != nullptr) {
      plan = plan_on_earth(*box, *way_);
    } else {
      plan.emplace();
      for (const Point3 p : corners_of(*box)) plan->add(xy(p));
    }
  }
  return !plan || plan->overlaps(*within_);
}

}  // namespace mansard::formats
