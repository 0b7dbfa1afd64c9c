// Blocks that are kept: a run goes on from them, and comes out as if it had made them itself.
#include <gtest/gtest.h>
#include <fstream>
#include <map>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/unfinished.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/city.hpp"
#include "mansard/report/layers.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

namespace fs = std::filesystem;

/// Four blocks: two wings, a terrace of two houses, a house apart, and one of which the ground is not known.
auto city() -> model::Scene {
  auto scene = test::with_a_bad_block(test::town());
  test::add_house(scene.mesh, 0, 24, 12, 32, 5, 8);
  scene.footprints.push_back(test::footprint("apart", test::rectangle(0, 24, 12, 32)));
  return scene;
}

auto opened(const fs::path& folder) -> std::unique_ptr<KeptBlocks> {
  auto kept = KeptBlocks::open(folder);
  EXPECT_TRUE(kept);
  return kept ? std::move(*kept) : nullptr;
}

struct Made {
  std::string bytes;  ///< everything that must not differ
  report::Reuse reuse;
  std::size_t blocks_kept = 0;
};

/// run.json without its times.
auto untimed(std::string text) -> std::string {
  for (const auto* name : {"\"times\": {", "\"times\":{"})
    for (std::size_t at; (at = text.find(name)) != std::string::npos;) {
      std::size_t end = text.find('{', at), depth = 0;
      do {
        if (text[end] == '{') ++depth;
        if (text[end] == '}') --depth;
        ++end;
      } while (depth > 0);
      text.erase(at, end - at);
    }
  return text;
}

auto made(const model::Scene& scene, KeptBlocks* kept, const Options& options = {}, Keep keep = Keep::models) -> Made {
  Tally tally;
  auto r = reconstruct(scene, options, {}, keep, {}, {kept, &tally});
  EXPECT_TRUE(r) << (r ? "" : base::to_string(r.error()));
  if (!r) return {};
  std::string bytes = *formats::cityjson(r->city) + formats::plans(r->city) + untimed(report::run_json(*r, scene));
  for (const auto& map : r->error_maps)
    bytes.append(reinterpret_cast<const char*>(map.difference.data()), map.difference.size() * sizeof(float));
  for (const auto& block : r->segmented) {
    bytes += block.name + std::to_string(block.arrangement.half_edges.size());
    if (block.segmentation) bytes += std::to_string(block.segmentation->objective);
  }
  return {bytes, r->reuse, tally.blocks_kept};
}

auto kept_files(const fs::path& folder) -> std::vector<fs::path> {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != "last") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

using Why = std::vector<std::pair<std::string, std::string>>;

TEST(Kept, takes_blocks_over_and_gives_the_same_bytes) {
  const test::Scratch folder;
  const auto scene = city();
  const auto plain = made(scene, nullptr);
  const auto first = made(scene, opened(folder).get());
  EXPECT_EQ(first.bytes, plain.bytes);
  EXPECT_EQ(first.blocks_kept, 0U);
  EXPECT_TRUE(first.reuse.made.empty()) << "there was no earlier run";
  EXPECT_EQ(kept_files(folder).size(), 3U);
  const auto second = made(scene, opened(folder).get());
  EXPECT_EQ(second.bytes, plain.bytes);
  EXPECT_EQ(second.blocks_kept, 3U);
  EXPECT_EQ(second.reuse.blocks, 3U);
}

TEST(Kept, keeps_segmentations_too) {
  const test::Scratch folder;
  const auto scene = city();
  const auto plain = made(scene, nullptr, {}, Keep::segmentations);
  (void)made(scene, opened(folder).get());
  const auto first = made(scene, opened(folder).get(), {}, Keep::segmentations);
  EXPECT_EQ(first.blocks_kept, 0U) << "blocks without their segmentations do not do";
  const auto second = made(scene, opened(folder).get(), {}, Keep::segmentations);
  EXPECT_EQ(second.blocks_kept, 3U);
  EXPECT_EQ(first.bytes, plain.bytes);
  EXPECT_EQ(second.bytes, plain.bytes);
}

