#include "mansard/refine/detail/propose.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include "fields.hpp"
#include "mansard/planes/planes.hpp"

namespace mansard::refine::detail {

/// For the messages of tests that fail.
void PrintTo(const Proposal& proposal, std::ostream* out) {
  *out << proposal.what << ", gain " << proposal.gain << ":";
  for (const auto& p : proposal.polygon.outer) *out << " (" << p.x << ", " << p.y << ")";
}

}  // namespace mansard::refine::detail

namespace {

using namespace fields;
using mansard::geometry::area;
using mansard::refine::Options;
using mansard::refine::detail::Proposal;
using mansard::refine::detail::propose;

constexpr double least_gain = 2;  // m²·m²

const Polygon house = rectangle({0, 0}, {20, 12});

/// The cells of a surface, and the planes that they are on.
struct CellsOnPlanes {
  CellsOnPlanes(const Heights& scan, double noise) : area(scan.spacing * scan.spacing) {
    std::vector<mansard::geometry::Point3> cells;
    for (std::size_t k = 0; k < scan.z.size(); ++k) {
      if (std::isnan(scan.z[k])) continue;
      places.push_back(scan.centre(k));
      heights.push_back(scan.z[k]);
      cells.push_back({places.back().x, places.back().y, scan.z[k]});
    }
    planes = mansard::planes::find(cells, {.noise = noise, .point_area = area}).plane_of;
  }
  [[nodiscard]] auto samples() const -> mansard::refine::detail::OnPlanes {
    return {places, planes, heights, area, false};
  }
  double area;
  std::vector<Point2> places;
  std::vector<double> heights;
  std::vector<std::uint32_t> planes;
};

auto on_planes(const Polygon& part, const Heights& seen, const Heights& model, const Options& options)
    -> std::vector<Proposal> {
  const CellsOnPlanes cells(seen, options.samples.noise);
  return propose(part, seen, model, least_gain, options, cells.samples());
}

auto found(const Polygon& part, const Roof& seen, const Roof& model, const Scan& scan = {}) -> std::vector<Proposal> {
  const Polygon there = turned(part, scan.turn);
  Options options;
  options.samples.noise = scan.noise;
  return on_planes(there, scanned(there, seen, scan), modelled(there, model, scan), options);
}

/// m² of a beyond b.
auto beyond(const Polygon& a, const Polygon& b) -> double {
  const auto pieces = mansard::geometry::subtract(a, b);
  double sum = 0;
  for (const auto& p : *pieces) sum += area(p);
  return sum;
}

/// m²·m² of squared residual over the part's area.
auto squared(const Polygon& part, const Roof& seen, const Roof& model, double turn) -> double {
  const Polygon there = turned(part, turn);
  const Heights a = scanned(there, seen, {.turn = turn}), b = modelled(there, model, {.turn = turn});
  double sum = 0;
  for (std::size_t k = 0; k < a.z.size(); ++k)
    if (std::isfinite(a.z[k])) sum += (a.z[k] - b.z[k]) * (a.z[k] - b.z[k]) * a.spacing * a.spacing;
  return sum;
}

/// m², in one but not in the other.
auto difference(const Polygon& a, const Polygon& b) -> double { return beyond(a, b) + beyond(b, a); }

/// m; how far the farthest corner of one ring is from the nearest of the other, both ways.
auto corner_distance(const Ring& a, const Ring& b) -> double {
  double farthest = 0;
  for (const auto& [from, to] : {std::pair{&a, &b}, {&b, &a}})
    for (const Point2 p : *from) {
      double nearest = 1e9;
      for (const Point2 q : *to) nearest = std::min(nearest, length(p - q));
      farthest = std::max(farthest, nearest);
    }
  return farthest;
}

/// The piece, or the rest around it: one cut.
auto cut_distance(const Proposal& proposal, const Polygon& part, const Polygon& piece) -> double {
  return std::min(difference(proposal.polygon, piece), area(part) - difference(proposal.polygon, piece));
}

constexpr double angles[] = {0, 0.1, 0.4, 0.7853981633974483, 1.2, 2.5, -0.9};

TEST(Propose, a_lift_house_with_its_corners_at_any_angle) {
  const Polygon lift = rectangle({6, 4}, {9, 8});
  const Roof seen = with_box(flat(10), {6, 4}, {9, 8}, 12.4);
  for (const double turn : angles) {
    SCOPED_TRACE(turn);
    const auto all = found(house, seen, flat(10), {.turn = turn});
    ASSERT_EQ(all.size(), 1u);
    EXPECT_LT(corner_distance(all[0].polygon.outer, turned(lift, turn).outer), 0.1);
    EXPECT_THAT(all[0].what, testing::MatchesRegex("stands 2.[34] m above the roof around it"));
    EXPECT_FALSE(all[0].whole_side);
    const double explained = squared(house, seen, flat(10), turn) - squared(house, seen, seen, turn);
    EXPECT_NEAR(all[0].gain, explained, 0.1 * explained);
  }
}

TEST(Propose, a_tower_on_a_corner_leaves_no_slivers) {
  const Polygon tower = rectangle({15, 7}, {20, 12});
  const Roof seen = with_box(flat(10), {15, 7}, {30, 30}, 18);
  for (const double turn : angles) {
    SCOPED_TRACE(turn);
    // At the part's edges the scan melts down to the ground.
    const Roof melted = [&](Point2 p) { return p.x < 0 || p.y < 0 || p.x > 20 || p.y > 12 ? 4.0 : seen(p); };
    const auto all = found(house, melted, flat(10), {.turn = turn});
    ASSERT_FALSE(all.empty());
    EXPECT_LT(corner_distance(all[0].polygon.outer, turned(tower, turn).outer), 0.26) << "a cell";
    EXPECT_EQ(all[0].polygon.outer.size(), 4u);
  }
}

TEST(Propose, of_an_annex_shaped_like_an_L_first_the_larger_wing) {
  Roof seen = with_box(flat(10), {-9, -9}, {12, 4}, 7);
  seen = with_box(seen, {-9, -9}, {5, 9}, 7);
  for (const double turn : angles) {
    SCOPED_TRACE(turn);
    const auto all = found(house, seen, flat(10), {.turn = turn});
    ASSERT_FALSE(all.empty());
    EXPECT_LT(cut_distance(all[0], turned(house, turn), turned(rectangle({0, 0}, {12, 4}), turn)), 8)
        << "its long side is half a metre too far in: along the other wing nothing says where it is";
    EXPECT_THAT(all[0].what, testing::HasSubstr("m below"));
  }
}

TEST(Propose, a_setback_along_one_side_is_one_line) {
  const Polygon strip = rectangle({0, 0}, {20, 2.2});
  const Roof seen = with_box(flat(10), {-9, -9}, {30, 2.2}, 7.5);
  for (const double turn : angles) {
    SCOPED_TRACE(turn);
    const auto all = found(house, seen, flat(10), {.turn = turn});
    ASSERT_FALSE(all.empty());
    EXPECT_TRUE(all[0].whole_side);
    EXPECT_LT(cut_distance(all[0], turned(house, turn), turned(strip, turn)), 2);
  }
}

TEST(Propose, setbacks_all_around_are_what_they_run_around) {
  const Polygon core = rectangle({2.5, 2.5}, {17.5, 9.5});
  const auto all = found(house, with_box(flat(7), {2.5, 2.5}, {17.5, 9.5}, 10), flat(10));
  ASSERT_FALSE(all.empty());
  EXPECT_LT(corner_distance(all[0].polygon.outer, core.outer), 0.15);
}

TEST(Propose, the_valley_between_two_gables) {
  const Roof seen = [](Point2 p) { return 12 - 0.7 * std::abs(std::fmod(p.y + 600, 6.0) - 3); };  // ridges at 3 and 9
  const Polygon bay = rectangle({0, 0}, {20, 6});
  for (const double turn : angles) {
    SCOPED_TRACE(turn);
    const auto all = found(house, seen, flat(10.9), {.turn = turn});
    ASSERT_FALSE(all.empty());
    EXPECT_TRUE(all[0].whole_side);
    EXPECT_LT(cut_distance(all[0], turned(house, turn), turned(bay, turn)), 20 * 0.15);
    EXPECT_EQ(all[0].what, "another roof on either side of a line across");
  }
}

TEST(Propose, houses_in_a_row_under_ridges_of_other_heights) {
  const Roof seen = [](Point2 p) { return (p.x < 8 ? 12 : 14) - 0.7 * std::abs(p.y - 6); };
  const auto all = found(house, seen, [](Point2 p) { return 13 - 0.7 * std::abs(p.y - 6); });
  ASSERT_FALSE(all.empty());
  EXPECT_TRUE(all[0].whole_side);
  EXPECT_LT(cut_distance(all[0], house, rectangle({0, 0}, {8, 12})), 12 * 0.1);
  EXPECT_THAT(all[0].what, testing::HasSubstr("2.0 m"));
}

TEST(Propose, two_structures_are_two_proposals_the_larger_gain_first) {
  Roof seen = with_box(flat(10), {3, 3}, {6, 7}, 12);
  seen = with_box(seen, {12, 5}, {16, 9}, 14);
  const auto all = found(house, seen, flat(10));
  ASSERT_GE(all.size(), 2u);
  EXPECT_LT(corner_distance(all[0].polygon.outer, rectangle({12, 5}, {16, 9}).outer), 0.15);
  EXPECT_TRUE(std::ranges::any_of(all, [](const Proposal& p) {
    return corner_distance(p.polygon.outer, rectangle({3, 3}, {6, 7}).outer) < 0.15;
  }));
  EXPECT_TRUE(std::ranges::is_sorted(all, std::greater{}, &Proposal::gain));
}

TEST(Propose, a_tower_upon_a_wing_by_planes) {
  Roof seen = with_box(flat(10), {10, -9}, {30, 30}, 12);
  seen = with_box(seen, {14, 4}, {18, 8}, 20);
  const auto all = found(house, seen, flat(10));
  ASSERT_GE(all.size(), 2u);
  EXPECT_TRUE(std::ranges::any_of(all, [](const Proposal& p) {
    return corner_distance(p.polygon.outer, rectangle({14, 4}, {18, 8}).outer) < 0.4;
  }));
  EXPECT_TRUE(std::ranges::any_of(all, [](const Proposal& p) {
    return cut_distance(p, house, rectangle({10, 0}, {20, 12})) < 6.5;  // half a metre
  })) << testing::PrintToString(all);
}

TEST(Propose, a_pyramid_on_a_flat_roof) {
  const Roof seen = [](Point2 p) {
    const double d = std::max(std::abs(p.x - 8), std::abs(p.y - 6));
    return d < 3 ? 12 + (3 - d) * 0.9 : 10;
  };
  const auto all = found(house, seen, flat(10));
  ASSERT_FALSE(all.empty());
  EXPECT_LT(corner_distance(all[0].polygon.outer, rectangle({5, 3}, {11, 9}).outer), 0.15);
}

TEST(Propose, nothing_where_there_is_nothing) {
  for (const double turn : angles) {
    SCOPED_TRACE(turn);
    EXPECT_THAT(found(house, with_box(flat(10), {6, 5}, {7, 6.2}, 12), flat(10), {.turn = turn}), testing::IsEmpty())
        << "a chimney";
    EXPECT_THAT(found(house, flat(10), flat(10), {.turn = turn}), testing::IsEmpty()) << "noise";
    const Roof gable = [](Point2 p) { return 12 - 0.8 * std::abs(p.y - 6); };
    EXPECT_THAT(found(house, gable, gable, {.turn = turn}), testing::IsEmpty()) << "a gable as modelled";
    EXPECT_THAT(found(house, gable, flat(9.6), {.turn = turn}), testing::IsEmpty()) << "a gable that one roof explains";
    const Roof ground_beyond = [](Point2 p) { return p.x < 0 || p.y < 0 || p.x > 20 || p.y > 12 ? 0.0 : 10; };
    EXPECT_THAT(found(house, ground_beyond, flat(10), {.turn = turn}), testing::IsEmpty()) << "melted eaves";
  }
}

TEST(Propose, beside_a_courtyard) {
  Polygon part = rectangle({0, 0}, {30, 24});
  part.holes.push_back({{10, 8}, {10, 16}, {20, 16}, {20, 8}});
  const Roof seen = with_box(flat(12), {19.8, -9}, {40, 40}, 9);
  for (const double turn : {0.0, 0.7}) {
    SCOPED_TRACE(turn);
    const auto all = found(part, seen, flat(12), {.turn = turn});
    ASSERT_FALSE(all.empty());
    EXPECT_LT(cut_distance(all[0], turned(part, turn), turned(rectangle({20, 0}, {30, 24}), turn)), 1)
        << "the wall goes on from the courtyard's";
  }
}

TEST(Propose, sees_through_gaps) {
  const auto all = found(house, with_box(flat(10), {6, 4}, {9, 8}, 12.4), flat(10), {.unseen = 0.3});
  ASSERT_FALSE(all.empty());
  EXPECT_LT(corner_distance(all[0].polygon.outer, rectangle({6, 4}, {9, 8}).outer), 0.2);
}

TEST(Propose, a_plant_room_askew_to_the_part) {
  const double askew = 0.5;
  const Roof seen = [&](Point2 p) {
    const Point2 q = turned(p - Point2{10, 6}, -askew);
    return std::abs(q.x) < 3 && std::abs(q.y) < 2 ? 13.0 : 10.0;
  };
  Polygon room = turned(rectangle({-3, -2}, {3, 2}), askew);
  for (auto& p : room.outer) p = p + Point2{10, 6};
  const auto all = found(house, seen, flat(10));
  ASSERT_FALSE(all.empty());
  EXPECT_LT(corner_distance(all[0].polygon.outer, room.outer), 0.25);
}

TEST(Propose, what_lies_on_a_plane_of_its_own_although_it_is_no_step) {
  // A pitch of 10° on a part that the model has level: within 0.3 m of it everywhere.
  const Polygon pitch = rectangle({8, 4}, {11, 10});
  const auto is_pitch = [](Point2 p) { return p.x > 8 && p.x < 11 && p.y > 4 && p.y < 10; };
  const Roof seen = [&](Point2 p) { return is_pitch(p) ? 10 + 0.18 * (p.x - 9.5) : 10.0; };
  const Heights measured = scanned(house, seen, {}), model = modelled(house, flat(10), {});
  std::vector<Point2> places;
  std::vector<std::uint32_t> planes;
  std::vector<double> heights;
  for (double x = 0.3; x < 20; x += 0.4)
    for (double y = 0.3; y < 12; y += 0.4) {
      places.push_back({x, y});
      planes.push_back(is_pitch({x, y}) ? 1 : 0);
      heights.push_back(seen({x, y}));
    }
  Options options;
  options.samples.point_area = 0.16;
  const auto has_it = [&](const std::vector<Proposal>& all) {
    return std::ranges::any_of(all, [&](const Proposal& one) { return cut_distance(one, house, pitch) < 4; });
  };
  EXPECT_TRUE(has_it(propose(house, measured, model, 0.1, options, {places, planes, heights, 0.16, true})));
  EXPECT_FALSE(has_it(propose(house, measured, model, 0.1, options)));
}

TEST(Propose, gives_nothing_for_no_grid_or_another) {
  EXPECT_THAT(propose(house, {}, {}, least_gain, {}), testing::IsEmpty());
  Heights small = grid_over(house, 0.5);
  EXPECT_THAT(propose(house, small, grid_over(house, 0.25), least_gain, {}), testing::IsEmpty());
  EXPECT_THAT(propose(house, small, small, least_gain, {}), testing::IsEmpty()) << "all unseen";
}

/// A rectilinear part with notches, boxes of other heights and a turn, all by chance.
struct Block {
  Polygon part;
  Roof roof;
  Scan scan;
};

auto block_of(unsigned seed) -> Block {
  std::mt19937 random(seed);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double w = between(6, 25), h = between(6, 18);
  Polygon part = rectangle({0, 0}, {w, h});
  if (random() % 2) part = {{{0, 0}, {w, 0}, {w, h * 0.6}, {w * 0.5, h * 0.6}, {w * 0.5, h}, {0, h}}, {}};
  if (random() % 3 == 0) part.outer[1].y -= between(0, 2);  // not at right angles
  if (w > 15 && h > 12 && random() % 2) part.holes.push_back({{3, 3}, {3, 6}, {6, 6}, {6, 3}});
  Roof roof = flat(9);
  for (unsigned n = random() % 4; n > 0; --n) {
    const Point2 a{between(-2, w), between(-2, h)};
    roof = with_box(roof, a, a + Point2{between(1, 9), between(1, 9)}, between(5, 15));
  }
  if (random() % 3 == 0) roof = [=](Point2 p) { return roof(p) - 0.5 * std::abs(p.y - h / 2); };
  const double turn = random() % 2 ? between(-3, 3) : 0;
  return {turned(part, turn), roof, {.turn = turn, .spacing = 0.4, .unseen = random() % 2 ? 0.2 : 0.0, .seed = seed}};
}

TEST(Propose, two_that_become_one_piece_are_proposed_once) {
  const Block b = block_of(217817);
  const auto all = on_planes(b.part, scanned(b.part, b.roof, b.scan), modelled(b.part, flat(9), b.scan), {});
  EXPECT_GT(all.size(), 1U);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(difference(all[i].polygon, all[j].polygon), 0.01 * area(all[i].polygon));
}

TEST(Propose, sides_that_are_moved_end_in_the_part) {
  for (const unsigned seed : {64752460U, 21141037U, 982539U}) {  // up to 0.022 m² were beyond
    const Block b = block_of(seed);
    const auto all = on_planes(b.part, scanned(b.part, b.roof, b.scan), modelled(b.part, flat(9), b.scan), {});
    EXPECT_FALSE(all.empty()) << seed;
    for (const auto& one : all) EXPECT_LT(beyond(one.polygon, b.part), 1e-6) << seed;
  }
}

TEST(Propose, guarantees_over_random_parts) {
  EXPECT_TRUE(rc::check("in the part, simple, apart, the same twice", [] {
    const Block b = block_of(*rc::gen::arbitrary<unsigned>());
    const Heights seen = scanned(b.part, b.roof, b.scan), model = modelled(b.part, flat(9), b.scan);
    const Options options;
    const auto all = on_planes(b.part, seen, model, options);
    const auto again = on_planes(b.part, seen, model, options);
    RC_ASSERT(std::ssize(all) <= options.cuts.max_count && all.size() == again.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Polygon& piece = all[i].polygon;
      RC_ASSERT(beyond(piece, b.part) < 1e-6);
      RC_ASSERT(mansard::geometry::is_simple(piece));
      RC_ASSERT(area(piece) >= options.cuts.min_area - 1e-6);
      RC_ASSERT(area(b.part) - area(piece) >= options.cuts.min_area - 1e-6);
      RC_ASSERT(all[i].gain >= least_gain);
      RC_ASSERT(piece == again[i].polygon && all[i].gain == again[i].gain && all[i].what == again[i].what);
      for (std::size_t j = 0; j < i; ++j) RC_ASSERT(difference(piece, all[j].polygon) > 0.01 * area(piece));
    }
  }));
}

}  // namespace
