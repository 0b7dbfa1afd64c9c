// Models: roofs in one step, fitted to the scan.
#include <algorithm>

#include "apps/server/model_boxes.hpp"
#include "apps/server/models.hpp"
#include "mansard/edit/roofs.hpp"

namespace mansard::server {

auto Models::roofs(const RoofsRequest& request, const OpenScene* scene) const -> base::Result<std::string> {
  const auto now = view();
  for (const auto& part : request.parts)
    if (const auto at = known({part.at.building, 0, {}}, *now); !at) return at.error();
  if (scene == nullptr)
    return base::error("edit-unseen", "there is no scan to fit roofs to; open the inputs of the run");
  std::vector<Json> roofs(request.parts.size());
  base::parallel_for(roofs.size(), [&](std::size_t i) {
    const auto& [at, plan] = request.parts[i];
    const auto box = geometry::bounds(plan.outer.points);
    std::vector<model::Plan> others;
    for (std::size_t b = 0; b < now->buildings.size(); ++b) {
      const auto& building = *now->buildings[b];
      if (!touch(box, building.box)) continue;
      const auto parts = parts_of(b, building);
      for (const auto& part : *parts)
        if (building.id != at.building || part.id != at.part) others.push_back(part.plan);
    }
    const auto mesh = scene->rays_of(at.building);
    const auto roof = mesh == nullptr ? base::Result<edit::FittedRoof>(base::error(
                                            "edit-unseen", "the scan does not cover this building", at.building))
                      : request.kind  ? edit::roof_of(*request.kind, plan, others, *mesh, options_)
                                      : edit::fitted_roof(plan, *mesh, options_);
    const auto before = mesh == nullptr ? std::nullopt : edit::error_of(plan, *mesh, options_);
    roofs[i] = {{"building", at.building},
                {"part", at.part},
                {"plan", roof ? json_of(roof->plan) : Json(nullptr)},
                {"mse", roof && roof->mse ? Json(*roof->mse) : Json(nullptr)},
                {"mse_before", before ? Json(*before) : Json(nullptr)},
                {"why", roof ? Json(nullptr) : json_of(roof.error())}};
  });
  return text_of({{"roofs", roofs}});
}

}  // namespace mansard::server
