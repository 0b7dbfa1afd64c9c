// The paper's experiments, each as one call: settings over scans, a row of numbers per run, and a report of them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::explore {

enum class Experiment : std::uint8_t {
  alpha_beta,  ///< Figure 6: plans over α and β
  quality,     ///< Figure 7: models and errors at each profile quality
  gamma,       ///< Figure 8: γ from 10 to 90 m²
  datasets,    ///< Figure 9: scans, models and error maps, with Table 1
  profiles,    ///< Figure 10: every profile of a dataset in one plot
  table,       ///< Table 1
  grid,        ///< whatever is asked for
};
[[nodiscard]] auto to_string(Experiment experiment) -> std::string_view;
[[nodiscard]] auto experiment_of(std::string_view name) -> std::optional<Experiment>;
[[nodiscard]] auto experiment_names() -> std::vector<std::string>;

/// An option and the values it takes one after the other.
struct Axis {
  std::string key;  ///< "module.name"
  std::vector<std::string> values;
};

/// Reads "key=a,b,c". A key is "module.name", or as on the command line ("sweep-gamma", "gamma").
/// Fails with "explore-axis", "option-unknown", "option-value".
[[nodiscard]] auto axis_of(std::string_view text) -> base::Result<Axis>;

/// The experiment's own axes; one that is asked for takes the place of the one of its key. `grid` has those asked for
/// alone. Fails with "explore-axis".
[[nodiscard]] auto axes_of(Experiment experiment, const std::vector<Axis>& asked) -> base::Result<std::vector<Axis>>;

/// Options and their values, as text.
using Setting = std::vector<std::pair<std::string, std::string>>;

/// Every combination of values, the last axis fastest; without axes one empty setting.
/// Fails with "explore-runs" where there are more than `most`.
[[nodiscard]] auto settings_of(const std::vector<Axis>& axes, std::size_t most) -> base::Result<std::vector<Setting>>;

struct Dataset {
  std::string name;
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path footprints;
  Setting options;    ///< set over those of the request: an offset, an id attribute
  std::string place;  ///< where it is, in words; may be empty
};

struct Request {
  Experiment experiment = Experiment::table;
  std::vector<Dataset> datasets;
  std::vector<Axis> axes;
  pipeline::Options options;
  std::size_t most_runs = 100;
  bool pictures = true;              ///< rendered ones; plans and plots are always there
  double error_limit = 2.0;          ///< m; ends of the error maps' colour scale
  std::vector<std::string> command;  ///< the words of the command line, told in the report
  std::string version;               ///< told too
};

/// Table 1 of the paper and more, of a block or of all blocks of a run.
struct Numbers {
  std::size_t triangles = 0, footprints = 0, full = 0, fallback = 0, covered = 0, refused = 0;
  std::size_t blocks = 0, optimal = 0;
  std::size_t sweep_edges = 0, faces = 0, inside_faces = 0, candidates = 0, conflicts = 0;
  std::size_t variables = 0;            ///< of our program
  std::size_t reference_variables = 0;  ///< of the reference's program on the same faces: docs/explore.md
  std::size_t parts = 0, model_faces = 0;
  segment::Terms terms;
  double objective = 0, bound = 0;
  evaluate::Scores scores;
  double optimise_cpu_seconds = 0;  ///< from the program to the labels, added up over blocks
  double cpu_seconds = 0;           ///< of the whole reconstruction, without reading and writing
};

/// A profile of a part, up to the part's crest.
struct Rise {
  model::Profile profile;
  double length = 0;                      ///< m of edges that rise along it
  std::size_t slices = 0, attempted = 0;  ///< raw slices it was fitted to, of those that were made
};

struct BlockRow {
  std::string name;
  Numbers numbers;
};

/// A picture file of the report.
struct Picture {
  std::string name, alt;
  std::string png;
};

/// One run.
struct Row {
  std::size_t dataset = 0;  ///< index into Study::datasets
  Setting setting;
  std::string command;                      ///< the same with `mansard reconstruct`
  std::optional<base::Diagnostic> failure;  ///< without which the rest is there
  Numbers numbers;
  std::vector<BlockRow> blocks;
  std::vector<geometry::Polygon> plan;  ///< of every part, m
  std::vector<Rise> profiles;           ///< Experiment::profiles only
  std::vector<Picture> pictures;
  std::vector<base::Diagnostic> warnings;
};

struct DatasetInfo {
  Dataset dataset;
  std::vector<model::InputFile> inputs;
  std::string crs;
  std::vector<geometry::Polygon> footprints;  ///< local frame, m
  std::array<double, 2> centre{};             ///< of the footprints' box: x and y of the file frame, m
  /// The same as longitude and latitude on WGS 84, degrees; none without a CRS, or where PROJ cannot tell.
  std::optional<std::array<double, 2>> angles;
};

struct Study {
  Experiment experiment = Experiment::table;
  std::vector<Axis> axes;
  std::vector<DatasetInfo> datasets;
  std::vector<Row> rows;  ///< dataset by dataset, setting by setting
  Setting options;        ///< every option as the request has it
  std::string command;    ///< that made it, quoted for a shell
  std::string version;
};

/// Reads every scan once and reconstructs it with every setting. A setting that fails is a row with its reason, as is a
/// dataset that cannot be read where there are several. Guarantees: 1 the same request gives the same study but for
/// what is called seconds · 2 a row's numbers are those of pipeline::reconstruct.
/// Fails with "cancelled", "explore-runs", "explore-list", "option-…", and as ingest::read_scene where no dataset
/// can be read.
[[nodiscard]] auto investigate(const Request& request, const base::Run& run = {}) -> base::Result<Study>;

/// index.html (complete without a network and without scripts), results.json, results.csv, and the pictures. Names and
/// bytes. Everything but the cells of class "seconds", the columns named "…_s" and the members of "seconds" is the same
/// in every run.
[[nodiscard]] auto report(const Study& study) -> std::vector<std::pair<std::string, std::string>>;
/// Whether a report may have a picture of that name: "run-12-above.png".
[[nodiscard]] auto is_picture(const std::string& name) -> bool;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::explore
