#include "lab/simulate/faults.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include "lab/simulate/detail/noise.hpp"
#include "lab/simulate/points.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;

struct Range {
  double least, most;
};
struct FaultRange {
  std::string_view name;
  Range amount;
  bool of_clouds = false;
};
/// From what is hardly seen to what spoils a roof, each kind: a survey has all of it.
constexpr std::array<FaultRange, fault_kinds> fault_ranges{{{"unseen", {0.2, 0.75}},
                                                            {"sparse", {0.15, 0.8}, true},
                                                            {"classes", {0.3, 1.0}, true},
                                                            {"crown", {0.1, 0.45}},
                                                            {"scaffold", {0.8, 1.6}},
                                                            {"crane", {3, 12}},
                                                            {"pits", {0.05, 0.4}},
                                                            {"demolished", {0, 0}},
                                                            {"lower", {2.5, 3.5}},
                                                            {"deck", {1.5, 4}},
                                                            {"moved", {0.8, 3}},
                                                            {"turned", {0.1, 0.5}},
                                                            {"larger", {1.15, 1.6}},
                                                            {"smaller", {0.55, 0.9}}}};

auto direction_of(const Fault& fault) -> Point2 {
  return {geometry::cosine(fault.direction), geometry::sine(fault.direction)};
}

/// A building of the truth, as faults see it.
struct Place {
  const std::vector<Polygon>& outline;
  double ground, top, area = 0;
  Point2 middle;

  explicit Place(const model::Building& building)
      : outline(building.footprint), ground(building.ground), top(building.ground) {
    for (const auto& part : building.parts)
      for (const auto v : part.model.solid.vertices) top = std::max(top, v.z);
    for (const auto& polygon : outline) area += geometry::area(polygon);
    const auto box = geometry::bounds(outline);
    middle = 0.5 * (box.least + box.most);
  }
  /// From 0 to 1 across the outline along a direction.
  [[nodiscard]] auto across(Point2 p, Point2 direction) const -> double {
    double least = 1e300, most = -1e300;
    for (const auto& polygon : outline)
      for (const auto v : polygon.outer)
        least = std::min(least, dot(v, direction)), most = std::max(most, dot(v, direction));
    return (dot(p, direction) - least) / (most - least);
  }
  [[nodiscard]] auto contains(Point2 p) const -> bool { return geometry::contains(outline, p); }
  /// m; 0 inside.
  [[nodiscard]] auto distance(Point2 p) const -> double {
    if (contains(p)) return 0;
    double out = 1e300;
    for (const auto& polygon : outline) out = std::min(out, geometry::boundary_distance(polygon, p));
    return out;
  }
  /// A place inside the outline.
  [[nodiscard]] auto inside(base::Random& random) const -> Point2 {
    const auto box = geometry::bounds(outline);
    constexpr int tries = 1000;
    for (int i = 0; i < tries; ++i) {
      const Point2 p{random.uniform(box.least.x, box.most.x), random.uniform(box.least.y, box.most.y)};
      if (contains(p)) return p;
    }
    return middle;
  }
};

/// Takes away the triangles whose middle is lost.
void remove(Scan& scan, const std::function<bool(std::size_t, Point3)>& lost) {
  std::size_t kept = 0;
  auto& triangles = scan.mesh.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    const auto middle = (1.0 / 3) * (scan.mesh.vertices[a] + scan.mesh.vertices[b] + scan.mesh.vertices[c]);
    if (lost(t, middle)) continue;
    triangles[kept] = triangles[t];
    scan.classes[kept] = scan.classes[t];
    scan.buildings[kept] = scan.buildings[t];
    ++kept;
  }
  triangles.resize(kept);
  scan.classes.resize(kept);
  scan.buildings.resize(kept);
}

/// Adds a surface of squares where `height` has a value at all four corners.
void add(Scan& scan, const geometry::Box2& box, double step, Class kind, std::uint32_t building,
         const std::function<std::optional<double>(Point2)>& height) {
  const auto columns = static_cast<std::size_t>(std::ceil((box.most.x - box.least.x) / step)) + 1,
             rows = static_cast<std::size_t>(std::ceil((box.most.y - box.least.y) / step)) + 1;
  std::vector<std::optional<std::uint32_t>> corners(columns * rows);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const Point2 p{box.least.x + step * static_cast<double>(i), box.least.y + step * static_cast<double>(j)};
      if (const auto z = height(p)) {
        corners[j * columns + i] = static_cast<std::uint32_t>(scan.mesh.vertices.size());
        scan.mesh.vertices.push_back({p.x, p.y, *z});
      }
    }
  for (std::size_t j = 0; j + 1 < rows; ++j)
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      const auto a = corners[j * columns + i], b = corners[j * columns + i + 1], c = corners[(j + 1) * columns + i + 1],
                 d = corners[(j + 1) * columns + i];
      if (!a || !b || !c || !d) continue;
      for (const std::array<std::uint32_t, 3> triangle : {std::array{*a, *b, *c}, std::array{*a, *c, *d}}) {
        scan.mesh.triangles.push_back(triangle);
        scan.classes.push_back(kind);
        scan.buildings.push_back(building);
      }
    }
}

