#include <gmock/gmock.h>

#include "edit/plans.hpp"

namespace mansard::edit {
namespace {

using testing::ElementsAre;

auto start() -> History { return History(test::city_of({test::house(0), test::house(10), test::house(20)})); }

auto lower_cap(const History& history, const std::string& building, double cap) -> Edit {
  Change change{building, history.revision(building), *history.parts(building)};
  change.parts[0].plan.cap = cap;
  return {"cap of " + building, {change}};
}

TEST(History, starts_with_the_plans_of_the_city) {
  const auto history = start();
  ASSERT_NE(history.parts("b"), nullptr);
  EXPECT_EQ(history.parts("b")->at(0), (NamedPlan{"b-1", test::house(10)}));
  EXPECT_EQ(history.parts("nowhere"), nullptr);
  EXPECT_EQ(history.revision("b"), 0U);
  EXPECT_FALSE(history.edited("b"));
}

TEST(History, undoes_and_redoes_without_limit) {
  auto history = start();
  for (int i = 1; i <= 50; ++i) ASSERT_TRUE(history.apply(lower_cap(history, "a", 9 - 0.1 * i)));
  EXPECT_EQ(history.done(), 50U);
  for (int i = 0; i < 50; ++i) {
    const auto changed = history.undo();
    ASSERT_TRUE(changed);
    EXPECT_THAT(*changed, ElementsAre("a"));
  }
  EXPECT_EQ(history.parts("a")->at(0).plan, test::house(0));
  EXPECT_FALSE(history.edited("a"));
  EXPECT_EQ(history.undo().error().code, "edit-nothing");
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(history.redo());
  EXPECT_EQ(history.parts("a")->at(0).plan.cap, 9 - 0.1 * 50);
  EXPECT_EQ(history.redo().error().code, "edit-nothing");
  EXPECT_EQ(history.revision("a"), 150U);
  EXPECT_TRUE(history.edited("a"));
}

TEST(History, forgets_what_could_be_redone_when_something_else_is_done) {
  auto history = start();
  ASSERT_TRUE(history.apply(lower_cap(history, "a", 8)));
  ASSERT_TRUE(history.apply(lower_cap(history, "a", 7)));
  ASSERT_TRUE(history.undo());
  ASSERT_TRUE(history.apply(lower_cap(history, "b", 6)));
  EXPECT_EQ(history.edits().size(), 2U);
  EXPECT_EQ(history.redo().error().code, "edit-nothing");
  ASSERT_TRUE(history.undo());
  EXPECT_EQ(history.parts("b")->at(0).plan.cap, 9);
  EXPECT_EQ(history.parts("a")->at(0).plan.cap, 8);
}

TEST(History, does_and_undoes_the_changes_of_one_edit_together) {
  auto history = start();
  Edit edit{
      "merge",
      {{"a", 0, {{"a-1", test::plan_of(test::rectangle(0, 0, 20, 8), {test::pitch, test::wall})}}}, {"b", 0, {}}}};
  ASSERT_TRUE(history.apply(edit));
  EXPECT_TRUE(history.parts("b")->empty());
  const auto changed = history.undo();
  ASSERT_TRUE(changed);
  EXPECT_THAT(*changed, ElementsAre("a", "b"));
  EXPECT_EQ(history.parts("a")->at(0).plan, test::house(0));
  EXPECT_EQ(history.parts("b")->at(0).plan, test::house(10));
}

TEST(History, refuses_an_edit_of_a_state_that_is_gone_and_leaves_all_as_it_was) {
  auto history = start();
  ASSERT_TRUE(history.apply(lower_cap(history, "a", 8)));
  const auto before = history;
  auto stale = lower_cap(history, "b", 5);
  stale.changes.push_back({"a", 0, {}});
  const auto refused = history.apply(stale);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, "edit-stale");
  EXPECT_EQ(refused.error().subject, "a");
  EXPECT_EQ(history, before);
}

TEST(History, refuses_what_is_no_edit) {
  auto history = start();
  const auto code_of = [&](Edit edit) { return history.apply(std::move(edit)).error().code; };
  EXPECT_EQ(code_of({"", {}}), "edit-empty");
  EXPECT_EQ(code_of({"", {{"a", 0, *history.parts("a")}}}), "edit-empty");
  EXPECT_EQ(code_of({"", {{"nowhere", 0, {}}}}), "edit-building");
  EXPECT_EQ(code_of({"", {{"a", 0, {}}, {"a", 0, {}}}}), "edit-building");
  EXPECT_EQ(code_of({"", {{"a", 0, {{"x", test::house()}, {"x", test::house(30)}}}}}), "edit-duplicate-id");
  EXPECT_EQ(history, start());
}

}  // namespace
}  // namespace mansard::edit
