// The solids of a building as they are written: what textures are made for.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/formats/stream.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats {

/// In the order of every file that has models. A building that cannot be written has none.
[[nodiscard]] auto written_solids(const model::Building& building, Solids solids) -> std::vector<model::LabelledSolid>;

/// Pixels along a face's picture that there is room for in an image of these options.
[[nodiscard]] auto largest_picture(const WriteOptions& options) -> std::uint32_t;

}  // namespace mansard::formats
