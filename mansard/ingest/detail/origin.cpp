#include "mansard/ingest/detail/origin.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::ingest::detail {

auto origin_of(const geometry::Box2& centred, const geometry::Box3& all) -> std::array<std::int64_t, 3> {
  constexpr double small = 1024;
  const auto along = [](double least, double most, double from) -> std::int64_t {
    return std::max(std::abs(least), std::abs(most)) <= small ? 0 : static_cast<std::int64_t>(std::floor(from));
  };
  const geometry::Point2 middle = 0.5 * (centred.least + centred.most);
  geometry::Box2 both = centred;
  both.include(all.plan());
  return {along(both.least.x, both.most.x, middle.x), along(both.least.y, both.most.y, middle.y),
          along(all.least.z, all.most.z, all.least.z)};
}

}  // namespace mansard::ingest::detail
