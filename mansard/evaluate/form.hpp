// The form of a model: what a person who draws roofs objects to, with and without ground truth.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "mansard/evaluate/truth.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::evaluate {

/// The roof faces of one building that lie in one plane, whether they touch or not.
struct RoofPlane {
  geometry::Point3 normal;  ///< unit, upward; of the largest face
  geometry::Point3 point;   ///< a corner of that face
  double area = 0;          ///< m²
  Outline plan;             ///< seen from above; empty for vertical faces, and where it could not be computed
  double width = 0;         ///< m; the shorter side of the smallest rectangle, of any direction, around the plan
  std::uint32_t building = 0;
};

struct RoofPlanes {
  std::vector<RoofPlane> planes;             ///< of one building after the other, by the area of their largest face
  std::vector<std::uint32_t> plane_of_face;  ///< per face, counted through all parts; no_plane for other faces
  std::size_t unchecked = 0;                 ///< planes whose plan could not be computed
};
inline constexpr std::uint32_t no_plane = ~0U;

/// A face joins the plane of a larger one of its building within these two limits (all corners).
inline constexpr double same_plane_angle = 2, same_plane_distance = 0.1;  ///< degrees, m
[[nodiscard]] auto roof_planes_of(const model::Model& model) -> RoofPlanes;
/// rad from level.
[[nodiscard]] auto pitch_of(const RoofPlane& plane) -> double;
/// rad, 0 to 2π, clockwise from north: the direction in which the plane falls; none for a level one.
[[nodiscard]] auto azimuth_of(const RoofPlane& plane) -> std::optional<double>;
/// The centre of the plan at the height of the plane there, which is the mean height over the plan; none without a
/// plan.
[[nodiscard]] auto centre_of(const RoofPlane& plane) -> std::optional<geometry::Point3>;

enum class RoofLineKind : std::uint8_t { ridge, hip, valley, eave };
inline constexpr std::size_t roof_line_kinds = 4;
[[nodiscard]] auto to_string(RoofLineKind kind) -> std::string_view;

/// Where two roof planes of a building meet, or a pitched roof begins. The lines of mansards, verges, flat roofs and
/// single pitches' upper ends are none of these.
struct RoofLine {
  RoofLineKind kind = RoofLineKind::ridge;
  geometry::Point3 start, end;
  std::uint32_t building = 0, part = 0;  ///< part: counted through all buildings; of two, the first
};
[[nodiscard]] auto roof_lines_of(const model::Model& model, const RoofPlanes& planes) -> std::vector<RoofLine>;

/// What rises from a roof plane that surrounds it: dormers, plant rooms, cross gables. As cells of a grid.
struct RoofStructure {
  bool dormer = false;  ///< on a plane pitched by `dormer_pitch` or more
  std::uint32_t building = 0;
  struct Place {
    std::int64_t column = 0, row = 0;
    double z = 0;  ///< m
  };
  std::vector<Place> places;  ///< by row, then column
};
/// Seen from above on the grid: neighbouring cells of one building that are at least `structure_rise` above a roof
/// plane, at most `structure_height`, with 1 to 40 m², and at least half of the boundary along that plane. Parts with
/// the role "dormer" are dormers whatever their shape.
inline constexpr double structure_rise = 0.3, structure_height = 5;          ///< m
inline constexpr double structure_least_area = 1, structure_most_area = 40;  ///< m²
inline constexpr double dormer_pitch = 15;                                   ///< degrees
[[nodiscard]] auto roof_structures_of(const model::Model& model, const RoofPlanes& planes, double grid)
    -> std::vector<RoofStructure>;

