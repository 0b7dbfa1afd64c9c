// Boolean operations and triangulation by GEOS, through its re-entrant C interface.
#include <geos_c.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>

#include "mansard/geometry/polygon.hpp"

namespace mansard::geometry {
namespace {

struct Context {
  Context() : handle(GEOS_init_r()) {
    GEOSContext_setErrorMessageHandler_r(
        handle, [](const char* words, void* self) { static_cast<Context*>(self)->message = words; }, this);
  }
  Context(const Context&) = delete;
  auto operator=(const Context&) -> Context& = delete;
  ~Context() { GEOS_finish_r(handle); }

  GEOSContextHandle_t handle;
  std::string message;
};

struct Drop {
  Context* context;
  void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context->handle, g); }
};
using Shape = std::unique_ptr<GEOSGeometry, Drop>;

auto keep(Context& context, GEOSGeometry* g) -> Shape { return Shape(g, Drop{&context}); }

auto to_ring(Context& context, const Ring& ring) -> GEOSGeometry* {
  const auto n = static_cast<unsigned>(ring.size());
  GEOSCoordSequence* points = GEOSCoordSeq_create_r(context.handle, n + 1, 2);
  for (unsigned i = 0; i <= n; ++i) GEOSCoordSeq_setXY_r(context.handle, points, i, ring[i % n].x, ring[i % n].y);
  return GEOSGeom_createLinearRing_r(context.handle, points);
}

auto to_shape(Context& context, const Polygon& polygon) -> Shape {
  if (polygon.outer.size() < 3) return keep(context, GEOSGeom_createEmptyPolygon_r(context.handle));
  std::vector<GEOSGeometry*> holes;
  for (const auto& hole : polygon.holes)
    if (hole.size() >= 3) holes.push_back(to_ring(context, hole));
  return keep(context, GEOSGeom_createPolygon_r(context.handle, to_ring(context, polygon.outer), holes.data(),
                                                static_cast<unsigned>(holes.size())));
}

auto from_ring(Context& context, const GEOSGeometry* ring) -> Ring {
  const GEOSCoordSequence* points = GEOSGeom_getCoordSeq_r(context.handle, ring);
  unsigned n = 0;
  GEOSCoordSeq_getSize_r(context.handle, points, &n);
  Ring out;
  for (unsigned i = 0; i + 1 < n; ++i) {
    Point2 p;
    GEOSCoordSeq_getXY_r(context.handle, points, i, &p.x, &p.y);
    out.push_back(p);
  }
  return out;
}

void collect(Context& context, const GEOSGeometry* g, std::vector<Polygon>& out) {
  const int type = GEOSGeomTypeId_r(context.handle, g);
  if (type == GEOS_POLYGON) {
    if (GEOSisEmpty_r(context.handle, g) != 0) return;
    Polygon polygon;
    polygon.outer = from_ring(context, GEOSGetExteriorRing_r(context.handle, g));
    for (int i = 0; i < GEOSGetNumInteriorRings_r(context.handle, g); ++i)
      polygon.holes.push_back(from_ring(context, GEOSGetInteriorRingN_r(context.handle, g, i)));
    polygon = oriented(std::move(polygon));
    if (area(polygon) > 0) out.push_back(std::move(polygon));
  } else if (type == GEOS_MULTIPOLYGON || type == GEOS_GEOMETRYCOLLECTION) {
    for (int i = 0; i < GEOSGetNumGeometries_r(context.handle, g); ++i)
      collect(context, GEOSGetGeometryN_r(context.handle, g, i), out);
  }
}

/// Whether products of the coordinates can be computed. GEOS makes no ring of coordinates that are not numbers and
/// loses polygons without a word where its products overflow.
auto computable(const Polygon& polygon) -> bool {
  constexpr double limit = 1e150;  // m; the square of a difference stays below 1e301
  const auto good = [](Point2 p) { return std::abs(p.x) <= limit && std::abs(p.y) <= limit; };
  return std::ranges::all_of(polygon.outer, good) &&
         std::ranges::all_of(polygon.holes, [&](const Ring& hole) { return std::ranges::all_of(hole, good); });
}

constexpr const char* not_computable = "a coordinate is not a number, or beyond 1e150 m";

using Operation = std::function<GEOSGeometry*(Context&)>;

