#include "mansard/extrude/detail/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mansard::extrude::detail {

using geometry::Point2;

auto track_of(const geometry::Profile& profile) -> Track {
  // Knots on a straight run change nothing; within four quanta of the chord they are rounding, not design.
  constexpr double straight = 4 * quantum;
  std::vector<std::size_t> knots{0};
  while (knots.back() + 1 < profile.size()) {
    const std::size_t from = knots.back();
    const auto chord_holds = [&](std::size_t to) {
      const Point2 a{profile[from].inward, profile[from].height}, b{profile[to].inward, profile[to].height};
      for (std::size_t i = from + 1; i < to; ++i)
        if (geometry::distance({a, b}, {profile[i].inward, profile[i].height}) > straight) return false;
      return true;
    };
    std::size_t to = from + 1;
    while (to + 1 < profile.size() && chord_holds(to + 1)) ++to;
    knots.push_back(to);
  }
  Track track;
  Rational inward = 0, height = 0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Rational next_inward = on_grid(profile[knots[i + 1]].inward),
                   next_height = on_grid(profile[knots[i + 1]].height);
    const Rational run = next_inward - inward, rise = next_height - height;
    if (run == 0 && rise == 0) continue;
    TrackPart part{inward, height, 0, rise == 0, 0, static_cast<std::uint32_t>(knots[i])};
    if (part.horizontal) part.run = run;
    else part.slope = run / rise;
    // Rounding can make neighbours alike that were not.
    const bool alike =
        !track.empty() &&
        (part.horizontal ? track.back().horizontal : !track.back().horizontal && track.back().slope == part.slope);
    if (alike) track.back().run += part.run;
    else track.push_back(part);
    inward = next_inward;
    height = next_height;
  }
  if (track.empty() || track.back().horizontal)
    track.push_back({inward, height, 0, false, 0, static_cast<std::uint32_t>(profile.size() - 2)});
  return track;
}

void shorten_runs(std::vector<Track>& tracks) {
  const Rational less(1023, 1024);
  for (Track& track : tracks)
    for (TrackPart& part : track) {
      part.inward *= less;
      part.slope *= less;
      part.run *= less;
    }
}

namespace {

/// A stretch of the source ring that becomes one line.
struct Run {
  std::size_t first = 0, last = 0;  ///< source corners, `last` counted on past the end of the ring
  bool own_direction = false;       ///< not to share its direction with others
  Direction direction;
  Rational offset;
};

auto turn_between(Point2 before, Point2 after) -> double {
  return std::atan2(cross(before, after), dot(before, after));
}

class Canon {
 public:
  Canon(const Source& source, const Options& options, std::string& why)
      : source_(source), options_(options), why_(why) {}

  auto make() -> std::optional<Footprint> {
    const auto box = geometry::bounds(source_.rings[0].points);
    out_.origin = {std::floor(box.least.x), std::floor(box.least.y)};
    gather_tracks();
    runs_.clear();
    for (std::size_t r = 0; r < source_.rings.size(); ++r) {
      runs_.push_back(straighten(r));
      if (runs_.back().size() < 3) return refuse("a ring has fewer than three sides once straightened");
    }
    // Every round merges two runs or gives one its own direction, so this ends.
    for (;;) {
      share_directions();
      if (merge_parallel_neighbours()) continue;
      if (!why_.empty()) return std::nullopt;
      place_lines();
      if (free_displaced_runs()) continue;
      if (!why_.empty()) return std::nullopt;
      break;
    }
    for (std::size_t r = 0; r < runs_.size(); ++r) write_ring(r);
    if (!is_proper()) return refuse("the footprint on exact lines would not be simple");
    return std::move(out_);
  }

 private:
  auto refuse(std::string why) -> std::nullopt_t {
    why_ = std::move(why);
    return std::nullopt;
  }

  [[nodiscard]] auto point(std::size_t r, std::size_t i) const -> Point2 {
    const auto& points = source_.rings[r].points;
    return points[i % points.size()] - out_.origin;
  }
  [[nodiscard]] auto chord(std::size_t r, const Run& run) const -> Point2 {
    return point(r, run.last) - point(r, run.first);
  }
  [[nodiscard]] auto track(std::size_t r, std::size_t edge) const -> std::uint32_t {
    const auto& ring = source_.rings[r];
    return track_of_profile_[ring.profile[edge % ring.profile.size()]];
  }

