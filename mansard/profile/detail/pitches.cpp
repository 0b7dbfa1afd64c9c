#include "mansard/profile/detail/pitches.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mansard::profile::detail {
namespace {

constexpr double far = std::numeric_limits<double>::infinity();

/// Weighted sums of 1, u, u², h, uh over the columns from one on to the last.
struct Sums {
  double w = 0, u = 0, uu = 0, h = 0, uh = 0;
};

/// Least squares over the basis 1, u, (u − a)+, (u − b)+ for knots at columns a < b, from suffix sums in O(1).
class Hinges {
 public:
  explicit Hinges(std::span<const Pooled> columns) : columns_(columns), suffix_(columns.size() + 1) {
    for (std::size_t i = columns.size(); i-- > 0;) {
      const auto& c = columns[i];
      Sums s = suffix_[i + 1];
      s.w += c.weight, s.u += c.weight * c.inward, s.uu += c.weight * c.inward * c.inward;
      s.h += c.weight * c.height, s.uh += c.weight * c.inward * c.height;
      suffix_[i] = s;
      squares_ += c.weight * c.height * c.height;
    }
  }

  struct Fit {
    std::array<double, 4> coefficients{};
    double residual = far;  ///< weighted sum of squares
  };

  [[nodiscard]] auto solve(std::span<const std::size_t> knots) const -> Fit {
    const std::size_t n = 2 + knots.size();
    std::array<std::array<double, 5>, 4> m{};
    const Sums& all = suffix_[0];
    m[0] = {all.w, all.u, 0, 0, 0};
    m[1] = {all.u, all.uu, 0, 0, 0};
    std::array<double, 4> right{all.h, all.uh, 0, 0};
    for (std::size_t k = 0; k < knots.size(); ++k) {
      const Sums& s = suffix_[knots[k]];
      const double a = columns_[knots[k]].inward;
      m[0][2 + k] = m[2 + k][0] = s.u - a * s.w;
      m[1][2 + k] = m[2 + k][1] = s.uu - a * s.u;
      right[2 + k] = s.uh - a * s.h;
      for (std::size_t l = 0; l <= k; ++l) {
        const double b = columns_[knots[l]].inward;  // knots ascend: both hinges act from the later one on
        m[2 + k][2 + l] = m[2 + l][2 + k] = s.uu - (a + b) * s.u + a * b * s.w;
      }
    }
    Fit fit;
    auto work = m;
    auto x = right;
    for (std::size_t i = 0; i < n; ++i) {  // symmetric positive definite: no pivoting needed
      if (work[i][i] <= 1e-12 * (1 + m[i][i])) return fit;
      for (std::size_t r = i + 1; r < n; ++r) {
        const double f = work[r][i] / work[i][i];
        for (std::size_t c = i; c < n; ++c) work[r][c] -= f * work[i][c];
        x[r] -= f * x[i];
      }
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t c = i + 1; c < n; ++c) x[i] -= work[i][c] * x[c];
      x[i] /= work[i][i];
    }
    double explained = 0;
    for (std::size_t i = 0; i < n; ++i) explained += x[i] * right[i];
    fit.coefficients = x;
    fit.residual = std::max(0.0, squares_ - explained);
    return fit;
  }

 private:
  std::span<const Pooled> columns_;
  std::vector<Sums> suffix_;
  double squares_ = 0;
};

/// The slopes of the pieces never fall.
auto rises(const Hinges::Fit& fit, std::size_t knots) -> bool {
  double slope = fit.coefficients[1];
  if (slope < 0) return false;
  for (std::size_t k = 0; k < knots; ++k)
    if ((slope += fit.coefficients[2 + k]) < 0) return false;
  return true;
}

auto line_of(std::span<const Pooled> columns, const Hinges::Fit& fit, std::span<const std::size_t> knots) -> RoofLine {
  const auto at = [&](double u) {
    double h = fit.coefficients[0] + fit.coefficients[1] * u;
    for (std::size_t k = 0; k < knots.size(); ++k)
      h += fit.coefficients[2 + k] * std::max(0.0, u - columns[knots[k]].inward);
    return h;
  };
  RoofLine line{{0, at(0)}};
  for (const auto k : knots) line.push_back({columns[k].inward, at(columns[k].inward)});
  line.push_back({columns.back().inward, at(columns.back().inward)});
  return line;
}

auto height_on(const RoofLine& line, double inward) -> double {
  std::size_t i = 1;
  while (i + 1 < line.size() && line[i].inward < inward) ++i;
  const auto& a = line[i - 1];
  const auto& b = line[i];
  return a.height + (inward - a.inward) / (b.inward - a.inward) * (b.height - a.height);
}

}  // namespace

