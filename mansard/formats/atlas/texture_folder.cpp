#include "mansard/formats/atlas/texture_folder.hpp"

#include "mansard/base/files.hpp"
#include "mansard/formats/results.hpp"

namespace mansard::formats::detail {

TextureFolder::TextureFolder(const std::filesystem::path& file, const WriteOptions& options, base::Outputs& outputs)
    : folder_(textures_beside(file)), quality_(static_cast<int>(options.texture_quality)), outputs_(&outputs) {}

auto TextureFolder::name(std::uint32_t page) const -> std::string {
  std::string number = std::to_string(page);
  constexpr std::size_t digits = 4;
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return folder_.filename().string() + "/" + number + std::string(image_extension(ImageCodec::jpeg));
}

auto TextureFolder::write(const SolidAtlas& atlas) -> base::Result<std::uint32_t> {
  if (place_.empty()) {
    auto place = outputs_->folder(folder_);
    if (!place) return place.failure();
    place_ = std::move(*place);
  }
  const std::uint32_t first = pages_;
  for (std::size_t page = 0; page < atlas.pages(); ++page) {
    const auto bytes = encode_image(atlas.page(page), ImageCodec::jpeg, quality_);
    if (!bytes) return bytes.failure();
    const auto file = place_ / std::filesystem::path(name(pages_++)).filename();
    if (auto written = base::write_file(file, *bytes); !written) return written.failure();
  }
  return first;
}

auto textures_for(const model::Building& building, std::size_t solids) -> const model::BuildingTexture* {
  return building.texture && building.texture->solids.size() == solids ? &*building.texture : nullptr;
}

TextureQueue::TextureQueue(const WriteOptions& options) : side_(static_cast<std::uint32_t>(options.atlas_size)) {}

auto TextureQueue::put(const model::Building& building, Gate::Keyed keys) -> base::Result<void> {
  if (!building.texture && waiting_.empty()) return write(building, keys, nullptr);
  const std::uint64_t area = area_in_atlas(building), room = std::uint64_t{side_} * side_ / 5 * 4;
  if (!waiting_.empty() && area_ + area > room)
    if (auto done = empty(); !done) return done;
  waiting_.push_back({building, std::move(keys)});
  area_ += area;
  return {};
}

auto TextureQueue::empty() -> base::Result<void> {
  SolidAtlas atlas(side_);
  std::vector<std::size_t> first;
  std::size_t solids = 0;
  for (const auto& [building, keys] : waiting_) {
    first.push_back(solids);
    if (!building.texture) continue;
    for (const auto& solid : building.texture->solids) solids = atlas.add(solid) + 1;
  }
  atlas.settle();
  std::uint32_t page = 0;
  if (atlas.pages() > 0) {
    const auto number = images(atlas);
    if (!number) return number.failure();
    page = *number;
  }
  for (std::size_t b = 0; b < waiting_.size(); ++b) {
    const auto& [building, keys] = waiting_[b];
    const TexturedSolids textured{&atlas, first[b], page};
    if (auto done = write(building, keys, building.texture ? &textured : nullptr); !done) return done;
  }
  waiting_.clear();
  area_ = 0;
  return {};
}

}  // namespace mansard::formats::detail
