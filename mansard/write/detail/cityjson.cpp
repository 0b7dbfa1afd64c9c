#include "mansard/write/detail/cityjson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <unordered_map>

#include "mansard/base/text.hpp"
#include "mansard/write/detail/quantised.hpp"

namespace mansard::write::detail {
namespace {

using label::Class;

/// Vertices by their integer coordinates: only those that some surface names, each once, numbered as first named.
class VertexPool {
 public:
  auto index_of(const Vertex& v) -> std::size_t {
    const auto [entry, added] = index_.try_emplace(v, vertices_.size());
    if (added) vertices_.push_back(v);
    return entry->second;
  }
  [[nodiscard]] auto vertices() const -> const std::vector<Vertex>& { return vertices_; }

 private:
  struct Hash {
    auto operator()(const Vertex& v) const -> std::size_t {
      std::uint64_t h = 0;
      for (const auto c : v) h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL, h ^= h >> 29U;
      return h;
    }
  };
  std::unordered_map<Vertex, std::size_t, Hash> index_;
  std::vector<Vertex> vertices_;
};

auto degrees(double radians) -> double { return radians * 180 / std::numbers::pi; }

/// A real number with two decimals, without the trailing noise of rounding.
auto hundredths(double value) -> std::string { return base::to_text(value, 2); }

/// The semantic object of a surface. Slope is the angle from the horizontal, azimuth the compass direction the surface
/// looks to, both in degrees; a flat roof has no azimuth.
auto semantics_of(const Surface& surface) -> std::string {
  JsonText json;
  json.begin_object().key("type");
  switch (surface.kind) {
    case Class::wall: json.text("WallSurface").key("ms_party_wall").flag(false); break;
    case Class::party_wall: json.text("WallSurface").key("ms_party_wall").flag(true); break;
    case Class::ground: json.text("GroundSurface"); break;
    case Class::soffit: json.text("OuterCeilingSurface"); break;
    case Class::roof: {
      const auto& n = surface.normal;
      const double slope = degrees(std::atan2(std::hypot(n.x, n.y), n.z));
      json.text("RoofSurface").key("ms_slope").raw(hundredths(slope));
      if (slope >= 0.5) {
        const double azimuth = degrees(std::atan2(n.x, n.y));
        const std::string text = hundredths(azimuth < 0 ? azimuth + 360 : azimuth);
        json.key("ms_azimuth").raw(text == "360.00" ? "0.00" : text);
      }
      break;
    }
  }
  return std::move(json.end_object()).str();
}

class Text {
 public:
  Text(const City& city, const Keys& keys) : city_(city), keys_(keys) {}

  auto all() -> std::string {
    objects_.begin_object();
    for (std::size_t b = 0; b < city_.buildings.size(); ++b) {
      append_building(b);
      for (std::size_t p = 0; p < city_.buildings[b].parts.size(); ++p) append_part(b, p);
    }
    objects_.line().end_object();

    JsonText json;
    json.begin_object().key("type").text("CityJSON").key("version").text("2.0");
    append_transform(json.line());
    append_metadata(json.line());
    json.line().key("CityObjects").raw(objects_.str());
    json.line().key("vertices").begin_array();
    for (const Vertex& v : pool_.vertices()) json.begin_array().whole(v[0]).whole(v[1]).whole(v[2]).end_array();
    json.end_array().line().end_object();
    return std::move(json).str() + "\n";
  }

 private:
  void append_transform(JsonText& json) const {
    json.key("transform").begin_object().key("scale").begin_array();
    for (int axis = 0; axis < 3; ++axis) json.raw(base::to_text(1 / quanta_per_metre, 4));
    json.end_array();
    json.key("translate").begin_array();
    for (const auto metres : city_.frame.origin) json.real(static_cast<double>(metres));
    json.end_array().end_object();
  }

  /// How the file was made stands among the metadata, whose schema is open, rather than in an extension: an extension
  /// must be downloadable by whoever validates the file.
  void append_metadata(JsonText& json) const {
    json.key("metadata").begin_object();
    if (const auto& vertices = pool_.vertices(); !vertices.empty()) {
      Vertex least = vertices.front(), most = vertices.front();
      for (const Vertex& v : vertices)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          least[axis] = std::min(least[axis], v[axis]);
          most[axis] = std::max(most[axis], v[axis]);
        }
      json.key("geographicalExtent").begin_array();
      for (const Vertex& corner : {least, most})
        for (std::size_t axis = 0; axis < 3; ++axis)
          json.raw(quanta_in_file_frame(corner[axis], city_.frame.origin[axis]));
      json.end_array();
    }
    if (const std::string code = epsg_code(); !code.empty())
      json.key("referenceSystem").text("https://www.opengis.net/def/crs/EPSG/0/" + code);
    append_made_by(json.key("mansard"), city_.made_by);
    json.end_object();
  }

  /// "28992" of "EPSG:28992"; empty for anything else, which a referenceSystem cannot name.
  [[nodiscard]] auto epsg_code() const -> std::string {
    constexpr std::string_view prefix = "EPSG:";
    const std::string_view crs = city_.frame.crs;
    if (!crs.starts_with(prefix)) return {};
    const auto code = base::to_whole(crs.substr(prefix.size()));
    return code && *code > 0 ? std::to_string(*code) : std::string();
  }

