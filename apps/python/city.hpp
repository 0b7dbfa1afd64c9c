// A city in the hands of Python: buildings, parts, plans that can be edited, solids as arrays.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mansard/edit/edit.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::python {

/// Mesh and footprints in one frame, with the surface for rays once it is needed.
class Scan {
 public:
  explicit Scan(model::Scene scene) : scene_(std::move(scene)) {}
  [[nodiscard]] auto scene() const -> const model::Scene& { return scene_; }
  [[nodiscard]] auto rays() const -> const rays::Scene&;

 private:
  model::Scene scene_;
  mutable std::optional<rays::Scene> rays_;
};

/// What a run made, and the plans as they are being edited.
struct CityState {
  model::City city;
  std::vector<std::vector<edit::NamedPlan>> plans;  ///< per building, as edited
  std::vector<report::BuildingReport> reports;      ///< per building; empty for a file that was read
  std::optional<report::Summary> summary;           ///< of a run
  std::vector<evaluate::ErrorMap> error_maps;
  std::string report;                ///< run.json; empty for a file that was read
  std::shared_ptr<const Scan> scan;  ///< what it was reconstructed from, where that is known
  pipeline::Options options;
  std::vector<base::Diagnostic> warnings;
  [[nodiscard]] auto edited(std::size_t building) const -> bool;
};
using CityPointer = std::shared_ptr<CityState>;

/// Sets `plans` to those of the city.
[[nodiscard]] auto city_pointer(CityState state) -> CityPointer;

void bind_city(pybind11::module_& m);

/// A read-only array over memory that belongs to `owner`.
template <class T>
auto view(const T* data, std::vector<pybind11::ssize_t> shape, const pybind11::object& owner) -> pybind11::array_t<T> {
  pybind11::array_t<T> array(std::move(shape), data, owner);
  pybind11::detail::array_proxy(array.ptr())->flags &= ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// The same over a vector that the array takes.
template <class T, class Element>
auto taken(std::vector<Element> values, pybind11::ssize_t columns) -> pybind11::array_t<T> {
  static_assert(sizeof(Element) % sizeof(T) == 0);
  auto* kept = new std::vector<Element>(std::move(values));
  const pybind11::capsule owner(kept, [](void* p) { delete static_cast<std::vector<Element>*>(p); });
  const auto rows = static_cast<pybind11::ssize_t>(kept->size());
  std::vector<pybind11::ssize_t> shape{rows};
  if (columns > 0) shape.push_back(columns);
  return pybind11::array_t<T>(shape, reinterpret_cast<const T*>(kept->data()), owner);
}

/// (n, 2) and (n, 3), metres.
[[nodiscard]] auto ring_array(const geometry::Ring& ring) -> pybind11::array_t<double>;
/// Polygons in the file's coordinates, as a GeoJSON geometry.
[[nodiscard]] auto geo_of(const std::vector<geometry::Polygon>& polygons, const model::Frame& frame) -> pybind11::dict;
/// The values (rows, columns) from the south, and (xmin, xmax, ymin, ymax) in the file's coordinates.
[[nodiscard]] auto map_array(evaluate::ErrorMap map, const model::Frame& frame) -> pybind11::tuple;
[[nodiscard]] auto to_python(const model::Value& value) -> pybind11::object;

}  // namespace mansard::python
