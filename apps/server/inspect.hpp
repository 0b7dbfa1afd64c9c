// Answers about models beyond what editing needs: attributes, levels of detail, models of others.
#pragma once

#include <string>
#include <vector>

#include "apps/server/json.hpp"
#include "mansard/formats/attributes.hpp"
#include "mansard/formats/levels.hpp"
#include "mansard/model/city.hpp"
#include "mansard/model/surfaces.hpp"
#include "mansard/pipeline/placing.hpp"

namespace mansard::server {

/// Attributes: those of the source and those that mansard computed, per building and part, and what they mean.
[[nodiscard]] auto attributes_json(const model::City& city) -> Json;

/// AttributeMeaning of each name, in that order.
[[nodiscard]] auto meanings_json(const std::vector<std::string>& names) -> Json;
/// A value as JSON; null where it is no finite number.
[[nodiscard]] auto value_json(const model::Value& value) -> Json;

/// LevelsOfDetail: the solids of every building at one level of detail. `lod` is "1.2", "1.3" or "2.0".
[[nodiscard]] auto level_json(const model::City& city, formats::Lod lod, const solid::LevelOptions& options) -> Json;

/// OtherModel: the faces of models of any producer, in the frame of the project.
[[nodiscard]] auto other_model_json(const model::Model& model) -> Json;

/// Alignment: what makes mesh and footprints match; null if nothing was found.
[[nodiscard]] auto placing_json(const std::optional<pipeline::Placing>& placing, const pipeline::Options& options)
    -> Json;

}  // namespace mansard::server
