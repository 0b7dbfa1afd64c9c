// Plan + profiles as JSON and back: docs/formats.md and docs/plan.schema.json describe the format.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/stream.hpp"

namespace mansard::formats::detail {

/// The members "type", "version", "made_by" and "frame" of a file of plans; on lines of that level, or on one line when
/// negative.
void append_header(JsonText& json, const Header& header, int level = -1);
/// One of its "buildings", without models; its brackets at that level, or on one line when negative.
void append_building(JsonText& json, const model::Building& building, int level = -1);

/// {"origin", "crs"}.
void append_frame(JsonText& json, const model::Frame& frame);
/// [{"outer", "holes"}, …].
void append_footprint(JsonText& json, const std::vector<geometry::Polygon>& footprint);

/// A file of plans, building by building.
class PlansText {
 public:
  PlansText(const Header& header, base::Sink& sink);
  void add(const model::Building& building);
  void end();

 private:
  JsonText json_;
  base::Sink& sink_;
};

/// `name` is the file's, for messages. Fails with the "write-plan-…" codes; parts that are at fault are left out,
/// and `refused` has the same codes.
[[nodiscard]] auto parse_plans(std::string_view text, const std::string& name, std::vector<base::Diagnostic>& refused)
    -> base::Result<model::City>;
/// Reads building by building where the file is large, and its buildings come last and near their origin; else null.
[[nodiscard]] auto large_plans_reader(const std::filesystem::path& path) -> std::unique_ptr<CityReader>;
/// One plan by itself; the same codes.
[[nodiscard]] auto parse_plan(std::string_view text, const std::string& name) -> base::Result<model::Plan>;

}  // namespace mansard::formats::detail
