// Rays against triangles (Embree). Directions need not be of unit length; distances are in metres.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mansard/geometry/mesh.hpp"

namespace mansard::rays {

struct Ray {
  geometry::Point3 origin, direction;
};

struct Hit {
  double distance = 0;         ///< metres from the origin along the unit direction
  std::uint32_t triangle = 0;  ///< index into the mesh's triangles
};

/// The place on a mesh that is nearest to a point.
struct Nearest {
  geometry::Point3 point;
  double distance = 0;         ///< metres
  std::uint32_t triangle = 0;  ///< index into the mesh's triangles
};

/// A mesh prepared for rays. What `top` and `seen_from_above` return is computed in doubles and is a function of the
/// triangles alone, so it has the same bits on every processor; `cast` computes in single precision relative to the
/// mesh's centre (about 0.1 mm over a kilometre) with the instructions that the processor has, and is for pictures and
/// simulated scans. `nearest` takes its candidates from a tree in single precision, with a margin for its rounding, and
/// decides in doubles. Queries may run on any thread.
/// Cost: O(n log n) to build (each structure when it is first needed), O(log n) a ray.
class Scene {
 public:
  explicit Scene(geometry::Mesh mesh);
  /// Without some triangles (ascending), below which nothing is seen from above either: where one of them is topmost,
  /// `top` and `seen_from_above` see nothing. `cast` and `nearest` number the triangles that are left.
  Scene(geometry::Mesh mesh, std::vector<std::uint32_t> hiding);
  Scene(Scene&&) noexcept;
  auto operator=(Scene&&) noexcept -> Scene&;
  Scene(const Scene&) = delete;
  auto operator=(const Scene&) -> Scene& = delete;
  ~Scene();

  /// The nearest triangle hit, from either side.
  [[nodiscard]] auto cast(geometry::Point3 origin, geometry::Point3 direction) const -> std::optional<Hit>;
  /// The same for many rays, `hits` being as many: eight go through the tree together, which is quicker where
  /// neighbours in the list take nearly the same way. Where two triangles are equally near, another of them than `cast`
  /// names may be the one hit.
  void cast_all(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;
  /// Whether anything is hit, for many rays, `blocked` being as many.
  void cast_any(std::span<const Ray> rays, std::span<char> blocked) const;
  /// z of the topmost surface above or below (x, y): what a satellite sees. Vertical triangles have no top. Of
  /// triangles that are equally high there, the one with the lower index is seen.
  [[nodiscard]] auto top(geometry::Point2 at) const -> std::optional<double>;
  /// The triangle that `top` saw, of the mesh as it was given, and its z.
  struct Seen {
    double z = 0;
    std::uint32_t triangle = 0;
  };
  [[nodiscard]] auto seen_from_above(geometry::Point2 at) const -> std::optional<Seen>;
  /// The same as `top`, but where a wall only bulges over (x, y), z of the surface at the wall's foot. It does where
  /// the mesh is hollow over more than half of the height from there up, the foot is 2 m or more above `ground` (m),
  /// and the sky is open above a place of about the foot's height within 0.35 m. Seen from above a wall is where it
  /// bulges most, which is outside of where it is on average: of a scanned wall 20 m high, some 0.1 m. Where fronts and
  /// backs of the mesh do not alternate, and where triangles are left out, it is `top`.
  [[nodiscard]] auto top_inside_walls(geometry::Point2 at, double ground) const -> std::optional<double>;

  /// The measured points in the box, its border included, in order; of a scan that consists of points, else none. Not
  /// those above or below triangles that hide. Cost: O(log n + points between the box's x).
  [[nodiscard]] auto points_in(const geometry::Box2& box) const -> std::vector<geometry::Point3>;
  [[nodiscard]] auto has_points() const -> bool;
  /// From now on its points are the vertices of its mesh, but for those of triangles that hide. Of a mesh without
  /// points; before anything is looked up.
  void take_vertices_as_points();

  /// The nearest place of the mesh within so many metres, of any triangle. Of two as near (to the last bit) that of the
  /// lower triangle.
  [[nodiscard]] auto nearest(geometry::Point3 to, double within = std::numeric_limits<double>::infinity()) const
      -> std::optional<Nearest>;
  /// The same for the least of distance + extra(triangle) metres, which is never negative; a triangle with infinite
  /// extra is passed over. `within` limits the distance alone.
  using Extra = std::function<double(std::uint32_t)>;
  [[nodiscard]] auto nearest(geometry::Point3 to, double within, const Extra& extra) const -> std::optional<Nearest>;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mansard::rays
