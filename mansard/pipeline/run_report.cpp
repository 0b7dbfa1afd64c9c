// The steps of a report: run.json, the models one by one, then the pictures.
#include "mansard/pipeline/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

#include "mansard/base/files.hpp"
#include "mansard/base/statistics.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/confidence/confidence.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/model/find.hpp"
#include "mansard/model/move.hpp"
#include "mansard/picture/picture.hpp"
#include "mansard/pipeline/detail/run_files.hpp"
#include "mansard/pipeline/stored.hpp"
#include "mansard/report/measures.hpp"
#include "mansard/report/page.hpp"
#include "mansard/report/pictures.hpp"

namespace mansard::pipeline {
namespace {

namespace fs = std::filesystem;
using report::RunBuilding;

/// What is kept of each building of run.json while the models are read.
struct Known {
  std::optional<float> right;
  bool with_model = false;
};

/// Whether the first is to be looked at before the second: the lower probability, then the larger error.
auto worse(const RunBuilding& a, const RunBuilding& b) -> bool {
  const auto probability = [](const RunBuilding& one) { return one.right.value_or(2); };
  const auto error = [](const RunBuilding& one) { return one.error.value_or(one.rmse.value_or(0)); };
  if (probability(a) != probability(b)) return probability(a) < probability(b);
  if (error(a) != error(b)) return error(a) > error(b);
  return a.id < b.id;
}

/// What is gathered of run.json's buildings.
class Gathered {
 public:
  explicit Gathered(std::size_t most) : most_(most) {}

  void add(RunBuilding building) {
    const bool with_model = building.outcome == "full" || building.outcome == "fallback";
    Known known;
    known.with_model = with_model;
    if (building.right) known.right = static_cast<float>(*building.right);
    known_.emplace(building.id, known);
    if (!with_model) {
      const auto code = building.reasons.empty() ? std::string("unknown") : building.reasons.front().first;
      auto& [count, message] = without_[code];
      if (count++ == 0 && !building.reasons.empty()) message = building.reasons.front().second;
      if (first_without_.size() < most_listed) first_without_.push_back(std::move(building));
      return;
    }
    std::size_t of_class = 3;
    if (building.right) {
      const auto name = confidence::class_of(*building.right);
      of_class = name == "high" ? 0 : name == "medium" ? 1 : 2;
      expected_ += *building.right;
      variance_ += *building.right * (1 - *building.right);
      ++rated_;
    }
    ++by_class_[of_class];
    if (building.error) errors_.push_back(*building.error);
    if (building.rmse) rmse_.push_back(*building.rmse);
    if (!building.right && !building.rmse) return;
    const auto at = std::ranges::upper_bound(worst_, building, worse);
    if (static_cast<std::size_t>(at - worst_.begin()) >= most_) return;
    worst_.insert(at, std::move(building));
    if (worst_.size() > most_) worst_.pop_back();
  }

  void tell(report::RunPage& page) {
    page.by_class = by_class_;
    page.rated = rated_;
    const auto n = static_cast<double>(rated_);
    if (rated_ > 0) page.expected_right = std::pair(expected_ / n, std::sqrt(variance_) / n);
    const auto quantiles = [&](const char* what, std::vector<double>& values) {
      if (values.empty()) return;
      page.errors.push_back({what, "m", values.size(), base::percentile(values, 0.5), base::percentile(values, 0.9)});
    };
    quantiles("Root mean square distance from the scan, without what is beside walls", rmse_);
    quantiles("Error to expect against what is really there, root mean square", errors_);
    page.without_model = std::move(without_);
    page.without_model_first = std::move(first_without_);
    for (auto& building : worst_) page.worst.push_back({std::move(building), {}, 0, 0, false});
  }
  [[nodiscard]] auto find(const std::string& id) const -> const Known* {
    const auto at = known_.find(id);
    return at == known_.end() ? nullptr : &at->second;
  }

