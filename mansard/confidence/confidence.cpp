#include "mansard/confidence/confidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "mansard/base/metres.hpp"
#include "mansard/confidence/detail/coefficients.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::confidence {
namespace {

/// What measures have in common: one sentence for a person.
struct Reason {
  const char* code;
  std::vector<Measure> measures;
  std::string (*words)(const Evidence&);
};

auto percent(double share) -> std::string { return base::to_text(100 * share, 0) + " %"; }

/// Share of the footprint.
auto share_at_ground(const Evidence& e) -> double { return e[Measure::low] + e[Measure::razed]; }
constexpr double most_of_it = 0.5;

auto reasons() -> const std::vector<Reason>& {
  using enum Measure;
  static const std::vector<Reason> all{
      {"confidence-unseen",
       {unseen, crowns, bare},
       [](const Evidence& e) {
         if (e[bare] > e[unseen])
           return percent(e[bare]) + " of the footprint has no model, where the scan does not show the ground";
         return "the scan does not cover " + percent(e[unseen]) + " of the footprint" +
                (e[crowns] > 0.5 * e[unseen] ? ", most of it below trees" : "");
       }},
      {"confidence-above",
       {above, patch_above, stacked, top, bias},
       [](const Evidence& e) {
         return "the scan is above the model over " + percent(e[above]) + " of the roof, by up to " +
                base::metres(e[top]) + ": a part of the roof that the model lacks, a tree or a crane";
       }},
      {"confidence-below",
       {below, patch_below, sunk},
       [](const Evidence& e) {
         return "the scan is below the model over " + percent(e[below]) + " of the roof, " +
                base::to_text(e[patch_below], 0) + " m² in one place: a lower part, glass or water";
       }},
      {"confidence-off",
       {rms, rough},
       [](const Evidence& e) {
         return "the scan is " + base::to_text(e[rms], 2) +
                " m off the model's roof (root mean square), and uneven over " + percent(e[rough]) + " of it";
       }},
      {"confidence-beside",
       {ring_high, ring_side, gap, seamless},
       [](const Evidence& e) -> std::string {
         constexpr double most_of_a_side = 0.5;
         if (e[seamless] >= most_of_a_side)
           return "the roof continues beyond the footprint on one side: the building may be larger or elsewhere, "
                  "or the roof overhangs";
         return "beside the footprint the scan is as high as the building along " + percent(e[ring_side]) +
                " of one side: the building may be larger or elsewhere, or something stands against it";
       }},
      {"confidence-rim",
       {rim_low, rim_side, free},
       [](const Evidence& e) {
         return "inside the footprint the scan is at half of the building's height or lower along " +
                percent(e[rim_side]) + " of one side: the building may be smaller or elsewhere";
       }},
      {"confidence-ground",
       {low, razed, ground_off, doubtful, height},
       [](const Evidence& e) {
         constexpr double notable = 0.1;  // of the footprint
         const double at_ground = share_at_ground(e);
         return at_ground > notable
                    ? "the scan is at the ground over " + percent(at_ground) +
                          " of the footprint: the building may be " +
                          (at_ground > most_of_it ? "gone, or newer than the scan" : "smaller, or a part of it gone")
                    : "its height above the ground, " + base::metres(e[height]) + ", is less sure than that of others";
       }},
      {"confidence-samples",
       {samples},
       [](const Evidence& e) {
         return base::to_text(e[samples], 0) + " points or independent areas of the scan for " +
                base::to_text(e[planes], 0) + " roof faces are few";
       }},
      {"confidence-walls",
       {misplaced, steps},
       [](const Evidence& e) -> std::string {
         constexpr double notable = 0.1;  // m
         const double off = std::sqrt(e[misplaced]);
         if (off < notable) return "walls within the roof are so high that a few centimetres count as an error";
         return "walls within the roof are displaced against the scan, which alone is an error of " +
                base::metres(off) + " (root mean square)";
       }},
      {"confidence-form",
       {planes, small_planes, steep, spread, relief, walls, area},
       [](const Evidence& e) {
         constexpr double notable = 0.05;  // of the roof
         std::string words = "roofs of this form are less often right: " + base::to_text(e[planes], 0) +
                             (e[planes] == 1 ? " face" : " faces") + ", heights that differ by " +
                             base::metres(e[spread]);
         if (e[small_planes] > notable) words += ", " + percent(e[small_planes]) + " of it in faces of less than 4 m²";
         if (e[steep] > notable) words += ", " + percent(e[steep]) + " of it steeper than 60°";
         return words;
       }},
      {"confidence-height",
       {height_off},
       [](const Evidence& e) {
         return "the footprint's own height or storeys are " + base::metres(std::abs(e[height_off])) +
                (e[height_off] > 0 ? " less" : " more") + " than the model's: one of the two may be of another year";
       }},
  };
  return all;
}

/// What a measure counts as: differences of a little matter more than those of a lot. With the same digits on every
/// processor, as the functions of geometry/angles.hpp.
auto scaled(const Evidence& evidence, const detail::Term& term) -> double {
  const double value = evidence[term.measure] * (term.second == detail::alone ? 1 : evidence[term.second]);
  return static_cast<double>(std::log1p(static_cast<long double>(std::abs(value) / term.scale)));
}

}  // namespace

