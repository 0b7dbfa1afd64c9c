// Roofs compared with the scan: the sum, its bounds, and what is known again.
#include "mansard/refine/detail/judge.hpp"

#include <gmock/gmock.h>

#include <cstring>

#include "mansard/refine/detail/blur.hpp"
#include "mansard/refine/detail/order.hpp"
#include "scans.hpp"

namespace {

using namespace scans;
using refine::detail::Judge;
using refine::detail::Judged;
using refine::detail::KnownRoofs;
using refine::detail::Site;

/// A turned L, so that the grid has cells outside of it on all sides.
const geometry::Ring ring{{10, 20}, {22, 26}, {18, 34}, {13, 31.5}, {11, 35.5}, {4, 32}};
auto gabled(double gutter, double slope) -> Plan {
  return plan(ring, {roof(gutter, slope), wall(6), roof(gutter, slope), wall(6), roof(gutter, slope), wall(6)}, 9);
}

class Judging : public testing::Test {
 protected:
  void SetUp() override {
    mesh_.emplace(scan({gabled(5, 0.7)}));
    site_ = refine::detail::look({ring, {}}, ground, *mesh_, options_);
  }
  auto judge(KnownRoofs* known = nullptr) const -> Judge { return {site_, options_, raising_, run_, known}; }

  refine::Options options_;
  extrude::Options raising_;
  base::Run run_;
  std::optional<rays::Scene> mesh_;
  Site site_;
};

/// The definition, cell by cell.
auto misfit_by_cell(const Site& site, const std::vector<double>& z, double cap, double robust) -> double {
  const auto& grid = site.measured;
  const auto height = [&](std::ptrdiff_t column, std::ptrdiff_t row) -> double {
    if (column < 0 || row < 0 || column >= std::ssize(grid.z) / std::ssize(site.extents) ||
        row >= std::ssize(site.extents))
      return 0;
    const auto cell = static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column);
    return site.unblurred[cell] > 0 && !std::isnan(z[cell]) ? std::min(z[cell], cap) : 0;
  };
  const auto along = [&](std::ptrdiff_t column, std::ptrdiff_t row) {
    return 6 * height(column, row) + 4 * (height(column - 1, row) + height(column + 1, row)) +
           (height(column - 2, row) + height(column + 2, row));
  };
  double sum = 0;
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const auto column = static_cast<std::ptrdiff_t>(site.cells[i] % grid.columns),
               row = static_cast<std::ptrdiff_t>(site.cells[i] / grid.columns);
    const double blurred = 6 * along(column, row) + 4 * (along(column, row - 1) + along(column, row + 1)) +
                           (along(column, row - 2) + along(column, row + 2));
    const double off = site.unblurred[site.cells[i]] * blurred - grid.z[site.cells[i]];
    const double limit = off > 0 ? std::min(robust, site.limits[site.cells[i]]) : robust;
    sum += site.weight[i] * refine::detail::loss(off, limit);
  }
  return sum * site.cell_area;
}

TEST_F(Judging, sums_the_losses_of_the_smoothed_heights_to_the_last_bit) {
  for (const double gutter : {2.0, 4.9, 5.0, 8.0}) {
    const auto judged = judge()(gabled(gutter, 0.6));
    ASSERT_TRUE(judged);
    EXPECT_GT(judged->misfit, 0);
    for (const double cap : {3.0, 6.1, 100.0})
      EXPECT_EQ(judge().misfit_of(judged->view, cap), misfit_by_cell(site_, judged->view.z, cap, options_.robust));
  }
}

TEST_F(Judging, counts_what_falls_off_beside_the_outline_linearly) {
  const auto at = [&](double fall) {
    Site fallen = site_;
    for (std::size_t cell = 0; cell < fallen.heights.size(); ++cell)
      if (std::isfinite(fallen.limits[cell])) fallen.heights[cell] -= fall;
    const Judge over{fallen, options_, raising_, run_};
    return over(gabled(5, 0.7))->misfit;
  };
  const double far = at(3) - at(2);
  EXPECT_GT(far, 0);
  EXPECT_NEAR(at(4) - at(3), far, 1e-9) << "below the roof: linear";
  EXPECT_GT(at(-2) - at(-1), 1.2 * (at(-1) - at(0))) << "above it: squared, as everywhere";
}

