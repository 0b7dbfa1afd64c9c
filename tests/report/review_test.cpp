// Decisions of people on models: read, merged, and tied to the model that was looked at.
#include "mansard/report/review.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace mansard::report {
namespace {

using testing::HasSubstr;

auto decision(const std::string& building, Verdict verdict, const std::string& time, const std::string& who = "ann")
    -> Decision {
  return {building, verdict, "", who, time, "abc"};
}

auto file_with(const std::string& decisions) -> std::string {
  return R"({"type":"mansard-review","version":1,"decisions":[)" + decisions + "]}";
}

TEST(Review, a_file_that_is_written_is_read_again) {
  Decisions all;
  all["a"] = {"a", Verdict::wrong, "the dormer \"is\" a tree\n", "Ann", "2026-11-28T10:00:00Z", "0f"};
  all["b"] = decision("b", Verdict::later, "2026-11-28T10:00:01Z", "");
  const auto text = review_text(all);
  EXPECT_EQ(std::ranges::count(text, '\n'), 4) << "one decision a line";
  const auto again = parse_review(text, "x");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, all);
  EXPECT_EQ(*parse_review(review_text({}), "x"), Decisions());
}

TEST(Review, a_file_that_cannot_be_read_says_where_and_why) {
  const auto why = [](const std::string& text) {
    const auto read = parse_review(text, "theirs.json");
    EXPECT_FALSE(read) << text;
    if (read) return std::string();
    EXPECT_EQ(read.error().code, "review-file");
    EXPECT_EQ(read.error().subject, "theirs.json");
    return read.error().message;
  };
  const std::string one = R"({"building":"a","decision":"right","note":"","reviewer":"","time":"2026-11-28T10:00:00Z",)"
                          R"("model":"x"})";
  ASSERT_TRUE(parse_review(file_with(one), ""));
  EXPECT_THAT(why("{"), HasSubstr("not valid JSON at byte"));
  EXPECT_THAT(why("[]"), HasSubstr("mansard-review"));
  EXPECT_THAT(why(R"({"type":"mansard-review","version":2,"decisions":[]})"), HasSubstr("another version"));
  EXPECT_THAT(why(R"({"type":"mansard-review","version":1,"decisions":{}})"), HasSubstr("not an array"));
  EXPECT_THAT(why(file_with(one + "," + one)), HasSubstr("decision 2: the building a has one already"));
  EXPECT_THAT(why(file_with(R"({"building":"a"})")), HasSubstr("decision 1: "));
  auto maybe = one, undated = one;
  maybe.replace(maybe.find("right"), 5, "maybe");
  EXPECT_THAT(why(file_with(maybe)), HasSubstr("unknown decision 'maybe'"));
  undated.replace(undated.find("2026-11-28T10:00:00Z"), 20, "yesterday");
  EXPECT_THAT(why(file_with(undated)), HasSubstr("the time 'yesterday' is not of the form"));
}

TEST(Review, of_two_decisions_the_later_counts_in_either_order) {
  Decisions mine, theirs;
  mine["a"] = decision("a", Verdict::right, "2026-11-28T10:00:00Z");
  mine["b"] = decision("b", Verdict::right, "2026-11-28T12:00:00Z");
  mine["c"] = decision("c", Verdict::right, "2026-11-28T10:00:00Z");
  theirs["b"] = decision("b", Verdict::wrong, "2026-11-28T11:00:00Z", "bob");
  theirs["c"] = decision("c", Verdict::wrong, "2026-11-28T11:00:00Z", "bob");
  theirs["d"] = decision("d", Verdict::later, "2026-11-28T10:00:00Z", "bob");
  const auto both = merged(mine, theirs);
  EXPECT_EQ(both.decisions.size(), 4U);
  EXPECT_EQ(both.decisions.at("b").reviewer, "ann");
  EXPECT_EQ(both.decisions.at("c").reviewer, "bob");
  EXPECT_EQ(both.added, 1U);
  EXPECT_EQ(both.replaced, 1U);
  ASSERT_EQ(both.conflicts.size(), 2U);
  EXPECT_EQ(both.conflicts[0].kept.reviewer, "ann");
  EXPECT_EQ(both.conflicts[1].kept.reviewer, "bob");
  EXPECT_EQ(merged(theirs, mine).decisions, both.decisions);
  EXPECT_EQ(merged(both.decisions, both.decisions).decisions, both.decisions);
  // Also where the times are equal.
  theirs["a"] = decision("a", Verdict::wrong, "2026-11-28T10:00:00Z", "bob");
  EXPECT_EQ(merged(theirs, mine).decisions, merged(mine, theirs).decisions);
}

auto key_of(const model::Plan& plan, const model::Frame& frame) -> std::string {
  return model_key(std::vector{&plan}, frame);
}

TEST(Review, a_model_has_the_same_key_in_every_frame_and_another_when_it_changes) {
  model::Plan plan;
  plan.outer = {{{0, 0}, {8, 0}, {8, 10}, {0, 10}}, {0, 1, 0, 1}, {}};
  plan.profiles = {{{0, 0}, {0, 6}, {4, 9}}, {{0, 0}, {0, 9}}};
  plan.base = 1;
  plan.cap = 9;
  model::Frame frame, other;
  frame.origin = {85000, 447000, 0};
  other.origin = {84000, 447100, 1};
  auto moved = plan;
  for (auto& p : moved.outer.points) p = {p.x + 1000, p.y - 100};
  moved.base = 0;
  const auto key = key_of(plan, frame);
  EXPECT_EQ(key_of(moved, other), key);
  EXPECT_NE(key_of(plan, other), key);
  auto numbered = plan;  // the same profiles in another order
  std::swap(numbered.profiles[0], numbered.profiles[1]);
  numbered.outer.profile_of_edge = {1, 0, 1, 0};
  EXPECT_EQ(key_of(numbered, frame), key);
  plan.cap += 0.01;
  EXPECT_NE(key_of(plan, frame), key);
}

}  // namespace
}  // namespace mansard::report
