// What a model says of itself in attributes: heights, roof type, volume, areas, error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// Heights of a top surface over a polygon, sorted; on a grid aligned to whole multiples of `grid`, coarser for
/// polygons so large that it would not matter.
[[nodiscard]] auto heights_over(const rays::Scene& surface, const geometry::Polygon& polygon, double grid)
    -> std::vector<double>;

/// z of the model's top surface on a grid, sorted; of its corners where it is smaller than the grid.
[[nodiscard]] auto roof_heights(const model::LabelledSolid& model, const model::Plan& plan, double grid)
    -> std::vector<double>;

/// In the words of 3DBAG: "horizontal", "multiple horizontal", "slanted".
[[nodiscard]] auto roof_type(const model::LabelledSolid& model) -> std::string;
/// z of the highest corner of a pitched face, where there is one.
[[nodiscard]] auto ridge_height(const model::LabelledSolid& model) -> std::optional<double>;

/// The value below which that share (0 … 1) of the sorted, non-empty values lies.
[[nodiscard]] auto percentile(const std::vector<double>& sorted, double share) -> double;

/// The attributes that speak of the model, in the file's heights: `z0` is that of the origin. `roof` is of
/// roof_heights; `fallback` the code of the reason why the model is simpler than its plan, empty when it is not.
[[nodiscard]] auto model_attributes(const model::LabelledSolid& model, const model::Plan& plan,
                                    const std::vector<double>& roof, const std::optional<double>& mse,
                                    const std::string& fallback, double z0) -> model::Attributes;

}  // namespace mansard::pipeline::detail
