// Footprints without a mesh: attributes to forms, forms to plans, plans to solids.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>

#include "mansard/base/stopped.hpp"
#include "mansard/base/text.hpp"
#include "mansard/extrude/align.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/pipeline/detail/city_builder.hpp"
#include "mansard/pipeline/detail/city_tasks.hpp"
#include "mansard/pipeline/detail/overlaps.hpp"
#include "mansard/pipeline/detail/painted.hpp"
#include "mansard/pipeline/detail/place.hpp"
#include "mansard/pipeline/detail/said.hpp"
#include "mansard/pipeline/detail/task_kept.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/attributes.hpp"
#include "mansard/report/measures.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::pipeline {
namespace {

using detail::Said;
using detail::SaidOf;

/// One polygon of a feature or of a part of it, raised. All coordinates are in its block's own frame until it is
/// placed.
struct Raising {
  std::size_t feature = 0;
  std::optional<std::size_t> part;  ///< of the feature's own parts
  geometry::Polygon outline;
  roof::Planned planned;
  std::optional<model::Solid> solid;
  bool full = true;
  std::vector<base::Diagnostic> reasons;
};

constexpr std::string_view by_profile = "profile";  // what heights come from where no attribute counts

void add_all(std::vector<base::Diagnostic>& all, const std::vector<base::Diagnostic>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// The polygons of all blocks, those of one after the other. A building is made where its block's frame begins, so that
/// it depends on nothing else.
struct BlockJobs {
  std::size_t first = 0, count = 0;  ///< of the jobs
  geometry::Point3 origin;
};

/// The polygons of a part in the frame of its block, with the digits that the block's own have.
auto in_frame(std::vector<geometry::Polygon> polygons, geometry::Point2 origin) -> std::vector<geometry::Polygon> {
  for (auto& polygon : polygons)
    geometry::change_corners(polygon, [&](geometry::Point2 p) {
      return geometry::Point2{model::rounded(p.x), model::rounded(p.y)} - origin;
    });
  return polygons;
}

/// Where the scene has a terrain, the ground of the buildings is that, unless an attribute gives it.
auto divide(const model::Scene& scene, const Options& options, const base::Run& run, std::vector<Raising>& jobs,
            std::vector<SaidOf>& said) -> std::vector<BlockJobs> {
  const bool on_terrain = scene.terrain != nullptr && options.roof.ground_attribute.empty();
  std::vector<BlockJobs> out;
  for (auto& block : block::partition(scene, options.block, run)) {
    const auto own = block::in_own_frame(std::move(block));
    const auto& origin = own.block.origin;
    out.push_back({jobs.size(), 0, {static_cast<double>(origin[0]), static_cast<double>(origin[1]), 0}});
    for (std::size_t m = 0; m < own.block.members.size(); ++m) {
      const std::size_t feature = own.features[m];
      auto& [whole, parts, with_outline] = said[feature];
      if (on_terrain && own.block.ground_known)
        whole.form.ground = own.block.members[m].ground + static_cast<double>(origin[2]);
      for (auto& part : parts) part.form.ground = whole.form.ground;
      const auto add = [&](const geometry::Polygon& polygon, std::optional<std::size_t> part) {
        auto& job = jobs.emplace_back();
        job.feature = feature;
        job.part = part;
        job.outline = polygon;
      };
      if (with_outline)
        for (const auto& polygon : own.block.members[m].polygons) add(polygon, std::nullopt);
      for (std::size_t p = 0; p < parts.size(); ++p)
        for (const auto& polygon : in_frame(scene.feature(feature).parts[p].polygons, xy(out.back().origin)))
          add(polygon, p);
    }
    out.back().count = jobs.size() - out.back().first;
  }
  return out;
}

/// How far the top lies from where the plan was made to have it, m.
auto missed(const model::Solid& solid, const roof::Planned& planned) -> double {
  return std::abs(report::top_of(solid) - planned.plan.base - planned.top);
}
constexpr double far_off = 0.05;  // m

/// The plan with the walls that it shares with others on one line, as a checked solid. False where that would cost the
/// roof.
auto raise_aligned(Raising& job, model::Plan aligned, bool ridge_known, const Options& options, const base::Run& run)
    -> bool {
  auto raised = raise_part(aligned, options, run);
  if (!raised || raised->outcome != extrude::Outcome::full) return false;
  constexpr double near = 0.01;  // m; a wider house has a higher ridge
  if (ridge_known && missed(raised->solid, job.planned) > near) return false;
  job.planned.plan = std::move(aligned);
  job.solid = std::move(raised->solid);
  return true;
}

/// Where a roof would rise beyond what a plan can hold: the same, cut off flat where its profile ends.
auto raise_cut_off(Raising& job, const base::Diagnostic& why, const Options& options, const base::Run& run)
    -> base::Result<extrude::Raised> {
  auto& plan = job.planned.plan;
  plan.cap = job.planned.flat_top;
  auto raised = raise_part(plan, options, run);
  if (!raised) return raised;
  job.full = false;
  job.reasons.push_back(base::warning(
      why.code, why.message + "; the roof is cut off flat " + base::to_text(plan.cap, 2) + " m above the base"));
  return raised;
}

/// The plan as a checked solid; what the ladder did, and a ridge that is not where it should be, are reasons.
void raise(Raising& job, bool ridge_known, const Options& options, const base::Run& run) {
  auto& plan = job.planned.plan;
  auto raised = raise_part(plan, options, run);
  if (!raised && raised.error().code == "extrude-cap" && plan.cap > job.planned.flat_top)
    raised = raise_cut_off(job, raised.error(), options, run);
  if (raised && raised->outcome == extrude::Outcome::prism && plan.cap != job.planned.flat_top) {
    auto flat = plan;
    flat.cap = job.planned.flat_top;  // a flat roof where the ridge would have been, and not above it
    if (auto prism = extrude::prism(flat, detail::with_grid(options.extrude))) {
      plan.cap = flat.cap;
      raised->solid = std::move(*prism);
    } else {
      raised->warnings.push_back(base::warning(
          prism.error().code, "its flat roof stays " + base::to_text(plan.cap, 2) + " m above its base instead of " +
                                  base::to_text(flat.cap, 2) + " m: " + prism.error().message));
    }
  }
  if (!raised) {
    job.full = false;
    job.reasons.push_back(base::warning(raised.error().code, raised.error().message));
    return;
  }
  if (raised->outcome != extrude::Outcome::full) {
    job.full = false;
    add_all(job.reasons, raised->warnings);
  }
  if (ridge_known && raised->outcome != extrude::Outcome::prism && missed(raised->solid, job.planned) > far_off) {
    job.full = false;
    const double top = report::top_of(raised->solid) - plan.base;
    job.reasons.push_back(base::warning("roof-missed", "its ridge is " + base::to_text(top, 2) +
                                                           " m above its base instead of " +
                                                           base::to_text(job.planned.top, 2) + " m"));
  }
  job.solid = std::move(raised->solid);
}

/// z of the roof's lowest corner.
auto eaves_of(const model::LabelledSolid& model) -> double {
  double low = report::top_of(model.solid);
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f)
    if (model.classes[f] == model::FaceClass::roof)
      for (const auto v : model.solid.faces[f].loops.front()) low = std::min(low, model.solid.vertices[v].z);
  return low;
}

auto attributes_of(const model::LabelledSolid& model, const Raising& job, const model::Footprint& footprint,
                   const Said& said, std::string_view height_from) -> model::Attributes {
  const auto areas = label::areas(model);
  model::Attributes out;
  const auto add = [&out](const char* name, model::Value value) { out.push_back({name, std::move(value)}); };
  add("ms_h_ground", job.planned.plan.base);
  add("ms_h_roof_min", eaves_of(model));
  add("ms_h_roof_max", report::top_of(model.solid));
  if (const auto ridge = report::ridge_height(model)) add("ms_h_ridge", *ridge);
  add("ms_roof_type", report::roof_type(model));
  if (job.part) add("ms_source_id", footprint.parts[*job.part].id);
  if (height_from != by_profile) add("ms_roof_shape", std::string(roof::to_string(job.planned.shape)));
  add("ms_height_from", std::string(height_from));
  const auto& paint = said.paint;
  if (paint.wall) add("ms_wall_colour", detail::in_hex(*paint.wall));
  if (paint.roof) add("ms_roof_colour", detail::in_hex(*paint.roof));
  if (!paint.wall_material.empty()) add("ms_wall_material", paint.wall_material);
  if (!paint.roof_material.empty()) add("ms_roof_material", paint.roof_material);
  add("ms_volume_lod22", solid::volume(model.solid));
  add("ms_area_roof_flat", areas.roof_flat);
  add("ms_area_roof_sloped", areas.roof_sloped);
  add("ms_area_wall", areas.wall);
  add("ms_area_party_wall", areas.party_wall);
  if (job.full) add("ms_fallback", std::monostate{});
  else add("ms_fallback", job.reasons.empty() ? std::string("unknown") : job.reasons.front().code);
  report::round_measures(out);
  return out;
}

/// Adds a part to its building.
void take(Raising job, model::LabelledSolid model, const model::Footprint& footprint, const Said& said,
          bool by_attributes, model::Building& building) {
  auto attributes =
      attributes_of(model, job, footprint, said, by_attributes ? to_string(said.form.source) : by_profile);
  building.parts.push_back({footprint.part_id(building.parts.size() + 1), std::move(job.planned.plan), std::move(model),
                            std::move(attributes)});
}

/// The solids of a building, and its report of the parts that have one.
void settle(SolidsOf made, model::Building& building, report::BuildingReport& report) {
  drop_lost(building, made);
  for (const auto& [id, plan, model, attributes] : building.parts) {
    const double low = eaves_of(model), high = report::top_of(model.solid);
    report.roof_min = report.parts == 0 ? low : std::min(report.roof_min, low);
    report.roof_max = report.parts == 0 ? high : std::max(report.roof_max, high);
    ++report.parts;
  }
  for (const auto& one : made.solids) {  // of parts that overlap, what they share counts once
    report.volume += solid::volume(one.model.solid);
    detail::add(report.areas, label::areas(one.model));
  }
  detail::add_solids(building, report, std::move(made), 0);
}

/// Buildings and reports, still without parts.
void begin(const model::Scene& scene, const std::vector<SaidOf>& said, bool by_attributes,
           report::Reconstruction& out) {
  for (std::size_t i = 0; i < scene.footprints.size(); ++i) {
    const auto& footprint = scene.footprints[i];
    auto& building = out.city.buildings.emplace_back();
    auto& report = out.buildings.emplace_back();
    building.id = report.id = footprint.id;
    building.attributes = footprint.attributes;
    building.footprint = footprint.polygons;
    building.ground = report.ground = said[i].whole.form.ground;
    if (footprint.defect) {
      report.outcome = report::Outcome::refused;
      report.reasons.push_back(*footprint.defect);
      continue;
    }
    report.height_from = by_attributes ? to_string(detail::source_of(said[i])) : by_profile;
    if (!by_attributes) continue;
    if (said[i].with_outline) add_all(report.reasons, said[i].whole.warnings);
    for (const auto& part : said[i].parts) add_all(report.reasons, part.warnings);
    if (said[i].parts.empty() || said[i].with_outline) continue;
    if (const auto cover = detail::cover_of(footprint)) {
      building.attributes.emplace_back("ms_area_uncovered", std::round(cover->left * 100) / 100);
      if (const auto words = detail::in_words(*cover); !words.empty())
        report.reasons.push_back(base::warning("roof-uncovered", words));
    }
  }
}

/// The attributes that only the whole building has; the ids of its reasons.
void finish(model::Building& building, report::BuildingReport& report, const model::Frame& frame,
            const Options& options) {
  if (report.parts == 0) report.outcome = report::Outcome::refused;
  for (auto& reason : report.reasons)
    if (reason.subject.empty()) reason.subject = report.id;
  detail::add_attributes(building, report,
                         report::level_measures(building, frame, options.write.levels, nullptr, options.evaluate),
                         options, static_cast<double>(frame.origin[2]));
}

auto is_assumed(const report::BuildingReport& report) -> bool {
  return report.height_from == roof::to_string(roof::Source::assumed);
}

/// A word on heights out of thin air.
void warn_of_assumed(std::size_t assumed, const model::Scene& scene, std::vector<base::Diagnostic>& warnings) {
  if (assumed > 0)
    warnings.push_back(base::warning("roof-assumed",
                                     std::to_string(assumed) + " of " + std::to_string(scene.footprints.size()) +
                                         " buildings have neither height nor levels; their height is assumed",
                                     scene.inputs.empty() ? std::string() : scene.inputs.front().path));
}

/// How all roofs are made.
struct Making {
  bool by_attributes = true;
  model::Profile profile;  ///< where they are not
};

/// Fails with "pipeline-nothing", "roof-profile", "roof-attribute".
auto making_of(const model::Scene& scene, const Options& options) -> base::Result<Making> {
  const auto usable = std::ranges::find_if(scene.footprints, [](const auto& f) { return !f.defect.has_value(); });
  if (usable == scene.footprints.end()) {
    if (scene.footprints.empty()) return base::error("pipeline-nothing", "there are no footprints");
    const auto& first = scene.footprints.front().defect;
    return base::error("pipeline-nothing", "none of the " + std::to_string(scene.footprints.size()) +
                                               " footprints can be used; the first: " + (first ? first->message : ""));
  }
  if (auto known = roof::check_attributes(usable->attributes, options.roof); !known) return known.error();
  Making out;
  out.by_attributes = options.roof.profile.empty();
  if (out.by_attributes) return out;
  auto given = roof::profile_of(options.roof.profile);
  if (!given) return given.error();
  out.profile = std::move(*given);
  return out;
}

}  // namespace

