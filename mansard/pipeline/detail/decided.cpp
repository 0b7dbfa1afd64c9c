#include "mansard/pipeline/detail/decided.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/refine/law.hpp"
#include "mansard/sweep/law.hpp"

namespace mansard::pipeline::detail {
namespace {

/// Twice the smallest detail and noise: prices are their squares (docs/decisions/0047-moderate-detail.md).
constexpr double fewer_details = 4;

/// m: how far a wall in the scan is from its footprint for the scan's sake, or the survey's. Lines that are nearer to
/// each other are one; where all walls are exactly on the footprints, none of their corners may move.
auto snap_of(const fracture::Options& options, const model::Accuracy& scan) -> double {
  constexpr double least = 0.002;  // m: twice what footprints are rounded to in most files
  if (scan.edges == 0) return options.snap;
  return std::min(options.snap, std::max({least, scan.edge_noise, scan.offset_spread}));
}

/// A request for simpler profiles is not answered with finer ones by the refinement.
auto refining_of(const Options& options, const model::Accuracy& scan) -> refine::Options {
  refine::Options out = refine::decided_by(options.refine, scan);
  out.forms.cap_percentile = options.profile.cap_ridge;
  out.forms.cap_clearance = options.profile.cap_clear;
  out.samples.level_band = options.profile.cap_level;
  if (options.profile.quality == profile::Quality::simple) out.effort = refine::Effort::caps;
  if (options.profile.quality == profile::Quality::moderate)
    for (double* price : {&out.face_price, &out.part_price, &out.value_price}) *price *= fewer_details;
  return out;
}

}  // namespace

auto decided_by(Options o, const model::Accuracy& scan) -> Options {
  o.sweep = sweep::decided_by(o.sweep, scan);
  o.fracture.snap = snap_of(o.fracture, scan);
  // As near to a boundary, a sample may be of either side of the wall there. Without noise a mesh's own edges are those
  // of the surface, however large its triangles are.
  o.sweep.roof_height = o.segment.min_height;  // what is no building has no roof
  o.segment.by_points = scan.point_area > 0;
  if (o.segment.by_points) o.segment.rim = scan.spacing / 2;  // a wall is anywhere between two points
  else o.segment.rim = scan.edge() + scan.spacing / 2 * std::min(1.0, scan.noise / o.refine.detail);
  // What no part of the mesh shows is as high as a footprint that it does not cover.
  if (o.assumed_height > 0) o.profile.assumed_height = o.assumed_height;
  o.refine = refining_of(o, scan);
  return o;
}

}  // namespace mansard::pipeline::detail
