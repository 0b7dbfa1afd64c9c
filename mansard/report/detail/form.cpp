#include "mansard/report/detail/form.hpp"

#include <nlohmann/json.hpp>

#include "mansard/base/text.hpp"

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

}  // namespace

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
                        {"  planes recalled", in_words(found.planes, "area")}};
  for (std::size_t k = 0; k < found.lines.size(); ++k)
    out.emplace_back("  " + std::string(to_string(static_cast<evaluate::RoofLineKind>(k))) + "s recalled",
                     in_words(found.lines[k], "length"));
  out.emplace_back("  dormers recalled", in_words(found.dormers, "area"));
  out.emplace_back("  other structures recalled", in_words(found.structures, "area"));
  return out;
}

}  // namespace mansard::report::detail
