#include "mansard/refine/detail/propose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/pieces.hpp"
#include "mansard/refine/detail/place.hpp"
#include "mansard/refine/detail/propose_outline.hpp"
#include "mansard/refine/detail/propose_raster.hpp"
#include "mansard/refine/detail/propose_regions.hpp"
#include "mansard/refine/detail/propose_split.hpp"
#include "mansard/refine/detail/propose_surface.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Polygon;
using Mask = std::vector<std::uint8_t>;

struct Cut {
  Polygon polygon;
  carve::Frame frame;
  bool line = false;  ///< across the part; else an outline
  bool step = true;
  Mask mask;
  carve::Errors errors;
  double gain = 0;    ///< m²·m²
  double ranked = 0;  ///< the gain, less of outlines that are complicated
};

/// Area over the longer side of its box along the frame, metres.
auto mean_width(const Polygon& polygon, const carve::Frame& frame) -> double {
  const geometry::Box2 box = geometry::bounds(carve::in_frame(polygon, frame).outer);
  return geometry::area(polygon) / std::max({box.most.x - box.least.x, box.most.y - box.least.y, 1e-9});
}

/// The cuts of one part as they are found, held against the cells as measured.
class Cuts {
 public:
  Cuts(const carve::Raster& raster, double part_area, double least_gain, const Options& options)
      : raster_(raster), area_(part_area), least_gain_(least_gain), options_(options) {}

  void consider(const Polygon& polygon, const carve::Frame& frame, bool line, bool step) {
    const auto& o = options_.cuts;
    const double piece = geometry::area(polygon);
    if (piece < options_.cuts.min_area || area_ - piece < options_.cuts.min_area) return;
    if (!line && mean_width(polygon, frame) < o.min_width) return;
    Cut cut{polygon, frame, line, step, carve::cells_in(polygon, raster_), {}, 0, 0};
    if (!line && is_rim_around(cut.mask)) return;
    cut.errors = carve::errors_of(raster_, cut.mask, frame, options_.surfaces);
    const double gain = carve::gain_of(cut.errors, options_.surfaces);
    cut.gain = gain * raster_.cell_area();
    if (!(cut.gain >= least_gain_)) return;
    if (line && gain < o.line_gain * cut.errors.whole.best) return;
    cut.ranked = line ? cut.gain : cut.gain * (1 - o.outline_price);
    found_.push_back(std::move(cut));
  }

  /// Best first, none nearly the same as a better one.
  [[nodiscard]] auto best() && -> std::vector<Cut> {
    std::ranges::stable_sort(found_, {}, [](const Cut& cut) { return cut.polygon.outer; });
    rank(
        found_, [](const Cut& cut) { return -cut.ranked; }, options_.same_cost);
    std::vector<Cut> out;
    for (Cut& cut : found_) {
      if (std::ssize(out) >= options_.cuts.max_count) break;
      if (std::ranges::none_of(out, [&](const Cut& o) { return same(o, cut); })) out.push_back(std::move(cut));
    }
    return out;
  }

 private:
  /// Whether what is left of the part is narrower than a structure: the rim of an outline that is a little too large.
  [[nodiscard]] auto is_rim_around(const Mask& piece) const -> bool {
    Mask rest(piece.size());
    for (std::size_t k = 0; k < rest.size(); ++k)
      rest[k] = raster_.state[k] != carve::Cell::outside && !piece[k] ? 1 : 0;
    return std::ranges::count(carve::shrunk(raster_, rest, options_.cuts.min_width / 2), 1) == 0;
  }

  /// A piece and the rest around it are one cut; it is as large as the smaller of the two.
  [[nodiscard]] auto same(const Cut& a, const Cut& b) const -> bool {
    std::size_t in_a = 0, in_b = 0, crossed = 0, cells = 0;
    for (std::size_t k = 0; k < a.mask.size(); ++k) {
      if (raster_.state[k] == carve::Cell::outside) continue;
      ++cells;
      in_a += a.mask[k];
      in_b += b.mask[k];
      crossed += a.mask[k] ^ b.mask[k];
    }
    const std::size_t size = std::max(std::min(in_a, cells - in_a), std::min(in_b, cells - in_b));
    return static_cast<double>(std::min(crossed, cells - crossed)) <=
           options_.cuts.same_share * static_cast<double>(size);
  }