namespace {

/// The plans of an outline, side by side where its roof takes several; without one where none can be made.
auto planned_of(Raising outline, const std::vector<SaidOf>& said, const Making& making, const Options& options,
                const base::Run& run) -> std::vector<Raising> {
  const auto& of = said[outline.feature];
  const auto& form = outline.part ? of.parts[*outline.part].form : of.whole.form;
  std::vector<roof::Planned> plans;
  if (!making.by_attributes) {
    plans.push_back(roof::plan_along(outline.outline, making.profile, form, options.roof));
  } else if (auto made = roof::plans_of(outline.outline, form, options.roof, run)) {
    plans = std::move(*made);
  } else {
    outline.full = false;
    outline.reasons.push_back(base::warning(made.error().code, made.error().message));
    return {std::move(outline)};
  }
  std::vector<Raising> out;
  for (auto& plan : plans) {
    auto& job = out.emplace_back(outline);
    job.full = plan.as_asked;
    // Of roofs in several plans the same is said of each.
    if (out.size() == 1 || plan.warnings != out.front().planned.warnings) job.reasons = plan.warnings;
    job.planned = std::move(plan);
  }
  return out;
}

/// The footprints of a scene, but for what only all of a city show together. Nothing once the run is cancelled.
auto raise_all(const model::Scene& scene, const Making& making, const Options& options, const base::Run& run)
    -> report::Reconstruction {
  const bool by_attributes = making.by_attributes;
  std::vector<SaidOf> said(scene.footprints.size() + scene.surroundings.size());
  base::parallel_for(said.size(),
                     [&](std::size_t i) { said[i] = detail::said_of(scene.feature(i), options, by_attributes); });
  base::Watch planning;
  std::vector<Raising> outlines;
  auto blocks = divide(scene, options, run, outlines, said);

  base::Run inner = run;
  inner.progress = nullptr;
  run.report("roof", {}, 0);
  std::vector<std::vector<Raising>> planned(outlines.size());
  base::parallel_for(outlines.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    planned[i] = planned_of(std::move(outlines[i]), said, making, options, inner);
  });
  std::vector<Raising> jobs;
  for (auto& [first, count, origin] : blocks) {
    const std::size_t from = jobs.size();
    for (std::size_t i = first; i < first + count; ++i) std::ranges::move(planned[i], std::back_inserter(jobs));
    first = from;
    count = jobs.size() - from;
  }
  const base::Spent planned_in = planning.stop();
  base::Watch raising;
  std::vector<std::optional<model::Plan>> aligned(jobs.size());
  base::parallel_for(blocks.size(), [&](std::size_t b) {
    std::vector<model::Plan> plans;
    for (std::size_t i = 0; i < blocks[b].count; ++i) plans.push_back(jobs[blocks[b].first + i].planned.plan);
    std::ranges::move(extrude::align(plans, options.extrude),
                      aligned.begin() + static_cast<std::ptrdiff_t>(blocks[b].first));
  });

