#include "mansard/extrude/detail/lines.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/extrude/detail/runs.hpp"

namespace mansard::extrude::detail {

using geometry::Point2;

namespace {

// Error bounds, m, of points that lie on exact lines up to how they were written down. Coordinates of a projected
// system are below 2²⁴ m, where doubles are 2⁻²⁹ m apart: rounding both moves a point by √2 · 2⁻³⁰ = 1.4e-9 m at most.
// The fine grid adds √2 · 2⁻³⁷ = 1e-11 m, and n · p 4 u of coordinates from the origin, 5e-13 m for 1 km.
constexpr double off_line = 2e-9;
/// Lines that are off by that each and turn by α meet 2 · 2e-9 / sin α from where they should: 1e-5 m from 4e-4 rad on,
/// a twentieth of the turns that are kept at all (`merge_angle`).
constexpr double off_corner = 1e-5;
/// What counts as exactly on a chord, in the tally alone.
constexpr double on_chord = 1e-9;

// Shares of the tolerance. One half is for straightening (`Care::straighten`) and for chains of parallel neighbours,
// the other for what lines do that are put on the grid and share directions; measure() has the last word on the sum.

/// Where two lines meet, times `divisor` in quanta: integers below 2^122.
struct Corner {
  Int128 x = 0, y = 0, divisor = 1;
  Point2 at;  ///< metres; off by less than 2^-51 of the coordinate: two conversions and a quotient, 3 · 2^-53

  [[nodiscard]] auto exact() const -> ExactPoint {
    const auto quotient = [this](Int128 value) {
      Rational result(to_integer(value), to_integer(divisor) * 65536);
      result.canonicalize();
      return result;
    };
    return {quotient(x), quotient(y)};
  }
};

auto corner_between(const Direction& d, std::int64_t at_d, const Direction& e, std::int64_t at_e) -> Corner {
  Corner corner;
  const Int128 rd = static_cast<Int128>(at_d) * d.l, re = static_cast<Int128>(at_e) * e.l;
  corner.divisor = cross(d, e);
  // |at| < 2^38, l < 2^41, a < 2^41.
  corner.x = rd * e.a - re * d.a;
  corner.y = rd * e.b - re * d.b;
  const double divisor = static_cast<double>(corner.divisor);
  corner.at = {static_cast<double>(corner.x) / divisor * quantum, static_cast<double>(corner.y) / divisor * quantum};
  return corner;
}

auto distance_to(Point2 a, Point2 b, Point2 p) -> double { return geometry::distance({a, b}, p); }

/// At least the distance of a segment from some others. It is convex along a segment for each of them; where no one is
/// within `enough` of the whole segment, halves are looked at.
auto distance_bound(const geometry::Segment2& segment, const std::vector<geometry::Segment2>& others, double enough,
                    int depth = 0) -> double {
  constexpr int deepest = 12;
  double least = HUGE_VAL;
  for (const auto& other : others)
    least = std::min(least, std::max(geometry::distance(other, segment.start), geometry::distance(other, segment.end)));
  if (least <= enough || depth == deepest) return least;
  const Point2 middle = 0.5 * (segment.start + segment.end);
  return std::min(least, std::max(distance_bound({segment.start, middle}, others, enough, depth + 1),
                                  distance_bound({middle, segment.end}, others, enough, depth + 1)));
}

class Lines {
 public:
  Lines(const Source& source, const Options& options, const Care& care, std::string& why)
      : source_(source), options_(options), care_(care), why_(why) {}

  auto make() -> std::optional<Footprint> {
    out_.origin = origin_of(geometry::bounds(source_.rings[0].points));
    for (const auto& ring : source_.rings) grid_.push_back(on_fine_grid(ring.points, out_.origin));
    gather_tracks();
    for (const GridRing& ring : grid_) {
      runs_.push_back(straightened(ring, options_.merge_angle, care_.straighten));
      if (runs_.back().size() < 3) return refuse(collapses(runs_.size() - 1));
    }
    if (!lies_on_exact_lines() && !settle()) return std::nullopt;
    for (;;) {
      write();
      const auto clash = clash_in(out_.corners);
      if (!clash) break;
      // Shared directions may have closed a narrow place; own ones come nearer to the source.
      if (!release_all()) return refuse(clashes(*clash));
      if (!settle()) return std::nullopt;
    }
    return std::move(out_);
  }

