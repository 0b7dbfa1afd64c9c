// 3D Tiles 1.1: https://docs.ogc.org/cs/22-025r4/22-025r4.html
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <optional>

#include "mansard/base/files.hpp"
#include "mansard/base/pack.hpp"
#include "mansard/crs/globe.hpp"
#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/foreign.hpp"
#include "mansard/formats/gltf/glb_bytes.hpp"
#include "mansard/formats/tiles3d/tiles_tree.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Box3;
using geometry::Point3;

/// Boxes are so much larger than what is in them: the JSON of a matrix and single precision are coarser than a double.
constexpr double margin = 0.002;  // metres

// ---- parts put aside

struct TilePart {
  Row row;
  std::string record;
  PartMesh mesh;
  std::optional<model::SolidTexture> texture{};  ///< of the faces of the mesh
};

template <class T>
void append_all(std::string& bytes, const std::vector<T>& values) {
  const auto count = static_cast<std::uint32_t>(values.size());
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
auto take_all(std::string_view& bytes) -> std::vector<T> {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data(), sizeof count);
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data() + sizeof count, count * sizeof(T));
  bytes.remove_prefix(sizeof count + count * sizeof(T));
  return values;
}

void append_part(std::string& bytes, const TilePart& part) {
  append_row(bytes, part.row);
  append_all(bytes, std::vector<char>(part.record.begin(), part.record.end()));
  append_all(bytes, part.mesh.vertices);
  append_all(bytes, part.mesh.indices);
  append_all(bytes, part.mesh.faces);
  const auto texture = base::packed(part.texture);
  append_all(bytes, std::vector<char>(texture.begin(), texture.end()));
}

auto take_part(std::string_view& bytes) -> TilePart {
  TilePart part;
  part.row = take_row(bytes);
  const auto record = take_all<char>(bytes);
  part.record.assign(record.begin(), record.end());
  part.mesh.vertices = take_all<Point3>(bytes);
  part.mesh.indices = take_all<std::uint32_t>(bytes);
  part.mesh.faces = take_all<FaceMesh>(bytes);
  const auto texture = take_all<char>(bytes);
  base::Unpacker from({texture.data(), texture.size()});
  (void)from.take(part.texture);  // as put aside: Spool::read has failed otherwise
  return part;
}

/// Of LoD 1.2: the mean colours of the finer model.
auto plain_texture(const PartMesh& mesh, const model::SolidTexture& fine) -> model::SolidTexture {
  model::SolidTexture out;
  for (const FaceMesh& face : mesh.faces) {
    auto& texture = out.faces.emplace_back();
    const auto& colour = face.kind == model::FaceClass::roof ? fine.roof : fine.wall;
    texture.frame.start = {0.5, 0.5};
    texture.pixels = {1, 1, {colour.begin(), colour.end()}};
  }
  return out;
}

// ---- one building

/// The roof and the walls of LoD 1.2; the model itself where it has no roof or no ground.
auto flat_mesh(const model::Part& part, const PartMesh& fine, const model::Frame& frame, TileItem& item)
    -> base::Result<PartMesh> {
  const auto height = flat_height(part, frame);
  if (!height) return fine;
  model::LabelledSolid flat = flat_model(part.model, *height), seen;
  if (flat.solid.faces.empty()) return fine;
  seen.solid.vertices = flat.solid.vertices;
  for (std::size_t f = 0; f < flat.classes.size(); ++f) {
    if (flat.classes[f] == model::FaceClass::ground) continue;
    seen.solid.faces.push_back(flat.solid.faces[f]);
    seen.classes.push_back(flat.classes[f]);
  }
  for (const FaceMesh& face : fine.faces)
    if (face.kind == model::FaceClass::roof)
      for (std::uint32_t v = 0; v < face.vertices; ++v)
        item.flat_error = std::max(item.flat_error, std::abs(fine.vertices[face.first_vertex + v].z - *height));
  return part_mesh(seen, part.id);
}