  void gather_tracks() {
    for (const auto& profile : source_.profiles) {
      Track t = track_of(profile);
      const auto same = std::ranges::find(out_.tracks, t);
      track_of_profile_.push_back(static_cast<std::uint32_t>(same - out_.tracks.begin()));
      if (same == out_.tracks.end()) out_.tracks.push_back(std::move(t));
    }
  }

  /// Corners are turns of merge_angle and more, and where a run of lesser turns would bend away from its chord.
  auto straighten(std::size_t r) -> std::vector<Run> {
    const std::size_t n = source_.rings[r].points.size();
    std::vector<std::size_t> corners;
    for (std::size_t i = 0; i < n; ++i) {
      const double turn = turn_between(point(r, i) - point(r, i + n - 1), point(r, i + 1) - point(r, i));
      if (std::abs(turn) >= options_.merge_angle) corners.push_back(i);
    }
    if (corners.empty()) {
      std::size_t least = 0;
      for (std::size_t i = 1; i < n; ++i)
        if (point(r, i) < point(r, least)) least = i;
      corners.push_back(least);
    }
    if (corners.size() == 1) {
      std::size_t far = corners[0];
      for (std::size_t i = 0; i < n; ++i)
        if (length(point(r, i) - point(r, corners[0])) > length(point(r, far) - point(r, corners[0]))) far = i;
      corners.push_back(far);
      std::ranges::sort(corners);
    }
    std::vector<Run> runs;
    for (std::size_t c = 0; c < corners.size(); ++c)
      split(r, corners[c], c + 1 < corners.size() ? corners[c + 1] : corners[0] + n, runs);
    return runs;
  }

  /// Douglas and Peucker's rule.
  void split(std::size_t r, std::size_t first, std::size_t last, std::vector<Run>& runs) const {
    const double allowed = options_.tolerance / 2;  // the rest is for the lines' rounding
    double most = 0;
    std::size_t far = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d = geometry::distance({point(r, first), point(r, last)}, point(r, i));
      if (d > most) {
        most = d;
        far = i;
      }
    }
    if (most <= allowed) {
      runs.push_back({first, last, false, {}, {}});
      return;
    }
    split(r, first, far, runs);
    split(r, far, last, runs);
  }

  /// Longest first, each run takes the direction of an earlier one (or its perpendicular or opposite) where that moves
  /// its ends by less than a millimetre; otherwise its own becomes available.
  void share_directions() {
    constexpr double end_may_move = 1e-3, most_turn = 0.02;
    struct Entry {
      double length, angle;
      std::size_t ring, run;
    };
    std::vector<Entry> order;
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (std::size_t i = 0; i < runs_[r].size(); ++i) {
        const Point2 c = chord(r, runs_[r][i]);
        order.push_back({length(c), std::atan2(c.y, c.x), r, i});
      }
    std::ranges::sort(order, [](const Entry& p, const Entry& q) {
      // Lengths that differ by rounding only must not decide.
      const auto lp = std::llround(p.length * 1e6), lq = std::llround(q.length * 1e6);
      return std::tie(lq, p.angle, p.ring, p.run) < std::tie(lp, q.angle, q.ring, q.run);
    });
    std::vector<Direction> known;
    for (const Entry& entry : order) {
      Run& run = runs_[entry.ring][entry.run];
      const Point2 c = chord(entry.ring, run);
      run.direction = direction_of(bearing_of(c));
      if (!run.own_direction) {
        double least = std::min(most_turn, 2 * end_may_move / entry.length);
        Direction best = run.direction;
        for (Direction d : known)
          for (int quarter = 0; quarter < 4; ++quarter, d = d.left()) {
            const Point2 u = d.approximate();
            if (dot(u, c) <= 0) continue;
            const double off = std::abs(turn_between(u, c));
            if (off < least) {
              least = off;
              best = d;
            }
          }
        run.direction = best;
      }
      known.push_back(run.direction);
    }
  }

