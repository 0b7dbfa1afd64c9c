// The wavefront: closed loops of moving lines, between one critical moment and the next.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/extrude/detail/direction.hpp"
#include "mansard/extrude/detail/numbers.hpp"
#include "mansard/extrude/detail/surface.hpp"

namespace mansard::extrude::detail {

/// A moving line: n · x = (C + S t) / l with n the direction turned left. t is the height, or τ while terraces run.
struct Line {
  Direction direction;
  Rational C, S;            ///< scaled by direction.l
  Interval c, s;            ///< not scaled
  std::uint32_t plane = 0;  ///< equal for lines that coincide for ever
  bool connector = false;

  void move(Rational scaled_offset, Rational scaled_speed) {
    C = std::move(scaled_offset);
    S = std::move(scaled_speed);
    const Interval scale(static_cast<double>(direction.l));
    c = Interval(C) / scale;
    s = S == 0 ? Interval(0.0) : Interval(S) / scale;
  }
};

struct WaveEdge {
  std::uint32_t line = 0, node = 0;
  std::uint32_t prev = 0, next = 0;
  std::uint32_t origin = 0;         ///< the point where the present arc of the start vertex began
  std::optional<ExactPoint> start;  ///< exact start at the moment of a snapshot, where known

  // Prepared by `prepare`: the start vertex as x0 + x1 t, and where both ends lie along the edge.
  Interval x0, x1, y0, y1;
  Interval from0, from1, to0, to1;
  bool reflex = false;
};

class Wavefront {
 public:
  Wavefront(std::vector<Line>& lines, Trace& trace) : lines_(lines), trace_(trace) {}

  std::vector<WaveEdge> edges;

  /// Merges neighbours in one plane, and puts a connector, a zero-speed edge at right angles, between others on one
  /// line; which way it faces depends on which of them runs ahead. Then makes everything ready for `next_event`.
  void connect();

  /// The first moment after `now`, at `limit` at the latest, when an edge has shrunk to nothing or a reflex vertex has
  /// run into an edge.
  [[nodiscard]] auto next_event(const Rational& now, const Rational& limit) const -> std::optional<Rational>;

  /// Stops the wavefront at t (drawn at height z): drops what has no length, splits at touching vertices, cancels what
  /// has met, joins anew what is left. Leaves neighbours on one line without connector.
  void snapshot(const Rational& t, const Rational& z);

  /// The exact start of an edge at t; at the moment of a snapshot also between neighbours on one line.
  [[nodiscard]] auto start_of(std::uint32_t edge, const Rational& t) const -> ExactPoint;

  /// Ends the arc of an edge's start vertex at t, z and begins a new one there.
  void close_arc(std::uint32_t edge, const Rational& t, const Rational& z);

 private:
  struct Motion {
    Rational x0, x1, y0, y1;
  };
  struct Meeting;  // the work of one snapshot

  void merge_planes();
  void prepare();
  [[nodiscard]] auto line_of(std::uint32_t edge) const -> const Line& { return lines_[edges[edge].line]; }
  [[nodiscard]] auto motion_of(std::uint32_t edge) const -> Motion;
  [[nodiscard]] auto collapse(std::uint32_t edge) const -> std::optional<Rational>;
  [[nodiscard]] auto hit(std::uint32_t vertex, std::uint32_t edge, const Rational& now) const
      -> std::optional<Rational>;

  std::vector<Line>& lines_;
  Trace& trace_;
};

}  // namespace mansard::extrude::detail
