#include "mansard/formats/cityjson/cityjson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/plans/plan_text.hpp"

namespace mansard::formats::detail {
namespace {

using model::FaceClass;

/// The name of the textures: a file may have several sets of them.
constexpr std::string_view texture_theme = "visual";

auto degrees(double radians) -> double { return radians * 180 / std::numbers::pi; }

/// A real number with two decimals, without the trailing noise of rounding.
auto hundredths(double value) -> std::string { return base::to_text(value, 2); }

/// The semantic object of a roof with that normal: slope, the angle from the horizontal, and azimuth, the compass
/// direction it looks to, both in degrees; a flat roof has no azimuth.
auto roof_semantics(const Surface& surface, std::int64_t origin) -> std::string {
  const geometry::Point3 n = surface.normal;
  JsonText json;
  const double slope = degrees(std::atan2(std::hypot(n.x, n.y), n.z));
  json.begin_object().key("type").text("RoofSurface").key("ms_slope").raw(hundredths(slope));
  if (slope >= 0.5) {
    const double azimuth = degrees(std::atan2(n.x, n.y));
    const std::string text = hundredths(azimuth < 0 ? azimuth + 360 : azimuth);
    json.key("ms_azimuth").raw(text == "360.00" ? "0.00" : text);
  }
  const auto roof = solid_of({surface});
  const auto [low, high] = std::ranges::minmax(roof.solid.vertices, {}, &geometry::Point3::z);
  const auto height = [&](const char* name, double z) {
    json.key(name).raw(base::to_text(z + static_cast<double>(origin), 4));
  };
  height("ms_h_roof_min", low.z);
  height("ms_h_roof_50p", solid::roof_percentile(roof, 0.5));
  height("ms_h_roof_70p", solid::roof_percentile(roof, 0.7));
  height("ms_h_roof_max", high.z);
  return std::move(json.end_object()).str();
}

/// The semantic object of a surface; `origin` is the height of the frame's origin.
auto semantics_of(const Surface& surface, std::int64_t origin) -> std::string {
  JsonText json;
  json.begin_object().key("type");
  switch (surface.kind) {
    case FaceClass::wall: json.text("WallSurface").key("ms_party_wall").flag(false); break;
    case FaceClass::party_wall: json.text("WallSurface").key("ms_party_wall").flag(true); break;
    case FaceClass::ground: json.text("GroundSurface"); break;
    case FaceClass::soffit: json.text("OuterCeilingSurface"); break;
    case FaceClass::roof: return roof_semantics(surface, origin);
  }
  return std::move(json.end_object()).str();
}

/// "28992" of "EPSG:28992"; empty for anything else, which a referenceSystem cannot name.
auto epsg_code(std::string_view crs) -> std::string {
  constexpr std::string_view prefix = "EPSG:";
  if (!crs.starts_with(prefix)) return {};
  const auto code = base::to_integer(crs.substr(prefix.size()));
  return code && *code > 0 ? std::to_string(*code) : std::string();
}

void append_transform(JsonText& json, const model::Frame& frame) {
  json.key("transform").begin_object().key("scale").begin_array();
  for (int axis = 0; axis < 3; ++axis) json.raw(base::to_text(1 / quanta_per_metre, 4));
  json.end_array().key("translate").begin_array();
  for (const auto metres : frame.origin) json.real(static_cast<double>(metres));
  json.end_array().end_object();
}

void append_extent(JsonText& json, const model::Frame& frame, const Extent& extent) {
  if (!extent) return;
  json.key("geographicalExtent").begin_array();
  for (const Vertex& corner : *extent)
    for (std::size_t axis = 0; axis < 3; ++axis) json.raw(quanta_in_file_frame(corner[axis], frame.origin[axis]));
  json.end_array();
}

void widen(Extent& extent, const Loops& loops) {
  for (const auto& loop : loops)
    for (const Vertex& v : loop) detail::widen(extent, v);
}

void append_metadata(JsonText& json, const model::Frame& frame, const CityJsonOptions& options, const Extent& extent) {
  json.key("metadata").begin_object();
  append_extent(json, frame, extent);
  if (!options.title.empty()) json.key("title").text(options.title);
  if (!options.date.empty()) json.key("referenceDate").text(options.date);
  if (!options.contact.empty()) {
    json.key("pointOfContact").begin_object().key("contactName").text(options.contact);
    json.key("emailAddress").text(options.email).end_object();
  }
  if (const std::string code = epsg_code(frame.crs); !code.empty())
    json.key("referenceSystem").text("https://www.opengis.net/def/crs/EPSG/0/" + code);
  json.end_object();
}

/// What a plan or a footprint is relative to: a tool that moves the city model to another origin does not know of them.
void append_origin(JsonText& json, const model::Frame& frame) {
  json.key("origin").begin_array();
  for (const auto metres : frame.origin) json.whole(metres);
  json.end_array();
}

/// Without those of our names, which say more.
auto without(const model::Attributes& attributes, std::initializer_list<std::string_view> names) -> model::Attributes {
  model::Attributes kept;
  for (const auto& [name, value] : attributes)
    if (std::ranges::find(names, name) == names.end()) kept.emplace_back(undeclared(name), value);
  return kept;
}

}  // namespace

auto undeclared(const std::string& name) -> std::string {
  const auto start = name.find_first_not_of('_');
  return start != std::string::npos && name[start] == '+' ? "_" + name : name;
}

auto from_undeclared(const std::string& name) -> std::string {
  return name.starts_with('_') && undeclared(name) != name ? name.substr(1) : name;
}

auto CityObjects::footprint_of(const model::Building& building, const std::vector<Shape>& shapes)
    -> std::vector<Loops> {
  std::vector<Loops> footprint;
  for (const auto& polygon : building.footprint)
    if (auto loops = quantised(polygon, building.ground); !loops.empty()) footprint.push_back(std::move(loops));
  if (std::ranges::all_of(footprint, is_sound)) return footprint;
  footprint.clear();  // a surveyed polygon that no validator accepts: the ground of the models instead
  for (const Shape& shape : shapes)
    for (const Surface& surface : shape.fine)
      if (surface.kind == FaceClass::ground) {
        auto& loops = footprint.emplace_back(surface.loops);
        for (auto& loop : loops) std::ranges::reverse(loop);
      }
  return footprint;
}

auto TextureVertices::index_of(std::array<double, 2> uv) -> std::int64_t {
  // From the lower left corner, as in CityGML.
  sink_.append((count_ > 0 ? ",[" : "[") + base::to_text(uv[0], 6) + "," + base::to_text(1 - uv[1], 6) + "]");
  return count_++;
}

auto TextureVertices::number_of(std::uint32_t page) -> std::int64_t {
  if (!local_)
    while (pages_.size() <= page) pages_.push_back(static_cast<std::uint32_t>(pages_.size()));
  const auto [entry, added] = numbers_.try_emplace(page, local_ ? static_cast<std::int64_t>(numbers_.size()) : page);
  if (added && local_) pages_.push_back(page);
  return entry->second;
}

auto appearance_head(const TextureVertices& vertices, const TextureFolder& folder) -> JsonText {
  JsonText json;
  json.begin_object().key("default-theme-texture").text(texture_theme).key("textures").begin_array();
  for (const auto page : vertices.pages()) {
    json.begin_object().key("type").text("JPG").key("image").text(folder.name(page));
    json.key("wrapMode").text("clamp").key("textureType").text("specific").end_object();
  }
  json.end_array().key("vertices-texture").begin_array();
  return json;
}

void CityObjects::add(const model::Building& building, const Gate::Keyed& keys, std::vector<base::Diagnostic>& warnings,
                      const TexturedSolids* textured) {
  const Drawn solids = drawn(building, keys, solids_);
  textured_ = uv_ != nullptr && textures_for(building, solids.solids.size()) != nullptr ? textured : nullptr;
  warnings.insert(warnings.end(), solids.warnings.begin(), solids.warnings.end());
  std::vector<Shape> shapes;
  auto all = level_surfaces(solids, frame_, lods_, levels_);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [part, parts] = solids.solids[i];
    auto& levels = all[i];
    const bool own = part.id == keys.building || (parts.size() == 1 && part.id == keys.parts[parts.front()]);
    const bool asks = std::ranges::find(lods_, Lod::lod12) != lods_.end();
    if (asks && levels.lod12.empty() &&
        std::ranges::find(part.model.classes, FaceClass::roof) != part.model.classes.end())
      warnings.push_back(
          base::warning("solid-left-out", "no valid solid of LoD 1.2 can be made of its ground", building.id));
    const std::size_t solid = textured_ != nullptr ? textured_->first + shapes.size() : 0;
    Shape& shape = shapes.emplace_back(Shape{part.id, {}, quantised(part.model), std::move(levels), solid});
    if (!own)
      for (const std::size_t p : parts) shape.of.push_back(keys.parts[p]);
  }
  const bool has_footprint = std::ranges::find(lods_, Lod::lod0) != lods_.end();
  const auto footprint = has_footprint ? footprint_of(building, shapes) : std::vector<Loops>();
  Extent extent;  // of the building with its parts, whose objects come after its own
  for (const auto& loops : footprint) widen(extent, loops);
  for (const auto& shape : shapes)
    for (const auto lod : lods_)
      if (lod != Lod::lod0)
        for (const Surface& surface : shape.levels.at(lod)) widen(extent, surface.loops);