  [[nodiscard]] auto merge_parallel_neighbours() -> bool {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      auto& runs = runs_[r];
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::size_t j = (i + 1) % runs.size();
        if (cross(runs[i].direction, runs[j].direction) != 0) continue;
        if (runs[i].direction != runs[j].direction) {
          if (runs[i].own_direction && runs[j].own_direction) {
            why_ = "the footprint has a spike";
            return false;
          }
          runs[i].own_direction = runs[j].own_direction = true;
          return true;
        }
        if (runs.size() <= 3) {
          why_ = "a ring has fewer than three sides once straightened";
          return false;
        }
        const std::size_t n = source_.rings[r].points.size();
        const std::size_t span = runs[j].last - runs[j].first;
        runs[i].last += span;
        runs[i].own_direction = runs[i].own_direction || runs[j].own_direction;
        runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(j));
        for (Run& run : runs)
          if (run.first >= n) {
            run.first -= n;
            run.last -= n;
          }
        return true;
      }
    }
    return false;
  }

  void place_lines() {
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (Run& run : runs_[r]) {
        const Point2 middle = 0.5 * (point(r, run.first) + point(r, run.last));
        run.offset = on_grid(dot(left_of(run.direction.approximate()), middle));
      }
  }

  /// The corner where the run starts.
  [[nodiscard]] auto corner(std::size_t r, std::size_t i) const -> ExactPoint {
    const auto& runs = runs_[r];
    const Run &p = runs[(i + runs.size() - 1) % runs.size()], &m = runs[i];
    const Rational divisor(to_integer(cross(p.direction, m.direction)));
    const Rational rp = p.offset * p.direction.l, rm = m.offset * m.direction.l;
    return {(rp * m.direction.a - rm * p.direction.a) / divisor, (rp * m.direction.b - rm * p.direction.b) / divisor};
  }

  [[nodiscard]] static auto along(const Direction& d, const ExactPoint& p) -> Rational {
    return Rational(d.a) * p.x + Rational(d.b) * p.y;
  }

  /// A shared direction at a shallow turn can shift the corner far along the edge; such runs go back to their own.
  [[nodiscard]] auto free_displaced_runs() -> bool {
    bool freed = false;
    out_.moved = 0;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      auto& runs = runs_[r];
      const std::size_t n = runs.size();
      std::vector<ExactPoint> corners;
      for (std::size_t i = 0; i < n; ++i) corners.push_back(corner(r, i));
      const auto release = [&](std::size_t i) {
        if (!runs[i].own_direction) freed = runs[i].own_direction = true;
      };
      for (std::size_t i = 0; i < n; ++i) {
        const Point2 now{corners[i].x.get_d(), corners[i].y.get_d()};
        const double moved = length(now - point(r, runs[i].first));
        const double short_side = std::min(length(chord(r, runs[i])), length(chord(r, runs[(i + n - 1) % n])));
        if (moved > std::min(options_.tolerance / 2, short_side / 4)) {
          release(i);
          release((i + n - 1) % n);
        }
        out_.moved = std::max(out_.moved, moved);
      }
      for (std::size_t i = 0; i < n; ++i)
        if (along(runs[i].direction, corners[(i + 1) % n]) <= along(runs[i].direction, corners[i])) {
          for (const std::size_t k : {i, (i + 1) % n, (i + n - 1) % n}) release(k);
          if (!freed) why_ = "an edge would turn round on exact lines";
        }
    }
    if (freed) {
      why_.clear();
      return true;
    }
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (const Run& run : runs_[r])
        for (std::size_t i = run.first + 1; i < run.last; ++i)
          out_.moved = std::max(out_.moved,
                                std::abs(dot(left_of(run.direction.approximate()), point(r, i)) - run.offset.get_d()));
    if (why_.empty() && out_.moved > options_.tolerance) why_ = "a corner would move by more than the tolerance";
    return false;
  }

  /// One edge per stretch of one track; between stretches of one run a joint at whole quanta along the line.
  void write_ring(std::size_t r) {
    const auto& source = source_.rings[r];
    std::vector<CanonicalEdge> edges;
    std::vector<ExactPoint> corners;
    for (std::size_t i = 0; i < runs_[r].size(); ++i) {
      const Run& run = runs_[r][i];
      const Direction& d = run.direction;
      const ExactPoint start = corner(r, i), end = corner(r, (i + 1) % runs_[r].size());
      const auto add = [&](std::size_t edge, const ExactPoint& from, bool joint) {
        const Provenance provenance{static_cast<std::uint32_t>(r), source.edge[edge % source.edge.size()], 0};
        edges.push_back({d, run.offset, track(r, edge), provenance, joint ? std::optional(from) : std::nullopt});
        corners.push_back(from);
      };
      add(run.first, start, false);
      const Rational least(1, 1024);  // m; shorter stretches are left to their neighbours
      Rational last = along(d, start) / d.l;
      const Rational most = along(d, end) / d.l - least;
      for (std::size_t e = run.first + 1; e < run.last; ++e) {
        if (track(r, e) == edges.back().track) continue;
        const Rational w = on_grid(dot(d.approximate(), point(r, e)));
        if (w >= most) break;
        if (w < last + least) {  // the stretch so far has no length: this one takes its place
          edges.back().track = track(r, e);
          edges.back().provenance.edge = source.edge[e % source.edge.size()];
          continue;
        }
        add(e, {(d.a * w - d.b * run.offset) / d.l, (d.b * w + d.a * run.offset) / d.l}, true);
        last = w;
      }
    }
    out_.rings.push_back(std::move(edges));
    out_.corners.push_back(std::move(corners));
  }

  /// Simple, and every ring still the right way round; exact where boxes of doubles leave it open.
  [[nodiscard]] auto is_proper() const -> bool {
    struct Edge {
      const ExactPoint *a, *b;
      geometry::Box2 box;
      std::size_t ring, index, size;
    };
    std::vector<Edge> edges;
    for (std::size_t r = 0; r < out_.corners.size(); ++r) {
      const auto& ring = out_.corners[r];
      geometry::Ring rounded;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        Edge e{&ring[i], &ring[(i + 1) % ring.size()], {}, r, i, ring.size()};
        rounded.push_back({e.a->x.get_d(), e.a->y.get_d()});
        e.box.add(rounded.back());
        e.box.add({e.b->x.get_d(), e.b->y.get_d()});
        e.box = e.box.grown(1e-6);
        edges.push_back(std::move(e));
      }
      if ((geometry::signed_area(rounded) > 0) != (r == 0)) return false;
    }
    std::ranges::sort(edges, [](const Edge& p, const Edge& q) {
      return std::tie(p.box.least.x, p.ring, p.index) < std::tie(q.box.least.x, q.ring, q.index);
    });
    const auto turn = [](const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
      return sgn(Rational((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)));
    };
    const auto on = [](const ExactPoint& a, const ExactPoint& b, const ExactPoint& p) {
      return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
             p.y <= std::max(a.y, b.y);
    };
    for (std::size_t i = 0; i < edges.size(); ++i)
      for (std::size_t j = i + 1; j < edges.size() && edges[j].box.least.x <= edges[i].box.most.x; ++j) {
        const Edge &p = edges[i], &q = edges[j];
        if (!p.box.overlaps(q.box)) continue;
        const bool neighbours =
            p.ring == q.ring && ((p.index + 1) % p.size == q.index || (q.index + 1) % q.size == p.index);
        if (neighbours) continue;  // not parallel, or one after the other on one line: they share one point
        const int p1 = turn(*q.a, *q.b, *p.a), p2 = turn(*q.a, *q.b, *p.b), q1 = turn(*p.a, *p.b, *q.a),
                  q2 = turn(*p.a, *p.b, *q.b);
        if (p1 * p2 < 0 && q1 * q2 < 0) return false;
        if ((p1 == 0 && on(*q.a, *q.b, *p.a)) || (p2 == 0 && on(*q.a, *q.b, *p.b)) ||
            (q1 == 0 && on(*p.a, *p.b, *q.a)) || (q2 == 0 && on(*p.a, *p.b, *q.b)))
          return false;
      }
    return true;
  }

  const Source& source_;
  const Options& options_;
  std::string& why_;
  Footprint out_;
  std::vector<std::uint32_t> track_of_profile_;
  std::vector<std::vector<Run>> runs_;
};

}  // namespace

auto canonical(const Source& source, const Options& options, std::string& why) -> std::optional<Footprint> {
  why.clear();
  return Canon(source, options, why).make();
}

}  // namespace mansard::extrude::detail
