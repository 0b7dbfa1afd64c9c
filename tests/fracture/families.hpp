// Seeded families of cuts, from tame to hostile. Coordinates are multiples of 2^-20 m, so that shifts and turns of the
// input are exact.
#pragma once

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/fracture/fracture.hpp"

namespace mansard::fracture {

struct Family {
  std::string name;
  std::function<geometry::Segment2(base::Random&)> line;
  double left_out = 0;  ///< the share of cuts that may be left out
};

inline auto rounded(geometry::Point2 p) -> geometry::Point2 {
  return {std::round(p.x * 0x1p20) * 0x1p-20, std::round(p.y * 0x1p20) * 0x1p-20};
}

inline auto around(base::Random& random, geometry::Point2 middle, double angle) -> geometry::Segment2 {
  const geometry::Point2 direction{std::cos(angle), std::sin(angle)};
  return {middle - random.uniform(1, 30) * direction, middle + random.uniform(1, 30) * direction};
}

inline auto families() -> std::vector<Family> {
  constexpr double pi = 3.14159265358979323846;
  const auto somewhere = [](base::Random& r, double size) {
    const double x = r.uniform(0, size), y = r.uniform(0, size);  // in this order on every compiler
    return geometry::Point2{x, y};
  };
  const auto noise = [](base::Random& r, double by) {
    const double x = r.uniform(-by, by), y = r.uniform(-by, by);
    return geometry::Point2{x, y};
  };
  return {
      {"random",
       [=](base::Random& r) {
         const auto a = somewhere(r, 60);
         return geometry::Segment2{a, somewhere(r, 60)};
       },
       0},
      {"gridded",
       [=](base::Random& r) {
         const double x = 4.0 * static_cast<double>(r.index(16)), y = 4.0 * static_cast<double>(r.index(16));
         const double size = r.uniform(3, 25), by = r.uniform(0.01, 0.1);
         const geometry::Point2 a{x, y},
             b = r.index(2) == 0 ? geometry::Point2{x + size, y} : geometry::Point2{x, y + size};
         const auto start = a + noise(r, by);
         return geometry::Segment2{start, b + noise(r, by)};
       },
       0},
      {"town",
       [=](base::Random& r) {
         const auto a = somewhere(r, 60);
         const double angle = 0.2 + (r.index(2) == 0 ? 0 : pi / 2) + r.uniform(-0.05, 0.05), size = r.uniform(3, 25);
         return geometry::Segment2{a, a + size * geometry::Point2{std::cos(angle), std::sin(angle)}};
       },
       0},
      {"star",
       [=](base::Random& r) {
         const auto o = noise(r, 0.1);
         return around(r, o, r.uniform(0, pi));
       },
       0.02},
      {"bundle",
       [=](base::Random& r) {
         const auto o = noise(r, 3);
         return around(r, o, 0.3 + r.uniform(-0.02, 0.02));
       },
       0.01},
      {"crowd",
       [=](base::Random& r) {
         const auto a = somewhere(r, 1);
         return geometry::Segment2{a, somewhere(r, 1)};
       },
       0.01},
  };
}

inline auto cuts_of(const Family& family, std::size_t count, std::uint64_t seed) -> std::vector<Cut> {
  base::Random random(seed);
  std::vector<Cut> cuts;
  while (cuts.size() < count) {
    const auto [a, b] = family.line(random);
    cuts.push_back({{rounded(a), rounded(b)}, static_cast<std::uint32_t>(cuts.size())});
  }
  return cuts;
}

/// MANSARD_SEED in the environment runs that seed alone.
inline auto seeds(std::uint64_t count) -> std::vector<std::uint64_t> {
  if (const char* seed = std::getenv("MANSARD_SEED")) return {std::strtoull(seed, nullptr, 10)};
  std::vector<std::uint64_t> result;
  for (std::uint64_t i = 1; i <= count; ++i) result.push_back(i);
  return result;
}

}  // namespace mansard::fracture
