// Buildings as OBJ, with their records as comments.
#pragma once

#include <string>
#include <string_view>

#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {

/// What comments that carry records start with; the rest of the line is JSON.
inline constexpr std::string_view obj_header = "#mansard header ", obj_building = "#mansard building ";

/// An OBJ file, building by building. Buildings must have passed a Gate.
class ObjText {
 public:
  ObjText(const Header& header, Solids solids) : frame_(header.frame), solids_(solids) {}
  /// What stands before the first building.
  [[nodiscard]] static auto head(const Header& header, const std::string& mtl_name) -> std::string;
  /// Fails with "write-triangulate".
  [[nodiscard]] auto of(const model::Building& building, const Gate::Keyed& keys) -> base::Result<std::string>;
  /// Of solid::unite.
  [[nodiscard]] auto warnings() const -> const std::vector<base::Diagnostic>& { return warnings_; }

 private:
  void append_part(std::string& out, const model::Part& part,
                   const std::array<std::vector<std::vector<std::uint32_t>>, class_count>& facets);

  const model::Frame frame_;
  const Solids solids_;
  std::vector<base::Diagnostic> warnings_;
  std::size_t written_ = 0;  ///< vertices; OBJ counts them through the whole file, from 1
};

[[nodiscard]] auto mtl_text() -> std::string;

}  // namespace mansard::formats::detail
