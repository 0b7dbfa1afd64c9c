#include "mansard/base/result.hpp"

#include <gtest/gtest.h>

namespace {
using namespace mansard::base;

auto half(int n) -> Result<int> {
  if (n % 2 != 0) return error("odd", "expected an even number", std::to_string(n));
  return n / 2;
}

TEST(Result, and_then_goes_on_from_a_value) { EXPECT_EQ(half(8).and_then(half).and_then(half).value(), 1); }

TEST(Result, and_then_keeps_the_first_failure) {
  const auto result = half(6).and_then(half).and_then(half);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().subject, "3");
}

TEST(Result, transform_changes_the_value_only) {
  const auto text = [](int n) { return std::to_string(n); };
  EXPECT_EQ(half(4).transform(text).value(), "2");
  EXPECT_EQ(half(5).transform(text).error().code, "odd");
}

TEST(Result, a_failure_carries_several_diagnostics) {
  const auto result = half(5).also(error("file", "while 'a.txt' was read"));
  ASSERT_EQ(result.errors().size(), 2U);
  EXPECT_EQ(result.errors()[0].code, "odd");
  EXPECT_EQ(result.errors()[1].code, "file");
  const Result<std::string> other = result.failure();
  EXPECT_EQ(other.errors(), result.errors());
  EXPECT_EQ(half(4).also(error("file", "")).value(), 2);
}

TEST(Result, success_without_a_value_chains_too) {
  Result<void> good;
  EXPECT_EQ(good.and_then([] { return half(2); }).value(), 1);
  Result<void> bad = Result<void>(error("a", "")).also(error("b", ""));
  EXPECT_EQ(bad.errors().size(), 2U);
  EXPECT_EQ(bad.and_then([] { return half(2); }).error().code, "a");
}

TEST(ResultDeathTest, the_value_of_a_failure_ends_the_program_in_every_build) {
  EXPECT_DEATH((void)half(3).value(), "bug: the value of a failed result was read:\n  error.odd. 3: expected an even");
  EXPECT_DEATH((void)*half(3), "error.odd.");
}

TEST(ResultDeathTest, the_error_of_a_value_ends_the_program_in_every_build) {
  EXPECT_DEATH((void)half(2).error(), "bug: a result was read as the failure that it is not");
  EXPECT_DEATH((void)Result<void>().error(), "bug:");
  EXPECT_DEATH((void)Result<int>(Failure{}), "bug:");
}
}  // namespace
