// The wavefront: closed loops of moving lines, between one critical moment and the next.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "mansard/extrude/detail/plane.hpp"
#include "mansard/extrude/detail/surface.hpp"

namespace mansard::extrude::detail {

/// A moving line of the wavefront; several edges can lie on it.
struct Line {
  Direction direction;
  PlaneId plane = none;                       ///< of its motion over the height
  Rational speed;                             ///< inward, run over rise
  std::uint32_t motions = 0;                  ///< equal for lines that coincide for ever
  std::uint32_t towards = none, away = none;  ///< numbers of the direction and its opposite; set by Wavefront::add
};

/// How a line moves while terraces run: over τ, not over the height.
struct TerraceMotion {
  PlaneId plane = none;
  Rational run;  ///< m, inward, from τ = 0 to τ = 1
};

/// An edge and its start vertex.
struct WaveEdge {
  std::uint32_t line = none;  ///< none: the slot is free
  std::uint32_t node = 0;
  std::uint32_t prev = 0, next = 0;
  PlaneId joint = none;      ///< where the predecessor lies on the same line: the upright plane through the start
  std::uint32_t origin = 0;  ///< the point where the present arc of the start vertex began
  std::uint64_t origin_moment = 0, origin_level = 0;  ///< when that was

  std::uint32_t vertex_stamp = 0, edge_stamp = 0;  ///< changed with the motion of the start, or of any part of the edge
  bool vertex_dirty = false, edge_dirty = false;
  bool pointed = false;        ///< the start can run into edges: it is reflex, or a joint
  std::uint32_t place = none;  ///< in the list of edges
  std::uint64_t scanned = 0;   ///< the refresh in which the start was compared with all edges
  std::uint32_t pointed_place = none;

  // In doubles: the start vertex as x0 + x1 t, y0 + y1 t; each is off by less than `error0`, `error1`.
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0, error0 = 0, error1 = 0, pace = 0;
  // Where both ends lie along the edge's line.
  double from0 = 0, from1 = 0, to0 = 0, to1 = 0, span_error0 = 0, span_error1 = 0, span_pace = 0;
};

/// An edge that has shrunk to nothing (vertex == edge), or a vertex that has run into an edge.
struct Contact {
  std::uint32_t vertex = 0, edge = 0;
  bool inside = false;  ///< surely strictly between the edge's ends
};

class Wavefront {
 public:
  explicit Wavefront(Trace& trace) : trace_(trace), planes_(trace.planes) {}

  std::vector<Line> lines;
  std::vector<WaveEdge> edges;

  auto add(Line line) -> std::uint32_t;

  // The present moment, told by the sweep.
  Fraction now;
  double horizon = 0;                   ///< later than this nothing counts
  std::uint64_t moment = 1, level = 1;  ///< numbers; a level is one height
  std::int64_t height = 0;              ///< quanta; of the level

  /// A free slot; the caller links it, then calls `changed`.
  auto create(std::uint32_t line, std::uint32_t node) -> std::uint32_t;
  /// The slots in use, sorted.
  [[nodiscard]] auto alive() const -> std::vector<std::uint32_t>;
  [[nodiscard]] auto empty() const -> bool { return fronts_.empty(); }

  /// The line of an edge moves differently from now on, or its neighbours are others.
  void changed(std::uint32_t edge);
  /// Only its start moves differently.
  void start_changed(std::uint32_t edge);

  /// Neighbours in one plane become one edge; other neighbours on one line keep their joint where they move alike, and
  /// get a connector, a zero-speed edge at right angles, where one runs ahead, which is also the way it faces. To be
  /// asked for every edge whose start or motion is new.
  void connect(std::uint32_t edge);

  /// `connect` for what the last snapshot made, and for every joint.
  void connect_pending();
  void connect_all();

  /// Lets terraces run at the present height: while `body` runs, t is τ from 0 to 1, the lines that `moving` names move
  /// as it says, and all others stand still. Before and after, t is the height and lines move by their own planes; the
  /// candidates of the rise are kept.
  template <class Body>
  void run_terraces(const std::map<std::uint32_t, TerraceMotion>& moving, Body body) {
    enter_terraces(moving);
    body();
    leave_terraces();
  }

  /// The contacts of the next critical moment after `now`, at `limit` at the latest; empty if there is none.
  [[nodiscard]] auto next_contacts(const Fraction& limit, Fraction& when) -> std::vector<Contact>;

  /// Stops the wavefront at the moment `now`: drops what has no length, splits at touching vertices, cancels what has
  /// met, joins anew what is left.
  void snapshot(const std::vector<Contact>& contacts);

  /// Ends the arc of an edge's start vertex at the moment and begins a new one there.
  void close_arc(std::uint32_t edge, PlaneId moment_plane);

