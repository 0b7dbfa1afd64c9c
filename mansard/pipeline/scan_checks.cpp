// The checks of a scan, one after another, each on the same sample of blocks.
#include "mansard/pipeline/scan_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/pipeline/detail/scan_digits.hpp"
#include "mansard/pipeline/detail/scan_place.hpp"
#include "mansard/pipeline/detail/scan_sample.hpp"
#include "mansard/pipeline/placing.hpp"

namespace mansard::pipeline {
namespace {

using base::to_text;
using detail::SampledFootprint;
using detail::ScanSample;

constexpr double deviations = 3;  // a share is significant from three standard errors on

auto percent(double share) -> std::string { return to_text(100 * share, 0) + " %"; }

/// "12 of 29 footprints"; of a sample with the share of all.
auto counted(std::size_t some, const ScanSample& sample) -> std::string {
  std::string words = std::to_string(some) + " of " + std::to_string(sample.footprints) + " footprints";
  if (sample.footprints < sample.all) {
    const auto n = static_cast<double>(sample.footprints), share = static_cast<double>(some) / n;
    // The standard error of a share (binomial), at least that of one case.
    const double error = std::sqrt(std::max(share * (1 - share), 1 / n) / n);
    words += " in a sample of " + std::to_string(sample.all) + " (" + percent(share) + " ± " + percent(error) + ")";
  }
  return words;
}

/// ": 'a', 'b', 'c'", the first of these in the source's order.
auto named(std::vector<std::size_t> features, const model::Scene& scene) -> std::string {
  constexpr std::size_t examples = 3;
  std::ranges::sort(features);
  std::string words;
  for (std::size_t i = 0; i < std::min(examples, features.size()); ++i)
    words += (i == 0 ? ": '" : ", '") + scene.footprints[features[i]].id + "'";
  return words + (features.size() > examples ? " …" : "");
}

template <class Test>
auto features_where(const ScanSample& sample, Test test) -> std::vector<std::size_t> {
  std::vector<std::size_t> out;
  for (const auto& block : sample.blocks)
    for (const auto& one : block.footprints)
      if (test(one)) out.push_back(one.feature);
  return out;
}

/// Heights above the ground of footprints that the scan covers by half.
auto heights_of(const ScanSample& sample) -> std::vector<double> {
  std::vector<double> out;
  for (const auto& block : sample.blocks)
    for (const auto& one : block.footprints)
      if (one.height && one.covered > 0.5) out.push_back(*one.height);
  return out;
}

auto way(double metres, const char* positive, const char* negative) -> std::string {
  return to_text(std::abs(metres), 2) + " m " + (metres < 0 ? negative : positive);
}

void add_offset(const accuracy::Registration& found, const Options& options, CheckedScan& out) {
  const auto offset = aligned_offset(found, options.ingest.mesh_offset);
  if (!offset) return;
  out.findings.push_back(
      base::warning("scan-offset", "the scan is " + way(found.offset.x, "east", "west") + " and " +
                                       way(found.offset.y, "north", "south") + " of the footprints (± " +
                                       to_text(found.error, 2) + " m, " + std::to_string(found.edges) + " walls); " +
                                       offset_in_words(*offset) + " corrects it, and so does --align"));
}

void add_digits(const model::Scene& scene, const ScanSample& sample, CheckedScan& out) {
  using formats::Reads;
  // A raster has its cells at regular places by nature.
  if (std::ranges::any_of(scene.inputs, [](const auto& input) {
        return formats::has_extension(input.path, &Reads::raster) && !formats::has_extension(input.path, &Reads::mesh);
      }))
    return;
  const auto lost = detail::lost_digits(scene, sample);
  if (!lost) return;
  static constexpr std::array axes{"x", "y", "z"};
  std::string steps;
  for (std::size_t a = 0; a < 3; ++a)
    if (lost->steps[a] > 0)
      steps += (steps.empty() ? "" : ", ") + std::string(axes[a]) + " in steps of " + to_text(lost->steps[a]) + " m";
  const double largest = std::ranges::max(lost->steps), error = largest / std::sqrt(12.0);
  constexpr double metres = 1;
  const bool hopeless = largest >= metres;
  auto finding = base::warning(
      "scan-digits", "the coordinates of the scan have lost digits: " + steps + ", an error of " + to_text(error, 2) +
                         " m at a noise of " + to_text(lost->noise, 2) +
                         " m, as 32-bit floats have at such coordinates; export the scan with an origin near it, and "
                         "give that as --mesh-offset");
  if (hopeless) finding.severity = base::Severity::error;
  out.findings.push_back(std::move(finding));
}

/// Lower than the ground around them, by more than a cellar's window.
constexpr double clearly = 2;  // m; the least difference at which transects see a wall

/// Whether the scan shows buildings where the footprints are. Adds what is wrong where it does not.
auto add_place(const model::Scene& scene, bool in_memory, const ScanSample& sample, const Options& options,
               const base::Run& run, CheckedScan& out) -> bool {
  auto heights = heights_of(sample);
  const auto n = static_cast<double>(heights.size());
  const auto high = std::ranges::count_if(heights, [](double h) { return h > clearly; });
  const auto low = std::ranges::count_if(heights, [](double h) { return h < -clearly; });
  // Of pits and building sites there may be one in twenty: more than these by three standard deviations (binomial).
  constexpr double pits = 0.05;
  const double most_pits = n * pits + deviations * std::sqrt(n * pits * (1 - pits));
  if (static_cast<double>(low) > most_pits && 2 * static_cast<double>(low) > n) {
    const double middle = base::mean_median(heights);
    auto finding = base::error(
        "scan-upside-down", "the scan is upside down: " + counted(static_cast<std::size_t>(low), sample) +
                                " are lower than the ground around them, by " + to_text(-middle, 1) +
                                " m in the median, and " + std::to_string(high) + " are higher; multiply its z by -1");
    // Of one or two buildings it may be a pit.
    if (n < 3) finding.severity = base::Severity::warning;
    out.findings.push_back(std::move(finding));
    return false;
  }
  // Of those without scan, too: of one that lies on its side a strip is over some footprints.
  if (high > 0 && 2 * static_cast<std::size_t>(high) >= sample.footprints) return true;
  if (!in_memory) return false;
  if (auto found = detail::other_place(scene, options, run)) {
    out.findings.push_back(std::move(*found));
    return false;
  }
  return n > 0;
}

/// Heights above the ground, or where none is found between noise that is too high, above the lowest around them.
auto some_heights_of(const ScanSample& sample) -> std::vector<double> {
  auto heights = heights_of(sample);
  if (heights.empty())
    for (const auto& block : sample.blocks)
      for (const auto& one : block.footprints)
        if (one.covered > 0.5) heights.push_back(one.above_lowest);
  std::ranges::sort(heights);
  return heights;
}

constexpr std::size_t fewest_heights = 3;

/// Heights that no town has: of those of the world's highest buildings in the median. Returns whether they are such.
auto add_too_high(const ScanSample& sample, CheckedScan& out) -> bool {
  const auto heights = some_heights_of(sample);
  constexpr double highest = 300;  // m
  if (heights.size() < fewest_heights) return false;
  const double middle = base::mean_median_of_sorted(heights);
  if (middle <= highest) return false;
  // A house of 3 m or more has 3,000 mm.
  const bool millimetres = middle > 3000;
  out.findings.push_back(
      base::error("scan-units", "the heights of the scan are not in metres: of " + std::to_string(heights.size()) +
                                    " footprints, the median is " + to_text(middle, 0) + " m high; multiply its z by " +
                                    (millimetres ? "0.001 if it is in millimetres" : "0.01 if it is in centimetres")));
  return true;
}

/// No footprint that is as high as a man, though all are higher than an exact scan of level ground. Returns whether.
auto add_too_low(const ScanSample& sample, CheckedScan& out) -> bool {
  const auto heights = some_heights_of(sample);
  constexpr double lowest = 1, exact = 0.001;  // m
  if (heights.size() < fewest_heights || heights.back() >= lowest || base::mean_median_of_sorted(heights) <= exact)
    return false;
  out.findings.push_back(base::warning(
      "scan-units", "the scan has no buildings, or its heights are not in metres: of " +
                        std::to_string(heights.size()) + " footprints, the highest is " + to_text(heights.back(), 3) +
                        " m high; multiply its z by 1000 if it is in kilometres"));
  return true;
}

void add_ground(const model::Scene& scene, const ScanSample& sample, const Options& options, CheckedScan& out) {
  using block::GroundSource;
  const auto unseen = features_where(sample, [](const SampledFootprint& one) {
    return one.covered > 0 && (one.ground == GroundSource::lowest || one.ground == GroundSource::assumed);
  });
  if (unseen.empty()) return;
  const auto assumed = features_where(
      sample, [](const SampledFootprint& one) { return one.covered > 0 && one.ground == GroundSource::assumed; });
  out.findings.push_back(base::warning(
      "scan-ground",
      "the scan shows no ground for " + counted(unseen.size(), sample) + named(unseen, scene) + "; their bases are " +
          (assumed.size() == unseen.size() ? to_text(options.block.storey, 1) + " m below their lowest roofs"
           : assumed.empty()               ? std::string("at the lowest that the scan shows beside them")
                             : "at the lowest that the scan shows beside them, or " + to_text(options.block.storey, 1) +
                                   " m below their lowest roofs") +
          "; give a terrain model (--dtm FILE), an attribute (--ground-attribute NAME) or a height (--ground-height "
          "Z)"));
}

void add_coverage(const model::Scene& scene, const ScanSample& sample, const Options& options, CheckedScan& out) {
  const auto outside = static_cast<std::size_t>(std::ranges::count_if(scene.footprints, [](const auto& footprint) {
    return footprint.defect && footprint.defect->code == "ingest-footprint-outside";
  }));
  // A place of the sample is a metre wide or more: less than one place in ten may be a chimney's shadow.
  const auto none = features_where(sample, [](const SampledFootprint& one) { return one.covered == 0; });
  const auto cut = features_where(sample, [&](const SampledFootprint& one) {
    return one.covered > 0 && 1 - one.covered >= options.partly_seen && one.at_end;
  });
  if (outside > 0)
    out.findings.push_back(base::warning(
        "scan-coverage", std::to_string(outside) + " of " + std::to_string(scene.footprints.size()) + " footprints (" +
                             percent(static_cast<double>(outside) / static_cast<double>(scene.footprints.size())) +
                             ") are outside of the scan; give the scan there, or choose footprints with --bbox"));
  if (!none.empty())
    out.findings.push_back(base::warning("scan-coverage", "the scan covers nothing of " + counted(none.size(), sample) +
                                                              named(none, scene) +
                                                              "; they get no model: give the scan there"));
  if (!cut.empty())
    out.findings.push_back(base::warning(
        "scan-coverage", "the scan ends in " + counted(cut.size(), sample) + named(cut, scene) +
                             "; what it does not cover continues the roof beside it: give the scan there"));
}

void add_age(const model::Scene& scene, const ScanSample& sample, CheckedScan& out) {
  // As high as the ground around it, in the median over the footprint: neither a shed nor a carport.
  constexpr double level = 0.5;  // m
  const auto empty = features_where(sample, [](const SampledFootprint& one) {
    return one.height && one.covered > 0.9 && std::abs(*one.height) < level;
  });
  if (empty.empty()) return;
  out.findings.push_back(base::warning(
      "scan-empty", counted(empty.size(), sample) + " are as high as the ground around them in the scan" +
                        named(empty, scene) +
                        "; the buildings are younger than the scan, demolished, or below the ground: compare the dates "
                        "of scan and footprints"));
}

}  // namespace

auto aligned_offset(const accuracy::Registration& found, const std::array<double, 3>& present)
    -> std::optional<std::array<double, 3>> {
  constexpr double least = 0.02;     // m: twice what surveys of footprints are rounded to
  constexpr std::size_t fitted = 3;  // numbers: the offset, and what all walls have in common
  if (found.edges <= fitted) return std::nullopt;
  // Of two coordinates, a length that chance exceeds once in ten thousand scans (χ² with two degrees of freedom:
  // 18.42): walls beside each other are less independent than the error counts them. Of few walls rather more, as
  // Student's t is beyond the normal distribution (Cornish and Fisher 1938, the first two terms).
  constexpr double z = 4.29;
  const auto freedom = static_cast<double>(found.edges - fitted);
  const double limit =
      z + (z * z * z + z) / (4 * freedom) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * freedom * freedom);
  const double size = length(found.offset);
  if (size < least || size < limit * found.error) return std::nullopt;
  const auto centimetres = [](double value) { return std::round(value * 100) / 100; };
  return std::array{present[0] - centimetres(found.offset.x), present[1] - centimetres(found.offset.y), present[2]};
}

