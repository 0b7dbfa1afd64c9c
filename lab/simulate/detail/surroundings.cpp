#include "lab/simulate/detail/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mansard/geometry/angles.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::simulate::detail {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Point3;

constexpr double knot = 2.0;            // m between the knots of the ground
constexpr double superstructure = 2.5;  // m; a base so far over the building's lowest stands on a roof

/// Places at the feet of the buildings: corners of their bases, and points along the sides.
auto feet_of(const Surface& surface) -> std::vector<Point3> {
  const auto& mesh = surface.mesh;
  const auto grounded = on_ground(surface);
  std::vector<Point3> feet;
  constexpr double apart = 4.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!grounded[t]) continue;
    const auto& corners = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 a = mesh.vertices[corners[i]], b = mesh.vertices[corners[(i + 1) % 3]];
      const auto pieces = std::max(1.0, std::round(length(b - a) / apart));
      for (double k = 0; k < pieces; ++k) feet.push_back(a + (k / pieces) * (b - a));
    }
  }
  std::ranges::sort(feet);
  feet.erase(std::ranges::unique(feet).begin(), feet.end());
  return feet;
}

auto in_frame(const Object& object, Point2 p) -> Point2 {
  const Point2 off = p - xy(object.centre);
  return {dot(off, object.axis), dot(off, left_of(object.axis))};
}

/// A crown of some overlapping ellipsoids over a trunk.
void add_tree(std::vector<Object>& objects, Point3 foot, base::Random& random) {
  const double radius = random.uniform(1.3, 3.2), trunk = random.uniform(1.5, 2.5), high = random.uniform(0.9, 1.4);
  const Point3 crown = foot + Point3{0, 0, trunk + radius * high};
  objects.push_back({Object::Form::ellipsoid, crown, {1, 0}, {radius, radius, radius * high}});
  for (int lump = 0; lump < 4; ++lump) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), r = random.uniform(0.4, 0.7) * radius;
    const Point3 off{0.6 * radius * geometry::cosine(angle), 0.6 * radius * geometry::sine(angle),
                     random.uniform(-0.5, 0.6) * radius};
    objects.push_back({Object::Form::ellipsoid, crown + off, {1, 0}, {r, r, r}});
  }
  objects.push_back({Object::Form::box, foot + Point3{0, 0, trunk / 2 - 0.5}, {1, 0}, {0.25, 0.25, trunk / 2 + 1}});
}

void add_car(std::vector<Object>& objects, Point3 foot, Point2 axis, base::Random& random) {
  const double half_length = random.uniform(1.9, 2.4);
  objects.push_back({Object::Form::box, foot + Point3{0, 0, 0.25}, axis, {half_length, 0.9, 0.65}});
  const Point2 back = -0.2 * half_length * axis;
  objects.push_back({Object::Form::box, foot + Point3{back.x, back.y, 0.9}, axis, {0.5 * half_length, 0.8, 0.55}});
}

/// Where no building stands, nor nearer than `clear`.
class OpenGround {
 public:
  OpenGround(const Surface& surface, const Nearest& nearest, const Terrain& terrain)
      : above_(surface.mesh), nearest_(&nearest), terrain_(&terrain) {}

  [[nodiscard]] auto foot(Point2 p) const -> Point3 { return {p.x, p.y, terrain_->at(p)}; }
  [[nodiscard]] auto free(Point2 p, double clear) const -> bool {
    constexpr double chest = 1.5;
    return !above_.top(p) && !nearest_->find(foot(p) + Point3{0, 0, chest}, {}, clear);
  }
  /// Along the nearest wall, where there is one within 8 m; else as given.
  [[nodiscard]] auto along(Point2 p, Point2 otherwise) const -> Point2 {
    const auto wall = nearest_->find(foot(p) + Point3{0, 0, 1.0}, {}, 8.0);
    if (!wall) return otherwise;
    const Point2 across = normalised(xy(nearest_->normal(wall->triangle)));
    return across == Point2{} ? otherwise : left_of(across);
  }

 private:
  rays::Scene above_;
  const Nearest* nearest_;
  const Terrain* terrain_;
};

/// A crown at a place of the plan, over a trunk that begins at `foot`.
void add_crown(std::vector<Object>& objects, Point3 foot, double middle, double radius, base::Random& random) {
  const Point3 crown{foot.x, foot.y, middle};
  objects.push_back({Object::Form::ellipsoid, crown, {1, 0}, {radius, radius, radius * random.uniform(0.9, 1.3)}});
  for (int lump = 0; lump < 5; ++lump) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), r = random.uniform(0.35, 0.6) * radius;
    const Point3 off{0.7 * radius * geometry::cosine(angle), 0.7 * radius * geometry::sine(angle),
                     random.uniform(-0.4, 0.7) * radius};
    objects.push_back({Object::Form::ellipsoid, crown + off, {1, 0}, {r, r, r}});
  }
  const double half = (middle - foot.z) / 2;
  objects.push_back({Object::Form::box, foot + Point3{0, 0, half}, {1, 0}, {0.25, 0.25, half + 0.5}});
}

