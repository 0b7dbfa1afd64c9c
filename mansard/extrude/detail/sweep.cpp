#include "mansard/extrude/detail/sweep.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "mansard/extrude/detail/wavefront.hpp"

namespace mansard::extrude::detail {
namespace {

/// Of a multiple of the grid below 2^39 quanta; reads the number alone, no arithmetic of GMP.
auto quanta_of(const Rational& metres) -> std::optional<std::int64_t> {
  constexpr long most = 1L << 39;
  const mpz_srcptr n = mpq_numref(metres.get_mpq_t()), d = mpq_denref(metres.get_mpq_t());
  if (!mpz_fits_slong_p(n) || !mpz_fits_slong_p(d)) return std::nullopt;
  const long over = mpz_get_si(n), under = mpz_get_si(d);
  if (under > quanta_per_metre || quanta_per_metre % under != 0) return std::nullopt;
  const long times = quanta_per_metre / under;
  if (over >= most / times || over <= -most / times) return std::nullopt;
  return over * times;
}

/// Of a number that must be whole.
auto whole_quanta(const Rational& metres) -> std::int64_t {
  if (const auto whole = quanta_of(metres)) return *whole;
  const Rational quanta = metres * quanta_per_metre;
  if (quanta.get_den() != 1 || bits_of(quanta.get_num()) > 40) throw Broken("a height off the grid");
  return quanta.get_num().get_si();
}

/// What a line does over the height: its track, and the part it is on.
struct Course {
  const CanonicalEdge* edge;
  const Track* track;
  std::size_t part = 0;

  [[nodiscard]] auto now() const -> const TrackPart& { return (*track)[part]; }
};

/// The height at which a line enters a part of its track.
struct TrackChange {
  std::int64_t height;
  std::uint32_t line, part;
  friend auto operator<=>(const TrackChange&, const TrackChange&) = default;
};

class Sweep {
 public:
  Sweep(const Footprint& footprint, const Rational& cap, const base::Run& run, const Eaves* eaves)
      : footprint_(footprint), cap_(whole_quanta(cap)), run_(run), eaves_(eaves), wave_(trace_) {
    wave_.now = fraction_of(0);
    wave_.horizon = static_cast<double>(cap_);
    moment_plane_ = trace_.planes.add(moment_plane(0));
  }

  auto surface() -> ExactSurface {
    lay_out();
    if (std::ranges::any_of(courses_, [](const Course& c) { return c.now().horizontal; })) set_back_at_the_ground();
    if (eaves_ != nullptr) draw_eaves();
    else draw_base();
    while (rise()) {
    }
    ExactSurface surface = trace_.assemble();
    surface.moments = steps_;
    return surface;
  }

 private:
  using Edges = std::vector<std::uint32_t>;

  /// One line per canonical edge; edges on one line with one track share a plane for ever.
  void lay_out() {
    const auto before = [](const CanonicalEdge* p, const CanonicalEdge* q) {
      return std::tie(p->direction, p->offset, p->track) < std::tie(q->direction, q->offset, q->track);
    };
    std::map<const CanonicalEdge*, std::uint32_t, decltype(before)> motions(before);
    for (std::size_t r = 0; r < footprint_.rings.size(); ++r) {
      const auto& ring = footprint_.rings[r];
      const auto size = static_cast<std::uint32_t>(ring.size());
      const auto first = static_cast<std::uint32_t>(wave_.edges.size());
      for (const CanonicalEdge& edge : ring) {
        const auto index = static_cast<std::uint32_t>(courses_.size());
        courses_.push_back({&edge, &footprint_.tracks[edge.track], 0});
        Line line;
        line.direction = edge.direction;
        line.motions = motions.try_emplace(&edge, static_cast<std::uint32_t>(motions.size())).first->second;
        wave_.add(std::move(line));
        // Where a roof overhangs, the sweep begins with it.
        const std::uint32_t begins = overhangs(r, static_cast<std::size_t>(&edge - ring.data())) ? 1 : 0;
        enter(index, begins);
        add_knots(index, begins);
        wave_.create(index, face_of(index));
      }
      for (std::uint32_t i = 0; i < size; ++i) {
        WaveEdge& e = wave_.edges[first + i];
        e.prev = first + (i + size - 1) % size;
        e.next = first + (i + 1) % size;
        if (const auto& joint = ring[i].joint) {
          const Direction& d = ring[i].direction;
          const Rational along = -(Rational(d.a) * joint->x + Rational(d.b) * joint->y) / d.l;
          e.joint = trace_.planes.add(plane_of(d.left(), along * quanta_per_metre, 0));
        }
      }
    }
    std::ranges::sort(knots_);
    for (const std::uint32_t i : wave_.alive()) wave_.changed(i);
  }