  std::mutex progress;
  std::size_t done = 0;
  run.report("extrude", {}, 0);
  base::parallel_for(jobs.size(), [&](std::size_t i) {
    Raising& job = jobs[i];
    if (run.cancelled()) return;
    const bool is_planned = !job.planned.plan.outer.points.empty();
    if (is_planned && !(aligned[i] && raise_aligned(job, *aligned[i], by_attributes, options, inner)))
      raise(job, by_attributes, options, inner);
    const std::scoped_lock lock(progress);
    if (++done % 64 == 0 || done == jobs.size())
      run.report("extrude", {}, static_cast<double>(done) / static_cast<double>(jobs.size()));
  });
  if (run.cancelled()) return {};

  const base::Spent raised_in = raising.stop();
  base::Watch labelling;
  std::vector<std::optional<model::LabelledSolid>> models(jobs.size());
  label::Options classes = options.label;
  // Walls are vertical where nothing was measured: what leans at all is the roof that tags describe.
  constexpr double upright = 0.02;  // rad
  if (by_attributes) classes.wall_angle = std::min(classes.wall_angle, upright);
  base::parallel_for(blocks.size(), [&](std::size_t b) {
    std::vector<std::size_t> raised;
    std::vector<model::Solid> solids;
    for (std::size_t i = blocks[b].first; i < blocks[b].first + blocks[b].count; ++i) {
      if (!jobs[i].solid) continue;
      raised.push_back(i);
      solids.push_back(std::move(*jobs[i].solid));
    }
    auto labelled = label::classify(std::move(solids), classes, inner);
    for (std::size_t k = 0; k < raised.size(); ++k) {
      detail::move(jobs[raised[k]].planned.plan, blocks[b].origin);
      detail::move(labelled[k].solid, blocks[b].origin);
      models[raised[k]] = std::move(labelled[k]);
    }
  });
  const base::Spent labelled_in = labelling.stop();

