// A city as binary glTF 2.0, building by building or at once.
#pragma once

#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/gltf/gltf_file.hpp"
#include "mansard/formats/stream.hpp"

namespace mansard::formats::detail {

/// A node for each solid, in the order they are told. Memory grows by about 12 bytes a solid.
class GlbBytes {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open(const Header& header, bool compress, Solids solids) -> base::Result<GlbBytes>;
  /// Fails with "write-triangulate".
  [[nodiscard]] auto add(const model::Building& building, const Gate::Keyed& keys) -> base::Result<void>;
  /// Of solid::unite.
  [[nodiscard]] auto warnings() const -> const std::vector<base::Diagnostic>& { return warnings_; }
  /// Fails with "write-glb-size", "file-write".
  [[nodiscard]] auto write(base::Sink& sink) -> base::Result<void>;

 private:
  GlbBytes(Header header, Solids solids, std::unique_ptr<GltfFile> file)
      : header_(std::move(header)), solids_(solids), file_(std::move(file)) {}

  Header header_;
  Solids solids_;
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
