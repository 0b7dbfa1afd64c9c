// A city whose mesh is in cells on disk comes out as one whose mesh is in memory, to the byte.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/city.hpp"
#include "mansard/pipeline/detail/city_tasks.hpp"
#include "mansard/pipeline/scan_pieces.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

/// Houses in rows, some wall to wall, on a field of large triangles, with faults: triangles that are there twice, that
/// have no area, and corners that are nowhere.
auto town_obj() -> std::string {
  geometry::Mesh mesh;
  test::add_quad(mesh, {-300, -300, 0}, {700, -300, 0}, {700, 700, 0}, {-300, 700, 0});
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k < 4; ++k) {
      const double x = 60.0 * i + 0.25 * k, y = 45.0 * k;
      test::add_house(mesh, x, y, x + 12, y + 8, 5 + 0.5 * i, 8 + 0.5 * i);
      if ((i + k) % 2 == 0) test::add_house(mesh, x + 12, y, x + 23, y + 8, 6, 6);
    }
  std::string obj;
  for (const auto& v : mesh.vertices)
    obj += "v " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  obj += "v 3 3 nan\nv 1e300 0 0\n";
  const auto face = [&obj](std::size_t a, std::size_t b, std::size_t c) {
    obj += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  };
  for (const auto& t : mesh.triangles) face(t[0] + 1, t[1] + 1, t[2] + 1);
  for (std::size_t t = 10; t < 20; ++t)  // again, some the other way round
    face(mesh.triangles[t][0] + 1, mesh.triangles[t][t % 2 == 0 ? 1 : 2] + 1,
         mesh.triangles[t][t % 2 == 0 ? 2 : 1] + 1);
  face(5, 6, 5);
  face(7, mesh.vertices.size() + 1, 8);
  face(7, mesh.vertices.size() + 2, 8);
  face(7, mesh.vertices.size() + 900, 8);
  return obj;
}

auto town_geojson() -> std::string {
  std::string features;
  const auto add = [&](const std::string& id, double x0, double y0, double x1, double y1) {
    const auto corner = [](double x, double y) { return "[" + std::to_string(x) + "," + std::to_string(y) + "]"; };
    features += std::string(features.empty() ? "" : ",") + R"({"type":"Feature","properties":{"id":")" + id +
                R"(","use":"home"},"geometry":{"type":"Polygon","coordinates":[[)" + corner(x0, y0) + "," +
                corner(x1, y0) + "," + corner(x1, y1) + "," + corner(x0, y1) + "," + corner(x0, y0) + "]]}}";
  };
  for (int k = 3; k >= 0; --k)  // not in the order of their places
    for (int i = 0; i < 5; ++i) {
      const double x = 60.0 * i + 0.25 * k, y = 45.0 * k;
      const std::string name = std::to_string(i) + std::to_string(k);
      add("house" + name, x, y, x + 12, y + 8);
      if ((i + k) % 2 == 0) add("annex" + name, x + 12, y, x + 23, y + 8);
    }
  features += R"(,{"type":"Feature","properties":{"id":"point"},"geometry":{"type":"Point","coordinates":[1,2]}})";
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)" +
         features + "]}";
}

struct Files {
  test::Scratch folder;
  std::filesystem::path mesh = folder / "town.obj", footprints = folder / "town.geojson";
  Files() {
    EXPECT_TRUE(base::write_file(mesh, town_obj()));
    EXPECT_TRUE(base::write_file(footprints, town_geojson()));
  }
  [[nodiscard]] auto read(Options options, double from) const -> ingest::CityScene {
    options.ingest.cells_from = from;
    auto city = ingest::read_city({mesh}, footprints, options.ingest);
    EXPECT_TRUE(city) << (city ? "" : base::to_string(city.error()));
    return city ? std::move(*city) : ingest::CityScene{};
  }
};

constexpr double never = 1e9;  // MB

/// Everything of a run that is put aside but its times.
auto told(const PutAside& city) -> std::string {
  std::string out;
  model::City whole;
  whole.frame = city.frame;
  for (const auto& block : city.summary.blocks)
    out += block.name + " " + std::to_string(block.triangles) + " " + std::to_string(block.objective) + " " +
           std::to_string(block.scores.mse) + "\n";
  for (const auto& warning : city.summary.warnings) out += base::to_string(warning) + "\n";
  const auto done = city.each([&](model::Building building, const report::BuildingReport& report) {
    out += report.id + " " + report.block + " " + std::string(report::to_string(report.outcome)) + " " +
           std::to_string(report.volume) + "\n";
    for (const auto& reason : report.reasons) out += base::to_string(reason) + "\n";
    whole.buildings.push_back(std::move(building));
    return base::Result<void>();
  });
  EXPECT_TRUE(done);
  return out + *formats::cityjson(whole) + formats::plans(whole);
}

