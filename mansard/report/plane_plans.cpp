#include "mansard/report/plane_plans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "mansard/base/text.hpp"
#include "mansard/picture/plans.hpp"
#include "mansard/report/detail/degrees.hpp"
#include "mansard/report/detail/form.hpp"

namespace mansard::report {
namespace {

using base::to_text;
using detail::degrees;
using evaluate::ComparedBuilding;
using evaluate::ComparedPlane;
using picture::Colour;
using Result = ComparedPlane::Result;
using Planes = std::vector<ComparedPlane>;

constexpr Colour wrong_red{238, 120, 100}, right_grey{205, 211, 220}, small_white{244, 244, 246};

/// Lighter where a plane faces the north-west, as on a map with a shaded relief.
auto shaded(Colour colour, geometry::Point3 normal) -> Colour {
  const geometry::Point3 light = normalised(geometry::Point3{-1, 1, 1.4});
  const double level = light.z, shade = std::clamp(1 + 0.3 * (dot(light, normal) - level), 0.7, 1.15);
  for (auto& channel : colour)
    channel = static_cast<std::uint8_t>(std::lround(std::min(255.0, shade * static_cast<double>(channel))));
  return colour;
}

auto colour_of(const ComparedPlane& plane) -> Colour {
  switch (plane.result) {
    case Result::too_small: return small_white;
    case Result::not_found: return shaded(wrong_red, plane.plane.normal);
    case Result::found: break;
  }
  return shaded(right_grey, plane.plane.normal);
}

using LabelLines = std::vector<std::string>;

/// Why the plane of the other model that shares most area with this one is another plane; empty where it has nearly
/// nothing to do with it.
auto difference(const ComparedPlane::Nearest& nearest) -> std::string {
  constexpr double much = 15;  // degrees
  const double angle = degrees(nearest.angle);
  if (angle > much) return {};
  if (angle > evaluate::found_angle) return "turned by " + to_text(angle, angle < 10 ? 1 : 0) + "°";
  if (std::abs(nearest.height) > evaluate::found_height)
    return to_text(std::abs(nearest.height), 2) + (nearest.height > 0 ? " m too high" : " m too low");
  return "small overlap";
}

/// The pitch and the mean height above ground, on two lines or on one; before these also the difference, if wanted.
auto labels_of(const ComparedPlane& plane, double ground, bool differences) -> std::vector<LabelLines> {
  const auto centre = evaluate::centre_of(plane.plane);
  if (plane.result != Result::not_found || !centre) return {};
  const std::string pitch = to_text(degrees(evaluate::pitch_of(plane.plane)), 0) + "°",
                    height = to_text(centre->z - ground, 1) + " m";
  std::vector<LabelLines> labels{{pitch, height}, {pitch + " " + height}};
  const std::string why = differences && plane.nearest ? difference(*plane.nearest) : std::string();
  if (!why.empty()) labels.insert(labels.begin(), {pitch, height, why});
  return labels;
}

auto panel_of(const std::string& title, const Planes& planes, double ground, const std::string& note, bool differences)
    -> picture::PlanPanel {
  std::vector<std::pair<double, const ComparedPlane*>> by_height;
  for (const auto& plane : planes) {
    const auto centre = evaluate::centre_of(plane.plane);
    by_height.emplace_back(centre ? centre->z : std::numeric_limits<double>::lowest(), &plane);
  }
  std::ranges::stable_sort(by_height, {}, &std::pair<double, const ComparedPlane*>::first);
  picture::PlanPanel panel{title, {}, note};
  for (const auto& [height, plane] : by_height)
    panel.areas.push_back({plane->plane.plan, colour_of(*plane), labels_of(*plane, ground, differences)});
  return panel;
}

auto group_of(const ComparedBuilding& building, const EvaluationInput& input) -> picture::PlanGroup {
  const auto truth = detail::sum_of(building.truth_planes), model = detail::sum_of(building.model_planes);
  const auto wrong = [](const evaluate::Found& of) { return of.size - of.size_found; };
  picture::PlanGroup group;
  group.title = base::on_one_line(id_of(building, input));
  group.subtitle = "truth " + std::to_string(truth.count) + ", found " + std::to_string(truth.found) + "; model " +
                   std::to_string(model.count) + ", right " + std::to_string(model.found) + "; wrong " +
                   to_text(wrong(truth), 0) + " m² of the truth, " + to_text(wrong(model), 0) + " m² of the model";
  group.panels = {panel_of("truth", building.truth_planes, building.ground, "not in the truth", false),
                  panel_of("model", building.model_planes, building.ground, "not in the model", true)};
  return group;
}

}  // namespace

auto id_of(const ComparedBuilding& building, const EvaluationInput& input) -> std::string {
  if (building.truth && input.truth) return input.truth->buildings[*building.truth].id;
  return building.model.empty() ? std::string() : input.model.buildings[building.model.front()].id;
}

auto plane_plans(const Evaluation& evaluation, const EvaluationInput& input, std::size_t most) -> picture::Image {
  picture::PlanSheet sheet;
  const auto& compared = evaluation.truth.value().form.compared;
  std::vector<std::tuple<std::size_t, double, const ComparedBuilding*>> wrong;
  for (const auto& building : compared) {
    const auto truth = detail::sum_of(building.truth_planes), model = detail::sum_of(building.model_planes);
    const auto planes = truth.count - truth.found + model.count - model.found;
    if (!building.every_plane_right())
      wrong.emplace_back(planes, truth.size - truth.size_found + model.size - model.size_found, &building);
  }
  std::ranges::stable_sort(wrong, [](const auto& a, const auto& b) {
    return std::tie(std::get<0>(a), std::get<1>(a)) > std::tie(std::get<0>(b), std::get<1>(b));
  });
  const auto shown = std::min(most, wrong.size());
  for (std::size_t i = 0; i < shown; ++i) sheet.groups.push_back(group_of(*std::get<2>(wrong[i]), input));

  const auto& planes = evaluation.truth->form.planes;
  const auto of = [](std::size_t part, std::size_t all) { return std::to_string(part) + " of " + std::to_string(all); };
  sheet.title = "Roof planes of the model and of the truth";
  sheet.subtitle = "buildings with every plane right: " + detail::buildings_right(evaluation.truth->form) +
                   "; planes of the truth found: " + of(planes.truth.found, planes.truth.count) +
                   "; planes of the model right: " + of(planes.model.found, planes.model.count) + "; the worst " +
                   std::to_string(shown) + " of " + std::to_string(wrong.size()) + " buildings with an error are shown";
  sheet.keys = {
      {wrong_red,
       "not found in the other model; with its pitch and its mean height above the lowest corner of the building, "
       "and in the model with the difference from a similar plane of the truth"},
      {right_grey, "found in the other model; lighter where it faces north-west"},
      {small_white, "under 1 m²: not compared"}};
  return picture::plan_sheet(sheet);
}

}  // namespace mansard::report
