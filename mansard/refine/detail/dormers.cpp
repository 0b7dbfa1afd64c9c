#include "mansard/refine/detail/dormers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/forms.hpp"
#include "mansard/refine/detail/normal_curve.hpp"
#include "mansard/refine/detail/order.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using model::Plan;
using model::Profile;

constexpr double not_seen = std::numeric_limits<double>::quiet_NaN();

/// A slope of the roof: height = gutter + slope · inward of its edge, above the base.
struct Slope {
  std::uint32_t face = 0, ring = 0, edge = 0;
  Point2 start, along, inward;
  double gutter = 0, slope = 0;
  Profile profile;  // of its edge, and the slope's place in it
  std::uint32_t part = 0;
  [[nodiscard]] auto at(double v) const -> double { return gutter + slope * v; }
  [[nodiscard]] auto u_of(Point2 p) const -> double { return dot(p - start, along); }
  [[nodiscard]] auto v_of(Point2 p) const -> double { return dot(p - start, inward); }
  [[nodiscard]] auto place(double u, double v) const -> Point2 { return start + u * along + v * inward; }
};

auto slopes_of(const Judged& judged, const Options::Dormers& options) -> std::vector<Slope> {
  std::vector<Slope> out;
  for (std::uint32_t f = 0; f < judged.sketch.faces.size(); ++f) {
    const auto& face = judged.sketch.faces[f];
    if (face.kind != model::FaceKind::side || !face.provenance) continue;
    const auto [ring, edge, part] = *face.provenance;
    const auto& of = ring == 0 ? judged.plan.outer : judged.plan.holes[ring - 1];
    const auto& profile = judged.plan.profiles[of.profile_of_edge[edge]];
    if (part + 1 >= profile.size()) continue;
    const auto &a = profile[part], &b = profile[part + 1];
    if (b.inward <= a.inward) continue;
    const double slope = (b.height - a.height) / (b.inward - a.inward);
    if (slope < options.min_slope || slope > options.max_slope) continue;
    const Point2 start = of.points[edge], end = of.points[(edge + 1) % of.points.size()];
    const Point2 along = geometry::normalised(end - start);
    out.push_back(
        {f, ring, edge, start, along, geometry::left_of(along), a.height - slope * a.inward, slope, profile, part});
  }
  return out;
}

/// A sample near to a dormer, in the slope's directions.
struct Sample {
  double u = 0, v = 0, z = 0;  // m; z above the base
};

struct Box {
  double left = 0, right = 0, front = 0;  // m along the edge, and inward of it
  double eaves = 0;                       // m above the base
  double pitch = 0;                       // rise per run of its own roof, towards the middle
  [[nodiscard]] auto width() const -> double { return right - left; }
  [[nodiscard]] auto back(const Slope& slope) const -> double { return (eaves - slope.gutter) / slope.slope; }
  [[nodiscard]] auto own(double u) const -> double {
    return eaves + pitch * (width() / 2 - std::abs(u - (left + right) / 2));
  }
  [[nodiscard]] auto height(const Slope& slope, double u, double v) const -> double {
    const double below = slope.at(v);
    if (u < left || u > right || v < front || v > back(slope)) return below;
    return std::max(below, own(u));
  }
};

/// m: the standard deviation of what a scan smooths, of which `melt` is the reach.
auto blur_of(const Options& options) -> double { return std::max(0.05, std::numbers::sqrt2 * options.samples.blur); }

