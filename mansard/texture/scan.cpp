#include "mansard/texture/scan.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "mansard/formats/image.hpp"

namespace mansard::texture {
namespace {

using geometry::Box2;
using geometry::Box3;
using geometry::Point3;

constexpr double cell_side = 32;         // m; about the size of a building
constexpr std::int64_t most_cells = 64;  // of one triangle; larger ones are in a list of their own

auto cell_of(double coordinate) -> std::int32_t {
  return static_cast<std::int32_t>(std::floor(coordinate / cell_side));
}

auto finite(Point3 p) -> bool { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Everything of a triangle that is not its place in memory.
auto key_of(const ScanTriangle& t) {
  return std::tie(t.corners[0], t.corners[1], t.corners[2], t.uv, t.material, t.colour);
}

}  // namespace

auto Scan::open(double image_memory) -> base::Result<std::unique_ptr<Scan>> {
  std::unique_ptr<Scan> out(new Scan(image_memory));
  for (auto* spool : {&out->triangles_, &out->pictures_, &out->points_}) {
    auto opened = base::Spool::open();
    if (!opened) return opened.failure();
    *spool = std::move(*opened);
  }
  return out;
}

void Scan::expect(const Box3& box) {
  if (box.empty()) return;
  expected_.include(box.plan());
  for (auto x = cell_of(box.least.x); x <= cell_of(box.most.x); ++x)
    for (auto y = cell_of(box.least.y); y <= cell_of(box.most.y); ++y) wanted_.insert({x, y});
}

auto Scan::number_of(const formats::TextureMaterial& material) -> std::uint32_t {
  if (!material.image) return no_material;
  const auto& source = *material.image;
  std::uint32_t image = 0;
  const auto path = source.path.string();
  const auto known = source.bytes ? image_of_path_.end() : image_of_path_.find(path);
  if (known != image_of_path_.end()) {
    image = known->second;
  } else {
    image = static_cast<std::uint32_t>(images_.size());
    Image& added = images_.emplace_back(Image{path, source.name, 0, 0, source.bytes != nullptr, source.refused});
    if (source.bytes) {
      added.offset = pictures_->size();
      added.bytes = source.bytes->size();
      pictures_->append(*source.bytes);
    } else {
      image_of_path_[path] = image;
    }
  }
  materials_.push_back({{}, material.wrap, image});
  return static_cast<std::uint32_t>(materials_.size() - 1);
}

void Scan::append(std::vector<Chunk>& chunks, const std::vector<ScanTriangle>& triangles) {
  chunks.push_back({triangles_->size(), triangles.size()});
  triangles_->append({reinterpret_cast<const char*>(triangles.data()), triangles.size() * sizeof(ScanTriangle)});
}

void Scan::add(const formats::TexturedMesh& mesh) {
  if (!mesh.has_colour()) return;
  std::map<Cell, std::vector<ScanTriangle>> by_cell;
  std::vector<ScanTriangle> large;
  std::vector<std::uint32_t> number(mesh.materials.size(), no_material);
  const auto& vertices = mesh.mesh.vertices;
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    const auto& corners = mesh.mesh.triangles[t];
    if (std::ranges::any_of(corners, [&](auto c) { return c >= vertices.size() || !finite(vertices[c]); })) continue;
    const auto own = mesh.material_of[t];
    const bool pictured = own < mesh.materials.size() && mesh.materials[own].image;
    const bool plain = std::ranges::all_of(mesh.corners[t].colour, [](const auto& c) { return c == formats::white; });
    if (!pictured && plain) continue;
    const Box2 box = Box2::of(std::array{vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]});
    if (!box.overlaps(expected_)) continue;
    const std::int64_t columns = std::int64_t{cell_of(box.most.x)} - cell_of(box.least.x) + 1,
                       rows = std::int64_t{cell_of(box.most.y)} - cell_of(box.least.y) + 1;
    std::vector<Cell> cells;
    const bool is_large = columns > most_cells || rows > most_cells || columns * rows > most_cells;
    if (!is_large) {
      for (auto x = cell_of(box.least.x); x <= cell_of(box.most.x); ++x)
        for (auto y = cell_of(box.least.y); y <= cell_of(box.most.y); ++y)
          if (wanted_.contains({x, y})) cells.emplace_back(x, y);
      if (cells.empty()) continue;
    }
    ScanTriangle triangle{{vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]},
                          mesh.corners[t].uv,
                          mesh.corners[t].colour,
                          0,
                          no_material};
    if (pictured) {
      if (number[own] == no_material) number[own] = number_of(mesh.materials[own]);
      triangle.material = number[own];
    }
    if (is_large) large.push_back(triangle);
    for (const Cell& cell : cells) by_cell[cell].push_back(triangle);
  }
  for (const auto& [cell, triangles] : by_cell) append(cells_[cell], triangles);
  if (!large.empty()) append(large_, large);
}

