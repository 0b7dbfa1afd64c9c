#include "mansard/derive/detail/parting.hpp"

#include "mansard/base/text.hpp"

namespace mansard::derive::detail {
namespace {

using geometry::Polygon;

auto box_of(const Polygon& polygon) -> geometry::Box2 { return geometry::bounds(polygon.outer); }

/// The piece without what is narrower than `slip`, and off the other polygon, from which rounding may have moved it.
auto opened(const Polygon& piece, const Polygon& other, double slip) -> base::Result<std::vector<Polygon>> {
  std::vector<Polygon> out;
  const auto core = geometry::buffer(piece, -slip / 2);
  if (!core) return core.failure();
  for (const auto& part : *core) {
    const auto whole = geometry::buffer(part, slip / 2);
    if (!whole) return whole.failure();
    for (const auto& one : *whole) {
      const auto apart = geometry::subtract(one, other);
      if (!apart) return apart.failure();
      out.insert(out.end(), apart->begin(), apart->end());
    }
  }
  return out;
}

}  // namespace

auto kept(const std::string& what, const base::Diagnostic& why, const Polygon& polygon) -> base::Diagnostic {
  const auto box = geometry::bounds(polygon.outer);
  return base::warning("derive-outline-kept", "the derived footprint near " +
                                                  base::to_text((box.least.x + box.most.x) / 2, 1) + ", " +
                                                  base::to_text((box.least.y + box.most.y) / 2, 1) +
                                                  " m from the origin " + what + " (" + why.message + ")");
}

auto clipped(const Polygon& polygon, const geometry::Box2& to, std::vector<base::Diagnostic>& warnings)
    -> std::vector<Polygon> {
  const auto box = geometry::bounds(polygon.outer);
  if (to.contains(box.least) && to.contains(box.most)) return {polygon};
  const Polygon frame{{to.least, {to.most.x, to.least.y}, to.most, {to.least.x, to.most.y}}, {}};
  auto common = geometry::intersect(polygon, frame);
  if (common) return std::move(*common);
  warnings.push_back(kept("could not be clipped at the end of the mesh", common.error(), polygon));
  return {polygon};
}

auto parted(std::vector<Polygon> polygons, const std::vector<Polygon>& before, double slip_width,
            std::vector<base::Diagnostic>& warnings) -> std::vector<Polygon> {
  for (const auto& other : before) {
    std::vector<Polygon> rest;
    for (auto& polygon : polygons) {
      if (!box_of(polygon).overlaps(box_of(other))) {
        rest.push_back(std::move(polygon));
        continue;
      }
      const auto common = geometry::intersect(polygon, other);
      if (common && common->empty()) {
        rest.push_back(std::move(polygon));
        continue;
      }
      const auto left = geometry::subtract(polygon, other);
      if (!left) {
        warnings.push_back(kept("could not be parted from another one, and may overlap it", left.error(), polygon));
        rest.push_back(std::move(polygon));
        continue;
      }
      for (const auto& piece : *left) {
        const auto wide = opened(piece, other, slip_width);
        if (!wide) warnings.push_back(kept("keeps the slivers that another one left of it", wide.error(), polygon));
        if (wide) rest.insert(rest.end(), wide->begin(), wide->end());
        else rest.push_back(piece);
      }
    }
    polygons = std::move(rest);
  }
  return polygons;
}

auto simple(const Polygon& polygon, std::vector<base::Diagnostic>& warnings) -> std::vector<Polygon> {
  constexpr double apart = 0.01;  // m
  auto pieces = geometry::simple_pieces(polygon, apart);
  if (pieces) return std::move(*pieces);
  warnings.push_back(kept("is left out, because no simple outline could be made of it", pieces.error(), polygon));
  return {};
}

}  // namespace mansard::derive::detail