/// What a scan shows of a box above its slope, m: the box smoothed by a normal curve.
class Shown {
 public:
  Shown(const Box& box, const Slope& slope, double blur) : box_(box), slope_(slope), inverse_(1 / blur), blur_(blur) {
    // A gable as strips of one height, the same on both sides of the ridge: a quarter of a narrow one is less than what
    // a scan smooths.
    strips_ = box.pitch > 0 ? most_strips : 1;
    wide_ = box.width() / strips_;
    for (int k = 0; k < (strips_ + 1) / 2; ++k) {
      heights_[k] = box.pitch > 0 ? box_.own(box_.left + (k + 0.5) * wide_) : box_.eaves;
      ends_[k] = (heights_[k] - slope_.gutter) / slope_.slope;
    }
  }
  /// Of a box of one height, what of a sample depends on its left and right side, its front, and its back.
  struct Sides {
    double left = 0, right = 0, below = 0, density = 0, below_back = 0, density_back = 0;
  };
  /// Those of which the box is another than `other`, or all.
  void update(Sides& sides, double u, double v, const Box* other) const {
    if (!other || other->left != box_.left) sides.left = normal_curve.below((box_.left - u) * inverse_);
    if (!other || other->right != box_.right) sides.right = normal_curve.below((box_.right - u) * inverse_);
    if (!other || other->front != box_.front) {
      const double from = (box_.front - v) * inverse_;
      sides.below = normal_curve.below(from), sides.density = normal_curve.density(from);
    }
    if (!other || other->eaves != box_.eaves) {
      const double to = (ends_[0] - v) * inverse_;
      sides.below_back = normal_curve.below(to), sides.density_back = normal_curve.density(to);
    }
  }
  [[nodiscard]] auto operator()(const Sides& sides, double v) const -> double {
    const double share = sides.right - sides.left;
    if (share <= least_share || ends_[0] <= box_.front) return 0;
    return share * above_slope(v, 0, sides.below_back - sides.below, sides.density - sides.density_back);
  }
  [[nodiscard]] auto operator()(double u, double v) const -> double {
    const double first = normal_curve.below((box_.left - u) * inverse_),
                 last = normal_curve.below((box_.right - u) * inverse_);
    if (last - first <= least_share) return 0;
    const double from = (box_.front - v) * inverse_;
    const double below = normal_curve.below(from), density = normal_curve.density(from);
    if (strips_ == 1) return (last - first) * ramp(v, 0, below, density);
    double sum = 0, left = first, right = last;
    for (int k = 0; k < strips_ / 2; ++k) {
      const double next = normal_curve.below((box_.left + (k + 1) * wide_ - u) * inverse_);
      const double before =
          k + 1 < strips_ / 2 ? normal_curve.below((box_.right - (k + 1) * wide_ - u) * inverse_) : next;
      const double share = next - left + right - before;
      if (share > least_share) sum += share * ramp(v, k, below, density);
      left = next, right = before;
    }
    return sum;
  }

 private:
  /// The part of a level roof that is above the slope, from the front to where they meet.
  [[nodiscard]] auto ramp(double v, int k, double below, double density) const -> double {
    if (ends_[k] <= box_.front) return 0;
    const double to = (ends_[k] - v) * inverse_;
    return above_slope(v, k, normal_curve.below(to) - below, density - normal_curve.density(to));
  }
  [[nodiscard]] auto above_slope(double v, int k, double share, double density) const -> double {
    return (heights_[k] - slope_.at(v)) * share - slope_.slope * blur_ * density;
  }

  static constexpr int most_strips = 8;
  static constexpr double least_share = 1e-4;
  const Box& box_;
  const Slope& slope_;
  double inverse_, blur_;
  int strips_ = 1;
  double wide_ = 0;
  std::array<double, most_strips / 2> heights_{}, ends_{};
};

/// The squared error that is left when the slope, too, may be raised and tilted a little: what it was fitted to was in
/// part the dormer.
template <class AboveSlope>
auto error_left(const std::vector<Sample>& samples, const Slope& slope, AboveSlope shown) -> double {
  double n = 0, sv = 0, svv = 0, sd = 0, svd = 0, sdd = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& s = samples[i];
    const double d = s.z - slope.at(s.v) - shown(i);
    ++n, sv += s.v, svv += s.v * s.v, sd += d, svd += s.v * d, sdd += d * d;
  }
  const double determinant = n * svv - sv * sv;
  if (!(n > 0) || !(determinant > 1e-9 * n * svv)) return sdd;
  const double raised = (svv * sd - sv * svd) / determinant, tilted = (n * svd - sv * sd) / determinant;
  return std::max(0.0, sdd - raised * sd - tilted * svd);
}

auto error_of(const std::vector<Sample>& samples, const Slope& slope, const Box* box, double blur) -> double {
  if (!box) return error_left(samples, slope, [](std::size_t) { return 0.0; });
  const Shown shown(*box, slope, blur);
  return error_left(samples, slope, [&](std::size_t i) { return shown(samples[i].u, samples[i].v); });
}