/// Where it lies and how large it is: by its models, else by its footprint.
void measure(TileItem& item, const model::Building& building, const std::vector<PartMesh>& meshes) {
  Box3 box;
  for (const auto& mesh : meshes) {
    item.triangles += static_cast<std::uint32_t>(mesh.indices.size() / 3);
    for (const Point3& v : mesh.vertices) box.add(v);
  }
  if (box.empty())
    for (const auto& polygon : building.footprint)
      for (const auto& p : polygon.outer) box.add({p.x, p.y, building.ground});
  if (box.empty()) box.add({0, 0, 0});
  const auto &least = box.least, &most = box.most;
  item.centre = {(least.x + most.x) / 2, (least.y + most.y) / 2};
  item.ground = least.z;
  item.height = most.z - least.z;
  item.volume = (most.x - least.x) * (most.y - least.y) * item.height;
}

// ---- the tileset

auto corners_of(const Box3& box) -> std::array<Point3, 8> {
  const auto &least = box.least, &most = box.most;
  std::array<Point3, 8> out;
  for (unsigned i = 0; i < 8; ++i)
    out[i] = {(i & 1U) != 0 ? most.x : least.x, (i & 2U) != 0 ? most.y : least.y, (i & 4U) != 0 ? most.z : least.z};
  return out;
}

void append_point(JsonText& json, Point3 p) { json.number(p.x).number(p.y).number(p.z); }

void append_box(JsonText& json, const Box3& box) {
  const Point3 half = 0.5 * (box.most - box.least) + Point3{margin, margin, margin};
  json.key("boundingVolume").begin_object().key("box").begin_array();
  append_point(json, 0.5 * (box.least + box.most));
  for (const Point3 axis : {Point3{half.x, 0, 0}, Point3{0, half.y, 0}, Point3{0, 0, half.z}}) append_point(json, axis);
  json.end_array().end_object();
}

/// From one frame into the one around it, column by column.
void append_transform(JsonText& json, const crs::Place& outer, const crs::Place& inner) {
  const auto turned = [&](Point3 axis) {
    return Point3{dot(axis, outer.east), dot(axis, outer.north), dot(axis, outer.up)};
  };
  json.key("transform").begin_array();
  for (const Point3 axis : {inner.east, inner.north, inner.up}) {
    append_point(json, turned(axis));
    json.number(0);
  }
  append_point(json, outer.inside(inner.origin));
  json.number(1).end_array();
}

auto name_of(const Tile& tile) -> std::string {
  std::string name = "root";
  for (const auto step : tile.path) name += "-" + std::to_string(step);
  return name + ".glb";
}

class TilesWriter : public CityWriter {
 public:
  TilesWriter(Path folder, Header header, const WriteOptions& options, std::optional<crs::Globe> globe,
              std::unique_ptr<base::Spool> aside)
      : folder_(std::move(folder)),
        header_(std::move(header)),
        options_(options),
        globe_(std::move(globe)),
        aside_(std::move(aside)) {}

  auto add(const model::Building& building) -> base::Result<void> override {
    const auto keyed = gate_.admit(building);
    if (!keyed) return keyed.error();
    TileItem item;
    std::vector<PartMesh> fine, flat;
    const Drawn solids = drawn(building, *keyed, options_.solids);
    warnings_.insert(warnings_.end(), solids.warnings.begin(), solids.warnings.end());
    for (const auto& [part, parts] : solids.solids) {
      auto mesh = part_mesh(part.model, part.id);
      if (!mesh) return mesh.error();
      auto coarse = flat_mesh(part, *mesh, header_.frame, item);
      if (!coarse) return coarse.error();
      item.flat_triangles += static_cast<std::uint32_t>(coarse->indices.size() / 3);
      for (PartMesh* one : {&*mesh, &*coarse})
        for (Point3& v : one->vertices) v.z += options_.tiles_height_offset;
      fine.push_back(std::move(*mesh));
      flat.push_back(std::move(*coarse));
    }
    measure(item, building, fine);
    put_aside(item, building, *keyed, solids, std::move(fine), std::move(flat));
    items_.push_back(item);
    return {};
  }