  /// Of a line: inward, over the height or over τ.
  [[nodiscard]] auto speed_of(std::uint32_t line) const -> const Rational&;
  [[nodiscard]] auto plane_at(std::uint32_t edge) -> PlaneId;
  /// The planes that cut off the edge at its start and end.
  [[nodiscard]] auto start_plane(std::uint32_t edge) -> PlaneId;
  [[nodiscard]] auto end_plane(std::uint32_t edge) -> PlaneId;

 private:
  struct Candidate {
    double lo, hi;
    Contact contact;
    std::uint32_t vertex_stamp, edge_stamp;
    bool sure;  ///< nothing but its exact moment is open
  };
  struct Later {
    auto operator()(const Candidate& a, const Candidate& b) const -> bool;
  };
  struct Seen {
    double nx, ny, c, s, size;
    const Direction* direction;
  };
  /// An edge's line, packed for the search: its offset is off by less than `size` times 2^-49.
  struct Front {
    double nx = 0, ny = 0, c = 0, s = 0, size = 0;
    std::uint32_t edge = none;
  };
  /// A pointed vertex, packed for the search; see WaveEdge.
  struct Tip {
    double x0 = 0, x1 = 0, y0 = 0, y1 = 0, error0 = 0, error1 = 0, pace = 0;
    std::uint32_t edge = none;
  };
  struct Meeting;  // the work of one snapshot
  friend struct Meeting;

  /// The work of run_terraces: exists exactly while its body runs.
  struct Terraces {
    std::vector<TerraceMotion> motions;  ///< by line; without a plane: it stands still, and was not asked for yet
    std::vector<std::uint32_t> touched;  ///< slots whose motion over the height must be found anew afterwards
    std::vector<Candidate> waiting;      ///< the queue of the rise
    double rise_horizon;  ///< without an initialiser: clang 16 wants those of a nested class after its outer class
    [[nodiscard]] auto motion_of(std::uint32_t line) const -> const TerraceMotion* {
      return line < motions.size() && motions[line].plane != none ? &motions[line] : nullptr;
    }
  };
  void enter_terraces(const std::map<std::uint32_t, TerraceMotion>& moving);
  void leave_terraces();
  /// A point where three planes meet in the time that runs now.
  [[nodiscard]] auto traced(const Triple& at) const -> TracePoint { return {at, terraces_.has_value(), height}; }

  void release(std::uint32_t edge);
  void set_pointed(std::uint32_t edge, bool pointed);
  [[nodiscard]] auto seen(std::uint32_t line) const -> Seen;
  [[nodiscard]] auto seen_plane(PlaneId plane) const -> Seen;
  void aim_vertex(std::uint32_t edge);
  void aim_edge(std::uint32_t edge);
  void aim_all();
  /// Brings doubles and candidates up to date.
  void refresh();
  void try_collapse(std::uint32_t edge);
  void try_hit(const Tip& tip, const Front& front);
  [[nodiscard]] auto never_meet(std::uint32_t vertex, std::uint32_t edge) const -> bool;
  void push(double lo, double hi, Contact contact, bool sure);
  void put(const Candidate& candidate);
  [[nodiscard]] auto is_current(const Candidate& c) const -> bool;
  /// The planes that meet in a contact.
  [[nodiscard]] auto triple_of(const Contact& c) -> Triple;
  /// Whether it comes to the contact after `now`, exactly.
  [[nodiscard]] auto happens(const Contact& c) -> bool;
  /// Where along the edge the contact is: −1 at its start, +1 at its end, 0 between, ±2 beyond.
  [[nodiscard]] auto place_on(const Contact& c) -> int;
  [[nodiscard]] auto turn(PlaneId p, PlaneId q) const -> int {
    return sign(cross(planes_[p].direction, planes_[q].direction));
  }
  /// The upright plane across the line through the point, of the line's direction turned left.
  [[nodiscard]] auto joint_through(std::uint32_t line, const Triple& at) -> PlaneId;
  [[nodiscard]] auto position(std::uint32_t edge, double t) const -> geometry::Point2 {
    const WaveEdge& e = edges[edge];
    return {e.x0 + e.x1 * t, e.y0 + e.y1 * t};
  }

  Trace& trace_;
  Planes& planes_;
  std::vector<std::uint32_t> free_, dirty_;
  std::vector<Front> fronts_;  ///< of the slots in use, in no order that means anything
  std::vector<Tip> tips_;
  std::map<Direction, std::uint32_t> directions_;
  std::vector<std::uint32_t> pending_;  ///< slots made by the last snapshot
  std::vector<Candidate> queue_;        ///< a heap
  std::optional<Terraces> terraces_;
  std::uint64_t refreshes_ = 0;
};

}  // namespace mansard::extrude::detail
