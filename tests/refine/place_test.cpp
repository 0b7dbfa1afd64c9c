// Cuts moved to the step that the samples show.
#include "mansard/refine/detail/place.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "fields.hpp"
#include "mansard/refine/law.hpp"

namespace {

using namespace fields;
namespace refine = mansard::refine;
namespace model = mansard::model;

constexpr double turn = 0.4;  // rad: rows of samples cross a step at many places of a cell

auto options_of(double noise, double blur) -> refine::Options {
  model::Accuracy accuracy;
  accuracy.noise = noise, accuracy.correlated_area = 0.1, accuracy.blur = blur, accuracy.edge_noise = 0;
  return refine::decided_by({}, accuracy);
}
auto house() -> Polygon { return turned({{{0, 0}, {12, 0}, {12, 8}, {0, 8}}, {}}, turn); }
/// The western piece, cut at x.
auto cut_at(double x) -> Polygon { return turned({{{0, 0}, {x, 0}, {x, 8}, {0, 8}}, {}}, turn); }
auto east_of(const Polygon& piece) -> double {
  double most = 0;
  for (const Point2 p : piece.outer) most = std::max(most, turned(p, -turn).x);
  return most;
}
auto step_at(double x) -> Roof {
  return [x](Point2 p) { return p.x < x ? 6.0 : 7.5 + 0.4 * (p.y - 4); };
}

TEST(Place, moves_a_cut_to_the_step_of_an_exact_scan) {
  const auto options = options_of(0, 0);
  for (const double at : {4.1, 4.63, 5.2}) {
    const auto heights = scanned(house(), step_at(at), {.noise = 0, .melt = 0, .turn = turn});
    const auto piece = refine::detail::placed(house(), cut_at(4.6), heights, options);
    EXPECT_NEAR(east_of(piece), at, 0.02) << at;
    EXPECT_NEAR(mansard::geometry::area(piece), 8 * at, 0.2) << at;
  }
}

TEST(Place, of_a_smoothed_and_noisy_step_is_within_a_few_centimetres) {
  const auto options = options_of(0.05, 0.25);
  const auto heights = scanned(house(), step_at(5.1), {.noise = 0.05, .melt = 0.25, .turn = turn});
  EXPECT_NEAR(east_of(refine::detail::placed(house(), cut_at(4.6), heights, options)), 5.1, 0.06);
}

TEST(Place, leaves_a_cut_where_the_samples_show_nothing) {
  const auto options = options_of(0, 0);
  const Roof flat = [](Point2) { return 6.0; };
  const auto heights = scanned(house(), flat, {.noise = 0, .melt = 0, .turn = turn});
  EXPECT_EQ(refine::detail::placed(house(), cut_at(4.6), heights, options).outer, cut_at(4.6).outer);
}

TEST(Place, leaves_a_cut_farther_from_the_step_than_it_looks) {
  const auto options = options_of(0, 0);
  const auto heights = scanned(house(), step_at(7.5), {.noise = 0, .melt = 0, .turn = turn});
  EXPECT_EQ(refine::detail::placed(house(), cut_at(4.6), heights, options).outer, cut_at(4.6).outer);
}

TEST(Place, leaves_a_cut_on_the_line_of_an_edge_that_the_scan_allows) {
  const Polygon court = turned({{{0, 0}, {12, 0}, {12, 8}, {4.6, 8}, {4.6, 6}, {0, 6}}, {}}, turn);
  const Polygon cut = turned({{{0, 0}, {4.6, 0}, {4.6, 6}, {0, 6}}, {}}, turn);
  const auto heights = scanned(court, step_at(4.8), {.noise = 0, .melt = 0, .turn = turn});
  EXPECT_EQ(refine::detail::placed(court, cut, heights, options_of(0.1, 0.25)).outer, cut.outer);
  EXPECT_NEAR(east_of(refine::detail::placed(court, cut, heights, options_of(0, 0))), 4.8, 0.02);
}

/// Ten points a square metre of the house, each with an error.
struct Points {
  std::vector<Point2> places;
  std::vector<std::uint32_t> planes;
  std::vector<double> heights;
  [[nodiscard]] auto seen() const -> refine::detail::OnPlanes { return {places, planes, heights, 0.1, true}; }
};
auto measured(const Roof& roof) -> Points {
  Points out;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(0, 12), y(0, 8);
  std::normal_distribution<double> error(0, 0.03);
  for (int i = 0; i < 960; ++i) {
    const Point2 at{x(random), y(random)};
    out.places.push_back(turned(at, turn));
    out.planes.push_back(0);
    out.heights.push_back(roof(at) + error(random));
  }
  return out;
}
auto options_of_points() -> refine::Options {
  model::Accuracy accuracy;
  accuracy.noise = 0.03, accuracy.correlated_area = accuracy.point_area = 0.1, accuracy.spacing = 0.316;
  accuracy.blur = accuracy.edge_noise = 0;
  return refine::decided_by({}, accuracy);
}

TEST(Place, is_between_the_points_of_either_side) {
  const auto options = options_of_points();
  const auto points = measured([](Point2 p) { return p.x < 5.1 ? 6.0 : 9.0; });
  const auto piece = refine::detail::placed(house(), cut_at(4.6), grid_over(house(), 0.25), options, points.seen());
  EXPECT_NEAR(east_of(piece), 5.1, 0.03);
  EXPECT_NEAR(mansard::geometry::area(piece), 8 * 5.1, 0.24);
}

TEST(Place, turns_a_side_that_is_askew) {
  const Roof askew = [](Point2 p) { return p.x < 5.1 + 0.03 * (p.y - 4) ? 6.0 : 9.0; };
  const auto points = measured(askew);
  const auto piece =
      refine::detail::placed(house(), cut_at(4.6), grid_over(house(), 0.25), options_of_points(), points.seen());
  EXPECT_NEAR(east_of(piece), 5.1 + 0.03 * 4, 0.04);
  EXPECT_NEAR(mansard::geometry::area(piece), 8 * 5.1, 0.1);
}

TEST(Place, turns_no_side_by_less_than_rounded_edges_tell) {
  const Roof askew = [](Point2 p) { return p.x < 5.1 + 0.03 * (p.y - 4) ? 6.0 : 9.0; };
  const auto heights = scanned(house(), askew, {.noise = 0.05, .melt = 0.25, .turn = turn});
  const auto piece = refine::detail::placed(house(), cut_at(4.6), heights, options_of(0.05, 0.25));
  const auto way = mansard::geometry::normalised(piece.outer[2] - piece.outer[1]);
  EXPECT_NEAR(dot(way, turned(Point2{0, 1}, turn)), 1, 1e-9);
}

TEST(Place, beside_a_parapet_is_where_the_tower_ends) {
  const Roof tower = [](Point2 p) { return p.x > 5.4 ? 30.0 : p.x > 5.1 ? 30.7 : 6.0; };
  const auto points = measured(tower);
  const auto piece =
      refine::detail::placed(house(), cut_at(5.4), grid_over(house(), 0.25), options_of_points(), points.seen());
  EXPECT_NEAR(east_of(piece), 5.1, 0.03);
}

TEST(Place, leaves_sides_along_the_parts_outline) {
  const auto options = options_of(0, 0);
  const auto heights = scanned(house(), step_at(5), {.noise = 0, .melt = 0, .turn = turn});
  const auto piece = refine::detail::placed(house(), cut_at(4.6), heights, options);
  for (const Point2 p : piece.outer) EXPECT_LT(mansard::geometry::boundary_distance(house(), p), 1e-9);
}

}  // namespace
