#include "mansard/formats/written.hpp"

#include "mansard/formats/atlas/atlas.hpp"
#include "mansard/formats/detail/drawn.hpp"

namespace mansard::formats {

auto written_solids(const model::Building& building, Solids solids) -> std::vector<model::LabelledSolid> {
  if (!detail::check_model(building)) return {};
  detail::Gate::Keyed keys{building.id, {}};
  for (const auto& part : building.parts) keys.parts.push_back(part.id);
  std::vector<model::LabelledSolid> out;
  for (auto& solid : detail::drawn(building, keys, solids).solids) out.push_back(std::move(solid.part.model));
  return out;
}

auto largest_picture(const WriteOptions& options) -> std::uint32_t {
  return detail::usable_side(static_cast<std::uint32_t>(options.atlas_size));
}

}  // namespace mansard::formats
