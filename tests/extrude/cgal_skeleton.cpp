// The roof nodes of a tent against CGAL's unweighted straight skeleton: another library's opinion, of an algorithm that
// shares nothing with ours but the definition. Its part of CGAL is GPL, so it stays in this file.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/create_straight_skeleton_2.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <exception>
#include <limits>
#include <optional>

#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "mansard/extrude/extrude.hpp"
#include "plans.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace model = mansard::model;

using namespace plans;
using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPolygon = CGAL::Polygon_2<CgalKernel>;

/// MANSARD_SEED shifts the seeds of the random cases.
auto first_seed() -> std::uint64_t {
  const char* text = std::getenv("MANSARD_SEED");
  return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

/// The rings that the kernel really raises, as doubles relative to the footprint's origin. It lies within `tolerance`
/// of the plan, which is further than the nodes may differ here.
auto canonical_rings(const Plan& p) -> std::vector<Ring> {
  std::string why;
  const auto source = extrude::detail::prepared(p);
  if (!source) return {};
  const auto footprint = extrude::detail::canonical(*source, {}, why);
  if (!footprint) return {};
  std::vector<Ring> rings;
  for (const auto& corners : footprint->corners) {
    rings.emplace_back();
    for (const auto& corner : corners)
      rings.back().push_back({footprint->origin.x + corner.x.get_d(), footprint->origin.y + corner.y.get_d()});
  }
  return rings;
}

/// Places (x, y, time) of CGAL's inner nodes; nothing where CGAL gives up.
auto nodes_of_cgal(const std::vector<Ring>& rings) -> std::optional<std::vector<Point3>> {
  std::vector<CgalPolygon> polygons;
  for (const Ring& ring : rings) {
    polygons.emplace_back();
    for (const Point2 p : ring) polygons.back().push_back({p.x, p.y});
  }
  try {
    const auto skeleton = CGAL::create_interior_straight_skeleton_2(
        polygons[0].vertices_begin(), polygons[0].vertices_end(), polygons.begin() + 1, polygons.end(), CgalKernel());
    if (!skeleton) return std::nullopt;
    std::vector<Point3> nodes;
    for (auto v = skeleton->vertices_begin(); v != skeleton->vertices_end(); ++v)
      if (v->is_skeleton()) nodes.push_back({v->point().x(), v->point().y(), v->time()});
    return nodes;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

auto distance_to(const std::vector<Point3>& points, Point3 p) -> double {
  double least = std::numeric_limits<double>::infinity();
  for (const Point3 q : points) least = std::min(least, length(p - q));
  return least;
}

/// How far above or below our roof the point is. Collinear edges whose roofs meet share a face here, and where doubles
/// have turned them against each other by an ulp, CGAL parts that face anywhere: its node is no corner of ours then.
auto distance_to_roof(const model::Solid& solid, Point3 p) -> double {
  double least = std::numeric_limits<double>::infinity();
  for (const double height : roofs_over(solid, xy(p))) least = std::min(least, std::abs(p.z - height));
  return least;
}

struct Agreement {
  std::size_t nodes = 0, within_a_face = 0, refused_by_cgal = 0;
};

constexpr double near = 1e-3;  // m

/// Every node of CGAL's has one of ours within a millimetre, and every one of ours has one of CGAL's.
void expect_agreement(const Plan& p, const std::string& what, Agreement& sum) {
  SCOPED_TRACE(what + ": " + text(p));
  const auto raised = extrude::raise(p);
  ASSERT_TRUE(raised) << base::to_string(raised.error());
  ASSERT_EQ(raised->outcome, extrude::Outcome::full);
  const auto rings = canonical_rings(p);
  ASSERT_FALSE(rings.empty());
  const auto theirs = nodes_of_cgal(rings);
  if (!theirs) {
    ++sum.refused_by_cgal;
    return;
  }
  for (const Point3 node : *theirs) {
    ++sum.nodes;
    if (distance_to(raised->solid.vertices, node) <= near) continue;
    ++sum.within_a_face;
    EXPECT_LE(distance_to_roof(raised->solid, node), near) << "CGAL's (" << node.x << " " << node.y << " " << node.z;
  }
  for (const Point3 node : raised->solid.vertices) {
    if (node.z > near) {
      EXPECT_LE(distance_to(*theirs, node), near) << "ours (" << node.x << " " << node.y << " " << node.z;
    }
  }
}

auto tent_over(Ring outer, std::vector<Ring> holes = {}) -> Plan {
  return plan(std::move(outer), {tent}, {}, 1000, std::move(holes));
}

TEST(CgalSkeleton, agrees_on_convex_polygons) {
  Agreement sum;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + 40; ++seed) {
    base::Random random(seed);
    std::vector<double> angles(4 + random.index(17));
    for (double& a : angles) a = random.uniform(0, 2 * std::numbers::pi);
    std::ranges::sort(angles);
    Ring ring;  // on an ellipse
    for (const double a : angles) ring.push_back({15 * std::cos(a), 8 * std::sin(a)});
    expect_agreement(turned(tent_over(ring), 0.7), "seed " + std::to_string(seed), sum);
  }
  for (int n = 3; n <= 16; ++n) {
    Ring ring;
    for (int i = 0; i < n; ++i)
      ring.push_back({9 * std::cos(2 * std::numbers::pi * i / n), 9 * std::sin(2 * std::numbers::pi * i / n)});
    expect_agreement(tent_over(ring), "regular " + std::to_string(n), sum);
  }
  EXPECT_GT(sum.nodes, 300U);
  EXPECT_LE(sum.within_a_face, sum.nodes / 100);  // of edges that are all but collinear
  EXPECT_EQ(sum.refused_by_cgal, 0U);
}

TEST(CgalSkeleton, agrees_on_stars) {
  Agreement sum;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + 60; ++seed) {
    base::Random random(seed);
    expect_agreement(tent_over(star(random, 5 + random.index(36))), "seed " + std::to_string(seed), sum);
  }
  EXPECT_GT(sum.nodes, 1000U);
  EXPECT_LE(sum.within_a_face, sum.nodes / 100);
  EXPECT_EQ(sum.refused_by_cgal, 0U);
}

TEST(CgalSkeleton, agrees_on_orthogonal_polygons_with_many_simultaneous_events) {
  Agreement sum;
  std::size_t polygons = 0;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + 80; ++seed) {
    base::Random random(seed);
    const Ring ring = rectilinear(random, 3 + random.index(18));
    if (ring.empty()) continue;
    ++polygons;
    expect_agreement(tent_over(ring), "seed " + std::to_string(seed), sum);
    expect_agreement(turned(tent_over(ring), 0.3), "turned, seed " + std::to_string(seed), sum);
  }
  EXPECT_GT(polygons, 30U);
  EXPECT_GT(sum.nodes, 500U);
  EXPECT_LT(sum.within_a_face, sum.nodes / 4);
  EXPECT_EQ(sum.refused_by_cgal, 0U);
}

