#include "mansard/formats/vector/features.hpp"

#include <ogrsf_frmts.h>
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "mansard/base/files.hpp"
#include "mansard/base/options.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/citygml/citygml_document.hpp"
#include "mansard/formats/cityjson/footprint_reader.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/geojson/assumed_crs.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/osm/osm.hpp"
#include "mansard/formats/osm/relations.hpp"
#include "mansard/formats/osm/tags.hpp"
#include "mansard/formats/vector/attributes.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

auto open(const std::string& name, const std::string& encoding) -> GDALDatasetUniquePtr {
  crs::register_gdal();
  GDALDriverH driver = GDALIdentifyDriverEx(name.c_str(), GDAL_OF_VECTOR, nullptr, nullptr);
  const auto is = [&](std::string_view kind) { return driver != nullptr && GDALGetDescription(driver) == kind; };
  CPLStringList words;
  // The GML driver would write a .gfs file beside its input.
  if (is("GML")) words.SetNameValue("WRITE_GFS", "NO");
  if (is("OSM")) words.SetNameValue("CONFIG_FILE", osm_configuration().c_str());
  if (is("ESRI Shapefile") && !encoding.empty()) words.SetNameValue("ENCODING", encoding.c_str());
  return GDALDatasetUniquePtr(GDALDataset::Open(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                                nullptr, words.List(), nullptr));
}

