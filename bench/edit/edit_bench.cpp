// How long an edit takes: every building of a scan raised and measured among its neighbours, as the workbench does
// while a corner is dragged; and the tiles of its mesh.
//   bench_edit MESH FOOTPRINTS [MODULE.OPTION=VALUE…]
//   bench_edit TRIANGLES        tiles of so many triangles of hills
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "bench/edit/options.hpp"
#include "mansard/base/text.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/picture/tiles.hpp"

namespace {

using namespace mansard;

template <class Work>
auto milliseconds(const Work& work) -> double {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void print_times(const char* what, std::vector<double> times) {
  if (times.empty()) return;
  std::ranges::sort(times);
  std::printf("%-34s n %4zu  median %8.2f ms  95 %% %8.2f ms  worst %8.2f ms\n", what, times.size(),
              times[times.size() / 2], times[times.size() * 95 / 100], times.back());
}

/// The best of a few.
template <class Work>
auto best(const Work& work) -> double {
  double least = milliseconds(work);
  for (int i = 0; i < 4; ++i) least = std::min(least, milliseconds(work));
  return least;
}

/// Across the middle of the longest edge, from well outside to well outside.
auto across(const model::Plan& plan) -> std::vector<geometry::Point2> {
  const auto& ring = plan.outer.points;
  geometry::Segment2 longest{ring[0], ring[1]};
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const geometry::Segment2 edge{ring[i], ring[(i + 1) % ring.size()]};
    if (length(edge.end - edge.start) > length(longest.end - longest.start)) longest = edge;
  }
  const auto middle = 0.5 * (longest.start + longest.end);
  const auto inward = geometry::left_of(geometry::normalised(longest.end - longest.start));
  return {middle - inward, middle + 500.0 * inward};
}

auto area_of(const std::vector<geometry::Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

/// n by n squares of 25 cm.
auto hills(std::uint32_t n) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      mesh.vertices.push_back({0.25 * i, 0.25 * j, 5 * std::sin(0.03 * i) * std::cos(0.02 * j)});
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const auto at = j * (n + 1) + i;
      mesh.triangles.push_back({at, at + 1, at + n + 2});
      mesh.triangles.push_back({at, at + n + 2, at + n + 1});
    }
  return mesh;
}

void cut_tiles(const geometry::Mesh& mesh) {
  std::vector<picture::Tile> tiles;
  const auto processor = std::clock();
  const double took = milliseconds([&] { tiles = picture::tiles(mesh); });
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> levels;
  for (const auto& tile : tiles) {
    ++levels[tile.level].first;
    levels[tile.level].second += tile.triangles.size() / 3;
  }
  std::printf("tiles of %zu triangles: %.0f ms, %.0f ms of processors:", mesh.triangles.size(), took,
              1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
  for (const auto& [level, counts] : levels)
    std::printf(" level %zu %zu tiles %zu triangles;", level, counts.first, counts.second);
  std::puts("");
}

}  // namespace

