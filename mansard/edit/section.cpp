#include <algorithm>
#include <cmath>
#include <utility>

#include "mansard/edit/edit.hpp"

namespace mansard::edit {
namespace {

using geometry::Point2;
using model::ProfilePoint;

/// What of the piece is no farther than `reach` from the foot, to both sides and downwards.
auto clipped(ProfilePoint a, ProfilePoint b, double reach) -> std::optional<std::array<ProfilePoint, 2>> {
  double from = 0, to = 1;
  const auto keep = [&](double at_a, double at_b) {  // where this is not negative
    if (at_a < 0 && at_b < 0) from = 2;
    else if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    else if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
  };
  keep(a.inward + reach, b.inward + reach);
  keep(reach - a.inward, reach - b.inward);
  keep(a.height + reach, b.height + reach);
  if (!(from < to)) return std::nullopt;
  const auto at = [&](double t) -> ProfilePoint {
    if (t == 0) return a;
    if (t == 1) return b;
    return {a.inward + t * (b.inward - a.inward), a.height + t * (b.height - a.height)};
  };
  return std::array{at(from), at(to)};
}

}  // namespace

auto section(const geometry::Mesh& mesh, Point2 from, Point2 to, double share, double base, double reach) -> Section {
  Section out;
  const Point2 along = geometry::normalised(to - from), inward = geometry::left_of(along);
  if (!(length(along) > 0)) return out;
  const Point2 foot = from + share * (to - from);
  const auto off = [&](std::uint32_t v) { return dot(geometry::xy(mesh.vertices[v]) - foot, along); };
  for (const auto& triangle : mesh.triangles) {
    const std::array offs{off(triangle[0]), off(triangle[1]), off(triangle[2])};
    // Corners on the plane count as before it, so that every triangle is crossed on two edges or none.
    std::array<ProfilePoint, 2> ends;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
      std::size_t a = i, b = (i + 1) % 3;
      if ((offs[a] >= 0) == (offs[b] >= 0)) continue;
      if (triangle[a] > triangle[b]) std::swap(a, b);  // neighbours find the same point
      const auto p = mesh.vertices[triangle[a]], q = mesh.vertices[triangle[b]];
      const auto at = p + (offs[a] / (offs[a] - offs[b])) * (q - p);
      ends[count++] = {dot(geometry::xy(at) - foot, inward), at.z - base};
    }
    if (count < 2) continue;
    if (const auto piece = clipped(ends[0], ends[1], reach)) out.pieces.push_back(*piece);
  }
  return out;
}

}  // namespace mansard::edit
