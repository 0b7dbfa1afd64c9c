// What a comparison of a model with a mesh, and with ground truth, found; as JSON and as a table.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/evaluate/distances.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/evaluate/form.hpp"
#include "mansard/evaluate/points.hpp"
#include "mansard/evaluate/truth.hpp"
#include "mansard/model/scene.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::report {

/// Whose footprints say where a building should be: those asked for, else the truth's, else the model's own.
enum class Reference : std::uint8_t { footprints, truth, model };
[[nodiscard]] auto to_string(Reference reference) -> std::string_view;

/// Everything in the frame of the model.
struct EvaluationInput {
  model::Model model;
  std::optional<model::Model> truth;
  model::Scene scene;  ///< the mesh with the reference's footprints; `warnings` of all files
  Reference reference = Reference::model;
  std::vector<geometry::Point3> building_points;  ///< by their class, where point clouds are among the meshes
};

struct ModelCounts {
  std::size_t buildings = 0, parts = 0, faces = 0, planes = 0;
  std::array<double, model::surface_class_count> area{};  ///< m² per class
};

/// A building of the reference.
struct BuildingScores {
  std::string id, block;
  evaluate::Scores scores;  ///< over its own footprint
  evaluate::Prism prism;    ///< the footprint raised to the mesh's median height over it
  std::optional<evaluate::Scores> from_truth, prism_from_truth;  ///< the same two against the truth's surface
  bool modelled = false;                                         ///< the model covers at least half of it
};

/// m²; a model whose MSE over a footprint is this much above that of the prism is worse than it. Less is the noise of
/// the scan: 0.1 m, squared.
inline constexpr double worse_by = 0.01;
[[nodiscard]] auto worse_than_prism(const BuildingScores& building) -> bool;
[[nodiscard]] auto worse_than_prism_from_truth(const BuildingScores& building) -> bool;

struct BlockScores {
  std::string name;
  std::size_t buildings = 0, model_buildings = 0;
  evaluate::Scores scores;
  evaluate::Spread from_model, from_scan;  ///< m
};

struct TruthScores {
  evaluate::Scores scores, prism;  ///< of the model and of the prisms, as against the mesh, against the truth's surface
  evaluate::Partition parts, buildings;
  evaluate::PartyWalls party_walls;  ///< truth, found: of its buildings; model, right: of all parts
  evaluate::Roofs roofs;
  evaluate::Confusion classes;
  evaluate::FormTruth form;
};

struct Evaluation {
  ModelCounts counts;
  evaluate::Form form;
  evaluate::Scores scores;                 ///< over all blocks; quantiles of all cells
  evaluate::Scores prism;                  ///< of the buildings' prisms
  evaluate::Spread from_model, from_scan;  ///< m
  std::vector<BlockScores> blocks;
  std::vector<BuildingScores> buildings;  ///< in the reference's order, without those that cannot be used
  std::vector<std::string> beside;        ///< model buildings on no footprint of the reference: invented
  std::optional<TruthScores> truth;
  std::optional<evaluate::PointScores> points;  ///< of EvaluationInput::building_points
  evaluate::ErrorMap map;
  evaluate::Options options;  ///< it was measured with
  std::int64_t seed = 1;
  std::string version;  ///< of mansard
  std::vector<base::Diagnostic> warnings;
};

/// The report as JSON: docs/evaluate.md lists its members.
[[nodiscard]] auto evaluation_json(const Evaluation& evaluation, const EvaluationInput& input) -> std::string;
/// The same for a person, in a few lines.
[[nodiscard]] auto evaluation_table(const Evaluation& evaluation, const EvaluationInput& input) -> std::string;

/// Square metres by true class and class given, as a small table.
using ClassAreas = std::array<std::array<double, model::surface_class_count>, model::surface_class_count>;
[[nodiscard]] auto confusion_table(const ClassAreas& area) -> std::string;

}  // namespace mansard::report
