#include "mansard/profile/raw.hpp"

#include <algorithm>
#include <cassert>

#include "mansard/profile/detail/climb.hpp"
#include "mansard/profile/detail/runs.hpp"
#include "mansard/profile/detail/section_index.hpp"

namespace mansard::profile {

struct RawProfiles::Parts {
  detail::SectionIndex index;
};

RawProfiles::RawProfiles(const geometry::Mesh& mesh) : parts_(new Parts{detail::SectionIndex(mesh)}) {}
RawProfiles::RawProfiles(RawProfiles&&) noexcept = default;
auto RawProfiles::operator=(RawProfiles&&) noexcept -> RawProfiles& = default;
RawProfiles::~RawProfiles() = default;

auto RawProfiles::behind(const geometry::Polygon& polygon, std::size_t ring, std::size_t edge, double base,
                         const Options& options) const -> std::vector<RawProfile> {
  assert(ring <= polygon.holes.size());
  std::vector<RawProfile> out;
  for (const auto& sample : detail::samples_of(polygon, {ring, {edge}}, options)) {
    const double reach = std::min(sample.reach, options.slice_inward);
    const auto pieces = parts_->index.cut({sample.foot, sample.inward, -options.slice_outward, reach});
    const auto climb = detail::climb(pieces, options, base);
    if (!climb) continue;
    auto& raw = out.emplace_back(RawProfile{sample.foot, sample.along, {}});
    for (const auto& point : climb->points) raw.points.push_back({point.inward, point.height - base});
  }
  return out;
}

}  // namespace mansard::profile