/// Why the value of a GeoJSON's "crs" names no CRS; empty where it does. GDAL takes degrees instead.
auto failure_of_crs(std::string_view value) -> std::string {
  const auto crs = nlohmann::json::parse(value, nullptr, false);
  const auto text_in = [](const nlohmann::json& from, const char* key) {
    const auto found = from.is_object() ? from.find(key) : from.end();
    return from.is_object() && found != from.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  if (!crs.is_object()) return "it is no object";
  const auto properties = crs.value("properties", nlohmann::json::object());
  const auto kind = text_in(crs, "type");
  if (kind == "link" || kind == "url")
    return "it is a link, '" + base::on_one_line(text_in(properties, kind == "link" ? "href" : "url")) +
           "', and no link is followed";
  const auto name = text_in(properties, "name");
  if (kind != "name" || crs::from_words(name)) return {};
  return "'" + base::on_one_line(name) + "'" + crs::hint_for(name);
}

/// Where JSON has an escaped NUL.
auto first_nul(std::string_view json) -> std::optional<std::size_t> {
  constexpr std::string_view escaped = "\\u0000";
  for (auto at = json.find(escaped); at != json.npos; at = json.find(escaped, at + 1)) {
    const auto before = json.find_last_not_of('\\', at);
    if ((before == json.npos ? at + 1 : at - before) % 2 == 1) return at;  // else the backslash itself is escaped
  }
  return std::nullopt;
}

/// Everything that was read of the features, as bytes that differ where they differ.
auto input_of(const std::vector<RawFeature>& features, const std::string& name) -> model::InputFile {
  std::string text;
  for (const auto& feature : features) {
    text += std::to_string(feature.number) + "\n";
    for (const auto& [key, value] : feature.attributes) {
      text += std::to_string(key.size()) + ":" + key + std::to_string(value.index());
      if (const auto* words = std::get_if<std::string>(&value)) text += std::to_string(words->size()) + ":" + *words;
      if (const auto* whole = std::get_if<std::int64_t>(&value)) text += std::to_string(*whole);
      if (const auto* number = std::get_if<double>(&value)) text += base::to_text(*number);
      if (const auto* flag = std::get_if<bool>(&value)) text += *flag ? "1" : "0";
      text += ";";
    }
    for (const auto& part : feature.parts)
      for (const auto& ring : part)
        for (const auto p : ring) text += base::to_text(p.x) + " " + base::to_text(p.y) + ",";
  }
  return {name, text.size(), sha256(text)};
}

/// The files a source consists of (a Shapefile is three or more), by name; folders among them are looked into.
auto inputs_of(GDALDataset& dataset, const fs::path& path) -> base::Result<std::vector<model::InputFile>> {
  const CPLStringList listed(dataset.GetFileList());
  const bool archive = name_for_gdal(path).starts_with("/vsizip/");
  std::vector<std::string> names;
  // A packed file is known by the name it was asked for by.
  for (int i = 0; i < listed.Count() && (archive || !is_virtual(path)); ++i) names.emplace_back(listed[i]);
  if (names.empty()) names.push_back(path.string());
  std::ranges::sort(names);
  // All of an archive is one folder.
  const fs::path given =
      archive ? fs::path("/vsizip/" + archive_of(name_for_gdal(path)).first.string() + "/member") : path;
  if (archive || !is_virtual(path))
    for (const auto& name : names)
      if (auto reach = check_reach(given, name); !reach) return reach.error();
  std::vector<model::InputFile> out;
  for (const auto& name : names) {
    std::error_code failure;
    if (!is_virtual(name) && !fs::is_regular_file(name, failure)) continue;
    const auto bytes = Bytes::of(name);
    if (!bytes && is_virtual(name)) continue;  // a folder in an archive
    if (!bytes) return bytes.error();
    out.push_back({name, bytes->view().size(), sha256(bytes->view())});
  }
  return out;
}

auto polygons_possible(OGRLayer& layer) -> bool {
  const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
  return type == wkbUnknown || type == wkbGeometryCollection || OGR_GT_IsSubClassOf(type, wkbCurvePolygon) != 0 ||
         OGR_GT_IsSubClassOf(type, wkbMultiSurface) != 0;
}

auto is_osm(GDALDataset& dataset) -> bool { return std::string_view(dataset.GetDriverName()) == "OSM"; }

auto choose_layer(GDALDataset& dataset, const FeatureQuery& options, const std::string& subject,
                  std::vector<base::Diagnostic>& warnings) -> base::Result<OGRLayer*> {
  std::vector<std::string> names;
  for (auto* layer : dataset.GetLayers()) names.emplace_back(layer->GetName());
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  if (!options.layer.empty()) {
    if (OGRLayer* layer = dataset.GetLayerByName(options.layer.c_str())) return layer;
    const auto nearest = base::nearest_word(options.layer, names);
    return base::error(
        "ingest-layer",
        "there is no layer '" + options.layer + "'" + base::did_you_mean(nearest) + "; the file has: " + all, subject);
  }
  // Of OpenStreetMap's layers, which are the same in every file, buildings are in one.
  OGRLayer* chosen = is_osm(dataset) ? dataset.GetLayerByName("multipolygons") : nullptr;
  if (chosen != nullptr) return chosen;
  for (auto* layer : dataset.GetLayers())
    if (chosen == nullptr && polygons_possible(*layer)) chosen = layer;
  if (names.empty())
    return base::error("ingest-footprints-format",
                       "there are no layers; check what the file is, or export the footprints again", subject);
  if (chosen == nullptr) chosen = dataset.GetLayer(0);
  if (names.size() > 1)
    warnings.push_back(base::warning(
        "ingest-layers", "read layer '" + std::string(chosen->GetName()) + "' of: " + all + "; --ingest-layer chooses",
        subject));
  return chosen;
}

void add_ring(const OGRLinearRing& ring, RawPolygon& polygon) {
  geometry::Ring points;
  points.reserve(static_cast<std::size_t>(ring.getNumPoints()));
  for (int i = 0; i < ring.getNumPoints(); ++i) points.push_back({ring.getX(i), ring.getY(i)});
  polygon.push_back(std::move(points));
}

/// Many files have a z that nobody measured, and it is 0.
void add_heights(const OGRLinearRing& ring, RawFeature& feature) {
  if (!ring.Is3D()) return;
  for (int i = 0; i < ring.getNumPoints(); ++i)
    if (const double z = ring.getZ(i); std::isfinite(z) && z != 0)
      feature.lowest = std::min(z, feature.lowest.value_or(z));
}

/// Polygons from whatever holds polygons. Surfaces in space (TIN and the like) are no footprints.
void collect(const OGRGeometry& geometry, RawFeature& feature) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbPolygon || type == wkbTriangle) {
    const OGRPolygon* polygon = geometry.toPolygon();
    if (polygon->getExteriorRing() == nullptr) return;
    RawPolygon raw;
    add_ring(*polygon->getExteriorRing(), raw);
    for (int i = 0; i < polygon->getNumInteriorRings(); ++i) add_ring(*polygon->getInteriorRing(i), raw);
    feature.parts.push_back(std::move(raw));
    add_heights(*polygon->getExteriorRing(), feature);
  } else if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) collect(*part, feature);
  } else {
    feature.other_geometry = feature.other_geometry || !geometry.IsEmpty();
  }
}