TEST(Kept, makes_again_only_what_changed_and_says_why) {
  const test::Scratch folder;
  auto scene = city();
  (void)made(scene, opened(folder).get());

  // The house apart is a metre longer, and only it.
  scene.footprints.back().polygons = {test::rectangle(0, 24, 13, 32)};
  auto again = made(scene, opened(folder).get());
  EXPECT_EQ(again.reuse.made, (Why{{"block-apart", "footprints"}}));
  EXPECT_EQ(again.blocks_kept, 2U);
  EXPECT_EQ(again.bytes, made(scene, nullptr).bytes);

  // A corner of the wings' roof moves: the mesh of the neighbours within reach of it is another one too.
  for (auto& v : scene.mesh.vertices)
    if (v.x == 42 && v.y == 0 && v.z == 6) v.z = 6.5;
  again = made(scene, opened(folder).get());
  EXPECT_EQ(again.reuse.made, (Why{{"block-wings", "mesh"}}));
  EXPECT_EQ(again.bytes, made(scene, nullptr).bytes);

  scene.footprints.push_back(test::footprint("more", test::rectangle(44, 30, 49, 38)));
  again = made(scene, opened(folder).get());
  EXPECT_EQ(again.reuse.made, (Why{{"block-more", "new"}}));

  Options other;
  other.refine.detail = 0.2;
  again = made(scene, opened(folder).get(), other);
  EXPECT_EQ(again.reuse.made.size(), 4U);
  for (const auto& [block, why] : again.reuse.made) EXPECT_EQ(why, "options") << block;
  EXPECT_EQ(again.bytes, made(scene, nullptr, other).bytes);
  EXPECT_EQ(kept_files(folder).size(), 4U) << "what no block of the last run is made of is taken away";

  other.write.compress = true;
  EXPECT_EQ(made(scene, opened(folder).get(), other).blocks_kept, 4U) << "how files are written is no reason";
}

TEST(Kept, makes_again_what_is_damaged) {
  const test::Scratch folder;
  const auto scene = city();
  const auto plain = made(scene, opened(folder).get());
  const auto files = kept_files(folder);
  ASSERT_EQ(files.size(), 3U);
  fs::resize_file(files[0], fs::file_size(files[0]) / 2);
  fs::resize_file(files[1], 0);
  auto bytes = *base::read_file(files[2]);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  ASSERT_TRUE(base::write_file(files[2], bytes));
  const auto again = made(scene, opened(folder).get());
  EXPECT_EQ(again.blocks_kept, 0U);
  EXPECT_EQ(again.bytes, plain.bytes);
  for (const auto& [block, why] : again.reuse.made) EXPECT_EQ(why, "damaged") << block;
  EXPECT_EQ(made(scene, opened(folder).get()).blocks_kept, 3U);
}

TEST(Kept, sweeps_half_written_files_where_it_works_alone) {
  const test::Scratch folder;
  (void)made(city(), opened(folder).get());
  const auto left = base::beside(kept_files(folder).front(), base::Beside::part);
  ASSERT_TRUE(base::write_file(left, "half"));
  EXPECT_TRUE(KeptBlocks::open(folder, false));
  EXPECT_TRUE(fs::exists(left));
  EXPECT_TRUE(KeptBlocks::open(folder, true));
  EXPECT_FALSE(fs::exists(left));
}

TEST(Kept, adds_shares_up_to_the_whole) {
  const auto scene = city();
  const auto plain = made(scene, nullptr);
  for (const std::size_t shares : {1, 2, 3, 7}) {
    const test::Scratch folder;
    for (std::size_t share = shares; share-- > 0;) {
      const auto kept = opened(folder);
      ASSERT_TRUE(make_share({scene, nullptr}, {}, {}, Keep::models, {kept.get(), nullptr}, share, shares));
    }
    EXPECT_EQ(kept_files(folder).size(), 3U);
    const auto whole = made(scene, opened(folder).get());
    EXPECT_EQ(whole.blocks_kept, 3U) << shares;
    EXPECT_EQ(whole.bytes, plain.bytes);
  }
}

TEST(Kept, fails_where_a_block_cannot_be_kept) {
  const test::Scratch folder;
  const auto kept = opened(folder);
  for (int i = 0; i < 256; ++i) {  // where blocks would go
    constexpr auto digits = "0123456789abcdef";
    ASSERT_TRUE(base::write_file(folder / std::string{digits[i / 16], digits[i % 16]}, "in the way"));
  }
  const auto r = reconstruct(city(), {}, {}, Keep::models, {}, {kept.get(), nullptr});
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().code, "file-write");
}

