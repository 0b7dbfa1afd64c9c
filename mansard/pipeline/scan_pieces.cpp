#include "mansard/pipeline/scan_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "mansard/geometry/curve.hpp"
#include "mansard/geometry/mesh_part.hpp"

namespace mansard::pipeline {
namespace {

using geometry::Mesh;
using Cells = std::vector<ingest::MeshCells::Cell>;

auto in_cells(const ingest::MeshCells& cells, const geometry::Box2& box) -> report::ScanPieces {
  Cells wanted = cells.cells_in(box);
  std::ranges::sort(wanted, {}, [](const auto& cell) { return geometry::along_curve(cell.first, cell.second); });
  auto pieces = std::make_shared<std::vector<Cells>>();
  std::size_t all = 0;
  for (const auto& cell : wanted) all += cells.triangles_in(cell);
  const std::size_t most = report::piece_triangles(all);
  std::size_t triangles = 0;
  for (const auto& cell : wanted) {
    const std::size_t more = cells.triangles_in(cell);
    if (pieces->empty() || triangles + more > most) {
      pieces->emplace_back();
      triangles = 0;
    }
    triangles += more;
    pieces->back().push_back(cell);
  }
  const auto load = [&cells, pieces](std::size_t piece) -> base::Result<std::shared_ptr<const Mesh>> {
    auto out = std::make_shared<Mesh>();
    for (const auto& cell : (*pieces)[piece]) {
      const auto own = cells.load_own(cell);
      if (!own) return own.failure();
      const auto first = static_cast<std::uint32_t>(out->vertices.size());
      out->vertices.insert(out->vertices.end(), own->vertices.begin(), own->vertices.end());
      for (const auto& [a, b, c] : own->triangles) out->triangles.push_back({first + a, first + b, first + c});
    }
    return std::shared_ptr<const Mesh>(std::move(out));
  };
  return {pieces->size(), load};
}

/// Triangles of a mesh in memory, those that are near each other together.
auto in_memory(const Mesh& mesh, const geometry::Box2& box) -> report::ScanPieces {
  constexpr double side = 64;  // m; as the cells on disk are by default
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto middle = geometry::xy((1.0 / 3) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]));
    if (!box.contains(middle)) continue;
    const auto cell = [](double metres) { return static_cast<std::int64_t>(std::floor(metres / side)); };
    order.emplace_back(geometry::along_curve(cell(middle.x), cell(middle.y)), t);
  }
  const std::size_t most = report::piece_triangles(order.size());
  if (order.size() <= most)
    return {1, [&mesh](std::size_t) -> base::Result<std::shared_ptr<const Mesh>> {
              return std::shared_ptr<const Mesh>(std::shared_ptr<const Mesh>(), &mesh);  // which nobody owns
            }};
  std::ranges::sort(order);
  auto sorted = std::make_shared<std::vector<std::uint32_t>>();
  sorted->reserve(order.size());
  for (const auto& [place, t] : order) sorted->push_back(t);
  const std::size_t count = (sorted->size() + most - 1) / most, each = (sorted->size() + count - 1) / count;
  const auto load = [&mesh, sorted, each](std::size_t piece) -> base::Result<std::shared_ptr<const Mesh>> {
    const auto own = std::span(*sorted).subspan(piece * each, std::min(each, sorted->size() - piece * each));
    return std::make_shared<const Mesh>(geometry::part_of(mesh, own));
  };
  return {count, load};
}

}  // namespace

auto scan_pieces(const ingest::CityScene& city, const geometry::Box2& box) -> report::ScanPieces {
  return city.cells ? in_cells(*city.cells, box) : in_memory(city.scene.mesh, box);
}

}  // namespace mansard::pipeline
