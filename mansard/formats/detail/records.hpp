// A building without its models as one line of JSON, as a plans.json has it. It travels in every format that has room
// for a text, so that whatever mansard wrote can be opened, changed and extruded again.
#pragma once

#include <string>
#include <string_view>

#include "mansard/formats/stream.hpp"

namespace mansard::formats::detail {

/// {"id", "attributes", "ground", "footprint", "parts"} on one line: a member of "buildings" of docs/plan.schema.json.
[[nodiscard]] auto building_record(const model::Building& building) -> std::string;
/// {"type", "version", "made_by", "frame"} on one line: the rest of a plans.json.
[[nodiscard]] auto header_record(const Header& header) -> std::string;

/// As strictly as a plans.json; `name` is the file's, for messages. Fails with "write-plan-…".
[[nodiscard]] auto read_building_record(std::string_view json, const std::string& name)
    -> base::Result<model::Building>;
[[nodiscard]] auto read_header_record(std::string_view json, const std::string& name) -> base::Result<Header>;

}  // namespace mansard::formats::detail
