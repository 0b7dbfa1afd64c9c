// Files that mansard wrote, as models again: taken as they are where a file has them, else raised from its plans.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mansard/formats/stream.hpp"
#include "mansard/ingest/model.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline {

/// Whether an error of formats::read_city means that the file is none of mansard's, rather than one of them that is
/// broken: "write-read-format", "write-read-plans", "write-plan-type".
[[nodiscard]] auto is_foreign(const base::Diagnostic& why) -> bool;

/// Sets the options that plans are extruded and classified by (those of the modules extrude and label) to what a file
/// says it was made with. Warnings: "option-unknown" and "option-value" of what this version does not take.
[[nodiscard]] auto take_options(const model::MadeBy& made_by, Options& options) -> std::vector<base::Diagnostic>;
/// Writes down these options as what it is made with now; all others stay as they were.
void note_options(const Options& options, model::MadeBy& made_by);
/// Whether they are what the file was made with.
[[nodiscard]] auto same_options(const model::MadeBy& made_by, const Options& options) -> bool;

/// All that is left in a file, with models raised with `options`, which give faces what CityJSON has no place for.
/// Where the file has solids, was made with these options, and other solids come of its plans, since another program or
/// version changed them, its own stay: those of buildings, or of single parts, united unless options.write asks for
/// parts. Parts that could not be read are `refused` too. Fails as the reader and raise_plans do.
[[nodiscard]] auto read_raised(formats::CityReader& reader, const Options& options, const base::Run& run = {})
    -> base::Result<RaisedPlans>;

/// The models as ingest::read_model gives those of any producer, without `inputs`.
[[nodiscard]] auto model_of(const model::City& city) -> model::Model;

/// A model of any producer: as ingest::read_model where that knows the format (CityJSON, CityJSONSeq, OBJ), and
/// whatever else mansard wrote, raised from its plans. Fails as these do, and with "ingest-model-lod" for a LoD that is
/// not in it, "ingest-model-crs" for another CRS than its own.
[[nodiscard]] auto read_any_model(const std::filesystem::path& path, const ingest::ModelOptions& options = {},
                                  const base::Run& run = {}) -> base::Result<model::Model>;

}  // namespace mansard::pipeline
