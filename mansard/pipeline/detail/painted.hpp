// The colours of tags on the faces of models.
#pragma once

#include <optional>

#include "mansard/model/city.hpp"
#include "mansard/model/scene.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// Whether any feature of a scene, or a part of one, has a colour: then all models of a file have one.
[[nodiscard]] auto has_colours(const model::Scene& scene, const Options& options) -> bool;

/// A picture of one colour on every face of a building's solids: what ms_wall_colour and ms_roof_colour of its part
/// say, else the colour of its class. None where that part is not known.
[[nodiscard]] auto painted(const model::Building& building) -> std::optional<model::BuildingTexture>;

}  // namespace mansard::pipeline::detail
