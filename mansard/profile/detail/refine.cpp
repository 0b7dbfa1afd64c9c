#include "mansard/profile/detail/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::profile::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using model::Profile;

constexpr double sky = std::numeric_limits<double>::infinity();

/// Height of the surface swept by a profile at a distance inward of its edge; a wall stands over nothing.
auto height_at(const Profile& profile, double inward) -> double {
  if (profile.back().inward == 0) return sky;
  std::size_t i = 1;
  while (i + 1 < profile.size() && profile[i].inward < inward) ++i;
  const auto& a = profile[i - 1];
  const auto& b = profile[i];
  if (b.inward == a.inward) {
    if (inward <= a.inward) return b.height;
    return sky;
  }
  return a.height + (inward - a.inward) / (b.inward - a.inward) * (b.height - a.height);
}

/// Per sample the distance inward of the nearest edge of the run whose strip it is in; negative where there is none.
auto distances(const Polygon& polygon, const Run& run, double reach, std::span<const RoofSample> samples)
    -> std::vector<double> {
  const auto& ring = run.ring == 0 ? polygon.outer : polygon.holes[run.ring - 1];
  std::vector<double> out(samples.size(), -1);
  for (const std::size_t edge : run.edges) {
    const Point2 a = ring[edge], vector = ring[(edge + 1) % ring.size()] - a;
    const double length = geometry::length(vector);
    if (!(length > 0)) continue;
    const Point2 direction = (1 / length) * vector, inward = geometry::left_of(direction);
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const double d = dot(samples[s].at - a, inward), along = dot(samples[s].at - a, direction);
      if (d < 0 || d > reach || along < -d || along > length + d) continue;
      if (out[s] < 0 || d < out[s]) out[s] = d;
    }
  }
  return out;
}

class Search {
 public:
  Search(const Polygon& polygon, std::span<const Run> runs, std::span<const Choices> choices,
         std::span<const RoofSample> samples, std::span<const double> caps, const Options& options)
      : options_(options),
        choices_(choices),
        samples_(samples),
        caps_(caps),
        chosen_(runs.size(), 0),
        surfaces_(runs.size()) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const auto& profiles = choices[r].profiles;
      surfaces_[r].resize(profiles.size());
      if (std::ranges::all_of(profiles, [](const Profile& p) { return p.back().inward == 0; })) continue;
      const auto inward = distances(polygon, runs[r], choices[r].reach, samples);
      for (std::size_t c = 0; c < profiles.size(); ++c) {
        if (profiles[c].back().inward == 0) continue;  // no surface: the sky
        auto& surface = surfaces_[r][c];
        surface.resize(samples.size());
        for (std::size_t s = 0; s < samples.size(); ++s)
          surface[s] = inward[s] < 0 ? sky : height_at(profiles[c], inward[s]);
      }
    }
    lower();
  }

  /// Tries the other candidates of a run; whether one was taken.
  auto improve(std::size_t run) -> bool {
    const std::size_t count = surfaces_[run].size();
    if (count < 2) return false;
    std::size_t best = chosen_[run];
    double least = options_.choice_gain * error(run, best);
    for (std::size_t c = 0; c < count; ++c) {
      if (c == chosen_[run]) continue;
      const double e = error(run, c);
      if (e < least) {
        least = e;
        best = c;
      }
    }
    if (best == chosen_[run]) return false;
    chosen_[run] = best;
    lower();
    return true;
  }

  [[nodiscard]] auto chosen() const -> const std::vector<std::size_t>& { return chosen_; }
  [[nodiscard]] auto errors() const -> std::vector<double> {
    std::vector<double> out(caps_.size(), 0);
    for (std::size_t s = 0; s < samples_.size(); ++s) add(out, least_[s], samples_[s].height);
    for (double& e : out) e /= static_cast<double>(std::max<std::size_t>(1, samples_.size()));
    return out;
  }

 private:
  void add(std::vector<double>& errors, double roof, double height) const {
    for (std::size_t k = 0; k < caps_.size(); ++k) {
      const double d = std::min(std::abs(std::min(roof, caps_[k]) - height), options_.choice_outlier);
      errors[k] += d * d;
    }
  }

  [[nodiscard]] auto surface(std::size_t run, std::size_t candidate, std::size_t sample) const -> double {
    const auto& heights = surfaces_[run][candidate];
    if (heights.empty()) return sky;
    return heights[sample];
  }

  /// With the run's profile exchanged, under the cap that suits best.
  [[nodiscard]] auto error(std::size_t run, std::size_t candidate) const -> double {
    std::vector<double> sums(caps_.size(), 0);
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const double others = owner_[s] == run ? second_[s] : least_[s];
      add(sums, std::min(others, surface(run, candidate, s)), samples_[s].height);
    }
    return std::ranges::min(sums);
  }

  /// The lowest two surfaces over every sample.
  void lower() {
    least_.assign(samples_.size(), sky);
    second_.assign(samples_.size(), sky);
    owner_.assign(samples_.size(), surfaces_.size());
    for (std::size_t r = 0; r < surfaces_.size(); ++r) {
      const auto& heights = surfaces_[r][chosen_[r]];
      for (std::size_t s = 0; s < heights.size(); ++s) {
        if (heights[s] < least_[s]) {
          second_[s] = least_[s];
          least_[s] = heights[s];
          owner_[s] = r;
        } else if (heights[s] < second_[s]) {
          second_[s] = heights[s];
        }
      }
    }
  }

  const Options& options_;
  std::span<const Choices> choices_;
  std::span<const RoofSample> samples_;
  std::span<const double> caps_;
  std::vector<std::size_t> chosen_;
  std::vector<std::vector<std::vector<double>>> surfaces_;  ///< per run, candidate and sample
  std::vector<double> least_, second_;
  std::vector<std::size_t> owner_;
};

}  // namespace

auto look_over(const rays::Scene& mesh, const Polygon& polygon, double base, const Options& o)
    -> std::vector<RoofSample> {
  const double grid = std::max(o.choice_grid, std::sqrt(geometry::area(polygon) / o.choice_samples));
  const auto box = geometry::bounds(polygon.outer);
  std::vector<RoofSample> samples;
  const auto columns = static_cast<std::int64_t>(std::floor(box.most.x / grid));
  const auto rows = static_cast<std::int64_t>(std::floor(box.most.y / grid));
  for (auto j = static_cast<std::int64_t>(std::ceil(box.least.y / grid)); j <= rows; ++j) {
    for (auto i = static_cast<std::int64_t>(std::ceil(box.least.x / grid)); i <= columns; ++i) {
      const Point2 at{static_cast<double>(i) * grid, static_cast<double>(j) * grid};
      if (!geometry::contains(polygon, at)) continue;
      if (const auto z = mesh.top_inside_walls(at, base)) samples.push_back({at, *z - base});
    }
  }
  return samples;
}

auto refine(const Polygon& polygon, std::span<const Run> runs, std::span<const Choices> choices,
            std::span<const RoofSample> samples, std::span<const double> caps, const Options& o) -> Refined {
  Search search(polygon, runs, choices, samples, caps, o);
  // The longest runs own most of the roof: they decide first.
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t r = 0; r < runs.size(); ++r) order.emplace_back(-length_of(polygon, runs[r]), r);
  std::ranges::sort(order);
  bool changed = true;
  for (std::size_t round = 0; changed && round < o.choice_rounds; ++round) {
    changed = false;
    for (const auto& [length, run] : order) changed = search.improve(run) || changed;
  }
  return {search.chosen(), search.errors()};
}

}  // namespace mansard::profile::detail