TEST(City, in_cells_is_that_in_memory) {
  const Files files;
  for (const double side : {17.0, 64.0, 1000.0}) {
    Options options;
    options.ingest.cell_side = side;
    options.ingest.task_triangles = side == 64.0 ? 2e6 : 120;
    const auto in_memory = files.read(options, never), in_cells = files.read(options, 0);
    ASSERT_FALSE(in_memory.cells);
    ASSERT_TRUE(in_cells.cells);
    EXPECT_TRUE(in_cells.scene.mesh.triangles.empty());
    const auto& a = in_memory.scene.mesh_counts;
    const auto& b = in_cells.scene.mesh_counts;
    EXPECT_EQ(a.vertices, b.vertices) << side;
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.not_finite, b.not_finite);
    EXPECT_EQ(a.out_of_range, b.out_of_range);
    EXPECT_EQ(a.degenerate, b.degenerate);
    EXPECT_EQ(a.duplicate, b.duplicate);
    EXPECT_EQ(a.non_manifold_edges, b.non_manifold_edges);
    EXPECT_EQ(a.boundary_edges, b.boundary_edges);
    EXPECT_EQ(a.flipped_edges, b.flipped_edges);
    EXPECT_EQ(a.vertices_read, b.vertices_read);
    EXPECT_EQ(a.triangles_read, b.triangles_read);
    EXPECT_GT(a.duplicate, 0U);
    EXPECT_GT(a.not_finite, 0U);
    EXPECT_GT(a.out_of_range, 0U);
    EXPECT_EQ(in_memory.scene.frame.origin, in_cells.scene.frame.origin);
    EXPECT_EQ(in_memory.scene.warnings, in_cells.scene.warnings);
    const auto one = reconstruct_aside(in_memory, options), other = reconstruct_aside(in_cells, options);
    ASSERT_TRUE(one);
    ASSERT_TRUE(other);
    EXPECT_EQ(one->outcomes.full, 30U);
    EXPECT_EQ(told(*one), told(*other)) << side;
  }
}

TEST(City, put_aside_is_that_of_reconstruct) {
  const Files files;
  const auto city = files.read({}, never);
  const auto aside = reconstruct_aside(city, {});
  const auto whole = reconstruct(city.scene, {});
  ASSERT_TRUE(aside);
  ASSERT_TRUE(whole);
  model::City again;
  again.frame = aside->frame;
  std::vector<report::BuildingReport> reports;
  ASSERT_TRUE(aside->each([&](model::Building building, report::BuildingReport report) {
    again.buildings.push_back(std::move(building));
    reports.push_back(std::move(report));
    return base::Result<void>();
  }));
  again.made_by = aside->made_by;
  EXPECT_EQ(*formats::cityjson(again), *formats::cityjson(whole->city));
  ASSERT_EQ(reports.size(), whole->buildings.size());
  for (std::size_t i = 0; i < reports.size(); ++i) EXPECT_EQ(reports[i].reasons, whole->buildings[i].reasons);
  EXPECT_EQ(aside->summary.warnings, whole->warnings);
  EXPECT_EQ(aside->summary.scores.mse, whole->scores.mse);
}

auto how_many_differ(const picture::Image& a, const picture::Image& b) -> std::size_t {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) different += std::abs(a.pixels[i] - b.pixels[i]) > 3 ? 1 : 0;
  return different;
}

TEST(City, cells_have_every_triangle_once) {
  const Files files;
  Options options;
  options.ingest.cell_side = 17;  // the largest triangles lie in thousands of them
  const auto in_memory = files.read(options, never), in_cells = files.read(options, 0);
  const auto corners_of = [](const geometry::Mesh& mesh, std::multiset<std::array<double, 9>>& out) {
    for (const auto& t : mesh.triangles) {
      std::array<double, 9> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = mesh.vertices[t[k]];
        corners[3 * k] = v.x, corners[3 * k + 1] = v.y, corners[3 * k + 2] = v.z;
      }
      out.insert(corners);
    }
  };
  std::multiset<std::array<double, 9>> all, own;
  corners_of(in_memory.scene.mesh, all);
  for (const auto& cell : in_cells.cells->cells_in(geometry::Box3::of(in_memory.scene.mesh.vertices).plan())) {
    const auto mesh = in_cells.cells->load_own(cell);
    ASSERT_TRUE(mesh);
    corners_of(*mesh, own);
  }
  const auto each_once = [](const auto& triangles) { return std::set(triangles.begin(), triangles.end()); };
  EXPECT_EQ(each_once(own), each_once(all));
  EXPECT_LT(own.size(), 1.02 * static_cast<double>(all.size()))
      << "only those with the middle on a border are in two cells";
}

