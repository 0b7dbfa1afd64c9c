// O7: pairs of edges that would make a sliver or a needle if both became walls.
#include <algorithm>
#include <cmath>
#include <set>

#include "mansard/geometry/angles.hpp"
#include "mansard/segment/detail/candidates.hpp"
#include "mansard/segment/detail/walk.hpp"

namespace mansard::segment::detail {
namespace {

using geometry::cross, geometry::dot, geometry::Point2;

/// Consecutive, nearly collinear half-edges of a face with one neighbour.
struct Run {
  geometry::Segment2 segment;              ///< the face on its left
  std::uint32_t face = 0, first = 0;       ///< the face; the run's first half-edge
  std::optional<std::uint32_t> candidate;  ///< none on the outline
  double length = 0;                       ///< m
  double facing_out = 0, facing_in = 0;    ///< m of sweep-edge whose outside lies off the face, or in it
};

/// The runs of a face are added to `runs`, in order around it; run_of half-edge is set.
void add_runs(const fracture::Arrangement& arrangement, std::uint32_t face,
              const std::vector<std::optional<std::uint32_t>>& candidate_of, const Options& o, std::vector<Run>& runs,
              std::vector<std::uint32_t>& run_of) {
  const auto direction = [&](std::uint32_t h) {
    const auto s = arrangement.segment(h);
    return s.end - s.start;
  };
  const auto goes_on = [&](std::uint32_t h, std::uint32_t next) {
    const Point2 a = direction(h), b = direction(next);
    return candidate_of[h] == candidate_of[next] && dot(a, b) > 0 &&
           std::abs(cross(a, b)) <= o.thin_run_turn * dot(a, b);
  };
  std::uint32_t first = arrangement.faces[face].edge;
  const std::uint32_t origin = first;
  while (goes_on(arrangement.half_edges[first].previous, first)) {
    first = arrangement.half_edges[first].previous;
    if (first == origin) break;
  }
  std::uint32_t h = first;
  do {
    const fracture::HalfEdge& edge = arrangement.half_edges[h];
    if (h == first || !goes_on(edge.previous, h)) runs.push_back({arrangement.segment(h), face, h, candidate_of[h]});
    Run& run = runs.back();
    run_of[h] = static_cast<std::uint32_t>(runs.size() - 1);
    const double length = length_of(arrangement, h);
    run.segment.end = arrangement.segment(h).end;
    run.length += length;
    // A sweep-edge has its outside on the left.
    bool in = false, out = false;
    for (const fracture::Origin& cause : edge.origins)
      if (cause.kind == fracture::Kind::hard && cause.source < gis_source) (cause.along ? in : out) = true;
    if (in) run.facing_in += length;
    if (out) run.facing_out += length;
    h = edge.next;
  } while (h != first);
}

/// Consecutive runs with an interior angle under the limit between them.
auto is_needle(const Run& one, const Run& next, const Options& o) -> bool {
  if (one.length < o.thin_shortest || next.length < o.thin_shortest) return false;
  const Point2 back = one.segment.start - one.segment.end, on = next.segment.end - next.segment.start;
  return cross(on, back) > 0 && dot(on, back) > geometry::cosine(o.thin_angle) * length(on) * length(back);
}

/// Where runs that face each other, nearer than the limit, are nearest on the first one.
auto sliver_at(const Run& one, const Run& other, const Options& o) -> std::optional<Point2> {
  if (one.length < o.thin_shortest || other.length < o.thin_shortest) return std::nullopt;
  const Point2 a = one.segment.end - one.segment.start, b = other.segment.end - other.segment.start;
  const double la = length(a);
  if (dot(a, b) > -geometry::cosine(o.thin_parallel) * la * length(b)) return std::nullopt;
  // In the frame of `one`: along it, and to its left; `other` runs backwards.
  const auto along = [&](Point2 p) { return dot(p - one.segment.start, a) / la; };
  const auto aside = [&](Point2 p) { return cross(a, p - one.segment.start) / la; };
  const double from = along(other.segment.end), to = along(other.segment.start);
  const double low = std::max(0.0, from), high = std::min(la, to);
  if (!(high > low)) return std::nullopt;
  const auto off = [&](double t) {
    const double s = (t - from) / (to - from);
    return (1 - s) * aside(other.segment.end) + s * aside(other.segment.start);
  };
  const double nearest = std::min(off(low), off(high)), farthest = std::max(off(low), off(high));
  if (farthest <= 0 || nearest >= o.thin_distance) return std::nullopt;
  // Just inside the common stretch, so that a walk across starts beside both.
  const double inset = (high - low) / 8, at = off(low) < off(high) ? low + inset : high - inset;
  return one.segment.start + (at / la) * a;
}

/// Whether two runs that do not meet, and do not lie on one line, are nearer than the limit somewhere. The runs of one
/// straight wall are one edge of a footprint.
auto near_by(const Run& one, const Run& other, const Options& o) -> bool {
  if (one.length < o.thin_shortest || other.length < o.thin_shortest) return false;
  const auto &a = one.segment, &b = other.segment;
  if (a.start == b.start || a.start == b.end || a.end == b.start || a.end == b.end) return false;
  const Point2 along = geometry::normalised(a.end - a.start);
  const auto aside = [&](Point2 p) { return std::abs(cross(along, p - a.start)); };
  if (aside(b.start) < o.thin_shortest && aside(b.end) < o.thin_shortest) return false;
  return std::min({geometry::distance(a, b.start), geometry::distance(a, b.end), geometry::distance(b, a.start),
                   geometry::distance(b, a.end)}) < o.thin_distance;
}

/// A thin wall, or a shaft, seen from both sides: sweep-edges on both, which face away from each other or towards.
auto seen_from_both_sides(const Run& one, const Run& other) -> bool {
  const auto most = [](double part, const Run& run) { return part > run.length / 2; };
  return (most(one.facing_out, one) && most(other.facing_out, other)) ||
         (most(one.facing_in, one) && most(other.facing_in, other));
}

class ConflictSearch {
 public:
  ConflictSearch(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                 const std::vector<std::optional<std::uint32_t>>& candidate_of, const Options& options)
      : arrangement_(arrangement), faces_(faces), options_(options), run_of_(arrangement.half_edges.size()) {
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      if (faces[f].inside) add_runs(arrangement, f, candidate_of, options, runs_, run_of_);
  }

