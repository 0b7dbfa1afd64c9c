#include "mansard/base/pack.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace mansard::base {
namespace {

enum class Colour : std::uint8_t { red, green };
struct Inner {
  double x = 0;
  std::array<int, 3> three{};
  friend auto operator==(const Inner&, const Inner&) -> bool = default;
};
struct Outer {
  Colour colour = Colour::red;
  std::string words;
  std::vector<Inner> inner;
  std::vector<std::vector<std::uint32_t>> loops;
  std::optional<Inner> maybe, never;
  std::variant<std::monostate, bool, std::int64_t, double, std::string> value;
  std::vector<std::pair<std::string, bool>> pairs;
  std::vector<float> numbers;
  friend auto operator==(const Outer&, const Outer&) -> bool = default;
};

auto sample() -> Outer {
  return {Colour::green,    std::string("a\0b", 3), {{1.5, {1, 2, 3}}, {std::numeric_limits<double>::denorm_min(), {}}},
          {{}, {7, 8}},     Inner{-0.0, {4, 5, 6}}, std::nullopt,
          std::string("v"), {{"k", true}},          {0.25F}};
}

TEST(Pack, counts_the_members_of_a_struct) {
  EXPECT_EQ(detail::members<Inner>(), 2U);
  EXPECT_EQ(detail::members<Outer>(), 9U);
}

TEST(Pack, gives_back_what_went_in) {
  const auto bytes = packed(sample());
  Outer back;
  Unpacker from(bytes);
  EXPECT_TRUE(from.take(back));
  EXPECT_TRUE(from.done());
  EXPECT_EQ(back, sample());
  EXPECT_EQ(packed(back), bytes);
}

TEST(Pack, notices_every_cut) {
  const auto bytes = packed(sample());
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    Outer back;
    EXPECT_FALSE(Unpacker(std::string_view(bytes).substr(0, n)).take(back)) << n;
  }
}

TEST(Pack, takes_no_memory_for_absurd_lengths) {
  std::string bytes = packed(std::uint64_t{1} << 60);
  std::vector<double> numbers;
  std::vector<std::string> words;
  EXPECT_FALSE(Unpacker(bytes).take(numbers));
  EXPECT_FALSE(Unpacker(bytes).take(words));
}

TEST(Pack, notices_an_unknown_alternative) {
  const std::string bytes = packed(std::uint64_t{9});
  std::variant<std::monostate, bool> value;
  EXPECT_FALSE(Unpacker(bytes).take(value));
}

}  // namespace
}  // namespace mansard::base
