#include "lab/explore/sensitivity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "explore/helpers.hpp"

namespace mansard::explore {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

auto axis_named(const std::vector<Axis>& axes, const std::string& key) -> Axis {
  const auto at = std::ranges::find(axes, key, &Axis::key);
  return at == axes.end() ? Axis{} : *at;
}

TEST(ParametersOf, halves_and_doubles_numbers) {
  const auto axes = parameters_of({"gamma", "sweep.setback_columns"}, {});
  ASSERT_TRUE(axes.has_value()) << axes.error().message;
  EXPECT_THAT(axis_named(*axes, "sweep.gamma").values, ElementsAre("5", "20"));
  EXPECT_THAT(axis_named(*axes, "sweep.setback_columns").values, ElementsAre("5", "20"));
}

TEST(ParametersOf, keeps_values_within_their_range) {
  pipeline::Options options;
  options.sweep.same_line_cosine = 0.98;  // at most 1
  options.sweep.setback = 0.4;            // at least 0.3
  const auto axes = parameters_of({"sweep.*"}, options);
  ASSERT_TRUE(axes.has_value());
  EXPECT_THAT(axis_named(*axes, "sweep.same_line_cosine").values, ElementsAre("0.49", "1"));
  EXPECT_THAT(axis_named(*axes, "sweep.setback").values, ElementsAre("0.3", "0.8"));
}

TEST(ParametersOf, leaves_out_values_that_the_parameter_has_already) {
  pipeline::Options options;
  options.segment.narrow = 0;     // neither half of it nor its double is another
  options.label.party_share = 1;  // its double is beyond the range
  const auto axes = parameters_of({"segment.narrow", "label.party_share", "segment.seconds"}, options);
  ASSERT_TRUE(axes.has_value());
  EXPECT_THAT(axis_named(*axes, "segment.narrow").values, IsEmpty());
  EXPECT_THAT(axis_named(*axes, "segment.seconds").values, IsEmpty()) << "it has no value";
  EXPECT_THAT(axis_named(*axes, "label.party_share").values, ElementsAre("0.5"));
}

TEST(ParametersOf, takes_every_other_value_of_choices_and_flags) {
  const auto axes = parameters_of({"profile.quality", "segment.cliques"}, {});
  ASSERT_TRUE(axes.has_value());
  EXPECT_THAT(axis_named(*axes, "profile.quality").values, ElementsAre("simple", "moderate"));
  EXPECT_THAT(axis_named(*axes, "segment.cliques").values, ElementsAre("true"));
}

TEST(ParametersOf, has_ordinary_and_advanced_ones_of_the_modules_that_make_models) {
  const auto axes = parameters_of({}, {});
  ASSERT_TRUE(axes.has_value());
  EXPECT_FALSE(axis_named(*axes, "sweep.gamma").values.empty());
  EXPECT_FALSE(axis_named(*axes, "sweep.column_width").values.empty());
  for (const auto& axis : *axes)
    for (const auto* module : {"ingest.", "evaluate.", "write.", "roof.", "derive."})
      EXPECT_FALSE(axis.key.starts_with(module)) << axis.key;
}

TEST(ParametersOf, gives_only_values_that_their_options_take) {
  const auto axes = parameters_of({}, {});
  ASSERT_TRUE(axes.has_value());
  for (const auto& axis : *axes)
    for (const auto& value : axis.values) {
      pipeline::Options options;
      auto lists = pipeline::option_lists(options);
      EXPECT_TRUE(pipeline::set_option(lists, axis.key, value)) << axis.key << " = " << value;
    }
}

TEST(ParametersOf, refuses_an_unknown_name) {
  const auto axes = parameters_of({"sweep.gama"}, {});
  ASSERT_FALSE(axes.has_value());
  EXPECT_EQ(axes.error().code, "explore-axis");
  EXPECT_EQ(axes.error().subject, "sweep.gama");
}

TEST(EffectsOf, sorts_parameters_by_their_largest_effect_and_knows_those_without) {
  const std::vector<Trial> usual{{"a", "", "", 1.0, 0.5, 100, 3, 1, "m", ""},
                                 {"b", "", "", 2.0, 1.0, 50, 1, 1, "n", ""}};
  const std::vector<Axis> axes{{"sweep.gamma", {"5", "20"}}, {"segment.alpha", {"20"}}, {"segment.beta", {"30"}}};
  const std::vector<Trial> trials{{"a", "sweep.gamma", "5", 1.0, 0.5, 100, 3, 1, "m", ""},
                                  {"b", "sweep.gamma", "5", 2.0, 1.0, 50, 1, 1, "n", ""},
                                  {"a", "sweep.gamma", "20", 1.1, 0.5, 100, 3, 1, "other", ""},
                                  {"b", "sweep.gamma", "20", 2.0, 1.0, 50, 1, 1, "n", ""},
                                  {"a", "segment.alpha", "20", 1.0, 0.5, 100, 3, 1, "m", ""},
                                  {"b", "segment.alpha", "20", 2.0, 1.0, 75, 2, 1, "z", ""},
                                  {"a", "segment.beta", "30", 0, 0, 0, 0, 0, "", "it failed"},
                                  {"b", "segment.beta", "30", 2.0, 1.0, 50, 1, 1, "n", ""}};
  const auto effects = effects_of(usual, trials, axes, {});
  ASSERT_EQ(effects.size(), 4U);
  EXPECT_EQ(effects[0].key, "segment.alpha");
  EXPECT_NEAR(effects[0].largest, 0.5, 1e-12) << "half as many faces again";
  EXPECT_EQ(effects[1].key, "sweep.gamma");
  EXPECT_TRUE(effects[1].none) << "the same models";
  EXPECT_NEAR(effects[2].largest, 0.1, 1e-9);
  EXPECT_FALSE(effects[2].none);
  EXPECT_EQ(effects[2].usual, "10");
  EXPECT_FALSE(effects[3].none) << "a run that failed says nothing";
}

TEST(Trials, are_read_back_as_they_were_written) {
  SensitivityRequest request;
  request.version = "1.2.3";
  const std::vector<Trial> trials{{"a, \"b\"", "sweep.gamma", "5", 0.125, 1.0 / 3, 10, 2, 0.25, "00ff", ""},
                                  {"c", "", "", 0, 0, 0, 0, 0, "", "[x] no, \"not\" that"}};
  const auto text = trials_head(request) + trial_line(trials[0]) + trial_line(trials[1]) + "a,line,that,was,cut";
  const auto read = trials_from(text, request);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].dataset, trials[0].dataset);
  EXPECT_EQ(read[0].rmse_inside, trials[0].rmse_inside);
  EXPECT_EQ(read[0].models, "00ff");
  EXPECT_EQ(read[1].failure, trials[1].failure);
  SensitivityRequest other = request;
  other.options.sweep.gamma = 11;
  EXPECT_THAT(trials_from(text, other), IsEmpty()) << "runs with other options cannot be compared";
}