  const carve::Raster& raster_;
  double area_, least_gain_;
  const Options& options_;
  std::vector<Cut> found_;
};

/// The part's side of a line at x that lies beyond it in direction `way`, in the raster's frame.
auto half_plane(const carve::Raster& raster, double x, int way) -> Polygon {
  const geometry::Box2 box = geometry::bounds(raster.part.outer).grown(1);
  const double from = way > 0 ? x : box.least.x, to = way > 0 ? box.most.x : x;
  return {{{from, box.least.y}, {to, box.least.y}, {to, box.most.y}, {from, box.most.y}}, {}};
}

auto exchanged(Polygon polygon) -> Polygon {
  for (auto& p : polygon.outer) std::swap(p.x, p.y);
  std::ranges::reverse(polygon.outer);
  return polygon;
}

void consider_lines(const Polygon& part, const carve::Raster& raster, bool across, double least_gain,
                    const Options& options, Cuts& cuts) {
  const geometry::Box2 box = geometry::bounds(raster.part.outer);
  const auto wide = [&](const Polygon& piece) {
    return geometry::area(piece) >= options.cuts.min_area &&
           mean_width(piece, raster.frame) >= options.cuts.line_min_width;
  };
  for (const carve::SplitLine& line : carve::split_lines(raster, least_gain, options)) {
    const double at = carve::aligned(raster, line.at, box.least.y, box.most.y, options.outlines);
    std::array<std::vector<Polygon>, 2> sides;
    for (const int way : {0, 1}) {
      Polygon side = half_plane(raster, at, way == 0 ? -1 : 1);
      if (across) side = exchanged(std::move(side));
      sides[static_cast<std::size_t>(way)] = carve::pieces_in_part(part, side, raster.frame, options.pieces);
      std::erase_if(sides[static_cast<std::size_t>(way)], [&](const Polygon& piece) { return !wide(piece); });
    }
    // What a line shaves off as a thin strip is the rim of an outline that is a little too large.
    if (sides[0].empty() || sides[1].empty()) continue;
    for (const auto& side : sides)
      for (const Polygon& piece : side) cuts.consider(piece, raster.frame, true, line.step);
  }
}

void consider_regions(const Polygon& part, const carve::Raster& raster, const carve::Raster& turned,
                      const std::vector<carve::Region>& regions, const Options& options, Cuts& cuts) {
  for (const carve::Region& region : regions) {
    for (const auto& outline :
         {carve::outline_of(raster, turned, region, options), carve::askew_outline_of(raster, region, options)}) {
      if (!outline) continue;
      const auto pieces = carve::pieces_in_part(part, *outline, raster.frame, options.pieces);
      if (!pieces.empty()) cuts.consider(pieces.front(), raster.frame, false, true);
    }
  }
}

/// With the part's own corners where it has some, and no corner twice or on a straight line but those.
auto with_corners_of(const Polygon& part, const Polygon& piece, double same_place) -> Polygon {
  std::vector<geometry::Point2> corners = part.outer;
  for (const auto& hole : part.holes) corners.insert(corners.end(), hole.begin(), hole.end());
  const auto at_corner = [&](geometry::Point2 p) { return std::ranges::find(corners, p) != corners.end(); };
  const auto tidy = [&](const geometry::Ring& ring) {
    geometry::Ring out;
    for (geometry::Point2 p : ring) {
      for (const geometry::Point2 c : corners)
        if (length(p - c) < same_place) p = c;
      if (out.empty() || length(p - out.back()) >= same_place) out.push_back(p);
    }
    while (out.size() > 1 && length(out.front() - out.back()) < same_place) out.pop_back();
    for (std::size_t i = 0; i < out.size() && out.size() > 3;) {
      const geometry::Segment2 past{out[(i + out.size() - 1) % out.size()], out[(i + 1) % out.size()]};
      if (!at_corner(out[i]) && geometry::distance(past, out[i]) < same_place)
        out.erase(out.begin() + static_cast<std::ptrdiff_t>(i));
      else ++i;
    }
    return out;
  };
  Polygon out{tidy(piece.outer), {}};
  for (const auto& hole : piece.holes)
    if (geometry::Ring ring = tidy(hole); ring.size() > 2) out.holes.push_back(std::move(ring));
  return out;
}

