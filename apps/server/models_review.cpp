// Models: what a person who reviews a building is shown beside it: where scan and model differ most, and other models.
//
// The search of a run keeps none of the models that it did not choose. Those offered here are made from the plan and
// the scan: plain roofs, of which eaves and pitch fit the scan with the least squares, over each part and over the
// whole footprint; the parts without the structures on their roofs; and, after edits, what the run made. All are
// measured as the model itself is, and the best three are offered.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "apps/server/model_boxes.hpp"
#include "apps/server/models.hpp"
#include "apps/server/review_place.hpp"
#include "mansard/confidence/confidence.hpp"
#include "mansard/roof/roof.hpp"
#include "mansard/solid/append_surface.hpp"

namespace mansard::server {
namespace {

constexpr std::size_t most_alternatives = 3;
/// A plain roof that would be wrong (confidence::wrong_above), with a root mean square error of more than this many
/// times that of the model, is no alternative to it.
constexpr double most_times_worse = 2;
constexpr double lowest_eaves = 1.0;     // m above the ground; less is no wall
constexpr double steepest_pitch = 3.0;   // rise over run, 72°; more is a wall
constexpr double flattest_pitch = 0.03;  // rise over run; less is a flat roof

auto mesh_of_solids(const std::vector<const model::Solid*>& solids) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (const auto* one : solids) solid::append_surface(*one, mesh);
  return mesh;
}

/// A roof that can be put on a part.
struct Plain {
  roof::Shape shape;
  roof::Orientation orientation;
};

auto plain_plan(const geometry::Polygon& polygon, const Plain& plain, double base, double eaves, double pitch)
    -> std::optional<model::Plan> {
  roof::Form form;
  form.shape = plain.shape;
  form.orientation = plain.orientation;
  form.ground = base;
  form.height = eaves;
  form.roof_included = plain.shape == roof::Shape::flat;
  if (plain.shape != roof::Shape::flat) form.angle = std::atan(pitch);
  auto planned = roof::plan_of(polygon, form);
  if (!planned || planned->shape != plain.shape) return std::nullopt;
  return std::move(planned->plan);
}

/// Eaves and pitch with the least squares: heights of such a roof are eaves + pitch · d, where d is the height over its
/// eaves of the same roof with a pitch of 1.
auto fitted(const geometry::Polygon& polygon, const Plain& plain, double base, const rays::Scene& scan,
            const pipeline::Options& options) -> std::optional<model::Plan> {
  constexpr double first = 3.0;  // m; eaves of the roof with the pitch 1
  const auto unit = plain_plan(polygon, plain, base, first, 1);
  if (!unit) return std::nullopt;
  const auto raised = pipeline::raise_part(*unit, options);
  if (!raised || raised->outcome != extrude::Outcome::full) return std::nullopt;
  const rays::Scene model(mesh_of_solids({&raised->solid}));
  double n = 0, d1 = 0, d2 = 0, h1 = 0, dh = 0;
  const std::vector<geometry::Polygon> footprint{polygon};
  const auto over = differences_on_roof({model, scan, footprint, {}, base, options.evaluate});
  for (std::size_t row = 0; row < over.rows; ++row)
    for (std::size_t column = 0; column < over.columns; ++column) {
      const double difference = over.over[row * over.columns + column];
      const auto top = std::isfinite(difference) ? model.top(over.at(column, row)) : std::nullopt;
      if (!top) continue;
      const double d = *top - base - first, h = *top - difference - base;  // of the unit roof, and of the scan
      n += 1, d1 += d, d2 += d * d, h1 += h, dh += d * h;
    }
  if (n == 0) return std::nullopt;
  if (plain.shape == roof::Shape::flat)
    return h1 / n < lowest_eaves ? std::nullopt : plain_plan(polygon, plain, base, h1 / n, 0);
  const double determinant = n * d2 - d1 * d1;
  if (!(determinant > 0)) return std::nullopt;
  const double pitch = (n * dh - d1 * h1) / determinant, eaves = (h1 - pitch * d1) / n;
  if (!(pitch > flattest_pitch && pitch < steepest_pitch && eaves > lowest_eaves)) return std::nullopt;
  return plain_plan(polygon, plain, base, eaves, pitch);
}

/// The parts that stand on the ground, with the holes closed in which structures of their roofs are.
auto without_structures(const std::vector<edit::NamedPlan>& parts) -> std::vector<edit::NamedPlan> {
  const auto same = [](const geometry::Ring& hole, const geometry::Ring& outline) {
    return hole.size() == outline.size() &&
           std::ranges::all_of(hole, [&](const auto& p) { return std::ranges::find(outline, p) != outline.end(); });
  };
  std::vector<edit::NamedPlan> out;
  for (const auto& part : parts) {
    const bool is_structure = std::ranges::any_of(parts, [&](const auto& other) {
      return &other != &part && std::ranges::any_of(other.plan.holes, [&](const auto& hole) {
        return same(hole.points, part.plan.outer.points);
      });
    });
    if (is_structure) continue;
    auto bare = part;
    std::erase_if(bare.plan.holes, [&](const auto& hole) {
      return std::ranges::any_of(
          parts, [&](const auto& other) { return &other != &part && same(hole.points, other.plan.outer.points); });
    });
    out.push_back(std::move(bare));
  }
  return out;
}

struct Candidate {
  std::string what;
  std::vector<edit::NamedPlan> parts;
  bool plain = true;  ///< roofs that nobody made or edited
};

constexpr std::array<std::pair<const char*, std::array<Plain, 2>>, 3> plain_roofs{{
    {"flat roof", {{{roof::Shape::flat, roof::Orientation::along}, {roof::Shape::flat, roof::Orientation::across}}}},
    {"gable roof",
     {{{roof::Shape::gabled, roof::Orientation::along}, {roof::Shape::gabled, roof::Orientation::across}}}},
    {"hip roof", {{{roof::Shape::hipped, roof::Orientation::along}, {roof::Shape::hipped, roof::Orientation::across}}}},
}};

/// A plain roof over one polygon, and its error as that of a part.
struct Fitted {
  model::Plan plan;
  double mse = 0;  // m²
};
/// The better of the two directions.
auto best_of(const geometry::Polygon& polygon, const std::array<Plain, 2>& choices, double base,
             const rays::Scene& scan, const pipeline::Options& options) -> std::optional<Fitted> {
  std::optional<Fitted> best;
  for (const auto& plain : choices) {
    if (plain.shape == roof::Shape::flat && plain.orientation == roof::Orientation::across) continue;
    auto plan = fitted(polygon, plain, base, scan, options);
    if (!plan) continue;
    const auto raised = pipeline::raise_part(*plan, options);
    if (!raised || raised->outcome != extrude::Outcome::full) continue;
    const double mse = evaluate::error_over(raised->solid, polygon, scan, options.evaluate);
    if (!best || mse < best->mse) best = Fitted{std::move(*plan), mse};
  }
  return best;
}

/// Plain roofs over each of the polygons: all of one shape, and the best shape of each.
auto plain_candidates(const std::vector<edit::NamedPlan>& over, const std::string& where, const rays::Scene& scan,
                      const pipeline::Options& options) -> std::vector<Candidate> {
  constexpr auto shapes = plain_roofs.size();
  std::vector<std::array<std::optional<Fitted>, shapes>> roofs(over.size());
  base::parallel_for(over.size() * shapes, [&](std::size_t i) {
    const auto& plan = over[i / shapes].plan;
    roofs[i / shapes][i % shapes] =
        best_of(model::polygon_of(plan), plain_roofs[i % shapes].second, plan.base, scan, options);
  });
  std::vector<Candidate> out;
  for (std::size_t shape = 0; shape < shapes; ++shape) {
    Candidate candidate{plain_roofs[shape].first + where, {}};
    for (std::size_t p = 0; p < over.size(); ++p)
      if (const auto& roof = roofs[p][shape]) candidate.parts.push_back({over[p].id, roof->plan});
    if (candidate.parts.size() == over.size()) out.push_back(std::move(candidate));
  }
  Candidate mixed{"the best plain roof" + where, {}};
  for (std::size_t p = 0; p < over.size(); ++p) {
    const Fitted* best = nullptr;
    for (const auto& roof : roofs[p])
      if (roof && (best == nullptr || roof->mse < best->mse)) best = &*roof;
    if (best != nullptr) mixed.parts.push_back({over[p].id, best->plan});
    else if (!over[p].plan.profiles.empty()) mixed.parts.push_back(over[p]);  // as it is
  }
  if (mixed.parts.size() == over.size()) out.push_back(std::move(mixed));
  return out;
}

auto faces_of(const edit::RaisedBuilding& building) -> std::size_t {
  std::size_t faces = 0;
  for (const auto& part : building.parts)
    if (part.model) faces += static_cast<std::size_t>(std::ranges::count(part.model->classes, model::FaceClass::roof));
  return faces;
}

}  // namespace