  void append_building(std::size_t b) {
    const Building& building = city_.buildings[b];
    objects_.line().key(keys_.buildings[b]).begin_object().key("type").text("Building");
    append_attributes(objects_.key("attributes").begin_object(), building.attributes);
    objects_.end_object();
    if (!keys_.parts[b].empty()) {
      objects_.key("children").begin_array();
      for (const auto& key : keys_.parts[b]) objects_.text(key);
      objects_.end_array();
    }
    objects_.key("geometry").begin_array();
    append_footprint(building);
    objects_.end_array().end_object();
  }

  void append_footprint(const Building& building) {
    std::vector<Loops> surfaces;
    for (const auto& polygon : building.footprint)
      if (auto loops = quantised(polygon, building.ground); !loops.empty()) surfaces.push_back(std::move(loops));
    if (surfaces.empty()) return;
    objects_.begin_object().key("type").text("MultiSurface").key("lod").text("0").key("boundaries").begin_array();
    for (const auto& loops : surfaces) append_loops(loops);
    objects_.end_array().end_object();
  }

  void append_part(std::size_t b, std::size_t p) {
    const Part& part = city_.buildings[b].parts[p];
    objects_.line().key(keys_.parts[b][p]).begin_object().key("type").text("BuildingPart");
    append_attributes(objects_.key("attributes").begin_object(), without_plan(part.attributes));
    // The plan names its own origin: a tool that moves the city model to another one does not know about plans.
    objects_.key("ms_plan").begin_object().key("type").text(plan_type).key("version").whole(plan_version);
    objects_.key("origin").begin_array();
    for (const auto metres : city_.frame.origin) objects_.whole(metres);
    append_plan(objects_.end_array(), part.plan);
    objects_.end_object().end_object();
    objects_.key("parents").begin_array().text(keys_.buildings[b]).end_array();
    objects_.key("geometry").begin_array();
    const auto surfaces = quantised(part.model);
    append_solid("1.2", flat_prism(surfaces, roof_height(part)));
    append_solid("2.2", surfaces);
    objects_.end_array().end_object();
  }

  [[nodiscard]] static auto without_plan(const ingest::Attributes& attributes) -> ingest::Attributes {
    ingest::Attributes kept;
    for (const auto& attribute : attributes)
      if (attribute.first != "ms_plan") kept.push_back(attribute);
    return kept;
  }

  /// z of the flat roof of LoD 1.2: the 70th percentile of the roof's heights where it was measured and lies within
  /// the model, else half-way between the lowest and the highest point of the roof.
  [[nodiscard]] auto roof_height(const Part& part) const -> double {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double least = infinity, most = -infinity, bottom = infinity;
    const auto& solid = part.model.solid;
    for (std::size_t f = 0; f < solid.faces.size(); ++f)
      for (const auto& loop : solid.faces[f].loops)
        for (const auto v : loop) {
          const double z = solid.vertices[v].z;
          bottom = std::min(bottom, z);
          if (part.model.classes[f] != Class::roof) continue;
          least = std::min(least, z);
          most = std::max(most, z);
        }
    for (const auto& [name, value] : part.attributes)
      if (const double* height = std::get_if<double>(&value); height != nullptr && name == "ms_h_roof_70p")
        if (const double z = *height - static_cast<double>(city_.frame.origin[2]); z > bottom && z <= most) return z;
    return 0.5 * (least + most);
  }

  void append_solid(std::string_view lod, const std::vector<Surface>& surfaces) {
    if (surfaces.empty()) return;
    objects_.begin_object().key("type").text("Solid").key("lod").text(lod);
    objects_.key("boundaries").begin_array().begin_array();
    for (const Surface& surface : surfaces) append_loops(surface.loops);
    objects_.end_array().end_array();

    std::map<std::string, std::size_t> index_of;
    std::vector<std::string> distinct;
    std::vector<std::size_t> values;
    for (const Surface& surface : surfaces) {
      const auto [entry, added] = index_of.try_emplace(semantics_of(surface), distinct.size());
      if (added) distinct.push_back(entry->first);
      values.push_back(entry->second);
    }
    objects_.key("semantics").begin_object().key("surfaces").begin_array();
    for (const auto& object : distinct) objects_.raw(object);
    objects_.end_array().key("values").begin_array().begin_array();
    for (const auto value : values) objects_.whole(static_cast<std::int64_t>(value));
    objects_.end_array().end_array().end_object().end_object();
  }

  void append_loops(const Loops& loops) {
    objects_.begin_array();
    for (const auto& loop : loops) {
      objects_.begin_array();
      for (const Vertex& v : loop) objects_.whole(static_cast<std::int64_t>(pool_.index_of(v)));
      objects_.end_array();
    }
    objects_.end_array();
  }

  const City& city_;
  const Keys& keys_;
  JsonText objects_;
  VertexPool pool_;
};

}  // namespace

auto cityjson_text(const City& city, const Keys& keys) -> std::string { return Text(city, keys).all(); }

}  // namespace mansard::write::detail