auto fit_line(std::span<const Pooled> columns, std::size_t most, const Options& o) -> RoofLine {
  if (columns.size() < o.pitch_columns) return {};
  // Heights relative to the first column keep the digits of the sums.
  std::vector<Pooled> relative(columns.begin(), columns.end());
  double heaviest = 0;
  for (const auto& c : columns) heaviest = std::max(heaviest, c.weight);
  for (auto& c : relative) {
    c.height -= columns.front().height;
    c.weight /= heaviest;
  }
  const Hinges hinges(relative);
  auto best = hinges.solve({});
  std::vector<std::size_t> knots;
  double cost = best.residual;
  const std::size_t n = relative.size();
  const auto consider = [&](std::span<const std::size_t> candidate) {
    const auto fit = hinges.solve(candidate);
    const double c = fit.residual + o.pitch_price * static_cast<double>(candidate.size());
    if (c < cost && rises(fit, candidate.size())) {
      best = fit;
      cost = c;
      knots.assign(candidate.begin(), candidate.end());
    }
  };
  for (std::size_t a = o.pitch_columns; most > 1 && a + o.pitch_columns <= n; ++a) {
    consider(std::array{a});
    for (std::size_t b = a + o.pitch_columns; most > 2 && b + o.pitch_columns <= n; ++b) consider(std::array{a, b});
  }
  if (best.residual == far) return {};
  auto line = line_of(relative, best, knots);
  for (auto& p : line) p.height += columns.front().height;
  return line;
}

auto supported(RoofLine line, std::span<const SliceColumns> slices, double tolerance, const Options& o) -> RoofLine {
  for (std::size_t piece = 0; piece + 1 < line.size(); ++piece) {
    const double from = line[piece].inward, to = line[piece + 1].inward;
    std::size_t agreeing = 0;
    for (const auto& slice : slices) {
      std::size_t looked = 0, near = 0;
      for (std::size_t b = slice.first; b < slice.last; ++b) {
        const double u = (static_cast<double>(b) + 0.5) * o.column_width;
        if (u < from || u > to || std::isnan(slice.heights[b])) continue;
        const double height = height_on(line, u);
        ++looked;
        near += std::abs(slice.heights[b] - height) <= tolerance ? 1 : 0;
      }
      agreeing += looked > 0 && 2 * near >= looked ? 1 : 0;
    }
    if (static_cast<double>(agreeing) >= o.support * static_cast<double>(slices.size())) continue;
    line.resize(piece + 1);
    break;
  }
  if (line.size() < 2) line.clear();
  return line;
}

auto vertical_profile(double height, const Options& o) -> model::Profile {
  return {{0, 0}, {0, std::max(o.minimum_height, height)}};
}

auto profile_from(const RoofLine& line, const Options& o) -> model::Profile {
  if (line.size() < 2) return vertical_profile(line.empty() ? 0 : line.front().height, o);
  /// A pitch on its own infinite line, as far as `end`.
  struct Pitch {
    model::ProfilePoint through;
    double slope = 0, end = 0;
    [[nodiscard]] auto at(double inward) const -> double { return through.height + slope * (inward - through.inward); }
  };
  const double steep = 1 / geometry::tangent(o.vertical_angle);
  std::vector<Pitch> pitches;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double run = line[i + 1].inward - line[i].inward;
    double slope = std::max(0.0, line[i + 1].height - line[i].height) / run;
    if (slope > steep) {  // a wall that the scan has blurred: upright at its middle, between its neighbours' pitches
      if (!pitches.empty()) pitches.back().end = line[i].inward + run / 2;
      continue;
    }
    if (slope < o.level_slope) slope = 0;
    pitches.push_back({line[i + 1], slope, line[i + 1].inward});
  }
  while (!pitches.empty() && pitches.back().slope == 0) pitches.pop_back();
  // Scans round off the edges of flat roofs too: what gains less than that is no pitch.
  if (pitches.empty() || line.back().height < 2 * o.minimum_height ||
      line.back().height - line.front().height < o.pitch_gain)
    return vertical_profile(line.front().height, o);

  model::Profile profile = vertical_profile(pitches.front().at(0), o);
  const auto add = [&](double inward, double height) {
    const model::ProfilePoint next{inward, std::max(height, profile.back().height)};
    if (!(next == profile.back())) profile.push_back(next);
  };
  for (std::size_t i = 0; i < pitches.size(); ++i) {
    if (i > 0) add(pitches[i - 1].end, pitches[i].at(pitches[i - 1].end));
    add(pitches[i].end, pitches[i].at(pitches[i].end));
  }
  return profile;
}

}  // namespace mansard::profile::detail