auto confidence_of(const Evidence& evidence) -> Confidence {
  double wrong = detail::wrong_bias, error = detail::error_bias;
  std::vector<std::pair<double, const Reason*>> against;
  for (const auto& reason : reasons()) against.emplace_back(0, &reason);
  // Where the scan is at the ground, that is why it is below the model.
  constexpr std::array below_model{Measure::below, Measure::patch_below, Measure::sunk, Measure::rim_low,
                                   Measure::rim_side};
  const bool gone = share_at_ground(evidence) > most_of_it;
  for (const auto& term : detail::terms) {
    const double by = scaled(evidence, term) - term.usual;
    wrong += term.wrong * by;
    error += term.error * by;
    const auto of =
        gone && std::ranges::find(below_model, term.measure) != below_model.end() ? Measure::low : term.measure;
    for (auto& [sum, reason] : against)
      if (std::ranges::find(reason->measures, of) != reason->measures.end()) sum += term.wrong * by;
  }
  Confidence out;
  out.right = 1 / (1 + geometry::exponential(wrong));
  out.error = geometry::exponential(error);
  if (class_of(out.right) == "high") return out;
  constexpr double twice = 0.6931;  // ln 2
  std::ranges::stable_sort(against, std::greater(), &std::pair<double, const Reason*>::first);
  for (const auto& [sum, reason] : against)
    if (sum > twice) out.reasons.push_back(base::warning(reason->code, reason->words(evidence)));
  return out;
}

auto class_of(double right) -> std::string_view {
  constexpr double high = 0.85, medium = 0.5;
  return right >= high ? "high" : right >= medium ? "medium" : "low";
}

auto codes() -> std::vector<base::Code> {
  const char* const look = "Look at the building beside the scan; ms_confidence says how likely it is right.";
  return {
      {"confidence-unseen", "The scan does not cover a part of a building.", look, 0},
      {"confidence-above", "The scan is above a model.", look, 0},
      {"confidence-below", "The scan is below a model.", look, 0},
      {"confidence-off", "The scan and a model's roof differ.", look, 0},
      {"confidence-beside", "Beside a footprint the scan is as high as its building.", look, 0},
      {"confidence-rim", "Inside a footprint the scan is lower than its building.", look, 0},
      {"confidence-ground", "A building's height above the ground is less sure than others, or it has none.", look, 0},
      {"confidence-samples", "The scan has few points over a building.", look, 0},
      {"confidence-walls", "Walls within a roof may be displaced.", look, 0},
      {"confidence-form", "A building has a form that is seldom right.", look, 0},
      {"confidence-height", "A footprint's own height or number of storeys is another than the model's.", look, 0},
  };
}

}  // namespace mansard::confidence