 private:
  struct Place {
    std::size_t ring, run;
  };

  auto refuse(std::string why) -> std::nullopt_t {
    why_ = std::move(why);
    return std::nullopt;
  }

  // ---- words
  [[nodiscard]] auto place(Point2 local) const -> std::string {
    const Point2 p = local + out_.origin;
    return "(" + base::to_text(p.x, 3) + ", " + base::to_text(p.y, 3) + ")";
  }
  [[nodiscard]] auto edge(std::size_t r, std::size_t source_edge) const -> std::string {
    const auto& names = source_.rings[r].edge;
    const std::string name = "edge " + std::to_string(names[source_edge % names.size()]);
    return r == 0 ? name : name + " of hole " + std::to_string(source_.rings[r].ring);
  }
  [[nodiscard]] auto collapses(std::size_t r) const -> std::string {
    return (r == 0 ? std::string("the outline") : "hole " + std::to_string(source_.rings[r].ring)) + " near " +
           place(metres(grid_[r][0])) + " has fewer than three sides once shallow turns are straightened";
  }
  [[nodiscard]] auto clashes(const Clash& c) const -> std::string {
    const auto& name = [&](std::size_t r, std::size_t i) {
      return "edge " + std::to_string(out_.rings[r][i].provenance.edge) +
             (r == 0 ? "" : " of hole " + std::to_string(source_.rings[r].ring));
    };
    const ExactPoint& p = out_.corners[c.ring][c.edge];
    return name(c.ring, c.edge) + " near " + place(p.approximate()) + " and " + name(c.other_ring, c.other_edge) +
           " are too close to each other to stay apart on exact lines; widen the gap or the neck between them to a "
           "millimetre, or close it";
  }

  // ---- source
  [[nodiscard]] auto point(std::size_t r, std::size_t i) const -> Point2 { return metres(detail::at(grid_[r], i)); }
  [[nodiscard]] auto track(std::size_t r, std::size_t source_edge) const -> std::uint32_t {
    const auto& ring = source_.rings[r];
    return track_of_profile_[ring.profile[source_edge % ring.profile.size()]];
  }
  void gather_tracks() {
    for (const auto& profile : source_.profiles) {
      Track t = track_of(profile);
      const auto same = std::ranges::find(out_.tracks, t);
      track_of_profile_.push_back(static_cast<std::uint32_t>(same - out_.tracks.begin()));
      if (same == out_.tracks.end()) out_.tracks.push_back(std::move(t));
    }
  }
  [[nodiscard]] auto alike(std::uint32_t p, std::uint32_t q) const -> bool {
    return p == q || same_shape(out_.tracks[p], out_.tracks[q]);
  }

  // ---- a source that is canonical already
  /// Every run on a line of the table and the grid to within the rounding of its corners: then those lines are taken.
  [[nodiscard]] auto lies_on_exact_lines() -> bool {
    const auto kept = runs_;
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (Run& run : runs_[r]) {
        run.direction = direction_of(bearing_of(metres(chord_of(grid_[r], run))));
        const Point2 n = left_of(run.direction.approximate());
        run.offset = std::llrint(dot(n, point(r, run.first)) / quantum);
        for (std::size_t i = run.first; i <= run.last; ++i)
          if (std::abs(dot(n, point(r, i)) - static_cast<double>(run.offset) * quantum) > off_line) {
            runs_ = kept;
            return false;
          }
      }
    const auto stands = [&] {
      for (std::size_t r = 0; r < runs_.size(); ++r) {
        auto& runs = runs_[r];
        join(r, [&](const Run& p, const Run& q) { return p.direction == q.direction && p.offset == q.offset; });
        if (runs.size() < 3) return false;
        for (std::size_t i = 0; i < runs.size(); ++i)
          if (cross(runs[i].direction, runs[(i + 1) % runs.size()].direction) == 0) return false;
      }
      place_corners();
      for (std::size_t r = 0; r < runs_.size(); ++r)
        for (std::size_t i = 0; i < runs_[r].size(); ++i)
          if (length(corners_[r][i].at - point(r, runs_[r][i].first)) > off_corner || turns_round(r, i, shortest))
            return false;
      return measure();
    };
    if (stands()) return true;
    runs_ = kept;
    why_.clear();
    return false;
  }

