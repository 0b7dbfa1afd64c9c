// The pieces of a file of plans, read strictly: unknown members, wrong types and impossible profiles are Defects that
// name their place.
#pragma once

#include <array>
#include <initializer_list>

#include "mansard/formats/json/json_item.hpp"
#include "mansard/formats/stream.hpp"

namespace mansard::formats::detail {

/// Limits of docs/plan.schema.json, m: of coordinates from the origin of their frame, of the origin, of caps, of points
/// of profiles, of overhangs. Doubles are 1.5e-8 m apart at the first and 1.2e-7 m at the second, where files have
/// 1e-4 m; the others are those of the extrusion.
inline constexpr double farthest = 1e8, farthest_origin = 1e9, highest_cap = 1e5, longest_profile = 1e6,
                        farthest_overhang = 3;

/// m; as in bring_near: plans whose middle is farther from their origin get one near it, for which all must be read.
inline constexpr double near_origin = 5e4;

/// "type", "version", "made_by" and "frame"; `others` are members that the file may have beside them.
[[nodiscard]] auto read_header(const Item& item, std::initializer_list<const char*> others) -> Header;
/// Parts that are at fault are left out and listed in `refused`, if there is one; else the first ends the reading.
[[nodiscard]] auto read_building(const Item& item, std::vector<base::Diagnostic>* refused = nullptr) -> model::Building;
[[nodiscard]] auto read_attributes(const Item& item) -> model::Attributes;
[[nodiscard]] auto read_made_by(const Item& item) -> model::MadeBy;
/// {"origin", "crs"}.
[[nodiscard]] auto read_frame(const Item& item) -> model::Frame;
/// [{"outer", "holes"}, …].
[[nodiscard]] auto read_footprint(const Item& item) -> std::vector<geometry::Polygon>;
/// Three whole numbers of metres.
[[nodiscard]] auto read_origin(const Item& item) -> std::array<std::int64_t, 3>;
/// A plan by itself: these members and no others.
[[nodiscard]] auto read_plan_item(const Item& item) -> model::Plan;
/// From coordinates relative to `own` to those relative to `origin`, metres.
[[nodiscard]] auto offset_between(const std::array<std::int64_t, 3>& own, const std::array<std::int64_t, 3>& origin)
    -> geometry::Point3;
/// A plan with "type", "version" and the "origin" it is relative to, moved to `origin`: files put together from several
/// may have plans of several origins.
[[nodiscard]] auto read_embedded_plan(const Item& item, const std::array<std::int64_t, 3>& origin) -> model::Plan;

}  // namespace mansard::formats::detail
