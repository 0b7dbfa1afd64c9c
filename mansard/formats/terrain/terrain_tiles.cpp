#include "mansard/formats/terrain/terrain_tiles.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <vector>

#include "mansard/base/files.hpp"
#include "mansard/formats/json/json_text.hpp"
#include "mansard/formats/terrain/terrain_glb.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/mesh_part.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Box2;
using geometry::Box3;
using geometry::Mesh;
using geometry::Point2;
using geometry::Point3;

// ---- levels of detail

/// Two meshes as one, with one vertex at every place. Triangles of the second come after those of the first.
auto joined(const Mesh& one, const Mesh& other) -> Mesh {
  Mesh out;
  std::map<Point3, std::uint32_t> numbers;
  for (const Mesh* mesh : {&one, &other})
    for (auto triangle : mesh->triangles) {
      for (auto& v : triangle) {
        const Point3 p = mesh->vertices[v];
        const auto [entry, added] = numbers.try_emplace(p, static_cast<std::uint32_t>(out.vertices.size()));
        if (added) out.vertices.push_back(p);
        v = entry->second;
      }
      out.triangles.push_back(triangle);
    }
  return out;
}

/// Without the steps between grounds of different heights, which would all stay: corners above each other become the
/// lowest of them, and upright triangles go. Those on the border of the mesh in plan stay.
auto without_steps(const Mesh& mesh) -> Mesh {
  std::map<Point2, std::uint32_t> lowest;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    auto& kept = lowest.try_emplace(xy(mesh.vertices[v]), v).first->second;
    if (mesh.vertices[v].z < mesh.vertices[kept].z) kept = v;
  }
  std::vector<std::uint32_t> at(mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) at[v] = lowest[xy(mesh.vertices[v])];
  std::set<std::pair<std::uint32_t, std::uint32_t>> border;  // edges of one triangle
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = at[t[i]], b = at[t[(i + 1) % 3]];
      if (a != b && border.erase({b, a}) == 0) border.emplace(a, b);
    }
  std::vector<bool> stays(mesh.vertices.size());
  for (const auto& [a, b] : border) stays[a] = stays[b] = true;
  Mesh out{mesh.vertices, {}};
  for (auto t : mesh.triangles) {
    for (auto& v : t)
      if (!stays[at[v]]) v = at[v];
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) out.triangles.push_back(t);
  }
  return joined(out, {});
}

