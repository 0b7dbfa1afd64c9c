#include <gmock/gmock.h>

#include "apps/server/requests.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;

constexpr const char* plan =
    R"({"base":0,"cap":5,"outer":{"points":[[0,0],[4,0],[4,4],[0,4]],"profile_of_edge":[0,0,0,0]},"holes":[],"profiles":[[[0,0],[0,5]]]})";

template <class T>
void expect_refusal(const base::Result<T>& result, const std::string& code, const std::string& words) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, code);
  EXPECT_THAT(result.error().message, HasSubstr(words));
}

TEST(Requests, report_the_byte_at_which_json_is_invalid) {
  expect_refusal(read_changes(R"({"changes":[)"), "server-body", "at byte 13");
  expect_refusal(read_changes(""), "server-body", "at byte 1");
  expect_refusal(read_changes("\xff"), "server-body", "at byte 1");
  expect_refusal(read_changes(R"({"changes":[1e999]})"), "server-body", "out of range");
}

TEST(Requests, report_the_invalid_member) {
  expect_refusal(read_changes("[]"), "server-body", "the body must be an object");
  expect_refusal(read_changes("{}"), "server-body", "no \"changes\"");
  expect_refusal(read_changes(R"({"changes":[{"building":1,"revision":0,"parts":[]}]})"), "server-body",
                 "changes[0].building must be a string");
  expect_refusal(read_changes(R"({"changes":[{"building":"a","revision":-1,"parts":[]}]})"), "server-body",
                 "changes[0].revision must be an integer");
  expect_refusal(read_changes(R"({"changes":[{"building":"a","revison":0,"parts":[]}]})"), "server-body",
                 "did you mean");
  expect_refusal(read_split(R"({"building":"a","part":"a-1","line":[[0,0],[1]]})"), "server-body",
                 "line[1] must be an array of 2 numbers");
  expect_refusal(read_merge(R"({"parts":[{"building":"a","part":"a-1"}]})"), "server-body", "two parts");
  expect_refusal(read_nothing("{\"a\":1}"), "server-body", "unknown member");
  expect_refusal(read_inputs(R"({"meshes":[],"footprints":"f"})"), "server-body", "at least one file");
  expect_refusal(read_export(R"({"overwrite":true,"formats":"stl"})"), "server-body", "formats must be");
}

TEST(Requests, refuse_invalid_plans_with_the_codes_of_plan_files) {
  const std::string broken = R"({"base":0,"cap":"5"})";
  const auto read =
      read_changes(R"({"changes":[{"building":"a","revision":0,"parts":[{"id":"a-1","plan":)" + broken + "}]}]}");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().code, HasSubstr("write-plan-"));
}

TEST(Requests, refuse_deep_nesting_without_parsing) {
  expect_refusal(read_changes(std::string(1'000'000, '[')), "server-body", "nested deeper");
  const std::string brackets(100, '[');
  EXPECT_TRUE(read_label("{\"label\":\"" + brackets + "\"}")) << "brackets in a string do not count";
}

TEST(Requests, keep_names_on_one_line) {
  const auto label = read_label("{\"label\":\"two\\nlines\"}");
  ASSERT_TRUE(label);
  EXPECT_EQ(*label, "two lines");
}

TEST(Requests, check_the_edges_of_a_plan) {
  const auto request = read_section(std::string(R"({"plan":)") + plan + R"(,"ring":0,"edge":3,"share":0.5})");
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_TRUE(check_edge(request->plan, 0, 3, 0.5));
  EXPECT_FALSE(check_edge(request->plan, 0, 4, 0.5));
  EXPECT_FALSE(check_edge(request->plan, 1, 0, 0.5));
  EXPECT_FALSE(check_edge(request->plan, 0, 0, 1.5));
}

}  // namespace
}  // namespace mansard::server
