// Roofs of scans with round corners: steep ones stay steep, level ones level.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "scans.hpp"

namespace {

namespace geometry = mansard::geometry;

using namespace scans;
using refine::Effort;
using refine::Options;

/// The scan of the plans with round corners: smoothed by a Gaussian of 0.25 m, whatever is more than a corner's size
/// above or below counting as that much, so that walls stay upright.
auto melted(const std::vector<Plan>& plans) -> rays::Scene {
  const auto sharp = scan(plans, 0);
  geometry::Box2 box;
  for (const auto& p : plans)
    for (const Point2 at : p.outer.points) box.add(at);
  box = box.grown(1);
  constexpr double step = 0.2, melt = 0.25, corner = 0.7;
  constexpr int reach = 4;
  const auto columns = static_cast<std::uint32_t>((box.most.x - box.least.x) / step) + 1;
  const auto rows = static_cast<std::uint32_t>((box.most.y - box.least.y) / step) + 1;
  geometry::Mesh mesh;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const Point2 at{box.least.x + step * i, box.least.y + step * j};
      const double own = sharp.top(at).value_or(ground);
      double sum = 0, all = 0;
      for (int v = -reach; v <= reach; ++v)
        for (int u = -reach; u <= reach; ++u) {
          const double weight = std::exp(-0.5 * step * step * (u * u + v * v) / (melt * melt));
          const double z = sharp.top({at.x + step * u, at.y + step * v}).value_or(ground);
          sum += weight * std::clamp(z, own - corner, own + corner);
          all += weight;
        }
      mesh.vertices.push_back({at.x, at.y, sum / all});
    }
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = j * columns + i;
      mesh.triangles.push_back({a, a + 1, a + columns});
      mesh.triangles.push_back({a + 1, a + columns + 1, a + columns});
    }
  return rays::Scene(mesh);
}

auto refined(const refine::Draft& draft, const rays::Scene& mesh) -> refine::Part {
  Options options;
  options.effort = Effort::planes;
  auto out = refine::refine(std::vector{draft}, mesh, options, {});
  EXPECT_EQ(out.parts.size(), 1U);
  return std::move(out.parts.front());
}

/// Degrees, of the part of a profile that ends at that point.
auto pitch(const Profile& profile, std::size_t point) -> double {
  const auto &a = profile[point - 1], &b = profile[point];
  return std::atan2(b.height - a.height, b.inward - a.inward) * 180 / 3.14159265358979;
}

TEST(Melted, mansard_keeps_its_steep_foot) {
  const Profile side{{0, 0}, {0, 6}, {0.91, 8.5}, {1.91, 8.95}};  // 70°, then 24°
  const Plan truth = plan(rectangle(10, 20, 12, 8), {side, wall(6), side, wall(6)}, 12);
  const auto part = refined(flat_draft(rectangle(10, 20, 12, 8), 9), melted({truth}));
  const auto& made = part.plan.profiles[part.plan.outer.profile_of_edge[0]];
  ASSERT_EQ(made.size(), 4U);
  EXPECT_NEAR(pitch(made, 2), 70, 4);
  EXPECT_NEAR(pitch(made, 3), std::atan(0.45) * 180 / 3.14159265358979, 1);
}

TEST(Melted, flat_annex_at_a_high_wall_is_level) {
  const Plan house = plan(rectangle(10, 23, 10, 8), std::vector<Profile>(4, wall(8)), 8);
  const Plan annex = plan(rectangle(10, 20, 10, 3), std::vector<Profile>(4, wall(3)), 3);
  auto draft = flat_draft(rectangle(10, 20, 10, 3), 3);
  draft.plan.profiles[0] = roof(2.8, 0.13);  // the fillet at the foot of the wall looks like a roof of one pitch
  draft.plan.cap = 6;
  draft.caps = {6};
  const auto part = refined(draft, melted({house, annex}));
  EXPECT_TRUE(pitched_sides(part.plan).empty());
  EXPECT_NEAR(part.plan.cap, 3, 0.05);
}

TEST(Melted, roof_of_one_low_pitch_is_not_made_level) {
  Plan truth = plan(rectangle(10, 20, 10, 8), {roof(5, 0.15), wall(5), wall(5), wall(5)}, 7);
  const auto part = refined(flat_draft(rectangle(10, 20, 10, 8), 5.5), melted({truth}));
  EXPECT_EQ(pitched_sides(part.plan).size(), 1U);
  EXPECT_LT(difference({part}, {truth}), 0.03);
}

const geometry::Ring annex = rectangle(10, 20, 10, 3);

/// A lean-to of that slope.
auto lean_to(double slope) -> Plan { return plan(annex, {roof(3, slope), wall(3), wall(3), wall(3)}, 5); }

/// Its scan under waves that no profile can follow, and that much lower along its outline.
auto rough(const Plan& truth, double wave, double lower) -> rays::Scene {
  auto mesh = scanned({truth}, 0);
  const auto polygon = model::polygon_of(truth);
  for (auto& v : mesh.vertices) {
    if (v.z < ground + 1) continue;
    if (geometry::boundary_distance(polygon, {v.x, v.y}) < 0.3) v.z -= lower;
    v.z += wave * std::sin(4 * v.x) * std::sin(4 * v.y);
  }
  return rays::Scene(mesh);
}

auto sides_with_roof(const rays::Scene& mesh, double level_gain) -> std::size_t {
  Options options;
  options.effort = Effort::planes;
  options.sharpen.level_gain = level_gain;
  const auto out = refine::refine(std::vector{flat_draft(annex, 3.2)}, mesh, options, {});
  EXPECT_EQ(out.parts.size(), 1U);
  return pitched_sides(out.parts.front().plan).size();
}

TEST(Melted, pitch_that_explains_little_of_a_rough_roof_is_made_level) {
  const auto default_gain = Options().sharpen.level_gain;
  const auto very_rough = rough(lean_to(0.13), 0.5, 0), less_rough = rough(lean_to(0.13), 0.2, 0);
  EXPECT_EQ(sides_with_roof(very_rough, 1), 1U) << "whatever a pitch explains, however little";
  EXPECT_EQ(sides_with_roof(very_rough, default_gain), 0U);
  EXPECT_EQ(sides_with_roof(less_rough, default_gain), 1U) << "explains more than a fifth";
}

TEST(Melted, pitch_that_explains_the_roof_but_not_its_walls_stays) {
  const auto mesh = rough(lean_to(0.12), 0, 1);
  EXPECT_EQ(sides_with_roof(mesh, 1), 1U);
  EXPECT_EQ(sides_with_roof(mesh, Options().sharpen.level_gain), 1U);
}

}  // namespace
