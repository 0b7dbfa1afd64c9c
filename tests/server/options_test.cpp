// What /api/options says: options, presets and file formats.
#include <gmock/gmock.h>

#include <algorithm>

#include "apps/server/formats.hpp"
#include "apps/server/options.hpp"

namespace mansard::server {
namespace {

TEST(Options, have_a_module_a_kind_a_range_and_a_use) {
  const auto options = options_json()["options"];
  const auto gamma = std::ranges::find_if(
      options, [](const auto& option) { return option["module"] == "sweep" && option["name"] == "gamma"; });
  ASSERT_NE(gamma, options.end());
  EXPECT_EQ((*gamma)["kind"], "number");
  EXPECT_EQ((*gamma)["used_in"], "runs");
  EXPECT_TRUE((*gamma)["minimum"].is_number());
  EXPECT_TRUE((*gamma)["advanced"].is_boolean());
  EXPECT_TRUE((*gamma)["source"].is_string());
  for (const auto& option : options) {
    const auto key = option["module"].get<std::string>() + "." + option["name"].get<std::string>();
    EXPECT_THAT(option["kind"].get<std::string>(), testing::AnyOf("boolean", "integer", "number", "string", "choice"));
    EXPECT_EQ(option["used_in"] == "inputs", is_input_option(key)) << key;
  }
}

TEST(Options, of_a_run_are_those_of_the_inputs_then_the_preset_then_its_own) {
  RunRequest request;
  request.preset = "paper";
  request.options = {{"sweep.gamma", "12"}};
  const auto options = run_options(request, {{"ingest.crs", "local"}});
  ASSERT_TRUE(options);
  const auto values = differing(*options);
  EXPECT_EQ(values.at("ingest.crs"), "local");
  EXPECT_EQ(values.at("sweep.gamma"), "12");
  EXPECT_EQ(values.at("refine.effort"), "caps");
  request.preset = "papre";
  EXPECT_EQ(run_options(request, {}).error().code, "option-value");
}

TEST(Formats, are_listed_once_with_extensions_for_reading_and_files_for_export) {
  const auto formats = formats_json();
  std::vector<std::string> names;
  std::size_t exported = 0;
  for (const auto& format : formats) {
    names.push_back(format["name"]);
    exported += format["files"].empty() ? 0 : 1;
    EXPECT_FALSE(format["reads"].empty() && format["files"].empty()) << format;
    for (const auto& kind : format["reads"])
      EXPECT_THAT(kind.get<std::string>(), testing::AnyOf("mesh", "raster", "footprints", "models"));
  }
  EXPECT_EQ(exported, written_formats().size());
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace mansard::server
