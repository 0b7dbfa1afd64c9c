#include "mansard/extrude/detail/sweep.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "mansard/extrude/detail/wavefront.hpp"

namespace mansard::extrude::detail {
namespace {

/// What a line does over the height: its track, and the part it is on.
struct Course {
  const CanonicalEdge* edge;
  const Track* track;
  std::size_t part = 0;
  Rational C, S;  ///< the line's motion over the height on that part, scaled

  [[nodiscard]] auto now() const -> const TrackPart& { return (*track)[part]; }
  /// The height where the present part ends; the last never does.
  [[nodiscard]] auto knot() const -> const Rational* {
    return part + 1 < track->size() ? &(*track)[part + 1].height : nullptr;
  }
  void enter(std::size_t next) {
    part = next;
    const TrackPart& p = now();
    const Rational l(edge->direction.l);
    S = l * p.slope;
    C = l * (edge->offset + p.inward - p.slope * p.height);
  }
};

class Sweep {
 public:
  Sweep(const Footprint& footprint, Rational cap, const base::Run& run)
      : footprint_(footprint), cap_(std::move(cap)), run_(run), wave_(lines_, trace_) {}

  auto surface() -> ExactSurface {
    lay_out();
    if (starts_with_terrace()) set_back_at_the_ground();
    draw_base();
    while (rise()) {
    }
    return assemble(trace_);
  }

 private:
  using Edges = std::vector<std::uint32_t>;

  /// One line per canonical edge; edges on one line with one track share a plane for ever.
  void lay_out() {
    std::map<std::tuple<Direction, std::pair<mpz_class, mpz_class>, std::uint32_t>, std::uint32_t> planes;
    for (std::size_t r = 0; r < footprint_.rings.size(); ++r) {
      const auto& ring = footprint_.rings[r];
      const auto first = static_cast<std::uint32_t>(wave_.edges.size()), size = static_cast<std::uint32_t>(ring.size());
      for (std::uint32_t i = 0; i < size; ++i) {
        const CanonicalEdge& edge = ring[i];
        Course course{&edge, &footprint_.tracks[edge.track], 0, {}, {}};
        course.enter(0);
        Line line;
        line.direction = edge.direction;
        line.plane = planes
                         .try_emplace({edge.direction, {edge.offset.get_num(), edge.offset.get_den()}, edge.track},
                                      static_cast<std::uint32_t>(planes.size()))
                         .first->second;
        line.move(course.C, course.S);
        WaveEdge e;
        e.line = static_cast<std::uint32_t>(lines_.size());
        e.prev = first + (i + size - 1) % size;
        e.next = first + (i + 1) % size;
        e.start = footprint_.corners[r][i];
        e.origin = trace_.point(*e.start, z_);
        lines_.push_back(std::move(line));
        courses_.push_back(std::move(course));
        e.node = face_of(e.line);
        wave_.edges.push_back(std::move(e));
      }
    }
  }

  /// The course of a wavefront edge; connectors have none.
  [[nodiscard]] auto course_of(std::uint32_t edge) -> Course* {
    const std::uint32_t line = wave_.edges[edge].line;
    return line < courses_.size() ? &courses_[line] : nullptr;
  }

  auto face_of(std::uint32_t line) -> std::uint32_t {
    const Course& c = courses_[line];
    Provenance from = c.edge->provenance;
    from.part = c.now().part;
    return trace_.node(
        {c.now().horizontal ? FaceKind::terrace : FaceKind::side, from, c.edge->direction, c.now().slope});
  }

  [[nodiscard]] auto starts_with_terrace() const -> bool {
    return std::ranges::any_of(courses_, [](const Course& c) { return c.now().horizontal; });
  }

  /// A setback at height 0 has no thickness: the ground floor is what is left after it.
  void set_back_at_the_ground() {
    Edges all;
    for (std::uint32_t i = 0; i < wave_.edges.size(); ++i)
      if (course_of(i)->now().horizontal) all.push_back(i);
    run_terraces(all);
    trace_.forget_arcs();
    if (wave_.edges.empty()) throw Broken("the setback at the ground leaves nothing");
  }

  void draw_base() {
    const std::uint32_t base = trace_.node({FaceKind::base, {}, {}, 0});
    for (std::uint32_t i = 0; i < wave_.edges.size(); ++i)
      wave_.edges[i].origin = trace_.point(wave_.start_of(i, z_), z_);
    for (const WaveEdge& e : wave_.edges) trace_.arc(e.origin, wave_.edges[e.next].origin, e.node, base);
    wave_.connect();
  }

  /// On to the next critical height; false when nothing is left to raise.
  auto rise() -> bool {
    Rational limit = cap_;
    for (std::uint32_t i = 0; i < wave_.edges.size(); ++i)
      if (const Course* c = course_of(i))
        if (const Rational* knot = c->knot(); knot != nullptr && *knot < limit) limit = *knot;
    const auto event = wave_.next_event(z_, limit);
    z_ = event ? *event : limit;
    count_step();
    wave_.snapshot(z_, z_);
    if (wave_.edges.empty()) return false;
    if (z_ == cap_) {
      close_with_cap();
      return false;
    }
    pass_knots();
    if (wave_.edges.empty()) return false;
    wave_.connect();
    return true;
  }