/// The same of boxes that differ from one in a side or two: what is shown of the others is kept.
class Errors {
 public:
  Errors(const Box& box, const std::vector<Sample>& samples, const Slope& slope, double blur)
      : samples_(samples), slope_(slope), blur_(blur), kept_(samples.size()), tried_(samples.size()) {
    error_ = error_for(box, nullptr);
    keep(box);
  }
  [[nodiscard]] auto error() const -> double { return error_; }

  /// Of a box; kept where it is less than that.
  auto is_less(const Box& box, double than) -> bool {
    const double error = error_for(box, &box_);
    if (!(error < than)) return false;
    error_ = error;
    keep(box);
    return true;
  }

 private:
  auto error_for(const Box& box, const Box* kept) -> double {
    if (box.pitch > 0) return error_of(samples_, slope_, &box, blur_);
    const Shown shown(box, slope_, blur_);
    return error_left(samples_, slope_, [&](std::size_t i) {
      tried_[i] = kept_[i];
      shown.update(tried_[i], samples_[i].u, samples_[i].v, kept);
      return shown(tried_[i], samples_[i].v);
    });
  }
  void keep(const Box& box) {
    box_ = box;
    std::swap(kept_, tried_);
  }

  const std::vector<Sample>& samples_;
  const Slope& slope_;
  double blur_;
  Box box_;
  double error_ = 0;
  std::vector<Shown::Sides> kept_, tried_;  // per sample: of the box, and of the one that was tried last
};

/// Walls and eaves moved until that no longer helps, by less and less.
auto fitted_box(Box box, const std::vector<Sample>& samples, const Slope& slope, double blur, double reach, double same)
    -> Box {
  Box least = box, most = box;
  reach += same_length;  // steps that add up to the reach are within it, however they are rounded
  least.left -= reach, least.front -= reach, most.right += reach, most.eaves += reach;
  Errors errors(box, samples, slope, blur);
  for (const double step : {0.4, 0.2, 0.1, 0.05}) {
    for (int round = 0; round < 12; ++round) {
      bool moved = false;
      // left, right, front, eaves; all of it along the edge, and up the slope
      const double ways[6][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0},
                                 {0, 0, 0, 1}, {1, 1, 0, 0}, {0, 0, 1, slope.slope}};
      for (const auto& way : ways)
        for (const double by : {-step, step}) {
          Box other = box;
          other.left += by * way[0], other.right += by * way[1], other.front += by * way[2];
          other.eaves += by * way[3];
          if (!(other.width() > 0.4) || !(other.back(slope) > other.front)) continue;
          if (other.left < least.left || other.right > most.right || other.front < least.front) continue;
          if (other.eaves > most.eaves) continue;
          if (errors.is_less(other, errors.error() - same)) box = other, moved = true;
        }
      if (!moved) break;
    }
  }
  return box;
}

/// Connected cells of a slope that stand out of it.
auto islands(const Judged& judged, const Site& site, const Slope& slope, double above)
    -> std::vector<std::vector<std::uint32_t>> {
  const auto& grid = site.measured;
  std::vector<std::uint8_t> out_of_it(grid.z.size(), 0);
  for (std::size_t cell = 0; cell < grid.z.size(); ++cell)
    if (!std::isnan(judged.view.z[cell]) && judged.view.face[cell] == slope.face &&
        grid.z[cell] - judged.view.z[cell] > above)
      out_of_it[cell] = 1;
  std::vector<std::vector<std::uint32_t>> found;
  for (std::uint32_t cell = 0; cell < grid.z.size(); ++cell) {
    if (!out_of_it[cell]) continue;
    std::vector<std::uint32_t> island{cell};
    out_of_it[cell] = 0;
    for (std::size_t i = 0; i < island.size(); ++i) {
      const auto at = island[i];
      const auto column = at % grid.columns;
      const auto visit = [&](bool there, std::size_t next) {
        if (!there || !out_of_it[next]) return;
        out_of_it[next] = 0;
        island.push_back(static_cast<std::uint32_t>(next));
      };
      visit(column > 0, at - 1);
      visit(column + 1 < grid.columns, at + 1);
      visit(at >= grid.columns, at - grid.columns);
      visit(at + grid.columns < grid.z.size(), at + grid.columns);
    }
    found.push_back(std::move(island));
  }
  return found;
}

