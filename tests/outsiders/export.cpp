// outsiders_export OUTDIR FOOTPRINTS [PLANS]: cities of every kind as GLB, as 3D Tiles and as CityJSON, for the
// programs of others to read. OUTDIR/expected.json says of each GLB and tileset what must be in it. With PLANS also
// that city, as "given".
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "formats/painted.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/formats/scan.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Ids, names of attributes and values as no schema foresees them.
auto odd() -> model::City {
  auto city = cities::street();
  city.buildings[0].id = "Haus \"Zur Rose\"\n\xF0\x9F\x8F\xA0 \xFF";
  city.buildings[0].attributes = {{"bouwjaar (ca.)", std::int64_t{1893}},
                                  {"2nd", true},
                                  {"", 1.5},
                                  {"class", std::string("a")},
                                  {"record", std::string("b")},
                                  {"+noise", std::int64_t{48}},
                                  {"mixed", std::int64_t{3}},
                                  {"big", std::int64_t{503100000012869}},
                                  {"nan", std::numeric_limits<double>::quiet_NaN()},
                                  {"Stra\xC3\x9F"
                                   "e",
                                   std::string()}};
  city.buildings[1].attributes = {{"mixed", std::string("three")}, {"bouwjaar_ca__", 2.0}, {"listed", false}};
  return city;
}

/// Houses every 250 m over a square of 8 km: levels of tiles, and the Earth curves by metres.
auto wide() -> model::City {
  auto city = cities::street();
  city.buildings.clear();
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j) {
      const double x = 250 * i, y = 250 * j, ridge = 9 + (7 * i + 3 * j) % 5;
      model::Building house;
      house.id = "h" + std::to_string(i) + "-" + std::to_string(j);
      house.attributes = {{"row", std::int64_t{j}}};
      house.footprint = {cities::rectangle(x, y, 10, 8)};
      house.parts = {
          {house.id + "-1", cities::plan_of(house.footprint[0], 0, 10), cities::gable(x, y, 10, 8, 0, 6, ridge), {}}};
      city.buildings.push_back(std::move(house));
    }
  return city;
}

struct Sample {
  std::string name;
  model::City city;
  double tile_triangles = 20000;
};

/// What a validator compares the files of a city with.
auto expected(const model::City& city) -> Json {
  Json buildings = Json::array();
  for (const auto& building : city.buildings) buildings.push_back({{"parts", building.parts.size()}});
  return {{"buildings", city.buildings.size()}, {"crs", city.frame.crs}, {"parts", buildings}};
}

auto write_cityjson(const fs::path& out, const Sample& sample) -> base::Result<void> {
  for (const auto format : {formats::Format::cityjson, formats::Format::cityjsonseq}) {
    const std::string name = sample.name + (format == formats::Format::cityjson ? ".city.json" : ".city.jsonl");
    base::Outputs outputs;
    auto writer = formats::open_writer(format, out / name, {sample.city.frame, sample.city.made_by}, {}, outputs);
    if (!writer) return writer.error();
    if (auto written = formats::write_city(sample.city, **writer); !written) return written;
    if (auto done = outputs.commit(); !done) return done;
  }
  return {};
}

auto write_sample(const fs::path& out, const Sample& sample, Json& all) -> base::Result<void> {
  if (auto written = write_cityjson(out, sample); !written) return written;
  for (const bool compress : {false, true}) {
    formats::WriteOptions options;
    options.compress = compress;
    options.tile_triangles = sample.tile_triangles;
    options.unlit = compress;  // of what has textures
    for (const auto format : {formats::Format::glb, formats::Format::tiles}) {
      const std::string name =
          sample.name + (compress ? "-compressed" : "") + (format == formats::Format::glb ? ".glb" : "");
      base::Outputs outputs;
      auto writer =
          formats::open_writer(format, out / name, {sample.city.frame, sample.city.made_by}, options, outputs);
      if (!writer) return writer.error();
      if (auto written = formats::write_city(sample.city, **writer); !written) return written;
      if (auto done = outputs.commit(); !done) return done;
      all[name] = expected(sample.city);
    }
  }
  return {};
}

auto raised(model::City city) -> base::Result<model::City> {
  auto done = pipeline::raise_plans(std::move(city), {});
  if (!done) return done.error();
  return std::move(done->city);
}

auto samples(int count, char** arguments) -> base::Result<std::vector<Sample>> {
  std::vector<Sample> all{{"street", cities::street()}, {"odd", odd()}, {"wide", wide(), 300}};
  model::City empty = cities::street(), bare = empty, local = empty;
  empty.buildings.clear();
  for (auto& building : bare.buildings) building.parts.clear();
  local.frame.crs.clear();
  all.push_back({"empty", empty});
  all.push_back({"bare", bare});
  all.push_back({"local", local});
  all.push_back({"painted", cities::painted_street(), 100});
  const auto scene = ingest::read_footprints(arguments[2], {});
  if (!scene) return scene.error();
  pipeline::Options pitched;
  pitched.roof.profile = "0,0 0,6 4,9";  // so that roofs differ from flat ones
  auto footprints = pipeline::raise_footprints(*scene, pitched);
  if (!footprints) return footprints.error();
  all.push_back({"footprints", std::move(footprints->city), 1000});
  if (count > 3) {
    auto plans = formats::read_plans(arguments[3]);
    if (!plans) return plans.error();
    auto city = raised(std::move(*plans));
    if (!city) return city.error();
    all.push_back({"given", std::move(*city)});
  }
  return all;
}

auto labelled(const fs::path& out) -> base::Result<void> {
  using model::SurfaceClass;
  const geometry::Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0.25}},
                            {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}};
  const std::vector<SurfaceClass> classes{SurfaceClass::roof, SurfaceClass::ground, SurfaceClass::wall};
  const auto bytes = formats::labelled_glb(mesh, classes, {{85000, 447000, 2}, "EPSG:28992"});
  if (!bytes) return bytes.error();
  return base::write_file(out / "labelled.glb", *bytes);
}

auto export_all(int count, char** arguments) -> base::Result<void> {
  const fs::path out = arguments[1];
  fs::remove_all(out);
  fs::create_directories(out);
  const auto all = samples(count, arguments);
  if (!all) return all.error();
  Json said;
  for (const Sample& sample : *all)
    if (auto written = write_sample(out, sample, said); !written) return written;
  if (auto written = labelled(out); !written) return written;
  return base::write_file(out / "expected.json", said.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace
}  // namespace mansard

auto main(int count, char** arguments) -> int {
  if (count < 3) {
    std::cerr << "usage: outsiders_export OUTDIR FOOTPRINTS [PLANS]\n";
    return 2;
  }
  const auto done = mansard::export_all(count, arguments);
  if (!done) std::cerr << mansard::base::to_string(done.error()) << "\n";
  return done ? 0 : 1;
}
