#include "apps/server/scene.hpp"

#include <malloc.h>
#include <algorithm>
#include <limits>

#include "apps/server/options.hpp"
#include "mansard/formats/input_name.hpp"
#include "mansard/pipeline/inputs.hpp"

namespace mansard::server {
namespace {

/// Half the width of a section, and its height above and below the base of the edge, in m.
constexpr double section_reach = 20.0;
/// Triangles that are kept prepared, for rays and for sections: about 50 MB each.
constexpr std::size_t most_prepared = 250'000;

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
  out->mesh_box_ = geometry::Box3::of(out->scene_.mesh.vertices);
  std::vector<Json> blocks;
  if (auto divided = out->divide(options.block, run, blocks); !divided) return divided.failure();
  ::malloc_trim(0);  // what dividing took is not kept beside what the tiles take
  run.report("tiles", inputs.meshes.front(), 0.95);
  for (std::size_t b = 0; b < out->blocks_.size(); ++b)
    for (const auto& member : out->blocks_[b].members) out->block_of_[out->scene_.feature(member.feature).id] = b;
  auto view = SceneView::make(text_of(json_of(out->scene_, out->blocks_, std::move(blocks))),
                              [&](const picture::TakeTile& take) { picture::tiles(out->scene_.mesh, {}, run, take); });
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  if (!view) return view.failure();
  out->view_ = std::move(*view);
  out->meshes_->put(out->blocks_.size(), out->scene_.mesh);
  out->scene_.mesh = {};
  if (auto put = out->meshes_->check(); !put) return put.failure();
  return std::shared_ptr<const OpenScene>(out);
}

/// The blocks, of which each piece of the mesh is in memory only until it is in the file; `shown`: for the page.
auto OpenScene::divide(const block::Options& options, const base::Run& run, std::vector<Json>& shown)
    -> base::Result<void> {
  const block::Partition partition(scene_, options, run);
  const std::size_t count = partition.size();
  auto meshes = MeshFile::open(count + 1);
  if (!meshes) return meshes.failure();
  meshes_ = std::move(*meshes);
  blocks_.resize(count);
  shown.resize(count);
  base::parallel_for(count, [&](std::size_t b) {
    if (run.cancelled()) return;
    auto block = partition.make(b);
    shown[b] = json_of(block, scene_);
    meshes_->put(b, block.mesh);
    block.mesh = {};
    blocks_[b] = std::move(block);
  });
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  rays_ = std::make_unique<UsedLast<rays::Scene>>(count, most_prepared);
  sliced_ = std::make_unique<UsedLast<Sliced>>(count, most_prepared);
  return meshes_->check();
}

auto OpenScene::with_mesh() const -> base::Result<model::Scene> {
  auto mesh = meshes_->read(blocks_.size());
  if (!mesh) return mesh.failure();
  auto whole = scene_;
  whole.mesh = std::move(*mesh);
  return whole;
}

auto OpenScene::failure() const -> std::optional<base::Diagnostic> {
  const std::scoped_lock lock(failure_mutex_);
  return failure_;
}

auto OpenScene::mesh_of(std::size_t block) const -> std::optional<geometry::Mesh> {
  auto mesh = meshes_->read(block);
  if (mesh) return std::move(*mesh);
  const std::scoped_lock lock(failure_mutex_);
  failure_ = mesh.error();
  return std::nullopt;
}

auto OpenScene::has_block(std::string_view name) const -> bool { return block_named(name) != nullptr; }

auto OpenScene::rays_of(std::string_view building) const -> std::shared_ptr<const rays::Scene> {
  const auto at = block_of_.find(building);
  if (at == block_of_.end() || meshes_->triangles(at->second) == 0) return nullptr;
  return rays_->get(at->second, meshes_->triangles(at->second), [&]() -> std::shared_ptr<const rays::Scene> {
    auto mesh = mesh_of(at->second);
    return mesh ? std::make_shared<const rays::Scene>(std::move(*mesh)) : nullptr;
  });
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
    const auto sliced = sliced_->get(b, meshes_->triangles(b), [&]() -> std::shared_ptr<const Sliced> {
      auto mesh = mesh_of(b);
      return mesh ? std::make_shared<const Sliced>(std::move(*mesh)) : nullptr;
    });
    if (sliced == nullptr) return {{"share", share}, {"pieces", std::move(pieces)}, {"climbs", std::move(climbs)}};
    for (const auto& [start, end] : edit::section(sliced->mesh, from, to, share, plan.base, section_reach).pieces)
      pieces.push_back(Json::array({json_of(start), json_of(end)}));
    for (const auto& raw : sliced->raw.behind(model::polygon_of(plan), ring, edge, plan.base, options.profile)) {
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
