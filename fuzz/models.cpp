// Bytes → a file of building models; the first says by which name it is taken. What reads cities that mansard wrote
// must give an error of its module, or a city whose plans read back as they were; what reads models of others an error,
// or models that can be cut into triangles; what takes their footprints an error, or footprints that are simple.
#include <array>
#include <cmath>
#include <exception>

#include "fuzz/files.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/codes.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/ingest/model.hpp"

namespace {

using namespace mansard;
using fuzz::promise;

auto codes() -> const std::vector<base::Code>& {
  static const auto all = [] {
    auto codes = ingest::codes();
    for (const auto& more : {base::codes(), formats::codes()}) codes.insert(codes.end(), more.begin(), more.end());
    return codes;
  }();
  return all;
}

/// The names that a city is read by, what is beside it being sound: the leaf of a tileset is a GLB with no buildings.
struct Names {
  fuzz::Folder folder{"models"};
  std::array<std::filesystem::path, 8> paths{folder.name("model.city.json"),    folder.name("model.city.jsonl"),
                                             folder.name("model.json"),         folder.name("model.glb"),
                                             folder.name("model.obj"),          folder.name("model.geojson"),
                                             folder.name("tiles/tileset.json"), folder.name("leaf/content.glb")};
  fuzz::MemoryFile again;

  Names() {
    const auto leaf = formats::glb({});
    promise(leaf.has_value(), "no GLB");
    promise(base::write_file(paths[6].parent_path() / "content.glb", *leaf).has_value(), "no folder to work in");
    const std::string header = R"({"type":"mansard-plan","version":1,"frame":{"origin":[0,0,0]}})";
    promise(base::write_file(paths[7].parent_path() / "tileset.json",
                             R"({"asset":{"version":"1.1","extras":{"header":)" + header +
                                 R"(}},"root":{"content":{"uri":"content.glb"}}})")
                .has_value(),
            "no folder to work in");
  }
};

void check_city(const std::filesystem::path& path, const fuzz::MemoryFile& again) {
  auto reader = formats::read_city(path);
  if (!reader) return fuzz::check_error(reader.error(), codes());
  const auto city = formats::read_whole(**reader);
  if (!city) return fuzz::check_error(city.error(), codes());
  // Ids are unique in what is written; a city that breaks that is told so there.
  const std::string text = formats::plans(*city);
  again.hold(text);
  const auto back = formats::read_plans(again.path());
  if (!back) {
    promise(back.error().message.find("an id that no other has") != std::string::npos, "what was written is not read",
            [&] { return base::to_string(back.error()) + text; });
    return;
  }
  promise(formats::plans(*back) == text, "what was written and read is written differently", [&] { return text; });
}

void check_model(const std::filesystem::path& path) {
  const auto model = ingest::read_model(path, {"", "local"});
  if (!model) return fuzz::check_error(model.error(), codes());
  for (const auto& building : model->buildings) {
    promise(!building.parts.empty(), "a building without parts");
    for (const auto& part : building.parts) {
      promise(!part.faces.empty(), "a part without faces");
      for (const auto& face : part.faces) {
        promise(!face.loops.empty() && face.loops[0].size() >= 3, "a face without corners");
        for (const auto& loop : face.loops)
          for (const auto p : loop)
            promise(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "a coordinate that is not finite");
      }
    }
  }
  const auto surface = model::surface_of(*model);
  for (const auto& t : surface.mesh.triangles)
    promise(std::max({t[0], t[1], t[2]}) < surface.mesh.vertices.size(), "a triangle names no vertex");
}

void check_footprints(const std::filesystem::path& path) {
  ingest::Options options;
  options.crs = "local";
  const auto scene = ingest::read_footprints(path, options);
  if (!scene) return fuzz::check_error(scene.error(), codes());
  for (const auto& footprint : scene->footprints)
    for (const auto& polygon : footprint.polygons)
      promise(polygon.outer.size() >= 3 && geometry::is_simple(polygon), "a footprint that crosses itself");
}

}  // namespace

auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int {
  static const Names names;
  if (size == 0) return 0;
  const std::size_t which = bytes[0] % names.paths.size();
  const std::string_view text{reinterpret_cast<const char*>(bytes) + 1, size - 1};
  names.folder.hold(text);
  const auto& path = names.paths[which];
  try {
    check_city(which == 7 ? path.parent_path() / "tileset.json" : path, names.again);
    if (which <= 2 || which == 4) check_model(path);
    // GDAL reads the rest, at its own pace.
    if (which <= 2 && text.find("\"CityJSON\"") != text.npos) check_footprints(path);
  } catch (const std::exception& thrown) {
    promise(false, "an exception left the module", [&] { return thrown.what(); });
  }
  return 0;
}
