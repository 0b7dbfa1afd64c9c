// The colours of point clouds, piece by piece.
#include <algorithm>
#include <array>

#include "mansard/base/stopped.hpp"
#include "mansard/cloud/classes.hpp"
#include "mansard/formats/points.hpp"
#include "mansard/ingest/detail/mesh_files.hpp"

namespace mansard::ingest::detail {
namespace {

using formats::CloudPoint;

/// What cannot be the surface of a building nor the ground around it: noise, vegetation and wires by class, and what a
/// pulse went through. `as`: the class that the point's is taken for, here and below.
auto is_surface(const CloudPoint& p, std::uint8_t as) -> bool {
  using enum cloud::Use;
  const auto use = cloud::use_of(as);
  return !p.withheld && p.return_number >= p.returns && use != vegetation && use != wires && use != outliers;
}

auto is_ground(std::uint8_t as) -> bool {
  constexpr std::array ground{2, 9, 10, 11};
  return std::ranges::find(ground, as) != ground.end();
}

auto brightest(const std::vector<CloudPoint>& points) -> std::uint16_t {
  std::uint16_t most = 0;
  for (const auto& p : points) most = std::max(most, std::ranges::max(p.colour));
  return most;
}

/// The bits by which values are larger than 8 bits: 8 or 0; none where no point has a colour. LAS asks for 16 bits, and
/// many producers write 8: values up to 255 in four pieces, evenly spaced over the cloud, are 8 bits. All pieces are
/// looked at where these are black.
auto spare_bits(const formats::PointCloud& cloud, const base::Run& run) -> base::Result<std::optional<int>> {
  constexpr std::size_t few = 4;
  const std::size_t all = cloud.pieces(), spaced = std::min(few, all);
  std::uint16_t most = 0;
  for (std::size_t k = 0; k < spaced + all; ++k) {
    if (run.cancelled()) return base::stopped();
    if (k >= spaced && most > 0) break;
    const auto points = cloud.read(k < spaced ? k * all / spaced : k - spaced);
    if (!points) return points.failure();
    most = std::max(most, brightest(*points));
    if (most > 255) return std::optional<int>(8);
  }
  return most > 0 ? std::optional<int>(0) : std::nullopt;
}

}  // namespace

auto MeshReading::colours_of_clouds(const geometry::Box2& within, const TakePoints& take, const base::Run& run) const
    -> base::Result<void> {
  const auto map = cloud::class_map(options_.cloud);
  if (!map) return map.failure();
  for (const auto& source : sources_) {
    if (!source.cloud || !source.cloud->info().has_colours) continue;
    const auto& cloud = *source.cloud;
    const auto box = source.way ? source.way->back(within) : std::optional(within);
    // As for the surface: of one file the header's box is a hint only.
    const auto& stated = cloud.info().stated_bounds;
    if (box && sources_.size() > 1 && stated && !stated->plan().overlaps(*box)) continue;
    const auto spare = spare_bits(cloud, run);
    if (!spare) return spare.failure();
    const auto& bits = *spare;
    if (!bits) continue;
    const int shift = *bits;
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < cloud.pieces(); ++i)
      if (const auto own = cloud.box_of(i); !box || !own || own->plan().overlaps(*box)) wanted.push_back(i);
    constexpr std::size_t at_a_time = 8;  // bounds memory; threads are fewer on most machines
    for (std::size_t first = 0; first < wanted.size(); first += at_a_time) {
      if (run.cancelled()) return base::stopped();
      std::vector<std::optional<base::Result<std::vector<formats::ColouredPoint>>>> some(
          std::min(at_a_time, wanted.size() - first));
      base::parallel_for(some.size(), [&](std::size_t i) {
        const auto points = cloud.read(wanted[first + i]);
        if (!points) {
          some[i] = points.failure();
          return;
        }
        std::vector<formats::ColouredPoint> coloured;
        std::vector<geometry::Point3> positions;
        for (const auto& p : *points) {
          const std::uint8_t as = (*map)[p.classification];
          if (!is_surface(p, as) || std::ranges::max(p.colour) == 0) continue;
          auto& point = coloured.emplace_back();
          for (std::size_t c = 0; c < 3; ++c)
            point.colour[c] = formats::linear_of(static_cast<std::uint8_t>(std::min(p.colour[c] >> shift, 255)));
          point.ground = is_ground(as);
          positions.push_back(p.position);
        }
        if (source.way) source.way->take(positions);
        for (std::size_t k = 0; k < positions.size(); ++k) coloured[k].position = positions[k];
        some[i] = std::move(coloured);
      });
      for (auto& one : some) {
        if (!one) continue;  // each was read
        auto& read = *one;
        if (!read) return read.failure();
        if (auto taken = take(*std::move(read)); !taken) return taken;
      }
      run.report("texture", source.path.string(), static_cast<double>(first) / static_cast<double>(wanted.size()));
    }
  }
  return {};
}

}  // namespace mansard::ingest::detail
