#include <libxml/xmlreader.h>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/formats/citygml/citygml_document.hpp"
#include "mansard/formats/citygml/xml_text.hpp"

namespace mansard::formats {
namespace {

struct FreeReader {
  void operator()(xmlTextReader* reader) const { xmlFreeTextReader(reader); }
};

auto text_in(const xmlChar* text) -> std::string_view {
  return text == nullptr ? std::string_view() : std::string_view(reinterpret_cast<const char*>(text));
}
auto name_of(const xmlNode* node) -> std::string_view { return text_in(node->name); }

/// Of elements.
template <class Work>
void each_child(const xmlNode* node, Work work) {
  for (const xmlNode* child = node->children; child != nullptr; child = child->next)
    if (child->type == XML_ELEMENT_NODE) work(child);
}
auto child_of(const xmlNode* node, std::string_view name) -> const xmlNode* {
  const xmlNode* found = nullptr;
  each_child(node, [&](const xmlNode* child) {
    if (found == nullptr && name_of(child) == name) found = child;
  });
  return found;
}

/// By its name without prefix: producers choose prefixes, and "id" and "href" mean the same in all namespaces here.
auto attribute_of(const xmlNode* node, std::string_view name) -> std::string {
  for (const xmlAttr* a = node->properties; a != nullptr; a = a->next)
    if (text_in(a->name) == name && a->children != nullptr) return std::string(text_in(a->children->content));
  return {};
}

/// The text directly in an element.
auto words_of(const xmlNode* node) -> std::string {
  std::string out;
  for (const xmlNode* child = node->children; child != nullptr; child = child->next)
    if (child->type == XML_TEXT_NODE || child->type == XML_CDATA_SECTION_NODE) out += text_in(child->content);
  const auto first = out.find_first_not_of(" \t\r\n");
  if (first == out.npos) return {};
  return out.substr(first, out.find_last_not_of(" \t\r\n") - first + 1);
}

auto is_leaf(const xmlNode* node) -> bool {
  bool leaf = true;
  each_child(node, [&](const xmlNode*) { leaf = false; });
  return leaf;
}

auto numbers_in(std::string_view text) -> std::vector<double> {
  std::vector<double> out;
  for (std::size_t at = 0; at < text.size();) {
    at = text.find_first_not_of(" \t\r\n,", at);
    if (at == text.npos) break;
    const auto end = std::min(text.find_first_of(" \t\r\n,", at), text.size());
    out.push_back(base::to_number(text.substr(at, end - at)).value_or(std::numeric_limits<double>::quiet_NaN()));
    at = end;
  }
  return out;
}

/// "EPSG:25832" of "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783" and others: the first code is that of the plane.
/// The names of the German surveying authorities have no code in them.
auto system_of(const std::string& name) -> std::string {
  if (const auto at = name.find("EPSG"); at != name.npos) {
    const auto digits = name.find_first_of("0123456789", at);
    if (digits == name.npos) return name;
    auto code = name.substr(digits, name.find_first_not_of("0123456789", digits) - digits);
    // ".../EPSG/0/7415": the version of the register comes first.
    if (const auto rest = digits + code.size(); rest < name.size() && name[rest] == '/') {
      const auto more = name.substr(rest + 1);
      if (!more.empty() && more.find_first_not_of("0123456789") == more.npos) code = more;
    }
    return "EPSG:" + code;
  }
  for (const char* zone : {"31", "32", "33"})
    if (name.find(std::string("ETRS89_UTM") + zone) != name.npos) return std::string("EPSG:258") + zone;
  return name;
}

class BuildingReader {
 public:
  /// The whole of a building, as a document.
  auto document(const xmlNode* building) -> Json {
    collect_polygons(building);
    add_object(building, "Building", {});
    Json out = {
        {"type", "CityJSON"}, {"version", "2.0"}, {"CityObjects", std::move(objects_)}, {"vertices", Json::array()}};
    for (const auto& v : vertices_) out["vertices"].push_back({v[0], v[1], v[2]});
    return out;
  }

 private:
  void collect_polygons(const xmlNode* node) {
    if (const auto id = attribute_of(node, "id"); !id.empty()) by_id_.emplace(id, node);
    each_child(node, [&](const xmlNode* child) { collect_polygons(child); });
  }

