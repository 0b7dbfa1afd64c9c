// `mansard doctor`, and what is said of inputs that do not fit together.
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class Doctor : public Command {
 protected:
  const std::string mesh = MANSARD_DATA "/delft/mesh.ply", footprints = MANSARD_DATA "/delft/footprints.geojson";
};

TEST_F(Doctor, finds_nothing_wrong_with_the_machine_that_runs_the_tests) {
  const auto outcome = run("doctor --json");
  EXPECT_EQ(outcome.exit, 0) << outcome.out << outcome.err;
  const auto found = Json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(found.is_array());
  std::vector<std::string> subjects;
  for (const auto& each : found) subjects.push_back(each["subject"]);
  EXPECT_THAT(subjects, testing::ElementsAre("processor", "memory", "temporary files", "GDAL", "PROJ", "geoids"));
}

TEST_F(Doctor, says_where_temporary_files_cannot_be_written) {
  ::setenv("TMPDIR", "/proc", 1);
  const auto outcome = run("doctor");
  ::unsetenv("TMPDIR");
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.out, HasSubstr("problem  temporary files"));
  EXPECT_THAT(outcome.out, HasSubstr("-> set TMPDIR"));
}

TEST_F(Doctor, names_the_offset_that_is_missing_and_the_command_to_run) {
  const auto outcome = run("doctor " + mesh + " " + footprints);
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.out, HasSubstr("-> mansard reconstruct " + mesh + " " + footprints +
                                     " --mesh-offset 84800 447400 0 -o models"));
  const auto with = run("doctor " + mesh + " " + footprints + " --mesh-offset 84800 447400 0");
  EXPECT_EQ(with.exit, 0);
  EXPECT_THAT(with.out, HasSubstr("ok       place: mesh and footprints match"));
}

TEST_F(Doctor, recognises_inputs_in_the_wrong_order) {
  const auto outcome = run("doctor " + footprints + " " + mesh);
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.out, HasSubstr("problem  order"));
  EXPECT_THAT(outcome.out, HasSubstr("reconstruct " + mesh + " " + footprints));
}

TEST_F(Doctor, proposes_nothing_for_inputs_of_different_places) {
  const auto outcome = run("doctor " MANSARD_DATA "/hall/mesh.off " + footprints);
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.out, HasSubstr("seem to be of different places"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("mansard reconstruct")));
}

TEST_F(Doctor, says_what_to_do_with_one_input_alone) {
  EXPECT_THAT(run("doctor " + footprints).out, HasSubstr("mansard extrude " + footprints));
  EXPECT_THAT(run("doctor " + mesh).out, HasSubstr("--derive-footprints"));
}

TEST_F(Doctor, is_asked_by_runs_whose_inputs_do_not_overlap) {
  const auto outcome = run("reconstruct " + mesh + " " + footprints + " -o " + at("out"));
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error[ingest-no-overlap]"));
  EXPECT_THAT(outcome.err, HasSubstr("add --mesh-offset 84800 447400 0: then 98 % of the footprints' area"));
  EXPECT_FALSE(std::filesystem::exists(at("out") + "/run.json"));
}

/// Footprints in degrees, and a mesh in the national system: the UTM zone is the wrong guess.
TEST_F(Doctor, names_the_national_system_of_the_mesh) {
  put("outlines.geojson",
      R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"id": "a"}, "geometry":
        {"type": "Polygon", "coordinates": [[[4.36390, 52.00890], [4.36405, 52.00890], [4.36405, 52.00900], [4.36390, 52.00900], [4.36390, 52.00890]]]}}]})");
  // The same house in EPSG:28992, 8 m high, on ground that reaches 30 m around it (coordinates by PROJ 9.1).
  const auto made =
      run("extrude " + at("outlines.geojson") + " --crs EPSG:28992 --default-height 8 -o " + at("raised.obj"));
  ASSERT_EQ(made.exit, 0) << made.err;
  std::string obj = read(at("raised.obj"));
  double x = 0, y = 0;
  std::size_t count = 0;
  for (std::size_t line = obj.find("\nv "); line != std::string::npos; line = obj.find("\nv ", line + 1)) {
    double px = 0, py = 0;
    if (std::sscanf(obj.c_str() + line, "\nv %lf %lf", &px, &py) == 2) x += px, y += py, ++count;
  }
  ASSERT_GT(count, 0U);
  x /= static_cast<double>(count);
  y /= static_cast<double>(count);
  std::string ground;
  for (const auto& [dx, dy] : {std::pair{-40, -40}, std::pair{40, -40}, std::pair{40, 40}, std::pair{-40, 40}})
    ground += "v " + std::to_string(x + dx) + " " + std::to_string(y + dy) + " 0\n";
  put("scan.obj", obj + "\n" + ground + "f -4 -3 -2\nf -4 -2 -1\n");
  const auto outcome = run("doctor " + at("scan.obj") + " " + at("outlines.geojson"));
  EXPECT_EQ(outcome.exit, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("--crs EPSG:28992"));
}

TEST_F(Doctor, reads_point_clouds_with_the_classes_that_are_given) {
  // The house is of class 67, one beside it of class 6, so that buildings are found by class.
  std::string points = "x y z class\n";
  for (int y = -20; y < 40; ++y)
    for (int x = -20; x < 40; ++x) {
      const bool in = x >= 0 && x < 12 && y >= 0 && y < 8, beside = x >= 25 && x < 35 && y >= 25 && y < 35;
      points += std::to_string(x) + ".5 " + std::to_string(y) + ".5 " + (in ? "6 67\n" : beside ? "6 6\n" : "0 2\n");
    }
  const std::string inputs = put("cloud.xyz", points) + " " + at("house.geojson");
  const auto with = run("doctor " + inputs + " --cloud-building-classes 6,67");
  EXPECT_EQ(with.exit, 0) << with.out << with.err;
  EXPECT_THAT(with.out, HasSubstr("mansard reconstruct " + inputs + " --cloud-building-classes 6,67 -o models"));
  EXPECT_THAT(with.out, HasSubstr("accuracy"));
  const auto without = run("doctor " + inputs);
  EXPECT_EQ(without.exit, 1) << without.out << "class 67 is no building";
}

TEST_F(Doctor, without_arguments_the_program_says_what_to_do_first) {
  const auto outcome = run("");
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_THAT(outcome.out, HasSubstr("mansard reconstruct MESH FOOTPRINTS -o models"));
  EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace mansard::cli