  report::Reconstruction out;
  out.city.frame = scene.frame;
  out.city.made_by = detail::made_by(scene, options);
  begin(scene, said, by_attributes, out);
  out.city.buildings.resize(said.size());  // with those that stand around what was asked for
  out.buildings.resize(said.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    auto& job = jobs[i];
    const std::size_t feature = job.feature;
    const auto& footprint = scene.feature(feature);
    auto& report = out.buildings[feature];
    if (job.part)
      for (auto& reason : job.reasons) reason.subject = footprint.parts[*job.part].id;
    add_all(report.reasons, job.reasons);
    if (!job.full) report.outcome = report::Outcome::fallback;
    if (by_attributes) {
      const std::string shape(roof::to_string(job.planned.shape));
      report.roof = report.roof.empty() || report.roof == shape ? shape : "several";
    }
    const auto& of = job.part ? said[feature].parts[*job.part] : said[feature].whole;
    auto& building = out.city.buildings[feature];
    if (auto& model = models[i]) take(std::move(job), *std::move(model), footprint, of, by_attributes, building);
  }
  auto united = unite_parts(out.city.buildings);
  for (std::size_t b = 0; b < united.size(); ++b) settle(std::move(united[b]), out.city.buildings[b], out.buildings[b]);
  out.city.buildings.resize(scene.footprints.size());
  out.buildings.resize(scene.footprints.size());
  for (auto& building :
       out.city.buildings) {  // to the nearest numbers of the files' grid, as those that are taken over
    for (auto& one : building.parts) detail::move(one.model.solid, {});
    for (auto& one : building.solids) detail::move(one.model.solid, {});
  }
  base::parallel_for(out.buildings.size(),
                     [&](std::size_t i) { finish(out.city.buildings[i], out.buildings[i], scene.frame, options); });
  out.times.stages = {{"roof", planned_in}, {"extrude", raised_in}, {"label", labelled_in}};
  return out;
}

}  // namespace

