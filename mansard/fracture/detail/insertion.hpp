// One cut goes into the graph: laid down as a straight line, then settled until nothing is too near to anything else.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "mansard/fracture/detail/graph.hpp"

namespace mansard::fracture::detail {

/// How near is too near.
struct Tolerances {
  explicit Tolerances(const Options& o)
      : merge(o.snap + slack),
        drift(2 * o.snap - slack),
        steps(o.settle_steps),
        steps_per_crossing(o.settle_steps_per_crossing) {}

  double merge;  ///< m; vertices nearer than this to a vertex or edge are drawn together
  double drift;  ///< m; no edge may be drawn farther than this from the line of a cut it comes of

  std::size_t steps, steps_per_crossing;  ///< as Options::settle_steps has it

  /// Splitting an edge at a grid point moves it by up to 0.7 grid steps; this leaves room for a thousand of them.
  static constexpr double slack = 0x1.0p-14;
};

/// Where a cut was asked to run, once rounded to the grid.
struct Line {
  Segment2 hard;
  Segment2 whole;  ///< with its continuations
};

/// Ways to try again when the plain one fails.
struct Attempt {
  double continuation = 0;                ///< m
  double attraction = 1;                  ///< times Tolerances::merge: how far the cut is drawn to vertices
  double shift_start = 0, shift_end = 0;  ///< m to the left: laid down beside where it should be
};

class Insertion {
 public:
  Insertion(Graph& graph, std::vector<Line>& lines, const Tolerances& tolerances)
      : graph_(graph), lines_(lines), tolerances_(tolerances) {}

  /// Lays down lines[cut].hard and its continuations (setting `whole`). False when it could not settle: the graph is
  /// then as it was.
  [[nodiscard]] auto lay(std::uint32_t cut, const Attempt& attempt) -> bool;

 private:
  [[nodiscard]] auto try_to_lay(std::uint32_t cut, const Attempt& attempt) -> bool;
  [[nodiscard]] auto reach(Point2 from, Point2 towards, double at_least) const -> Point2;
  [[nodiscard]] auto anchor(Point2 p, bool loose) -> std::optional<std::uint32_t>;
  [[nodiscard]] auto vertex_at(Point2 p) -> std::optional<std::uint32_t>;
  [[nodiscard]] auto settle() -> bool;
  [[nodiscard]] auto way_past(std::uint32_t edge) const -> std::vector<std::uint32_t>;
  [[nodiscard]] auto cross(std::uint32_t edge, std::uint32_t other) -> bool;
  [[nodiscard]] auto bend(std::uint32_t edge, std::uint32_t vertex) -> bool;
  [[nodiscard]] auto lead(std::uint32_t edge, const std::vector<std::uint32_t>& way) -> bool;
  [[nodiscard]] auto draw_in(std::uint32_t vertex) -> bool;
  [[nodiscard]] auto may_pass(const Edge& edge, Point2 p) const -> bool;
  [[nodiscard]] auto line_of(const Trace& trace) const -> const Segment2& {
    return trace.kind == Kind::hard ? lines_[trace.cut].hard : lines_[trace.cut].whole;
  }
  [[nodiscard]] auto has_present_cut(const Edge& edge) const -> bool;
  [[nodiscard]] auto nearest_vertex(const Segment2& segment, double distance) const -> std::optional<std::uint32_t>;
  [[nodiscard]] auto tidy() -> bool;
  void join(std::uint32_t a, std::uint32_t b, const Edge& like, bool unsettled);
  void wait(std::uint32_t edge);
  [[nodiscard]] auto waits(std::uint32_t edge) const -> bool { return edge < waiting_.size() && waiting_[edge]; }

  Graph& graph_;
  std::vector<Line>& lines_;
  Tolerances tolerances_;

  std::uint32_t cut_ = 0;
  double attraction_ = 0;                  // metres
  std::vector<std::uint32_t> rigid_;       // cuts whose edges may not be bent
  std::optional<std::uint32_t> overbent_;  // the cut that was in the way of settling, if not the present one
  std::deque<std::uint32_t> unsettled_;
  std::vector<bool> waiting_;           // which edges are in unsettled_
  std::vector<std::uint32_t> thinned_;  // vertices that may be left with one edge or none
};

}  // namespace mansard::fracture::detail