  /// Where a hole's edge goes on with another's roof, its knots after the first are the other's.
  void add_knots(std::uint32_t line, std::uint32_t begins) {
    const Course& course = courses_[line];
    if (const auto& roof = course.edge->roof) {
      knots_.push_back({whole_quanta((*course.track)[1].height), line, roof->part});
      const Track& track = footprint_.tracks[footprint_.rings[roof->ring][roof->edge].track];
      for (std::uint32_t part = roof->part + 1; part < track.size(); ++part)
        knots_.push_back({whole_quanta(track[part].height), line, part});
      return;
    }
    for (std::uint32_t part = begins + 1; part < course.track->size(); ++part)
      knots_.push_back({whole_quanta((*course.track)[part].height), line, part});
  }

  /// At its first knot such an edge becomes the other: they coincide for ever, and so do their faces.
  void go_on(std::uint32_t line) {
    Course& course = courses_[line];
    if (!course.edge->roof) return;
    const auto [ring, edge, part] = *course.edge->roof;
    std::size_t host = edge;  // lines are numbered as edges, ring by ring
    for (std::size_t r = 0; r < ring; ++r) host += footprint_.rings[r].size();
    course.edge = &footprint_.rings[ring][edge];
    course.track = &footprint_.tracks[course.edge->track];
    wave_.lines[line].motions = wave_.lines[host].motions;
  }

  [[nodiscard]] auto overhangs(std::size_t ring, std::size_t edge) const -> bool {
    return eaves_ != nullptr && eaves_->overhangs[ring][edge];
  }

  /// The line moves by this part of its track from now on.
  void enter(std::uint32_t line, std::size_t part) {
    Course& course = courses_[line];
    course.part = part;
    wave_.lines[line].speed = course.now().slope;
    wave_.lines[line].plane = plane_on(*course.edge, course.now());
  }
  auto plane_on(const CanonicalEdge& edge, const TrackPart& p) -> PlaneId {
    constexpr long most = 1L << 30;
    const mpz_srcptr run = mpq_numref(p.slope.get_mpq_t()), rise = mpq_denref(p.slope.get_mpq_t());
    const auto at = quanta_of(edge.offset), inward = quanta_of(p.inward), height = quanta_of(p.height);
    if (at && inward && height && mpz_cmp_si(run, most) < 0 && mpz_cmp_si(rise, most) < 0)
      return trace_.planes.add(plane_of(edge.direction, *at + *inward, *height, mpz_get_si(run), mpz_get_si(rise)));
    const Rational offset = (edge.offset + p.inward - p.slope * p.height) * quanta_per_metre;
    return trace_.planes.add(plane_of(edge.direction, offset, p.slope));
  }

  /// The course of a wavefront edge; connectors have none.
  [[nodiscard]] auto course_of(std::uint32_t edge) -> Course* {
    const std::uint32_t line = wave_.edges[edge].line;
    return line < courses_.size() ? &courses_[line] : nullptr;
  }

  auto face_of(std::uint32_t line) -> std::uint32_t {
    const Course& c = courses_[line];
    model::Provenance from = c.edge->provenance;
    from.part = c.now().part;
    return trace_.node({c.now().horizontal ? model::FaceKind::terrace : model::FaceKind::side, from, c.edge->direction,
                        c.now().slope});
  }

  /// A setback at height 0 has no thickness: the ground floor is what is left after it.
  void set_back_at_the_ground() {
    start_arcs();
    std::vector<std::uint32_t> entering(courses_.size(), none);
    for (std::uint32_t line = 0; line < courses_.size(); ++line)
      if (courses_[line].now().horizontal) entering[line] = 1;
    run_terraces(entering);
    trace_.forget_arcs();
    if (wave_.empty()) throw Broken("the setback at the ground leaves nothing");
  }

  void draw_base() {
    next_moment(fraction_of(0));
    start_arcs();
    const std::uint32_t base = trace_.node({model::FaceKind::base, {}, {}, 0});
    for (const std::uint32_t i : wave_.alive()) {
      const WaveEdge& e = wave_.edges[i];
      trace_.arc(e.origin, wave_.edges[e.next].origin, e.node, base);
    }
    wave_.connect_all();
  }

