// Buildings as CityGML 2.0 (OGC 12-019) and 3.0 (OGC 20-010 and 21-006): solids with semantic surfaces, attributes
// and appearance.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"
#include "mansard/formats/atlas/texture_folder.hpp"
#include "mansard/formats/citygml/xml_text.hpp"
#include "mansard/formats/citygml_made_by.hpp"
#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {
namespace {

using model::FaceClass;

/// A module of CityGML: the prefix of its names, and where its schema is.
struct Module {
  std::string_view prefix, name;
};

auto head_of(bool v3, bool appearance) -> std::string {
  const std::string version = v3 ? "3.0" : "2.0", citygml = "http://www.opengis.net/citygml/";
  std::vector<Module> modules{{"bldg", "building"}, {"gen", "generics"}};
  if (v3) modules.push_back({"con", "construction"});
  if (appearance) modules.push_back({"app", "appearance"});
  std::string spaces, places;
  for (const auto& [prefix, name] : modules) {
    const std::string module(name);
    spaces += " xmlns:" + std::string(prefix) + "=\"" + citygml + module + "/" + version + "\"";
    if (prefix == "con") continue;  // by that of buildings
    places += (places.empty() ? "" : " ") + citygml + module + "/" + version + " http://schemas.opengis.net/citygml/" +
              module + "/" + version + "/" + module + ".xsd";
  }
  return "<CityModel xmlns=\"" + citygml + version + "\"" + spaces + " xmlns:gml=\"http://www.opengis.net/gml" +
         (v3 ? "/3.2" : "") +
         "\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xsi:schemaLocation=\"" +
         places + "\">\n";
}

auto surface_name(FaceClass kind) -> std::string_view {
  switch (kind) {
    case FaceClass::roof: return "RoofSurface";
    case FaceClass::ground: return "GroundSurface";
    case FaceClass::soffit: return "OuterCeilingSurface";
    default: return "WallSurface";
  }
}

/// How the file was made, as a comment: CityGML has no element for it that its schemas allow in every version. Two
/// dashes would end the comment, so that the second is written as JSON's escape; they occur in strings only.
auto made_by_comment(const model::MadeBy& made_by) -> std::string {
  JsonText json;
  append_made_by(json, made_by);
  std::string text = std::move(json).str();
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;) text.replace(at + 1, 1, "\\u002d");
  return std::string(citygml_made_by_start) + text + " -->\n";
}

auto attribute(std::string_view name, std::string_view value) -> std::string {
  return std::string(name) + "=\"" + base::markup_escaped(value) + "\"";
}

using Colour = std::array<std::uint8_t, 3>;

/// What colours a building: the polygons on each image, with their rings and the places in the image, and those of one
/// colour.
struct Appearance {
  struct Ring {
    std::string id;
    std::vector<std::array<double, 2>> places;  ///< of every corner, and of the first again; from the lower left
  };
  struct Target {
    std::string id;
    std::vector<Ring> rings;
  };
  std::map<std::uint32_t, std::vector<Target>> images;
  std::map<Colour, std::vector<std::string>> colours;
  [[nodiscard]] auto empty() const -> bool { return images.empty() && colours.empty(); }
};

/// The textures of one solid of a building.
struct SolidTextures {
  const TexturedSolids* textured = nullptr;
  std::size_t number = 0;  ///< of the solid, in the atlas
  const model::SolidTexture* own = nullptr;
};

class CityGmlWriter : public CityWriter, private TextureQueue {
 public:
  CityGmlWriter(Header header, const WriteOptions& options, const Lods& lods, std::unique_ptr<base::Spool> objects,
                base::Sink& file, TextureFolder folder)
      : TextureQueue(options),
        header_(std::move(header)),
        options_(options),
        v3_(options.citygml == CityGml::v3),
        objects_(std::move(objects)),
        file_(file),
        folder_(std::move(folder)) {
    for (const auto lod : lods) {  // CityGML has whole levels: of two that share one the finer is written
      if (lod == Lod::lod0) footprint_ = true;
      if (lod == Lod::lod12 || lod == Lod::lod13) lod1_ = lod;
      if (lod == Lod::lod20 || lod == Lod::lod22) lod2_ = lod;
    }
  }

