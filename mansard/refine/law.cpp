#include "mansard/refine/law.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::refine {
namespace {

/// What is said of a roof, in numbers. A face is a plane: the two numbers of its profile, and where it begins. A part
/// is an outline of its own: a position and a direction of four sides, where both ends of each begin, and which of its
/// sides carry roof.
constexpr double numbers_of_face = 3, numbers_of_part = 20;

/// m²: a structure that every scan shows, such as a lift house; what is of interest is a step of `detail` on it.
constexpr double structure = 4;
/// Samples for each number of a structure. A fit with as many has an error of 0.6 of a sample's.
constexpr double samples_of_number = 3;

/// m²: the ground that one number is fitted to, for n = F / A in ½ ln n: a roof plane of a house. It counts by its
/// logarithm.
constexpr double roof_plane = 40;

/// The share of the smallest detail that one number of it pays: a box is some forty-five numbers, an outline and eight
/// faces; so much is left where the roof around it explains two thirds of the detail.
constexpr double number_of_detail = 1.0 / 14;

/// Beyond 0.4 m from an outline and 0.5 m from a crease too little is left of narrow roofs, however much a scan rounds.
constexpr double most_margin = 0.4, most_melt = 0.5;
/// Standard deviations: 99 % of what is smoothed is nearer to its edge.
constexpr double reach = 2.5;
/// Blurs: what rounds the edges of a plane moves all of it, up or down, and no number of samples takes that off. Block
/// A's mesh tells heights of roofs apart from a tenth of its blur on (decision 169).
constexpr double bias_of_blur = 0.15;
/// m: kernels of five cells of 0.25 m and of solids that were smoothed by more, whose tall steps are no wider.
constexpr double most_blur = 0.25;

/// Nominal spacings: a wall is anywhere between two points, and points on it are seen so far from it.
constexpr double between_points = 0.5;
/// Smallest details: a point that is farther from a roof is of something else.
constexpr double stray = 10;

/// Weights of a sample within the margin of an outline. What is rounded is explained in part, by the same smoothing of
/// the roof; where an edge was sampled beside its place, the difference is the height of the wall and says nothing.
constexpr double weight_of_rounded = 0.2, weight_of_rough = 0.05;

/// Standard deviations of the noise: over as much as that, spread about their middle, twelve samples show a slope to
/// one in twenty. And m: of three rows of samples half a metre wide, and what suffices in every scan.
constexpr double spread_of_slope = 6, least_spread = 0.1, most_spread = 0.25;

/// m: what is left between lines and samples without noise: coordinates have single precision in many files.
constexpr double least_robust = 0.02;

/// Melts: a structure is wider than what is rounded along its two walls, a line across a part leaves a clear strip of
/// half a melt between two that are not, and a step is where its own rounding ends. Those of a photogrammetric mesh
/// with a melt of 0.5 m (0.8 m, 1.25 m, 0.7 m) were chosen by hand.
constexpr double width_of_part = 1.6, width_of_side = 2.5, depth_of_step = 1.4;
/// m: a strip of one sample is none.
constexpr double least_strip = 0.3;
/// Smallest details, standard deviations of the noise, and m: a step is a half larger than what is of interest and
/// stands clear of the noise on both sides; half a metre is a step in every scan.
constexpr double wanted_step = 1.5, seen_step = 10, most_step = 0.5;
/// Standard deviations, and m: samples so near to a steep face lie on it.
constexpr double on_face = 1.5, most_on_face = 0.15;

}  // namespace

auto decided_by(Options o, const model::Accuracy& scan) -> Options {
  const double independent = std::max(2.0, roof_plane / scan.correlated_area);
  const double by_noise = o.significance * scan.chance() * std::log(independent);
  const double by_detail = number_of_detail * o.detail * o.detail * structure;
  const double number = std::max(by_noise, by_detail);
  o.value_price = number;
  o.face_price = numbers_of_face * number;
  o.part_price = numbers_of_part * number;
  o.dormers.price = o.dormers.wanted ? o.face_price / 2 : 0;  // a box of a given form: its walls are no new planes
  // A three-hundredth of a face. A mesh moved by δ changes a cost by at most Σ 2·|d|·δ·area over its samples: 1e-4 for
  // a micrometre, mean differences of 0.5 m and 100 m², and less where a scan is so accurate that a face costs less.
  o.same_cost = std::min(1e-3, o.face_price / 300);

  // A point is where it was measured: only the surface that is drawn between points rounds anything.
  o.samples.point_area = scan.point_area;
  o.samples.noise = scan.noise;
  o.samples.stray = stray * o.detail;
  const bool points = scan.point_area > 0;
  const double blur = points ? 0 : scan.blur * scan.blur, rough = points ? 0 : scan.edge_noise * scan.edge_noise,
               edge = std::sqrt(blur + rough);
  o.margin = std::min(most_margin, reach * edge);
  if (points)
    o.margin = std::min(most_margin, std::hypot(reach * scan.noise, between_points * std::sqrt(scan.point_area)));
  o.samples.margin_weight =
      blur + rough > 0 ? (weight_of_rounded * blur + weight_of_rough * rough) / (blur + rough) : weight_of_rough;
  o.samples.melt = std::clamp(reach * edge, o.grid / 2, most_melt);  // a sample is of all of its cell
  o.samples.blur = std::min(most_blur, edge);
  o.alike.bias = points ? 0 : bias_of_blur * scan.blur;
  o.lines.robust = std::max(least_robust, reach * scan.noise);
  o.lines.min_spread = std::clamp(spread_of_slope * scan.noise, least_spread, most_spread);

  // What is smaller than the scan can show is neither proposed nor made. An edge between two points is known to a
  // twelfth of their squared distance; where a surface has its edges was measured.
  const double between = points ? scan.spacing * std::min(1.0, scan.noise / o.detail) : 0;
  const double shown = std::clamp(reach * std::sqrt(edge * edge + between * between / 12), o.grid / 2, most_melt);
  o.cuts.min_width = std::max(least_strip, width_of_part * shown);
  o.cuts.line_min_width = std::max(least_strip, width_of_side * shown);
  o.bends.min_depth = depth_of_step * shown;  // its height is that of a plane, and no strip of its own
  o.mansard.min_depth = std::max(least_strip, o.bends.min_depth);
  o.cuts.min_step = std::max(wanted_step * o.detail, std::min(most_step, seen_step * scan.noise));
  o.bare.noise = std::clamp(on_face * scan.noise, least_robust, most_on_face);
  // A structure is shown where there are some samples for each of its numbers, and where it is wider than its edges.
  const double side = width_of_side * o.cuts.min_width;
  const double shown_area = std::max(samples_of_number * numbers_of_part * scan.point_area, side * side);
  o.cuts.min_area = std::max(o.least_area, std::min(structure, shown_area));
  return o;
}

}  // namespace mansard::refine