auto main(int argc, char** argv) -> int {
  if (argc == 2 && base::to_integer(argv[1])) {
    cut_tiles(hills(static_cast<std::uint32_t>(std::sqrt(static_cast<double>(*base::to_integer(argv[1])) / 2))));
    return 0;
  }
  if (argc < 3) return std::puts("bench_edit MESH FOOTPRINTS [MODULE.OPTION=VALUE…]"), 2;
  const auto given = bench::options_of(argc, argv);
  if (!given) return std::puts(base::to_string(given.error()).c_str()), 2;
  const pipeline::Options& options = *given;
  const auto scene = ingest::read_scene({argv[1]}, argv[2], options.ingest);
  if (!scene) return std::puts(base::to_string(scene.error()).c_str()), 3;
  std::printf("%zu triangles, %zu footprints\n", scene->mesh.triangles.size(), scene->footprints.size());

  cut_tiles(scene->mesh);
  const auto run = pipeline::reconstruct(*scene, options);
  if (!run) return std::puts(base::to_string(run.error()).c_str()), 5;
  std::map<std::string, rays::Scene> meshes;
  for (const auto& block : block::partition(*scene, options.block)) meshes.emplace(block.name, block.mesh);
  const edit::History history(run->city);
  const auto mesh_of = [&](std::string_view id) -> const rays::Scene* {
    const auto report_of = std::ranges::find(run->buildings, id, &report::BuildingReport::id);
    const auto found = meshes.find(report_of->block);
    return found != meshes.end() ? &found->second : nullptr;
  };

  std::vector<double> all, small, one_thread, without_mesh;
  std::size_t invalid = 0, less = 0, corners_most = 0;
  for (const auto& building : run->city.buildings) {
    const auto& parts = *history.parts(building.id);
    if (parts.empty()) continue;
    std::vector<model::Plan> neighbours;
    for (const auto& other : run->city.buildings)
      if (other.id != building.id)
        for (const auto& part : other.parts) neighbours.push_back(part.plan);
    const edit::Site site{.neighbours = neighbours, .before = {}, .mesh = mesh_of(building.id)};
    const auto raised = edit::raise(parts, site, options);
    invalid += raised.valid() ? 0 : 1;
    for (const auto& diagnostic : raised.diagnostics) std::puts(base::to_string(diagnostic).c_str());
    std::size_t corners = 0;
    for (const auto& part : parts) corners += part.plan.outer.points.size();
    for (const auto& part : raised.parts) less += part.outcome == extrude::Outcome::full ? 0 : 1;
    corners_most = std::max(corners_most, corners);
    const double took = best([&] { (void)edit::raise(parts, site, options); });
    all.push_back(took);
    if (corners <= 10) small.push_back(took);
    without_mesh.push_back(
        best([&] { (void)edit::raise(parts, {.neighbours = neighbours, .before = {}, .mesh = nullptr}, options); }));
    base::limit_threads(1);
    one_thread.push_back(best([&] { (void)edit::raise(parts, site, options); }));
    base::limit_threads(0);
  }
  print_times("raise + measure, a building", all);
  print_times("… of at most 10 corners", small);
  print_times("… one thread", one_thread);
  print_times("… without measuring", without_mesh);
  std::printf("%zu of %zu buildings invalid as they are, %zu parts less than full; most corners %zu\n", invalid,
              all.size(), less, corners_most);

  // Every part cut across its longest edge, and put together again.
  std::size_t parts_all = 0, parts_split = 0, split_valid = 0, merged = 0, raised_less = 0;
  edit::History cut(run->city);
  for (const auto& building : run->city.buildings) {
    std::vector<model::Plan> neighbours;
    for (const auto& other : run->city.buildings)
      if (other.id != building.id)
        for (const auto& part : other.parts) neighbours.push_back(part.plan);
    const auto& before = *history.parts(building.id);
    for (const auto& part : before) {
      ++parts_all;
      const auto line = across(part.plan);
      const auto after = edit::split(building.id, before, part.id, line);
      if (!after) {
        std::puts(base::to_string(after.error()).c_str());
        continue;
      }
      ++parts_split;
      const auto raised = edit::raise(*after, {.neighbours = neighbours, .before = before, .mesh = nullptr}, options);
      split_valid += raised.valid() ? 1 : 0;
      for (const auto& diagnostic : raised.diagnostics) std::puts(base::to_string(diagnostic).c_str());
      for (const auto& piece : raised.parts) raised_less += piece.outcome == extrude::Outcome::full ? 0 : 1;
      auto pieces = *edit::split(part.plan, line);
      for (bool any = true; any && pieces.size() > 1;) {
        any = false;
        for (std::size_t i = 1; i < pieces.size() && !any; ++i)
          if (auto one = edit::merge(pieces[0], pieces[i])) {
            pieces[0] = std::move(*one);
            pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
            any = true;
          }
      }
      const auto again = model::polygon_of(pieces.front()), was = model::polygon_of(part.plan);
      const auto lost = geometry::subtract(was, again), won = geometry::subtract(again, was);
      merged += lost && won && area_of(*lost) + area_of(*won) < 1e-9 ? 1 : 0;
      if (&part == &before.front())
        if (auto done = cut.apply({"cut", {{building.id, 0, *after}}}); !done)
          std::puts(base::to_string(done.error()).c_str());
    }
  }
  std::printf("%zu parts: %zu split, %zu of them valid (%zu pieces less than full), %zu merged to what they were\n",
              parts_all, parts_split, split_valid, raised_less, merged);

  // Every two parts whose boxes touch, as one.
  std::vector<const model::Part*> parts_of_all;
  for (const auto& building : run->city.buildings)
    for (const auto& part : building.parts) parts_of_all.push_back(&part);
  std::size_t joined = 0, joined_valid = 0;
  std::map<std::string, std::size_t> refused;
  for (std::size_t i = 0; i < parts_of_all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto &a = parts_of_all[i]->plan, &b = parts_of_all[j]->plan;
      if (!geometry::bounds(a.outer.points).grown(0.02).overlaps(geometry::bounds(b.outer.points))) continue;
      const auto one = edit::merge(a, b);
      if (!one) {
        ++refused[one.error().message.substr(0, 24)];
        continue;
      }
      ++joined;
      joined_valid += edit::raise(std::vector<edit::NamedPlan>{{"one", *one}}, {}, options).valid() ? 1 : 0;
    }
  std::printf("%zu pairs merged, %zu of them valid; refused:", joined, joined_valid);
  for (const auto& [words, count] : refused) std::printf(" %zu \"%s…\"", count, words.c_str());
  std::puts("");

  base::Result<model::City> city = base::error("", "");
  const double exporting = milliseconds([&] { city = edit::edited_city(run->city, history, mesh_of, options); });
  if (!city) return std::puts(base::to_string(city.error()).c_str()), 1;
  const bool same = *formats::cityjson(*city) == *formats::cityjson(run->city) &&
                    formats::plans(*city) == formats::plans(run->city) &&
                    *formats::glb(*city) == *formats::glb(run->city);
  std::printf("edited_city %.0f ms; without edits it is the run's to the byte: %s\n", exporting, same ? "yes" : "NO");

  auto edited = edit::edited_city(run->city, cut, mesh_of, options);
  if (!edited) return std::puts(base::to_string(edited.error()).c_str()), 1;
  const auto again = pipeline::raise_plans(*edited, options);
  const bool kept = again && *formats::cityjson(again->city) == *formats::cityjson(*edited);
  std::printf("%zu buildings edited; raised again from their plans to the byte: %s\n", cut.done(), kept ? "yes" : "NO");
  return same && kept ? 0 : 1;
}
