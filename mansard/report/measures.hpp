// What is measured of a whole building: heights, areas and counts of its solids, each level of detail, and how much of
// its footprint the scan covers.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mansard/confidence/confidence.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/formats/levels.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/city.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/solid/half_edges.hpp"

namespace mansard::report {

/// What is measured of a building: its solids, or the models of its parts where it has none.
[[nodiscard]] auto solids_of(const model::Building& building) -> std::vector<const model::LabelledSolid*>;

/// Several solids side by side, for questions that concern their faces.
[[nodiscard]] auto together(const std::vector<const model::LabelledSolid*>& solids) -> model::LabelledSolid;

/// A line of the eaves.
struct Eave {
  std::size_t solid = 0;
  solid::Line line;
  double z = 0, length = 0;  ///< m; units of the files
};
/// The eaves and the edges of flat roofs, rising.
[[nodiscard]] auto eaves_of(const std::vector<const model::LabelledSolid*>& solids) -> std::vector<Eave>;
/// The one at the height below which that share of their length lies; there is one.
[[nodiscard]] auto eave_at(const std::vector<Eave>& eaves, double share) -> const Eave&;

/// Of its solids, or of its parts where it has none: heights in those of the file, whose origin is at `z0` (m); areas,
/// counts, storeys of `storey` metres, CityGML's measuredHeight, roofType and storeysAboveGround. Attributes of these
/// three names that the source has stay as they are. Nothing of a building without a model.
/// Storeys are above `ground_mean` (z of the frame, m), the mean of the terrain at the walls, where that is known, else
/// above the base.
[[nodiscard]] auto building_measures(const model::Building& building, double z0, double storey,
                                     std::optional<double> ground_mean = {}) -> model::Attributes;

/// The attributes of a level of detail, in the order of the levels.
struct LevelNames {
  formats::Lod lod = formats::Lod::lod22;
  const char *volume = "", *surface = "", *rmse = "", *val3dity = "";
};
[[nodiscard]] auto level_names() -> std::span<const LevelNames>;
[[nodiscard]] auto level_names(formats::Lod lod) -> const LevelNames&;

/// Volume and surface of every level of detail, whether it is valid, and with a mesh its root mean square vertical
/// error as evaluate::error_over. LoD 2.2 has volume and error elsewhere.
[[nodiscard]] auto level_measures(const model::Building& building, const model::Frame& frame,
                                  const solid::LevelOptions& options, const rays::Scene* mesh,
                                  const evaluate::Options& error) -> model::Attributes;

/// How much of polygons a mesh covers, on a grid that is coarser for polygons of more than 250,000 cells.
struct Coverage {
  double missing = 0;  ///< share of the area without a surface above or below, 0 to 1
  double radius = 0;   ///< m; of the largest circle in the polygons without a surface, to half a cell
};
[[nodiscard]] auto coverage(const rays::Scene& mesh, std::span<const geometry::Polygon> polygons, double grid)
    -> Coverage;

/// Sets ms_reasons, after the attributes of add_quality, to what the reasons say, the first one first; none where there
/// is none.
void set_reasons(model::Attributes& attributes, const std::vector<base::Diagnostic>& reasons);

/// The checks that a building failed, of "outcome" (some part is simpler than its profiles), "validity" (a level of
/// detail is not valid), "coverage" (the scan covers less than half of the footprint) and "ground" (nothing shows it).
/// `levels` has the attributes of level_measures.
[[nodiscard]] auto failed_checks(std::string_view outcome, const model::Attributes& levels,
                                 std::string_view ground_source = {}) -> std::vector<std::string_view>;

/// ms_quality, ms_checks and, where the model was measured with a scan, ms_confidence and ms_error.
void add_quality(std::string_view outcome, const std::vector<std::string_view>& failed,
                 const std::optional<confidence::Confidence>& confidence, model::Attributes& attributes);

}  // namespace mansard::report