  auto add(const model::Building& building) -> base::Result<void> override {
    auto keys = gate_.admit(building);
    if (!keys) return keys.error();
    return put(building, *std::move(keys));
  }

  auto finish() -> base::Result<void> override {
    if (auto done = empty(); !done) return done;
    file_.append("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    file_.append(head_of(v3_, appearance_));
    // Behind the root element: GDAL looks for that in the first 4,000 bytes.
    if (!header_.made_by.version.empty()) file_.append(made_by_comment(header_.made_by));
    XmlText xml(1);
    if (!options_.lineage.empty()) xml.leaf("gml:description", options_.lineage);
    if (!options_.title.empty()) xml.leaf("gml:name", options_.title);
    if (extent_) {
      std::string frame = attribute("srsDimension", "3");
      if (!header_.frame.crs.empty() && header_.frame.crs.starts_with("EPSG:"))
        frame = attribute("srsName", header_.frame.crs) + " " + frame;
      xml.open("gml:boundedBy").open("gml:Envelope", frame);
      xml.leaf("gml:lowerCorner", point((*extent_)[0])).leaf("gml:upperCorner", point((*extent_)[1]));
      xml.close().close();
    }
    file_.append(xml.take());
    if (auto copied = objects_->copy_to(file_); !copied) return copied;
    file_.append("</CityModel>\n");
    return {};
  }

  [[nodiscard]] auto warnings() const -> std::vector<base::Diagnostic> override { return warnings_; }

 private:
  auto images(const SolidAtlas& atlas) -> base::Result<std::uint32_t> override { return folder_.write(atlas); }

  auto write(const model::Building& building, const Gate::Keyed& keys, const TexturedSolids* textured)
      -> base::Result<void> override {
    const Drawn all = drawn(building, keys, Solids::building);
    warnings_.insert(warnings_.end(), all.warnings.begin(), all.warnings.end());
    Lods wanted;
    if (lod1_) wanted.push_back(*lod1_);
    if (lod2_) wanted.push_back(*lod2_);
    const auto levels = level_surfaces(all, header_.frame, wanted, options_.levels);
    const auto* texture = textured != nullptr ? textures_for(building, all.solids.size()) : nullptr;
    for (std::size_t i = 0; texture != nullptr && i < all.solids.size(); ++i)
      if (texture->solids[i].faces.size() != all.solids[i].part.model.solid.faces.size())
        texture = nullptr;  // they are those of parts (write.solids), which CityGML does not have
    const auto textures_of = [&](std::size_t solid) {
      if (texture == nullptr) return SolidTextures();
      return SolidTextures{textured, textured->first + solid, &texture->solids[solid]};
    };
    XmlText xml(1);
    const std::string id = unique_id(building.id);
    xml.open("cityObjectMember").open("bldg:Building", attribute("gml:id", id));
    const LevelSurfaces none;
    append(xml, building.id, id, building.attributes, building.footprint, building.ground,
           levels.size() == 1 ? levels.front() : none, levels.size() == 1 ? textures_of(0) : SolidTextures());
    if (levels.size() > 1)
      for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::string part = id + "_solid" + std::to_string(i + 1);
        xml.open(v3_ ? "bldg:buildingPart" : "bldg:consistsOfBuildingPart");
        xml.open("bldg:BuildingPart", attribute("gml:id", part));
        append(xml, all.solids[i].part.id, part, {}, {}, building.ground, levels[i], textures_of(i));
        xml.close().close();
      }
    xml.close().close();
    objects_->append(xml.take());
    return {};
  }

