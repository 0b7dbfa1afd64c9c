// A constrained Delaunay triangulation of a rectangle on an integer grid. Points and edges are added one by one; every
// decision is exact.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace mansard::terrain::detail {

/// In whole units of a grid. Coordinates of one triangulation differ by less than 2²⁹ units, so that twice an area fits
/// into 64 bits and the test of a circle into 128.
struct Site {
  std::int64_t x = 0, y = 0;
  friend auto operator<=>(const Site&, const Site&) = default;
};
inline constexpr std::int64_t widest = std::int64_t{1} << 29;

/// Twice the signed area of a, b, c: positive for a left turn.
[[nodiscard]] constexpr auto twice_area(Site a, Site b, Site c) -> std::int64_t {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class Triangulation {
 public:
  static constexpr std::uint32_t none = UINT32_MAX;

  struct Triangle {
    std::array<std::uint32_t, 3> corner;                    ///< counter-clockwise
    std::array<std::uint32_t, 3> beyond{none, none, none};  ///< the triangle across the edge opposite corner i
    std::array<bool, 3> fixed{false, false, false};         ///< whether that edge was added by fix()
  };

  /// The rectangle as two triangles; its corners are the first four vertices, counter-clockwise from the least.
  Triangulation(Site least, Site most);

  struct Place {
    enum class On : std::uint8_t { vertex, edge, inside } on = On::inside;
    std::uint32_t triangle = none;
    int index = 0;  ///< the corner, or the corner opposite the edge
  };
  /// Where a site of the rectangle is; the search starts at triangle `from`.
  [[nodiscard]] auto locate(Site p, std::uint32_t from) const -> Place;

  /// Called with a triangle before it changes.
  using Touch = std::function<void(std::uint32_t)>;
  /// The vertex at a site of the rectangle, added where there is none. A fixed edge that it is on becomes two.
  auto insert(Site p, const Touch& touch = {}) -> std::uint32_t;
  auto insert(Site p, const Place& place, const Touch& touch) -> std::uint32_t;

  /// Makes the segment between two vertices an edge, or several where other vertices are exactly on it. False where it
  /// would cross a fixed edge; some part of it may be fixed then.
  [[nodiscard]] auto fix(std::uint32_t a, std::uint32_t b) -> bool;

  [[nodiscard]] auto sites() const -> const std::vector<Site>& { return sites_; }
  [[nodiscard]] auto triangles() const -> const std::vector<Triangle>& { return triangles_; }
  [[nodiscard]] auto triangle_at(std::uint32_t vertex) const -> std::uint32_t { return at_[vertex]; }
  /// The triangle to the left of the edge from a to b, and the corner opposite; none where there is no such edge.
  [[nodiscard]] auto left_of(std::uint32_t a, std::uint32_t b) const -> std::optional<std::pair<std::uint32_t, int>>;
  /// The triangles around a vertex, counter-clockwise from triangle `from`; where the vertex is on the border, from
  /// the first one there.
  [[nodiscard]] auto around(std::uint32_t vertex) const -> std::vector<std::uint32_t>;

 private:
  void link(std::uint32_t t, int side, std::uint32_t other, std::uint32_t instead_of);
  void flip(std::uint32_t t, int side);
  void legalise(const std::vector<std::pair<std::uint32_t, int>>& open, const Touch& touch);
  auto split_triangle(std::uint32_t t, std::uint32_t v, const Touch& touch) -> void;
  auto split_edge(std::uint32_t t, int side, std::uint32_t v, const Touch& touch) -> void;
  [[nodiscard]] auto in_circle(std::uint32_t t, std::uint32_t v) const -> bool;
  void set_fixed(std::uint32_t t, int side);

  std::vector<Site> sites_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> at_;  ///< of each vertex, a triangle
};

}  // namespace mansard::terrain::detail
