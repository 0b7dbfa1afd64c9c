// `mansard review`: decisions of several people counted and merged.
#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;

auto one(const std::string& building, const std::string& verdict, const std::string& reviewer, int hour)
    -> std::string {
  return R"({"building":")" + building + R"(","decision":")" + verdict + R"(","note":"","reviewer":")" + reviewer +
         R"(","time":"2026-11-28T1)" + std::to_string(hour) + R"(:00:00Z","model":"0"})";
}
auto file_of(const std::string& decisions) -> std::string {
  return R"({"type":"mansard-review","version":1,"decisions":[)" + decisions + "]}";
}

using Review = Command;

TEST_F(Review, merges_the_decisions_of_two_people_and_lists_where_they_disagree) {
  const auto north = put("north.json", file_of(one("a", "right", "Ann", 1) + "," + one("b", "right", "Ann", 1)));
  const auto south = put("south.json", file_of(one("b", "wrong", "Bob", 2) + "," + one("c", "later", "", 2)));
  const auto outcome = run("review " + north + " " + south + " -o " + at("both.json"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3 decisions: 1 right, 1 wrong, 1 later\n"));
  EXPECT_THAT(outcome.out, HasSubstr("  Ann: 1 right, 0 wrong, 0 later\n"));
  EXPECT_THAT(outcome.out, HasSubstr("  no name: 0 right, 0 wrong, 1 later\n"));
  EXPECT_THAT(outcome.out, HasSubstr("b: wrong (Bob, 2026-11-28T12:00:00Z) is kept, right (Ann, 2026-11-28T11:00:00Z) "
                                     "is not\n"));
  const auto both = read(at("both.json"));
  ASSERT_EQ(run("review -q " + south + " " + north + " -o " + at("again.json")).exit, 0);
  EXPECT_EQ(read(at("again.json")), both) << "the order does not matter";
  EXPECT_THAT(run("review " + at("both.json")).out, HasSubstr("3 decisions: 1 right, 1 wrong, 1 later\n"));
}

TEST_F(Review, refuses_what_it_cannot_read_and_replaces_nothing_unasked) {
  const auto good = put("good.json", file_of(one("a", "right", "Ann", 1)));
  expect_refusal(run("review " + at("none.json")), 3, "file-missing", "none.json");
  expect_refusal(run("review " + good + " " + put("bad.json", file_of(one("a", "maybe", "", 1)))), 3, "review-file",
                 "decision 1: unknown decision 'maybe'");
  // tried: expected review.json of a project, as 'mansard serve' writes it
  EXPECT_EQ(run("review " + put("bad.json", file_of(one("a", "wrong", "", 1)))).exit, 0);
  fs::create_directory(at("empty"));
  expect_refusal(run("review " + at("empty")), 3, "review-file", "no project");
  const auto out = put("out.json", "kept");
  expect_refusal(run("review " + good + " -o " + out), 2, "output-exists");
  EXPECT_EQ(read(out), "kept");
  EXPECT_EQ(run("review " + good + " -o " + out + " --overwrite").exit, 0);
  EXPECT_THAT(read(out), HasSubstr("\"Ann\""));
  expect_refusal(run("review " + good + " -o " + good + " --overwrite"), 2, "output-input");
  expect_refusal(run("review"), 2, "usage", "mansard review REVIEW...");
}

}  // namespace
}  // namespace mansard::cli