TEST(City, pictures_in_cells_are_those_in_memory) {
  const Files files;
  const Options options;
  const auto in_memory = files.read(options, never), in_cells = files.read(options, 0);
  const auto whole = reconstruct(in_memory.scene, options);
  ASSERT_TRUE(whole);
  const auto expected = report::pictures(*whole, in_memory.scene, 1);
  ASSERT_TRUE(expected);
  const auto aside = reconstruct_aside(in_cells, options, {}, {}, Aside::models_and_error_maps);
  ASSERT_TRUE(aside);
  const auto frame = report::frame_of(in_cells.scene);
  const auto cells = in_cells.cells->cells_in(frame);
  ASSERT_GT(cells.size(), 10U);
  const report::ScanPieces by_cell{cells.size(),
                                   [&](std::size_t i) -> base::Result<std::shared_ptr<const geometry::Mesh>> {
                                     auto mesh = in_cells.cells->load_own(cells[i]);
                                     if (!mesh) return mesh.failure();
                                     return std::make_shared<const geometry::Mesh>(std::move(*mesh));
                                   }};
  const auto each_building = [&](const auto& visit) {
    return aside->each([&](const model::Building& building, const auto&) { return visit(building); });
  };
  const auto each_error_map = [&](const auto& visit) { return aside->each_error_map(visit); };
  for (const auto& scan : {scan_pieces(in_cells, frame), by_cell}) {
    const auto pictures = report::pictures({in_cells.scene, scan, each_building, each_error_map}, 1);
    ASSERT_TRUE(pictures);
    EXPECT_LT(how_many_differ(pictures->above, expected->above), expected->above.pixels.size() / 1000);
    EXPECT_LT(how_many_differ(pictures->angle, expected->angle), expected->angle.pixels.size() / 1000);
    EXPECT_EQ(pictures->error.pixels, expected->error.pixels);
  }
}

TEST(City, without_error_maps_has_none) {
  const Files files;
  const auto aside = reconstruct_aside(files.read({}, 0), {});
  ASSERT_TRUE(aside);
  ASSERT_TRUE(aside->each_error_map([](const auto&) { ADD_FAILURE(); }));
}

TEST(City, in_a_box_is_that_in_memory) {
  const Files files;
  Options options;
  options.ingest.bbox = {50, 30, 140, 110};
  const auto in_memory = files.read(options, never), in_cells = files.read(options, 0);
  EXPECT_EQ(in_memory.scene.mesh_counts.triangles, in_cells.scene.mesh_counts.triangles);
  const auto one = reconstruct_aside(in_memory, options), other = reconstruct_aside(in_cells, options);
  ASSERT_TRUE(one);
  ASSERT_TRUE(other);
  EXPECT_EQ(told(*one), told(*other));
}