auto to_raw(const OGRFeature& given) -> RawFeature {
  RawFeature feature;
  feature.number = given.GetFID();
  feature.attributes = attributes_of(given);
  const OGRGeometry* geometry = given.GetGeometryRef();
  feature.geometry = geometry == nullptr ? "NONE" : geometry->getGeometryName();
  if (geometry == nullptr) return feature;
  if (geometry->hasCurveGeometry()) {
    const std::unique_ptr<OGRGeometry> straight(geometry->getLinearGeometry());
    if (straight) collect(*straight, feature);
  } else {
    collect(*geometry, feature);
  }
  return feature;
}

auto crs_of(const OGRSpatialReference* crs) -> std::string {
  if (crs == nullptr) return {};
  // GeoPackage has two "undefined" systems of its own; an engineering one is a local frame by another name.
  const char* name = crs->GetName();
  if (crs->IsLocal() || (name != nullptr && std::string_view(name).starts_with("Undefined "))) return {};
  return crs::wkt_of(*crs);
}

/// A box in the layer's coordinates beyond which nothing meets `options.bbox`; nothing where that is not known before
/// all is read. Drivers test shapes where here boxes of shapes count: a building's length around the box, they agree.
auto box_in(OGRLayer& layer, const FeatureQuery& options) -> std::optional<geometry::Box2> {
  if (std::ranges::all_of(options.bbox, [](double c) { return c == 0; }) || !layer.TestCapability(OLCFastSpatialFilter))
    return std::nullopt;
  constexpr double around = 10000;  // m; what is longer than 5 km is refused as a footprint
  const auto& b = options.bbox;
  const geometry::Box2 box = geometry::Box2{{b[0], b[1]}, {b[2], b[3]}}.grown(around);
  const OGRSpatialReference* crs = layer.GetSpatialRef();
  if (crs == nullptr || crs->IsLocal() || options.crs == "local") return box;
  const crs::Crs own = crs::flat(*crs);
  if (options.crs.empty()) return crs->IsProjected() != 0 && crs::in_metres(*crs) ? std::optional(box) : std::nullopt;
  const auto wanted = crs::from_words(options.crs);
  if (!wanted) return std::nullopt;
  const crs::Crs working = crs::flat(wanted->system);
  if (working.system.IsSame(&own.system) != 0) return box;
  const auto way = crs::transformation(working, own);
  if (!way) return std::nullopt;
  geometry::Box2 out;
  constexpr int steps = 16;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      double x = box.least.x + (box.most.x - box.least.x) * i / steps;
      double y = box.least.y + (box.most.y - box.least.y) * j / steps;
      if (way->Transform(1, &x, &y) == 0) return std::nullopt;
      out.add({x, y});
    }
  return out;
}

/// Reads one source from its opening to its last feature.
class Source {
 public:
  Source(const fs::path& path, const FeatureQuery& options, const base::Run& run)
      : path_(path), subject_(shown_name(path)), options_(options), run_(run) {}

  auto read() -> base::Result<FeatureFile> {
    if (auto known = OtherStrings(options_.encoding).check(); !known) return known.failure();
    const Confined confined(path_);
    auto file = read_confined();
    // What is wrong may be that something is missing that was refused.
    if (auto done = confined.check(); !done) return done.error();
    return file;
  }