  static auto is_part(std::string_view name) -> bool {
    return name == "consistsOfBuildingPart" || name == "buildingPart";
  }
  static auto is_installation(std::string_view name) -> bool {
    return name == "outerBuildingInstallation" || name == "buildingInstallation";
  }
  /// What is in a building, or beside it, and no surface of it.
  static auto is_aside(std::string_view name) -> bool {
    static const std::set<std::string_view> names{"interiorRoom",
                                                  "interiorBuildingInstallation",
                                                  "buildingRoom",
                                                  "buildingFurniture",
                                                  "interiorFurniture",
                                                  "address",
                                                  "opening",
                                                  "fillingSurface",
                                                  "externalReference",
                                                  "appearance",
                                                  "appearanceMember",
                                                  "boundedByEnvelope",
                                                  "buildingSubdivision",
                                                  "generalizesTo",
                                                  "relatedTo"};
    return names.contains(name);
  }

  void add_object(const xmlNode* node, const char* type, const std::string& parent) {
    std::string id = attribute_of(node, "id");
    // mansard writes ids that are not valid in XML with their true spelling as the name.
    if (const auto* name = child_of(node, "name")) {
      const auto spelt = words_of(name), valid = detail::xml_id(spelt);
      if (valid == id || (valid != spelt && id.starts_with(valid + "_n"))) id = spelt;
    }
    if (id.empty()) id = (parent.empty() ? std::string("building") : parent + "-part");
    const std::string wanted = id;
    for (int n = 2; objects_.contains(id); ++n) id = wanted + "-" + std::to_string(n);
    objects_[id] = {{"type", type}};
    if (!parent.empty()) {
      objects_[id]["parents"] = {parent};
      objects_[parent]["children"].push_back(id);
    }
    Json attributes = Json::object();
    add_attributes(node, id, attributes);
    if (!attributes.empty()) objects_[id]["attributes"] = std::move(attributes);
    if (auto addresses = addresses_of(node); !addresses.empty()) objects_[id]["address"] = std::move(addresses);
    Levels levels;
    gather(node, levels);
    Json geometry = Json::array();
    for (const auto& [lod, level] : levels) append_level(lod, level, geometry);
    if (!geometry.empty()) objects_[id]["geometry"] = std::move(geometry);
    each_child(node, [&](const xmlNode* child) {
      if (is_part(name_of(child)))
        each_child(child, [&](const xmlNode* part) { add_object(part, "BuildingPart", id); });
      if (is_installation(name_of(child)))
        each_child(child, [&](const xmlNode* part) { add_object(part, "BuildingInstallation", id); });
    });
  }

  // ---- attributes

  static auto number_or_text(const std::string& text) -> Json {
    if (const auto integer = base::to_integer(text)) return *integer;
    if (const auto number = base::to_number(text)) return *number;
    return text;
  }

  static void add_generic(const xmlNode* node, std::string_view kind, Json& out) {
    std::string name = attribute_of(node, "name");
    if (const auto* own = child_of(node, "name"); name.empty() && own != nullptr) name = words_of(own);
    const auto* value = child_of(node, "value");
    if (name.empty() || value == nullptr) return;
    const auto text = words_of(value);
    const auto lower = base::lower(std::string(kind));
    if (lower.starts_with("int")) {
      if (const auto integer = base::to_integer(text)) {
        out[name] = *integer;
        return;
      }
    }
    if (lower.starts_with("double") || lower.starts_with("measure")) {
      if (const auto number = base::to_number(text)) {
        out[name] = *number;
        return;
      }
    }
    out[name] = text;
  }

  static void add_attributes(const xmlNode* node, const std::string& id, Json& out) {
    static const std::set<std::string_view> numbers{"measuredHeight", "storeysAboveGround", "storeysBelowGround",
                                                    "yearOfConstruction", "yearOfDemolition"};
    each_child(node, [&](const xmlNode* child) {
      const auto name = name_of(child);
      if (name.ends_with("Attribute") && name != "genericAttribute") {
        add_generic(child, name, out);
      } else if (name == "genericAttribute") {
        each_child(child, [&](const xmlNode* one) { add_generic(one, name_of(one), out); });
      } else if (name == "height") {
        if (const auto* height = child_of(child, "Height"))
          if (const auto* value = child_of(height, "value"))
            if (const auto number = base::to_number(words_of(value))) out["measuredHeight"] = *number;
      } else if (name == "name") {
        if (const auto text = words_of(child); !text.empty() && text != id) out["name"] = text;
      } else if (!name.starts_with("lod") && !is_aside(name) && is_leaf(child)) {
        if (const auto text = words_of(child); !text.empty())
          out[std::string(name)] = numbers.contains(name) ? number_or_text(text) : Json(text);
      }
    });
  }

