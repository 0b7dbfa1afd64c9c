#include "mansard/refine/detail/ties.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::refine::detail {
namespace {

/// Error bounds. Every tie subtracts from a covariance what rounding knows to 1e-16 of it; after a thousand ties a
/// variance that should be 0 is below 1e-12 of what it was. A tie that is missed by less than a micrometre holds.
constexpr double no_variance = 1e-9;  // of the variance without ties
constexpr double nothing_missing = 1e-6;

}  // namespace

auto Values::add(double first, double second, const std::array<double, 3>& sums) -> std::size_t {
  const auto [w, d, dd] = sums;
  const double determinant = w * dd - d * d;
  const std::size_t number = at_.size();
  const double a = dd / determinant, b = -d / determinant, c = w / determinant;
  at_.insert(at_.end(), {first, second});
  free_.insert(free_.end(), {a, c});
  group_.insert(group_.end(), {groups_.size(), groups_.size()});
  place_.insert(place_.end(), {0, 1});
  groups_.push_back({{number, number + 1}, {a, b, b, c}});
  return number;
}

auto Values::add(double value, double sum) -> std::size_t {
  const std::size_t number = at_.size();
  at_.push_back(value);
  free_.push_back(1 / sum);
  group_.push_back(groups_.size());
  place_.push_back(0);
  groups_.push_back({{number}, {1 / sum}});
  return number;
}

auto Values::covariance(std::size_t a, std::size_t b) const -> double {
  if (group_[a] != group_[b]) return 0;
  const Group& group = groups_[group_[a]];
  return group.covariance[place_[a] * group.values.size() + place_[b]];
}

auto Values::gap(const Tie& tie) const -> Gap {
  Gap out{tie.level, 0, 0};
  for (const auto& a : tie.terms) {
    out.missing -= a.factor * at_[a.value];
    out.most += a.factor * a.factor * free_[a.value];
    for (const auto& b : tie.terms) out.variance += a.factor * b.factor * covariance(a.value, b.value);
  }
  return out;
}

auto Values::price(const Tie& tie) const -> double {
  const Gap gap = this->gap(tie);
  if (gap.variance > no_variance * gap.most) return gap.missing * gap.missing / gap.variance;
  return std::abs(gap.missing) <= nothing_missing ? 0 : std::numeric_limits<double>::infinity();
}

/// The group of all values of the tie, made one where they are several.
auto Values::merged(const Tie& tie) -> Group& {
  const std::size_t into = group_[tie.terms.front().value];
  for (const auto& term : tie.terms) {
    const std::size_t from = group_[term.value];
    if (from == into) continue;
    Group &a = groups_[into], b = std::move(groups_[from]);
    groups_[from] = {};
    const std::size_t n = a.values.size(), m = b.values.size();
    std::vector<double> both((n + m) * (n + m), 0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) both[i * (n + m) + j] = a.covariance[i * n + j];
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j) both[(n + i) * (n + m) + n + j] = b.covariance[i * m + j];
    for (std::size_t j = 0; j < m; ++j) {
      group_[b.values[j]] = into;
      place_[b.values[j]] = n + j;
      a.values.push_back(b.values[j]);
    }
    a.covariance = std::move(both);
  }
  return groups_[into];
}

void Values::hold(const Tie& tie) {
  const Gap gap = this->gap(tie);
  if (!(gap.variance > no_variance * gap.most)) return;
  Group& group = merged(tie);
  const std::size_t n = group.values.size();
  std::vector<double> along(n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (const auto& term : tie.terms) along[i] += term.factor * group.covariance[i * n + place_[term.value]];
  for (std::size_t i = 0; i < n; ++i) {
    if (along[i] == 0) continue;
    at_[group.values[i]] += along[i] * gap.missing / gap.variance;
    for (std::size_t j = 0; j < n; ++j) group.covariance[i * n + j] -= along[i] * along[j] / gap.variance;
  }
}

}  // namespace mansard::refine::detail