auto check_scan(const model::Scene& scene, const ingest::MeshCells* cells, const Options& options, const base::Run& run)
    -> base::Result<CheckedScan> {
  CheckedScan out;
  if (std::ranges::any_of(scene.footprints, &model::Footprint::derived)) return out;
  run.report("check", "", 0);
  const auto sample = detail::sample_scan(scene, cells, options, run);
  if (!sample) return sample.failure();
  add_digits(scene, *sample, out);
  const bool in_place = !add_too_high(*sample, out) && add_place(scene, cells == nullptr, *sample, options, run, out);
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  if (in_place) {
    std::vector<accuracy::Piece> pieces;
    for (const auto& block : sample->blocks) pieces.push_back(block.piece());
    out.registration = accuracy::registration(pieces);
    if (out.registration) add_offset(*out.registration, options, out);
    // Beside the buildings, what is over a footprint says nothing of it.
    constexpr double beside = 0.5;  // m
    const bool over = !out.registration || length(out.registration->offset) < beside;
    if (!add_too_low(*sample, out) && over) add_age(scene, *sample, out);
  }
  add_ground(scene, *sample, options, out);
  add_coverage(scene, *sample, options, out);
  std::ranges::stable_sort(out.findings, {}, [](const auto& one) { return one.severity != base::Severity::error; });
  run.report("check", "", 1);
  return out;
}

