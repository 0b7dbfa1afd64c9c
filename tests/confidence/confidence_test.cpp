#include "mansard/confidence/confidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace mansard;
using confidence::confidence_of;
using confidence::Evidence;
using enum confidence::Measure;

/// A house of a good scan, with nothing against it.
auto good() -> Evidence {
  Evidence out;
  out[area] = 90;
  out[height] = 8;
  out[rms] = 0.05;
  out[top] = 0.1;
  out[free] = 0.6;
  out[walls] = 0.4;
  out[relief] = 1;
  out[samples] = 500;
  out[planes] = 2;
  out[spread] = 2.5;
  out[noise] = 0.03;
  out[spacing] = 0.35;
  out[edge_noise] = 0.1;
  out[offset] = 0.05;
  return out;
}

TEST(Confidence, is_high_where_nothing_speaks_against_a_model) {
  const auto found = confidence_of(good());
  EXPECT_GT(found.right, 0.9);
  EXPECT_TRUE(found.reasons.empty());
  EXPECT_LT(found.error, 0.5);
}

struct Fault {
  const char* what;
  std::vector<std::pair<confidence::Measure, double>> measured;
  const char* reason;
};

TEST(Confidence, names_what_speaks_most_against_a_model_first) {
  const std::vector<Fault> faults{
      {"a deck or scaffold all around, or a footprint that is too small",
       {{ring_high, 0.9}, {ring_side, 1}, {gap, 1.5}},
       "confidence-beside"},
      {"the building is gone",
       {{low, 1}, {rim_low, 1}, {rim_side, 1}, {below, 1}, {patch_below, 60}, {height, 0.5}},
       "confidence-ground"},
      {"a roof that goes on beyond the footprint", {{ring_side, 1}, {gap, 0.2}, {seamless, 1}}, "confidence-beside"},
      {"a tower beside its place", {{steps, 40}, {misplaced, 3}}, "confidence-walls"},
      {"most of the footprint is a yard, and the rest low", {{razed, 0.9}, {height, 2}}, "confidence-ground"},
      {"a register that knows two storeys more", {{height_off, -6}}, "confidence-height"},
  };
  for (const auto& fault : faults) {
    auto evidence = good();
    for (const auto& [measure, value] : fault.measured) evidence[measure] = value;
    const auto found = confidence_of(evidence);
    EXPECT_LT(found.right, confidence_of(good()).right) << fault.what;
    ASSERT_FALSE(found.reasons.empty()) << fault.what;
    EXPECT_EQ(found.reasons.front().code, fault.reason) << fault.what << ": " << found.reasons.front().message;
  }
}

TEST(Confidence, says_whether_the_scan_or_the_model_is_missing) {
  const auto words = [](double not_seen, double not_built) {
    auto evidence = good();
    evidence[unseen] = not_seen;
    evidence[crowns] = not_seen;
    evidence[bare] = not_built;
    evidence[steps] = 40;
    evidence[misplaced] = 3;  // else it is high, and has no reasons
    for (const auto& reason : confidence_of(evidence).reasons)
      if (reason.code == "confidence-unseen") return reason.message;
    return std::string();
  };
  EXPECT_EQ(words(0.8, 0), "the scan does not cover 80 % of the footprint, most of it below trees");
  EXPECT_EQ(words(0, 0.7), "70 % of the footprint has no model, where the scan does not show the ground");
}

TEST(Confidence, falls_with_every_measure_that_speaks_against_a_model) {
  const std::vector<std::pair<confidence::Measure, double>> worse{
      {unseen, 0.8},  {above, 0.4},  {below, 0.4},  {patch_above, 30}, {patch_below, 30}, {stacked, 2},
      {sunk, 2},      {top, 6},      {rough, 0.3},  {ring_high, 0.8},  {ring_side, 1},    {gap, 0.4},
      {rim_low, 0.8}, {rim_side, 1}, {low, 0.9},    {height_off, 5},   {fallback, 1},     {small_planes, 0.6},
      {bare, 0.5},    {razed, 0.5},  {seamless, 1}, {steps, 20},       {misplaced, 2}};
  const double before = confidence_of(good()).right;
  for (const auto& [measure, value] : worse) {
    auto evidence = good();
    evidence[measure] = value;
    EXPECT_LE(confidence_of(evidence).right, before) << confidence::name_of(measure);
  }
}

TEST(Confidence, has_classes) {
  EXPECT_EQ(confidence::class_of(0.95), "high");
  EXPECT_EQ(confidence::class_of(0.85), "high");
  EXPECT_EQ(confidence::class_of(0.84), "medium");
  EXPECT_EQ(confidence::class_of(0.49), "low");
}

TEST(Confidence, has_a_code_for_every_reason) {
  Evidence all;
  for (std::size_t m = 0; m < confidence::measures; ++m) all.of[m] = 10;
  const auto known = confidence::codes();
  const auto found = confidence_of(all);
  EXPECT_FALSE(found.reasons.empty());
  for (const auto& reason : found.reasons) {
    EXPECT_TRUE(std::ranges::any_of(known, [&](const auto& code) { return code.code == reason.code; })) << reason.code;
    EXPECT_FALSE(reason.message.empty());
  }
}

}  // namespace
