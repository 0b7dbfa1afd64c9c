// What is found of changes that were planted between two states, and what is not taken for one.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "mansard/compare/compare.hpp"

namespace mansard::compare {
namespace {

using geometry::Mesh;
using geometry::Point2;
using geometry::Polygon;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A roof over a rectangle: its height above the ground by the place from its west and south, m.
struct House {
  std::string id;
  double x = 0, y = 0, wide = 10, deep = 8;
  std::function<double(double, double)> roof = [](double, double) { return 6.0; };
  double error = 0.1, right = 0.95;
};

auto flat(double height) -> std::function<double(double, double)> {
  return [height](double, double) { return height; };
}

auto outline_of(const House& h) -> Polygon {
  return {{{h.x, h.y}, {h.x + h.wide, h.y}, {h.x + h.wide, h.y + h.deep}, {h.x, h.y + h.deep}}, {}};
}

/// The top of a house as triangles of half a metre, which follow any roof.
void add_roof(const House& h, double lift, Mesh& mesh) {
  const auto columns = static_cast<std::uint32_t>(std::lround(2 * h.wide)),
             rows = static_cast<std::uint32_t>(std::lround(2 * h.deep));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i)
      mesh.vertices.push_back({h.x + 0.5 * i, h.y + 0.5 * j, lift + h.roof(0.5 * i, 0.5 * j)});
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const auto a = first + j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = a + columns + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
}

struct Shift {
  double x = 0, y = 0, z = 0;
};

auto state_of(std::vector<House> houses, Shift by = {}) -> State {
  State out;
  for (auto& h : houses) {
    h.x += by.x, h.y += by.y;
    out.buildings.push_back({h.id, {outline_of(h)}, by.z, h.right, h.error});
    add_roof(h, by.z, out.models);
  }
  out.accuracy.noise = 0.05;
  out.accuracy.correlated_area = 1;
  out.accuracy.blur = 0.2;
  return out;
}

/// The same with a scan of these houses, on level ground.
auto scanned(State state, const std::vector<House>& seen) -> State {
  add_roof({"", -30, -30, 200, 80, flat(0)}, 0, state.scan);
  for (const auto& h : seen) add_roof(h, 0, state.scan);
  return state;
}

/// Eight houses of 10 m by 8 m in a row, 4 m apart.
auto row() -> std::vector<House> {
  std::vector<House> out;
  for (int i = 0; i < 8; ++i) out.push_back({"h" + std::to_string(i), 14.0 * i});
  return out;
}

auto kinds_of(const Comparison& found) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& change : found.changes)
    if (change.kind != Kind::unchanged) {
      std::string one = std::to_string(change.now.empty() ? change.old.front() : change.now.front());
      out.push_back(one + (change.now.empty() ? " old " : " ") + std::string(to_string(change.kind)));
    }
  return out;
}

auto words_of(const Change& change) -> std::string {
  std::string out;
  for (const auto& why : change.why) out += why + "\n";
  return out;
}

auto gable(double x, double) -> double { return 6 + 3 - 0.6 * std::abs(x - 5); }

/// One change of each kind.
auto changed_row() -> std::vector<House> {
  auto houses = row();
  houses[0].roof = flat(9);
  houses[1].roof = flat(3.2);
  houses[2].roof = gable;
  houses[3].deep = 12;
  houses[3].roof = [](double, double y) { return y > 8 ? 3.0 : 6.0; };
  houses[4].deep = 5;
  houses.erase(houses.begin() + 5);
  houses.push_back({"added", 14.0 * 8});
  return houses;
}

TEST(Changes, of_equal_states_are_none) {
  const auto found = changes(state_of(row()), state_of(row()), {});
  EXPECT_THAT(kinds_of(found), IsEmpty());
  ASSERT_EQ(found.changes.size(), 8U);
  EXPECT_TRUE(found.offset.removed);
  EXPECT_DOUBLE_EQ(found.offset.height, 0);
  EXPECT_DOUBLE_EQ(found.changes.front().height, 0);
  EXPECT_GT(found.changes.front().height_error, 0);
}

TEST(Changes, that_are_planted_are_found_with_their_measures) {
  const auto found = changes(state_of(row()), state_of(changed_row()), {});
  EXPECT_THAT(kinds_of(found),
              ElementsAre("0 raised", "1 lowered", "2 re-roofed", "3 extended", "4 reduced", "7 new", "5 old gone"));
  const auto& raised = found.changes[0].parts.front();
  EXPECT_NEAR(raised.height, 3, 1e-6);
  EXPECT_NEAR(raised.area, 80, 2);
  EXPECT_NEAR(raised.volume, 240, 6);
  EXPECT_GT(raised.sigmas, 10);
  EXPECT_THAT(words_of(found.changes[0]), HasSubstr("m² of the roof are 3.00 ±"));
  EXPECT_NEAR(found.changes[1].parts.front().height, -2.8, 1e-6);
  const auto& extended = found.changes[3].parts.front();
  EXPECT_NEAR(extended.area, 40, 4);
  EXPECT_NEAR(extended.height, 3, 1e-6);
  EXPECT_NEAR(found.changes[4].parts.front().area, 30, 4);
  EXPECT_NEAR(found.changes[4].parts.front().volume, -180, 24);
  EXPECT_NEAR(found.changes[7].parts.front().volume, 480, 10);
  EXPECT_EQ(found.changes[8].old, std::vector<std::uint32_t>{5});
}

