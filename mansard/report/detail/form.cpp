#include "mansard/report/detail/form.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "mansard/base/text.hpp"
#include "mansard/report/detail/degrees.hpp"

namespace mansard::report::detail {
namespace {

using Json = nlohmann::ordered_json;
using base::to_text;

auto share(double part, double whole) -> Json { return whole > 0 ? Json(part / whole) : Json(nullptr); }
auto share(std::size_t part, std::size_t whole) -> Json {
  return share(static_cast<double>(part), static_cast<double>(whole));
}

auto per_building(std::size_t count, std::size_t buildings) -> double {
  return buildings > 0 ? static_cast<double>(count) / static_cast<double>(buildings) : 0;
}

auto json_of(const evaluate::FoundBoth& both, const std::string& unit) -> Json {
  const auto &t = both.truth, &m = both.model;
  return {{"truth", t.count},
          {"truth_found", t.found},
          {"truth_" + unit, t.size},
          {"model", m.count},
          {"model_found", m.found},
          {"model_" + unit, m.size},
          {"recall", share(t.found, t.count)},
          {"recall_" + unit, share(t.size_found, t.size)},
          {"precision", share(m.found, m.count)},
          {"precision_" + unit, share(m.size_found, m.size)}};
}

auto of(std::size_t part, std::size_t whole) -> std::string {
  return std::to_string(part) + " of " + std::to_string(whole);
}

auto percent(double part, double whole) -> std::string {
  return whole > 0 ? to_text(100 * part / whole, 1) + " %" : std::string("-");
}

auto in_words(const evaluate::FoundBoth& both, const std::string& by) -> std::string {
  const auto &t = both.truth, &m = both.model;
  return of(t.found, t.count) + " (" + percent(t.size_found, t.size) + " by " + by + "), precision " +
         of(m.found, m.count) + " (" + percent(m.size_found, m.size) + ")";
}

/// How many planes a building has, in ratio to the truth.
auto plane_ratio(const evaluate::FormTruth& found, const evaluate::Form& form) -> std::pair<double, double> {
  return {per_building(form.planes, form.buildings), per_building(found.form.planes, found.form.buildings)};
}

auto right_buildings(const evaluate::FormTruth& found) -> std::size_t {
  return static_cast<std::size_t>(
      std::ranges::count_if(found.compared, [](const auto& building) { return building.every_plane_right(); }));
}

auto json_of(const std::optional<evaluate::ComparedPlane::Nearest>& nearest) -> Json {
  if (!nearest) return nullptr;
  return {{"angle_deg", degrees(nearest->angle)}, {"height_m", nearest->height}, {"shared_m2", nearest->shared}};
}

/// The planes that are not found in the other model.
auto wrong_json(const std::vector<evaluate::ComparedPlane>& planes, double ground, const model::Frame& frame) -> Json {
  Json out = Json::array();
  for (const auto& one : planes) {
    if (one.result != evaluate::ComparedPlane::Result::not_found) continue;
    const auto azimuth = evaluate::azimuth_of(one.plane);
    const auto centre = evaluate::centre_of(one.plane);
    const auto in_file = [&](double local, std::size_t axis) {
      return Json(local + static_cast<double>(frame.origin[axis]));
    };
    out.push_back(
        {{"pitch_deg", degrees(evaluate::pitch_of(one.plane))},
         {"azimuth_deg", azimuth ? Json(degrees(*azimuth)) : Json(nullptr)},
         {"area_m2", one.plane.area},
         {"height_above_ground_m", centre ? Json(centre->z - ground) : Json(nullptr)},
         {"centre", centre ? Json{in_file(centre->x, 0), in_file(centre->y, 1), in_file(centre->z, 2)} : Json(nullptr)},
         {"nearest", json_of(one.nearest)}});
  }
  return out;
}

}  // namespace

auto sum_of(const std::vector<evaluate::ComparedPlane>& planes) -> evaluate::Found {
  using Result = evaluate::ComparedPlane::Result;
  evaluate::Found sum;
  for (const auto& one : planes) {
    const bool found = one.result == Result::found;
    if (one.result != Result::too_small) sum.add(one.plane.area, found ? one.plane.area : 0, found);
  }
  return sum;
}

auto buildings_right(const evaluate::FormTruth& found) -> std::string {
  return of(right_buildings(found), found.buildings);
}

auto compared_json(const evaluate::FormTruth& found, const EvaluationInput& input) -> Json {
  Json out = Json::array();
  for (const auto& building : found.compared) {
    const auto truth = sum_of(building.truth_planes), model = sum_of(building.model_planes);
    Json ids = Json::array();
    for (const auto m : building.model) ids.push_back(input.model.buildings[m].id);
    out.push_back(
        {{"id", building.truth && input.truth ? Json(input.truth->buildings[*building.truth].id) : Json(nullptr)},
         {"model_ids", std::move(ids)},
         {"truth", truth.count},
         {"truth_found", truth.found},
         {"model", model.count},
         {"model_right", model.found},
         {"every_plane_right", building.every_plane_right()},
         {"truth_not_found", wrong_json(building.truth_planes, building.ground, input.scene.frame)},
         {"model_wrong", wrong_json(building.model_planes, building.ground, input.scene.frame)}});
  }
  return out;
}

auto json_of(const evaluate::Form& f) -> Json {
  return {{"planes", f.planes},
          {"planes_per_building", per_building(f.planes, f.buildings)},
          {"narrow_planes", f.narrow},
          {"twins", f.twins},
          {"twins_unequal", f.unequal},
          {"steep_planes", f.steep},
          {"steep_planes_without_scan", f.steep_bare},
          {"parts", f.parts},
          {"tall_parts", f.tall},
          {"near_ridges", f.ridges},
          {"near_ridges_unequal", f.ridges_unequal},
          {"edges", f.edges},
          {"short_edges", f.short_edges},
          {"vertices_per_building", per_building(f.vertices, f.buildings)},
          {"dormers", f.dormers},
          {"roof_structures", f.structures},
          {"unchecked", f.unchecked}};
}

auto json_of(const evaluate::FormTruth& found, const evaluate::Form& form) -> Json {
  const auto [own, real] = plane_ratio(found, form);
  Json lines = Json::object();
  for (std::size_t k = 0; k < found.lines.size(); ++k)
    lines[std::string(to_string(static_cast<evaluate::RoofLineKind>(k)))] = json_of(found.lines[k], "m");
  return {{"truth_itself", json_of(found.form)},
          {"planes_per_building_to_truth", share(own, real)},
          {"planes", json_of(found.planes, "m2")},
          {"buildings", found.buildings},
          {"buildings_with_every_plane_right", right_buildings(found)},
          {"lines", lines},
          {"dormers", json_of(found.dormers, "m2")},
          {"roof_structures", json_of(found.structures, "m2")},
          {"unchecked", found.unchecked}};
}

auto lines_of(const evaluate::Form& f) -> std::vector<Line> {
  return {
      {"  roof planes", std::to_string(f.planes) + ", " + std::to_string(f.narrow) + " of them narrower than " +
                            to_text(evaluate::narrow_width, 2) + " m"},
      {"  opposite pitches within 3°", std::to_string(f.twins) + ", " + std::to_string(f.unequal) + " of them unequal"},
      {"  roof planes over 65°",
       std::to_string(f.steep) + ", " + std::to_string(f.steep_bare) + " of them with less than 1 m² of the scan"},
      {"  parts taller than 3·√area", of(f.tall, f.parts)},
      {"  neighbours' ridges within 0.3 m",
       std::to_string(f.ridges) + ", " + std::to_string(f.ridges_unequal) + " of them unequal"},
      {"  edges shorter than 0.5 m", of(f.short_edges, f.edges)},
      {"  vertices per building", to_text(per_building(f.vertices, f.buildings), 1)},
      {"  dormers, other roof structures", std::to_string(f.dormers) + ", " + std::to_string(f.structures)},
  };
}

auto lines_of(const evaluate::FormTruth& found, const evaluate::Form& form) -> std::vector<Line> {
  const auto [own, real] = plane_ratio(found, form);
  std::vector<Line> out{{"  planes per building", to_text(own, 2) + ", of the truth " + to_text(real, 2)},
                        {"  planes recalled", in_words(found.planes, "area")},
                        {"  buildings with every plane right:", buildings_right(found)}};
  for (std::size_t k = 0; k < found.lines.size(); ++k)
    out.emplace_back("  " + std::string(to_string(static_cast<evaluate::RoofLineKind>(k))) + "s recalled",
                     in_words(found.lines[k], "length"));
  out.emplace_back("  dormers recalled", in_words(found.dormers, "area"));
  out.emplace_back("  other structures recalled", in_words(found.structures, "area"));
  return out;
}

}  // namespace mansard::report::detail