/// Whether the box lies on the slope with all of its plan.
auto on_slope(const Box& box, const Slope& slope, const Judged& judged, const Site& site) -> bool {
  const auto& grid = site.measured;
  const double step = grid.spacing / 2;
  for (double u = box.left - step; u <= box.right + step + step / 2; u += step)
    for (double v = box.front - step; v <= box.back(slope) + step + step / 2; v += step) {
      const Point2 p = slope.place(u, v);
      const double column = std::round((p.x - grid.origin.x) / grid.spacing);
      const double row = std::round((p.y - grid.origin.y) / grid.spacing);
      if (column < 0 || row < 0 || column >= static_cast<double>(grid.columns) || row >= static_cast<double>(grid.rows))
        return false;
      const auto cell = static_cast<std::size_t>(row) * grid.columns + static_cast<std::size_t>(column);
      if (std::isnan(judged.view.z[cell]) || judged.view.face[cell] != slope.face) return false;
    }
  return true;
}

/// The same, where necessary with a front, sides and a back that are moved inwards by what a displaced outline makes of
/// it. None where that is not enough.
auto moved_onto(Box box, const Slope& slope, const Judged& judged, const Site& site, double most)
    -> std::optional<Box> {
  const double step = site.measured.spacing / 4;
  for (double by = 0; by <= most; by += step) {
    for (const auto& [left, right, top] :
         {std::array{0.0, 0.0, 0.0}, std::array{by, 0.0, 0.0}, std::array{0.0, by, 0.0}, std::array{0.0, 0.0, by}}) {
      for (const double front : {0.0, by}) {
        Box other = box;
        other.left += left, other.right -= right, other.eaves -= top * slope.slope, other.front += front;
        if (on_slope(other, slope, judged, site)) return other;
      }
    }
  }
  return std::nullopt;
}

/// What the roof does from a place on the slope on: the rest of its profile. A slope that ends at no knot keeps its run
/// and rise, which a kernel rounds to the same plane as beside the dormer.
auto from_there(const Slope& slope, double inward) -> Profile {
  const auto& of = slope.profile;
  const auto &a = of[slope.part], &b = of[slope.part + 1];
  const double height = slope.at(inward);
  Profile out{{0, 0}, {0, height}};
  if (slope.part + 2 == of.size()) {
    out.push_back({b.inward - a.inward, height + b.height - a.height});
    return out;
  }
  for (std::size_t i = slope.part + 1; i < of.size(); ++i)
    if (of[i].inward > inward) out.push_back({of[i].inward - inward, of[i].height});
  return out;
}

auto built(const Box& box, const Slope& slope, double base, double gain, const Options& options) -> Dormer {
  const double back = box.back(slope);
  Dormer out;
  out.ring = slope.ring;
  out.edge = slope.edge;
  out.gain = gain;
  out.eaves = box.eaves;
  out.pitch = box.pitch;
  out.back = from_there(slope, back);
  out.plan.outer.points = {slope.place(box.left, box.front), slope.place(box.right, box.front),
                           slope.place(box.right, back), slope.place(box.left, back)};
  out.plan.base = base;
  const double top = box.own((box.left + box.right) / 2);
  if (box.pitch > 0) {
    out.plan.outer.profile_of_edge = {0, 1, 2, 3};
    out.plan.profiles = {wall(box.eaves, options.forms), pitched(box.eaves, box.pitch), wall(box.eaves, options.forms),
                         pitched(box.eaves, box.pitch)};
    out.plan.cap = top + 1;
  } else {
    out.plan.outer.profile_of_edge = {0, 0, 0, 0};
    out.plan.profiles = {wall(box.eaves, options.forms)};
    out.plan.cap = box.eaves;
  }
  return out;
}

