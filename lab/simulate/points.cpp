#include "lab/simulate/points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lab/simulate/detail/labels.hpp"
#include "lab/simulate/detail/noise.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::simulate {

namespace {

/// Squared distances along the normals of roofs, and how many.
struct Drawn {
  double squares = 0, count = 0;
};

auto planted_of(const Accuracy& mesh, const Drawn& drawn, double density) -> Accuracy {
  Accuracy out{0, 0, 1 / std::sqrt(density), mesh.blur};
  const double shared = mesh.noise * mesh.noise, own = drawn.count > 0 ? drawn.squares / drawn.count : 0;
  if (shared + own <= 0) return out;
  out.noise = std::sqrt(shared + own);
  out.correlated_area = (shared * std::max(mesh.correlated_area, 1 / density) + own / density) / (shared + own);
  return out;
}

}  // namespace

auto airborne_points(const Scan& scan, const AirborneOptions& options, std::uint64_t seed) -> AirbornePoints {
  const auto box = geometry::Box2::of(scan.mesh.vertices);
  if (box.empty() || !(options.density > 0)) return {};
  const double step = 1 / std::sqrt(options.density);
  const auto columns = static_cast<std::size_t>((box.most.x - box.least.x) / step) + 1,
             rows = static_cast<std::size_t>((box.most.y - box.least.y) / step) + 1;
  const rays::Scene scene(scan.mesh);
  const bool noisy = options.noise > 0 || options.noise_plan > 0;
  std::vector<std::vector<formats::CloudPoint>> lines(rows);
  std::vector<Drawn> drawn(rows);
  base::parallel_for(rows, [&](std::size_t row) {
    // Of its own, so that the points are the same with and without noise.
    base::Random random(seed, row);
    auto noise = detail::random_of(seed, row);
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
      if (noisy) {
        const geometry::Point3 by{options.noise_plan * detail::near_normal(noise),
                                  options.noise_plan * detail::near_normal(noise),
                                  options.noise * detail::near_normal(noise)};
        point.position = point.position + by;
        if (kind == Class::roof) {
          const double off = dot(by, detail::normal_of(scan.mesh, scan.mesh.triangles[seen->triangle]));
          drawn[row].squares += off * off;
          drawn[row].count += 1;
        }
      }
      lines[row].push_back(point);
    }
  });
  AirbornePoints out;
  for (const auto& line : lines) out.points.insert(out.points.end(), line.begin(), line.end());
  Drawn all;
  for (const auto& some : drawn) all.squares += some.squares, all.count += some.count;
  out.planted = planted_of(scan.planted, all, options.density);
  return out;
}

}  // namespace mansard::simulate