auto total_area(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const Polygon& p : polygons) sum += geometry::area(p);
  return sum;
}

/// Whether part and piece can be told apart by polygon operations: rounding at shared walls defeats them now and then.
auto sound(const Polygon& part, const Polygon& piece, const Options& options) -> bool {
  const double nothing = options.pieces.straight * around(part), least_area = options.cuts.min_area;
  if (piece.outer.size() < 3 || !geometry::is_simple(piece)) return false;
  const auto [whole, taken] = fitted(part, piece, options.pieces);
  const auto rest = geometry::subtract(whole, taken), beyond = geometry::subtract(taken, whole);
  if (!rest || !beyond) return false;
  const double left = total_area(*rest), own = geometry::area(piece);
  return total_area(*beyond) < nothing && std::abs(left + own - geometry::area(part)) < nothing && own >= least_area &&
         left >= least_area;
}

/// Without the slivers outside of the part that tidying leaves: it moves corners by up to `Options::Pieces::slit`.
auto inside_of(const Polygon& part, Polygon piece) -> Polygon {
  constexpr double none = 1e-7;  // m²; coordinates of some 100 m are right to 1e-14 m, lengths of 100 m to 1e-9 m
  const auto beyond = geometry::subtract(piece, part);
  if (!beyond || total_area(*beyond) < none) return piece;
  const auto inside = geometry::intersect(part, piece);
  if (!inside || inside->empty()) return piece;
  return *std::ranges::max_element(*inside, {}, [](const Polygon& p) { return geometry::area(p); });
}

auto metres(double value) -> std::string {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f m", value);
  return text;
}

/// How much higher the piece stands than what is next to it, both read near to but off the walls, which melt; nothing
/// where unseen.
auto rise_of(const carve::Raster& raster, const Mask& mask, const Options& options) -> std::optional<double> {
  const double melted = options.samples.melt, far = options.cuts.rise_reach;
  const Mask core = carve::shrunk(raster, mask, melted), rim = carve::grown(raster, mask, melted);
  const Mask around = carve::grown(raster, mask, far);
  Mask part(mask.size()), rest(mask.size());
  for (std::size_t k = 0; k < mask.size(); ++k) {
    part[k] = raster.state[k] != carve::Cell::outside ? 1 : 0;
    rest[k] = part[k] && !mask[k] ? 1 : 0;
  }
  const Mask beside = carve::grown(raster, rest, far), off_eaves = carve::shrunk(raster, part, melted);
  double in = 0, in_count = 0, out = 0, out_count = 0;
  for (std::size_t k = 0; k < mask.size(); ++k) {
    if (raster.state[k] != carve::Cell::seen || !off_eaves[k]) continue;
    if (core[k] && beside[k]) in += raster.z[k], in_count += 1;
    if (around[k] && !rim[k]) out += raster.z[k], out_count += 1;
  }
  if (in_count < 1 || out_count < 1) return std::nullopt;
  return in / in_count - out / out_count;
}

auto words_for(const carve::Raster& raster, const Cut& cut, const Options& options) -> std::string {
  if (cut.line && !cut.step) return "another roof on either side of a line across";
  const std::string beside = cut.line ? "the other side of a line across" : "the roof around it";
  const auto rise = rise_of(raster, cut.mask, options);
  if (!rise || std::abs(*rise) < options.cuts.min_rise) return "a roof of its own beside " + beside;
  return *rise > 0 ? "stands " + metres(*rise) + " above " + beside : "lies " + metres(-*rise) + " below " + beside;
}

/// Every so many cells of a fine grid.
auto thinned(const Heights& heights, std::size_t every) -> Heights {
  Heights out{heights.origin,
              heights.spacing * static_cast<double>(every),
              (heights.columns + every - 1) / every,
              (heights.rows + every - 1) / every,
              {}};
  out.z.reserve(out.columns * out.rows);
  for (std::size_t j = 0; j < heights.rows; j += every)
    for (std::size_t i = 0; i < heights.columns; i += every) out.z.push_back(heights.at(i, j));
  return out;
}