TEST(Kept, keeps_nothing_that_a_cancelled_run_made_in_part) {
  const test::Scratch folder;
  const auto scene = city();
  const auto plain = made(scene, nullptr);
  // Cancelled at every stage that is reported, one after the other, until a run comes to its end.
  bool whole = false;
  for (int stages = 1; !whole && stages < 500; stages += 3) {
    base::Cancel cancel;
    base::Run run;
    run.cancel = &cancel;
    int seen = 0;
    run.progress = [&](auto, auto, double) {
      if (++seen == stages) cancel.request();
    };
    const auto kept = opened(folder);
    whole = reconstruct(scene, {}, run, Keep::models, {}, {kept.get(), nullptr}).has_value();
  }
  ASSERT_TRUE(whole);
  const auto again = made(scene, opened(folder).get());
  EXPECT_EQ(again.blocks_kept, 3U);
  EXPECT_EQ(again.bytes, plain.bytes);
}

/// Footprints without a mesh, 300 m apart but for two pairs: one that touches, one that lies on each other. Their
/// corners are not on any grid.
auto footprints() -> model::Scene {
  model::Scene scene;
  scene.frame.origin = {84'120, 447'310, 0};
  const auto add = [&](const std::string& id, double x, double y, std::int64_t levels) {
    auto footprint =
        test::footprint(id, {{{x, y}, {x + 11.013, y + 1.377}, {x + 10.1, y + 9.703}, {x - 0.9, y + 8.3}}, {}});
    footprint.attributes = {{"building:levels", levels}, {"roof:shape", std::string("hipped")}};
    scene.footprints.push_back(std::move(footprint));
  };
  for (int i = 0; i < 12; ++i)
    add("h" + std::to_string(i), -450.123 + 300.0 * (i % 4) + i / 7.0, -300.456 + 300.0 * (i / 4), 1 + i % 3);
  add("touches", -450.123 + 11.013, -300.456 + 1.377, 3);
  add("overlaps", -150.0, -299.0, 2);
  return scene;
}

auto made_in_tasks(const model::Scene& scene, KeptBlocks* kept, Options options = {}) -> Made {
  options.ingest.task_footprints = 2;
  Tally tally;
  const auto aside = raise_footprints_aside(scene, options, {}, {kept, &tally});
  EXPECT_TRUE(aside) << (aside ? "" : base::to_string(aside.error()));
  if (!aside) return {};
  model::City city{aside->frame, aside->made_by, {}};
  Made out;
  EXPECT_TRUE(aside->each([&](model::Building building, const report::BuildingReport& report) {
    out.bytes += report.id + std::string(to_string(report.outcome)) + std::to_string(report.volume);
    for (const auto& reason : report.reasons) out.bytes += base::to_string(reason);
    city.buildings.push_back(std::move(building));
    return base::Result<void>();
  }));
  for (const auto& overlap : aside->summary.overlaps) out.bytes += overlap.first + std::to_string(overlap.area);
  out.bytes += *formats::cityjson(city) + formats::plans(city);
  out.reuse = aside->summary.reuse;
  out.blocks_kept = tally.blocks_kept;
  EXPECT_EQ(tally.blocks_done, tally.blocks);
  EXPECT_EQ(tally.buildings_done, scene.footprints.size());
  return out;
}

auto reasons(const report::Reuse& reuse) -> std::map<std::string, int> {
  std::map<std::string, int> out;
  for (const auto& [name, why] : reuse.made) ++out[why];
  return out;
}

using Reasons = std::map<std::string, int>;

TEST(KeptTasks, are_taken_over_with_the_same_bytes) {
  const test::Scratch folder;
  const auto scene = footprints();
  const auto plain = made_in_tasks(scene, nullptr);
  const auto first = made_in_tasks(scene, opened(folder).get());
  EXPECT_EQ(first.bytes, plain.bytes);
  EXPECT_EQ(first.blocks_kept, 0U);
  EXPECT_TRUE(first.reuse.made.empty());
  const auto files = kept_files(folder);
  EXPECT_GE(files.size(), 7U);
  const auto second = made_in_tasks(scene, opened(folder).get());
  EXPECT_EQ(second.bytes, plain.bytes);
  EXPECT_EQ(second.reuse.blocks, files.size());
  EXPECT_EQ(second.blocks_kept, 12U) << "blocks";

  const auto whole = base::read_file(files[3]);
  ASSERT_TRUE(base::write_file(files[3], whole->substr(0, whole->size() / 2)));
  const auto third = made_in_tasks(scene, opened(folder).get());
  EXPECT_EQ(third.bytes, plain.bytes);
  EXPECT_EQ(reasons(third.reuse), (Reasons{{"damaged", 1}}));
}

