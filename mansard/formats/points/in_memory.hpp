// A cloud whose points are all in memory: of formats without an index and without records of one length.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "mansard/formats/points.hpp"

namespace mansard::formats {

class CloudInMemory : public PointCloud {
 public:
  /// The number of points and their bounds are taken from the points.
  CloudInMemory(std::vector<CloudPoint> points, PointInfo info, model::InputFile input)
      : points_(std::move(points)), info_(std::move(info)), input_(std::move(input)) {
    info_.points = points_.size();
    geometry::Box3 box;
    for (const auto& [at, classification, number, returns, withheld, source, intensity, colour] : points_)
      if (std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z)) box.add(at);
    if (!box.empty()) info_.stated_bounds = box;
  }
  [[nodiscard]] auto info() const -> const PointInfo& override { return info_; }
  [[nodiscard]] auto pieces() const -> std::size_t override { return (points_.size() + piece - 1) / piece; }
  [[nodiscard]] auto points_of(std::size_t i) const -> std::uint64_t override {
    return std::min(piece, points_.size() - i * piece);
  }
  [[nodiscard]] auto box_of(std::size_t /*piece*/) const -> std::optional<geometry::Box3> override {
    return std::nullopt;
  }
  [[nodiscard]] auto read(std::size_t i) const -> base::Result<std::vector<CloudPoint>> override {
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(i * piece);
    return std::vector<CloudPoint>(first, first + static_cast<std::ptrdiff_t>(points_of(i)));
  }
  [[nodiscard]] auto inputs() const -> base::Result<std::vector<model::InputFile>> override {
    return std::vector{input_};
  }

 private:
  static constexpr std::size_t piece = 65536;
  std::vector<CloudPoint> points_;
  PointInfo info_;
  model::InputFile input_;
};

}  // namespace mansard::formats
