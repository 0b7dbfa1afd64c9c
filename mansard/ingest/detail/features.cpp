#include "mansard/ingest/detail/features.hpp"

#include <ogrsf_frmts.h>
#include <algorithm>
#include <mutex>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/ingest/detail/attributes.hpp"
#include "mansard/ingest/detail/gdal_messages.hpp"
#include "mansard/ingest/detail/geojson.hpp"
#include "mansard/ingest/detail/hash.hpp"

namespace mansard::ingest::detail {
namespace {

namespace fs = std::filesystem;

auto open(const fs::path& path) -> GDALDatasetUniquePtr {
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
  // The GML driver would write a .gfs file beside its input.
  const CPLStringList quiet(CSLSetNameValue(nullptr, "WRITE_GFS", "NO"));
  const CPLStringList none;
  GDALDriverH driver = GDALIdentifyDriverEx(path.c_str(), GDAL_OF_VECTOR, nullptr, nullptr);
  const bool gml = driver != nullptr && std::string_view(GDALGetDescription(driver)) == "GML";
  return GDALDatasetUniquePtr(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                                nullptr, gml ? quiet.List() : none.List(), nullptr));
}

/// The files a source consists of (a Shapefile is three or more), by name; folders among them are looked into.
auto inputs_of(GDALDataset& dataset, const fs::path& path) -> base::Result<std::vector<InputFile>> {
  const CPLStringList listed(dataset.GetFileList());
  std::vector<std::string> names;
  for (int i = 0; i < listed.Count(); ++i) names.emplace_back(listed[i]);
  if (names.empty()) names.push_back(path.string());
  std::ranges::sort(names);
  std::vector<InputFile> out;
  for (const auto& name : names) {
    std::error_code failure;
    if (!fs::is_regular_file(name, failure)) continue;
    const auto bytes = base::read_file(name);
    if (!bytes) return bytes.error();
    out.push_back({name, bytes->size(), sha256(*bytes)});
  }
  return out;
}

auto polygons_possible(OGRLayer& layer) -> bool {
  const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
  return type == wkbUnknown || type == wkbGeometryCollection || OGR_GT_IsSubClassOf(type, wkbCurvePolygon) != 0 ||
         OGR_GT_IsSubClassOf(type, wkbMultiSurface) != 0;
}

auto choose_layer(GDALDataset& dataset, const Options& options, const std::string& subject,
                  std::vector<base::Diagnostic>& warnings) -> base::Result<OGRLayer*> {
  std::vector<std::string> names;
  for (auto* layer : dataset.GetLayers()) names.emplace_back(layer->GetName());
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  if (!options.layer.empty()) {
    if (OGRLayer* layer = dataset.GetLayerByName(options.layer.c_str())) return layer;
    const auto nearest = base::nearest_word(options.layer, names);
    return base::error("ingest-layer",
                       "there is no layer '" + options.layer + "'" +
                           base::did_you_mean(nearest) + "; the file has: " + all,
                       subject);
  }
  OGRLayer* chosen = nullptr;
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

auto wkt_of(const OGRSpatialReference* crs) -> std::string {
  if (crs == nullptr) return {};
  // GeoPackage has two "undefined" systems of its own; an engineering one is a local frame by another name.
  const char* name = crs->GetName();
  if (crs->IsLocal() || (name != nullptr && std::string_view(name).starts_with("Undefined "))) return {};
  char* text = nullptr;
  const char* options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  const OGRErr failed = crs->exportToWkt(&text, options);
  std::string wkt = failed == OGRERR_NONE && text != nullptr ? text : "";
  CPLFree(text);
  return wkt;
}

}  // namespace

auto read_features(const fs::path& path, const Options& options, const base::Run& run) -> base::Result<FeatureFile> {
  const std::string subject = path.string();
  std::error_code failure;
  if (!fs::exists(path, failure)) return base::error("file-missing", "no such file; check the path", subject);
  if (fs::is_regular_file(path, failure) && fs::file_size(path, failure) == 0)
    return base::error("ingest-footprints-format", "the file is empty; export the footprints again", subject);

  GdalMessages messages;
  const auto unreadable = [&](const std::string& why) {
    return base::error("ingest-footprints-format",
                       "not a readable vector file" + (why.empty() ? std::string() : " (" + why + ")") +
                           "; check what it is, or export the footprints again",
                       subject);
  };
  const auto dataset = open(path);
  if (!dataset) return unreadable(messages.failure());
  const std::string at_opening = messages.failure();
  FeatureFile out;
  auto inputs = inputs_of(*dataset, path);
  if (!inputs) return inputs.error();
  out.inputs = std::move(*inputs);
  auto chosen = choose_layer(*dataset, options, subject, out.warnings);
  if (!chosen) return chosen.error();
  OGRLayer& layer = **chosen;
  out.crs = wkt_of(layer.GetSpatialRef());
  if (std::string_view(dataset->GetDriverName()) == "GeoJSON") {
    const auto text = base::read_file(path);
    if (!text) return text.error();
    out.assumed_crs = !has_top_level_member(*text, "crs");
    // GDAL complains, and takes degrees instead.
    if (!out.assumed_crs && at_opening.find("crs") != std::string::npos) out.crs_failure = at_opening;
  }
  const auto bad_filter = [&] {
    return base::error("ingest-where",
                       "'" + options.where + "' is no filter this layer takes (" + messages.failure() +
                           "); write it as in SQL after WHERE",
                       subject);
  };
  if (!options.where.empty() && layer.SetAttributeFilter(options.where.c_str()) != OGRERR_NONE) return bad_filter();

  layer.ResetReading();
  for (;;) {
    if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");
    messages.forget();
    const OGRFeatureUniquePtr feature{layer.GetNextFeature()};
    if (!feature) break;
    out.features.push_back(to_raw(*feature));
    out.features.back().failure = messages.failure();
  }
  // A source that breaks off says so; databases only look at the filter now.
  if (!messages.failure().empty())
    return !options.where.empty() && out.features.empty() ? bad_filter() : unreadable(messages.failure());
  if (out.features.empty() && !at_opening.empty()) return unreadable(at_opening);
  // FlatGeobuf's reader stops without a word where the file does, but the header has the number of features.
  const bool counted = std::string_view(dataset->GetDriverName()) == "FlatGeobuf" && options.where.empty();
  if (const auto count = counted ? layer.GetFeatureCount(FALSE) : 0; count > static_cast<GIntBig>(out.features.size()))
    return unreadable("it holds " + std::to_string(out.features.size()) + " of the " + std::to_string(count) +
                      " features it promises");
  if (out.features.empty())
    return base::error("ingest-footprints-none",
                       options.where.empty() ? "there are no features; give a file with building footprints"
                                             : "no feature passes the filter '" + options.where + "'",
                       subject);
  if (std::ranges::none_of(out.features, [](const auto& feature) { return !feature.parts.empty(); })) {
    for (const auto& feature : out.features)
      if (!feature.failure.empty()) return unreadable(feature.failure);
    return base::error("ingest-footprints-geometry",
                       "none of the " + std::to_string(out.features.size()) + " features is a polygon (the first is " +
                           out.features.front().geometry + "); give footprints as polygons",
                       subject);
  }
  return out;
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
  for (const auto& feature : features)
    if (const auto own = bounds(feature); !own.empty()) {
      box.add(own.least);
      box.add(own.most);
    }
  return box;
}

}  // namespace mansard::ingest::detail