auto Models::model_now(std::string_view building) const -> std::optional<ModelNow> {
  const auto now = view();
  const auto at = index_.find(building);
  if (at == index_.end() || at->second >= now->buildings.size()) return std::nullopt;
  const auto& known = *now->buildings[at->second];
  const auto first = first_->plans(at->second);
  const auto parts = known.parts ? known.parts : first;
  const bool same = std::ranges::equal(*first, *parts, {}, &edit::NamedPlan::plan, &edit::NamedPlan::plan);
  std::vector<const model::Plan*> plans;
  for (const auto& part : *parts) plans.push_back(&part.plan);
  return ModelNow{report::model_key(plans, first_->frame()), known.revision, !same};
}

auto Models::review_case(const std::string& building, const OpenScene* scene) const -> base::Result<std::string> {
  const auto now = view();
  const auto index = known({building, 0, {}}, *now);
  if (!index) return index.error();
  const auto& own = *now->buildings[*index];
  const auto parts_now = parts_of(*index, own);
  const auto scan = scene == nullptr ? nullptr : scene->rays_of(building);
  const auto* member = scene == nullptr ? nullptr : scene->member_of(building);

  Json place = nullptr;
  std::vector<Candidate> candidates;
  if (scan != nullptr && member != nullptr) {
    auto around = geometry::bounds(member->polygons);
    std::vector<std::size_t> which;
    for (std::size_t b = 0; b < now->buildings.size(); ++b)
      if (b == *index || touch(around, now->buildings[b]->box)) which.push_back(b);
    const auto near = made_all(which, *now);
    std::vector<const model::Solid*> solids;
    for (const auto& one : near)
      for (const auto& part : one->models) solids.push_back(&part.solid);
    const rays::Scene models(mesh_of_solids(solids));
    std::vector<geometry::Polygon> others;
    if (const auto* block = scene->block_named(*reports_[*index].block); block != nullptr) {
      others = block->beside;
      for (const auto& one : block->members)
        if (&one != member) others.insert(others.end(), one.polygons.begin(), one.polygons.end());
    }
    const auto& text = *reports_[*index].reasons;
    const auto reasons = text.empty() ? Json::array() : Json::parse(text);
    const auto reason = reasons.empty() ? std::string() : reasons.front().value("code", std::string());
    if (const auto found =
            place_of(reason, {models, *scan, member->polygons, others, member->ground, options_.evaluate}))
      place = {{"at", {found->at.x, found->at.y, found->at.z}},
               {"what", to_string(found->what)},
               {"difference", found->difference ? Json(*found->difference) : Json(nullptr)}};
    const auto bare = without_structures(*parts_now);
    candidates = plain_candidates(bare, bare.size() > 1 ? " on each part" : std::string(), *scan, options_);
    if (bare.size() != 1 && member->polygons.size() == 1) {
      model::Plan whole;
      whole.outer.points = member->polygons.front().outer;
      for (const auto& hole : member->polygons.front().holes) whole.holes.push_back({hole, {}});
      whole.base = member->ground;
      const auto id = parts_now->empty() ? building + "-1" : parts_now->front().id;
      for (auto& one : plain_candidates({{id, std::move(whole)}}, " over the whole footprint", *scan, options_))
        candidates.push_back(std::move(one));
    }
  }
  if (auto bare = without_structures(*parts_now); bare.size() < parts_now->size() && !bare.empty())
    candidates.push_back({"without the structures on the roof", std::move(bare), false});
  candidates.push_back({"as the run made it", *first_->plans(*index), false});

  struct Offered {
    Candidate candidate;
    edit::RaisedBuilding raised;
  };
  std::vector<Offered> offered;
  for (auto& candidate : candidates) {
    const auto has_parts = [&](const Offered& other) { return other.candidate.parts == candidate.parts; };
    if (candidate.parts == *parts_now || candidate.parts.empty() || std::ranges::any_of(offered, has_parts)) continue;
    auto raised = this->raised({building, own.revision, candidate.parts}, *index, {}, *now, scene);
    const double most = std::max(confidence::wrong_above, most_times_worse * most_times_worse * own.mse.value_or(0));
    if (candidate.plain && own.mse && raised.mse.value_or(most) > most) continue;
    if (raised.valid()) offered.push_back({std::move(candidate), std::move(raised)});
  }
  std::ranges::stable_sort(
      offered, {}, [](const Offered& one) { return one.raised.mse.value_or(std::numeric_limits<double>::infinity()); });
  if (offered.size() > most_alternatives) offered.erase(offered.begin() + most_alternatives, offered.end());

  Json alternatives = Json::array();
  for (const auto& [candidate, raised] : offered) {
    Json parts = Json::array();
    for (const auto& part : candidate.parts) parts.push_back(json_of(part));
    alternatives.push_back({{"what", candidate.what},
                            {"mse", raised.mse ? Json(*raised.mse) : Json(nullptr)},
                            {"roof_faces", faces_of(raised)},
                            {"parts", std::move(parts)}});
  }
  return text_of({{"building", building},
                  {"revision", own.revision},
                  {"place", std::move(place)},
                  {"alternatives", std::move(alternatives)}});
}

}  // namespace mansard::server