  /// In the words of CityJSON; of xAL 2.0, where names are elements of their own, and 3.0, where they are in the
  /// element of what they name.
  static void add_address(const xmlNode* node, std::string_view within, Json& out) {
    static const std::map<std::string_view, const char*> leaves{
        {"CountryName", "Country"},
        {"AdministrativeAreaName", "AdministrativeArea"},
        {"LocalityName", "Locality"},
        {"ThoroughfareName", "ThoroughfareName"},
        {"ThoroughfareNumber", "ThoroughfareNumber"},
        {"PostalCodeNumber", "Postcode"},
        {"PremiseName", "PremiseName"},
        {"PremiseNumber", "PremiseNumber"},
    };
    static const std::map<std::string_view, std::pair<const char*, const char*>> named{
        {"Country", {"Country", "CountryCode"}},
        {"AdministrativeArea", {"AdministrativeArea", "AdministrativeAreaNumber"}},
        {"Locality", {"Locality", "LocalityNumber"}},
        {"Thoroughfare", {"ThoroughfareName", "ThoroughfareNumber"}},
        {"PostCode", {"Postcode", "Postcode"}},
        {"Premises", {"PremiseName", "PremiseNumber"}},
    };
    const auto name = name_of(node);
    if (name == "multiPoint") return;
    const auto put = [&](const char* key) {
      const auto text = words_of(node);
      if (!text.empty() && !out.contains(key)) out[key] = text;
    };
    if (const auto leaf = leaves.find(name); leaf != leaves.end()) return put(leaf->second);
    if (const auto what = named.find(within); what != named.end()) {
      if (name == "NameElement") return put(what->second.first);
      if (name == "Number" || name == "Identifier") return put(what->second.second);
    }
    each_child(node, [&](const xmlNode* child) { add_address(child, named.contains(name) ? name : within, out); });
  }

  static auto addresses_of(const xmlNode* node) -> Json {
    Json out = Json::array();
    each_child(node, [&](const xmlNode* child) {
      if (name_of(child) != "address") return;
      Json one = Json::object();
      add_address(child, {}, one);
      if (!one.empty()) out.push_back(std::move(one));
    });
    return out;
  }

  // ---- geometry

  struct Polygon {
    const xmlNode* node = nullptr;
    bool reversed = false;
  };
  struct Level {
    std::vector<Polygon> flat, edge;                      ///< LoD 0: on the ground, and of the roof
    std::vector<std::vector<Polygon>> solids;             ///< shells of the outside
    std::vector<Polygon> surfaces;                        ///< of a MultiSurface
    std::vector<std::pair<Polygon, std::string>> bounds;  ///< with what they are: RoofSurface
  };
  using Levels = std::map<char, Level>;

  /// The polygons in a geometry, with those that it names.
  void polygons_in(const xmlNode* node, std::vector<Polygon>& out, bool reversed = false, int depth = 0) const {
    constexpr int deepest = 64;
    if (depth > deepest) return;
    const auto name = name_of(node);
    if (name == "Polygon" || name == "Triangle" || name == "Rectangle" || name == "PolygonPatch") {
      out.push_back({node, reversed});
      return;
    }
    if (name == "interior" && name_of(node->parent) == "Solid") return;  // a cavity
    if (const auto target = attribute_of(node, "href"); target.starts_with("#")) {
      if (const auto found = by_id_.find(target.substr(1)); found != by_id_.end())
        polygons_in(found->second, out, reversed, depth + 1);
      return;
    }
    const bool turned = name == "OrientableSurface" && attribute_of(node, "orientation") == "-";
    each_child(node, [&](const xmlNode* child) { polygons_in(child, out, reversed != turned, depth + 1); });
  }

  void solids_in(const xmlNode* node, std::vector<std::vector<Polygon>>& out) const {
    if (name_of(node) == "Solid") {
      polygons_in(node, out.emplace_back());
      return;
    }
    each_child(node, [&](const xmlNode* child) { solids_in(child, out); });
  }