 private:
  static constexpr std::size_t most_listed = 20;  // half a page
  std::size_t most_;
  std::unordered_map<std::string, Known> known_;
  std::vector<RunBuilding> worst_, first_without_;
  std::map<std::string, std::pair<std::size_t, std::string>> without_;
  std::array<std::size_t, 4> by_class_{};
  std::vector<double> errors_, rmse_;
  double expected_ = 0, variance_ = 0;
  std::size_t rated_ = 0;
};

/// Numbers of a building that have a standard error.
struct Measured {
  const char *attribute, *what, *unit;
};
constexpr std::array measured_numbers{Measured{"ms_h_ground_se", "Height of the ground", "m"},
                                      Measured{"ms_h_eave_se", "Height of the eaves", "m"},
                                      Measured{"ms_h_ridge_se", "Height of the ridge", "m"},
                                      Measured{"ms_h_roof_70p_se", "Height that 70 % of the roof is below", "m"},
                                      Measured{"ms_volume_lod22_se", "Volume", "m³"},
                                      Measured{"ms_area_ground_se", "Area of the ground", "m²"},
                                      Measured{"ms_area_wall_se", "Area of the walls", "m²"}};

// The kinds of the map, in the order in which they are drawn: what is worst on top.
enum MapKind : std::uint8_t { certain, likely, unlikely, unrated, bare };
constexpr std::array<report::CityMap::Kind, 5> map_kinds{{{"high", "#8fbf9f"},
                                                          {"medium", "#e8a33d"},
                                                          {"low", "#b3261e"},
                                                          {"without a probability", "#b9bec7"},
                                                          {"without a model", "#ffffff"}}};

auto kind_on_map(const Known* known, bool has_solid) -> MapKind {
  if (known != nullptr ? !known->with_model : !has_solid) return bare;
  if (known == nullptr || !known->right) return unrated;
  const auto name = confidence::class_of(static_cast<double>(*known->right));
  return name == "high" ? certain : name == "medium" ? likely : unlikely;
}

/// What is gathered of the models.
class Models {
 public:
  Models(const Gathered& gathered, report::RunPage& page, const report::Decisions* decisions, const model::Frame& frame)
      : gathered_(gathered), page_(page), decisions_(decisions), frame_(frame), values_(measured_numbers.size()) {
    for (std::size_t i = 0; i < page.worst.size(); ++i) wanted_.emplace(page.worst[i].run.id, i);
    kept_.buildings.resize(page.worst.size());
    for (const auto& names : report::level_names()) page.levels.push_back({std::string(formats::name_of(names.lod))});
    page.reviewed.known = decisions != nullptr;
  }

  void add(model::Building building) {
    const auto& attributes = building.attributes;
    const auto* known = gathered_.find(building.id);
    ++page_.buildings;
    page_.parts += building.parts.size();
    for (const auto& polygon : building.footprint) page_.footprint_area += geometry::area(polygon);
    extent_.include(geometry::bounds(building.footprint));
    const auto kind = kind_on_map(known, !building.parts.empty());
    ++on_map_[kind];
    map_.add(building.footprint, kind);
    heights(attributes);
    if (const auto* volume = model::find<double>(attributes, "ms_volume_lod22")) page_.volume += *volume;
    levels(attributes);
    for (std::size_t i = 0; i < measured_numbers.size(); ++i)
      if (const auto* value = model::find<double>(attributes, measured_numbers[i].attribute))
        values_[i].push_back(*value);
    if (const auto* kept = model::find<std::string>(attributes, "ms_kept_from")) ++kept_from_[*kept];
    if (const auto* change = model::find<std::string>(attributes, "ms_change")) ++changes_[*change];
    review(building, known);
    if (const auto at = wanted_.find(building.id); at != wanted_.end())
      kept_.buildings[at->second] = std::move(building);
  }

