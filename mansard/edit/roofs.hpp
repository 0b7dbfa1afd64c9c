// Roofs in one step: the best of a kind for the scan, over a part among its neighbours.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/refine/kinds.hpp"

namespace mansard::edit {

/// Per edge of the outer ring whether outlines of others run along more than a third of it, within 5 cm.
[[nodiscard]] auto shared_edges(const model::Plan& plan, std::span<const model::Plan> others) -> std::vector<bool>;

/// What an edit makes worse, as warnings: "edit-error" where the root mean square error of a building rises by half and
/// by more than 5 cm, "edit-above" where it is more than 2 m above all that the scan shows over its parts. `before`:
/// m², the error without the edit.
[[nodiscard]] auto doubts_of(const RaisedBuilding& building, std::optional<double> before, const rays::Scene& mesh)
    -> std::vector<base::Diagnostic>;

/// A roof, and its error over the part as raise() measures it.
struct FittedRoof {
  model::Plan plan;
  std::optional<double> mse;  ///< m²; none where the scan does not cover the part
};
/// m²: of a plan over its polygon; none where it cannot be raised, or the scan does not cover it.
[[nodiscard]] auto error_of(const model::Plan& plan, const rays::Scene& mesh, const pipeline::Options& options)
    -> std::optional<double>;
/// The part with the best roof of a kind for the scan. Fails as refine::roof_of.
[[nodiscard]] auto roof_of(refine::Kind kind, const model::Plan& plan, std::span<const model::Plan> others,
                           const rays::Scene& mesh, const pipeline::Options& options, const base::Run& run = {})
    -> base::Result<FittedRoof>;
/// The part with the roof that it has, fitted to the scan. Fails as refine::fitted.
[[nodiscard]] auto fitted_roof(const model::Plan& plan, const rays::Scene& mesh, const pipeline::Options& options,
                               const base::Run& run = {}) -> base::Result<FittedRoof>;

}  // namespace mansard::edit
