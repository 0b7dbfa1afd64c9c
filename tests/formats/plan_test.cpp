// One plan as JSON, there and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cities.hpp"

namespace {

using mansard::formats::plan_json;
using mansard::formats::read_plan;
using mansard::model::Plan;
using testing::HasSubstr;

auto plan() -> Plan {
  Plan plan;
  plan.base = 1.0 / 3;
  plan.cap = 1e-3 + 9;
  plan.profiles = {{{0, 0}, {0, 5.1}, {3, 8}}, {{0, 0}, {0, 9}}};
  plan.outer = {{{0.1, 0.2}, {10, 0}, {10, 8}, {0, 8}}, {0, 1, 0, 1}};
  plan.holes = {{{{4, 4}, {4, 5}, {5, 5}}, {1, 1, 0}}};
  return plan;
}

TEST(PlanJson, reads_back_as_the_very_same_plan_on_one_line) {
  const auto text = plan_json(plan());
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto read = read_plan(text, "here");
  ASSERT_TRUE(read) << mansard::base::to_string(read.error());
  EXPECT_EQ(*read, plan());
}

TEST(PlanJson, is_the_plan_of_a_file_of_plans) {
  cities::City city;
  city.buildings.push_back({"b", {}, {}, 0, {{"b-1", plan(), {}, {}}}});
  const auto file = nlohmann::json::parse(mansard::formats::plans(city));
  EXPECT_EQ(nlohmann::json::parse(plan_json(plan())), file["buildings"][0]["parts"][0]["plan"]);
}

TEST(PlanJson, refuses_what_a_file_of_plans_may_not_have_either) {
  const auto refused = [](const std::string& text) {
    const auto read = read_plan(text, "the draft");
    EXPECT_FALSE(read);
    if (read) return std::string();
    EXPECT_EQ(read.error().subject, "the draft");
    return read.error().code + ": " + read.error().message;
  };
  const auto with = [](const char* member, const nlohmann::json& value) {
    auto json = nlohmann::json::parse(plan_json(plan()));
    json[member] = value;
    return json.dump();
  };
  EXPECT_THAT(refused("{"), HasSubstr("write-plan-json"));
  EXPECT_THAT(refused("[]"), HasSubstr("write-plan-value"));
  EXPECT_THAT(refused("{}"), HasSubstr("write-plan-missing"));
  EXPECT_THAT(refused(with("caps", 1)), HasSubstr("did you mean \"cap\""));
  EXPECT_THAT(refused(with("cap", 0)), HasSubstr("write-plan-value"));
  EXPECT_THAT(refused(with("base", nullptr)), HasSubstr("base must be a number"));
  EXPECT_THAT(refused(with("profiles", {{{0, 0}, {1, -1}}})), HasSubstr("write-plan-profile"));
}

}  // namespace