struct Planting {
  const Fault& fault;
  Place place;
  double step;  ///< m; between new vertices
  base::Random random;
  Scan& scan;

  [[nodiscard]] auto rough(double by) -> double { return by * (2 * random.uniform() - 1); }
};

void plant_crown(Planting& to) {
  const double radius = std::sqrt(to.fault.amount * to.place.area / std::numbers::pi);
  const auto middle = to.place.inside(to.random);
  // As a tree beside the house would: its crown begins below the highest roof and rises above it.
  const double foot = to.place.top - 1, rise = 1 + to.random.uniform(1, 3);
  add(to.scan, geometry::Box2{middle, middle}.grown(radius), to.step, Class::roof, to.fault.building,
      [&](Point2 p) -> std::optional<double> {
        const double r = length(p - middle) / radius;
        if (r > 1) return std::nullopt;
        return foot + rise * std::sqrt(1 - r * r) + to.rough(0.3);
      });
}

void plant_scaffold(Planting& to) {
  const double high = to.place.top + to.rough(0.3);
  add(to.scan, geometry::bounds(to.place.outline).grown(2 * to.fault.amount), to.step, Class::roof, to.fault.building,
      [&](Point2 p) -> std::optional<double> {
        const double d = to.place.distance(p);
        return d > 0 && d < to.fault.amount ? std::optional(high + to.rough(0.1)) : std::nullopt;
      });
}

void plant_crane(Planting& to) {
  constexpr double reach = 25, half_width = 0.6;
  const auto along = direction_of(to.fault), middle = to.place.inside(to.random);
  const double high = to.place.top + to.fault.amount;
  add(to.scan, geometry::Box2{middle, middle}.grown(reach), to.step / 2, Class::roof, to.fault.building,
      [&](Point2 p) -> std::optional<double> {
        const auto by = p - middle;
        if (std::abs(dot(by, along)) > reach || std::abs(cross(by, along)) > half_width) return std::nullopt;
        return high + to.rough(0.5);
      });
}

void plant_pits(Planting& to) {
  const double each = std::min(0.5 * to.fault.amount * to.place.area, 6.0);
  const auto count = std::max(1.0, std::round(to.fault.amount * to.place.area / each));
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double radius = std::sqrt(each / std::numbers::pi), deep = to.random.uniform(1.5, 6);
    const auto middle = to.place.inside(to.random);
    const auto within = [&](Point2 p) { return length(p - middle) < radius; };
    remove(to.scan,
           [&](std::size_t t, Point3 p) { return to.scan.buildings[t] == to.fault.building && within(xy(p)); });
    add(to.scan, geometry::Box2{middle, middle}.grown(radius + to.step), to.step, Class::roof, to.fault.building,
        [&](Point2 p) -> std::optional<double> {
          if (!within(p) || !to.place.contains(p)) return std::nullopt;
          return std::max(to.place.ground, to.place.top - deep + to.rough(1));
        });
  }
}

void plant_deck(Planting& to) {
  // Beside the outline on the side that the direction points to.
  const auto out = direction_of(to.fault);
  const double high = to.place.ground + 2.0 / 3 * (to.place.top - to.place.ground);
  add(to.scan, geometry::bounds(to.place.outline).grown(to.fault.amount), to.step, Class::roof, to.fault.building,
      [&](Point2 p) -> std::optional<double> {
        const double d = to.place.distance(p);
        if (!(d > 0 && d < to.fault.amount) || to.place.across(p, out) < 0.5) return std::nullopt;
        return high + to.rough(0.05);
      });
}

void plant_demolished(Planting& to) {
  remove(to.scan, [&](std::size_t t, Point3) { return to.scan.buildings[t] == to.fault.building; });
  add(to.scan, geometry::bounds(to.place.outline).grown(to.step), to.step, Class::ground, Scan::none,
      [&](Point2 p) -> std::optional<double> {
        if (to.place.distance(p) > to.step) return std::nullopt;
        return to.place.ground + to.rough(0.15);
      });
}

/// A storey less, all heights in proportion: what its walls share with others stays where it is at the foot.
void plant_lower(Planting& to) {
  const double high = to.place.top - to.place.ground, factor = std::max(0.3, (high - to.fault.amount) / high);
  std::vector<bool> own(to.scan.mesh.vertices.size());
  for (std::size_t t = 0; t < to.scan.mesh.triangles.size(); ++t)
    if (to.scan.buildings[t] == to.fault.building)
      for (const auto v : to.scan.mesh.triangles[t]) own[v] = true;
  for (std::size_t v = 0; v < own.size(); ++v)
    if (own[v]) {
      auto& z = to.scan.mesh.vertices[v].z;
      if (z > to.place.ground) z = to.place.ground + factor * (z - to.place.ground);
    }
}