  json_.line(level_).key(keys.building).begin_object().key("type").text("Building");
  append_extent(json_, frame_, extent);
  append_attributes(json_.key("attributes").begin_object(), without(building.attributes, {footprint_name}));
  append_origin(json_.key(footprint_name).begin_object(), frame_);
  detail::append_footprint(json_.key("ground").number(building.ground).key("polygons"), building.footprint);
  json_.end_object().end_object();
  std::vector<const Shape*> more;  // pieces that are no part
  const Shape* own = nullptr;
  for (const Shape& shape : shapes) {
    if (shape.key == keys.building) own = &shape;
    else if (std::ranges::find(keys.parts, shape.key) == keys.parts.end()) more.push_back(&shape);
  }
  if (!keys.parts.empty()) {
    json_.key("children").begin_array();
    for (const auto& key : keys.parts) json_.text(key);
    for (const Shape* shape : more) json_.text(shape->key);
    json_.end_array();
  }
  json_.key("geometry").begin_array();
  append_footprint(footprint);
  if (own != nullptr) append_solids(*own);
  json_.end_array().end_object();
  for (std::size_t p = 0; p < building.parts.size(); ++p) {
    const auto shape = std::ranges::find(shapes, keys.parts[p], &Shape::key);
    append_part(keys.parts[p], &building.parts[p], shape == shapes.end() ? nullptr : &*shape, keys.building);
  }
  for (const Shape* shape : more) append_part(shape->key, nullptr, shape, keys.building);
}

