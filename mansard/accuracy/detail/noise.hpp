// Noise and its correlated area, from how far samples are from planes through discs of several radii, or vertices of a
// coarse mesh from the planes of neighbouring triangles.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::accuracy::detail {

/// A low quantile of the mean squared distance from the plane through a disc, over many discs.
struct Residual {
  double radius = 0;   ///< m
  double squared = 0;  ///< m²
  double samples = 0;  ///< in the median disc
  std::size_t discs = 0;
};

struct Noise {
  double noise = 0;            ///< m
  double correlated_area = 0;  ///< m²
  std::size_t discs = 0;       ///< or pairs of triangles
};

/// Cosine of 60°: what is steeper is no roof.
constexpr double faces_up = 0.5;

/// Points in cells, for those near a place.
class Cells {
 public:
  explicit Cells(std::vector<geometry::Point3> points);
  /// Sorted by place; equal ones once.
  [[nodiscard]] auto points() const -> const std::vector<geometry::Point3>& { return points_; }
  /// m²: the ground of one point, in the median over the places.
  [[nodiscard]] auto ground_of_one(std::span<const geometry::Point2> places) const -> double;
  /// One for every radius from that which has a dozen points, and at least `least`, to 4 m at which enough discs are
  /// full.
  [[nodiscard]] auto residuals(std::span<const geometry::Point2> places, double ground_of_one, double least = 0) const
      -> std::vector<Residual>;

 private:
  /// Of the points within a radius, every so many: the mean squared distance from the plane through them.
  struct Disc {
    double squared = 0, count = 0;
  };
  [[nodiscard]] auto disc_at(geometry::Point2 at, double radius, std::size_t every) const -> std::optional<Disc>;
  template <class See>
  void each_near(geometry::Point2 at, double radius, See see) const;

  std::vector<geometry::Point3> points_;  // by cell, row by row
};

/// Share of the variance of noise with a Gaussian autocorrelation that a plane through a disc leaves, by the disc's
/// radius over the correlation length; and the equivalent degrees of freedom of what is left.
[[nodiscard]] auto left_by_plane(double radius_over_length) -> double;
[[nodiscard]] auto degrees_of_freedom(double radius_over_length) -> double;

/// The noise that has these residuals. None without any.
[[nodiscard]] auto noise_from(std::span<const Residual> residuals, double ground_of_one) -> std::optional<Noise>;

/// The noise of vertices, each with an error of its own, by how far the four of two neighbouring triangles are from one
/// plane. `seen`: the middles of edges at which that counts. None where there are too few.
[[nodiscard]] auto noise_of_vertices(const geometry::Mesh& mesh, const std::function<bool(geometry::Point2)>& seen,
                                     double ground_of_one) -> std::optional<Noise>;

}  // namespace mansard::accuracy::detail