  auto finish() -> base::Result<void> override {
    columns_.settle();
    tree_ = tile_tree(items_, options_.tile_triangles);
    made_.resize(tree_.tiles.size());
    parents_.resize(tree_.tiles.size());
    for (std::size_t t = 0; t < tree_.tiles.size(); ++t)
      for (const std::size_t child : tree_.tiles[t].children) parents_[child] = t;
    for (std::size_t t = 0; t < tree_.tiles.size(); ++t)
      if (auto placed = place(t); !placed) return placed;
    std::error_code failure;
    std::filesystem::create_directories(folder_ / "tiles", failure);
    for (std::size_t t = tree_.tiles.size(); t-- > 0;)  // children before their parents
      if (auto written = write_tile(t); !written) return written;
    return base::write_file(folder_ / "tileset.json", tileset());
  }
  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override {
    auto all = globe_ ? globe_->warnings() : std::vector<base::Diagnostic>();
    all.insert(all.end(), warnings_.begin(), warnings_.end());
    if (globe_ && globe_->heights() == crs::Globe::Heights::not_of_the_crs && options_.tiles_height_offset == 0)
      all.push_back(base::warning(
          "write-tiles-height",
          "the coordinate system says nothing of heights, which 3D Tiles have above the ellipsoid: on a globe the "
          "models "
          "may be as far above or below the terrain as the geoid is high there; give that with --tiles-height-offset"));
    return all;
  }

 private:
  struct Made {
    crs::Place place;
    Box3 box;  ///< along the axes of the tile
    double error = 0;
    bool content = false;
    std::string json;  ///< with its children; until its parent is made
  };

  void put_aside(TileItem& item, const model::Building& building, const Gate::Keyed& keyed, const Drawn& solids,
                 std::vector<PartMesh> fine, std::vector<PartMesh> flat) {
    const auto order = static_cast<std::int64_t>(items_.size());
    std::vector<Row> rows;
    for (const auto& [part, parts] : solids.solids)
      rows.push_back(columns_.row(building, keyed.building, order, &part, part.id));
    if (rows.empty()) {
      rows.push_back(columns_.row(building, keyed.building, order, nullptr, {}));
      fine.resize(1);
      flat.resize(1);
    }
    item.fine = aside_->size();
    std::string bytes;
    const auto* texture = textures_for(building, solids.solids.size());
    const auto of_part = [&](std::size_t p) -> std::optional<model::SolidTexture> {
      return texture != nullptr && p < texture->solids.size() ? std::optional(texture->solids[p]) : std::nullopt;
    };
    for (std::size_t p = 0; p < rows.size(); ++p)
      append_part(bytes, {rows[p], p == 0 && !is_foreign(header_) ? building_record(building) : "", std::move(fine[p]),
                          of_part(p)});
    item.coarse = item.fine + bytes.size();
    for (std::size_t p = 0; p < rows.size(); ++p) {
      auto plain = of_part(p);
      if (plain) plain = plain_texture(flat[p], *plain);
      append_part(bytes, {rows[p], {}, std::move(flat[p]), std::move(plain)});
    }
    aside_->append(bytes);
    item.end = aside_->size();
  }

  auto place(std::size_t t) -> base::Result<void> {
    const Tile& tile = tree_.tiles[t];
    if (tile.count == 0) return {};
    geometry::Box2 centres;
    double ground = std::numeric_limits<double>::infinity();
    for (std::size_t i = tile.first; i < tile.first + tile.count; ++i) {
      const TileItem& item = items_[tree_.order[i]];
      centres.add(item.centre);
      ground = std::min(ground, item.ground);
    }
    const Point3 centre{(centres.least.x + centres.most.x) / 2, (centres.least.y + centres.most.y) / 2, ground};
    made_[t].place.origin = centre;
    if (!globe_) return {};
    auto place = globe_->place(centre);
    if (!place) return place.error();
    made_[t].place = *place;
    // Which way the local axes point there: grid north is not north.
    std::vector<Point3> ends{centre, centre + Point3{10, 0, 0}, centre + Point3{0, 10, 0}, centre + Point3{0, 0, 10}};
    if (auto done = globe_->to_earth(ends); !done) return done;
    made_[t].box = {};
    axes_.resize(made_.size());
    for (std::size_t axis = 0; axis < 3; ++axis)
      axes_[t][axis] = geometry::normalised(place->inside(ends[axis + 1]) - place->inside(ends[0]));
    return {};
  }

