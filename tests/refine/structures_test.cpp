// What becomes a part of its own: what lies on a roof.
#include <gmock/gmock.h>

#include "mansard/refine/law.hpp"
#include "scans.hpp"

namespace {

using namespace scans;

auto house() -> geometry::Ring { return rectangle(10, 20, 16, 10); }

/// Parts of a flat roof at 8 m, of a scan in which heights over 4 by 4 m of it are moved by `more`, and the base is
/// not.
template <class More>
auto parts_with(More more) -> std::size_t {
  auto mesh = scanned({plan(house(), {wall(8), wall(8), wall(8), wall(8)}, 8)}, 0.02);
  base::Random random(11);
  for (auto& v : mesh.vertices)
    if (std::abs(v.x - 18) < 2 && std::abs(v.y - 25) < 2) v.z += more(random);
  model::Accuracy accuracy;
  accuracy.noise = 0.03, accuracy.correlated_area = 0.3, accuracy.blur = 0.1, accuracy.edge_noise = 0.05;
  const auto refined = refine::refine(std::vector{flat_draft(house(), 8)}, rays::Scene(std::move(mesh)),
                                      refine::decided_by({}, accuracy), {});
  EXPECT_TRUE(refined.failed.empty());
  return refined.parts.size();
}

TEST(Structures, are_parts_where_most_samples_lie_on_their_roof) {
  EXPECT_EQ(parts_with([](base::Random&) { return 2.5; }), 2U);
}

TEST(Structures, are_no_parts_where_leaves_are_at_any_height) {
  EXPECT_EQ(parts_with([](base::Random& random) { return random.uniform(0.5, 4.5); }), 1U);
  EXPECT_EQ(parts_with([](base::Random& random) { return random.uniform(1.5, 3.5); }), 1U);
}

}  // namespace