  [[nodiscard]] auto found() -> std::vector<Conflict> {
    for (std::size_t i = 0; i < runs_.size(); ++i) find_needles(i);
    if (options_.thin_reach == ThinReach::face) find_slivers_within_faces();
    else find_slivers_anywhere();
    return {conflicts_.begin(), conflicts_.end()};
  }

 private:
  void note(const Run& one, const Run& other) {
    if (!one.candidate && !other.candidate) return;  // the outline is there whatever is chosen
    if (!one.candidate || !other.candidate || *one.candidate == *other.candidate)
      conflicts_.insert({one.candidate ? *one.candidate : *other.candidate, std::nullopt});
    else conflicts_.insert({std::min(*one.candidate, *other.candidate), std::max(*one.candidate, *other.candidate)});
  }

  /// Turns counter-clockwise around the start of run i, over one face or over as many as lie within the angle.
  void find_needles(std::size_t i) {
    const Run& run = runs_[i];
    for (std::uint32_t h = run.first;;) {
      const std::uint32_t arriving = arrangement_.half_edges[h].previous;
      if (run_of_[arriving] == i) return;  // all around
      const Run& before = runs_[run_of_[arriving]];
      if (is_needle(before, run, options_) && !is_lens(h)) note(before, run);
      const auto s = arrangement_.segment(arriving);
      const Point2 back = s.start - s.end, on = run.segment.end - run.segment.start;
      h = arrangement_.half_edges[arriving].twin;
      const auto face = arrangement_.half_edges[h].face;
      if (options_.thin_reach == ThinReach::face || !face || !faces_[*face].inside || cross(on, back) <= 0 ||
          dot(on, back) <= 0)
        return;
    }
  }