auto polygons_of(std::initializer_list<std::span<const Polygon>> inputs, const Operation& operation)
    -> base::Result<std::vector<Polygon>> {
  for (const auto& polygons : inputs)
    if (!std::ranges::all_of(polygons, computable)) return base::error("geometry-boolean", not_computable);
  Context context;
  const Shape result = keep(context, operation(context));
  // The library takes it for a failure of the operation, and callers for a fault of the polygons.
  if (!result && context.message.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  // A normal form, so that the order does not depend on the library's inner workings.
  if (!result || GEOSNormalize_r(context.handle, result.get()) != 0)
    return base::error("geometry-boolean", context.message);
  std::vector<Polygon> out;
  collect(context, result.get(), out);
  return out;
}

auto one(const Polygon& polygon) -> std::span<const Polygon> { return {&polygon, 1}; }

enum class Keep : std::uint8_t { inside, outside };

/// The part of `a` on one side of `b`; on a grid of that size, or with all digits where it is 0.
auto part_of(const Polygon& a, const Polygon& b, Keep side, double grid) -> base::Result<std::vector<Polygon>> {
  return polygons_of({one(a), one(b)}, [&](Context& context) {
    const Shape p = to_shape(context, a), q = to_shape(context, b);
    auto* handle = context.handle;
    if (grid > 0)
      return side == Keep::inside ? GEOSIntersectionPrec_r(handle, p.get(), q.get(), grid)
                                  : GEOSDifferencePrec_r(handle, p.get(), q.get(), grid);
    return side == Keep::inside ? GEOSIntersection_r(handle, p.get(), q.get())
                                : GEOSDifference_r(handle, p.get(), q.get());
  });
}

/// Somewhere inside.
auto place_in(const Polygon& polygon) -> std::optional<Point2> {
  Context context;
  const Shape point = keep(context, GEOSPointOnSurface_r(context.handle, to_shape(context, polygon).get()));
  Point2 p;
  if (!point || GEOSGeomGetX_r(context.handle, point.get(), &p.x) != 1 ||
      GEOSGeomGetY_r(context.handle, point.get(), &p.y) != 1)
    return std::nullopt;
  return p;
}

/// Whether all parts of `a` are where they should be, as far as they are larger than rounding, and not larger than `a`.
auto are_on(Keep side, const std::vector<Polygon>& parts, const Polygon& a, const Polygon& b) -> bool {
  const Box2 box = bounds(a.outer);
  const Point2 extent = box.most - box.least;
  const double little = 1e-9 * dot(extent, extent);  // far more than rounding loses
  double rest = std::abs(area(a));
  for (const auto& part : parts) {
    rest -= area(part);
    if (area(part) <= little) continue;
    const auto place = place_in(part);
    if (place && contains(b, *place) != (side == Keep::inside)) return false;
  }
  return rest >= -little;
}

/// With all digits GEOS 3.11 sometimes takes a part for its opposite, without a word, where edges of both polygons are
/// within rounding of one line: what is inside of `b` is then left in the difference, and lacks in the intersection.
/// Where any part of `a` is not on its side, both are made again on a grid that is coarser than rounding and finer than
/// anything else, where it cannot happen.
struct Divided {
  Polygon a, b;
  base::Result<std::vector<Polygon>> inside, outside;

  Divided(const Polygon& first, const Polygon& second)
      : a(first), b(second), inside(part_of(a, b, Keep::inside, 0)), outside(part_of(a, b, Keep::outside, 0)) {
    const auto good = [this](const auto& in, const auto& out) {
      return are_on(Keep::inside, in, a, b) && are_on(Keep::outside, out, a, b);
    };
    if (!inside || !outside || good(*inside, *outside)) return;
    double most = 1;
    for (const auto* polygon : {&a, &b})
      for (const Point2 p : polygon->outer) most = std::max({most, std::abs(p.x), std::abs(p.y)});
    constexpr int digits = 40;  // binary ones that are left of 53: 0.1 nm for blocks of 100 m
    const double grid = std::ldexp(1.0, std::ilogb(most) - digits);
    auto in = part_of(a, b, Keep::inside, grid), out = part_of(a, b, Keep::outside, grid);
    if (!in || !out || !good(*in, *out)) return;
    inside = std::move(in);
    outside = std::move(out);
  }
};

/// One side of it. The last few of a thread are kept: who asks for one side often asks for the other, too, and for the
/// same again a little later.
auto divided(const Polygon& a, const Polygon& b, Keep side) -> base::Result<std::vector<Polygon>> {
  if (!bounds(a.outer).overlaps(bounds(b.outer))) return part_of(a, b, side, 0);
  constexpr std::size_t most_kept = 8;
  thread_local std::vector<Divided> kept;  // the last used at the end
  auto found = std::ranges::find_if(kept, [&](const Divided& one) { return one.a == a && one.b == b; });
  if (found == kept.end()) {
    Divided made(a, b);
    if (kept.size() == most_kept) kept.erase(kept.begin());
    kept.push_back(std::move(made));
  } else {
    std::rotate(found, std::next(found), kept.end());
  }
  return side == Keep::inside ? kept.back().inside : kept.back().outside;
}

}  // namespace

