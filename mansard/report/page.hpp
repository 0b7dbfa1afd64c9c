// The report of a run for those who ordered it: one page, HTML, that needs nothing else and prints on A4.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mansard/model/city.hpp"
#include "mansard/report/city_map.hpp"
#include "mansard/report/read_run.hpp"
#include "mansard/report/review.hpp"

namespace mansard::report {

/// How many buildings have a level of detail, and of how many of these the solid is valid.
struct LevelCount {
  std::string lod;
  std::size_t buildings = 0, valid = 0;
};

/// Values over all buildings, in their middle and near their end.
struct Quantiles {
  std::string what, unit;
  std::size_t count = 0;
  double median = 0, ninth_tenth = 0;
};

/// What people decided about the models.
struct Reviewed {
  bool known = false;  ///< whether there are decisions that could be read
  std::array<std::size_t, verdict_names.size()> holds{};
  std::size_t lapsed = 0;   ///< the model is another one since
  std::size_t missing = 0;  ///< on buildings that the run does not have
  std::map<std::string, std::array<std::size_t, verdict_names.size()>> by_reviewer;
  std::string last;  ///< time of the last decision that holds
  /// Of those that were found right or wrong: how many have a probability, the sum of these, and how many of them are
  /// right.
  std::size_t rated = 0, rated_right = 0;
  double expected_right = 0;
};

struct WorstBuilding {
  RunBuilding run;
  std::string png;  ///< empty: no picture
  std::size_t width = 0, height = 0;
  bool with_scan = false;
};

/// What the page shows. Strings are as files have them: the page escapes them.
struct RunPage {
  std::string title, name, date;
  RunFile run;
  std::vector<std::string> inputs;                   ///< by run.inputs: what it is, "scan", "footprints" …
  std::string source, source_date;                   ///< of the scan, by the options of the run; may be empty
  std::string scan_note;                             ///< why pictures have no scan; empty: they have it
  std::size_t buildings = 0, parts = 0;              ///< in the models
  geometry::Box2 extent;                             ///< m, in the coordinates of the files; may be empty
  std::optional<std::pair<double, double>> heights;  ///< m: the lowest ground, the highest ridge or roof
  double footprint_area = 0, volume = 0;             ///< m², m³
  std::vector<LevelCount> levels;
  std::array<std::size_t, 4> by_class{};  ///< high, medium, low, without a probability; of those with a model
  std::vector<std::pair<std::string, std::size_t>> failed_checks;
  std::optional<std::pair<double, double>> expected_right;  ///< share of the models, and its standard error
  std::size_t rated = 0;                                    ///< models with a probability
  std::vector<Quantiles> errors;                            ///< of buildings
  std::vector<Quantiles> standard_errors;
  std::string map;                                          ///< SVG
  std::vector<std::pair<std::string, std::string>> legend;  ///< colour and meaning
  std::vector<WorstBuilding> worst;
  std::map<std::string, std::pair<std::size_t, std::string>> without_model;  ///< code → how many, a message
  std::vector<RunBuilding> without_model_first;                              ///< some of these
  Reviewed reviewed;
  Changed changed;
  bool edited_since = false;  ///< in the workbench, and the models of this run do not have the edits
};

/// Standard error of the mean square over all cells of blocks, which are independent of each other: of a ratio, sum of
/// cells × mean square over sum of cells (W. Cochran, Sampling Techniques, 1977, 6.3). None of fewer than two blocks.
[[nodiscard]] auto standard_error(const std::vector<RunScores>& blocks, std::optional<MeanSquare> RunScores::*score)
    -> std::optional<double>;

/// UTF-8; no script, no other file. The same page gives the same bytes.
[[nodiscard]] auto page_html(const RunPage& page) -> std::string;

}  // namespace mansard::report