TEST(Changes, change_places_when_the_states_are_exchanged) {
  const auto found = changes(state_of(changed_row()), state_of(row()), {});
  EXPECT_THAT(kinds_of(found),
              ElementsAre("0 lowered", "1 raised", "2 re-roofed", "3 reduced", "4 extended", "5 new", "7 old gone"));
}

TEST(Changes, do_not_depend_on_ids_order_and_threads) {
  auto old = row(), now = changed_row();
  for (auto& h : now) h.id = "other " + h.id;
  std::ranges::reverse(old);
  std::ranges::rotate(now, now.begin() + 3);
  base::limit_threads(2);
  const auto found = changes(state_of(old), state_of(now), {});
  base::limit_threads(1);
  const auto again = changes(state_of(old), state_of(now), {});
  base::limit_threads(0);
  EXPECT_THAT(kinds_of(found), testing::UnorderedElementsAre("5 raised", "6 lowered", "7 re-roofed", "0 extended",
                                                             "1 reduced", "4 new", "2 old gone"));
  ASSERT_EQ(again.changes.size(), found.changes.size());
  for (std::size_t i = 0; i < found.changes.size(); ++i) {
    EXPECT_EQ(found.changes[i].chance, again.changes[i].chance);
    EXPECT_EQ(found.changes[i].why, again.changes[i].why);
  }
}

TEST(Changes, are_not_a_shift_that_all_buildings_share) {
  const auto old = state_of(row()), now = state_of(changed_row(), {0.6, -0.4, 1.2});
  const auto found = changes(old, now, {});
  EXPECT_THAT(kinds_of(found),
              ElementsAre("0 raised", "1 lowered", "2 re-roofed", "3 extended", "4 reduced", "7 new", "5 old gone"));
  EXPECT_NEAR(found.offset.height, 1.2, 1e-6);
  EXPECT_NEAR(found.offset.plan.x, 0.6, 1e-6);
  EXPECT_NEAR(found.offset.plan.y, -0.4, 1e-6);
  Options keep;
  keep.keep_offset = true;
  EXPECT_EQ(changes(old, now, keep).count(Kind::raised), 3U);  // the first, and the two that have no other change
}

TEST(Changes, of_few_buildings_are_not_taken_for_a_shift) {
  auto old = row(), now = row();
  old.resize(4), now.resize(4);
  for (auto& h : now) h.roof = flat(9);
  const auto found = changes(state_of(old), state_of(now), {});
  EXPECT_FALSE(found.offset.removed);
  EXPECT_EQ(found.count(Kind::raised), 4U);
}

TEST(Changes, are_none_where_only_a_model_is_wrong_and_the_scans_agree) {
  auto wrong = row();
  wrong[2].roof = gable;
  const auto old = scanned(state_of(row()), row()), now = scanned(state_of(wrong), row());
  const auto found = changes(old, now, {});
  EXPECT_THAT(kinds_of(found), IsEmpty());
  EXPECT_THAT(words_of(found.changes[2]), HasSubstr("the models differ by"));
  EXPECT_THAT(words_of(found.changes[2]), HasSubstr("which the scans do not show"));
  EXPECT_THAT(kinds_of(changes(state_of(row()), state_of(wrong), {})), ElementsAre("2 re-roofed"));
}

TEST(Changes, are_none_where_only_a_scan_has_a_crown) {
  auto crowned = row();
  crowned.push_back({"tree", 28, 0, 6, 6, flat(11)});
  const auto found = changes(scanned(state_of(row()), row()), scanned(state_of(row()), crowned), {});
  EXPECT_THAT(kinds_of(found), IsEmpty());
}

TEST(Changes, are_none_where_footprints_alone_have_changed) {
  auto fewer = row();
  fewer.pop_back();
  const auto found = changes(scanned(state_of(fewer), row()), scanned(state_of(row()), row()), {});
  EXPECT_THAT(kinds_of(found), IsEmpty());
  EXPECT_THAT(words_of(found.changes[7]), HasSubstr("nothing was built: the old scan shows it"));
  EXPECT_THAT(kinds_of(changes(state_of(fewer), state_of(row()), {})), ElementsAre("7 new"));
  const auto back = changes(scanned(state_of(row()), row()), scanned(state_of(fewer), row()), {});
  EXPECT_THAT(kinds_of(back), IsEmpty());
}

TEST(Changes, of_a_demolished_building_are_seen_in_the_scan_though_its_footprint_stays) {
  auto seen = row();
  seen.erase(seen.begin() + 3);
  auto low = row();
  low[3].roof = flat(0.1);  // the model of what the scan shows there
  const auto found = changes(scanned(state_of(row()), row()), scanned(state_of(low), seen), {});
  EXPECT_THAT(kinds_of(found), ElementsAre("3 gone"));
}