class SensitivityOfHouses : public testing::Test {
 protected:
  auto request(const std::vector<std::string>& parameters) const -> SensitivityRequest {
    SensitivityRequest request;
    request.datasets = {houses_.dataset("houses")};
    request.parameters = *parameters_of(parameters, {});
    request.command = {"mansard", "explore", "sensitivity", "a & b"};
    request.version = "1.2.3";
    return request;
  }
  test::Houses houses_;
};

TEST_F(SensitivityOfHouses, finds_what_changes_models_and_what_does_not) {
  auto asked = request({"block.ground_reach", "profile.quality"});
  std::vector<Trial> seen;
  asked.on_done = [&](const Trial& trial) { seen.push_back(trial); };
  const auto result = sensitivity(asked);
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_EQ(seen.size(), 5U) << "the usual one, two reaches, two qualities";
  std::map<std::string, bool> none;
  for (const auto& effect : result->effects) none[effect.key + "=" + effect.value] = effect.none;
  EXPECT_TRUE(none.at("block.ground_reach=100"));
  EXPECT_FALSE(none.at("profile.quality=simple"));
  EXPECT_EQ(result->effects.front().key, "profile.quality");

  // What is known is not run again, and gives the same.
  asked.known = seen;
  seen.clear();
  const auto again = sensitivity(asked);
  ASSERT_TRUE(again.has_value());
  EXPECT_THAT(seen, IsEmpty());
  EXPECT_EQ(report(*again), report(*result));
}

TEST_F(SensitivityOfHouses, are_reported_as_a_page_a_table_and_json) {
  const auto result = sensitivity(request({"block.ground_reach"}));
  ASSERT_TRUE(result.has_value());
  const auto files = report(*result);
  const std::map<std::string, std::string> by_name(files.begin(), files.end());
  const test::Xml page(by_name.at("index.html"));
  EXPECT_EQ(page.error, "");
  EXPECT_THAT(page.words_of_all, HasSubstr("block.ground_reach"));
  EXPECT_THAT(page.words_of_all, HasSubstr("no effect"));
  EXPECT_THAT(page.words_of_all, HasSubstr("a & b"));
  const auto json = nlohmann::json::parse(by_name.at("results.json"));
  EXPECT_EQ(json["effects"].size(), 2U);
  EXPECT_EQ(json["effects"][0]["no_effect"], true);
  EXPECT_THAT(by_name.at("results.csv"), HasSubstr("block.ground_reach,50,25,0,yes,houses,"));
}

}  // namespace
}  // namespace mansard::explore