TEST(KeptTasks, stay_where_the_frame_begins_elsewhere) {
  const test::Scratch folder;
  auto scene = footprints();
  (void)made_in_tasks(scene, opened(folder).get());
  // As where a city grows: its frame begins in its middle.
  const std::array<std::int64_t, 2> by{137, -41};
  for (std::size_t i = 0; i < 2; ++i) scene.frame.origin[i] += by[i];
  for (auto& footprint : scene.footprints)
    for (auto& p : footprint.polygons.front().outer)
      p = p - geometry::Point2{static_cast<double>(by[0]), static_cast<double>(by[1])};
  const auto again = made_in_tasks(scene, opened(folder).get());
  EXPECT_TRUE(again.reuse.made.empty());
  EXPECT_EQ(again.blocks_kept, 12U);
  EXPECT_EQ(again.bytes, made_in_tasks(scene, nullptr).bytes);
}

TEST(KeptTasks, are_made_again_only_where_something_changed) {
  const test::Scratch folder;
  auto scene = footprints();
  (void)made_in_tasks(scene, opened(folder).get());
  const auto expect = [&](const Reasons& wanted, const std::string& what, const Options& options = {}) {
    const auto again = made_in_tasks(scene, opened(folder).get(), options);
    EXPECT_EQ(reasons(again.reuse), wanted) << what;
    EXPECT_EQ(again.bytes, made_in_tasks(scene, nullptr, options).bytes) << what;
  };
  scene.footprints[5].attributes[0].second = std::int64_t{7};
  expect({{"footprints", 1}}, "an attribute");
  scene.footprints[11].polygons.front().outer[2].x += 0.001;
  expect({{"footprints", 1}}, "a millimetre");
  scene.footprints.push_back(scene.footprints[7]);
  scene.footprints.back().id = "more";
  for (auto& p : scene.footprints.back().polygons.front().outer) p.y += 2000;
  expect({{"new", 1}}, "one more, far from all");
  scene.footprints.pop_back();

  // A terrain, then one that is higher below one house.
  model::HeightGrid grid{{-700, -500}, 1, 1400, 1200, std::vector<float>(1400 * 1200, 2.0F)};
  scene.terrain = std::make_shared<const model::HeightGrid>(grid);
  auto again = made_in_tasks(scene, opened(folder).get());
  EXPECT_EQ(reasons(again.reuse).size(), 1U);
  EXPECT_TRUE(reasons(again.reuse).contains("terrain"));
  expect({}, "the same terrain");
  const auto& corner = scene.footprints[9].polygons.front().outer.front();
  for (int y = -3; y < 16; ++y)
    for (int x = -3; x < 16; ++x)
      grid.values[static_cast<std::size_t>(corner.y + 500 + y) * grid.columns +
                  static_cast<std::size_t>(corner.x + 700 + x)] = 3;
  scene.terrain = std::make_shared<const model::HeightGrid>(grid);
  expect({{"terrain", 1}}, "higher ground");

  Options other;
  other.roof.pitch = 0.7;
  again = made_in_tasks(scene, opened(folder).get(), other);
  EXPECT_EQ(again.blocks_kept, 0U);
  EXPECT_TRUE(reasons(again.reuse).contains("options"));
  other.write.compress = true;
  expect({}, "how files are written", other);
}

TEST(KeptTasks, are_whole_or_not_there) {
  const test::Scratch folder;
  const auto scene = footprints();
  const auto plain = made_in_tasks(scene, nullptr);
  Options options;
  options.ingest.task_footprints = 2;
  // Cancelled at every stage that is reported, one after the other, until a run comes to its end.
  bool whole = false;
  for (int stages = 1; !whole && stages < 500; stages += 2) {
    base::Cancel cancel;
    base::Run run;
    run.cancel = &cancel;
    int seen = 0;
    run.progress = [&](auto, auto, double) {
      if (++seen == stages) cancel.request();
    };
    const auto kept = opened(folder);
    whole = raise_footprints_aside(scene, options, run, {kept.get(), nullptr}).has_value();
  }
  ASSERT_TRUE(whole);
  const auto again = made_in_tasks(scene, opened(folder).get());
  EXPECT_EQ(again.blocks_kept, 12U);
  EXPECT_EQ(again.bytes, plain.bytes);

  const auto kept = opened(folder);
  fs::remove_all(fs::path(folder));
  std::ofstream(fs::path(folder)) << "in the way";
  const auto r = raise_footprints_aside(scene, options, {}, {kept.get(), nullptr});
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().code, "file-write");
}

}  // namespace
}  // namespace mansard::pipeline
