#include "lab/simulate/points.hpp"

#include <cmath>
#include <optional>

#include "mansard/rays/rays.hpp"

namespace mansard::simulate {

auto airborne_points(const Scan& scan, double density, std::uint64_t seed) -> std::vector<formats::CloudPoint> {
  const auto box = geometry::Box2::of(scan.mesh.vertices);
  if (box.empty() || !(density > 0)) return {};
  const double step = 1 / std::sqrt(density);
  const auto columns = static_cast<std::size_t>((box.most.x - box.least.x) / step) + 1,
             rows = static_cast<std::size_t>((box.most.y - box.least.y) / step) + 1;
  const rays::Scene scene(scan.mesh);
  std::vector<std::vector<formats::CloudPoint>> lines(rows);
  base::parallel_for(rows, [&](std::size_t row) {
    base::Random random(seed, row);
    for (std::size_t column = 0; column < columns; ++column) {
      const double x = box.least.x + (static_cast<double>(column) + random.uniform()) * step,
                   y = box.least.y + (static_cast<double>(row) + random.uniform()) * step;
      const double draw = random.uniform();
      const auto seen = scene.seen_from_above({x, y});
      if (!seen) continue;
      formats::CloudPoint point;
      point.position = {x, y, seen->z};
      const auto kind = scan.classes[seen->triangle];
      point.classification = kind == Class::ground ? 2 : kind == Class::other ? 1 : 6;
      point.returns = kind == Class::other && draw < 0.7 ? 2 : 1;
      lines[row].push_back(point);
    }
  });
  std::vector<formats::CloudPoint> out;
  for (const auto& line : lines) out.insert(out.end(), line.begin(), line.end());
  return out;
}

}  // namespace mansard::simulate
