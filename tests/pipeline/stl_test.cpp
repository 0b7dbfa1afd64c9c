// STL of real data, read back as it is: what OpenFOAM's surfaceCheck asks of it, in exact arithmetic.
#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <map>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::pipeline {
namespace {

/// The triangles of an STL as one solid; corners at one place are one vertex, as single precision has them.
auto read_stl(const std::filesystem::path& path) -> model::Solid {
  const auto bytes = base::read_file(path);
  EXPECT_TRUE(bytes);
  std::uint32_t count = 0;
  std::memcpy(&count, bytes->data() + 80, 4);
  model::Solid solid;
  std::map<std::array<float, 3>, std::uint32_t> numbers;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<std::array<float, 3>, 4> lines{};  // the normal first
    std::memcpy(lines.data(), bytes->data() + 84 + 50 * t, 48);
    auto& loop = solid.faces.emplace_back().loops.emplace_back();
    for (std::size_t k = 1; k < 4; ++k) {
      const auto [entry, added] = numbers.try_emplace(lines[k], static_cast<std::uint32_t>(solid.vertices.size()));
      if (added) solid.vertices.push_back({lines[k][0], lines[k][1], lines[k][2]});
      loop.push_back(entry->second);
    }
  }
  return solid;
}

auto shells_of(const model::City& city, formats::Shell shell) -> model::Solid {
  const test::Scratch folder;
  base::Outputs outputs;
  formats::WriteOptions options;
  options.stl_shell = shell;
  auto writer =
      formats::open_writer(formats::Format::stl, folder / "it.stl", {city.frame, city.made_by}, options, outputs);
  EXPECT_TRUE(writer);
  EXPECT_TRUE(formats::write_city(city, **writer));
  EXPECT_TRUE(outputs.commit());
  return read_stl(folder / "it.stl");
}

void expect_closed_without_crossings(const model::Solid& shells, const std::string& what) {
  EXPECT_FALSE(shells.faces.empty()) << what;
  for (const auto& fault : solid::check(shells, {.planar = 1}))
    ADD_FAILURE() << what << ": " << fault.code << ": " << fault.message;
}

TEST(Stl, of_delft_is_closed_and_crosses_itself_nowhere) {
  const auto data = std::filesystem::path(MANSARD_DATA) / "delft";
  Options options;
  options.ingest.mesh_offset = {84800, 447400, 0};
  const auto scene = ingest::read_scene({data / "mesh.ply"}, data / "footprints.geojson", options.ingest);
  ASSERT_TRUE(scene) << scene.error().message;
  const auto made = reconstruct(*scene, options);
  ASSERT_TRUE(made) << made.error().message;
  expect_closed_without_crossings(shells_of(made->city, formats::Shell::block), "blocks");
  // Buildings one by one: beside each other they have the walls between them twice.
  for (const auto& building : made->city.buildings) {
    if (building.solids.size() > 1) continue;  // its solids touch along an edge, at which four faces meet
    model::City one{made->city.frame, made->city.made_by, {building}};
    expect_closed_without_crossings(shells_of(one, formats::Shell::building), building.id);
  }
}

}  // namespace
}  // namespace mansard::pipeline