TEST(City, without_a_mesh_is_that_in_memory) {
  const Files files;
  Options options;
  options.ingest.bbox = {-10, -10, 200, 150};  // some are around it
  const auto scene = ingest::read_footprints(files.footprints, options.ingest);
  ASSERT_TRUE(scene);
  const auto whole = raise_footprints(*scene, options);
  ASSERT_TRUE(whole);
  for (const double together : {1.0, 3.0, 10'000.0}) {
    options.ingest.task_footprints = together;
    const auto aside = raise_footprints_aside(*scene, options);
    ASSERT_TRUE(aside);
    model::City again;
    again.frame = aside->frame;
    again.made_by = whole->city.made_by;
    std::size_t i = 0;
    ASSERT_TRUE(aside->each([&](model::Building building, const report::BuildingReport& report) {
      EXPECT_EQ(report.id, whole->buildings[i].id);
      EXPECT_EQ(report.reasons, whole->buildings[i].reasons);
      EXPECT_EQ(report.outcome, whole->buildings[i].outcome);
      EXPECT_EQ(report.volume, whole->buildings[i++].volume);
      again.buildings.push_back(std::move(building));
      return base::Result<void>();
    }));
    EXPECT_EQ(i, whole->buildings.size());
    EXPECT_EQ(*formats::cityjson(again), *formats::cityjson(whole->city)) << together;
    EXPECT_EQ(aside->summary.warnings, whole->warnings);
  }
}

/// Squares of 5 m in a row, so far apart that each is a block.
auto row_of_squares(int count, double apart) -> model::Scene {
  model::Scene scene;
  for (int i = 0; i < count; ++i) {
    const double x = apart * i;
    model::Footprint footprint;
    footprint.id = "square-" + std::to_string(i);
    footprint.polygons.push_back({{{x, 0}, {x + 5, 0}, {x + 5, 5}, {x, 5}}, {}});
    scene.footprints.push_back(std::move(footprint));
  }
  return scene;
}

TEST(City, is_extruded_in_tasks_of_so_many_footprints) {
  auto scene = row_of_squares(20, 5.05);  // two rows of ten that touch, 200 m apart, and 7 that stand alone
  for (std::size_t i = 10; i < 20; ++i)
    for (auto& corner : scene.footprints[i].polygons.front().outer) corner.x += 200;
  for (auto alone = row_of_squares(7, 300).footprints; auto& footprint : alone) {
    for (auto& corner : footprint.polygons.front().outer) corner.y += 1000;
    scene.footprints.push_back(std::move(footprint));
  }
  const auto groups = block::groups(scene, {});
  ASSERT_EQ(groups.size(), 9U);
  const auto places = detail::by_place(groups, scene.frame);
  for (const std::size_t most : {1U, 4U, 12U, 1000U}) {
    std::vector<const block::Group*> again;
    std::set<std::string> names;
    std::size_t tasks = 0;
    for (const auto& task : detail::in_tasks(places, most, scene.frame)) {
      ASSERT_FALSE(task.groups.empty());
      std::size_t features = 0;
      for (const auto* group : task.groups) features += group->features.size();
      EXPECT_TRUE(features <= most || task.groups.size() == 1) << features << " where " << most << " are the most";
      again.insert(again.end(), task.groups.begin(), task.groups.end());
      names.insert(task.name);
      ++tasks;
    }
    EXPECT_EQ(again, places) << most;
    EXPECT_EQ(names.size(), tasks) << "each has a name of its own";
  }
  EXPECT_EQ(detail::in_tasks(places, 1000, scene.frame).size(), 1U);
  EXPECT_TRUE(detail::in_tasks({}, 4, scene.frame).empty());
}

TEST(City, has_the_same_tasks_but_one_where_a_footprint_is_added) {
  model::Scene scene;
  scene.frame.origin = {84'000, 447'000, 0};
  const auto add = [&](double x, double y) {
    scene.footprints.push_back(
        test::footprint("f" + std::to_string(scene.footprints.size()), test::rectangle(x, y, x + 5, y + 5)));
  };
  for (int i = 0; i < 300; ++i) add(-300 + 31.7 * (i % 17), -250 + 23.3 * (i / 17));
  const auto tasks = [&] {
    const auto groups = block::groups(scene, {});
    const auto places = detail::by_place(groups, scene.frame);
    std::set<std::set<std::string>> out;
    for (const auto& task : detail::in_tasks(places, 20, scene.frame)) {
      std::set<std::string> ids;
      for (const auto* group : task.groups)
        for (const auto f : group->features) ids.insert(scene.feature(f).id);
      out.insert(ids);
    }
    return out;
  };
  const auto shared = [](const auto& a, const auto& b) {
    return static_cast<std::size_t>(std::ranges::count_if(a, [&](const auto& task) { return b.contains(task); }));
  };
  const auto before = tasks();
  ASSERT_GT(before.size(), 15U);
  add(-285, -237);
  const auto after = tasks();
  EXPECT_EQ(shared(before, after), before.size() - 1);
  // One frame for another: the file's coordinates are the same, and so are the tasks.
  scene.frame.origin = {84'123, 446'950, 0};
  for (auto& footprint : scene.footprints)
    for (auto& p : footprint.polygons.front().outer) p = p - geometry::Point2{123, -50};
  EXPECT_EQ(tasks(), after);
}

TEST(City, loads_for_a_task_only_what_is_near_its_groups) {
  const auto scene = row_of_squares(100, 200);
  const auto groups = block::groups(scene, {});
  ASSERT_EQ(groups.size(), 100U);
  // Far from each other, as where the order by place jumps: what is between them is near none.
  const std::vector<const block::Group*> both{&groups.front(), &groups.back()};
  const auto part = detail::part_of(scene, both, detail::index_of(scene), true);
  EXPECT_EQ(part.features, (std::vector<std::size_t>{0, 99}));
  EXPECT_TRUE(part.scene.surroundings.empty());
  const auto close = row_of_squares(100, 20);
  const auto beside = block::groups(close, {});
  const std::vector<const block::Group*> ends{&beside.front(), &beside.back()};
  const auto with_others = detail::part_of(close, ends, detail::index_of(close), true);
  EXPECT_EQ(with_others.features, (std::vector<std::size_t>{0, 99, 1, 2, 97, 98}));
  EXPECT_EQ(with_others.scene.surroundings.size(), 4U);
}

/// Files of this process stay below so many bytes, as on a full disk.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() { setrlimit(RLIMIT_FSIZE, &before_); }
  SmallFiles(const SmallFiles&) = delete;
  auto operator=(const SmallFiles&) -> SmallFiles& = delete;

 private:
  rlimit before_{};
};