  /// Of an object, without its parts. `surface` is the boundary surface that it is in.
  void gather(const xmlNode* node, Levels& out, const std::string& surface = {}) const {
    each_child(node, [&](const xmlNode* child) {
      const auto name = name_of(child);
      if (is_part(name) || is_installation(name) || is_aside(name)) return;
      if (name.size() > 4 && name.starts_with("lod") && name[3] >= '0' && name[3] <= '4') {
        auto& level = out[name[3]];
        const auto kind = name.substr(4);
        std::vector<Polygon> found;
        if (kind == "Solid") {
          solids_in(child, level.solids);
          return;
        }
        if (!kind.ends_with("Surface") && kind != "FootPrint" && kind != "RoofEdge" && kind != "Geometry") return;
        polygons_in(child, found);
        auto& to = kind == "RoofEdge" ? level.edge : name[3] == '0' ? level.flat : level.surfaces;
        for (const auto& polygon : found) {
          if (surface.empty()) to.push_back(polygon);
          else level.bounds.emplace_back(polygon, surface);
        }
      } else if (name == "boundedBy" || name == "boundary") {
        each_child(child, [&](const xmlNode* bound) {
          if (name_of(bound).ends_with("Surface")) gather(bound, out, std::string(name_of(bound)));
        });
      }
    });
  }

  auto vertex(const std::array<double, 3>& at) -> Json {
    const auto [entry, fresh] = numbers_.emplace(at, vertices_.size());
    if (fresh) vertices_.push_back(at);
    return entry->second;
  }

  auto ring_of(const xmlNode* node, bool reversed) -> Json {
    std::vector<double> all;
    std::size_t dimension = 3;
    const auto take = [&](const xmlNode* list) {
      if (const auto said = base::to_integer(attribute_of(list, "srsDimension")); said && *said == 2) dimension = 2;
      const auto more = numbers_in(words_of(list));
      all.insert(all.end(), more.begin(), more.end());
    };
    each_child(node, [&](const xmlNode* child) {
      const auto name = name_of(child);
      if (name == "posList" || name == "pos" || name == "coordinates") take(child);
      if (name == "pointProperty")
        each_child(child, [&](const xmlNode* point) {
          if (const auto* pos = child_of(point, "pos")) take(pos);
        });
    });
    std::vector<std::array<double, 3>> points;
    for (std::size_t i = 0; i + dimension <= all.size(); i += dimension)
      points.push_back({all[i], all[i + 1], dimension == 3 ? all[i + 2] : 0.0});
    if (points.size() > 1 && points.front() == points.back()) points.pop_back();
    if (reversed) std::ranges::reverse(points);
    Json out = Json::array();
    for (const auto& p : points) out.push_back(vertex(p));
    return out;
  }

  auto rings_of(const Polygon& polygon) -> Json {
    Json out = Json::array();
    for (const char* role : {"exterior", "outerBoundaryIs", "interior", "innerBoundaryIs"})
      each_child(polygon.node, [&](const xmlNode* child) {
        if (name_of(child) != role) return;
        each_child(child, [&](const xmlNode* ring) { out.push_back(ring_of(ring, polygon.reversed)); });
      });
    return out;
  }

  /// `kind_of` is what a polygon is; empty for nothing said.
  template <class KindOf>
  auto surfaces_of(const std::vector<Polygon>& polygons, const std::string& lod, const char* type, KindOf kind_of)
      -> Json {
    Json boundaries = Json::array(), kinds = Json::array(), values = Json::array();
    std::map<std::string, std::size_t> numbers;
    for (const auto& polygon : polygons) {
      auto rings = rings_of(polygon);
      if (rings.empty()) continue;
      boundaries.push_back(std::move(rings));
      const std::string kind = kind_of(polygon);
      if (kind.empty()) {
        values.push_back(nullptr);
        continue;
      }
      const auto [entry, fresh] = numbers.emplace(kind, kinds.size());
      if (fresh) kinds.push_back({{"type", kind}});
      values.push_back(entry->second);
    }
    const bool solid = std::string_view(type) == "Solid";
    Json out = {{"type", type}, {"lod", lod}, {"boundaries", solid ? Json::array({boundaries}) : boundaries}};
    if (!kinds.empty()) out["semantics"] = {{"surfaces", kinds}, {"values", solid ? Json::array({values}) : values}};
    return out;
  }

