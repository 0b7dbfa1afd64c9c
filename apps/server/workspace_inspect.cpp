// Workspace: answers about models beyond what editing needs.
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/server/ground.hpp"
#include "apps/server/inputs.hpp"
#include "apps/server/inspect.hpp"
#include "apps/server/options.hpp"
#include "apps/server/workspace.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/ground_tiles.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/ingest/model.hpp"
#include "mansard/pipeline/stored.hpp"

namespace mansard::server {
namespace {

constexpr std::size_t most_basemaps = 4;  // that are kept, of some 10 MB each

/// What tiles are shown of around the models: their box, a quarter of it on each side, and at least 50 m; to 50 m, so
/// that runs of the same inputs and their edits have the same picture.
auto surroundings(const geometry::Box2& models) -> geometry::Box2 {
  constexpr double step = 50;  // m
  const auto size = models.most - models.least;
  const auto wide = models.grown(std::max(step, 0.25 * std::max(size.x, size.y)));
  return {{step * std::floor(wide.least.x / step), step * std::floor(wide.least.y / step)},
          {step * std::ceil(wide.most.x / step), step * std::ceil(wide.most.y / step)}};
}

}  // namespace

auto Workspace::attributes(const std::string& run, const std::optional<std::string>& building) -> Text {
  const auto open = models(run);
  if (!open) return open.error();
  if (building) {
    auto around = (*open)->edited_around(*building, scene_now());
    if (!around) return around.error();
    around->buildings.resize(1);
    return text_of(attributes_json(*reviewed(std::make_shared<const model::City>(std::move(*around)), **open)));
  }
  const auto city = (*open)->edited(scene_now());
  return city ? Text(text_of(attributes_json(*reviewed(*city, **open)))) : Text(city.error());
}

auto Workspace::level(const std::string& run, const std::string& lod) -> Text {
  std::optional<formats::Lod> level;
  for (const auto one : {formats::Lod::lod12, formats::Lod::lod13, formats::Lod::lod20})
    if (formats::name_of(one) == lod) level = one;
  if (!level)
    return base::error("server-unknown", "unknown level of detail; expected 1.2, 1.3 or 2.0",
                       base::on_one_line(lod.substr(0, 20)));
  const auto open = models(run);
  if (!open) return open.error();
  const auto city = (*open)->edited(scene_now());
  return city ? Text(text_of(level_json(**city, *level, (*open)->options().write.levels))) : Text(city.error());
}

auto Workspace::basemap(const std::string& run) -> Text {
  if (basemap_.file.empty() && basemap_.tiles.empty())
    return base::error(
        "server-no-basemap",
        "there is no basemap: the server was started without a raster that says where it is, or tiles of a map");
  const auto open = models(run);
  if (!open) return open.error();
  const auto& frame = (*open)->frame();
  const auto x = static_cast<double>(frame.origin[0]), y = static_cast<double>(frame.origin[1]);
  constexpr int most = 4096;  // pixels along a side: 64 MB on the graphics card
  auto key = frame.crs;
  geometry::Box2 around;
  if (!basemap_.tiles.empty()) {
    const auto extent = (*open)->extent();
    if (extent.empty())
      return base::error("server-no-basemap", "the run has no models, so there is no ground below them");
    around = surroundings({extent.least + geometry::Point2{x, y}, extent.most + geometry::Point2{x, y}});
    for (const double edge : {around.least.x, around.least.y, around.most.x, around.most.y})
      key += ' ' + base::to_text(edge);
  }
  const std::scoped_lock lock(basemap_mutex_);
  auto known = basemaps_.find(key);
  if (known == basemaps_.end()) {
    auto picture = basemap_.tiles.empty() ? formats::read_ground_picture(basemap_.file, frame.crs, most)
                                          : formats::read_ground_tiles(basemap_.tiles, frame.crs, around, most);
    if (!picture) return picture.error();
    if (basemaps_.size() >= most_basemaps) basemaps_.clear();
    known = basemaps_.emplace(key, std::move(*picture)).first;
  }
  const auto& [png, place] = known->second;
  const std::array<double, 4> edges{place.least.x - x, place.least.y - y, place.most.x - x, place.most.y - y};
  return std::string(reinterpret_cast<const char*>(edges.data()), sizeof(edges)) + png;
}

auto Workspace::terrain(const std::string& run) -> Text {
  const auto scene = scene_or_error();
  if (!scene) return scene.error();
  const auto open = models(run);
  if (!open) return open.error();
  const auto city = (*open)->edited(*scene);
  return city ? terrain_bytes(**city, **scene, (*open)->options()) : Text(city.error());
}

auto Workspace::other_model(const ImportRequest& request) -> Text {
  const auto path = absolute_name(request.path);
  if (auto there = formats::check_input(path); !there) return there.error();
  auto model = pipeline::read_any_model(path);
  if (!model) return model.error();
  std::optional<model::Frame> frame;
  if (const auto scene = scene_now()) frame = scene->scene().frame;
  if (frame) {
    auto moved = ingest::in_frame(std::move(*model), *frame);
    if (!moved) return moved.error();
    return text_of(other_model_json(*moved));
  }
  return text_of(other_model_json(*model));
}

auto Workspace::alignment(const InputsRequest& request) const -> Text {
  std::optional<Inputs> known;
  {
    const std::scoped_lock lock(mutex_);
    known = project_.inputs();
  }
  auto inputs = requested_inputs(request, known);
  if (!inputs) return inputs.error();
  if (inputs->footprints.empty())
    return base::error("server-input", "an offset can be found only with footprints; give a file or a database");
  pipeline::Options options;
  if (auto set = set_all(options, inputs->reading); !set) return set.error();
  const std::vector<std::filesystem::path> meshes(inputs->meshes.begin(), inputs->meshes.end());
  const auto placing = pipeline::find_placing({meshes, inputs->footprints, false}, options);
  if (!placing) return explained(placing.error(), *inputs);
  return text_of({{"proposal", placing_json(*placing, options)}});
}

}  // namespace mansard::server
