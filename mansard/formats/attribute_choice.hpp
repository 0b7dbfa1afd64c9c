// Which of a building's attributes are written, and under which names.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/attributes.hpp"

namespace mansard::formats {

/// A chosen attribute: its name here, and its name in files.
using AttributeName = std::pair<std::string_view, std::string_view>;

/// The names that consumers of other producers' models expect of buildings.
struct NamePreset {
  std::string_view name, meaning, source;
  std::vector<AttributeName> names;
};
[[nodiscard]] auto name_presets() -> const std::vector<NamePreset>&;

/// Guarantees: 1 attributes of the source are written as they are, whatever is chosen · 2 of the attributes that
/// mansard computes, those that were chosen are written, in the order of the building.
class AttributeChoice {
 public:
  /// Of the text of the option write.attributes: "all", "none", the name of a preset, or a list of names, each with
  /// "=new name" where it is renamed. Fails with "option-value".
  [[nodiscard]] static auto of(std::string_view text) -> base::Result<AttributeChoice>;

  [[nodiscard]] auto is_all() const -> bool { return all_; }
  [[nodiscard]] auto chosen(const model::Attributes& attributes) const -> model::Attributes;
  /// The names of a list, not those of a preset, which has more than any building.
  [[nodiscard]] auto listed() const -> std::vector<std::string>;

 private:
  bool all_ = true, list_ = false;
  std::vector<std::pair<std::string, std::string>> names_;
};

/// Whether mansard computes an attribute of that name: "ms_…", and CityGML's measuredHeight, roofType and
/// storeysAboveGround, which a source may have, too.
[[nodiscard]] auto is_computed(std::string_view name) -> bool;

}  // namespace mansard::formats
