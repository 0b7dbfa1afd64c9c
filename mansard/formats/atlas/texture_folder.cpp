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

}  // namespace mansard::formats::detail