/// Trees beside buildings whose crowns are over the roof, and trees within the outlines.
void add_crowns(Surroundings& out, const Surface& surface, const Terrain& terrain, const ScanOptions& options,
                std::uint64_t seed) {
  std::map<std::uint32_t, Box2> boxes;
  for (std::uint32_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    if (surface.classes[t] != Class::roof) continue;
    for (const auto v : surface.mesh.triangles[t]) boxes[surface.buildings[t]].add(xy(surface.mesh.vertices[v]));
  }
  const rays::Scene above(surface.mesh);
  for (const auto& [building, box] : boxes) {
    base::Random random(seed, 100000 + building);
    // Drawn whether or not asked for: one option leaves the other's trees where they are.
    const bool beside = random.uniform() < options.crowns, within = random.uniform() < options.roof_trees;
    const auto on_building = [&](Point2 p) {
      const auto seen = above.seen_from_above(p);
      return seen && surface.buildings[seen->triangle] == building;
    };
    const auto place = [&](double grown, auto fits) -> std::optional<Point2> {
      const auto area = box.grown(grown);
      for (int tries = 0; tries < 200; ++tries) {
        const Point2 p{random.uniform(area.least.x, area.most.x), random.uniform(area.least.y, area.most.y)};
        if (fits(p)) return p;
      }
      return std::nullopt;
    };
    const double radius = random.uniform(1.4, 2.8), second = random.uniform(1.2, 2.2), lift = random.uniform(-0.3, 0.8);
    // Just outside, so that a third of the crown or more is over the roof.
    const auto outside = place(2, [&](Point2 p) {
      if (above.top(p)) return false;
      for (int k = 0; k < 8; ++k) {
        const double angle = k * std::numbers::pi / 4;
        if (on_building(p + 0.6 * radius * Point2{geometry::cosine(angle), geometry::sine(angle)})) return true;
      }
      return false;
    });
    const auto inside = place(0, on_building);
    if (beside && outside) {
      double roof = -std::numeric_limits<double>::infinity();
      for (int k = 0; k < 8; ++k) {
        const double angle = k * std::numbers::pi / 4;
        const Point2 p = *outside + 0.6 * radius * Point2{geometry::cosine(angle), geometry::sine(angle)};
        if (on_building(p)) roof = std::max(roof, *above.top(p));
      }
      add_crown(out.objects, {outside->x, outside->y, terrain.at(*outside)}, roof + lift, radius, random);
      out.crowns.push_back({{outside->x, outside->y, roof + lift}, radius, building, false});
    }
    if (within && inside) {
      const double middle = *above.top(*inside) + 0.5 * second;
      add_crown(out.objects, {inside->x, inside->y, terrain.at(*inside)}, middle, second, random);
      out.crowns.push_back({{inside->x, inside->y, middle}, second, building, true});
    }
  }
}

void add_chimneys(std::vector<Object>& objects, const Surface& surface, const ScanOptions& options,
                  std::uint64_t seed) {
  struct Summit {
    Point3 at, towards;
  };
  std::map<std::uint32_t, Summit> summits;
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    if (surface.classes[t] != Class::roof) continue;
    const auto& corners = surface.mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 v = surface.mesh.vertices[corners[i]], w = surface.mesh.vertices[corners[(i + 1) % 3]];
      const auto [at, fresh] = summits.emplace(surface.buildings[t], Summit{v, w});
      if (!fresh && v.z > at->second.at.z) at->second = {v, w};
    }
  }
  for (const auto& [building, summit] : summits) {
    base::Random random(seed, 1000 + building);
    if (random.uniform() >= options.chimneys) continue;
    const Point2 inward = normalised(xy(summit.towards - summit.at));
    const Point2 at = xy(summit.at) + random.uniform(0.4, 1.2) * inward;
    const Point2 axis = inward == Point2{} ? Point2{1, 0} : inward;
    objects.push_back({Object::Form::box,
                       {at.x, at.y, summit.at.z - 0.2},
                       axis,
                       {random.uniform(0.3, 0.45), random.uniform(0.4, 0.8), random.uniform(1.0, 1.6)}});
  }
}

}  // namespace

auto on_ground(const Surface& surface) -> std::vector<bool> {
  std::map<std::uint32_t, double> lowest;
  const auto& mesh = surface.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto v : mesh.triangles[t]) {
      const auto [at, fresh] = lowest.emplace(surface.buildings[t], mesh.vertices[v].z);
      if (!fresh) at->second = std::min(at->second, mesh.vertices[v].z);
    }
  std::vector<bool> out(mesh.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t)
    out[t] = surface.classes[t] == Class::ground &&
             mesh.vertices[mesh.triangles[t][0]].z <= lowest[surface.buildings[t]] + superstructure;
  return out;
}