  /// After the last one. What is pictured, by the number in the list of the worst.
  auto finish() -> model::City {
    for (std::size_t i = 0; i < measured_numbers.size(); ++i) {
      if (values_[i].empty()) continue;
      const auto& number = measured_numbers[i];
      page_.standard_errors.push_back({number.what, number.unit, values_[i].size(), base::percentile(values_[i], 0.5),
                                       base::percentile(values_[i], 0.9)});
    }
    std::erase_if(page_.levels, [](const auto& level) { return level.buildings == 0; });
    if (!extent_.empty()) {
      const geometry::Point2 origin{static_cast<double>(frame_.origin[0]), static_cast<double>(frame_.origin[1])};
      page_.extent = {extent_.least + origin, extent_.most + origin};
    }
    if (highest_ > lowest_) page_.heights = std::pair(lowest_, highest_);
    page_.failed_checks.assign(checks_.begin(), checks_.end());
    page_.changed.kept_from.assign(kept_from_.begin(), kept_from_.end());
    if (page_.changed.by_kind.empty()) page_.changed.by_kind.assign(changes_.begin(), changes_.end());
    for (std::size_t i = 0; i < kept_.buildings.size(); ++i) {
      const auto box = geometry::bounds(kept_.buildings[i].footprint);
      if (!box.empty()) map_.mark(0.5 * (box.least + box.most), std::to_string(i + 1));
    }
    std::string counts;
    for (std::size_t k = 0; k < map_kinds.size(); ++k) {
      if (on_map_[k] == 0) continue;
      std::string words(map_kinds[k].name);
      if (k <= unlikely) words += " confidence";
      words += ": " + std::to_string(on_map_[k]);
      counts += (counts.empty() ? "" : ", ") + words;
      page_.legend.emplace_back(std::string(map_kinds[k].colour), words);
    }
    page_.map = map_.svg({map_kinds.begin(), map_kinds.end()}, "Map of the buildings by confidence: " + counts);
    page_.reviewed.missing = decisions_ == nullptr ? 0 : decisions_->size() - decided_;
    return std::move(kept_);
  }

 private:
  void heights(const model::Attributes& attributes) {
    const auto* ground = model::find<double>(attributes, "ms_h_ground");
    const auto* roof = model::find<double>(attributes, "ms_h_roof_max");
    if (ground == nullptr || roof == nullptr) return;
    lowest_ = std::min(lowest_, *ground);
    highest_ = std::max(highest_, *roof);
  }

  void levels(const model::Attributes& attributes) {
    std::size_t l = 0;
    for (const auto& names : report::level_names()) {
      auto& level = page_.levels[l++];
      const auto* codes = model::find<std::string>(attributes, names.val3dity);
      if (codes == nullptr) continue;
      ++level.buildings;
      if (*codes == "[]") ++level.valid;
    }
    const auto* checks = model::find<std::string>(attributes, "ms_checks");
    if (checks == nullptr || *checks == "no check failed") return;
    for (std::size_t from = 0; from < checks->size();) {
      const auto to = std::min(checks->find(", ", from), checks->size());
      ++checks_[checks->substr(from, to - from)];
      from = to + 2;
    }
  }

  void review(const model::Building& building, const Known* known) {
    auto& reviewed = page_.reviewed;
    std::optional<report::Verdict> verdict;
    std::string reviewer, time;
    if (decisions_ != nullptr) {
      const auto at = decisions_->find(building.id);
      if (at == decisions_->end()) return;
      ++decided_;
      std::vector<const model::Plan*> plans;
      for (const auto& part : building.parts) plans.push_back(&part.plan);
      if (report::model_key(plans, frame_) != at->second.model) {
        ++reviewed.lapsed;
        return;
      }
      verdict = at->second.verdict;
      reviewer = at->second.reviewer;
      time = at->second.time;
    } else if (const auto* decided = model::find<std::string>(building.attributes, "ms_review")) {
      verdict = report::verdict_of(*decided);
      if (!verdict) return;
      reviewed.known = true;
      if (const auto* who = model::find<std::string>(building.attributes, "ms_reviewer")) reviewer = *who;
      if (const auto* when = model::find<std::string>(building.attributes, "ms_review_time")) time = *when;
    }
    if (!verdict) return;
    ++reviewed.holds[static_cast<std::size_t>(*verdict)];
    ++reviewed.by_reviewer[reviewer][static_cast<std::size_t>(*verdict)];
    reviewed.last = std::max(reviewed.last, time);
    if (*verdict == report::Verdict::later || known == nullptr || !known->right) return;
    ++reviewed.rated;
    reviewed.expected_right += static_cast<double>(*known->right);
    if (*verdict == report::Verdict::right) ++reviewed.rated_right;
  }