  // ---- everything else
  /// Every round joins runs, gives one its own direction or drops one, so this ends.
  [[nodiscard]] auto settle() -> bool {
    for (;;) {
      share_directions(grid_, runs_, std::min(options_.lines.share_move, options_.tolerance / 16),
                       options_.lines.share_turn);
      if (settle_parallel_neighbours()) continue;
      if (!why_.empty()) return false;
      for (std::size_t r = 0; r < runs_.size(); ++r)
        for (Run& run : runs_[r]) {
          const Point2 middle = 0.5 * (point(r, run.first) + point(r, run.last));
          run.offset = std::llrint(dot(left_of(run.direction.approximate()), middle) / quantum);
        }
      place_corners();
      if (release_displaced() || drop_turned() || join_straightest_of(displaced_, care_.straighten)) continue;
      if (!why_.empty()) return false;
      if (measure()) return true;
      const std::size_t next = (worst_.run + 1) % runs_[worst_.ring].size();
      if (!release_all() && !drop_shortest_of({worst_, {worst_.ring, next}})) return false;
      why_.clear();
    }
  }

  auto release(Run& run) -> bool { return !std::exchange(run.own_direction, true); }
  auto release_all() -> bool {
    bool freed = false;
    for (auto& runs : runs_)
      for (Run& run : runs) freed = release(run) || freed;
    return freed;
  }

  /// Makes one run of neighbours that go together, all around the ring at once.
  template <class Together>
  auto join(std::size_t r, Together together) -> bool {
    auto& runs = runs_[r];
    const std::size_t n = runs.size();
    std::size_t start = 0;
    while (start < n && together(runs[(start + n - 1) % n], runs[start])) ++start;
    if (start == n) return false;  // no ring of one direction closes
    std::vector<Run> joined;
    for (std::size_t k = 0; k < n; ++k) {
      const Run& run = runs[(start + k) % n];
      if (k > 0 && together(runs[(start + k - 1) % n], run)) {
        Run& whole = joined.back();
        whole.last = past(r, whole.first, run.last);
        whole.own_direction = whole.own_direction || run.own_direction;
      } else {
        joined.push_back(run);
      }
    }
    const bool changed = joined.size() < n;
    std::ranges::sort(joined, {}, [](const Run& run) { return run.first; });
    runs = std::move(joined);
    return changed;
  }

  /// Neighbours of one direction are one run where its chord stays near all their corners. What cannot be one, and
  /// neighbours of opposite directions, take directions of their own.
  [[nodiscard]] auto settle_parallel_neighbours() -> bool {
    bool changed = false;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      auto& runs = runs_[r];
      const std::size_t n = runs.size();
      std::vector<bool> goes_on(n, false);  // with the next
      for (std::size_t i = 0; i < n; ++i) goes_on[i] = runs[i].direction == runs[(i + 1) % n].direction;
      // The chain from i on, if one begins there.
      for (std::size_t i = 0; i < n; ++i) {
        if (!goes_on[i] || goes_on[(i + n - 1) % n]) continue;
        std::size_t end = i + 1;
        while (goes_on[end % n] && end < i + n) ++end;
        const std::size_t last = past(r, runs[i].first, runs[end % n].last);
        if (deviation(grid_[r], runs[i].first, last) <= options_.tolerance / 2) continue;
        bool freed = false;
        for (std::size_t k = i; k <= end; ++k) freed = release(runs[k % n]) || freed;
        if (freed)
          for (std::size_t k = i; k < end; ++k) goes_on[k % n] = false;
        changed = changed || freed;  // if not, they are one line to within the table's steps
      }
      for (std::size_t i = 0; i < n; ++i)
        if (runs[i].direction == runs[(i + 1) % n].direction.reversed()) {
          const bool freed = release(runs[i]), freed_next = release(runs[(i + 1) % n]);
          if (!freed && !freed_next && !drop_shortest_of({{r, i}, {r, (i + 1) % n}})) {
            why_ = edge(r, runs[i].last - 1) + " and " + edge(r, runs[(i + 1) % n].first) + " meet at " +
                   place(point(r, runs[i].last)) +
                   " in a spike too sharp for exact lines; cut it off, or widen it to a millimetre";
            return false;
          }
          changed = true;
          if (!freed && !freed_next) break;  // the runs are no longer those
        }
      if (runs.size() != n) continue;
      const auto place_of = [&](const Run& run) { return static_cast<std::size_t>(&run - runs.data()); };
      if (join(r, [&](const Run& p, const Run&) { return static_cast<bool>(goes_on[place_of(p)]); })) changed = true;
      if (runs.size() < 3) {
        why_ = collapses(r);
        return false;
      }
    }
    return changed;
  }

