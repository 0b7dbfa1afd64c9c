// Parts that are taller than they are wide: only where the mesh shows their walls.
#include <gtest/gtest.h>

#include <algorithm>

#include "mansard/refine/detail/tall.hpp"
#include "scans.hpp"

namespace {

using namespace scans;

const geometry::Ring house = rectangle(10, 20, 12, 8), tower = rectangle(14, 22, 3, 3);

auto box(const geometry::Ring& ring, double height) -> Plan {
  return plan(ring, std::vector<Profile>(ring.size(), wall(height)), height);
}

/// What a camera above sees of it: nothing of the walls.
auto without_walls(geometry::Mesh mesh) -> geometry::Mesh {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const auto [low, high] = std::minmax({mesh.vertices[t[0]].z, mesh.vertices[t[1]].z, mesh.vertices[t[2]].z});
    return high - low > 1;
  });
  return mesh;
}

/// How high the house is modelled, m, of a scan with something over it.
auto height_with(const geometry::Mesh& mesh) -> double {
  const rays::Scene scene(mesh);
  const std::vector drafts{flat_draft(house, 6)};
  double top = 0;
  for (const auto& part : refine::refine(drafts, scene, {}, {}).parts)
    top = std::max(top, top_of(part.raised.solid) - ground);
  return top;
}

TEST(Tall, a_tower_whose_walls_are_seen_is_a_part) {
  EXPECT_NEAR(height_with(scanned({box(house, 6), box(tower, 18)})), 18, 0.1);
}

TEST(Tall, what_hangs_in_the_air_is_none) {
  const auto floating = without_walls(scanned({box(house, 6), box(tower, 18)}));
  EXPECT_LT(height_with(floating), 9);
  // Without the limit it is one.
  refine::Options free;
  free.tall.ratio = 0;
  const std::vector drafts{flat_draft(house, 6)};
  EXPECT_EQ(refine::refine(drafts, rays::Scene(floating), free, {}).parts.size(), 2U);
}

TEST(Tall, what_is_wider_than_it_is_tall_needs_no_walls) {
  EXPECT_NEAR(height_with(without_walls(scanned({box(house, 6), box(rectangle(12, 21, 5, 5), 12)}))), 12, 0.1);
}

TEST(Tall, walls_are_asked_for_where_the_part_ends_above_or_below_what_is_beside_it) {
  const refine::Options options;
  const auto walls = [&](const geometry::Mesh& mesh, const Plan& of) {
    const rays::Scene scene(mesh);
    const auto site = refine::detail::look(model::polygon_of(of), ground, scene, options);
    const auto sketch = extrude::sketch(of, {}, {});
    return refine::detail::walls_of(site, refine::detail::view_of(*sketch, site), scene, options);
  };
  const auto whole = scanned({box(house, 6), box(tower, 18)});
  const auto all = walls(whole, box(tower, 18)), none = walls(without_walls(whole), box(tower, 18));
  EXPECT_GE(all.asked, 4U * 6 * 20);  // four sides of 3 m, 11 m from the roof to the top, every 0.5 m
  EXPECT_GT(all.seen, all.asked * 9 / 10);
  EXPECT_EQ(none.asked, all.asked);
  EXPECT_LT(none.seen, none.asked / 10);
  EXPECT_EQ(walls(scanned({box(house, 6)}), box(tower, 6)).asked, 0U);  // level with what is around it
}

}  // namespace
