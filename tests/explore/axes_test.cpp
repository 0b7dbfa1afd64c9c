#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/explore/explore.hpp"

namespace mansard::explore {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void expect_error(std::string_view text, const std::string& code, const std::string& words) {
  const auto axis = axis_of(text);
  ASSERT_FALSE(axis.has_value()) << text;
  EXPECT_EQ(axis.error().code, code) << axis.error().message;
  EXPECT_THAT(axis.error().message, HasSubstr(words));
}

TEST(AxisOf, takes_an_option_by_any_of_its_names) {
  for (const auto* text : {"sweep.gamma=10,20.5", "sweep-gamma=10,20.5", "gamma=10,20.5", "--gamma=10,20.5",
                           "--sweep-gamma=10,20.5", "sweep_gamma=10,20.5"}) {
    const auto axis = axis_of(text);
    ASSERT_TRUE(axis.has_value()) << text;
    EXPECT_EQ(axis->key, "sweep.gamma") << text;
    EXPECT_THAT(axis->values, ElementsAre("10", "20.5"));
  }
}

TEST(AxisOf, names_the_nearest_option_for_one_that_does_not_exist) {
  expect_error("gama=10", "option-unknown", "did you mean 'gamma'?");
}

TEST(AxisOf, refuses_values_that_the_option_does_not_take) {
  expect_error("gamma=10,many", "option-value", "many");
  expect_error("gamma=10,-5", "option-value", "");
  expect_error("profile.quality=simple,splendid", "option-value", "splendid");
}

TEST(AxisOf, refuses_what_is_no_axis) {
  expect_error("gamma", "explore-axis", "gamma=10,20,40");
  expect_error("=1,2", "explore-axis", "");
  expect_error("gamma=", "option-value", "");
  expect_error("gamma=10,,20", "option-value", "");
  expect_error("gamma=10,20,10", "explore-axis", "twice");
}

TEST(AxisOf, refuses_options_that_decide_how_the_scan_is_read) {
  expect_error("ingest.id_attribute=a,b", "explore-axis", "read once");
}

TEST(AxesOf, gives_every_experiment_of_the_paper_its_own) {
  const auto gamma = axes_of(Experiment::gamma, {});
  ASSERT_TRUE(gamma.has_value());
  ASSERT_EQ(gamma->size(), 1U);
  EXPECT_EQ(gamma->front().values.front(), "10");
  EXPECT_EQ(gamma->front().values.back(), "90");
  EXPECT_EQ(axes_of(Experiment::alpha_beta, {})->size(), 2U);
  EXPECT_THAT(axes_of(Experiment::quality, {})->front().values, ElementsAre("simple", "moderate", "high"));
  EXPECT_TRUE(axes_of(Experiment::table, {})->empty());
}

TEST(AxesOf, has_only_values_that_their_options_take) {
  for (const auto& name : experiment_names()) {
    if (name == "grid") continue;
    const auto axes = axes_of(*experiment_of(name), {});
    ASSERT_TRUE(axes.has_value());
    for (const auto& axis : *axes) {
      std::string text = axis.key + "=";
      for (const auto& value : axis.values) text += (&value == &axis.values.front() ? "" : ",") + value;
      const auto read = axis_of(text);
      ASSERT_TRUE(read.has_value()) << text << ": " << read.error().message;
      EXPECT_EQ(read->values, axis.values);
    }
  }
}

TEST(AxesOf, puts_asked_values_in_place_of_the_experiments) {
  const auto axes = axes_of(Experiment::alpha_beta, {{"segment.beta", {"1", "2"}}});
  ASSERT_TRUE(axes.has_value());
  EXPECT_EQ((*axes)[0].key, "segment.alpha");
  EXPECT_THAT((*axes)[1].values, ElementsAre("1", "2"));
}

TEST(AxesOf, refuses_what_the_experiment_does_not_vary_and_what_is_given_twice) {
  const std::vector<Axis> gamma{{"sweep.gamma", {"1"}}}, twice{gamma.front(), gamma.front()};
  EXPECT_EQ(axes_of(Experiment::quality, gamma).error().code, "explore-axis");
  EXPECT_EQ(axes_of(Experiment::grid, twice).error().code, "explore-axis");
  EXPECT_EQ(axes_of(Experiment::grid, {}).error().code, "explore-axis");
}

TEST(SettingsOf, has_every_combination_the_last_axis_fastest) {
  const auto settings = settings_of({{"a", {"1", "2"}}, {"b", {"x", "y"}}}, 4);
  ASSERT_TRUE(settings.has_value());
  EXPECT_THAT(*settings, ElementsAre(Setting{{"a", "1"}, {"b", "x"}}, Setting{{"a", "1"}, {"b", "y"}},
                                     Setting{{"a", "2"}, {"b", "x"}}, Setting{{"a", "2"}, {"b", "y"}}));
  EXPECT_THAT(*settings_of({}, 1), ElementsAre(Setting{}));
}

TEST(SettingsOf, refuses_more_than_allowed_before_it_makes_them) {
  const std::vector<std::string> values(1000, "v");
  const auto settings = settings_of({{"a", values}, {"b", values}, {"c", values}, {"d", values}}, 100);
  ASSERT_FALSE(settings.has_value());
  EXPECT_EQ(settings.error().code, "explore-runs");
  EXPECT_THAT(settings.error().message, HasSubstr("--most-runs"));
}

TEST(ExperimentOf, knows_every_name_and_no_other) {
  for (const auto& name : experiment_names()) {
    ASSERT_TRUE(experiment_of(name).has_value());
    EXPECT_EQ(to_string(*experiment_of(name)), name);
  }
  EXPECT_FALSE(experiment_of("alpha").has_value());
}

}  // namespace
}  // namespace mansard::explore
