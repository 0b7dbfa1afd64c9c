#include "mansard/picture/detail/scenery.hpp"

#include <algorithm>
#include <queue>
#include <utility>

namespace mansard::picture::detail {
namespace {

using geometry::Point3;

/// visit(vertex) for those that a triangle has, each once.
template <class Visit>
void each_used(const geometry::Mesh& mesh, Visit visit) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles)
    for (const auto v : triangle) used[v] = 1;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) visit(mesh.vertices[v]);
}

}  // namespace

Piece::Piece(std::span<const Layer> layers) { join(layers); }

Piece::Piece(std::vector<Layer> layers) : own_(std::move(layers)) {
  join(own_);
  for (auto& layer : own_) layer.mesh = {};
}

void Piece::join(std::span<const Layer> layers) {
  geometry::Mesh mesh;
  for (const Layer& layer : layers) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    if (layer.picture) pictured_.push_back({mesh.triangles.size(), layer.mesh.triangles.size(), &layer});
    mesh.vertices.insert(mesh.vertices.end(), layer.mesh.vertices.begin(), layer.mesh.vertices.end());
    for (std::size_t t = 0; t < layer.mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = layer.mesh.triangles[t];
      mesh.triangles.push_back({first + a, first + b, first + c});
      const Point3 &p = layer.mesh.vertices[a], &q = layer.mesh.vertices[b], &r = layer.mesh.vertices[c];
      normals_.push_back(normalised(cross(q - p, r - p)));
      colours_.push_back(layer.colours.empty()
                             ? mesh_blue
                             : layer.colours[layer.colours.size() == layer.mesh.triangles.size() ? t : 0]);
    }
  }
  scene_ = std::make_unique<const rays::Scene>(std::move(mesh));
}

auto Piece::look(std::size_t triangle, Point3 point) const -> Look {
  for (const auto& [first, count, layer] : pictured_)
    if (triangle >= first && triangle - first < count) {
      if (const auto colour = layer->picture(triangle - first, point)) return {*colour, true};
      break;
    }
  return {colours_[triangle], false};
}

template <class Visit>
auto Scenery::each(Visit visit) const -> base::Result<void> {
  if (pieces_ == nullptr) {
    visit(std::size_t{0}, layers_);
    return {};
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const auto layers = pieces_->load(i);
    if (!layers) return layers.failure();
    visit(i, std::span<const Layer>(*layers));
  }
  return {};
}

auto Scenery::survey(std::span<const Camera> views) -> base::Result<void> {
  boxes_.assign(count_, {});
  in_views_.assign(views.size(), {});
  std::size_t vertices = 0;
  auto seen = each([&](std::size_t i, std::span<const Layer> layers) {
    for (const Layer& layer : layers)
      each_used(layer.mesh, [&](const Point3& p) {
        ++vertices;
        boxes_[i].add(p);
        for (std::size_t v = 0; v < views.size(); ++v) in_views_[v].add(along(views[v], p));
      });
    box_.include(boxes_[i]);
  });
  if (!seen || vertices == 0) return seen;
  // Scans have debris far below the ground; the paper lies under all but the lowest hundredth.
  const std::size_t hundredth = vertices / 100;
  std::priority_queue<double> lowest;
  seen = each([&](std::size_t, std::span<const Layer> layers) {
    for (const Layer& layer : layers)
      each_used(layer.mesh, [&](const Point3& p) {
        if (lowest.size() <= hundredth) {
          lowest.push(p.z);
        } else if (p.z < lowest.top()) {
          lowest.pop();
          lowest.push(p.z);
        }
      });
  });
  if (seen) low_ = lowest.top();
  return seen;
}

auto Scenery::piece(std::size_t number) const -> base::Result<std::shared_ptr<const Piece>> {
  if (only_) return only_;
  std::shared_ptr<const Piece> made;
  if (pieces_ == nullptr) {
    made = std::make_shared<const Piece>(layers_);
  } else {
    auto layers = pieces_->load(number);
    if (!layers) return layers.failure();
    made = std::make_shared<const Piece>(std::move(*layers));
  }
  if (count_ == 1) only_ = made;
  return made;
}

}  // namespace mansard::picture::detail