 private:
  auto read_confined() -> base::Result<FeatureFile> {
    dataset_ = open(inside_of(name_for_gdal(path_)), options_.encoding);
    if (!dataset_) return not_opened();
    at_opening_ = messages_.failure();
    if (!is_elsewhere(path_)) {
      auto inputs = inputs_of(*dataset_, path_);
      if (!inputs) return inputs.error();
      out_.inputs = std::move(*inputs);
    }
    auto chosen = choose_layer(*dataset_, options_, subject_, out_.warnings);
    if (!chosen) return chosen.error();
    OGRLayer& layer = **chosen;
    out_.crs = crs_of(layer.GetSpatialRef());
    if (auto done = look_at_geojson(); !done) return done.error();
    if (out_.crs.empty() && out_.crs_failure.empty()) look_for_crs();
    if (!options_.where.empty() && layer.SetAttributeFilter(options_.where.c_str()) != OGRERR_NONE)
      return bad_filter(layer);
    if (auto done = take_near(layer, options_.where); !done) return done.error();
    if (!options_.where.empty() && options_.others) {
      std::set<std::int64_t> passing;
      for (const auto& feature : out_.features) passing.insert(feature.number);
      out_.features.clear();
      no_buildings_ = 0;
      layer.SetAttributeFilter(nullptr);
      if (auto done = take_near(layer, {}); !done) return done.error();
      for (auto& feature : out_.features) feature.passes = passing.contains(feature.number);
    }
    warn_of_limits();
    decode_texts();
    if (is_database(path_)) std::ranges::sort(out_.features, {}, &RawFeature::number);
    if (is_elsewhere(path_)) out_.inputs = {input_of(out_.features, subject_)};
    return std::move(out_);
  }

  auto unreadable(const std::string& why) const -> base::Diagnostic {
    if (has_extension(path_, &Reads::mesh) || extension_of(path_) == ".osgb")
      return base::error(
          "ingest-footprints-format",
          "this is a " + std::string(has_extension(path_, &Reads::points) ? "point cloud" : "mesh") +
              ", and footprints are expected here; give a vector file with polygons, or derive the footprints from "
              "the mesh with --derive-footprints",
          subject_);
    std::error_code status;
    if (fs::is_directory(path_, status))
      return base::error("ingest-footprints-format",
                         "this is a folder that GDAL does not read as one source of footprints; name the file in it",
                         subject_);
    return base::error("ingest-footprints-format",
                       "not a readable vector file" + (why.empty() ? std::string() : " (" + why + ")") +
                           "; check what it is, or export the footprints again",
                       subject_);
  }

  auto bad_filter(OGRLayer& layer) const -> base::Diagnostic {
    std::string fields;
    const OGRFeatureDefn& of = *layer.GetLayerDefn();
    for (int i = 0; i < of.GetFieldCount(); ++i)
      fields += (i > 0 ? ", " : "") + std::string(of.GetFieldDefn(i)->GetNameRef());
    return base::error("ingest-where",
                       "'" + options_.where + "' is no filter this layer takes (" + messages_.failure() +
                           "); write it as in SQL after WHERE; the layer has: " + fields,
                       subject_);
  }

  auto not_opened() const -> base::Diagnostic {
    const std::string why = shown_text(messages_.failure(), path_);
    if (is_database(path_))
      return base::error("file-read",
                         "the database cannot be reached" + (why.empty() ? std::string() : " (" + why + ")") +
                             "; check its address, the user's rights, and whether GDAL here has its driver",
                         subject_);
    if (name_for_gdal(path_).starts_with("/vsizip/"))
      return unreadable((why.empty() ? std::string() : why + "; ") +
                        "of an archive that holds more than one source, name one: /vsizip/ARCHIVE/MEMBER");
    return unreadable(why);
  }

  auto look_at_geojson() -> base::Result<void> {
    if (std::string_view(dataset_->GetDriverName()) != "GeoJSON" || is_database(path_)) return {};
    const CPLStringList files(dataset_->GetFileList());
    const auto text = Bytes::of(files.Count() > 0 && !is_virtual(path_) ? fs::path(files[0]) : path_);
    if (!text) return text.error();
    const auto named = top_level_member(text->view(), "crs");
    out_.assumed_crs = !named;
    if (named) out_.crs_failure = failure_of_crs(*named);
    if (const auto place = first_nul(text->view()))
      out_.warnings.push_back(base::warning(
          "ingest-text",
          "there are strings with the character U+0000, the first at byte " + std::to_string(*place) +
              "; GDAL reads each up to it: ids can have become the same. Write the file without that character",
          subject_));
    // GDAL complains, and takes degrees instead.
    if (named && out_.crs_failure.empty() && at_opening_.find("crs") != std::string::npos)
      out_.crs_failure = at_opening_;
    return {};
  }