auto best_box(const std::vector<std::uint32_t>& island, const Slope& slope, const Judged& judged, const Site& site,
              double above, Where where, const Options& options) -> std::optional<Dormer> {
  const auto& o = options.dormers;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box start{infinity, -infinity, infinity, 0, 0};
  double last = -infinity;
  std::vector<double> heights;
  for (const auto cell : island) {
    const Point2 p = site.measured.centre(cell);
    start.left = std::min(start.left, slope.u_of(p)), start.right = std::max(start.right, slope.u_of(p));
    start.front = std::min(start.front, slope.v_of(p)), last = std::max(last, slope.v_of(p));
    heights.push_back(site.measured.z[cell]);
  }
  if (start.width() > o.max_width || last - start.front > o.max_width) return std::nullopt;
  const double reach = 2 * std::max(0.5, options.samples.melt);  // m: what the slope beside it is taken from
  std::vector<std::uint32_t> own(island);
  std::ranges::sort(own);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const auto cell = site.cells[i];
    const double roof = judged.view.z_of(site, i);
    if (std::isnan(roof) || judged.view.face_of(site, i) != slope.face) continue;
    if (site.weight[i] < 1) continue;             // a melted wall
    const bool other = site.z[i] - roof > above;  // of another dormer
    if (other && !std::ranges::binary_search(own, cell)) continue;
    const Point2 p = site.places[i];
    const Sample s{slope.u_of(p), slope.v_of(p), site.z[i]};
    if (s.u > start.left - reach && s.u < start.right + reach && s.v > start.front - reach && s.v < last + reach)
      samples.push_back(s);
  }
  constexpr double walls_move = 0.5;  // m: two samples
  const double all = error_of(samples, slope, nullptr, 0);
  if (all * site.sample_area < o.price) return std::nullopt;  // no box saves more than there is
  start.front -= site.measured.spacing;                       // a scan's front leans back
  start.eaves = base::percentile(std::move(heights), 0.8);
  start.eaves = std::max(start.eaves, slope.at(start.front) + o.min_rise);
  // Scans of the same grid are smoothed by unlike lengths.
  double blur = 0, least_rough = infinity;
  Box rough = start;
  for (const double may_be : {site.measured.spacing / 2, blur_of(options)}) {
    const Box box = fitted_box(start, samples, slope, may_be, walls_move, options.same_cost);
    if (const double error = error_of(samples, slope, &box, may_be); error < least_rough)
      rough = box, blur = may_be, least_rough = error;
  }
  // What is left out below is seldom most of it.
  constexpr double hopeless = 0.75;
  if (least_rough > hopeless * all) return std::nullopt;
  // What stands out of both, a chimney beside it, belongs to neither, if it is little.
  const Shown shown(rough, slope, blur);
  std::vector<Sample> clean;
  for (const auto& s : samples)
    if (std::abs(s.z - slope.at(s.v) - shown(s.u, s.v)) < walls_move) clean.push_back(s);
  constexpr double most_of_it = 0.75;
  if (static_cast<double>(clean.size()) >= most_of_it * static_cast<double>(samples.size())) samples = std::move(clean);
  const double before = error_of(samples, slope, nullptr, blur);
  start = rough;
  std::optional<Box> best;
  double least = infinity;
  for (const double pitch : {0.0, 0.7}) {  // level; a gable, whose pitch a scan of this size does not show
    // Where a roof is looked for beside it, it is enough to know that there is one.
    if (where == Where::anywhere && least <= o.max_rest * before) break;
    Box box = best ? *best : start;
    box.pitch = pitch;
    if (best) box.eaves -= pitch * box.width() / 4;
    box = fitted_box(box, samples, slope, blur, walls_move / 2, options.same_cost);
    const double error = error_of(samples, slope, &box, blur);
    if (error < o.gable_gain * least) best = box, least = error;
  }
  const double gain = (before - least) * site.cell_area, rise = best->eaves - slope.at(best->front);
  const auto placed = where == Where::anywhere ? best : moved_onto(*best, slope, judged, site, walls_move);
  if (best->width() < o.min_width || rise < o.min_rise || rise > o.max_rise || least > o.max_rest * before ||
      gain < o.price || !placed || placed->width() < o.min_width / 2 ||
      placed->eaves - slope.at(placed->front) < o.min_rise / 2)
    return std::nullopt;
  auto dormer = built(*placed, slope, judged.plan.base, gain, options);
  dormer.rest = least * site.cell_area;
  return dormer;
}

/// Whether a line along a side of the first leaves the other beyond it, and farther than `by`.
auto apart(const Dormer& a, const Dormer& b, double by) -> bool {
  const auto& p = a.plan.outer.points;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 outward = -1 * geometry::left_of(geometry::normalised(p[(i + 1) % p.size()] - p[i]));
    if (std::ranges::all_of(b.plan.outer.points, [&](Point2 q) { return dot(q - p[i], outward) > by; })) return true;
  }
  return false;
}

