#include "mansard/solid/detail/planar_pieces.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "mansard/model/file_grid.hpp"
#include "mansard/solid/detail/fitted_plane.hpp"
#include "mansard/solid/detail/measure.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point3;
using model::Face;
using model::Solid;
using Loop = std::vector<std::uint32_t>;

auto piece_of(const Face& face, Loop loop) -> Face { return {{std::move(loop)}, face.kind, face.provenance, {}}; }

/// Corners of the outer loop, those furthest from the plane of most corners first.
auto furthest_first(const Solid& solid, const Face& face) -> std::vector<std::uint32_t> {
  const double middle = offset_of_most(solid, face);
  auto corners = face.loops[0];
  std::ranges::stable_sort(corners, std::greater{},
                           [&](auto v) { return std::abs(dot(face.normal, solid.vertices[v]) - middle); });
  return corners;
}

/// The triangle at corner `i` of the outer loop, if it is inside the face and no needle.
auto ear_at(const Solid& solid, const Face& face, std::size_t i) -> std::optional<Face> {
  const auto& loop = face.loops[0];
  const std::size_t n = loop.size();
  const Corners t{loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n]};
  const auto side = [&](std::uint32_t a, std::uint32_t b, Point3 p) {
    return dot(face.normal, cross(solid.vertices[b] - solid.vertices[a], p - solid.vertices[a]));
  };
  if (!(side(t[0], t[1], solid.vertices[t[2]]) > 0)) return std::nullopt;
  for (const auto& other : face.loops)
    for (const auto v : other) {
      if (std::ranges::find(t, v) != t.end()) continue;
      const Point3 p = solid.vertices[v];
      if (side(t[0], t[1], p) >= 0 && side(t[1], t[2], p) >= 0 && side(t[2], t[0], p) >= 0) return std::nullopt;
    }
  Face ear = piece_of(face, {t.begin(), t.end()});
  if (fitted_plane(solid, ear).narrow < model::narrowest_face) return std::nullopt;
  return ear;
}

/// The face without triangles at the corners that are furthest from its plane; nothing if that would be no better than
/// triangles all over.
auto without_corners(const Solid& solid, const Face& face, const std::function<bool(const Face&)>& good)
    -> std::vector<Face> {
  std::vector<Face> pieces;
  Face rest = face;
  for (const auto corner : furthest_first(solid, face)) {
    auto& loop = rest.loops[0];
    if (loop.size() < 5) break;
    const auto at = std::ranges::find(loop, corner);
    auto ear = ear_at(solid, rest, static_cast<std::size_t>(at - loop.begin()));
    if (!ear) break;
    pieces.push_back(std::move(*ear));
    loop.erase(at);
    if (!good(rest)) continue;
    pieces.insert(pieces.begin(), std::move(rest));
    return pieces;
  }
  return {};
}

/// The loop around two pieces that share the side from `a` to `b` of the first; nothing if they meet elsewhere, too.
auto around(const Loop& first, const Loop& second, std::uint32_t a, std::uint32_t b) -> std::optional<Loop> {
  const auto from = [](const Loop& loop, std::uint32_t corner) {
    Loop turned = loop;
    std::ranges::rotate(turned, std::ranges::find(turned, corner));
    return turned;
  };
  Loop out = from(first, b);           // b … a
  const Loop other = from(second, a);  // a … b
  for (const auto v : other) {
    if (v == a || v == b) continue;
    if (std::ranges::find(out, v) != out.end()) return std::nullopt;
    out.push_back(v);
  }
  return out;
}

/// Triangles put together again.
auto put_together(const Solid& solid, const Face& face, const std::vector<Corners>& triangles,
                  const std::function<bool(const Face&)>& good) -> std::vector<Face> {
  std::vector<Face> pieces;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> piece_at;  // by side
  for (const Corners& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) piece_at[{t[k], t[(k + 1) % 3]}] = pieces.size();
    pieces.push_back(piece_of(face, {t.begin(), t.end()}));
  }
  struct Diagonal {
    std::uint32_t a, b;
    double length;
  };
  std::vector<Diagonal> diagonals;
  for (const auto& [side, piece] : piece_at)
    if (side.first < side.second && piece_at.contains({side.second, side.first}))
      diagonals.push_back({side.first, side.second, length(solid.vertices[side.second] - solid.vertices[side.first])});
  std::ranges::stable_sort(diagonals, std::greater{}, &Diagonal::length);
  for (const auto& [a, b, unused] : diagonals) {
    const std::size_t one = piece_at.at({a, b}), two = piece_at.at({b, a});
    if (one == two) continue;
    auto loop = around(pieces[one].loops[0], pieces[two].loops[0], a, b);
    if (!loop) continue;
    Face both = piece_of(face, std::move(*loop));
    if (!good(both)) continue;
    for (auto& [side, piece] : piece_at)
      if (piece == two) piece = one;
    pieces[one] = std::move(both);
    pieces[two].loops.clear();
  }
  std::erase_if(pieces, [](const Face& piece) { return piece.loops.empty(); });
  return pieces;
}

}  // namespace

auto planar_pieces(const Solid& solid, const Face& face, const std::vector<Corners>& triangles,
                   const std::function<bool(const Face&)>& good) -> std::vector<Face> {
  auto pieces = without_corners(solid, face, good);
  if (pieces.empty() || pieces.size() >= triangles.size()) pieces = put_together(solid, face, triangles, good);
  for (Face& piece : pieces) piece.normal = fitted_plane(solid, piece).normal;
  return pieces;
}

}  // namespace mansard::solid::detail