  /// "_", letters, and perhaps digits at its end.
  static auto is_like_ours(const std::string& id) -> bool {
    const auto from = id.rfind('_');
    if (from == id.npos) return false;
    const auto word = std::string_view(id).substr(from + 1);
    const auto kind = word.substr(0, word.find_last_not_of("0123456789") + 1);
    static constexpr std::array<std::string_view, 12> kinds{"app", "c", "f", "lod",   "m",     "n",
                                                            "p",   "r", "s", "shell", "solid", "t"};
    return std::ranges::find(kinds, kind) != kinds.end();
  }

  auto unique_id(const std::string& name) -> std::string {
    std::string id = xml_id(name);
    // Two names may become one, and one may be like those that are made of another: "a_lod0", "a_s1_p", "a_n3".
    if (id != name || is_like_ours(id)) id += "_n" + std::to_string(renamed_++);
    return id;
  }

  auto point(const Vertex& v) -> std::string {
    std::string out;
    for (std::size_t axis = 0; axis < 3; ++axis)
      out += (axis == 0 ? "" : " ") + quanta_in_file_frame(v[axis], header_.frame.origin[axis]);
    return out;
  }

  /// `id` may be empty.
  void append_ring(XmlText& xml, std::string_view role, const std::vector<Vertex>& loop, const std::string& id) {
    std::string places;
    for (std::size_t i = 0; i <= loop.size(); ++i) {
      widen(extent_, loop[i % loop.size()]);
      places += (i == 0 ? "" : " ") + point(loop[i % loop.size()]);
    }
    xml.open(role)
        .open("gml:LinearRing", id.empty() ? id : attribute("gml:id", id))
        .leaf("gml:posList", places, "srsDimension=\"3\"")
        .close()
        .close();
  }

  static auto ring_id(const std::string& polygon, std::size_t loop) -> std::string {
    return polygon + "_r" + std::to_string(loop);
  }

  /// Rings have ids where something refers to them.
  void append_polygon(XmlText& xml, const Loops& loops, const std::string& id, bool rings = false) {
    xml.open("gml:surfaceMember").open("gml:Polygon", attribute("gml:id", id));
    for (std::size_t i = 0; i < loops.size(); ++i)
      append_ring(xml, i == 0 ? "gml:exterior" : "gml:interior", loops[i], rings ? ring_id(id, i) : std::string());
    xml.close().close();
  }

  static auto polygon_id(const std::string& id, std::size_t surface) -> std::string {
    return id + "_s" + std::to_string(surface) + "_p";
  }
  static auto coarse_id(const std::string& id, std::size_t surface) -> std::string {
    return id + "_c" + std::to_string(surface);
  }

  /// Whether a surface is on an image, and not of one colour.
  [[nodiscard]] static auto pictured(const SolidTextures& textures, const Surface& surface) -> bool {
    if (textures.own == nullptr) return false;
    const auto& picture = textures.own->faces[surface.face].pixels;
    return picture.width > 1 || picture.height > 1;
  }

  /// Pictures belong to LoD 2.2; simpler levels have the mean colours.
  [[nodiscard]] auto has_pictures() const -> bool { return lod2_ == Lod::lod22; }