  /// A name that GDAL does not know is none to it. The file next to a Shapefile, and GML, have it as text.
  void look_for_crs() {
    const bool gml = std::string_view(dataset_->GetDriverName()) == "GML";
    const CPLStringList files(dataset_->GetFileList());
    for (int i = 0; i < files.Count(); ++i) {
      const bool own = extension_of(files[i]) == ".prj";
      if (!own && !gml) continue;
      const auto bytes = Bytes::of(files[i]);
      if (!bytes) continue;
      constexpr std::size_t enough = 65536;  // the first feature of a GML has the name, or the box before it
      std::string name(bytes->view().substr(0, enough));
      if (!own) {
        constexpr std::string_view attribute = "srsName=\"";
        const auto at = name.find(attribute);
        if (at == name.npos) continue;
        name.erase(0, at + attribute.size());
        name.resize(std::min(name.find('"'), name.size()));
      }
      name = base::on_one_line(name);
      name.erase(name.find_last_not_of(" \t") + 1);
      if (name.empty() || crs::from_words(name)) continue;
      constexpr std::size_t shown = 100;
      out_.crs_failure = "'" + name.substr(0, shown) + "'" + crs::hint_for(name);
    }
  }

  /// The features in the box, or all, that pass the filter `where`, which is set.
  auto take_near(OGRLayer& layer, const std::string& where) -> base::Result<void> {
    const auto box = box_in(layer, options_);
    if (box) layer.SetSpatialFilterRect(box->least.x, box->least.y, box->most.x, box->most.y);
    if (auto done = take_all(layer); !done) return done.error();
    if (box && out_.features.empty() && messages_.failure().empty()) {
      // Where nothing is near, the message says where all the others are.
      layer.SetSpatialFilter(nullptr);
      if (auto done = take_all(layer); !done) return done.error();
    }
    return check(layer, where, box.has_value());
  }

  /// A relation type=building, whose members are one building.
  void take_relation(OGRLayer& of, const OGRFeature& feature) {
    if (std::string_view(of.GetName()) != "other_relations" || feature.GetGeometryRef() == nullptr) return;
    const auto attributes = attributes_of(feature);
    if (tag_of(attributes, "type") == "building")
      relations_.add("relation/" + tag_of(attributes, "osm_id"), *feature.GetGeometryRef());
  }

  auto take_all(OGRLayer& layer) -> base::Result<void> {
    relations_.clear();
    // Features of OpenStreetMap come from all layers as they lie in the file.
    const bool osm = is_osm(*dataset_);
    layer.ResetReading();
    if (osm) dataset_->ResetReading();
    for (;;) {
      if (run_.cancelled()) return base::stopped();
      messages_.forget();
      OGRLayer* of = &layer;
      const OGRFeatureUniquePtr feature{osm ? dataset_->GetNextFeature(&of, nullptr, nullptr, nullptr)
                                            : layer.GetNextFeature()};
      if (!feature) {
        relations_.mark(out_.features);
        return {};
      }
      if (of != &layer) {
        if (osm) take_relation(*of, *feature);
        continue;
      }
      RawFeature raw = to_raw(*feature);
      raw.failure = messages_.failure();
      if (osm) {
        split_tags(raw.attributes);
        raw.own_id = osm_name(raw.attributes);
        if (const auto role = role_of(raw.attributes); !role.outline && !role.part) {
          ++no_buildings_;
          continue;
        }
      }
      out_.features.push_back(std::move(raw));
    }
  }

  /// GDAL keeps integers in 64 bits, and puts the limit where a file has more.
  void warn_of_limits() {
    std::size_t count = 0;
    std::string first;
    for (const auto& feature : out_.features)
      for (const auto& [name, value] : feature.attributes)
        if (const auto* whole = std::get_if<std::int64_t>(&value);
            whole != nullptr &&
            (*whole == std::numeric_limits<std::int64_t>::max() ||
             *whole == std::numeric_limits<std::int64_t>::min()) &&
            count++ == 0)
          first =
              "'" + name + "' of feature " + std::to_string(feature.number) + " was read as " + std::to_string(*whole);
    if (count > 0)
      out_.warnings.push_back(base::warning("ingest-attribute-range",
                                            std::to_string(count) +
                                                " integer attributes are at the limit of 64 bits, " + first +
                                                "; write larger integers as strings",
                                            subject_));
  }

