#include "mansard/ingest/cells.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/pack.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/ingest/detail/clean.hpp"

namespace mansard::ingest {
namespace {

using geometry::Box2;
using geometry::Point3;
using geometry::Triangle;

/// More cells than that are not looked through for one triangle: it belongs to this one cell then, which every box
/// asks for.
constexpr std::int64_t most_cells = 10'000;
constexpr MeshCells::Cell everywhere{INT32_MIN, INT32_MIN};

auto in_range(const Triangle& t, std::size_t count) -> bool { return t[0] < count && t[1] < count && t[2] < count; }

auto index(double coordinate, double side) -> std::int32_t {
  return static_cast<std::int32_t>(std::floor(coordinate / side));  // |coordinate| < 1e8, side ≥ 1
}

/// The triangles of a mesh that are numbered, with their own vertices only. `places` has room for every vertex of the
/// mesh; what is in it does not matter.
auto part_of(const formats::RawMesh& raw, std::span<const std::pair<MeshCells::Cell, std::uint32_t>> numbered,
             std::vector<std::uint32_t>& places) -> geometry::Mesh {
  std::vector<std::uint32_t> used;
  for (const auto& [cell, t] : numbered) used.insert(used.end(), raw.triangles[t].begin(), raw.triangles[t].end());
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  geometry::Mesh out;
  for (const auto v : used) {
    places[v] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(raw.vertices[v]);
  }
  for (const auto& [cell, t] : numbered) {
    Triangle triangle = raw.triangles[t];
    for (auto& v : triangle) v = places[v];
    out.triangles.push_back(triangle);
  }
  return out;
}

/// Adds `more` behind what is there.
void append(geometry::Mesh& mesh, const geometry::Mesh& more) {
  mesh.points.insert(mesh.points.end(), more.points.begin(), more.points.end());
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (Triangle t : more.triangles) {
    for (auto& v : t) v += first;
    mesh.triangles.push_back(t);
  }
}

auto unreadable() -> base::Diagnostic {
  return base::error("file-write", "what was put aside in the folder for temporary files (TMPDIR) was changed there");
}

}  // namespace

auto MeshCells::open(double side) -> base::Result<std::unique_ptr<MeshCells>> {
  std::unique_ptr<MeshCells> out(new MeshCells(side));
  for (auto* spool : {&out->raw_, &out->clean_}) {
    auto opened = base::Spool::open();
    if (!opened) return opened.failure();
    *spool = std::move(*opened);
  }
  return out;
}

void MeshCells::add(const formats::RawMesh& raw) {
  std::vector<std::pair<Cell, std::uint32_t>> placed;
  geometry::Box3 box;
  model::MeshCounts counts;
  counts.vertices_read = raw.vertices.size();
  counts.triangles_read = raw.triangles.size() + raw.short_faces;
  counts.degenerate = raw.short_faces;
  for (std::uint32_t t = 0; t < raw.triangles.size(); ++t) {
    const Triangle& triangle = raw.triangles[t];
    if (!in_range(triangle, raw.vertices.size())) {
      ++counts.out_of_range;
      continue;
    }
    const std::array<Point3, 3> p{raw.vertices[triangle[0]], raw.vertices[triangle[1]], raw.vertices[triangle[2]]};
    if (!std::ranges::all_of(p, detail::usable)) {
      ++counts.not_finite;
      continue;
    }
    for (const auto& corner : p) box.add(corner);
    const auto plan = Box2::of(p);
    const Cell first{index(plan.least.x, side_), index(plan.least.y, side_)},
        last{index(plan.most.x, side_), index(plan.most.y, side_)};
    const auto columns = std::int64_t{last.first} - first.first + 1,
               rows = std::int64_t{last.second} - first.second + 1;
    if (columns > most_cells || columns * rows > most_cells) {
      placed.emplace_back(everywhere, t);
      continue;
    }
    for (std::int32_t x = first.first; x <= last.first; ++x)
      for (std::int32_t y = first.second; y <= last.second; ++y) placed.emplace_back(Cell{x, y}, t);
  }
  std::ranges::sort(placed);
  std::map<Cell, geometry::Mesh> parts;
  std::vector<std::uint32_t> places(raw.vertices.size());
  for (std::size_t i = 0, end = 0; i < placed.size(); i = end) {
    while (end < placed.size() && placed[end].first == placed[i].first) ++end;
    parts[placed[i].first] = part_of(raw, std::span(placed).subspan(i, end - i), places);
  }
  for (const Point3 p : raw.points)
    if (detail::usable(p)) parts[{index(p.x, side_), index(p.y, side_)}].points.push_back(p);
  std::vector<std::pair<Cell, std::pair<std::string, std::size_t>>> pieces;
  for (const auto& [cell, part] : parts)
    pieces.emplace_back(cell, std::pair(base::packed(part), part.triangles.size()));
  const std::scoped_lock lock(mutex_);
  box_.include(box);
  counts_.vertices_read += counts.vertices_read;
  counts_.triangles_read += counts.triangles_read;
  counts_.degenerate += counts.degenerate;
  counts_.out_of_range += counts.out_of_range;
  counts_.not_finite += counts.not_finite;
  for (const auto& [cell, piece] : pieces) {
    chunks_[cell].push_back({raw_->size(), piece.first.size(), piece.second});
    raw_->append(piece.first);
  }
}

auto MeshCells::clean_cell(const Cell& cell, const std::vector<Chunk>& chunks, const std::array<double, 3>& shift,
                           const std::optional<Box2>& within, model::MeshCounts& counts)
    -> base::Result<geometry::Mesh> {
  geometry::Mesh all;
  for (const auto& chunk : chunks) {
    base::Result<std::string> bytes = [&] {
      const std::scoped_lock lock(mutex_);
      return raw_->read(chunk.offset, chunk.bytes);
    }();
    if (!bytes) return bytes.failure();
    geometry::Mesh piece;
    base::Unpacker from(*bytes);
    if (!from.take(piece) || !from.done()) return unreadable();
    append(all, piece);
  }
  // What touches several cells is counted by the one that its first corner lies in.
  std::optional<detail::Home> home;
  if (cell != everywhere)
    home = detail::Home{{cell.first * side_ + shift[0], cell.second * side_ + shift[1]},
                        {(cell.first + 1.0) * side_ + shift[0], (cell.second + 1.0) * side_ + shift[1]}};
  formats::RawMesh raw;
  raw.vertices = std::move(all.vertices);
  raw.triangles = std::move(all.triangles);
  raw.points = std::move(all.points);
  auto clean = detail::clean(std::move(raw), shift, within, home);
  counts = clean.counts;
  return std::move(clean.mesh);
}

auto MeshCells::settle(const std::array<double, 3>& shift, const std::optional<Box2>& within, const base::Run& run)
    -> base::Result<model::MeshCounts> {
  shift_ = shift;
  struct Result {
    model::MeshCounts counts;
    std::optional<base::Failure> failure;
  };
  const std::vector<std::pair<Cell, std::vector<Chunk>>> all(chunks_.begin(), chunks_.end());
  std::vector<Result> results(all.size());
  base::parallel_for(all.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    auto mesh = clean_cell(all[i].first, all[i].second, shift, within, results[i].counts);
    if (!mesh) {
      results[i].failure = mesh.failure();
      return;
    }
    if (mesh->triangles.empty() && mesh->points.empty()) return;
    const auto bytes = base::packed(*mesh);
    const std::scoped_lock lock(mutex_);
    cells_[all[i].first] = {clean_->size(), bytes.size(), mesh->triangles.size()};
    clean_->append(bytes);
  });
  if (run.cancelled()) return base::stopped();
  model::MeshCounts sum = counts_;
  for (const auto& [counts, failure] : results) {
    if (failure) return *failure;
    sum.vertices += counts.vertices;
    sum.triangles += counts.triangles;
    sum.degenerate += counts.degenerate;
    sum.duplicate += counts.duplicate;
    sum.non_manifold_edges += counts.non_manifold_edges;
    sum.boundary_edges += counts.boundary_edges;
    sum.flipped_edges += counts.flipped_edges;
  }
  chunks_.clear();
  raw_.reset();
  return sum;
}