  /// The buildings of a tile, and how far it is from what it stands for: the largest vertical difference.
  auto chosen(const Tile& tile, double& error) const -> std::vector<std::uint32_t> {
    const auto first = tree_.order.begin() + static_cast<std::ptrdiff_t>(tile.first);
    std::vector<std::uint32_t> all(first, first + static_cast<std::ptrdiff_t>(tile.count));
    if (!tile.children.empty()) {
      std::ranges::sort(all, [&](auto a, auto b) {
        return items_[a].volume != items_[b].volume ? items_[a].volume > items_[b].volume : a < b;
      });
      double triangles = 0;
      std::size_t kept = 0;
      for (; kept < all.size(); ++kept) {
        triangles += items_[all[kept]].flat_triangles;
        if (kept > 0 && triangles > options_.tile_triangles) break;
        error = std::max(error, items_[all[kept]].flat_error);
      }
      for (std::size_t i = kept; i < all.size(); ++i) error = std::max(error, items_[all[i]].height);
      all.resize(kept);
    }
    std::ranges::sort(all);
    return all;
  }

  /// The parts of a building in a tile.
  auto parts_of(std::size_t t, std::uint32_t number) -> base::Result<std::vector<TilePart>> {
    const bool leaf = tree_.tiles[t].children.empty();
    const TileItem& item = items_[number];
    const std::uint64_t from = leaf ? item.fine : item.coarse, to = leaf ? item.coarse : item.end;
    const auto bytes = aside_->read(from, static_cast<std::size_t>(to - from));
    if (!bytes) return bytes.error();
    std::vector<TilePart> parts;
    for (std::string_view rest = *bytes; !rest.empty();) parts.push_back(take_part(rest));
    return parts;
  }

  auto add_parts(GltfFile& file, std::size_t t, const std::vector<TilePart>& parts, const TexturedSolids& textured)
      -> base::Result<void> {
    std::size_t solid = 0;
    for (const TilePart& part : parts) {
      PartTexture texture;
      if (part.texture) texture = part_texture(part.mesh, textured, solid++);
      std::vector<Point3> places = part.mesh.vertices, facing;
      if (globe_)
        if (auto done = globe_->to_earth(places); !done) return done;
      for (Point3& p : places) p = made_[t].place.inside(p);
      for (const FaceMesh& face : part.mesh.faces) {
        const Point3 n = face.normal;
        facing.push_back(globe_ ? n.x * axes_[t][0] + n.y * axes_[t][1] + n.z * axes_[t][2] : n);
      }
      file.add_part(part.row, part.record, part.mesh, places, facing, part.texture ? &texture : nullptr);
    }
    return {};
  }

  auto write_tile(std::size_t t) -> base::Result<void> {
    const Tile& tile = tree_.tiles[t];
    Made& made = made_[t];
    for (const std::size_t child : tile.children) made.error = std::max(made.error, made_[child].error);
    const auto buildings = chosen(tile, made.error);
    auto file = GltfFile::open(gltf_options(options_));
    if (!file) return file.error();
    std::vector<TilePart> parts;
    for (const auto number : buildings) {
      auto own = parts_of(t, number);
      if (!own) return own.failure();
      std::ranges::move(*own, std::back_inserter(parts));
    }
    SolidAtlas atlas(static_cast<std::uint32_t>(options_.atlas_size));
    for (const TilePart& part : parts)
      if (part.texture) (void)atlas.add(*part.texture);
    atlas.settle();
    const auto images = (*file)->add_images(atlas);
    if (!images) return images.failure();
    if (auto added = add_parts(**file, t, parts, {&atlas, 0, *images}); !added) return added;
    (*file)->end_mesh("buildings");
    if (const auto& bounds = (*file)->bounds())  // z up again
      for (const Float3& p : *bounds) made.box.add({p[0], -static_cast<double>(p[2]), p[1]});
    for (const std::size_t child : tile.children)
      for (const Point3& corner : corners_of(made_[child].box))
        made.box.add(made.place.inside(made_[child].place.outside(corner)));
    if (made.box.empty()) made.box.add({0, 0, 0});
    made.content = !buildings.empty();
    if (made.content) {
      base::TextSink sink;
      if (auto written = (*file)->write(sink, "mansard " + header_.made_by.version, {}, columns_); !written)
        return written;
      if (auto written = base::write_file(folder_ / "tiles" / name_of(tile), sink.text); !written) return written;
    }
    made.json = tile_json(t);
    return {};
  }