  void decode_texts() {
    OtherStrings strings(options_.encoding);
    for (auto& feature : out_.features)
      for (auto& [name, value] : feature.attributes)
        if (auto* text = std::get_if<std::string>(&value)) strings.take(*text, name, feature.number);
    if (auto warning = strings.warning(subject_)) out_.warnings.push_back(*std::move(warning));
  }

  auto check(OGRLayer& layer, const std::string& where, bool boxed) const -> base::Result<void> {
    const auto& features = out_.features;
    // A source that breaks off says so; databases only look at the filter now.
    if (!messages_.failure().empty())
      return !where.empty() && features.empty() ? bad_filter(layer) : unreadable(messages_.failure());
    if (features.empty() && !at_opening_.empty()) return unreadable(at_opening_);
    // FlatGeobuf's reader stops without a word where the file does, but the header has the number of features.
    const bool counted = std::string_view(dataset_->GetDriverName()) == "FlatGeobuf" && where.empty() && !boxed;
    if (const auto count = counted ? layer.GetFeatureCount(FALSE) : 0; count > static_cast<GIntBig>(features.size()))
      return unreadable("it holds " + std::to_string(features.size()) + " of the " + std::to_string(count) +
                        " features it promises");
    if (features.empty() && no_buildings_ > 0)
      return base::error("ingest-footprints-none",
                         "none of the " + std::to_string(no_buildings_) +
                             " areas is tagged as a building; give a file with buildings, or check --ingest-where",
                         subject_);
    return check_features(features, where, subject_);
  }

 public:
  /// What holds for every kind of source.
  static auto check_features(const std::vector<RawFeature>& features, const std::string& where,
                             const std::string& subject) -> base::Result<void> {
    if (features.empty())
      return base::error("ingest-footprints-none",
                         where.empty() ? "there are no features; give a file with building footprints"
                                       : "no feature passes the filter '" + where + "'",
                         subject);
    if (std::ranges::any_of(features, [](const auto& feature) { return !feature.parts.empty(); })) return {};
    for (const auto& feature : features)
      if (!feature.failure.empty())
        return base::error(
            "ingest-footprints-format",
            "not a readable vector file (" + feature.failure + "); check what it is, or export the footprints again",
            subject);
    return base::error("ingest-footprints-geometry",
                       "none of the " + std::to_string(features.size()) + " features is a polygon (the first is " +
                           features.front().geometry + "); give footprints as polygons",
                       subject);
  }

 private:
  fs::path path_;
  std::string subject_;
  const FeatureQuery& options_;
  const base::Run& run_;
  crs::GdalMessages messages_;
  std::string at_opening_;
  GDALDatasetUniquePtr dataset_;  // after the messages: closing may say something too
  FeatureFile out_;
  std::size_t no_buildings_ = 0;
  BuildingRelations relations_;
};