TEST_F(Judging, may_end_a_sum_that_reaches_what_is_too_much) {
  const auto judged = judge()(gabled(2, 0.7));
  const auto infinite = std::numeric_limits<double>::infinity();
  for (const double share : {0.1, 0.5, 1.0}) {
    const double most = share * judged->misfit, ended = judge().misfit_of(judged->view, infinite, most);
    EXPECT_GE(ended, most);
    EXPECT_LE(ended, judged->misfit);
  }
  EXPECT_EQ(judge().misfit_of(judged->view, infinite, 1.001 * judged->misfit), judged->misfit);
}

void expect_same(const Judged& a, const Judged& b) {
  EXPECT_EQ(a.plan, b.plan);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.misfit, b.misfit);
  EXPECT_EQ(a.unsupported, b.unsupported);
  EXPECT_EQ(a.bare, b.bare);
  EXPECT_EQ(a.view.face, b.view.face);
  ASSERT_EQ(a.view.z.size(), b.view.z.size());
  EXPECT_EQ(std::memcmp(a.view.z.data(), b.view.z.data(), a.view.z.size() * sizeof(double)), 0);  // some are NaN
}

TEST_F(Judging, tells_what_is_cheaper_as_the_costs_do) {
  KnownRoofs roofs;
  for (KnownRoofs* known : {static_cast<KnownRoofs*>(nullptr), &roofs})
    for (int twice = 0; twice < 2; ++twice)
      for (const double gutter : {3.0, 4.8, 5.0}) {
        const Plan at = gabled(gutter, 0.7);
        const auto judged = judge()(at);
        const auto with = judge(known);
        for (const double share : {0.01, 0.5, 0.9, 1.0}) EXPECT_FALSE(with.cheaper(at, share * judged->cost));
        EXPECT_FALSE(with.cheaper(at, judged->cost + 0.5 * refine::Options().same_cost));
        const auto cheaper = with.cheaper(at, judged->cost + 2 * refine::Options().same_cost);
        ASSERT_TRUE(cheaper);
        expect_same(*cheaper, *judged);
      }
}

TEST_F(Judging, of_points_sums_all_losses_and_ends_early_only_where_a_roof_is_too_dear) {
  Site site = site_;
  site.of_points = true;  // the centres of the cells
  const Judge judge{site, options_, raising_, run_};
  for (const double gutter : {2.0, 4.8, 5.0}) {
    const Plan at = gabled(gutter, 0.7);
    const auto judged = judge(at);
    ASSERT_TRUE(judged);
    ASSERT_EQ(judged->view.z_at.size(), site.z.size());
    double sum = 0;
    for (std::size_t i = 0; i < site.z.size(); ++i) {
      const double z = judged->view.z_at[i];
      sum += site.weight[i] * refine::detail::stray_loss((std::isnan(z) ? 0 : z) - site.z[i], options_.samples.stray);
    }
    EXPECT_EQ(judged->misfit, sum * site.sample_area);
    EXPECT_EQ(judge.misfit_of(judged->view), judged->misfit);
    for (const double share : {0.01, 0.5, 0.9, 1.0}) EXPECT_FALSE(judge.cheaper(at, share * judged->cost));
    const auto cheaper = judge.cheaper(at, judged->cost + 2 * options_.same_cost);
    ASSERT_TRUE(cheaper);
    expect_same(*cheaper, *judged);
    EXPECT_EQ(cheaper->view.face_at, judged->view.face_at);
  }
}

TEST_F(Judging, knows_a_roof_again_as_it_was) {
  KnownRoofs known;
  const auto with = judge(&known);
  const Plan at = gabled(4.5, 0.8);
  const auto first = with(at);
  ASSERT_NE(known.find(at), nullptr);
  EXPECT_EQ(known.find(gabled(4.5, 0.81)), nullptr);
  expect_same(*with(at), *first);
  expect_same(*first, *judge()(at));
}

TEST_F(Judging, remembers_the_largest_cost_that_a_roof_is_known_to_reach) {
  KnownRoofs known;
  const Plan at = gabled(4.5, 0.8);
  EXPECT_EQ(known.costs_at_least(at), 0);
  for (const double cost : {5.0, 9.0, 7.0}) known.add_too_dear(at, cost);
  EXPECT_EQ(known.costs_at_least(at), 9);
  EXPECT_EQ(known.costs_at_least(gabled(4.5, 0.81)), 0);
}

}  // namespace
