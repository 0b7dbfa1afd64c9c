// Tags by any of their names, and their values as numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/model/attributes.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof::detail {

/// A tag as a feature has it.
struct Tag {
  std::string name;  ///< the attribute's, or the key in the hstore text
  std::string text;  ///< not empty, without blanks around it
};

/// One tag of the simple 3D scheme. `names` are in lower case with '_' for ':', '-', '.' and blanks: its own, those of
/// other schemes, and what ten letters of a Shapefile leave of them.
struct Key {
  std::string_view tag;
  std::vector<std::string_view> names;
  std::string Options::*attribute = nullptr;  ///< the option that names an attribute instead; null for none
};

namespace keys {
[[nodiscard]] auto height() -> const Key&;
[[nodiscard]] auto levels() -> const Key&;
[[nodiscard]] auto min_height() -> const Key&;
[[nodiscard]] auto min_level() -> const Key&;
[[nodiscard]] auto shape() -> const Key&;
[[nodiscard]] auto roof_height() -> const Key&;
[[nodiscard]] auto roof_levels() -> const Key&;
[[nodiscard]] auto angle() -> const Key&;
[[nodiscard]] auto orientation() -> const Key&;
[[nodiscard]] auto direction() -> const Key&;
[[nodiscard]] auto ground() -> const Key&;
[[nodiscard]] auto wall_colour() -> const Key&;
[[nodiscard]] auto wall_material() -> const Key&;
[[nodiscard]] auto roof_colour() -> const Key&;
[[nodiscard]] auto roof_material() -> const Key&;
[[nodiscard]] auto all() -> const std::vector<const Key*>&;
}  // namespace keys

/// A feature's attributes, prepared for queries.
class Tags {
 public:
  Tags(const model::Attributes& attributes, const Options& options);
  [[nodiscard]] auto find(const Key& key) const -> std::optional<Tag>;

 private:
  struct Entry {
    std::string name;  ///< as Key::names
    const std::string* original;
    const model::Value* value;
  };
  std::vector<Entry> entries_;
  const Options& options_;
};

/// The value of a key in hstore text ("a"=>"b", "c"=>"d") or a JSON object of texts.
[[nodiscard]] auto in_hstore(std::string_view text, std::string_view key) -> std::optional<std::string>;

/// Lower case with '_' for ':', '-', '.' and blanks.
[[nodiscard]] auto plain(std::string_view name) -> std::string;

/// "12", "12.5 m", "12,5", "39'4\"", "40 ft", "1250 cm" as metres.
[[nodiscard]] auto length_of(std::string_view text) -> std::optional<double>;
/// "30", "30°", "30 deg" as radians.
[[nodiscard]] auto angle_of(std::string_view text) -> std::optional<double>;
/// "135", "SE", "south-east" as radians clockwise from north, from 0 to 2π.
[[nodiscard]] auto bearing_of(std::string_view text) -> std::optional<double>;
/// A number without a unit.
[[nodiscard]] auto count_of(std::string_view text) -> std::optional<double>;

/// "#b03020", "#b32", "red" and the other names of CSS, in any case.
[[nodiscard]] auto colour_of(std::string_view text) -> std::optional<Colour>;

/// What a material looks like, by OpenStreetMap's name for it.
[[nodiscard]] auto colour_of_material(std::string_view material) -> std::optional<Colour>;

/// The shape of a roof:shape, and whether it is that shape or only the nearest one.
struct Named {
  Shape shape = Shape::flat;
  bool exact = true;
};
[[nodiscard]] auto shape_of(std::string_view text) -> std::optional<Named>;

}  // namespace mansard::roof::detail
