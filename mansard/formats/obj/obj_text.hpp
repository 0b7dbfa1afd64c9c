// Buildings as OBJ, and what they are read back from in a file beside it.
#pragma once

#include <string>
#include <string_view>

#include "mansard/formats/atlas/texture_folder.hpp"
#include "mansard/formats/detail/flat_level.hpp"
#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {

/// The file beside an OBJ that it is read back from: the header and every building as JSON, a line each. Importers read
/// lines of an OBJ into buffers (Blender's holds 65,536 characters), so that records do not belong into it.
[[nodiscard]] auto obj_plans(const Path& path) -> Path;

/// What comments with records start with in older files, which had them in the OBJ; the rest of the line is JSON.
inline constexpr std::string_view obj_header = "#mansard header ", obj_building = "#mansard building ";

/// An OBJ file, building by building. Buildings must have passed a Gate.
class ObjText {
 public:
  ObjText(const Header& header, Solids solids) : frame_(header.frame), solids_(solids) {}
  /// The axis that points up, whether coordinates are relative to the frame's origin, and the level of detail.
  ObjText(const Header& header, const WriteOptions& options, const LevelOf& level)
      : frame_(header.frame),
        solids_(options.solids),
        y_up_(options.obj_up == UpAxis::y),
        local_(options.obj_local),
        level_(level) {}
  /// What stands before the first building. No line is longer than 1,000 characters.
  [[nodiscard]] auto head(const Header& header, const std::string& mtl_name) const -> std::string;
  /// With `textured`, faces have texture coordinates, and materials of their class and image. Fails with
  /// "write-triangulate".
  [[nodiscard]] auto of(const model::Building& building, const Gate::Keyed& keys,
                        const TexturedSolids* textured = nullptr) -> base::Result<std::string>;
  /// Of solid::unite.
  [[nodiscard]] auto warnings() const -> const std::vector<base::Diagnostic>& { return warnings_; }

 private:
  struct Facet {
    std::size_t face = 0;
    std::vector<std::uint32_t> corners;
  };
  using Facets = std::array<std::vector<Facet>, class_count>;

  [[nodiscard]] static auto facets_of(const model::Part& part) -> base::Result<Facets>;
  /// `solid`: its number in the atlas.
  void append_part(std::string& out, const model::Part& part, const Facets& facets, const TexturedSolids* textured,
                   std::size_t solid);

  const model::Frame frame_;
  const Solids solids_;
  const bool y_up_ = false, local_ = false;
  const LevelOf level_;
  std::vector<base::Diagnostic> warnings_;
  std::size_t written_ = 0;  ///< vertices; OBJ counts them through the whole file, from 1
  std::size_t placed_ = 0;   ///< texture coordinates
};

/// A material of each class with that image.
[[nodiscard]] auto textured_mtl_text(std::uint32_t page, const std::string& image) -> std::string;

[[nodiscard]] auto mtl_text() -> std::string;

}  // namespace mansard::formats::detail