void plant_one(Planting& to) {
  using enum FaultKind;
  switch (to.fault.kind) {
    case unseen:
      remove(to.scan, [&](std::size_t, Point3 p) {
        return to.place.distance(xy(p)) < 1 && to.place.across(xy(p), direction_of(to.fault)) > 1 - to.fault.amount;
      });
      break;
    case crown: plant_crown(to); break;
    case scaffold: plant_scaffold(to); break;
    case crane: plant_crane(to); break;
    case pits: plant_pits(to); break;
    case demolished: plant_demolished(to); break;
    case lower: plant_lower(to); break;
    case deck: plant_deck(to); break;
    case sparse:
    case classes:
    case moved:
    case turned:
    case larger:
    case smaller: break;
  }
}

auto random_for(const Fault& fault, std::uint64_t seed) -> base::Random {
  constexpr std::uint64_t purpose = 0x6661756c74;
  return detail::random_of(seed ^ purpose, fault.building);
}

/// Where a corner of the footprint is drawn.
auto drawn_with(Point2 p, const Fault& fault, Point2 middle) -> Point2 {
  const auto along = direction_of(fault), by = p - middle;
  switch (fault.kind) {
    case FaultKind::moved: return p + fault.amount * along;
    case FaultKind::turned: {
      const double c = geometry::cosine(fault.amount), s = geometry::sine(fault.amount);
      return middle + Point2{c * by.x - s * by.y, s * by.x + c * by.y};
    }
    case FaultKind::larger:
    case FaultKind::smaller: return p + (fault.amount - 1) * dot(by, along) * along;
    default: return p;
  }
}

auto is_of_survey(FaultKind kind) -> bool {
  using enum FaultKind;
  return kind == moved || kind == turned || kind == larger || kind == smaller;
}

}  // namespace

auto to_string(FaultKind kind) -> std::string_view { return fault_ranges[static_cast<std::size_t>(kind)].name; }

auto faults_of(const Truth& truth, double share, bool points, bool heights, std::uint64_t seed) -> std::vector<Fault> {
  constexpr double least_area = 20;  // m²
  std::vector<std::size_t> possible;
  for (std::size_t k = 0; k < fault_ranges.size(); ++k)
    if ((points || !fault_ranges[k].of_clouds) && (heights || static_cast<FaultKind>(k) != FaultKind::lower))
      possible.push_back(k);
  std::vector<Fault> out;
  for (std::uint32_t b = 0; b < truth.city.buildings.size(); ++b) {
    Fault fault{b};
    auto random = random_for(fault, seed + 1);
    const bool has_one = random.uniform() < share;
    if (!has_one || Place(truth.city.buildings[b]).area < least_area) continue;
    const auto kind = possible[random.index(possible.size())];
    fault.kind = static_cast<FaultKind>(kind);
    fault.amount = random.uniform(fault_ranges[kind].amount.least, fault_ranges[kind].amount.most);
    fault.direction = random.uniform(0, 2 * std::numbers::pi);
    out.push_back(fault);
  }
  return out;
}

void plant(const std::vector<Fault>& faults, const Truth& truth, std::uint64_t seed, Scan& scan) {
  constexpr double finest = 0.2;  // m; of a scan of faces
  const double step = std::max(finest, scan.planted.spacing);
  for (const auto& fault : faults) {
    Planting to{fault, Place(truth.city.buildings[fault.building]), step, random_for(fault, seed), scan};
    plant_one(to);
  }
}

void plant(const std::vector<Fault>& faults, const Truth& truth, std::uint64_t seed, AirbornePoints& points) {
  constexpr std::uint8_t other_building = 67;  // free for producers; of some, a building
  constexpr double around = 0.5;               // m; the points of its walls, too
  for (const auto& fault : faults) {
    if (!fault_ranges[static_cast<std::size_t>(fault.kind)].of_clouds) continue;
    const Place place(truth.city.buildings[fault.building]);
    const auto box = geometry::bounds(place.outline).grown(around);
    auto random = random_for(fault, seed);
    const double density = 1 / (points.planted.spacing * points.planted.spacing);
    std::erase_if(points.points, [&](formats::CloudPoint& point) {
      const auto p = xy(point.position);
      if (!box.contains(p) || place.distance(p) > around) return false;
      if (fault.kind == FaultKind::sparse) return random.uniform() > fault.amount / density;
      if (point.classification == 6 && place.across(p, direction_of(fault)) > 1 - fault.amount)
        point.classification = other_building;
      return false;
    });
  }
}

void plant(const std::vector<Fault>& faults, const Truth& truth, std::vector<model::Footprint>& footprints) {
  for (auto& footprint : footprints) {
    const auto* buildings = std::get_if<std::string>(&footprint.attributes.at(1).second);
    const auto own = std::ranges::find_if(faults, [&](const Fault& fault) {
      return is_of_survey(fault.kind) && buildings != nullptr &&
             (" " + *buildings + " ").find(" " + truth.city.buildings[fault.building].id + " ") != std::string::npos;
    });
    if (own == faults.end()) continue;
    const auto box = geometry::bounds(footprint.polygons);
    const auto middle = 0.5 * (box.least + box.most);
    for (auto& polygon : footprint.polygons) {
      for (auto& p : polygon.outer) p = drawn_with(p, *own, middle);
      for (auto& hole : polygon.holes)
        for (auto& p : hole) p = drawn_with(p, *own, middle);
    }
  }
}

}  // namespace mansard::simulate