  /// Walls up to the soffit, the soffit, and the outline from which the roofs go on.
  void draw_eaves() {
    const PlaneId ground = moment_plane_;
    wave_.height = eaves_->soffit;
    next_moment(fraction_of(eaves_->soffit));
    moment_plane_ = trace_.planes.add(moment_plane(eaves_->soffit));
    const std::uint32_t base = trace_.node({model::FaceKind::base, {}, {}, 0});
    const std::uint32_t soffit = trace_.node({model::FaceKind::soffit, {}, {}, 0});
    start_arcs();
    std::uint32_t first = 0;  // edges are numbered as they were laid out
    for (std::size_t r = 0; r < footprint_.rings.size(); ++r) {
      const auto size = static_cast<std::uint32_t>(footprint_.rings[r].size());
      std::vector<PlaneId> walls;
      std::vector<std::uint32_t> wall_nodes, feet, tops;
      for (std::uint32_t i = 0; i < size; ++i) {
        const Course& c = courses_[wave_.edges[first + i].line];
        const bool out = overhangs(r, i);
        walls.push_back(out ? plane_on(*c.edge, c.track->front()) : wave_.plane_at(first + i));
        model::Provenance from = c.edge->provenance;
        from.part = c.track->front().part;
        wall_nodes.push_back(out ? trace_.node({model::FaceKind::side, from, c.edge->direction, 0})
                                 : wave_.edges[first + i].node);
      }
      for (std::uint32_t i = 0; i < size; ++i) {
        const PlaneId joint = wave_.edges[first + i].joint;
        const PlaneId before = joint != none ? joint : walls[(i + size - 1) % size];
        feet.push_back(trace_.point({{before, walls[i], ground}, false, 0}));
        tops.push_back(trace_.point({{before, walls[i], moment_plane_}, false, 0}));
      }
      for (std::uint32_t i = 0; i < size; ++i) {
        const std::uint32_t j = (i + 1) % size;
        const WaveEdge& e = wave_.edges[first + i];
        const std::uint32_t start = e.origin, end = wave_.edges[first + j].origin;
        trace_.arc(feet[i], feet[j], wall_nodes[i], base);
        trace_.arc(feet[i], tops[i], wall_nodes[(i + size - 1) % size], wall_nodes[i]);
        if (overhangs(r, i)) {
          trace_.arc(tops[i], tops[j], soffit, wall_nodes[i]);
          trace_.arc(start, end, e.node, soffit);
        } else {
          trace_.arc(start, tops[i], e.node, soffit);
          trace_.arc(tops[j], end, e.node, soffit);
        }
      }
      first += size;
    }
    wave_.connect_all();
  }

  /// Every vertex begins its arc here and now.
  void start_arcs() {
    for (const std::uint32_t i : wave_.alive()) {
      WaveEdge& e = wave_.edges[i];
      e.origin = trace_.point({{wave_.start_plane(i), wave_.plane_at(i), moment_plane_}, false, 0});
      e.origin_moment = wave_.moment;
      e.origin_level = wave_.level;
    }
  }

  void next_moment(Fraction time) {
    wave_.now = std::move(time);
    ++wave_.moment;
  }

  /// On to the next knot or the cap; false when nothing is left to raise.
  auto rise() -> bool {
    while (knot_ < knots_.size() && knots_[knot_].height <= wave_.height) ++knot_;
    const std::int64_t limit = knot_ < knots_.size() ? std::min(cap_, knots_[knot_].height) : cap_;
    const Fraction end = fraction_of(limit);
    if (!pass_events(end, [&] { ++wave_.level; })) return false;
    wave_.height = limit;
    moment_plane_ = trace_.planes.add(moment_plane(limit));
    if (limit == cap_) {
      close_with_cap();
      return false;
    }
    pass_knots();
    return !wave_.empty();
  }

  /// All events up to `end`, where the wavefront then is; those at `end` wait to be connected until it is known how
  /// things go on. False when nothing is left.
  template <class Rising>
  auto pass_events(const Fraction& end, Rising rising) -> bool {
    bool at_end = false;
    for (Fraction when; !at_end;) {
      const auto contacts = wave_.next_contacts(end, when);
      count_step();
      at_end = contacts.empty() || trace_.planes.compare(when, end) == 0;
      rising();
      next_moment(contacts.empty() ? end : when);
      if (contacts.empty()) break;
      wave_.snapshot(contacts);
      if (wave_.empty()) return false;
      if (!at_end) wave_.connect_pending();
    }
    return true;
  }

  /// Geometric events have come first; now terraces, then new speeds.
  void pass_knots() {
    std::vector<std::uint32_t> entering(courses_.size(), none);  // by line: the part
    bool terraces = false;
    for (; knot_ < knots_.size() && knots_[knot_].height == wave_.height; ++knot_) {
      const TrackChange& k = knots_[knot_];
      go_on(k.line);
      if ((*courses_[k.line].track)[k.part].horizontal) {
        courses_[k.line].part = k.part;
        terraces = true;
      }
      entering[k.line] = k.part;
    }
    if (terraces) run_terraces(entering);
    else enter_parts(entering);
  }