TEST(CgalSkeleton, agrees_on_polygons_with_holes) {
  Agreement sum;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + 30; ++seed) {
    base::Random random(seed);
    std::vector<Ring> holes;
    for (int i = 0; i < 4; ++i) {  // in the quarters of a box of 60 by 50 m
      if (random.index(3) == 0) continue;
      Ring hole = turned_in(random.index(2) == 0 ? star(random, 3 + random.index(6)) : box(10, 7));
      const double angle = random.index(2) == 0 ? 0 : random.uniform(0, 3);
      const Point2 centre{i % 2 == 0 ? 15.0 : 45.0, i < 2 ? 13.0 : 37.0};
      for (Point2& v : hole)
        v = centre +
            Point2{std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y};
      holes.push_back(std::move(hole));
    }
    expect_agreement(turned(tent_over(box(60, 50), holes), 0.1 * static_cast<double>(random.index(5))),
                     "seed " + std::to_string(seed), sum);
  }
  EXPECT_GT(sum.nodes, 300U);
  EXPECT_LT(sum.within_a_face, sum.nodes / 20);
  EXPECT_EQ(sum.refused_by_cgal, 0U);
}

/// The comparison itself: a node that has moved by two millimetres is noticed.
TEST(CgalSkeleton, sees_a_node_that_is_two_millimetres_off) {
  const auto theirs = nodes_of_cgal({box(10, 6)});
  ASSERT_TRUE(theirs);
  ASSERT_EQ(theirs->size(), 2U);
  const auto raised = extrude::raise(shifted(tent_over(box(10, 6)), {0, 0.002}));
  ASSERT_TRUE(raised);
  for (const Point3 node : *theirs) {
    EXPECT_GT(distance_to(raised->solid.vertices, node), near);
    EXPECT_GT(distance_to_roof(raised->solid, node), near);
  }
}

}  // namespace