TEST(Changes, are_not_what_outlines_differ_by) {
  auto drawn = row();
  for (std::size_t i = 0; i < drawn.size(); ++i) {  // some larger, some smaller, by 0.4 m on each side
    const double by = i % 2 == 0 ? 0.4 : -0.4;
    drawn[i].x -= by, drawn[i].y -= by, drawn[i].wide += 2 * by, drawn[i].deep += 2 * by;
  }
  EXPECT_THAT(kinds_of(changes(state_of(row()), state_of(drawn), {})), IsEmpty());
}

TEST(Changes, tell_buildings_that_were_split_or_merged) {
  auto split = row();
  split[1].wide = 5;
  split.push_back({"h1b", split[1].x + 5, 0, 5});
  const auto found = changes(state_of(row()), state_of(split), {});
  EXPECT_THAT(kinds_of(found), IsEmpty());
  EXPECT_THAT(words_of(found.changes[1]), HasSubstr("the old building h1 is several now: h1, h1b"));
  const auto back = changes(state_of(split), state_of(row()), {});
  EXPECT_THAT(kinds_of(back), IsEmpty());
  EXPECT_THAT(words_of(back.changes[1]), HasSubstr("on the ground of 2 old buildings: h1, h1b"));
}

TEST(Changes, are_told_of_a_half_that_has_another_owner_now) {
  // One old building of two halves; one half is a storey higher now, and a building of its own.
  auto old = row(), now = row();
  now[1].wide = 5;
  now.push_back({"h1b", now[1].x + 5, 0, 5, 8, flat(9)});
  const auto found = changes(state_of(old), state_of(now), {});
  EXPECT_THAT(kinds_of(found), ElementsAre("8 raised"));
}

/// A box of 2.5 m by 2.5 m on the roof, 1.5 m high.
auto dormer(double x, double y) -> double { return x > 4 && x < 7 && y > 2 && y < 5 ? 7.5 : 6; }

TEST(Changes, are_significant_only_beyond_the_errors_of_the_models) {
  auto now = row();
  now[4].roof = dormer;
  now[4].error = 0.05;
  auto old = row();
  old[4].error = 0.05;
  EXPECT_THAT(kinds_of(changes(state_of(old), state_of(now), {})), ElementsAre("4 raised"));
  old[4].error = 0.6;  // a model may be wrong by as much at such a place
  EXPECT_THAT(kinds_of(changes(state_of(old), state_of(now), {})), IsEmpty());
  // The scans are not.
  EXPECT_THAT(kinds_of(changes(scanned(state_of(old), old), scanned(state_of(now), now), {})), ElementsAre("4 raised"));
}

TEST(Changes, are_measured_against_unchanged_buildings_where_no_error_is_known) {
  auto houses = row();
  houses[0].roof = flat(9);
  houses[2].roof = gable;
  auto old = state_of(row()), now = state_of(houses);
  for (auto* state : {&old, &now})
    for (auto& building : state->buildings) building.error.reset(), building.right.reset();
  EXPECT_THAT(kinds_of(changes(old, now, {})), ElementsAre("0 raised", "2 re-roofed"));
  Options asked;
  asked.old_error = asked.new_error = 3;  // of models that may be wrong by a storey nothing follows
  EXPECT_THAT(kinds_of(changes(old, now, asked)), IsEmpty());
}

TEST(Changes, smaller_than_what_is_of_interest_are_left_out) {
  auto now = row();
  now[4].roof = flat(6.8);
  EXPECT_THAT(kinds_of(changes(state_of(row()), state_of(now), {})), ElementsAre("4 raised"));
  Options options;
  options.smallest = 1;
  EXPECT_THAT(kinds_of(changes(state_of(row()), state_of(now), options)), IsEmpty());
}

TEST(Changes, are_doubtful_where_a_model_is_probably_wrong) {
  auto now = row();
  now[4].roof = flat(9);
  now[4].right = 0.2;
  const auto found = changes(state_of(row()), state_of(now), {});
  EXPECT_TRUE(found.changes[4].doubtful);
  EXPECT_THAT(words_of(found.changes[4]), HasSubstr("the new model of h4 is probably wrong (confidence 0.20)"));
  EXPECT_FALSE(found.changes[3].doubtful);
}

TEST(Changes, cannot_be_told_of_a_building_without_a_model) {
  auto old = state_of(row());
  old.models = {};
  const auto found = changes(old, state_of(row()), {});
  EXPECT_EQ(found.count(Kind::unseen), 8U);
}

TEST(Changes, of_no_buildings_are_none) {
  EXPECT_THAT(changes({}, {}, {}).changes, IsEmpty());
  EXPECT_EQ(changes({}, state_of(row()), {}).count(Kind::built), 8U);
  EXPECT_EQ(changes(state_of(row()), {}, {}).count(Kind::gone), 8U);
}

}  // namespace
}  // namespace mansard::compare
