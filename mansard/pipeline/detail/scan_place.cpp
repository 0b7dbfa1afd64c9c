#include "mansard/pipeline/detail/scan_place.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "mansard/align/align.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/pipeline/placing.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Point3;
using geometry::Polygon;

/// What a scan may be, and how its coordinates would be right.
struct Candidate {
  std::string code, words;
  std::function<Point3(Point3)> change;  ///< of coordinates as read, without offset
};

auto candidates_of(const model::Scene& scene, const Options& options, Point3 middle) -> std::vector<Candidate> {
  std::vector<Candidate> out;
  const bool y_up = ingest::is_read_y_up(options.ingest, scene.inputs);
  out.push_back({"scan-axis",
                 y_up ? std::string("its z axis is down; turn it by 180° about its x axis and give --up z")
                      : std::string("its y axis is up; give --up y"),
                 [](Point3 p) {
                   return Point3{p.x, -p.z, p.y};
                 }});
  out.push_back({"scan-axis",
                 y_up ? std::string("its z axis is up; give --up z")
                      : std::string("it is y up and mirrored; multiply its z by -1 and give --up y"),
                 [](Point3 p) {
                   return Point3{p.x, p.z, -p.y};
                 }});
  out.push_back({"scan-axis", "its x axis is up; turn it before it is read", [](Point3 p) {
                   return Point3{-p.z, p.y, p.x};
                 }});
  const auto scaled = [&](double factor, const std::string& words) {
    out.push_back({"scan-units", words, [factor](Point3 p) { return factor * p; }});
  };
  constexpr double foot = 0.3048;
  scaled(foot, "it is in feet; multiply its coordinates by 0.3048");
  scaled(1 / foot, "the footprints are in feet, or it was divided by 3.2808; multiply its coordinates by 3.2808");
  scaled(0.001, "it is in millimetres; multiply its coordinates by 0.001");
  scaled(0.01, "it is in centimetres; multiply its coordinates by 0.01");
  scaled(1000, "it is in kilometres; multiply its coordinates by 1000");
  out.push_back({"scan-mirrored", "it is mirrored along x; correct the sign of its x", [middle](Point3 p) {
                   return Point3{2 * middle.x - p.x, p.y, p.z};
                 }});
  out.push_back({"scan-mirrored", "it is mirrored along y; correct the sign of its y", [middle](Point3 p) {
                   return Point3{p.x, 2 * middle.y - p.y, p.z};
                 }});
  out.push_back({"scan-mirrored", "its x and y are swapped; swap them", [](Point3 p) {
                   return Point3{p.y, p.x, p.z};
                 }});
  return out;
}

/// The area that two boxes share, of that of both.
auto overlap(const geometry::Box2& a, const geometry::Box2& b) -> double {
  const auto area = [](double x, double y) { return x > 0 && y > 0 ? x * y : 0; };
  const double shared = area(std::min(a.most.x, b.most.x) - std::max(a.least.x, b.least.x),
                             std::min(a.most.y, b.most.y) - std::max(a.least.y, b.least.y));
  const double both =
      area(a.most.x - a.least.x, a.most.y - a.least.y) + area(b.most.x - b.least.x, b.most.y - b.least.y) - shared;
  return both > 0 ? shared / both : 0;
}

}  // namespace

auto other_place(const model::Scene& scene, const Options& options, const base::Run& run)
    -> std::optional<base::Diagnostic> {
  std::vector<Polygon> outlines;
  for (const auto& footprint : scene.footprints)
    outlines.insert(outlines.end(), footprint.polygons.begin(), footprint.polygons.end());
  if (outlines.empty() || scene.mesh.triangles.empty()) return std::nullopt;
  // What fits as it is, is in its place: its buildings are low, or gone.
  const auto here = align::match_at(scene.mesh, outlines, 0, 0);
  if (here && fits(*here)) return std::nullopt;
  const auto along = [&](std::size_t axis) {
    return static_cast<double>(scene.frame.origin[axis]) - options.ingest.mesh_offset[axis];
  };
  const Point3 shift{along(0), along(1), along(2)};
  const auto box = geometry::Box3::of(scene.mesh.vertices);
  // Of a few footprints some fit anything: two standard deviations of the correlation of as many that do not belong
  // together (1 / √n), and what half of them that are gone still leave of one that does; or all of them are high.
  constexpr double nearly_all = 0.9;
  const double least = std::min(0.6, 2 / std::sqrt(static_cast<double>(outlines.size())));
  geometry::Box2 around;
  for (const auto& outline : outlines) around.include(geometry::bounds(outline.outer));
  const double overlap_here = overlap(geometry::Box2::of(scene.mesh.vertices), around);
  const Candidate* best = nullptr;
  std::optional<align::Match> found;
  const auto candidates = candidates_of(scene, options, 0.5 * (box.least + box.most) + shift);
  for (const auto& candidate : candidates) {
    if (run.cancelled()) return std::nullopt;
    geometry::Mesh changed = scene.mesh;
    changed.points.clear();
    for (auto& v : changed.vertices) v = candidate.change(v + shift) - shift;
    // Millimetres of height would be kilometres of plan: no relief is made of these.
    constexpr double largest = 5000;  // m
    const auto plan = geometry::Box2::of(changed.vertices);
    if (plan.most.x - plan.least.x > largest || plan.most.y - plan.least.y > largest) continue;
    // In the right unit it is as large as the footprints' surroundings, and no less so than before.
    if (candidate.code == "scan-units" && overlap(plan, around) < overlap_here) continue;
    const auto match = align::match_at(changed, outlines, 0, 0);
    if (!match || !fits(*match) || (match->correlation < least && match->inside < nearly_all)) continue;
    if (found && match->correlation <= found->correlation) continue;
    found = match;
    best = &candidate;
  }
  const auto evidence = [](const align::Match& match) {
    return ": then " + base::to_text(100 * match.inside, 0) +
           " % of the footprints' area is higher than the ground (correlation " + base::to_text(match.correlation, 2) +
           ")";
  };
  if (best != nullptr)
    return base::error(best->code, "the scan does not fit the footprints: " + best->words + evidence(*found));
  const auto moved = align::best_match(scene.mesh, outlines, {}, run);
  if (!moved || !fits(*moved) || moved->correlation < least_lead * moved->next) return std::nullopt;
  Placing placing{{}, {}, options.ingest.mesh_offset, *moved, scene.frame.crs};
  placing.offset[0] += moved->x;
  placing.offset[1] += moved->y;
  return base::error("scan-place", "the scan does not fit the footprints: it is beside them; give " +
                                       options_in_words(placing, options) + evidence(*moved));
}

}  // namespace mansard::pipeline::detail