Terrain::Terrain(const Surface& surface, const Box2& area, const ScanOptions& options, std::uint64_t seed)
    : origin_(area.least),
      columns_(static_cast<std::size_t>((area.most.x - area.least.x) / knot) + 2),
      rows_(static_cast<std::size_t>((area.most.y - area.least.y) / knot) + 2),
      heights_(columns_ * rows_),
      waves_(options.ground_waves),
      noise_(seed, options.ground_length) {
  const auto feet = feet_of(surface);
  base::parallel_for(rows_, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      const Point2 p = origin_ + Point2{knot * static_cast<double>(column), knot * static_cast<double>(row)};
      double sum = 0, weights = 0;
      for (const Point3 foot : feet) {
        const Point2 off = p - xy(foot);
        const double near = dot(off, off) + 0.25, weight = 1 / (near * near);
        sum += weight * foot.z;
        weights += weight;
      }
      heights_[row * columns_ + column] = weights > 0 ? sum / weights : 0;
    }
  });
}

auto Terrain::smooth(Point2 p) const -> double {
  const double x = std::clamp((p.x - origin_.x) / knot, 0.0, static_cast<double>(columns_ - 1));
  const double y = std::clamp((p.y - origin_.y) / knot, 0.0, static_cast<double>(rows_ - 1));
  const auto c = std::min(static_cast<std::size_t>(x), columns_ - 2),
             r = std::min(static_cast<std::size_t>(y), rows_ - 2);
  const double u = x - static_cast<double>(c), v = y - static_cast<double>(r);
  const double* low = &heights_[r * columns_ + c];
  const double* high = low + columns_;
  return (1 - v) * ((1 - u) * low[0] + u * low[1]) + v * ((1 - u) * high[0] + u * high[1]);
}

auto Terrain::at(Point2 p) const -> double { return smooth(p) + (waves_ > 0 ? waves_ * noise_.at({p.x, p.y, 0}) : 0); }

auto Object::span(Point2 p) const -> std::optional<std::pair<double, double>> {
  const Point2 q = in_frame(*this, p);
  if (form == Form::box) {
    if (std::abs(q.x) > half.x || std::abs(q.y) > half.y) return std::nullopt;
    return std::pair(centre.z - half.z, centre.z + half.z);
  }
  const double left = 1 - q.x * q.x / (half.x * half.x) - q.y * q.y / (half.y * half.y);
  if (left <= 0) return std::nullopt;
  const double reach = half.z * std::sqrt(left);
  return std::pair(centre.z - reach, centre.z + reach);
}

auto Object::distance(Point3 p) const -> double {
  const Point2 q = in_frame(*this, xy(p));
  const double z = p.z - centre.z;
  if (form == Form::ellipsoid) {
    const double scaled = length(Point3{q.x / half.x, q.y / half.y, z / half.z});
    return std::abs(scaled - 1) * std::min({half.x, half.y, half.z});
  }
  const Point3 out{std::abs(q.x) - half.x, std::abs(q.y) - half.y, std::abs(z) - half.z};
  if (const double inside = std::max({out.x, out.y, out.z}); inside <= 0) return -inside;
  return length(Point3{std::max(out.x, 0.0), std::max(out.y, 0.0), std::max(out.z, 0.0)});
}

auto Object::bounds() const -> Box2 {
  const double reach = length(Point2{half.x, half.y});
  return Box2{xy(centre), xy(centre)}.grown(reach);
}

auto surroundings_of(const Surface& surface, const Nearest& nearest, const Terrain& terrain, const Box2& area,
                     const ScanOptions& options, std::uint64_t seed) -> Surroundings {
  Surroundings out;
  auto& objects = out.objects;
  const OpenGround ground(surface, nearest, terrain);
  base::Random random(seed);
  const Point2 extent = area.most - area.least;
  constexpr double crown = 4.5;  // m; nothing is cut by the border
  const auto place = [&] {
    return area.least +
           Point2{crown + random.uniform() * (extent.x - 2 * crown), crown + random.uniform() * (extent.y - 2 * crown)};
  };
  const double size = std::max(0.0, extent.x - 2 * crown) * std::max(0.0, extent.y - 2 * crown);
  // Places drawn on buildings count for nothing, so that the density is that of the open ground.
  const auto tries = [&](double per_1000) { return static_cast<std::size_t>(std::lround(per_1000 * size / 1000)); };
  for (std::size_t i = 0; i < tries(options.trees); ++i)
    if (const Point2 p = place(); ground.free(p, 1.5)) add_tree(objects, ground.foot(p), random);
  for (std::size_t i = 0; i < tries(options.cars); ++i) {
    const Point2 p = place();
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const Point2 axis = ground.along(p, {geometry::cosine(angle), geometry::sine(angle)});
    if (ground.free(p, 2.5)) add_car(objects, ground.foot(p), axis, random);
  }
  add_chimneys(objects, surface, options, seed);
  if (options.crowns > 0 || options.roof_trees > 0) add_crowns(out, surface, terrain, options, seed);
  return out;
}

}  // namespace mansard::simulate::detail
