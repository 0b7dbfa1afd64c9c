// Attributes of models: heights, roof type, volume, areas, error; and what each attribute means.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/evaluate/evaluate.hpp"
#include "mansard/formats/attributes.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/city.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::report {

/// Those of `formats`, and those that describe how a model was made and what it measures.
[[nodiscard]] auto attributes() -> std::vector<formats::Attribute>;

/// Heights of a top surface over a polygon, sorted; on a grid aligned to whole multiples of `grid`, coarser for
/// polygons so large that it would not matter, and finer for those between whose edges no sample would lie.
[[nodiscard]] auto heights_over(const rays::Scene& surface, const geometry::Polygon& polygon, double grid)
    -> std::vector<double>;

/// z of the model's top surface on a grid, sorted; of its corners where it is smaller than the grid.
[[nodiscard]] auto roof_heights(const model::LabelledSolid& model, const model::Plan& plan, double grid)
    -> std::vector<double>;

/// In the words of 3DBAG: "horizontal", "multiple horizontal", "slanted".
[[nodiscard]] auto roof_type(const model::LabelledSolid& model) -> std::string;
/// z of the highest corner of a pitched face, where there is one.
[[nodiscard]] auto ridge_height(const model::LabelledSolid& model) -> std::optional<double>;

/// z of the highest corner; the solid has one.
[[nodiscard]] auto top_of(const model::Solid& solid) -> double;

/// The attributes that speak of the model, in the file's heights: `z0` is that of the origin. `roof` is of
/// roof_heights; `fallback` the code of the reason why the model is simpler than its plan, empty when it is not.
[[nodiscard]] auto model_attributes(const model::LabelledSolid& model, const model::Plan& plan,
                                    const std::vector<double>& roof, const std::optional<double>& mse,
                                    const std::string& fallback, double z0) -> model::Attributes;

/// How a model is measured.
struct Sampling {
  double roof_grid = 0.5;   ///< m; of the roof's heights
  evaluate::Options error;  ///< of the vertical error
};
/// The attributes of a part that speak of its model (heights, roof type, volume, areas, error, fallback), measured
/// anew; all others stay as `part` has them. `mesh` may be null: no error then. `fallback`: the code of the reason why
/// the model is simpler than its plan; empty when it is not. `z0`: z of the frame's origin, metres.
[[nodiscard]] auto part_attributes(const model::Part& part, const std::string& fallback, const rays::Scene* mesh,
                                   double z0, const Sampling& sampling) -> model::Attributes;
/// The same for a building, of the attributes of its parts.
[[nodiscard]] auto building_attributes(const model::Building& building, double z0) -> model::Attributes;

/// Rounds the measured numbers (ms_…) to four decimals: 0.1 mm, 1 cm², 100 cm³. What is beyond them depends on where
/// the frame begins.
void round_measures(model::Attributes& attributes);
[[nodiscard]] auto rounded_measure(double value) -> double;

}  // namespace mansard::report