/// What needs no truth. Planes and edges of all buildings.
struct Form {
  std::size_t buildings = 0, parts = 0;
  std::size_t planes = 0;
  std::size_t narrow = 0;                 ///< planes with a width under `narrow_width`
  std::size_t twins = 0, unequal = 0;     ///< pairs of planes with opposite azimuth and nearly equal pitch
  std::size_t steep = 0, steep_bare = 0;  ///< planes over `steep_pitch`; those that carry less than 1 m² of the scan
  std::size_t tall = 0;                   ///< parts with a height over 3 · √area
  std::size_t ridges = 0, ridges_unequal = 0;  ///< neighbours with ridges within 0.3 m; those not at one height
  std::size_t edges = 0, short_edges = 0;      ///< edges between planes; those under `short_edge`
  std::size_t vertices = 0;
  std::size_t dormers = 0, structures = 0;  ///< on pitched roofs, on flat ones
  std::size_t unchecked = 0;                ///< planes whose plan could not be computed: they are not narrow
};
inline constexpr double narrow_width = 0.75;                                 ///< m
inline constexpr double twin_azimuth = 3, twin_pitch = 3, twin_equal = 0.2;  ///< degrees
inline constexpr double twin_least_pitch = 10, twin_most_pitch = 65;         ///< degrees
inline constexpr double steep_pitch = 65;                                    ///< degrees
inline constexpr double steep_evidence = 1;                                  ///< m² of scan
inline constexpr double tall_ratio = 3;                                      ///< height / √area
inline constexpr double ridge_near = 0.3, ridge_equal = 0.01;                ///< m
inline constexpr double short_edge = 0.5;                                    ///< m

struct FormInput {
  const model::Model& model;
  const RoofPlanes& planes;
  const std::vector<RoofLine>& lines;
  const std::vector<RoofStructure>& structures;
};
/// Guarantees: 1 a plain gable has nothing to object to · 2 cutting faces into triangles changes nothing.
[[nodiscard]] auto form_of(const FormInput& model, const geometry::Mesh& scan) -> Form;

/// Two models of the same place, and what they have in common.
struct Found {
  std::size_t count = 0, found = 0;
  double size = 0, size_found = 0;  ///< m² of planes, m of lines
  void add(double one, double one_found, bool is_found) {
    ++count, size += one, size_found += one_found, found += is_found ? 1 : 0;
  }
};
struct FoundBoth {
  Found truth, model;  ///< of the truth, found in the model (recall); of the model, found in the truth (precision)
};

/// A roof plane of one model, compared with those of the other one.
struct ComparedPlane {
  enum class Result : std::uint8_t { too_small, not_found, found };  ///< too_small: under `found_least_area`
  /// The plane of the other model that shares the largest area with this one from above.
  struct Nearest {
    double angle = 0;   ///< rad between the two
    double height = 0;  ///< m; this plane − that plane in the middle of the shared area
    double shared = 0;  ///< m²
  };
  RoofPlane plane;
  Result result = Result::not_found;
  std::optional<Nearest> nearest;  ///< of planes that are not found; none where no plane shares any area
};
/// A building of the truth, or one that only the model has, with the roof planes of both models. A plane of a building
/// that is several of the truth's is in each of those with which it shares a quarter of its own plan or of the outline.
struct ComparedBuilding {
  std::optional<std::uint32_t> truth;  ///< number in its model; none for a building that the truth does not have
  std::vector<std::uint32_t> model;    ///< numbers in theirs
  std::vector<ComparedPlane> truth_planes, model_planes;
  double ground = 0;  ///< m; the lowest corner of the true building, without one of the model's
  /// Whether the building is in both models, and all planes of both that are compared are found.
  [[nodiscard]] auto every_plane_right() const -> bool;
};

struct FormTruth {
  std::size_t buildings = 0;
  FoundBoth planes;                              ///< of `found_least_area` and more
  std::array<FoundBoth, roof_line_kinds> lines;  ///< by RoofLineKind; of `found_least_length` and more
  FoundBoth dormers, structures;
  std::vector<ComparedBuilding> compared;  ///< those of the truth in its order, then those that only the model has
  Form form;                               ///< of the truth itself
  std::size_t unchecked = 0;               ///< pairs of planes that could not be intersected; not found
};
/// A plane is found in one of the same building within `found_angle`, with a plan that overlaps at least half of the
/// smaller of the two, and a vertical distance of at most `found_height` in the middle of the overlap.
inline constexpr double found_angle = 3, found_height = 0.25, found_least_area = 1;  ///< degrees, m, m²
/// A line is found where lines of the same kind, within `found_angle`, are within `found_distance` of half its length.
inline constexpr double found_distance = 0.3, found_least_length = 0.5;  ///< m
/// A dormer or another structure is found where one of the other model has half of its cells in common with it, half of
/// either, and heights that differ by at most 0.5 m (median). `grid`: that of both models' structures.
[[nodiscard]] auto compare_form(const FormInput& truth, const FormInput& model, double grid) -> FormTruth;

}  // namespace mansard::evaluate
