// Values of known curvature, and what it costs to make some of them agree.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace mansard::refine::detail {

/// Σ factor · value = level over a few values: 1 and −1 for two that are equal.
struct Tie {
  struct Term {
    std::size_t value = 0;
    double factor = 1;
  };
  std::vector<Term> terms;
  double level = 0;
};

/// Values with a cost that is quadratic about where they started, and ties that hold among them. The values are at all
/// times those of the minimum cost; what another tie would add to it is exact (Lagrange: the square of what is missing
/// over its variance, where the inverse of the curvature is the covariance).
class Values {
 public:
  /// Two values that start there, with Σ w, Σ w d and Σ w d² of the samples of z = first + second · d, m², m³ and m⁴;
  /// the matrix must be positive definite. Returns the number of the first; the second's is one more.
  auto add(double first, double second, const std::array<double, 3>& sums) -> std::size_t;
  /// One value: Σ w.
  auto add(double value, double sum) -> std::size_t;

  /// m²·m²: what the tie would add. 0 where it holds for any values that the other ties allow; infinite where those
  /// do not allow it.
  [[nodiscard]] auto price(const Tie& tie) const -> double;
  /// Moves the values to the minimum cost with the tie.
  void hold(const Tie& tie);

  [[nodiscard]] auto operator[](std::size_t value) const -> double { return at_[value]; }
  [[nodiscard]] auto size() const -> std::size_t { return at_.size(); }
  /// Which values can be moved by ties on a value: those of one number.
  [[nodiscard]] auto group(std::size_t value) const -> std::size_t { return group_[value]; }

 private:
  /// Values that ties connect, and their covariance, row by row.
  struct Group {
    std::vector<std::size_t> values;
    std::vector<double> covariance;
  };
  struct Gap {
    double missing = 0, variance = 0, most = 0;  ///< most: what the variance was before any tie
  };
  [[nodiscard]] auto gap(const Tie& tie) const -> Gap;
  [[nodiscard]] auto covariance(std::size_t a, std::size_t b) const -> double;
  auto merged(const Tie& tie) -> Group&;

  std::vector<double> at_, free_;  // free_: the variance without ties
  std::vector<std::size_t> group_, place_;
  std::vector<Group> groups_;
};

}  // namespace mansard::refine::detail
