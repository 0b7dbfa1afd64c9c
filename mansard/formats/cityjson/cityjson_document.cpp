#include "mansard/formats/cityjson/cityjson_document.hpp"

#include <limits>

#include "mansard/base/nesting.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/citygml/citygml_document.hpp"
#include "mansard/formats/files/words.hpp"

namespace mansard::formats {
namespace {

auto objects_of(const Json& document) -> const Json& {
  const Json& objects = member(document, "CityObjects");
  return objects.is_object() ? objects : nothing();
}

auto check_head(const Json& document, const CityComplaints& complaints) -> base::Result<void> {
  if (text_of(member(document, "type")) != "CityJSON") return complaints("it is JSON, but no CityJSON");
  const std::string version = text_of(member(document, "version"));
  if (version.starts_with("1.") || version.starts_with("2.")) return {};
  return complaints("it is CityJSON " + (version.empty() ? "without a version" : version) +
                    ", and 1.0 to 2.0 are read");
}

/// A line per document: the first is the head, the others are features with vertices of their own.
auto each_line(std::string_view bytes, const CityComplaints& complaints,
               const std::function<base::Result<void>(const CityDocument&)>& work, Json& head) -> base::Result<void> {
  CityTransform transform;
  for (std::size_t number = 1; !bytes.empty(); ++number) {
    const auto line = take_line(bytes);
    if (line.find_first_not_of(" \t") == line.npos) continue;
    Json json = Json::parse(line, nullptr, false);
    if (json.is_discarded()) return complaints(complaints.not_json(number, head.is_null()));
    if (head.is_null()) {
      if (auto sound = check_head(json, complaints); !sound) return sound;
      transform = transform_of(json);
      head = json;
    }
    const CityDocument document(json, transform);
    if (document.objects().is_null()) return complaints("it has no CityObjects");
    if (auto done = work(document); !done) return done;
  }
  return {};
}

}  // namespace

auto transform_of(const Json& document) -> CityTransform {
  CityTransform out;
  const Json& transform = member(document, "transform");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const Json& s = item(member(transform, "scale"), axis); s.is_number()) out.scale[axis] = s.get<double>();
    if (const Json& t = item(member(transform, "translate"), axis); t.is_number())
      out.translate[axis] = t.get<double>();
  }
  return out;
}

CityDocument::CityDocument(const Json& json, const CityTransform& transform) : objects_(objects_of(json)) {
  constexpr double lost = std::numeric_limits<double>::quiet_NaN();
  const Json& vertices = member(json, "vertices");
  if (!vertices.is_array()) return;
  vertices_.reserve(vertices.size());
  for (const Json& vertex : vertices) {
    std::array<double, 3> c{lost, lost, lost};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const Json& number = item(vertex, axis); number.is_number())
        c[axis] = number.get<double>() * transform.scale[axis] + transform.translate[axis];
    vertices_.push_back({c[0], c[1], c[2]});
  }
}

auto CityDocument::vertex(const Json& index) const -> const geometry::Point3* {
  if (!index.is_number_integer() || index.get<std::int64_t>() < 0) return nullptr;
  const auto number = index.get<std::uint64_t>();
  return number < vertices_.size() ? &vertices_[static_cast<std::size_t>(number)] : nullptr;
}

auto each_document(std::string_view bytes, const CityComplaints& complaints,
                   const std::function<base::Result<void>(const CityDocument&)>& work) -> base::Result<std::string> {
  if (looks_like_citygml(bytes)) return each_citygml_building(bytes, complaints, work);
  if (base::nests_too_deep(bytes)) return complaints("its JSON nests too deep");
  Json head = Json::parse(bytes, nullptr, false);
  if (head.is_discarded()) {
    head = Json();
    if (auto done = each_line(bytes, complaints, work, head); !done) return done.error();
  } else {
    if (auto sound = check_head(head, complaints); !sound) return sound.error();
    const CityDocument document(head, transform_of(head));
    if (document.objects().is_null()) return complaints("it has no CityObjects");
    if (auto done = work(document); !done) return done.error();
  }
  return text_of(member(member(head, "metadata"), "referenceSystem"));
}

auto lod_of(const Json& geometry) -> std::string {
  const Json& lod = member(geometry, "lod");
  return lod.is_number() ? base::to_text(lod.get<double>()) : text_of(lod);
}

auto shell_depth(const Json& geometry) -> std::optional<int> {
  const std::string type = text_of(member(geometry, "type"));
  if (type == "MultiSurface" || type == "CompositeSurface") return 0;
  if (type == "Solid") return 1;
  if (type == "MultiSolid" || type == "CompositeSolid") return 2;
  return std::nullopt;
}

}  // namespace mansard::formats