/// With about that many triangles. Corners stay where they are, and those on the border of the mesh stay.
auto simplified(const Mesh& mesh, std::size_t most) -> Mesh {
  if (mesh.triangles.size() <= most) return mesh;
  // Relative to a corner: single precision decides only which corners go.
  const Point3 origin = mesh.vertices.front();
  std::vector<float> places;
  // Flattened, because only triangles that turn over in space are noticed: a steep one can turn over in plan by less.
  constexpr double flattened = 0.1;
  for (const auto& v : mesh.vertices)
    for (const double c : {v.x - origin.x, v.y - origin.y, flattened * (v.z - origin.z)})
      places.push_back(static_cast<float>(c));
  std::vector<std::uint32_t> corners, kept(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  constexpr float any_error = 1;  // of the size of the mesh
  kept.resize(meshopt_simplify(kept.data(), corners.data(), corners.size(), places.data(), mesh.vertices.size(),
                               3 * sizeof(float), 3 * most, any_error, meshopt_SimplifyLockBorder, nullptr));
  Mesh whole{mesh.vertices, {}};
  for (std::size_t i = 0; i + 2 < kept.size(); i += 3) whole.triangles.push_back({kept[i], kept[i + 1], kept[i + 2]});
  return joined(whole, {});
}

/// The largest vertical distance of the corners of a mesh from a surface over the same area, m.
auto vertical_distance(const Mesh& mesh, const Mesh& surface) -> double {
  std::vector<Box2> boxes;
  for (const auto& t : surface.triangles) {
    auto& box = boxes.emplace_back();
    for (const auto v : t) box.add(xy(surface.vertices[v]));
  }
  const geometry::BoxIndex index(boxes);
  double most = 0;
  for (const auto& p : mesh.vertices) {
    double least = std::numeric_limits<double>::infinity();
    Box2 here;
    here.add(xy(p));
    for (const auto t : index.overlapping(here)) {
      std::array<Point3, 3> c{};
      for (std::size_t i = 0; i < 3; ++i) c[i] = surface.vertices[surface.triangles[t][i]] - p;
      std::array<double, 3> share{};  // twice the areas opposite the corners
      for (std::size_t i = 0; i < 3; ++i) share[i] = cross(xy(c[(i + 1) % 3]), xy(c[(i + 2) % 3]));
      const double area = share[0] + share[1] + share[2];
      constexpr double flat = 1e-9;  // m²; less is upright
      if (area < flat || std::ranges::min(share) < -flat) continue;
      least = std::min(least, std::abs(share[0] * c[0].z + share[1] * c[1].z + share[2] * c[2].z) / area);
    }
    if (std::isfinite(least)) most = std::max(most, least);
  }
  return most;
}

// ---- 3D Tiles

void append_point(JsonText& json, Point3 p) { json.number(p.x).number(p.y).number(p.z); }

void append_box(JsonText& json, const geometry::Box3& box) {
  constexpr double margin = 0.002;  // metres; the JSON of a matrix and single precision are coarser than a double
  const Point3 half = 0.5 * (box.most - box.least) + Point3{margin, margin, margin};
  json.key("boundingVolume").begin_object().key("box").begin_array();
  append_point(json, 0.5 * (box.least + box.most));
  for (const Point3 axis : {Point3{half.x, 0, 0}, Point3{0, half.y, 0}, Point3{0, 0, half.z}}) append_point(json, axis);
  json.end_array().end_object();
}

void widen(Box3& box, const Box3& by) {
  if (by.empty()) return;
  box.add(by.least);
  box.add(by.most);
}

/// Writes tiles from the leaves up.
class TerrainTiles {
 public:
  TerrainTiles(std::filesystem::path folder, const Mesh& terrain, const Mesh& below, const Header& header,
               const WriteOptions& options, const std::optional<crs::Globe>& globe)
      : folder_(std::move(folder)),
        all_(joined(terrain, below)),
        shown_(static_cast<std::uint32_t>(terrain.triangles.size())),
        most_(std::max<std::size_t>(1, static_cast<std::size_t>(options.tile_triangles))),
        offset_(options.tiles_height_offset),
        header_(header),
        globe_(globe) {}

  auto write() -> base::Result<void> {
    const auto whole = Box3::of(all_.vertices);
    if (!whole.empty())
      place_.origin = {(whole.least.x + whole.most.x) / 2, (whole.least.y + whole.most.y) / 2, whole.least.z + offset_};
    if (globe_) {
      auto there = globe_->place(place_.origin);
      if (!there) return there.failure();
      place_ = *there;
    }
    std::error_code failure;
    std::filesystem::create_directories(folder_ / "tiles", failure);
    std::vector<std::uint32_t> order(all_.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    auto root = tile(order);
    if (!root) return root.failure();
    if (root->box.empty()) root->box.add({0, 0, 0});
    const double diagonal = std::ceil(length(root->box.most - root->box.least));
    JsonText json;
    json.begin_object().key("asset").begin_object().key("version").text("1.1").key("extras").begin_object();
    json.key("generator")
        .text("mansard " + header_.made_by.version)
        .key("crs")
        .text(header_.frame.crs)
        .end_object()
        .end_object();
    json.line().key("geometricError").number(std::max(diagonal, root->error)).line().key("root").begin_object();
    append_tile(json, *root);
    json.key("refine").text("REPLACE").key("transform").begin_array();
    for (const Point3 axis : {place_.east, place_.north, place_.up}) {
      append_point(json, axis);
      json.number(0);
    }
    append_point(json, place_.origin);
    json.number(1).end_array().end_object().line().end_object();
    return base::write_file(folder_ / "tileset.json", std::move(json).str() + "\n");
  }

 private:
  struct Tile {
    Mesh mesh;  ///< in the local frame
    Box3 box;   ///< of all that is in it and below it, in the frame of the tileset
    double error = 0;
    std::string uri;   ///< nothing where it shows nothing
    std::string json;  ///< of its children
  };

  /// The two halves of some triangles along the longer side of the box of their middles.
  [[nodiscard]] auto halves(std::span<std::uint32_t> triangles) const -> std::array<std::span<std::uint32_t>, 2> {
    const auto middle = [&](std::uint32_t t) {
      const auto& c = all_.triangles[t];
      return xy(all_.vertices[c[0]]) + xy(all_.vertices[c[1]]) + xy(all_.vertices[c[2]]);
    };
    Box2 box;
    for (const auto t : triangles) box.add(middle(t));
    const bool wide = box.most.x - box.least.x >= box.most.y - box.least.y;
    std::ranges::sort(triangles, {}, [&](std::uint32_t t) {
      const auto at = middle(t);
      return std::tuple(wide ? at.x : at.y, wide ? at.y : at.x, t);
    });
    return {triangles.first(triangles.size() / 2), triangles.subspan(triangles.size() / 2)};
  }

  auto tile(std::span<std::uint32_t> triangles) -> base::Result<Tile> {
    Tile out;
    if (triangles.size() <= most_) {
      std::ranges::sort(triangles);
      const auto shown = std::ranges::lower_bound(triangles, shown_) - triangles.begin();
      if (auto done = show(geometry::part_of(all_, triangles.first(static_cast<std::size_t>(shown))), out); !done)
        return done.failure();
      out.mesh = geometry::part_of(all_, triangles);
      return out;
    }
    JsonText json;
    json.begin_array();
    for (const auto half : halves(triangles))
      for (const auto quarter : half.size() > most_ ? halves(half) : std::array{half, half.first(0)}) {
        if (quarter.empty()) continue;
        auto child = tile(quarter);
        if (!child) return child.failure();
        json.line().begin_object();
        append_tile(json, *child);
        json.end_object();
        widen(out.box, child->box);
        out.error = std::max(out.error, child->error);
        out.mesh = joined(out.mesh, child->mesh);
      }
    out.json = std::move(json.end_array()).str();
    // A quarter: a level that is hardly smaller than the next one would cost more than it saves.
    auto coarse = simplified(without_steps(out.mesh), std::min(most_, out.mesh.triangles.size() / 4));
    out.error += vertical_distance(out.mesh, coarse);
    out.mesh = std::move(coarse);
    if (auto done = show(out.mesh, out); !done) return done.failure();
    return out;
  }

  /// Writes the content of a tile.
  auto show(Mesh mesh, Tile& tile) -> base::Result<void> {
    if (mesh.triangles.empty()) return {};
    for (auto& v : mesh.vertices) v.z += offset_;
    if (globe_)
      if (auto done = globe_->to_earth(mesh.vertices); !done) return done;
    for (auto& v : mesh.vertices) v = place_.inside(v);
    widen(tile.box, Box3::of(mesh.vertices));
    tile.uri = "tiles/terrain-" + std::to_string(written_++) + ".glb";
    const auto bytes = terrain_glb(mesh, header_.made_by.version, {});
    if (!bytes) return bytes.failure();
    return base::write_file(folder_ / tile.uri, *bytes);
  }

  /// Its members.
  static void append_tile(JsonText& json, const Tile& tile) {
    append_box(json, tile.box);
    json.key("geometricError").number(std::ceil(tile.error * 1000) / 1000);
    if (!tile.uri.empty()) json.key("content").begin_object().key("uri").text(tile.uri).end_object();
    if (!tile.json.empty()) json.key("children").raw(tile.json);
  }

  const std::filesystem::path folder_;
  const Mesh all_;
  const std::uint32_t shown_;  ///< triangles that leaves show; those below buildings come after them
  const std::size_t most_;
  const double offset_;
  const Header& header_;
  const std::optional<crs::Globe>& globe_;
  crs::Place place_;
  std::size_t written_ = 0;
};

}  // namespace

auto write_terrain_tiles(const std::filesystem::path& folder, const Mesh& terrain, const Mesh& below,
                         const Header& header, const WriteOptions& options, const std::optional<crs::Globe>& globe)
    -> base::Result<void> {
  return TerrainTiles(folder, terrain, below, header, options, globe).write();
}

}  // namespace mansard::formats::detail