  /// Geometric events come first (the snapshot), then terraces, then new speeds.
  void pass_knots() {
    Edges terraces;
    for (std::uint32_t i = 0; i < wave_.edges.size(); ++i) {
      Course* c = course_of(i);
      if (c != nullptr && at_knot(*c) && (*c->track)[c->part + 1].horizontal) terraces.push_back(i);
    }
    if (!terraces.empty()) {
      for (const std::uint32_t i : terraces)
        if (Course* c = course_of(i); !c->now().horizontal) ++c->part;
      run_terraces(terraces);
      return;
    }
    enter_new_parts(z_);
  }

  [[nodiscard]] auto at_knot(const Course& c) const -> bool {
    const Rational* knot = c.knot();
    return knot != nullptr && *knot == z_;
  }

  /// Terraces run at one height in a second time τ from 0 to 1: only they move, at the speed of their run.
  void run_terraces(const Edges& terraces) {
    trace_.cut_at(z_);
    change_faces(terraces, z_);
    for (std::uint32_t i = 0; i < lines_.size(); ++i) {
      Line& line = lines_[i];
      Rational here = line.C + line.S * z_;
      const bool runs = i < courses_.size() && courses_[i].now().horizontal;
      line.move(std::move(here), runs ? Rational(courses_[i].now().run * courses_[i].edge->direction.l) : Rational(0));
    }
    wave_.connect();
    const Rational end = 1;
    for (Rational tau = 0; tau < end;) {
      const auto event = wave_.next_event(tau, end);
      tau = event ? *event : end;
      count_step();
      wave_.snapshot(tau, z_);
      if (wave_.edges.empty()) return;
      if (tau < end) wave_.connect();
    }
    enter_new_parts(end);
  }

  /// New faces and speeds for edges whose part ends at this height; `t` is the wavefront's time, z or τ.
  void enter_new_parts(const Rational& t) {
    std::vector<std::size_t> next(courses_.size());
    Edges changed;
    for (std::uint32_t line = 0; line < courses_.size(); ++line) {
      const Course& c = courses_[line];
      next[line] = c.now().horizontal || at_knot(c) ? c.part + 1 : c.part;
    }
    for (std::uint32_t i = 0; i < wave_.edges.size(); ++i)
      if (const Course* c = course_of(i); c != nullptr && next[wave_.edges[i].line] != c->part) changed.push_back(i);
    for (std::uint32_t line = 0; line < courses_.size(); ++line)
      if (next[line] != courses_[line].part) courses_[line].enter(next[line]);
    change_faces(changed, t);
    for (std::uint32_t line = 0; line < courses_.size(); ++line) lines_[line].move(courses_[line].C, courses_[line].S);
  }

  /// The faces of these edges end here and those of their courses' present parts begin.
  void change_faces(const Edges& changed, const Rational& t) {
    std::vector<bool> ends(wave_.edges.size(), false);
    for (const std::uint32_t i : changed) ends[i] = ends[wave_.edges[i].next] = true;
    for (std::uint32_t i = 0; i < ends.size(); ++i)
      if (ends[i]) wave_.close_arc(i, t, z_);
    for (const std::uint32_t i : changed) {
      WaveEdge& e = wave_.edges[i];
      const std::uint32_t face = face_of(e.line);
      trace_.arc(e.origin, wave_.edges[e.next].origin, face, e.node);
      e.node = face;
    }
  }

  void close_with_cap() {
    const std::uint32_t cap = trace_.node({FaceKind::cap, {}, {}, 0});
    for (std::uint32_t i = 0; i < wave_.edges.size(); ++i) wave_.close_arc(i, z_, z_);
    for (const WaveEdge& e : wave_.edges) trace_.arc(e.origin, wave_.edges[e.next].origin, cap, e.node);
  }

  /// Every event removes an edge or splits a loop, so the steps are bounded; this only guards against a fault.
  void count_step() {
    if (++steps_ > 1000 + 100 * footprint_size()) throw Broken("the sweep does not end");
    if (run_.cancelled()) throw Broken("cancelled");
  }
  [[nodiscard]] auto footprint_size() const -> std::size_t { return courses_.size(); }

  const Footprint& footprint_;
  const Rational cap_;
  const base::Run& run_;
  Rational z_ = 0;
  std::size_t steps_ = 0;
  std::vector<Line> lines_;
  std::vector<Course> courses_;  ///< of the lines that are not connectors, which come first
  Trace trace_;
  Wavefront wave_;
};

}  // namespace

auto sweep(const Footprint& footprint, const Rational& cap, const base::Run& run) -> ExactSurface {
  return Sweep(footprint, cap, run).surface();
}

}  // namespace mansard::extrude::detail
