// The levels of detail of a building, as files have them, and which of them are written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/model/city.hpp"
#include "mansard/solid/levels.hpp"

namespace mansard::formats {

enum class Lod : std::uint8_t { lod0, lod12, lod13, lod20, lod22 };
inline constexpr std::size_t lod_count = 5;
/// "0", "1.2", "1.3", "2.0", "2.2", as CityJSON spells them.
[[nodiscard]] auto name_of(Lod lod) -> std::string_view;
/// "lod12": as names of attributes end.
[[nodiscard]] auto suffix_of(Lod lod) -> std::string;

/// Those that a format writes, rising.
using Lods = std::vector<Lod>;
/// The LoDs that are written to a format where nothing is asked for; empty where the format has no models.
[[nodiscard]] auto default_lods(Format format) -> Lods;
/// The LoDs that a format can have.
[[nodiscard]] auto possible_lods(Format format) -> Lods;
/// Of the text of the option write.lod: "1.2,2.2" for all formats, "cityjson=0,1.2;obj=1.3" for some, or both. A list
/// for all formats is reduced to what a format can have; formats with one solid a building take the finest of it.
/// Fails with "option-value".
[[nodiscard]] auto lods_of(std::string_view text, Format format) -> base::Result<Lods>;
/// Whether every format and every level in the text is known. Fails with "option-value".
[[nodiscard]] auto check_lods(std::string_view text) -> base::Result<void>;

/// A solid of a building at its levels of detail, each valid or without faces.
struct Levels {
  model::LabelledSolid lod12, lod13, lod20, lod22;
  [[nodiscard]] auto at(Lod lod) const -> const model::LabelledSolid&;
};

/// The solids that are written of a building: its union, or what was made of it. The heights of flat roofs are those of
/// the attribute ms_h_roof_70p, in the heights of `frame`, or else half-way up the roof.
[[nodiscard]] auto levels_of(const model::Building& building, const model::Frame& frame,
                             const solid::LevelOptions& options) -> std::vector<Levels>;

}  // namespace mansard::formats
