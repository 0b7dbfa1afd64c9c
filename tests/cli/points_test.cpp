// Point clouds on the command line.
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

class Points : public Command {
 protected:
  /// The models of four blocks of Delft, without what says how they were made.
  auto models_of(const std::string& clouds) const -> Json {
    fs::remove_all(at("out"));
    const auto outcome = run("reconstruct " + clouds + " " MANSARD_DATA "/delft/footprints.geojson -o " + at("out") +
                             " --formats cityjson --bbox 84850 447520 84900 447580");
    EXPECT_LE(outcome.exit, 1) << outcome.err;
    auto city = Json::parse(read(at("out/model.city.json")));
    city.erase("metadata");
    for (auto it = city.begin(); it != city.end();) it = it.key().starts_with("+") ? city.erase(it) : std::next(it);
    return city;
  }
  auto warning(const std::string& code) const -> std::string {
    const auto report = Json::parse(read(at("out/run.json")));
    for (const auto& each : report["warnings"])
      if (each["code"] == code) return each["message"];
    return {};
  }
};

TEST_F(Points, of_a_tile_that_is_given_twice_make_the_same_models_and_a_warning_names_both) {
  const std::string tile = MANSARD_DATA "/delft/points.laz";
  const auto once = models_of(tile);
  EXPECT_EQ(warning("ingest-points-twice"), "");
  const auto copy = put("copy.laz", read(tile));
  const auto twice = models_of(tile + " " + copy);
  EXPECT_EQ(twice["CityObjects"], once["CityObjects"]);
  EXPECT_EQ(twice["vertices"], once["vertices"]);
  EXPECT_GT(once["CityObjects"].size(), 3U);
  EXPECT_THAT(warning("ingest-points-twice"), HasSubstr(tile + " and " + copy + " have the same points"));
}

}  // namespace
}  // namespace mansard::cli