auto scan_codes() -> std::vector<base::Code> {
  return {
      {"scan-offset", "The scan is beside the footprints, by more than the error of this measurement explains.",
       "Give the option of the message, or --align, unless the footprints are what is in the wrong place.", 0},
      {"scan-upside-down", "The scan is upside down: footprints are lower than the ground around them.",
       "Multiply the heights of the scan by -1, or turn it over, before it is read.", 3},
      {"scan-axis", "Another axis of the scan is up than the one that was taken.",
       "Give the --up of the message, or turn the scan before it is read.", 3},
      {"scan-mirrored", "The scan is mirrored.", "Correct the sign or the order of its coordinates.", 3},
      {"scan-place", "The scan fits its footprints at another place.", "Give the option of the message.", 3},
      {"scan-units", "Scan and footprints are in different units.",
       "Multiply the coordinates of the scan by the factor of the message before it is read.", 3},
      {"scan-digits",
       "The coordinates of the scan lie on a coarse grid, as 32-bit floats have it far from their origin. From steps "
       "of a metre on it is an error.",
       "Export the scan with an origin near it, or in 64-bit floats.", 3},
      {"scan-ground", "The scan shows no ground beside buildings, so their bases are assumed.",
       "Give a terrain model with --dtm, or --ground-attribute or --ground-height.", 0},
      {"scan-coverage", "The scan does not cover all footprints.",
       "Give the scan there, or choose the footprints with --bbox.", 0},
      {"scan-empty", "Footprints are as high as the ground around them in the scan.",
       "Compare the dates of scan and footprints; leave out footprints that are no buildings with --where.", 0},
      {"scan-aligned", "The scan was moved to the footprints, as --align asks for.", "Nothing to do.", 0},
  };
}

}  // namespace mansard::pipeline