auto raise_footprints(const model::Scene& scene, const Options& options, const base::Run& run)
    -> base::Result<report::Reconstruction> {
  base::Watch total;
  const auto making = making_of(scene, options);
  if (!making) return making.failure();
  auto out = raise_all(scene, *making, options, run);
  if (!run.cancelled()) detail::report_overlaps(out, run);
  if (run.cancelled()) return base::stopped();
  if (detail::has_colours(scene, options))
    for (auto& building : out.city.buildings) building.texture = detail::painted(building);
  warn_of_assumed(static_cast<std::size_t>(std::ranges::count_if(out.buildings, is_assumed)), scene, out.warnings);
  out.times.total = total.stop();
  return out;
}

auto raise_footprints_aside(const model::Scene& scene, const Options& options, const base::Run& run,
                            const Schedule& schedule) -> base::Result<PutAside> {
  base::Watch total;
  const auto making = making_of(scene, options);
  if (!making) return making.failure();
  PutAside out;
  detail::CityBuilder builder(out, scene.footprints.size());
  if (auto opened = builder.open(); !opened) return opened.failure();
  const auto groups = block::groups(scene, options.block);
  const auto places = detail::by_place(groups, scene.frame);
  const auto index = detail::index_of(scene);
  std::size_t assumed = 0;
  std::map<std::string, std::vector<base::Spent>> spent;
  std::vector<std::string> stages;
  const bool coloured = detail::has_colours(scene, options);
  const auto take = [&](std::size_t feature, detail::Finished one) {
    if (is_assumed(one.report)) ++assumed;
    if (coloured) one.building.texture = detail::painted(one.building);
    builder.take(feature, one);
  };
  const auto tasks = detail::in_tasks(places, static_cast<std::size_t>(options.ingest.task_footprints), scene.frame);
  detail::TaskKeeper keeper(options, schedule, tasks, scene.footprints.size());
  std::size_t before = 0;
  for (const auto& task : tasks) {
    if (run.cancelled()) break;
    const auto part = detail::part_of(scene, task.groups, index, true);
    auto features = keeper.find(task, part);
    const std::size_t here = task.groups.size();
    if (!features) {
      base::Run inner = run;
      inner.progress = [&](auto stage, auto subject, double fraction) {
        run.report(
            stage, subject,
            (static_cast<double>(before) + fraction * static_cast<double>(here)) / static_cast<double>(places.size()));
      };
      auto made = raise_all(part.scene, *making, options, inner);
      if (run.cancelled()) break;
      features.emplace();
      for (std::size_t i = 0; i < made.buildings.size(); ++i)
        features->push_back({std::move(made.city.buildings[i]), std::move(made.buildings[i])});
      for (const auto& [stage, time] : made.times.stages) {
        if (!spent.contains(stage)) stages.push_back(stage);
        spent[stage].push_back(time);
      }
      if (auto kept = keeper.keep(*features, scene.frame); !kept) return kept.failure();
    }
    before += here;
    for (std::size_t i = 0; i < features->size(); ++i) take(part.features[i], std::move((*features)[i]));
    if (auto put = builder.check(); !put) return put.failure();
    keeper.count(task, features->size());
    if (before < places.size())
      run.report("done", std::to_string(before) + " of " + std::to_string(places.size()) + " blocks",
                 static_cast<double>(before) / static_cast<double>(places.size()));
  }
  if (!run.cancelled()) {
    auto reuse = keeper.finish();
    if (!reuse) return reuse.failure();
    out.summary.reuse = std::move(*reuse);
    if (keeper.keeps()) out.tasks = tasks.size();
    // Those that cannot be used belong to no group.
    model::Scene rest;
    std::vector<std::size_t> features;
    for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
      if (builder.has(f)) continue;
      features.push_back(f);
      rest.footprints.push_back(scene.footprints[f]);
    }
    rest.frame = scene.frame;
    base::Run inner = run;
    inner.progress = nullptr;  // no stage of the whole
    auto unmade = raise_all(rest, *making, options, inner);
    for (std::size_t i = 0; i < unmade.buildings.size(); ++i)
      take(features[i], {std::move(unmade.city.buildings[i]), std::move(unmade.buildings[i])});
    builder.finish(run);
  }
  if (run.cancelled()) return base::stopped();
  warn_of_assumed(assumed, scene, out.summary.warnings);
  out.frame = scene.frame;
  out.made_by = detail::made_by(scene, options);
  for (const auto& stage : stages) out.summary.times.stages.push_back({stage, base::combined(spent[stage])});
  out.summary.times.total = total.stop();
  return out;
}

}  // namespace mansard::pipeline
