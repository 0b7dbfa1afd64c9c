#include "mansard/pipeline/placing.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/base/text.hpp"
#include "mansard/block/block.hpp"
#include "mansard/crs/candidates.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/ingest/model.hpp"
#include "mansard/pipeline/scan_checks.hpp"

namespace mansard::pipeline {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Polygon;

/// Of a place in few systems a mesh can tell which one is meant; the others look the same but for centimetres.
constexpr std::size_t most_candidates = 12;
/// Two systems that match this closely are the same for footprints of a metre's accuracy.
constexpr double tie = 0.02;

/// In the file's coordinates.
auto outlines_of(const model::Scene& scene) -> std::vector<Polygon> {
  const Point2 origin{static_cast<double>(scene.frame.origin[0]), static_cast<double>(scene.frame.origin[1])};
  std::vector<Polygon> all;
  for (const auto& footprint : scene.footprints)
    for (auto polygon : footprint.polygons) {
      if (footprint.defect) continue;
      geometry::move(polygon, origin);
      all.push_back(std::move(polygon));
    }
  return all;
}

auto in_another_crs(const InputPaths& paths, const Options& options, const geometry::Mesh& mesh, const Box2& box,
                    const model::Scene& footprints, const Box2& outlines, const base::Run& run)
    -> std::optional<Placing> {
  // The footprints' centre lies in the mesh or beside it by no more than its size.
  const double reach = std::max(box.most.x - box.least.x, box.most.y - box.least.y);
  const Point2 centre = 0.5 * (outlines.least + outlines.most);
  auto candidates = crs::candidates(footprints.frame.crs, centre, box.grown(reach));
  candidates.resize(std::min(candidates.size(), most_candidates));
  std::optional<Placing> best;
  for (const auto& candidate : candidates) {
    if (run.cancelled()) return std::nullopt;
    auto other = options.ingest;
    other.crs = candidate.name;
    const auto scene = ingest::read_footprints(paths.footprints, other, run);
    if (!scene) continue;
    const auto match = align::match_at(mesh, outlines_of(*scene), 0, 0);
    if (!match || !fits(*match)) continue;
    if (!best || match->correlation > best->match.correlation + tie)
      best = Placing{candidate.name, candidate.title, options.ingest.mesh_offset, *match, footprints.frame.crs};
  }
  return best;
}

}  // namespace

auto fits(const align::Match& match) -> bool {
  return match.correlation >= least_correlation && match.met >= least_met;
}

auto offset_in_words(const std::array<double, 3>& offset) -> std::string {
  std::string words = "--mesh-offset";
  for (const double value : offset) words += " " + base::to_text(value);
  return words;
}

auto options_in_words(const Placing& placing, const Options& options) -> std::string {
  std::string words;
  if (!placing.crs.empty()) words = "--crs " + placing.crs;
  if (placing.offset != options.ingest.mesh_offset)
    words += (words.empty() ? "" : " ") + offset_in_words(placing.offset);
  return words;
}

auto reason_in_words(const Placing& placing) -> std::string {
  const auto share = [](double value) { return base::to_text(100 * value, 0) + " %"; };
  return share(placing.match.inside) + " of the footprints' area is higher than the ground in the mesh (" +
         (placing.title.empty() ? "" : placing.crs + " is " + placing.title + "; ") + "correlation " +
         base::to_text(placing.match.correlation, 2) +
         (placing.match.next > 0 ? ", elsewhere up to " + base::to_text(placing.match.next, 2) : "") + ")";
}

auto find_placing(const InputPaths& paths, const Options& options, const base::Run& run)
    -> base::Result<std::optional<Placing>> {
  auto wide = options;
  wide.ingest.bbox = {};
  const auto footprints = ingest::read_footprints(paths.footprints, wide.ingest, run);
  if (!footprints) return footprints.failure();
  model::Frame frame;
  frame.crs = footprints->frame.crs;
  const auto read = ingest::read_mesh(paths.meshes, frame, wide.ingest, run);
  if (!read) return read.failure();
  const auto& mesh = read->mesh;
  const auto polygons = outlines_of(*footprints);
  std::optional<Placing> none;
  if (mesh.triangles.empty() || polygons.empty()) return none;
  Box2 box;
  for (const auto& p : mesh.vertices) box.add({p.x, p.y});
  const Box2 outlines = geometry::bounds(polygons);
  if (box.overlaps(outlines))
    if (const auto match = align::match_at(mesh, polygons, 0, 0); match && fits(*match))
      return std::optional(Placing{{}, {}, options.ingest.mesh_offset, *match, frame.crs});
  if (!frame.crs.empty())
    if (auto found = in_another_crs(paths, wide, mesh, box, *footprints, outlines, run)) return found;
  const auto match = align::best_match(mesh, polygons, {}, run);
  if (run.cancelled()) return base::error("cancelled", "stopped on request");
  if (!match || !fits(*match) || match->correlation < least_lead * match->next) return none;
  Placing placing{{}, {}, options.ingest.mesh_offset, *match, frame.crs};
  placing.offset[0] += match->x;
  placing.offset[1] += match->y;
  return std::optional(placing);
}

auto accuracy_of_scan(const InputPaths& paths, const Options& options, const base::Run& run, std::size_t most_blocks)
    -> base::Result<MeasuredScan> {
  const auto scene = read_inputs(paths, options, run);
  if (!scene) return scene.failure();
  const block::Partition blocks(*scene, options.block, run);
  const std::size_t every = std::max<std::size_t>(1, (blocks.size() + most_blocks - 1) / most_blocks);
  std::vector<model::Accuracy> all;
  for (std::size_t i = 0; i < blocks.size() && !run.cancelled(); i += every) {
    const auto own = block::in_own_frame(blocks.make(i));
    all.push_back(accuracy::measure(own.block.mesh, rays::Scene(own.block.mesh), own.block.outline, options.accuracy));
  }
  MeasuredScan out{accuracy::combined(all), {}};
  for (const auto& warning : scene->warnings)
    if (warning.code.starts_with("scan-")) out.findings.push_back(warning);
  return out;
}

auto align_scan(const InputPaths& paths, const Options& options, const base::Run& run)
    -> base::Result<std::optional<std::array<double, 3>>> {
  auto unchecked = options;
  unchecked.scan_checks = ScanChecks::off;
  const auto city = read_city_inputs(paths, unchecked, run);
  if (!city) return city.failure();
  const auto checked = check_scan(city->scene, city->cells.get(), options, run);
  if (!checked) return checked.failure();
  if (!checked->registration) return std::optional<std::array<double, 3>>();
  return aligned_offset(*checked->registration, options.ingest.mesh_offset);
}

}  // namespace mansard::pipeline