TEST(City, that_cannot_be_put_aside_ends_at_once) {
  const auto scene = row_of_squares(300, 200);
  Options options;
  options.ingest.task_footprints = 1;
  std::size_t tasks = 0;
  base::Run run;
  std::vector<double> done;
  run.progress = [&](std::string_view stage, std::string_view, double fraction) {
    tasks += stage == "roof" ? 1 : 0;
    if (stage == "done") done.push_back(fraction);
  };
  {
    const SmallFiles full(40'000);
    const auto aside = raise_footprints_aside(scene, options, run);
    ASSERT_FALSE(aside);
    EXPECT_EQ(aside.error().code, "file-write");
    EXPECT_NE(aside.error().message.find("TMPDIR"), std::string::npos) << aside.error().message;
  }
  EXPECT_GT(tasks, 1U);
  EXPECT_LT(tasks, 100U);
  tasks = 0;
  done.clear();
  EXPECT_TRUE(raise_footprints_aside(scene, options, run));
  EXPECT_GE(tasks, 300U);
  EXPECT_EQ(done.size(), 299U) << "after every task but the last, so that a log shows how far a run is";
  EXPECT_TRUE(std::ranges::is_sorted(done));
}

TEST(City, tells_of_solids_that_overlap_as_in_memory) {
  model::Scene scene;
  for (int i = 0; i < 40; ++i) {
    const double x = 3.7 * (i % 7), y = 4.1 * (i / 7);
    model::Footprint footprint;
    footprint.id = "a name that is not short " + std::to_string(i);
    footprint.polygons.push_back({{{x, y}, {x + 5, y}, {x + 5, y + 5}, {x, y + 5}}, {}});
    if (i % 5 == 0) footprint.polygons.push_back({{{x + 90, y}, {x + 95, y}, {x + 95, y + 5}, {x + 90, y + 5}}, {}});
    scene.footprints.push_back(std::move(footprint));
  }
  const auto whole = raise_footprints(scene, {});
  const auto aside = raise_footprints_aside(scene, {});
  ASSERT_TRUE(whole);
  ASSERT_TRUE(aside);
  std::size_t i = 0, told = 0;
  ASSERT_TRUE(aside->each([&](const model::Building&, const report::BuildingReport& report) {
    EXPECT_EQ(report.reasons, whole->buildings[i++].reasons);
    for (const auto& reason : report.reasons) told += reason.code == "pipeline-overlap" ? 1 : 0;
    return base::Result<void>();
  }));
  EXPECT_EQ(i, 40U);
  EXPECT_GT(told, 100U);
  EXPECT_EQ(aside->summary.warnings, whole->warnings);
}

TEST(City, shares_of_cells_add_up) {
  const Files files;
  const auto in_cells = files.read({}, 0);
  const test::Scratch folder;
  for (std::size_t share = 0; share < 3; ++share) {
    auto kept = KeptBlocks::open(folder, false);
    ASSERT_TRUE(kept);
    ASSERT_TRUE(make_share(in_cells, {}, {}, Keep::models, {kept->get(), nullptr}, share, 3));
  }
  auto kept = KeptBlocks::open(folder);
  ASSERT_TRUE(kept);
  Tally tally;
  const auto merged = reconstruct_aside(in_cells, {}, {}, {kept->get(), &tally});
  ASSERT_TRUE(merged);
  EXPECT_EQ(tally.blocks_kept, 20U);
  EXPECT_EQ(told(*merged), told(*reconstruct_aside(in_cells, {})));
}

}  // namespace
}  // namespace mansard::pipeline