  /// Whether the face between has but two runs, which are as good as one line.
  [[nodiscard]] auto is_lens(std::uint32_t half_edge) const -> bool {
    std::optional<std::uint32_t> one = run_of_[half_edge], other;
    for (const std::uint32_t h : half_edges_around(arrangement_, *arrangement_.half_edges[half_edge].face)) {
      if (run_of_[h] == *one || (other && run_of_[h] == *other)) continue;
      if (other) return false;
      other = run_of_[h];
    }
    return true;
  }

  [[nodiscard]] auto is_exempt(const Run& one, const Run& other) const -> bool {
    return options_.thin_rule == ThinRule::unsupported && seen_from_both_sides(one, other);
  }

  [[nodiscard]] auto make_a_sliver(const Run& one, const Run& other) const -> bool {
    if (options_.thin_rule == ThinRule::any) return one.candidate != other.candidate && near_by(one, other, options_);
    return sliver_at(one, other, options_) && !is_exempt(one, other);
  }

  void find_slivers_within_faces() {
    for (std::size_t i = 0; i < runs_.size(); ++i)
      for (std::size_t j = i + 1; j < runs_.size() && runs_[j].face == runs_[i].face; ++j)
        if (make_a_sliver(runs_[i], runs_[j])) note(runs_[i], runs_[j]);
  }

  void find_slivers_anywhere() {
    std::vector<geometry::Box2> boxes;
    std::vector<std::size_t> order;
    for (const Run& run : runs_) {
      order.push_back(order.size());
      boxes.emplace_back();
      boxes.back().add(run.segment.start);
      boxes.back().add(run.segment.end);
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(boxes[i].least.x, i); });
    for (std::size_t k = 0; k < order.size(); ++k) {
      const auto reach = boxes[order[k]].grown(options_.thin_distance);
      for (std::size_t l = k + 1; l < order.size() && boxes[order[l]].least.x <= reach.most.x; ++l) {
        if (!reach.overlaps(boxes[order[l]])) continue;
        const Run &one = runs_[order[k]], &other = runs_[order[l]];
        if (!make_a_sliver(one, other)) continue;
        const auto at = options_.thin_rule == ThinRule::any ? std::nullopt : sliver_at(one, other, options_);
        if (!at || leads_to(one, *at, order[l])) note(one, other);
      }
    }
  }

  /// Whether a walk from a place on a run, straight away from it, comes to the other run through inside faces only.
  [[nodiscard]] auto leads_to(const Run& one, Point2 place, std::size_t other) const -> bool {
    const Point2 inwards = geometry::normalised(geometry::left_of(one.segment.end - one.segment.start));
    std::uint32_t from = one.first;
    while (run_of_[arrangement_.half_edges[from].next] == run_of_[one.first] &&
           dot(arrangement_.segment(from).end - place, one.segment.end - one.segment.start) < 0)
      from = arrangement_.half_edges[from].next;
    for (double gone = 0; gone <= options_.thin_distance;) {
      const auto exit = exit_of(arrangement_, from, place, inwards);
      if (!exit) return false;
      if (run_of_[exit->half_edge] == other) return true;
      gone += exit->distance;
      place = place + exit->distance * inwards;
      from = arrangement_.half_edges[exit->half_edge].twin;
      const auto face = arrangement_.half_edges[from].face;
      if (!face || !faces_[*face].inside) return false;
    }
    return false;
  }

  const fracture::Arrangement& arrangement_;
  const std::vector<FaceEvidence>& faces_;
  const Options& options_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> run_of_;  ///< by half-edge of an inside face
  std::set<Conflict> conflicts_;
};

}  // namespace

auto conflicts_of(const fracture::Arrangement& arrangement, const std::vector<FaceEvidence>& faces,
                  const std::vector<std::optional<std::uint32_t>>& candidate_of, const Options& options)
    -> std::vector<Conflict> {
  return ConflictSearch(arrangement, faces, candidate_of, options).found();
}

}  // namespace mansard::segment::detail