void Scan::add(const std::vector<ScanPoint>& points) {
  std::map<Cell, std::vector<ScanPoint>> by_cell;
  for (const auto& point : points) {
    if (!finite(point.position)) continue;
    const Cell cell{cell_of(point.position.x), cell_of(point.position.y)};
    if (wanted_.contains(cell)) by_cell[cell].push_back(point);
  }
  for (const auto& [cell, own] : by_cell) {
    points_of_[cell].push_back({points_->size(), own.size()});
    points_->append({reinterpret_cast<const char*>(own.data()), own.size() * sizeof(ScanPoint)});
  }
}

auto Scan::points_near(const Box3& box) const -> base::Result<std::vector<ScanPoint>> {
  std::vector<ScanPoint> out;
  for (auto x = cell_of(box.least.x); x <= cell_of(box.most.x); ++x)
    for (auto y = cell_of(box.least.y); y <= cell_of(box.most.y); ++y) {
      const auto found = points_of_.find({x, y});
      if (found == points_of_.end()) continue;
      for (const Chunk& chunk : found->second) {
        const auto bytes = points_->read(chunk.offset, chunk.triangles * sizeof(ScanPoint));
        if (!bytes) return bytes.failure();
        for (std::size_t i = 0; i < chunk.triangles; ++i) {
          ScanPoint point;
          std::memcpy(&point, bytes->data() + i * sizeof point, sizeof point);
          const Box3 at{point.position, point.position};
          if (at.overlaps(box)) out.push_back(point);
        }
      }
    }
  return out;
}

auto Scan::near(const Box3& box) const -> base::Result<std::vector<ScanTriangle>> {
  std::vector<ScanTriangle> out;
  const auto take = [&](const std::vector<Chunk>& chunks) -> base::Result<void> {
    for (const Chunk& chunk : chunks) {
      const auto bytes = triangles_->read(chunk.offset, chunk.triangles * sizeof(ScanTriangle));
      if (!bytes) return bytes.failure();
      for (std::size_t i = 0; i < chunk.triangles; ++i) {
        ScanTriangle triangle;
        std::memcpy(&triangle, bytes->data() + i * sizeof triangle, sizeof triangle);
        if (Box3::of(triangle.corners).overlaps(box)) out.push_back(triangle);
      }
    }
    return {};
  };
  if (auto done = take(large_); !done) return done.failure();
  for (auto x = cell_of(box.least.x); x <= cell_of(box.most.x); ++x)
    for (auto y = cell_of(box.least.y); y <= cell_of(box.most.y); ++y)
      if (const auto found = cells_.find({x, y}); found != cells_.end())
        if (auto done = take(found->second); !done) return done.failure();
  std::ranges::sort(out, [](const auto& a, const auto& b) { return key_of(a) < key_of(b); });
  const auto again = std::ranges::unique(out, [](const auto& a, const auto& b) { return key_of(a) == key_of(b); });
  out.erase(again.begin(), again.end());
  return out;
}

auto Scan::decode(const Image& image) const -> base::Result<model::Pixels> {
  if (image.embedded) {
    const auto bytes = pictures_->read(image.offset, image.bytes);
    if (!bytes) return bytes.failure();
    return formats::decode_image(*bytes, image.name);
  }
  if (image.refused) return base::error("texture-outside", image.refused->message, image.refused->subject);
  auto pixels = formats::read_image(image.path);
  if (!pixels && pixels.error().code == "file-missing")
    return base::error("texture-missing", "the picture is missing; copy it beside the mesh", image.name);
  return pixels;
}

auto Scan::image(std::uint32_t material) const -> std::shared_ptr<const model::Pixels> {
  if (material >= materials_.size()) return nullptr;
  const auto number = materials_[material].image;
  const std::scoped_lock lock(mutex_);
  if (const auto found = decoded_.find(number); found != decoded_.end()) {
    used_.splice(used_.begin(), used_, found->second.use);
    return found->second.pixels;
  }
  auto pixels = decode(images_[number]);
  std::shared_ptr<const model::Pixels> made;
  if (pixels) {
    made = std::make_shared<const model::Pixels>(std::move(*pixels));
    bytes_ += made->rgb.size();
  } else {
    const auto& why = pixels.error();
    failed_.try_emplace(images_[number].name, base::warning(why.code, why.message, why.subject));
  }
  while (bytes_ > most_bytes_ && !used_.empty()) {
    const auto last = decoded_.find(used_.back());
    if (last->second.pixels) bytes_ -= last->second.pixels->rgb.size();
    decoded_.erase(last);
    used_.pop_back();
  }
  used_.push_front(number);
  decoded_[number] = {made, used_.begin()};
  return made;
}

auto Scan::wrap(std::uint32_t material) const -> const std::array<formats::Wrap, 2>& {
  return materials_[material].wrap;
}

auto Scan::warnings() const -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> out;
  if (empty())
    out.push_back(base::warning("texture-none",
                                "the meshes have no textures and no colours near the models, and point clouds no "
                                "colours, so the models get the colours of their classes; give textured meshes or "
                                "clouds with colours (red, green, blue), or leave --texture out"));
  constexpr std::size_t most = 5;
  for (const auto& [name, why] : failed_) {
    if (out.size() == most) {
      out.push_back(base::warning(
          "texture-missing", std::to_string(failed_.size() - most) + " more pictures are missing or cannot be read"));
      break;
    }
    out.push_back(why);
  }
  return out;
}

}  // namespace mansard::texture