  void append_level(char number, const Level& level, Json& out) {
    const std::string lod(1, number);
    std::map<const xmlNode*, std::string> kinds;
    for (const auto& [polygon, kind] : level.bounds) kinds.emplace(polygon.node, kind);
    const auto kind_of = [&](const Polygon& polygon) {
      const auto found = kinds.find(polygon.node);
      return found == kinds.end() ? std::string() : found->second;
    };
    const auto nothing_said = [](const Polygon&) { return std::string(); };
    if (number == '0') {
      auto flat = level.flat;
      for (const auto& [polygon, kind] : level.bounds)
        if (flat.empty() || kind == "GroundSurface") flat.push_back(polygon);
      if (flat.empty()) flat = level.edge;
      if (!flat.empty()) out.push_back(surfaces_of(flat, lod, "MultiSurface", nothing_said));
      return;
    }
    bool some = false;
    for (const auto& shell : level.solids) {
      if (shell.empty()) continue;
      out.push_back(surfaces_of(shell, lod, "Solid", kind_of));
      some = true;
    }
    if (some) return;
    std::vector<Polygon> all;
    for (const auto& [polygon, kind] : level.bounds) all.push_back(polygon);
    if (all.empty()) all = level.surfaces;
    if (!all.empty()) out.push_back(surfaces_of(all, lod, "MultiSurface", kind_of));
  }

  std::map<std::string, const xmlNode*> by_id_;
  Json objects_ = Json::object();
  std::vector<std::array<double, 3>> vertices_;
  std::map<std::array<double, 3>, std::size_t> numbers_;
};

/// The first name of a reference system in an element.
auto system_in(const xmlNode* node) -> std::string {
  if (auto name = attribute_of(node, "srsName"); !name.empty()) return name;
  std::string found;
  each_child(node, [&](const xmlNode* child) {
    if (found.empty()) found = system_in(child);
  });
  return found;
}

void keep_quiet(void*, const char*, xmlParserSeverities, xmlTextReaderLocatorPtr) {}

}  // namespace

auto looks_like_citygml(std::string_view bytes) -> bool {
  const auto head = bytes.substr(0, 16384);
  const auto first = head.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  return first != head.npos && head[first] == '<' && head.find("CityModel") != head.npos &&
         head.find("opengis.net/citygml") != head.npos;
}

auto each_citygml_building(std::string_view bytes, const CityComplaints& complaints,
                           const std::function<base::Result<void>(const CityDocument&)>& work)
    -> base::Result<std::string> {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    return complaints("it is larger than 2 GB, which is not read in one file; divide it");
  const std::unique_ptr<xmlTextReader, FreeReader> reader(
      xmlReaderForMemory(bytes.data(), static_cast<int>(bytes.size()), nullptr, nullptr,
                         XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_COMPACT));
  if (!reader) return complaints("it cannot be read as XML");
  xmlTextReaderSetErrorHandler(reader.get(), keep_quiet, nullptr);
  std::string system;
  int more = xmlTextReaderRead(reader.get());
  while (more == 1) {
    const int type = xmlTextReaderNodeType(reader.get());
    if (type == XML_READER_TYPE_DOCUMENT_TYPE || type == XML_READER_TYPE_ENTITY_REFERENCE)
      return complaints("it has a DOCTYPE, which CityGML has no use for and which is not read");
    if (type != XML_READER_TYPE_ELEMENT) {
      more = xmlTextReaderRead(reader.get());
      continue;
    }
    const auto name = text_in(xmlTextReaderConstLocalName(reader.get()));
    if (name == "Envelope" && system.empty()) {
      if (xmlChar* said = xmlTextReaderGetAttribute(reader.get(), reinterpret_cast<const xmlChar*>("srsName"))) {
        system = text_in(said);
        xmlFree(said);
      }
    }
    if (name != "Building") {
      more = xmlTextReaderRead(reader.get());
      continue;
    }
    const xmlNode* building = xmlTextReaderExpand(reader.get());
    if (building == nullptr) {
      more = -1;
      break;
    }
    if (system.empty()) system = system_in(building);
    const Json json = BuildingReader().document(building);
    if (auto done = work(CityDocument(json, {})); !done) return done.failure();
    more = xmlTextReaderNext(reader.get());
  }
  if (more != 0)
    return complaints("it is not well-formed XML, or it is cut short, at line " +
                      std::to_string(xmlTextReaderGetParserLineNumber(reader.get())));
  return system.empty() ? std::string() : system_of(system);
}

}  // namespace mansard::formats
