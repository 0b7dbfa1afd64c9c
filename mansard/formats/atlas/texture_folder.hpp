// The images with textures in a folder beside a file.
#pragma once

#include <filesystem>
#include <string>

#include "mansard/base/outputs.hpp"
#include "mansard/formats/atlas/atlas.hpp"

namespace mansard::formats::detail {

/// The solids of a building in an atlas: the first of them, and the number of the atlas's first image in the file.
struct TexturedSolids {
  const SolidAtlas* atlas = nullptr;
  std::size_t first = 0;
  std::uint32_t first_page = 0;
};

/// JPEG, numbered through all atlases of a file. The folder is there from the first image on, and takes its place with
/// the file.
class TextureFolder {
 public:
  TextureFolder(const std::filesystem::path& file, const WriteOptions& options, base::Outputs& outputs);
  /// Returns the number of the atlas's first image. Fails with "file-write", "texture-encode".
  [[nodiscard]] auto write(const SolidAtlas& atlas) -> base::Result<std::uint32_t>;
  [[nodiscard]] auto pages() const -> std::uint32_t { return pages_; }
  /// As the file names an image: "model_obj_textures/0000.jpg".
  [[nodiscard]] auto name(std::uint32_t page) const -> std::string;

 private:
  std::filesystem::path folder_;
  int quality_;
  base::Outputs* outputs_;
  std::filesystem::path place_;  ///< until the outputs are committed; empty before the first image
  std::uint32_t pages_ = 0;
};

/// The textures of a building for its solids, where they are of these; else nothing.
[[nodiscard]] auto textures_for(const model::Building& building, std::size_t solids) -> const model::BuildingTexture*;

/// Empties a queue into one atlas: `before(atlas)` once the places of all pictures are known, which returns the number
/// of its first image, then `each(building number, building, textured)` in order; `textured` is null for a building
/// without textures. Fails as these do.
template <class Before, class Each>
[[nodiscard]] auto empty_queue(AtlasQueue& queue, std::uint32_t side, Before before, Each each) -> base::Result<void> {
  SolidAtlas atlas(side);
  std::vector<std::size_t> first;
  std::size_t solids = 0;
  for (const auto& building : queue.waiting) {
    first.push_back(solids);
    if (!building.texture) continue;
    for (const auto& solid : building.texture->solids) solids = atlas.add(solid) + 1;
  }
  atlas.settle();
  std::uint32_t page = 0;
  if (atlas.pages() > 0) {
    const auto number = before(atlas);
    if (!number) return number.failure();
    page = *number;
  }
  for (std::size_t b = 0; b < queue.waiting.size(); ++b) {
    const TexturedSolids textured{&atlas, first[b], page};
    if (auto done = each(b, queue.waiting[b], queue.waiting[b].texture ? &textured : nullptr); !done) return done;
  }
  queue.clear();
  return {};
}

}  // namespace mansard::formats::detail