  const Gathered& gathered_;
  report::RunPage& page_;
  const report::Decisions* decisions_;
  const model::Frame& frame_;
  std::unordered_map<std::string, std::size_t> wanted_;
  model::City kept_;
  report::CityMap map_;
  std::array<std::size_t, map_kinds.size()> on_map_{};
  geometry::Box2 extent_;
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> values_;
  std::map<std::string, std::size_t> checks_, kept_from_, changes_;
  std::size_t decided_ = 0;
};

/// run.json of a run, or of a project's run report.json, beside a run.json that says other things.
auto read_reports(const fs::path& folder, Gathered& gathered) -> base::Result<report::RunFile> {
  std::error_code status;
  if (!fs::exists(folder / "run.json", status))
    return base::error("report-run", "has no run.json; give the output folder of 'mansard reconstruct'",
                       folder.string());
  const auto visit = [&](RunBuilding building) { gathered.add(std::move(building)); };
  auto own = report::read_run_file(folder / "run.json", visit);
  if (own || !fs::exists(folder / "report.json", status)) return own;
  return report::read_run_file(folder / "report.json", visit);
}

auto decisions_of(const fs::path& folder, std::vector<fs::path> reviews)
    -> base::Result<std::optional<report::Decisions>> {
  if (reviews.empty()) {  // PROJECT/runs/NAME
    const auto project = fs::absolute(folder).lexically_normal();
    const auto home = (project.has_filename() ? project : project.parent_path()).parent_path().parent_path();
    std::error_code status;
    if (!fs::exists(home / "project.json", status)) return std::optional<report::Decisions>();
    reviews.push_back(home);
  }
  report::Decisions all;
  for (const auto& path : reviews) {
    const auto own = report::read_review(path);
    if (!own) return own.failure();
    all = report::merged(all, *own).decisions;
  }
  return std::optional(std::move(all));
}

auto changes_of(fs::path path) -> base::Result<report::Changed> {
  std::error_code status;
  if (fs::is_directory(path, status)) path /= "changes.json";
  const auto text = base::read_file(path);
  return text ? report::read_changed(*text, path.string()) : base::Result<report::Changed>(text.failure());
}

// ---- pictures

/// The scan around what is pictured; a large one is in cells on disk.
auto read_around(const std::vector<fs::path>& scans, const model::City& city, Options options, const base::Run& run)
    -> base::Result<ingest::CityScene> {
  geometry::Box2 box;
  for (const auto& building : city.buildings) box.include(geometry::bounds(building.footprint));
  if (box.empty()) return ingest::CityScene();
  box = box.grown(report::close_up_margin);
  const auto x = static_cast<double>(city.frame.origin[0]), y = static_cast<double>(city.frame.origin[1]);
  options.ingest.crs = city.frame.crs.empty() ? "local" : city.frame.crs;
  options.ingest.terrain.clear();
  options.ingest.bbox = {box.least.x + x, box.least.y + y, box.most.x + x, box.most.y + y};
  return ingest::read_city(scans, {}, options.ingest, run);
}

auto scan_near(const ingest::CityScene& scan, const geometry::Box2& box) -> base::Result<geometry::Mesh> {
  if (!scan.cells) return scan.scene.mesh;
  const auto cells = scan.cells->cells_in(box);
  return scan.cells->load({cells.begin(), cells.end()});
}

auto draw_worst(model::City city, const std::optional<ingest::CityScene>& scan, report::RunPage& page,
                const base::Run& run) -> base::Result<void> {
  constexpr std::size_t width = 560, height = 260;  // pixels: 150 dpi, and two buildings on a page of A4
  for (std::size_t i = 0; i < city.buildings.size(); ++i) {
    if (run.cancelled()) return base::stopped();
    run.report("picture", page.worst[i].run.id, static_cast<double>(i) / static_cast<double>(city.buildings.size()));
    auto& building = city.buildings[i];
    std::optional<geometry::Mesh> mesh;
    if (scan) {
      model::move(building, model::between(city.frame, scan->scene.frame));
      auto near = scan_near(*scan, geometry::bounds(building.footprint).grown(report::close_up_margin));
      if (!near) return near.failure();
      mesh = std::move(*near);
    }
    base::Run quiet = run;
    quiet.progress = nullptr;
    const auto image = report::close_up({building, mesh ? &*mesh : nullptr}, width, height, quiet);
    if (!image) continue;
    auto png = picture::png(*image);
    if (!png) return png.failure();
    auto& worst = page.worst[i];
    worst.png = std::move(*png);
    worst.width = image->width;
    worst.height = image->height;
    worst.with_scan = mesh && image->width > width;
  }
  return {};
}

/// The models of what is pictured, where the file has only plans.
auto with_models(model::City city, bool has_models, const base::Run& run) -> base::Result<model::City> {
  if (has_models || city.buildings.empty()) return city;
  Options options;
  (void)take_options(city.made_by, options);
  std::vector<std::size_t> parts;
  for (const auto& building : city.buildings) parts.push_back(building.parts.size());
  auto raised = raise_plans(city, options, run);
  return raised ? base::Result<model::City>(std::move(raised->city)) : base::Result<model::City>(raised.failure());
}

auto value_of(const report::EarlierRun& earlier, std::string_view name) -> std::string {
  for (const auto& [key, value] : earlier.options)
    if (key == name) return value;
  return {};
}

}  // namespace

auto run_report(const fs::path& folder, const RunReportOptions& wanted, const base::Run& run)
    -> base::Result<RunReport> {
  RunReport out;
  report::RunPage page;
  page.title = wanted.title;
  page.date = wanted.date;
  const auto named = fs::absolute(folder).lexically_normal();
  page.name = (named.has_filename() ? named : named.parent_path()).filename().string();

  // ---- run.json
  run.report("report", folder.string(), 0);
  Gathered gathered(wanted.worst);
  auto file = read_reports(folder, gathered);
  if (!file) return file.failure();
  page.run = std::move(*file);
  gathered.tell(page);
  Options reading;
  detail::take_reading(page.run, reading);
  for (const auto& input : page.run.inputs) {
    const auto kind = detail::kind_of(input, reading);
    page.inputs.emplace_back(kind == detail::InputKind::scan         ? "scan"
                             : kind == detail::InputKind::footprints ? "footprints"
                             : kind == detail::InputKind::terrain    ? "terrain"
                                                                     : "");
  }
  page.source = value_of(page.run, "pipeline.survey_source");
  page.source_date = value_of(page.run, "pipeline.survey_date");
  const auto decisions = decisions_of(folder, wanted.reviews);
  if (!decisions) return decisions.failure();
  if (!wanted.changes.empty()) {
    auto changed = changes_of(wanted.changes);
    if (!changed) return changed.failure();
    page.changed = std::move(*changed);
  }
  std::error_code status;
  const auto journal = folder / "journal.jsonl";
  page.edited_since = fs::exists(journal, status) && fs::file_size(journal, status) > 0;

  // ---- the models
  const auto models_path = detail::models_in(folder);
  if (models_path.empty())
    return base::error("report-models",
                       "there are no models in this folder that can be read; add cityjson or plans to --formats of the "
                       "run",
                       folder.string());
  auto reader = formats::read_city(models_path);
  if (!reader) return reader.failure();
  const auto& frame = (*reader)->header().frame;
  Models models(gathered, page, *decisions ? &**decisions : nullptr, frame);
  const auto all = static_cast<double>(std::max<std::size_t>(page.run.counts["footprints"], 1));
  while (true) {
    if (run.cancelled()) return base::stopped();
    auto next = (*reader)->next();
    if (!next) return next.failure();
    if (!*next) break;
    models.add(std::move(**next));
    constexpr std::size_t often = 256;
    if (page.buildings % often == 0)
      run.report("report", models_path.string(), std::min(static_cast<double>(page.buildings) / all, 1.0));
  }
  auto worst = models.finish();
  worst.frame = frame;
  worst.made_by = (*reader)->header().made_by;
  auto shown = with_models(std::move(worst), (*reader)->has_models() || (*reader)->has_solids(), run);
  if (!shown) return shown.failure();

  // ---- the scan
  std::optional<ingest::CityScene> scan;
  if (!shown->buildings.empty() && wanted.use_scans) {
    auto found =
        wanted.scans.empty() ? detail::scan_of(page.run, folder, reading) : detail::FoundScan{wanted.scans, {}};
    std::string why;
    if (!found.missing.empty())
      why = "The scan is not there any more, or is another one (" + found.missing +
            "): the pictures show the models alone.";
    else if (!found.files.empty()) {
      auto read = read_around(found.files, *shown, reading, run);
      if (run.cancelled()) return base::stopped();
      if (!read && !wanted.scans.empty()) return read.failure();
      if (read) scan = std::move(*read);
      else why = "The scan cannot be read (" + read.error().message + "): the pictures show the models alone.";
    }
    if (!why.empty()) out.warnings.push_back(base::warning("report-scan", why, folder.string()));
    page.scan_note = why;
  }
  if (auto drawn = draw_worst(std::move(*shown), scan, page, run); !drawn) return drawn.failure();
  out.html = report::page_html(page);
  return out;
}

}  // namespace mansard::pipeline