  [[nodiscard]] auto appearance_of(const std::vector<Surface>& coarse, const std::vector<Surface>& fine,
                                   const std::string& id, const SolidTextures& textures) const -> Appearance {
    Appearance out;
    if (textures.own == nullptr) return out;
    const auto mean = [&](const Surface& surface) {
      return surface.kind == FaceClass::roof ? textures.own->roof : textures.own->wall;
    };
    for (std::size_t i = 0; i < coarse.size(); ++i) out.colours[mean(coarse[i])].push_back(coarse_id(id, i));
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const auto polygon = polygon_id(id, i);
      if (!has_pictures()) {
        out.colours[mean(fine[i])].push_back(polygon);
        continue;
      }
      if (!pictured(textures, fine[i])) {
        const auto& rgb = textures.own->faces[fine[i].face].pixels.rgb;
        out.colours[{rgb[0], rgb[1], rgb[2]}].push_back(polygon);
        continue;
      }
      const auto& atlas = *textures.textured->atlas;
      Appearance::Target target{polygon, {}};
      for (std::size_t l = 0; l < fine[i].loops.size(); ++l) {
        const auto& loop = fine[i].loops[l];
        auto& ring = target.rings.emplace_back(Appearance::Ring{ring_id(polygon, l), {}});
        for (std::size_t k = 0; k <= loop.size(); ++k) {
          const auto& v = loop[k % loop.size()];
          const auto metres = [](std::int64_t quanta) { return static_cast<double>(quanta) / quanta_per_metre; };
          const auto [x, y] = atlas.uv(textures.number, fine[i].face, {metres(v[0]), metres(v[1]), metres(v[2])});
          ring.places.push_back({x, 1 - y});
        }
      }
      out.images[textures.textured->first_page + atlas.page_of(textures.number, fine[i].face)].push_back(
          std::move(target));
    }
    return out;
  }

  static auto place_text(const std::vector<std::array<double, 2>>& places) -> std::string {
    constexpr int decimals = 6;  // a hundredth of a pixel of the largest image
    std::string out;
    for (const auto& [u, v] : places)
      out += (out.empty() ? "" : " ") + base::to_text(u, decimals) + " " + base::to_text(v, decimals);
    return out;
  }

  void append_target(XmlText& xml, const Appearance::Target& target) {
    const auto list = [&] {
      xml.open("app:TexCoordList");
      for (const auto& ring : target.rings)
        xml.leaf("app:textureCoordinates", place_text(ring.places),
                 v3_ ? std::string() : attribute("ring", "#" + ring.id));
      if (v3_)
        for (const auto& ring : target.rings) xml.leaf("app:ring", "#" + ring.id);
      xml.close();
    };
    if (!v3_) {
      xml.open("app:target", attribute("uri", "#" + target.id));
      list();
      xml.close();
      return;
    }
    xml.open("app:textureParameterization").open("app:TextureAssociation", attribute("gml:id", target.id + "_t"));
    xml.leaf("app:target", "#" + target.id).open("app:textureParameterization");
    list();
    xml.close().close().close();
  }

  void append_appearance(XmlText& xml, const std::string& id, const Appearance& appearance) {
    if (appearance.empty()) return;
    appearance_ = true;
    std::size_t number = 0;
    const auto open_data = [&](std::string_view element) {
      xml.open(v3_ ? "app:surfaceData" : "app:surfaceDataMember");
      xml.open(element, attribute("gml:id", id + "_app" + std::to_string(number++)));
    };
    xml.open(v3_ ? "appearance" : "app:appearance").open("app:Appearance", attribute("gml:id", id + "_app"));
    xml.leaf("app:theme", "visual");
    for (const auto& [image, targets] : appearance.images) {
      open_data("app:ParameterizedTexture");
      xml.leaf("app:imageURI", folder_.name(image)).leaf("app:mimeType", "image/jpeg");
      xml.leaf("app:textureType", "specific").leaf("app:wrapMode", "none");
      for (const auto& target : targets) append_target(xml, target);
      xml.close().close();
    }
    for (const auto& [colour, targets] : appearance.colours) {
      open_data("app:X3DMaterial");
      std::string text;
      for (const auto value : colour) text += (text.empty() ? "" : " ") + base::to_text(value / 255.0, 4);
      xml.leaf("app:diffuseColor", text);
      for (const auto& target : targets) xml.leaf("app:target", "#" + target);
      xml.close().close();
    }
    xml.close().close();
  }

  /// A solid whose surfaces are `member(i)` for every i.
  template <class Member>
  void append_solid(XmlText& xml, std::string_view role, const std::string& id, std::size_t count, Member member) {
    xml.open(role).open("gml:Solid", attribute("gml:id", id)).open("gml:exterior");
    xml.open(v3_ ? "gml:Shell" : "gml:CompositeSurface", v3_ ? "" : attribute("gml:id", id + "_shell"));
    for (std::size_t i = 0; i < count; ++i) member(i);
    xml.close().close().close().close();
  }

  void append_generic(XmlText& xml, std::string_view name, const model::Value& value) {
    std::string type = "string", text;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
      // Version 3.0 has integers of 32 bits.
      const bool narrow = std::abs(static_cast<double>(*integer)) < 2147483648.0;
      if (narrow || !v3_) type = "int";
      text = std::to_string(*integer);
    } else if (const auto* real = std::get_if<double>(&value)) {
      if (!std::isfinite(*real)) return;
      type = "double";
      text = base::to_text(*real);
    } else if (const auto* flag = std::get_if<bool>(&value)) {
      text = *flag ? "true" : "false";
    } else if (const auto* string = std::get_if<std::string>(&value)) {
      text = *string;
    } else {
      return;
    }
    if (!v3_) {
      xml.open("gen:" + type + "Attribute", attribute("name", name)).leaf("gen:value", text).close();
      return;
    }
    type[0] = static_cast<char>(type[0] - 'a' + 'A');
    xml.open("genericAttribute").open("gen:" + type + "Attribute");
    xml.leaf("gen:name", name).leaf("gen:value", text).close().close();
  }

  void append_generics(XmlText& xml, const model::Attributes& attributes) {
    std::set<std::string_view> seen;
    std::vector<bool> last(attributes.size());
    for (std::size_t i = attributes.size(); i-- > 0;) last[i] = seen.insert(attributes[i].first).second;
    for (std::size_t i = 0; i < attributes.size(); ++i) {
      const auto& [name, value] = attributes[i];
      const bool native = (name == "measuredHeight" && std::holds_alternative<double>(value)) ||
                          (name == "roofType" && std::holds_alternative<std::string>(value)) ||
                          (name == "storeysAboveGround" && std::holds_alternative<std::int64_t>(value));
      if (last[i] && !native) append_generic(xml, name, value);
    }
  }

  template <class T>
  static auto native(const model::Attributes& attributes, std::string_view name) -> const T* {
    const T* found = nullptr;
    for (const auto& [key, value] : attributes)
      if (key == name) found = std::get_if<T>(&value);
    return found;
  }

  /// What CityGML itself has of a building, in the order of its schema.
  void append_native(XmlText& xml, const model::Attributes& attributes) {
    const auto* height = native<double>(attributes, "measuredHeight");
    const auto* roof = native<std::string>(attributes, "roofType");
    const auto* storeys = native<std::int64_t>(attributes, "storeysAboveGround");
    if (v3_ && height != nullptr) {
      xml.open("con:height").open("con:Height").leaf("con:highReference", "highestRoofEdge");
      xml.leaf("con:lowReference", "lowestGroundPoint").leaf("con:status", "estimated");
      xml.leaf("con:value", base::to_text(*height), "uom=\"m\"").close().close();
    }
    if (roof != nullptr) xml.leaf("bldg:roofType", *roof);
    if (!v3_ && height != nullptr) xml.leaf("bldg:measuredHeight", base::to_text(*height), "uom=\"m\"");
    if (storeys != nullptr && *storeys >= 0) xml.leaf("bldg:storeysAboveGround", std::to_string(*storeys));
  }

  void append_boundaries(XmlText& xml, const std::vector<Surface>& surfaces, const std::string& id,
                         const SolidTextures& textures) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const auto& surface = surfaces[i];
      const std::string own = id + "_s" + std::to_string(i);
      xml.open(v3_ ? "boundary" : "bldg:boundedBy");
      xml.open((v3_ ? "con:" : "bldg:") + std::string(surface_name(surface.kind)), attribute("gml:id", own));
      if (surface.kind == FaceClass::roof) {
        constexpr double degrees = 180 / std::numbers::pi;
        const auto n = surface.normal;
        const double slope = std::atan2(std::hypot(n.x, n.y), n.z) * degrees;
        append_generic(xml, "ms_slope", std::round(slope * 100) / 100);
        if (slope >= 0.5) {
          const double azimuth = std::atan2(n.x, n.y) * degrees;
          append_generic(xml, "ms_azimuth", std::round((azimuth < 0 ? azimuth + 360 : azimuth) * 100) / 100);
        }
      }
      if (surface.kind == FaceClass::wall || surface.kind == FaceClass::party_wall)
        append_generic(xml, "ms_party_wall", std::string(surface.kind == FaceClass::party_wall ? "true" : "false"));
      xml.open(v3_ ? "lod2MultiSurface" : "bldg:lod2MultiSurface")
          .open("gml:MultiSurface", attribute("gml:id", own + "_m"));
      append_polygon(xml, surface.loops, polygon_id(id, i), has_pictures() && pictured(textures, surface));
      xml.close().close().close().close();
    }
  }

  void append_footprint(XmlText& xml, const std::vector<geometry::Polygon>& footprint, double ground,
                        const std::string& id) {
    std::vector<Loops> sound;
    for (const auto& polygon : footprint)
      if (auto loops = quantised(polygon, ground); !loops.empty()) sound.push_back(std::move(loops));
    if (!footprint_ || sound.empty() || !std::ranges::all_of(sound, is_sound)) return;
    xml.open(v3_ ? "lod0MultiSurface" : "bldg:lod0FootPrint")
        .open("gml:MultiSurface", attribute("gml:id", id + "_lod0"));
    for (std::size_t i = 0; i < sound.size(); ++i) append_polygon(xml, sound[i], id + "_f" + std::to_string(i));
    xml.close().close();
  }

  /// Of a building or a part, in the order of the schema of its version.
  void append(XmlText& xml, const std::string& name, const std::string& id, const model::Attributes& attributes,
              const std::vector<geometry::Polygon>& footprint, double ground, const LevelSurfaces& levels,
              const SolidTextures& textures) {
    const std::vector<Surface> none;
    const auto& coarse = lod1_ ? levels.at(*lod1_) : none;
    const auto& fine = lod2_ ? levels.at(*lod2_) : none;
    const auto appearance = appearance_of(coarse, fine, id, textures);
    xml.leaf("gml:name", name);
    if (v3_) append_appearance(xml, id, appearance);
    append_generics(xml, attributes);
    if (!v3_) append_appearance(xml, id, appearance);
    if (v3_) append_boundaries(xml, fine, id, textures);
    if (!v3_) append_native(xml, attributes);
    append_footprint(xml, footprint, ground, id);
    if (!coarse.empty())
      append_solid(xml, v3_ ? "lod1Solid" : "bldg:lod1Solid", id + "_lod1", coarse.size(),
                   [&](std::size_t i) { append_polygon(xml, coarse[i].loops, coarse_id(id, i)); });
    if (!fine.empty())
      append_solid(xml, v3_ ? "lod2Solid" : "bldg:lod2Solid", id + "_lod2", fine.size(), [&](std::size_t i) {
        xml.empty("gml:surfaceMember", attribute("xlink:href", "#" + polygon_id(id, i)));
      });
    if (!v3_) append_boundaries(xml, fine, id, textures);
    if (v3_) append_native(xml, attributes);
  }

  const Header header_;
  const WriteOptions options_;
  const bool v3_;
  bool footprint_ = false;
  std::optional<Lod> lod1_, lod2_;
  Gate gate_;
  Extent extent_;
  std::size_t renamed_ = 0;
  std::unique_ptr<base::Spool> objects_;  ///< the extent of all comes first in the file
  base::Sink& file_;
  TextureFolder folder_;
  bool appearance_ = false;  ///< whether any building has one
  std::vector<base::Diagnostic> warnings_;
};

}  // namespace

auto citygml_writer(const Path& path, const Header& header, const WriteOptions& options, base::Outputs& outputs)
    -> WriterResult {
  auto lods = lods_of(options.lod, Format::citygml);
  if (!lods) return lods.error();
  auto objects = base::Spool::open();
  if (!objects) return objects.error();
  const auto file = outputs.file(path);
  if (!file) return file.error();
  return WriterResult(std::make_unique<CityGmlWriter>(header, options, *lods, *std::move(objects), **file,
                                                      TextureFolder(path, options, outputs)));
}

}  // namespace mansard::formats::detail
