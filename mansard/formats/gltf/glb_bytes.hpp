// A city as binary glTF 2.0, building by building or at once.
#pragma once

#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/gltf/gltf_file.hpp"
#include "mansard/formats/stream.hpp"

namespace mansard::formats::detail {

/// A node for each solid, in the order they are told. Memory grows by about 12 bytes a solid.
class GlbBytes : private TextureQueue {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open(const Header& header, const WriteOptions& options) -> base::Result<GlbBytes>;
  /// The level of detail of the solids that come; LoD 2.2 unless it is set.
  void set_level(const LevelOf& level) { level_ = level; }
  /// Buildings with textures wait until these fill an image. Fails with "write-triangulate", "texture-encode".
  [[nodiscard]] auto add(const model::Building& building, Gate::Keyed keys) -> base::Result<void> {
    return put(building, std::move(keys));
  }
  /// Of solid::unite.
  [[nodiscard]] auto warnings() const -> const std::vector<base::Diagnostic>& { return warnings_; }
  /// Fails with "write-glb-size", "file-write".
  [[nodiscard]] auto write(base::Sink& sink) -> base::Result<void>;

 private:
  GlbBytes(Header header, const WriteOptions& options, std::unique_ptr<GltfFile> file)
      : TextureQueue(options), header_(std::move(header)), solids_(options.solids), file_(std::move(file)) {}
  [[nodiscard]] auto images(const SolidAtlas& atlas) -> base::Result<std::uint32_t> override {
    return file_->add_images(atlas);
  }
  [[nodiscard]] auto write(const model::Building& building, const Gate::Keyed& keys, const TexturedSolids* textured)
      -> base::Result<void> override;

  Header header_;
  Solids solids_;
  LevelOf level_;
  std::vector<base::Diagnostic> warnings_;
  std::unique_ptr<GltfFile> file_;
  PartColumns columns_;
  std::int64_t buildings_ = 0;
};

/// The members "crs", "origin" and "header" (that of a plans.json) of a file.
void append_file_extras(JsonText& json, const Header& header);

/// The whole city in memory.
[[nodiscard]] auto glb_bytes(const model::City& city, const Keys& keys, Solids solids) -> base::Result<std::string>;

}  // namespace mansard::formats::detail