auto CityObjects::end() -> std::string {
  json_.line(level_).end_object();
  return json_.take();
}

void CityObjects::append_footprint(const std::vector<Loops>& surfaces) {
  if (surfaces.empty()) return;
  json_.begin_object().key("type").text("MultiSurface").key("lod").text("0").key("boundaries").begin_array();
  for (const auto& loops : surfaces) append_loops(loops);
  json_.end_array().end_object();
}

void CityObjects::append_part(const std::string& key, const model::Part* part, const Shape* shape,
                              const std::string& parent) {
  json_.line(level_).key(key).begin_object().key("type").text("BuildingPart");
  const bool joined = shape != nullptr && !shape->of.empty();
  if (part != nullptr || joined) json_.key("attributes").begin_object();
  if (part != nullptr) {
    append_attributes(json_, without(part->attributes, {plan_name, old_plan_name, solid_of_name}));
    json_.key(plan_name).begin_object().key("type").text(plan_type).key("version").whole(plan_version);
    append_origin(json_, frame_);
    append_plan(json_, part->plan);
    json_.end_object();
  }
  if (joined) {
    json_.key(solid_of_name).begin_array();
    for (const auto& name : shape->of) json_.text(name);
    json_.end_array();
  }
  if (part != nullptr || joined) json_.end_object();
  json_.key("parents").begin_array().text(parent).end_array();
  if (shape != nullptr) {
    json_.key("geometry").begin_array();
    append_solids(*shape);
    json_.end_array();
  }
  json_.end_object();
}

void CityObjects::append_solids(const Shape& shape) {
  for (const auto lod : lods_)  // pictures are of the faces of LoD 2.2
    if (lod != Lod::lod0)
      append_solid(name_of(lod), shape.levels.at(lod), shape.solid, lod == Lod::lod22 ? textured_ : nullptr);
}