/// Sets which pass `where`, by a table of their attributes in memory.
auto filter(std::vector<RawFeature>& features, const std::string& where, const std::string& subject)
    -> base::Result<void> {
  const crs::GdalMessages messages;
  crs::register_gdal();
  const auto failed = [&] {
    return base::error("ingest-where",
                       "its attributes could not be filtered (" + messages.failure() +
                           "); filter the file beforehand, as with ogr2ogr -where",
                       subject);
  };
  GDALDriver* maker = GetGDALDriverManager()->GetDriverByName("Memory");
  const GDALDatasetUniquePtr made(maker == nullptr ? nullptr : maker->Create("", 0, 0, 0, GDT_Unknown, nullptr));
  OGRLayer* table = made == nullptr ? nullptr : made->CreateLayer("buildings", nullptr, wkbNone, nullptr);
  if (table == nullptr) return failed();
  for (const auto& feature : features)
    for (const auto& [name, value] : feature.attributes) {
      if (table->GetLayerDefn()->GetFieldIndex(name.c_str()) >= 0 || value.index() == 0) continue;
      OGRFieldDefn field(name.c_str(), std::holds_alternative<double>(value)        ? OFTReal
                                       : std::holds_alternative<std::string>(value) ? OFTString
                                                                                    : OFTInteger64);
      if (table->CreateField(&field) != OGRERR_NONE) return failed();
    }
  for (std::size_t i = 0; i < features.size(); ++i) {
    const OGRFeatureUniquePtr row(OGRFeature::CreateFeature(table->GetLayerDefn()));
    row->SetFID(static_cast<GIntBig>(i));
    for (const auto& [name, value] : features[i].attributes) {
      const char* field = name.c_str();
      if (const auto* words = std::get_if<std::string>(&value)) row->SetField(field, words->c_str());
      if (const auto* whole = std::get_if<std::int64_t>(&value)) row->SetField(field, static_cast<GIntBig>(*whole));
      if (const auto* number = std::get_if<double>(&value)) row->SetField(field, *number);
      if (const auto* flag = std::get_if<bool>(&value)) row->SetField(field, *flag ? 1 : 0);
    }
    if (table->CreateFeature(row.get()) != OGRERR_NONE) return failed();
  }
  if (table->SetAttributeFilter(where.c_str()) != OGRERR_NONE)
    return base::error("ingest-where",
                       "'" + where + "' is no filter these attributes take (" + messages.failure() +
                           "); write it as in SQL after WHERE",
                       subject);
  for (auto& feature : features) feature.passes = false;
  table->ResetReading();
  while (const OGRFeatureUniquePtr row{table->GetNextFeature()})
    features[static_cast<std::size_t>(row->GetFID())].passes = true;
  return {};
}

/// A city model as a source; nothing where the file is none.
auto read_city_model(const fs::path& path, const FeatureQuery& options) -> base::Result<std::optional<FeatureFile>> {
  const std::string ending = plain_name(path).extension().string(), subject = path.string();
  if (ending != ".json" && ending != ".jsonl" && ending != ".cityjson" && ending != ".cityjsonl" && ending != ".gml" &&
      ending != ".citygml" && ending != ".xml")
    return std::optional<FeatureFile>();
  const auto bytes = Bytes::of(path);
  if (!bytes) return bytes.error();
  if (!looks_like_cityjson(bytes->view()) && !looks_like_citygml(bytes->view())) return std::optional<FeatureFile>();
  if (!options.layer.empty() && options.layer != "buildings")
    return base::error("ingest-layer", "there is no layer '" + options.layer + "'; the file has: buildings", subject);
  auto file = read_cityjson_footprints(bytes->view(), subject);
  if (!file) return file.error();
  if (!options.where.empty()) {
    if (auto done = filter(file->features, options.where, subject); !done) return done.error();
    auto passing = file->features;
    std::erase_if(passing, [](const auto& feature) { return !feature.passes; });
    if (auto sound = Source::check_features(passing, options.where, subject); !sound) return sound.error();
    if (!options.others) file->features = std::move(passing);
  }
  if (auto sound = Source::check_features(file->features, {}, subject); !sound) return sound.error();
  file->inputs = {{subject, bytes->view().size(), sha256(bytes->view())}};
  return std::optional(std::move(*file));
}

}  // namespace

auto read_features(const fs::path& path, const FeatureQuery& options, const base::Run& run)
    -> base::Result<FeatureFile> {
  const std::string subject = path.string();
  std::error_code failure;
  if (!is_database(path)) {
    if (!is_there(path)) return why_missing(path);
    if (auto piped = base::check_no_pipe(path); !piped) return piped.failure();
    if (fs::is_regular_file(path, failure) && fs::file_size(path, failure) == 0)
      return base::error("ingest-footprints-format", "the file is empty; export the footprints again", subject);
    auto model = read_city_model(path, options);
    if (!model) return model.error();
    if (auto& file = *model) return *std::move(file);
  }
  return Source(path, options, run).read();
}

auto bounds(const RawFeature& feature) -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto& part : feature.parts)
    for (const auto& ring : part)
      for (const auto p : ring)
        if (std::abs(p.x) < 1e8 && std::abs(p.y) < 1e8) box.add(p);  // not for NaN either
  return box;
}

auto bounds(const std::vector<RawFeature>& features) -> geometry::Box2 {
  geometry::Box2 box;
  for (const auto& feature : features) box.include(bounds(feature));
  return box;
}

}  // namespace mansard::formats
