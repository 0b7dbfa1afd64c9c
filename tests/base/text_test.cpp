#include "mansard/base/text.hpp"

#include <gtest/gtest.h>
#include <clocale>

namespace mansard::base {
namespace {

TEST(Text, of_a_number_reads_back_as_the_same_number) {
  for (const double value : {0.0, 0.1, -1.0 / 3, 1e300, 5e-324, 447400.123456789})
    EXPECT_EQ(to_number(to_text(value)), value);
}

TEST(Text, fixed_notation_never_writes_a_negative_zero) {
  EXPECT_EQ(to_text(-0.0004, 3), "0.000");
  EXPECT_EQ(to_text(-0.0006, 3), "-0.001");
  EXPECT_EQ(to_text(1234.5, 1), "1234.5");
}

TEST(Text, takes_whole_finite_numbers_only) {
  EXPECT_EQ(to_number("+1.5"), 1.5);
  for (const auto* text : {"", "1,5", "1.5 ", " 1", "nan", "inf", "1e999", "0x10", "1.5m"})
    EXPECT_FALSE(to_number(text)) << text;
  EXPECT_EQ(to_integer("-7"), -7);
  for (const auto* text : {"", "7.0", "99999999999999999999"}) EXPECT_FALSE(to_integer(text)) << text;
}

TEST(Text, lower_changes_ascii_letters_only) { EXPECT_EQ(lower("ÄB.City.JSON 9"), "Äb.city.json 9"); }

}  // namespace
}  // namespace mansard::base
