// What every format needs of a city: unique keys, sound models, attributes and plans as JSON.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/json/json_text.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats::detail {

inline constexpr std::string_view plan_type = "mansard-plan";
inline constexpr int plan_version = 1;

/// The key of every building and of every part, unique in the city.
struct Keys {
  std::vector<std::string> buildings;
  std::vector<std::vector<std::string>> parts;  ///< per building
};

/// Ids as they are; a part whose id is taken (building "7-1" beside part 1 of building "7") gets "-part" appended.
/// Fails with "write-duplicate-id" when two buildings share one.
[[nodiscard]] auto keys_of(const model::City& city) -> base::Result<Keys>;

/// Holds every model against what a writer relies on: finite coordinates within 10,000 km, loops that name vertices, a
/// class per face, unit normals. Fails with "write-model".
[[nodiscard]] auto check_models(const model::City& city) -> base::Result<void>;
[[nodiscard]] auto check_model(const model::Building& building) -> base::Result<void>;

/// wall, party_wall, roof, ground, soffit: the names of materials, in the order of label::Class.
[[nodiscard]] auto class_name(model::FaceClass c) -> std::string_view;
inline constexpr std::size_t class_count = 5;

/// The classes' colours, sRGB: those of picture/picture.hpp, which this module does not depend on.
inline constexpr std::array<std::array<int, 3>, class_count> class_colours{
    {{216, 212, 204}, {150, 150, 158}, {176, 98, 80}, {120, 124, 120}, {150, 132, 112}}};

/// Coordinates in the frame of the files.
[[nodiscard]] auto in_file_frame(const model::Frame& frame, geometry::Point3 p) -> geometry::Point3;

/// {"generator", "version", "options", "inputs"}.
void append_made_by(JsonText& json, const model::MadeBy& made_by);
/// The members of an attributes object. Of attributes with one name the last is kept: ours come after the source's.
void append_attributes(JsonText& json, const model::Attributes& attributes);
void append_value(JsonText& json, const model::Value& value);
/// [[x, y], …] on one line.
void append_ring(JsonText& json, const geometry::Ring& ring);
/// The members "base", "cap", "outer", "holes", "profiles"; on lines from that level on, or on one line when negative.
void append_plan(JsonText& json, const model::Plan& plan, int level = -1);

}  // namespace mansard::formats::detail
