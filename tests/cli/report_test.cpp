// Where --report may go.
#include "cli/command.hpp"

namespace mansard::cli {
namespace {

class Report : public Command {};

TEST_F(Report, takes_the_place_of_no_other_result) {
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--report " + at("out/model.city.json")), 2, "usage",
                 "two outputs have this path");
  const std::string extrude = "extrude -q " + at("house.geojson") + " -o ";
  expect_refusal(run(extrude + at("out") + " --report " + at("out/model.obj")), 2, "usage", "two outputs");
  expect_refusal(run(extrude + at("house.glb") + " --report " + at("house.glb")), 2, "usage", "two outputs");
  EXPECT_FALSE(fs::exists(at("house.glb")));
}

TEST_F(Report, may_lie_in_the_folder_that_is_made_for_the_results) {
  EXPECT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--report " + at("out/report.json")).exit, 0);
  EXPECT_EQ(read(at("out/report.json")), read(at("out/run.json")));
  EXPECT_EQ(run("extrude -q " + at("house.geojson") + " -o " + at("more") + " --report " + at("more/report.json")).exit,
            0);
  EXPECT_TRUE(fs::exists(at("more/report.json")));
}

}  // namespace
}  // namespace mansard::cli
