#include "apps/server/scene.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "apps/server/options.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/pipeline/inputs.hpp"

namespace mansard::server {
namespace {

/// Half the width of a section, and its height above and below the base of the edge, in m.
constexpr double section_reach = 20.0;
/// Triangles that are kept prepared for rays: about 100 MB.
constexpr std::size_t most_prepared = 500'000;

}  // namespace

auto OpenScene::read(const Inputs& inputs, const base::Run& run) -> base::Result<std::shared_ptr<const OpenScene>> {
  pipeline::Options options;
  if (auto set = set_all(options, inputs.reading); !set) return set.error();
  const std::vector<std::filesystem::path> meshes(inputs.meshes.begin(), inputs.meshes.end());
  auto scene = pipeline::read_inputs({meshes, inputs.footprints, inputs.footprints.empty()}, options, run);
  if (!scene) return scene.error();
  const std::shared_ptr<OpenScene> out(new OpenScene);
  out->scene_ = std::move(*scene);
  run.report("block", formats::name_to_show(inputs.footprints), 0.9);
  out->blocks_ = block::partition(out->scene_, options.block, run);
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  run.report("tiles", inputs.meshes.front(), 0.95);
  auto tiles = picture::tiles(out->scene_.mesh, {}, run);
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  out->prepared_.resize(out->blocks_.size());
  for (std::size_t b = 0; b < out->blocks_.size(); ++b)
    for (const auto& member : out->blocks_[b].members) out->block_of_[out->scene_.feature(member.feature).id] = b;
  auto view = SceneView::make(text_of(json_of(out->scene_, out->blocks_)), std::move(tiles));
  if (!view) return view.failure();
  out->view_ = std::move(*view);
  return std::shared_ptr<const OpenScene>(out);
}

auto OpenScene::has_block(std::string_view name) const -> bool { return block_named(name) != nullptr; }

auto OpenScene::rays_of(std::string_view building) const -> std::shared_ptr<const rays::Scene> {
  const auto at = block_of_.find(building);
  if (at == block_of_.end() || blocks_[at->second].mesh.triangles.empty()) return nullptr;
  auto& prepared = prepared_[at->second];
  const std::scoped_lock lock(prepared.rays_mutex);
  auto rays = prepared.rays.lock();
  if (!rays) prepared.rays = rays = std::make_shared<const rays::Scene>(blocks_[at->second].mesh);
  keep(at->second, rays);
  return rays;
}

void OpenScene::keep(std::size_t block, const std::shared_ptr<const rays::Scene>& rays) const {
  const std::scoped_lock lock(kept_mutex_);
  const auto known = std::ranges::find(kept_, block, [](const auto& one) { return one.first; });
  if (known != kept_.end()) kept_.erase(known);
  kept_.emplace_front(block, rays);
  std::size_t triangles = 0;
  for (auto one = kept_.begin(); one != kept_.end();) {
    triangles += blocks_[one->first].mesh.triangles.size();
    one = triangles > most_prepared && one != kept_.begin() ? kept_.erase(one) : std::next(one);
  }
}

auto OpenScene::member_of(std::string_view building) const -> const block::Member* {
  const auto at = block_of_.find(building);
  if (at == block_of_.end()) return nullptr;
  const auto& members = blocks_[at->second].members;
  const auto found =
      std::ranges::find(members, building, [&](const auto& member) { return scene_.feature(member.feature).id; });
  return found == members.end() ? nullptr : &*found;
}

auto OpenScene::block_named(std::string_view name) const -> const block::Block* {
  const auto at = std::ranges::find(blocks_, name, &block::Block::name);
  return at == blocks_.end() ? nullptr : &*at;
}

auto OpenScene::section(const model::Plan& plan, std::size_t ring, std::size_t edge, double share,
                        const std::optional<std::string>& building, const pipeline::Options& options) const -> Json {
  const auto& points = ring == 0 ? plan.outer.points : plan.holes[ring - 1].points;
  const auto from = points[edge], to = points[(edge + 1) % points.size()];
  Json pieces = Json::array(), climbs = Json::array();
  if (!blocks_.empty()) {
    const auto known = building ? block_of_.find(*building) : block_of_.end();
    const auto b = known != block_of_.end() ? known->second : block_near(0.5 * (from + to));
    const auto& mesh = blocks_[b].mesh;
    auto& prepared = prepared_[b];
    std::call_once(prepared.once_raw, [&] { prepared.raw = std::make_unique<profile::RawProfiles>(mesh); });
    for (const auto& [start, end] : edit::section(mesh, from, to, share, plan.base, section_reach).pieces)
      pieces.push_back(Json::array({json_of(start), json_of(end)}));
    for (const auto& raw : prepared.raw->behind(model::polygon_of(plan), ring, edge, plan.base, options.profile)) {
      Json climb = Json::array();
      for (const auto& point : raw.points) climb.push_back(json_of(point));
      climbs.push_back(std::move(climb));
    }
  }
  return {{"share", share}, {"pieces", std::move(pieces)}, {"climbs", std::move(climbs)}};
}

auto OpenScene::block_near(geometry::Point2 at) const -> std::size_t {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (const auto& polygon : blocks_[b].outline) {
      const double distance = geometry::contains(polygon, at) ? 0 : geometry::boundary_distance(polygon, at);
      if (distance < least) least = distance, nearest = b;
    }
  return nearest;
}

}  // namespace mansard::server