  void place_corners() {
    corners_.assign(runs_.size(), {});
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const auto& runs = runs_[r];
      corners_[r].reserve(runs.size());
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run &p = runs[i > 0 ? i - 1 : runs.size() - 1], &m = runs[i];
        corners_[r].push_back(corner_between(p.direction, p.offset, m.direction, m.offset));
      }
    }
  }
  [[nodiscard]] auto end_of(std::size_t r, std::size_t i) const -> const Corner& {
    return corners_[r][i + 1 < corners_[r].size() ? i + 1 : 0];
  }
  /// Or nearly so.
  [[nodiscard]] auto turns_round(std::size_t r, std::size_t i, double least) const -> bool {
    return dot(runs_[r][i].direction.approximate(), end_of(r, i).at - corners_[r][i].at) < least;
  }

  /// A shared direction at a shallow turn can shift the corner far along the edge; such runs go back to their own.
  [[nodiscard]] auto release_displaced() -> bool {
    bool freed = false;
    displaced_.clear();
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      auto& runs = runs_[r];
      const std::size_t n = runs.size();
      for (std::size_t i = 0; i < n; ++i) {
        Run &before = runs[(i + n - 1) % n], &run = runs[i], &after = runs[(i + 1) % n];
        const double moved = length(corners_[r][i].at - point(r, run.first));
        const double side =
            std::min(length(metres(chord_of(grid_[r], run))), length(metres(chord_of(grid_[r], before))));
        const bool far = moved > std::min(options_.tolerance / 2, side / 4), round = turns_round(r, i, care_.least);
        if (far) displaced_.push_back({r, (i + n - 1) % n});
        if (far || round) freed = release(run) || freed;
        if (far || round) freed = release(before) || freed;
        if (round) freed = release(after) || freed;
      }
    }
    return freed;
  }

  /// Edges that would turn round even so are too short for their neighbours' lines: the shortest thereabouts goes, and
  /// its neighbours meet in one corner.
  [[nodiscard]] auto drop_turned() -> bool {
    std::vector<Place> candidates;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const std::size_t n = runs_[r].size();
      for (std::size_t i = 0; i < n; ++i)
        if (turns_round(r, i, care_.least)) {
          for (const std::size_t k : {(i + n - 1) % n, i, (i + 1) % n}) candidates.push_back({r, k});
          if (candidates.size() == 3)
            why_ = edge(r, runs_[r][i].first) + " near " + place(point(r, runs_[r][i].first)) +
                   " would turn round on exact lines; remove it, or make the place wider";
        }
    }
    if (candidates.empty() ||
        (!drop_shortest_of(candidates) && !join_straightest_of(candidates, 0.9 * options_.tolerance)))
      return false;
    why_.clear();
    return true;
  }
  /// Makes one run of one of these and its next, if all corners between are nearer to its chord than that.
  auto join_straightest_of(const std::vector<Place>& places, double least) -> bool {
    std::optional<Place> best;
    for (const Place p : places) {
      const auto& runs = runs_[p.ring];
      const Run &run = runs[p.run], &next = runs[(p.run + 1) % runs.size()];
      if (runs.size() <= 3 || dot(run.direction, next.direction) <= 0) continue;
      if (const double off = deviation(grid_[p.ring], run.first, past(p.ring, run.first, next.last)); off < least) {
        least = off;
        best = p;
      }
    }
    if (!best) return false;
    auto& runs = runs_[best->ring];
    const std::size_t gone = (best->run + 1) % runs.size();
    runs[best->run].last = past(best->ring, runs[best->run].first, runs[gone].last);
    runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(gone));
    return true;
  }
  /// The corner counted on until it comes after another.
  [[nodiscard]] auto past(std::size_t r, std::size_t first, std::size_t corner) const -> std::size_t {
    while (corner < first) corner += grid_[r].size();
    return corner;
  }
  auto drop_shortest_of(const std::vector<Place>& places) -> bool {
    if (places.empty()) return false;
    const auto squared = [&](Place p) {
      const GridPoint c = chord_of(grid_[p.ring], runs_[p.ring][p.run]);
      return dot(c, c);
    };
    const Place least = *std::ranges::min_element(places, {}, squared);
    auto& runs = runs_[least.ring];
    if (runs.size() <= 3) return false;
    if (length(metres(chord_of(grid_[least.ring], runs[least.run]))) > options_.tolerance / 2) return false;
    runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(least.run));
    ++dropped_;
    return true;
  }

  /// Bounds the Hausdorff distance; false, and why, when it is beyond tolerance.
  ///
  /// From the source: the distance to a segment is convex, so over a source edge it is greatest at an end. From a run's
  /// segment: above the stretch between the feet of the source's ends it crosses the source somewhere within the
  /// greatest distance of the corners between; past the feet, convexity again, to the source edge next to the corner.
  [[nodiscard]] auto measure() -> bool {
    out_.moved = 0;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const auto& runs = runs_[r];
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run &run = runs[i], &next = runs[(i + 1) % runs.size()];
        const Point2 a = corners_[r][i].at, b = end_of(r, i).at;
        double most = 0;
        for (std::size_t k = run.first; k <= run.last; ++k) most = std::max(most, distance_to(a, b, point(r, k)));
        const std::size_t gap_end = past(r, run.last, next.first);
        if (gap_end == run.last) {
          const Point2 before = point(r, run.last - 1), here = point(r, run.last), after = point(r, run.last + 1);
          most = std::max(most, std::max(distance_to(before, here, b), distance_to(here, after, b)));
        } else {  // of an edge that was dropped
          for (std::size_t k = run.last; k <= gap_end; ++k) most = std::max(most, length(b - point(r, k)));
        }
        if (most > options_.tolerance / 2) most = std::min(most, strays(r, i));
        if (most > out_.moved) {
          out_.moved = most;
          worst_ = {r, i};
        }
      }
    }
    if (out_.moved <= options_.tolerance) return true;
    const Run& run = runs_[worst_.ring][worst_.run];
    why_ = "on exact lines the outline would move by " + base::to_text(out_.moved, 3) + " m at " +
           edge(worst_.ring, run.first) + ", near " + place(point(worst_.ring, run.last)) +
           ", where edges are nearly parallel; straighten it there, or allow more tolerance";
    return false;
  }

  /// The same bound for run i and the source up to the next, nearer to the truth: a corner between nearly parallel
  /// edges may slide far along them without leaving them.
  [[nodiscard]] auto strays(std::size_t r, std::size_t i) const -> double {
    const auto& runs = runs_[r];
    const std::size_t n = runs.size();
    std::vector<geometry::Segment2> given, made, given_near;
    for (const std::size_t k : {(i + n - 1) % n, i, (i + 1) % n}) {
      made.push_back({corners_[r][k].at, end_of(r, k).at});
      const std::size_t to = past(r, runs[k].last, runs[(k + 1) % n].first);
      for (std::size_t e = runs[k].first; e < to; ++e) {
        given_near.push_back({point(r, e), point(r, e + 1)});
        if (k == i) given.push_back(given_near.back());
      }
    }
    const double enough = options_.tolerance / 2;
    double most = distance_bound(made[1], given_near, enough);
    for (const auto& edge : given) most = std::max(most, distance_bound(edge, made, enough));
    return most;
  }

  // ---- the footprint
  struct Stretch {
    std::uint32_t track;
    std::size_t edge;
    double from, to;  ///< along the line, quanta; whole but at the ends of the run
  };

  /// The stretches of one profile along a run. Those under `min_stretch` go to their neighbours, half each.
  [[nodiscard]] auto stretches(std::size_t r, std::size_t i) -> std::vector<Stretch> {
    const double least = options_.lines.min_stretch / quantum;
    const Run& run = runs_[r][i];
    const Point2 d = run.direction.approximate();
    const double start = dot(d, corners_[r][i].at) / quantum, end = dot(d, end_of(r, i).at) / quantum;
    std::vector<Stretch> all{{track(r, run.first), run.first, start, end}};
    for (std::size_t e = run.first + 1; e < run.last; ++e) {
      if (alike(track(r, e), all.back().track)) {
        name_after_lower(r, all.back(), e);
        continue;
      }
      const double w = std::clamp(std::nearbyint(dot(d, point(r, e)) / quantum), start, end);
      all.back().to = w;
      all.push_back({track(r, e), e, w, end});
    }
    const auto& profile = source_.rings[r].profile;
    for (std::size_t e = run.first + 1; e < run.last; ++e)
      if (profile[e % profile.size()] != profile[run.first % profile.size()]) out_.by_profiles = true;
    if (all.size() == 1) return all;
    std::vector<Stretch> kept;
    for (const Stretch& s : all)
      if (s.to - s.from >= least) kept.push_back(s);
    out_.tally.slivers += all.size() - kept.size();
    if (kept.empty()) {
      kept.push_back(*std::ranges::max_element(all, [](const Stretch& p, const Stretch& q) {
        return std::pair(p.to - p.from, q.track) < std::pair(q.to - q.from, p.track);
      }));
    }
    kept.front().from = start;
    kept.back().to = end;
    for (std::size_t k = 0; k + 1 < kept.size(); ++k)
      kept[k].to = kept[k + 1].from = std::nearbyint((kept[k].to + kept[k + 1].from) / 2);
    std::vector<Stretch> merged;
    for (const Stretch& s : kept)
      if (!merged.empty() && alike(merged.back().track, s.track)) {
        merged.back().to = s.to;
        name_after_lower(r, merged.back(), s.edge);
      } else {
        merged.push_back(s);
      }
    return merged;
  }
  /// Of profiles that climb alike the one with the lower number, whichever way round the ring is walked.
  void name_after_lower(std::size_t r, Stretch& stretch, std::size_t e) const {
    const auto& profile = source_.rings[r].profile;
    if (profile[e % profile.size()] >= profile[stretch.edge % profile.size()]) return;
    stretch.edge = e;
    stretch.track = track(r, e);
  }

  void write() {
    out_.rings.clear();
    out_.corners.clear();
    out_.tally = {};
    out_.tally.slivers = dropped_;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      std::vector<CanonicalEdge> edges;
      std::vector<ExactPoint> corners;
      for (std::size_t i = 0; i < runs_[r].size(); ++i) {
        const Run& run = runs_[r][i];
        const Direction& d = run.direction;
        const Rational offset = in_metres(run.offset);
        bool joint = false;
        for (const Stretch& s : stretches(r, i)) {
          const model::Provenance provenance{source_.rings[r].ring, source_.rings[r].edge[s.edge % grid_[r].size()], 0};
          if (joint) {
            const Rational w = in_metres(std::llrint(s.from));
            corners.push_back({(d.a * w - d.b * offset) / d.l, (d.b * w + d.a * offset) / d.l});
            ++out_.tally.joints;
          } else {
            corners.push_back(corners_[r][i].exact());
          }
          edges.push_back({d, offset, s.track, provenance, joint ? std::optional(corners.back()) : std::nullopt});
          joint = true;
        }
      }
      out_.rings.push_back(std::move(edges));
      out_.corners.push_back(std::move(corners));
    }
    count_merges();
  }
  void count_merges() {
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (const Run& run : runs_[r])
        for (std::size_t i = run.first + 1; i < run.last; ++i)
          ++(distance_to(point(r, i - 1), point(r, i + 1), point(r, i)) > on_chord ? out_.tally.straightened
                                                                                   : out_.tally.collinear);
  }

  const Source& source_;
  const Options& options_;
  Care care_;
  std::string& why_;
  Footprint out_;
  std::vector<GridRing> grid_;
  std::vector<std::uint32_t> track_of_profile_;
  std::vector<std::vector<Run>> runs_;
  std::vector<std::vector<Corner>> corners_;
  std::vector<Place> displaced_;  ///< runs whose end has moved far, sharing no directions
  Place worst_{0, 0};             ///< where the outline moves most
  std::size_t dropped_ = 0;
};

}  // namespace

auto put_on_lines(const Source& source, const Options& options, const Care& care, std::string& why)
    -> std::optional<Footprint> {
  why.clear();
  return Lines(source, options, care, why).make();
}

}  // namespace mansard::extrude::detail
