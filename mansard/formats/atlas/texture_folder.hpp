// The images with textures in a folder beside a file.
#pragma once

#include <filesystem>
#include <string>

#include "mansard/base/outputs.hpp"
#include "mansard/formats/atlas/atlas.hpp"
#include "mansard/formats/detail/writers.hpp"

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

/// What every writer of textures does: buildings wait until their pictures fill an image. One without textures that
/// none is waiting before is written at once. All are written in the order in which they come.
class TextureQueue {
 public:
  explicit TextureQueue(const WriteOptions& options);
  virtual ~TextureQueue() = default;

 protected:
  // A writer of GLB is moved.
  TextureQueue(TextureQueue&&) = default;
  auto operator=(TextureQueue&&) -> TextureQueue& = default;

  /// Writes the images of an atlas; returns the number of its first one in the file.
  [[nodiscard]] virtual auto images(const SolidAtlas& atlas) -> base::Result<std::uint32_t> = 0;
  /// `textured` is null for a building without textures.
  [[nodiscard]] virtual auto write(const model::Building& building, const Gate::Keyed& keys,
                                   const TexturedSolids* textured) -> base::Result<void> = 0;

  /// Both fail as images() and write() do.
  [[nodiscard]] auto put(const model::Building& building, Gate::Keyed keys) -> base::Result<void>;
  [[nodiscard]] auto empty() -> base::Result<void>;

 private:
  struct Waiting {
    model::Building building;
    Gate::Keyed keys;
  };
  std::uint32_t side_;
  std::vector<Waiting> waiting_;
  std::uint64_t area_ = 0;  ///< of the pictures of those that wait
};

}  // namespace mansard::formats::detail
