// CityJSON 1.0 to 2.0 and CityJSONSeq as they are parsed for all readers: documents, vertices, geometries, semantics.
// Nothing in a file is trusted: what is missing or of another kind is null. How strict to be is left to each reader.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/json/json_access.hpp"
#include "mansard/formats/json/json_item.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {

/// From the integers of a document to coordinates: times `scale`, plus `translate`.
struct CityTransform {
  std::array<double, 3> scale{1, 1, 1}, translate{0, 0, 0};
};
/// Numbers that are missing are those of a document without a transform.
[[nodiscard]] auto transform_of(const Json& document) -> CityTransform;

/// A whole CityJSON, or a line of CityJSONSeq.
class CityDocument {
 public:
  /// `json` must outlive it. Features of CityJSONSeq use the transform of the first line.
  CityDocument(const Json& json, const CityTransform& transform);
  /// "CityObjects"; null if it is missing or not an object.
  [[nodiscard]] auto objects() const -> const Json& { return objects_; }
  /// The vertex that an index of a ring names, in the coordinates of the file, NaN for what is not a number; null if
  /// there is no such vertex.
  [[nodiscard]] auto vertex(const Json& index) const -> const geometry::Point3*;

 private:
  const Json& objects_;
  std::vector<geometry::Point3> vertices_;
};

/// How a reader reports a file that cannot be parsed.
struct CityComplaints {
  std::string code, subject;
  /// Says that a line is not JSON. `first` if nothing before it was JSON either.
  std::function<std::string(std::size_t line, bool first)> not_json;

  [[nodiscard]] auto operator()(const std::string& what) const -> base::Diagnostic {
    return base::error(code, what + "; check what the file is, or export it again", subject);
  }
};

/// Parses a file and calls `work` with each document in it: one, those of CityJSONSeq line by line, or those of CityGML
/// building by building. Returns the
/// reference system of the file as it is spelled, empty if there is none. Fails with the code of `complaints` and
/// with what `work` fails with.
[[nodiscard]] auto each_document(std::string_view bytes, const CityComplaints& complaints,
                                 const std::function<base::Result<void>(const CityDocument&)>& work)
    -> base::Result<std::string>;

/// "lod" as text: it is a string since CityJSON 1.1 and was a number before.
[[nodiscard]] auto lod_of(const Json& geometry) -> std::string;

/// How many lists are around the surfaces of a geometry: 0 for a MultiSurface, 1 for the shells of a Solid, 2 for the
/// solids of a MultiSolid. None for other types.
[[nodiscard]] auto shell_depth(const Json& geometry) -> std::optional<int>;

namespace detail {

/// The shell of a solid, or all surfaces of a MultiSurface. What `surfaces` is need not be a list.
struct CityShell {
  Item surfaces;
  const Json& values;      ///< a number of a semantic surface for each surface
  const Json& semantics;   ///< the semantic surfaces
  std::size_t number = 0;  ///< in its solid: 0 is the outer one
};

/// Calls `work` with each shell of a geometry of any type that has surfaces. A solid without shells has one that is
/// null.
template <class Work>
void each_shell(const Item& geometry, Work work) {
  const auto depth = shell_depth(geometry.json);
  if (!depth) return;
  const Json &semantics = formats::member(geometry.json, "semantics"),
             &surfaces = formats::member(semantics, "surfaces");
  const Item boundaries{formats::member(geometry.json, "boundaries"), {&geometry.place, "boundaries", 0}};
  const Json& values = formats::member(semantics, "values");
  const auto solid = [&](const Item& shells, const Json& of_shells) {
    const std::size_t count = shells.json.is_array() && !shells.json.empty() ? shells.json.size() : 1;
    for (std::size_t i = 0; i < count; ++i)
      work(CityShell{{item(shells.json, i), {&shells.place, {}, i}}, item(of_shells, i), surfaces, i});
  };
  if (*depth == 0) work(CityShell{boundaries, values, surfaces, 0});
  if (*depth == 1) solid(boundaries, values);
  if (*depth == 2)
    for (std::size_t i = 0; i < boundaries.json.size(); ++i)
      solid({item(boundaries.json, i), {&boundaries.place, {}, i}}, item(values, i));
}

/// A polygon of a shell: its rings, the outer one first, and the semantic surface that it is; null if there is none.
struct CitySurface {
  Item rings;
  const Json& semantics;
};

/// Calls `work` with each surface of a shell that is a list.
template <class Work>
void each_surface(const CityShell& shell, Work work) {
  for (std::size_t i = 0; shell.surfaces.json.is_array() && i < shell.surfaces.json.size(); ++i) {
    const Json& value = item(shell.values, i);
    const Json& own = value.is_number_unsigned() ? item(shell.semantics, value.get<std::size_t>()) : nothing();
    work(CitySurface{{shell.surfaces.json[i], {&shell.surfaces.place, {}, i}}, own});
  }
}

}  // namespace detail

}  // namespace mansard::formats
