// How well roofs that are made in one step suit a scan: over every part of a reconstruction, the best roof of each kind
// beside the roof that the reconstruction gave it.
//   bench_roofs MESH FOOTPRINTS [MODULE.OPTION=VALUE…]
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "bench/edit/options.hpp"
#include "mansard/base/statistics.hpp"
#include "mansard/base/text.hpp"
#include "mansard/edit/roofs.hpp"
#include "mansard/evaluate/evaluate.hpp"

namespace {

using namespace mansard;

struct Row {
  std::string part;
  double own = 0, area = 0;  // m²
  std::array<double, refine::kinds.size()> of{};
  std::array<double, refine::kinds.size()> above{};  // m: highest point over that of the scan
};

auto top_of(const model::Plan& plan, const pipeline::Options& options) -> double {
  const auto raised = pipeline::raise_part(plan, options);
  double top = -std::numeric_limits<double>::infinity();
  if (raised)
    for (const auto& vertex : raised->solid.vertices) top = std::max(top, vertex.z);
  return top;
}

/// z; of the scan over a part.
auto highest(const model::Plan& plan, const rays::Scene& scan) -> double {
  const auto polygon = model::polygon_of(plan);
  const auto box = geometry::bounds(polygon.outer);
  double top = -std::numeric_limits<double>::infinity();
  for (double x = box.least.x; x < box.most.x; x += 0.25)
    for (double y = box.least.y; y < box.most.y; y += 0.25)
      if (geometry::contains(polygon, {x, y}))
        if (const auto z = scan.top({x, y})) top = std::max(top, *z);
  return top;
}

}  // namespace

auto main(int argc, char** argv) -> int {
  if (argc < 3) return std::puts("bench_roofs MESH FOOTPRINTS [MODULE.OPTION=VALUE…]"), 2;
  const auto given = bench::options_of(argc, argv);
  if (!given) return std::puts(base::to_string(given.error()).c_str()), 2;
  const pipeline::Options& options = *given;
  const auto scene = ingest::read_scene({argv[1]}, argv[2], options.ingest);
  if (!scene) return std::puts(base::to_string(scene.error()).c_str()), 3;
  const auto run = pipeline::reconstruct(*scene, options);
  if (!run) return std::puts(base::to_string(run.error()).c_str()), 5;
  std::map<std::string, rays::Scene> meshes;
  for (const auto& block : block::partition(*scene, options.block)) meshes.emplace(block.name, block.mesh);

  std::vector<model::Plan> all;
  for (const auto& building : run->city.buildings)
    for (const auto& part : building.parts) all.push_back(part.plan);
  std::vector<Row> rows;
  std::size_t missing = 0, at = 0, fits = 0, fits_worse = 0;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t b = 0; b < run->city.buildings.size(); ++b) {
    const auto& mesh = meshes.find(run->buildings[b].block);
    for (const auto& part : run->city.buildings[b].parts) {
      std::vector<model::Plan> others = all;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(at++));
      if (mesh == meshes.end()) continue;
      const auto& scan = mesh->second;
      Row row{part.id, 0, 0, {}, {}};
      row.area = geometry::area(model::polygon_of(part.plan));
      const auto raised = pipeline::raise_part(part.plan, options);
      if (!raised) continue;
      row.own = evaluate::error_over(raised->solid, model::polygon_of(part.plan), scan, options.evaluate);
      if (!std::isfinite(row.own)) continue;
      const double scan_top = highest(part.plan, scan);
      for (std::size_t k = 0; k < refine::kinds.size(); ++k) {
        const auto roof = edit::roof_of(refine::kinds[k], part.plan, others, scan, options);
        row.of[k] = roof && roof->mse ? *roof->mse : std::numeric_limits<double>::infinity();
        missing += roof ? 0 : 1;
        if (roof) row.above[k] = top_of(roof->plan, options) - scan_top;
      }
      if (const auto fit = edit::fitted_roof(part.plan, scan, options); fit && fit->mse) {
        ++fits;
        fits_worse += *fit->mse > 1.1 * row.own + 1e-4 ? 1 : 0;
      }
      rows.push_back(row);
    }
  }
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto rmse = [](double mse) { return std::sqrt(mse); };
  std::puts(
      "| kind | parts with such a roof | median RMSE, m | within 1.1 of the automatic | over 2 m above the scan |");
  std::puts("|---|---|---|---|---|");
  for (std::size_t k = 0; k < refine::kinds.size(); ++k) {
    std::vector<double> errors;
    std::size_t near = 0, high = 0;
    for (const auto& row : rows) {
      if (!std::isfinite(row.of[k])) continue;
      errors.push_back(rmse(row.of[k]));
      near += rmse(row.of[k]) <= 1.1 * rmse(row.own) ? 1 : 0;
      high += row.above[k] > 2 ? 1 : 0;
    }
    std::printf("| %s | %zu | %.2f | %zu | %zu |\n", std::string(refine::to_string(refine::kinds[k])).c_str(),
                errors.size(), errors.empty() ? 0 : base::median(errors), near, high);
  }
  std::size_t near = 0, near_15 = 0, near_2cm = 0;
  std::vector<double> ratios, own, best_of;
  std::vector<std::pair<double, std::string>> worst;
  for (const auto& row : rows) {
    const double best = rmse(*std::ranges::min_element(row.of));
    const double ratio = best / std::max(rmse(row.own), 1e-9);
    near += ratio <= 1.1 ? 1 : 0;
    near_15 += ratio <= 1.5 ? 1 : 0;
    near_2cm += ratio <= 1.1 || best - rmse(row.own) <= 0.02 ? 1 : 0;
    ratios.push_back(ratio);
    own.push_back(rmse(row.own));
    best_of.push_back(best);
    worst.emplace_back(ratio, row.part + " " + base::to_text(rmse(row.own), 3) + " → " + base::to_text(best, 3) +
                                  " m, " + base::to_text(row.area, 0) + " m²");
  }
  std::printf(
      "%zu parts, %.1f s; best of the kinds within 1.1 times the RMSE of the automatic roof: %zu (%.0f %%), or 2 cm: "
      "%zu, within 1.5 times: %zu; median RMSE %.3f m automatic, %.3f m best kind; %zu roofs of a kind missing; fitted "
      "as it is: %zu, worse %zu\n",
      rows.size(), took, near,
      100.0 * static_cast<double>(near) / static_cast<double>(std::max<std::size_t>(1, rows.size())), near_2cm, near_15,
      base::median(own), base::median(best_of), missing, fits, fits_worse);
  std::ranges::sort(worst, std::greater<>());
  for (std::size_t i = 0; i < std::min<std::size_t>(15, worst.size()); ++i)
    std::printf("  %.2f %s\n", worst[i].first, worst[i].second.c_str());
  return 0;
}