/// Whether an island is what was seen of the dormer, at another height above the slope. A box begins as the bounds of
/// an island: sides that have not moved since go through the middle of a cell, which is in it.
auto holds(const Dormer& dormer, const std::vector<std::uint32_t>& island, const Site& site) -> bool {
  const auto polygon = model::polygon_of(dormer.plan);
  return std::ranges::all_of(island, [&](std::uint32_t cell) {
    const Point2 at = site.measured.centre(cell);
    return geometry::contains(polygon, at) || geometry::boundary_distance(polygon, at) <= same_distance;
  });
}

}  // namespace

auto dormers_on(const Judged& judged, const Site& site, const Options& options, Where where) -> std::vector<Dormer> {
  const auto& o = options.dormers;
  // A scan rounds off about half of the smallest.
  const double least = o.min_width * o.min_width / 4;
  std::vector<Dormer> found;
  for (const auto& slope : slopes_of(judged, o))
    for (const double above : {o.min_rise / 2, o.min_rise})  // in a row of dormers a scan fills what is between them
      for (const auto& island : islands(judged, site, slope, above)) {
        if (static_cast<double>(island.size()) * site.cell_area < least) continue;
        if (std::ranges::any_of(found, [&](const Dormer& dormer) { return holds(dormer, island, site); })) continue;
        if (auto dormer = best_box(island, slope, judged, site, above, where, options))
          found.push_back(std::move(*dormer));
      }
  rank(
      found, [](const Dormer& dormer) { return -dormer.gain; }, options.same_cost);
  std::vector<Dormer> out;
  for (auto& dormer : found) {
    if (std::ranges::all_of(out, [&](const Dormer& other) { return apart(dormer, other, site.measured.spacing); }))
      out.push_back(std::move(dormer));
  }
  return out;
}

void paint(const Dormer& dormer, const Site& site, View& view) {
  const auto& grid = site.measured;
  const auto& p = dormer.plan.outer.points;  // front left, front right, back right, back left
  const Point2 along = geometry::normalised(p[1] - p[0]), inward = geometry::left_of(along);
  const double width = dot(p[1] - p[0], along), depth = dot(p[3] - p[0], inward);
  const auto raise = [&](Point2 place, double& height) {
    const Point2 at = place - p[0];
    const double u = dot(at, along), v = dot(at, inward);
    // On a side is in it, as for holds().
    if (u < -same_distance || u > width + same_distance || v < -same_distance || v > depth + same_distance) return;
    height = std::max(height, dormer.eaves + dormer.pitch * (width / 2 - std::abs(u - width / 2)));
  };
  for (std::size_t i = 0; i < view.z_at.size(); ++i) raise(site.places[i], view.z_at[i]);
  const auto box = geometry::bounds(p).grown(same_distance);
  const auto index = [&grid](double at, double origin, std::size_t count) {
    return static_cast<std::size_t>(
        std::clamp(std::ceil((at - origin) / grid.spacing), 0.0, static_cast<double>(count)));
  };
  const std::size_t last_row = index(box.most.y, grid.origin.y, grid.rows);
  const std::size_t last_column = index(box.most.x, grid.origin.x, grid.columns);
  for (std::size_t row = index(box.least.y, grid.origin.y, grid.rows); row < last_row; ++row)
    for (std::size_t column = index(box.least.x, grid.origin.x, grid.columns); column < last_column; ++column)
      raise(grid.centre(column, row), view.z[row * grid.columns + column]);
}

auto with_hole(const Plan& host, const Dormer& dormer) -> Plan {
  Plan out = host;
  const auto& p = dormer.plan.outer.points;
  const auto upright = static_cast<std::uint32_t>(out.profiles.size()), back = upright + 1;
  out.profiles.push_back({{0, 0}, {0, dormer.plan.cap + 1}});
  out.profiles.push_back(dormer.back);
  out.holes.push_back({{p[0], p[3], p[2], p[1]}, {upright, back, upright, upright}});
  return out;
}

auto without_dormers(const Site& site, const std::vector<Dormer>& dormers, double aside, const Options& options)
    -> Site {
  std::vector<geometry::Polygon> polygons;
  for (const auto& dormer : dormers) polygons.push_back(model::polygon_of(dormer.plan));
  return without(
      site,
      [&](Point2 at) {
        return std::ranges::any_of(polygons, [&](const geometry::Polygon& polygon) {
          return geometry::contains(polygon, at) || geometry::boundary_distance(polygon, at) < aside;
        });
      },
      options);
}

}  // namespace mansard::refine::detail