  [[nodiscard]] auto edges_where(const auto& line_is) const -> Edges {
    Edges found;
    for (const std::uint32_t i : wave_.alive())
      if (const std::uint32_t line = wave_.edges[i].line; line < courses_.size() && line_is(line)) found.push_back(i);
    return found;
  }

  /// Of a line on a terrace.
  [[nodiscard]] auto motion_of(std::uint32_t line) -> TerraceMotion {
    const Course& c = courses_[line];
    const Rational offset = (c.edge->offset + c.now().inward) * quanta_per_metre, run = c.now().run * quanta_per_metre;
    return {trace_.planes.add(plane_of(c.edge->direction, offset, run)), c.now().run};
  }

  /// Terraces run at one height in a second time τ from 0 to 1: only they move, at the speed of their run.
  void run_terraces(const std::vector<std::uint32_t>& entering) {
    trace_.cut_at(wave_.height);
    const auto runs = [&](std::uint32_t line) { return courses_[line].now().horizontal; };
    const Edges terraces = edges_where(runs);
    change_faces(terraces);
    std::map<std::uint32_t, TerraceMotion> moving;
    for (const std::uint32_t i : terraces)
      if (const std::uint32_t line = wave_.edges[i].line; !moving.contains(line)) moving[line] = motion_of(line);
    bool left = false;
    wave_.run_terraces(moving, [&] {
      wave_.connect_all();
      left = pass_events(fraction_of(1), [] {});
      moment_plane_ = trace_.planes.add(moment_plane(1));
      if (left) change_faces_to(entering);
    });
    moment_plane_ = trace_.planes.add(moment_plane(wave_.height));
    if (left) enter_speeds(entering);
  }

  void enter_parts(const std::vector<std::uint32_t>& entering) {
    change_faces_to(entering);
    enter_speeds(entering);
  }

  void change_faces_to(const std::vector<std::uint32_t>& entering) {
    for (std::uint32_t line = 0; line < courses_.size(); ++line)
      if (entering[line] != none) courses_[line].part = entering[line];
    change_faces(edges_where([&](std::uint32_t line) { return entering[line] != none; }));
  }

  void enter_speeds(const std::vector<std::uint32_t>& entering) {
    std::vector<bool> entered(courses_.size(), false);
    for (const std::uint32_t i : edges_where([&](std::uint32_t line) { return entering[line] != none; })) {
      const std::uint32_t line = wave_.edges[i].line;
      if (!entered[line]) enter(line, entering[line]);
      entered[line] = true;
      wave_.changed(i);
    }
    wave_.connect_all();
  }

  /// The faces of these edges end here and those of their courses' present parts begin.
  void change_faces(const Edges& changed) {
    for (const std::uint32_t i : changed) {
      wave_.close_arc(i, moment_plane_);
      wave_.close_arc(wave_.edges[i].next, moment_plane_);
    }
    for (const std::uint32_t i : changed) {
      WaveEdge& e = wave_.edges[i];
      const std::uint32_t face = face_of(e.line);
      trace_.arc(e.origin, wave_.edges[e.next].origin, face, e.node);
      e.node = face;
    }
  }

  void close_with_cap() {
    const std::uint32_t cap = trace_.node({model::FaceKind::cap, {}, {}, 0});
    const Edges all = wave_.alive();
    for (const std::uint32_t i : all) wave_.close_arc(i, moment_plane_);
    for (const std::uint32_t i : all) {
      const WaveEdge& e = wave_.edges[i];
      trace_.arc(e.origin, wave_.edges[e.next].origin, cap, e.node);
    }
  }

  /// Every event removes an edge or splits a loop, so the steps are bounded; this only guards against a fault.
  void count_step() {
    if (++steps_ > 1000 + 100 * courses_.size()) throw Broken("the sweep does not end");
    if (run_.cancelled()) throw Broken("cancelled");
  }

  const Footprint& footprint_;
  const std::int64_t cap_;
  const base::Run& run_;
  const Eaves* eaves_;
  std::size_t steps_ = 0, knot_ = 0;
  std::vector<Course> courses_;  ///< of the lines that are not connectors, which come first
  std::vector<TrackChange> knots_;
  PlaneId moment_plane_ = none;
  Trace trace_;
  Wavefront wave_;
};

}  // namespace

auto sweep(const Footprint& footprint, const Rational& cap, const base::Run& run, const Eaves* eaves) -> ExactSurface {
  return Sweep(footprint, cap, run, eaves).surface();
}

}  // namespace mansard::extrude::detail