auto MeshCells::cells_in(const Box2& box) const -> std::vector<Cell> {
  std::vector<Cell> out;
  if (cells_.contains(everywhere)) out.push_back(everywhere);
  if (box.empty()) return out;
  // A rounding of the shift must not lose a cell at the border.
  const double margin = 1e-6 * side_;
  const std::int32_t low = index(box.least.y - shift_[1] - margin, side_),
                     high = index(box.most.y - shift_[1] + margin, side_);
  for (std::int32_t x = index(box.least.x - shift_[0] - margin, side_);
       x <= index(box.most.x - shift_[0] + margin, side_); ++x)
    for (auto at = cells_.lower_bound({x, low}); at != cells_.end() && at->first <= Cell{x, high}; ++at)
      out.push_back(at->first);
  return out;
}

auto MeshCells::triangles_in(const Cell& cell) const -> std::size_t {
  const auto at = cells_.find(cell);
  return at == cells_.end() ? 0 : at->second.triangles;
}

auto MeshCells::load(const std::set<Cell>& cells) const -> base::Result<geometry::Mesh> {
  geometry::Mesh out;
  for (const auto& cell : cells) {
    const auto at = cells_.find(cell);
    if (at == cells_.end()) continue;
    base::Result<std::string> bytes = [&] {
      const std::scoped_lock lock(mutex_);
      return clean_->read(at->second.offset, at->second.bytes);
    }();
    if (!bytes) return bytes.failure();
    geometry::Mesh piece;
    base::Unpacker from(*bytes);
    if (!from.take(piece) || !from.done()) return unreadable();
    append(out, piece);
  }
  return out;
}

auto MeshCells::load_own(const Cell& cell) const -> base::Result<geometry::Mesh> {
  auto mesh = load({cell});
  if (!mesh || cell == everywhere) return mesh;
  const double margin = 1e-6 * side_;  // a rounding of the shift must not lose a triangle at the border
  const Box2 box = Box2{{cell.first * side_ + shift_[0], cell.second * side_ + shift_[1]},
                        {(cell.first + 1.0) * side_ + shift_[0], (cell.second + 1.0) * side_ + shift_[1]}}
                       .grown(margin);
  std::erase_if(mesh->triangles, [&](const Triangle& t) {
    const auto& v = mesh->vertices;
    return !box.contains(geometry::xy((1.0 / 3) * (v[t[0]] + v[t[1]] + v[t[2]])));
  });
  return mesh;
}

}  // namespace mansard::ingest