/// What cuts are compared with.
auto thinned_raster(const Polygon& part, const Heights& measured, const Heights& model, const Options& options)
    -> carve::Raster {
  const double in_part = geometry::area(part) / (measured.spacing * measured.spacing);
  const auto every = static_cast<std::size_t>(std::ceil(std::sqrt(std::max(1.0, in_part / options.cuts.max_cells))));
  return carve::raster_of(part, thinned(measured, every), thinned(model, every), {}, options.directions);
}

}  // namespace

auto at_steps(const Polygon& part, const Polygon& piece, const Heights& measured, const OnPlanes& samples,
              const Options& options) -> std::optional<Polygon> {
  Polygon at_step = placed(part, piece, measured, options, samples);
  // A side that was moved ends on the line of the side beside it, which may be past a corner of the part.
  if (at_step != piece) {
    auto inside = carve::pieces_in_part(part, at_step, options.pieces);
    if (inside.empty()) return std::nullopt;
    at_step = std::move(inside.front());
  }
  Polygon out = with_corners_of(part, at_step, options.pieces.slit);
  out = inside_of(part, std::move(out));
  return sound(part, out, options) ? std::optional(std::move(out)) : std::nullopt;
}

namespace {

/// Whether two cuts whose sides were moved to where the scan has them became one.
auto are_one(const Polygon& a, const Polygon& b) -> bool {
  constexpr double share = 0.02;
  const double in_a = geometry::area(a), in_b = geometry::area(b), most = share * std::max(in_a, in_b);
  if (std::abs(in_a - in_b) > most) return false;
  const auto common = geometry::intersect(a, b);
  if (!common) return false;
  double in_both = 0;
  for (const Polygon& piece : *common) in_both += geometry::area(piece);
  return in_a + in_b - 2 * in_both <= most;
}

}  // namespace

auto propose(const Polygon& part, const Heights& measured, const Heights& model, double least_gain,
             const Options& options, const OnPlanes& samples) -> std::vector<Proposal> {
  const std::size_t cells = measured.columns * measured.rows;
  if (part.outer.size() < 3 || cells == 0 || !(measured.spacing > 0)) return {};
  if (measured.z.size() != cells || model.z.size() != cells) return {};
  const carve::Raster as_measured = thinned_raster(part, measured, model, options);
  Cuts cuts(as_measured, geometry::area(part), least_gain, options);
  const carve::Raster raster =
      carve::raster_of(part, measured, model, carve::direction_of(part, options.directions), options.directions);
  const carve::Raster turned = carve::turned(raster);
  consider_regions(part, raster, turned, carve::regions_of(raster, options), options, cuts);
  consider_regions(part, raster, turned, carve::regions_of_planes(raster, samples, least_gain, options), options, cuts);
  consider_lines(part, raster, false, least_gain, options, cuts);
  consider_lines(part, turned, true, least_gain, options, cuts);
  std::vector<Proposal> out;
  for (Cut& cut : std::move(cuts).best()) {
    auto piece = at_steps(part, cut.polygon, measured, samples, options);
    if (!piece || std::ranges::any_of(out, [&](const Proposal& o) { return are_one(o.polygon, *piece); })) continue;
    std::string what = words_for(as_measured, cut, options);
    out.push_back({std::move(*piece), cut.gain, std::move(what), cut.line});
  }
  rank(
      out, [](const Proposal& proposal) { return -proposal.gain; }, options.same_cost);
  return out;
}

Gains::Gains(const Polygon& part, const Heights& measured, const Heights& model, const Options& options)
    : raster_(thinned_raster(part, measured, model, options)), options_(options) {}

auto Gains::of(const Polygon& piece, geometry::Point2 along) const -> double {
  const auto errors = carve::errors_of(raster_, carve::cells_in(piece, raster_), {along}, options_.surfaces);
  return carve::gain_of(errors, options_.surfaces) * raster_.cell_area();
}

}  // namespace mansard::refine::detail
