#include "mansard/geometry/curve.hpp"

namespace mansard::geometry {

auto along_curve(std::int64_t x, std::int64_t y) -> std::uint64_t {
  const auto spread = [](std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value + (std::int64_t{1} << 31));
    std::uint64_t out = 0;
    for (unsigned i = 0; i < 32; ++i) out |= (bits >> i & 1U) << (2 * i);
    return out;
  };
  return spread(x) | spread(y) << 1U;
}

auto from_curve(std::uint64_t number) -> std::array<std::int64_t, 2> {
  std::array<std::int64_t, 2> out{};
  for (unsigned i = 0; i < 64; ++i) out[i % 2] |= static_cast<std::int64_t>(number >> i & 1U) << (i / 2);
  for (auto& metres : out) metres -= std::int64_t{1} << 31;
  return out;
}

}  // namespace mansard::geometry