  auto tile_json(std::size_t t) -> std::string {
    const Tile& tile = tree_.tiles[t];
    JsonText json;
    json.begin_object();
    if (t != 0) append_transform(json, made_[parents_[t]].place, made_[t].place);
    append_box(json, made_[t].box);
    json.key("geometricError").number(std::ceil(made_[t].error * 1000) / 1000);
    if (t == 0) json.key("refine").text("REPLACE");
    if (t == 0) append_transform(json, {}, made_[t].place);
    if (made_[t].content) json.key("content").begin_object().key("uri").text("tiles/" + name_of(tile)).end_object();
    if (!tile.children.empty()) json.key("children").begin_array();
    for (const std::size_t child : tile.children) {
      json.line().raw(made_[child].json);
      made_[child].json = {};
    }
    if (!tile.children.empty()) json.end_array();
    return std::move(json.end_object()).str();
  }

  auto tileset() const -> std::string {
    const Box3& box = made_[0].box;
    using enum crs::Globe::Heights;
    const char* heights =
        !globe_ ? "There is no coordinate system: the tileset is in the local frame, not on Earth."
        : globe_->heights() == of_the_crs ? "Heights are those of the coordinate system."
        : globe_->heights() == without_geoid
            ? "There was no geoid for the heights of the coordinate system: they are taken as heights above the "
              "ellipsoid of WGS 84."
            : "The coordinate system has no heights: they are taken as heights above the ellipsoid of WGS 84.";
    std::string all = heights;
    if (options_.tiles_height_offset != 0)
      all += " " + base::to_text(options_.tiles_height_offset) + " m were added to them.";
    JsonText json;
    json.begin_object().key("asset").begin_object().key("version").text("1.1").key("extras");
    append_file_extras(json.begin_object(), header_);
    json.key("generator").text("mansard " + header_.made_by.version).key("heights").text(all);
    json.end_object().end_object();
    // Without the tileset, all of it is missing.
    json.line().key("geometricError").number(std::ceil(length(box.most - box.least)));
    json.line().key("root").raw(made_[0].json).line().end_object();
    return std::move(json).str() + "\n";
  }

  Path folder_;
  Header header_;
  WriteOptions options_;
  std::optional<crs::Globe> globe_;
  std::unique_ptr<base::Spool> aside_;
  Gate gate_;
  PartColumns columns_;
  std::vector<TileItem> items_;
  std::vector<base::Diagnostic> warnings_;
  TileTree tree_;
  std::vector<Made> made_;
  std::vector<std::size_t> parents_;         ///< of tiles; nothing for the root
  std::vector<std::array<Point3, 3>> axes_;  ///< of the local frame, in the tile's
};

}  // namespace

auto tiles_writer(const Path& folder, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  auto globe = crs::Globe::of(header.frame);
  if (!globe) return globe.error();
  auto aside = base::Spool::open();
  if (!aside) return aside.error();
  auto place = outputs.folder(folder);
  if (!place) return place.error();
  return std::unique_ptr<CityWriter>(
      std::make_unique<TilesWriter>(*place, header, options, std::move(*globe), std::move(*aside)));
}

}  // namespace mansard::formats::detail
