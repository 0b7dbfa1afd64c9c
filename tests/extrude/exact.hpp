// Plans as the kernel sees them: on exact lines, with the surface before rounding; and maps of them that are exact,
// too.
#pragma once

#include <numeric>
#include <stdexcept>

#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "mansard/extrude/detail/sweep.hpp"
#include "oracle/compare.hpp"
#include "plans.hpp"

namespace plans {

using extrude::detail::CanonicalEdge;
using extrude::detail::Direction;
using extrude::detail::ExactSurface;
using extrude::detail::Footprint;
using oracle::Rational;

/// Throws with the reason when the public function refuses the plan.
inline auto footprint_of(const Plan& plan) -> Footprint {
  const auto source = extrude::detail::prepared(plan);
  if (!source) throw std::runtime_error(base::to_string(source.error()));
  std::string why;
  auto footprint = extrude::detail::canonical(*source, {}, why);
  if (!footprint) throw std::runtime_error("no canonical footprint: " + why);
  return std::move(*footprint);
}
inline auto cap_of(const Plan& plan) -> Rational { return extrude::detail::on_grid(plan.cap); }
inline auto surface_of(const Footprint& footprint, const Rational& cap) -> ExactSurface {
  return extrude::detail::sweep(footprint, cap, {});
}
inline auto surface_of(const Plan& plan) -> ExactSurface { return surface_of(footprint_of(plan), cap_of(plan)); }

inline auto mirrored(const Footprint& original) -> Footprint {
  Footprint out = original;
  for (std::size_t r = 0; r < out.rings.size(); ++r) {
    const auto& ring = original.rings[r];
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      // Edge i of the image is the last but i of the original, walked the other way: its start was that one's end.
      const std::size_t from = n - 1 - i, end = (from + 1) % n;
      CanonicalEdge& edge = out.rings[r][i];
      edge = ring[from];
      edge.direction = {ring[from].direction.a, -ring[from].direction.b, ring[from].direction.l};
      edge.joint = ring[end].joint;
      if (edge.joint) edge.joint->x = -edge.joint->x;
      out.corners[r][i] = original.corners[r][end];
      out.corners[r][i].x = -out.corners[r][i].x;
    }
  }
  return out;
}

/// Turned about the origin by the angle whose cosine is 3/5 and sine 4/5.
inline auto turned(Footprint out) -> Footprint {
  const auto turn = [](extrude::detail::ExactPoint& p) {
    const Rational x = (3 * p.x - 4 * p.y) / 5, y = (4 * p.x + 3 * p.y) / 5;
    p = {x, y};
  };
  for (auto& ring : out.rings)
    for (CanonicalEdge& e : ring) {
      Direction d{3 * e.direction.a - 4 * e.direction.b, 4 * e.direction.a + 3 * e.direction.b, 5 * e.direction.l};
      const std::int64_t common = std::gcd(std::gcd(d.a, d.b), d.l);
      e.direction = {d.a / common, d.b / common, d.l / common};
      if (e.joint) turn(*e.joint);
    }
  for (auto& ring : out.corners)
    for (auto& p : ring) turn(p);
  return out;
}

/// Every ring begun at another corner, holes and tracks in another order.
inline auto renumbered(const Footprint& original) -> Footprint {
  Footprint out = original;
  std::ranges::reverse(out.tracks);
  if (out.rings.size() > 1) {
    std::reverse(out.rings.begin() + 1, out.rings.end());
    std::reverse(out.corners.begin() + 1, out.corners.end());
  }
  for (std::size_t r = 0; r < out.rings.size(); ++r) {
    const auto by = static_cast<std::ptrdiff_t>(1 + r % 2);
    std::ranges::rotate(out.rings[r], out.rings[r].begin() + by);
    std::ranges::rotate(out.corners[r], out.corners[r].begin() + by);
    for (CanonicalEdge& e : out.rings[r]) e.track = static_cast<std::uint32_t>(out.tracks.size()) - 1 - e.track;
  }
  return out;
}

/// Only for edges along the axes, whose offsets stay on the grid: moved by (x, y), multiples of 2^-16 m.
inline auto moved(Footprint out, const Rational& x, const Rational& y) -> Footprint {
  const auto move = [&](extrude::detail::ExactPoint& p) {
    p.x += x;
    p.y += y;
  };
  for (auto& ring : out.rings)
    for (CanonicalEdge& e : ring) {
      e.offset += (e.direction.a * y - e.direction.b * x) / e.direction.l;
      if (e.joint) move(*e.joint);
    }
  for (auto& ring : out.corners)
    for (auto& p : ring) move(p);
  return out;
}

/// Faces with every corner mapped, in normal order; names dropped. A map that mirrors turns the boundaries round.
template <class Map>
auto mapped(std::vector<oracle::Face> faces, Map map, bool mirrors = false) -> std::vector<oracle::Face> {
  for (oracle::Face& face : faces) {
    face.provenance.reset();
    for (auto& [from, to] : face.boundary) {
      map(from);
      map(to);
      if (mirrors) std::swap(from, to);
    }
    std::ranges::sort(face.boundary);
  }
  std::ranges::sort(faces, std::less<>());
  return faces;
}

}  // namespace plans