void CityObjects::append_texture(const std::vector<Surface>& surfaces, std::size_t solid,
                                 const TexturedSolids& textured) {
  const auto metres = [](std::int64_t quanta) { return static_cast<double>(quanta) / quanta_per_metre; };
  json_.key("texture").begin_object().key(texture_theme).begin_object().key("values").begin_array().begin_array();
  for (const Surface& surface : surfaces) {
    const auto page = uv_->number_of(textured.first_page + textured.atlas->page_of(solid, surface.face));
    json_.begin_array();
    for (const auto& loop : surface.loops) {
      json_.begin_array().whole(page);
      for (const Vertex& v : loop)
        json_.whole(uv_->index_of(textured.atlas->uv(solid, surface.face, {metres(v[0]), metres(v[1]), metres(v[2])})));
      json_.end_array();
    }
    json_.end_array();
  }
  json_.end_array().end_array().end_object().end_object();
}

void CityObjects::append_solid(std::string_view lod, const std::vector<Surface>& surfaces, std::size_t solid,
                               const TexturedSolids* textured) {
  if (surfaces.empty()) return;
  json_.begin_object().key("type").text("Solid").key("lod").text(lod);
  json_.key("boundaries").begin_array().begin_array();
  for (const Surface& surface : surfaces) append_loops(surface.loops);
  json_.end_array().end_array();

  std::map<std::string, std::size_t> index_of;
  std::vector<std::string> distinct;
  std::vector<std::size_t> values;
  for (const Surface& surface : surfaces) {
    const auto [entry, added] = index_of.try_emplace(semantics_of(surface, frame_.origin[2]), distinct.size());
    if (added) distinct.push_back(entry->first);
    values.push_back(entry->second);
  }
  json_.key("semantics").begin_object().key("surfaces").begin_array();
  for (const auto& object : distinct) json_.raw(object);
  json_.end_array().key("values").begin_array().begin_array();
  for (const auto value : values) json_.whole(static_cast<std::int64_t>(value));
  json_.end_array().end_array().end_object();
  if (textured != nullptr) append_texture(surfaces, solid, *textured);
  json_.end_object();
}

void CityObjects::append_loops(const Loops& loops) {
  json_.begin_array();
  for (const auto& loop : loops) {
    json_.begin_array();
    for (const Vertex& v : loop) json_.whole(static_cast<std::int64_t>(pool_.index_of(v)));
    json_.end_array();
  }
  json_.end_array();
}

auto cityjson_head(const Header& header, const CityJsonOptions& options, const Extent& extent, int level) -> JsonText {
  JsonText json;
  json.begin_object().key("type").text("CityJSON").key("version").text("2.0");
  json.line(level).key("extensions").begin_object().key(extension_name).begin_object();
  json.key("url").text(MANSARD_EXTENSION_URL).key("version").text(extension_version).end_object().end_object();
  append_transform(json.line(level), header.frame);
  append_metadata(json.line(level), header.frame, options, extent);
  // The core's metadata are six; how the file was made is a member of the extension.
  append_made_by(json.line(level).key("+mansard").begin_object().key("made_by"), header.made_by);
  append_frame(json.key("frame"), header.frame);
  if (!options.lineage.empty()) json.key("lineage").text(options.lineage);
  const bool fine = std::ranges::find(options.lods, Lod::lod22) != options.lods.end();
  json.key("solids").text(!fine ? "none" : options.solids == Solids::part ? "part" : "building");
  json.end_object().line(level).key("CityObjects");
  return json;
}

auto cityjson_feature(const model::Building& building, const Gate::Keyed& keys, const Header& header,
                      const CityJsonOptions& options, std::vector<base::Diagnostic>& warnings,
                      const TexturedSolids* textured, const TextureFolder* folder) -> std::string {
  base::TextSink vertices, coordinates;
  TextureVertices uv(coordinates, true);
  CityObjects objects(header, options, vertices, -1, &uv);
  objects.add(building, keys, warnings, textured);
  JsonText json;
  json.begin_object().key("type").text("CityJSONFeature").key("id").text(keys.building);
  json.key("CityObjects").raw(objects.end()).key("vertices").begin_array();
  if (!vertices.text.empty()) json.raw(vertices.text);
  json.end_array();
  if (uv.count() > 0 && folder != nullptr)
    json.key("appearance").raw(appearance_head(uv, *folder).take() + coordinates.text + "]}");
  return json.end_object().take() + "\n";
}

}  // namespace mansard::formats::detail