auto unite(std::span<const Polygon> polygons) -> base::Result<std::vector<Polygon>> {
  return polygons_of({polygons}, [&](Context& context) {
    std::vector<GEOSGeometry*> shapes;
    for (const auto& polygon : polygons) shapes.push_back(to_shape(context, polygon).release());
    const Shape all = keep(context, GEOSGeom_createCollection_r(context.handle, GEOS_MULTIPOLYGON, shapes.data(),
                                                                static_cast<unsigned>(shapes.size())));
    return GEOSUnaryUnion_r(context.handle, all.get());
  });
}

auto intersect(const Polygon& a, const Polygon& b) -> base::Result<std::vector<Polygon>> {
  return divided(a, b, Keep::inside);
}

auto subtract(const Polygon& a, const Polygon& b) -> base::Result<std::vector<Polygon>> {
  return divided(a, b, Keep::outside);
}

auto buffer(const Polygon& polygon, double by) -> base::Result<std::vector<Polygon>> {
  if (!std::isfinite(by)) return base::error("geometry-boolean", "the distance is not a finite number");
  return polygons_of({one(polygon)}, [&](Context& context) {
    return GEOSBufferWithStyle_r(context.handle, to_shape(context, polygon).get(), by, 8, GEOSBUF_CAP_FLAT,
                                 GEOSBUF_JOIN_MITRE, 2.0);
  });
}

auto make_valid(const Polygon& polygon) -> base::Result<std::vector<Polygon>> {
  return polygons_of({one(polygon)}, [&](Context& context) {
    return GEOSMakeValid_r(context.handle, to_shape(context, polygon).get());
  });
}

auto simple_pieces(const Polygon& polygon, double apart) -> base::Result<std::vector<Polygon>> {
  if (is_simple(polygon)) return std::vector{polygon};
  auto pieces = buffer(polygon, -apart);
  if (pieces && !std::ranges::all_of(*pieces, is_simple))
    return base::error("geometry-boolean", "rings touch even after they were moved apart");
  return pieces;
}

auto triangulate(const Polygon& polygon) -> base::Result<std::vector<std::array<std::uint32_t, 3>>> {
  if (!computable(polygon)) return base::error("geometry-triangulate", not_computable);
  std::map<Point2, std::uint32_t> index;
  std::uint32_t count = 0;
  for (const Point2 p : polygon.outer) index.emplace(p, count++);
  for (const auto& hole : polygon.holes)
    for (const Point2 p : hole) index.emplace(p, count++);

  Context context;
  const Shape shape = to_shape(context, polygon);
  const Shape parts = keep(context, GEOSConstrainedDelaunayTriangulation_r(context.handle, shape.get()));
  if (!parts) return base::error("geometry-triangulate", context.message);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int i = 0; i < GEOSGetNumGeometries_r(context.handle, parts.get()); ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(context.handle, parts.get(), i);
    Ring ring = from_ring(context, GEOSGetExteriorRing_r(context.handle, part));
    if (signed_area(ring) < 0) std::ranges::reverse(ring);
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = ring.size() == 3 ? index.find(ring[k]) : index.end();
      if (at == index.end()) return base::error("geometry-triangulate", "the triangulation moved a point");
      triangle[k] = at->second;
    }
    triangles.push_back(triangle);
  }
  if (triangles.empty()) return base::error("geometry-triangulate", "the polygon has no area");
  return triangles;
}

}  // namespace mansard::geometry
