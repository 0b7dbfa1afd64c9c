// `mansard explore`: a report in a folder, and what is wrong with a command line.
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;

class Explore : public Command {
 protected:
  auto explore(const std::string& experiment, const std::string& more = "") const -> Outcome {
    return run("explore -q " + experiment + " " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out") +
               " " + more);
  }
};

TEST_F(Explore, writes_a_report_and_names_it) {
  const auto outcome = explore("grid", "--grid gamma=10,40 --grid profile.quality=simple,high");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, at("out") + "/index.html\n");
  const auto results = nlohmann::json::parse(read(at("out") + "/results.json"));
  EXPECT_EQ(results["runs"].size(), 4U);
  EXPECT_THAT(results["command"], HasSubstr("--grid gamma=10,40 --grid profile.quality=simple,high"));
  EXPECT_THAT(read(at("out") + "/index.html"), HasSubstr("gamma=10,40"));
}

TEST_F(Explore, repeats_a_run_by_the_command_that_its_report_gives) {
  ASSERT_EQ(explore("grid", "--grid gamma=10,40 --preset chordatlas").exit, 0);
  const auto results = nlohmann::json::parse(read(at("out") + "/results.json"));
  auto command = results["runs"][1]["command"].get<std::string>();
  ASSERT_TRUE(command.starts_with("mansard ") && command.ends_with(" -o out"));
  command = command.substr(8, command.size() - 11) + at("again") + " -q";
  const auto again = run(command);
  EXPECT_LE(again.exit, 1) << again.err;
  const auto report = nlohmann::json::parse(read(at("again") + "/run.json"));
  EXPECT_EQ(report["options"]["sweep.gamma"], "40");
  EXPECT_EQ(report["options"]["slice.interval"], "0.5");
  EXPECT_EQ(report["scores"]["vertical_mse_m2"], results["runs"][1]["numbers"]["vertical_mse_m2"]);
}

TEST_F(Explore, reads_a_list_of_datasets_from_its_folder_or_the_given_one) {
  const auto list = put("list.toml",
                        "[[dataset]]\nname = \"one\"\nplace = \"A & B\"\nmeshes = [\"house.obj\"]\n"
                        "footprints = \"house.geojson\"\noptions = { \"sweep.gamma\" = \"20\" }\n");
  const std::string words = "explore -q table --no-pictures -o " + at("out") + " --datasets " + list;
  EXPECT_EQ(run(words).exit, 0);
  const auto results = nlohmann::json::parse(read(at("out") + "/results.json"));
  EXPECT_EQ(results["runs"][0]["dataset"], "one");
  EXPECT_EQ(results["datasets"][0]["place"], "A & B");
  EXPECT_THAT(read(at("out") + "/index.html"), HasSubstr("A &amp; B"));
  EXPECT_THAT(results["runs"][0]["command"].get<std::string>(), HasSubstr("--sweep-gamma 20"));
  fs::remove_all(at("out"));
  expect_refusal(run(words + " --data " + at("nowhere")), 3, "file-missing", "");
}

TEST_F(Explore, refuses_a_list_with_something_wrong_in_it) {
  const std::string whole = "[[dataset]]\nname = \"one\"\nmeshes = [\"house.obj\"]\nfootprints = \"house.geojson\"\n";
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"dataset = [", "line 1"},
           {"[[datasets]]\nname = \"one\"\n", "[[dataset]]"},
           {"[[dataset]]\nname = \"one\"\n", "has no name, no meshes or no footprints"},
           {whole + "colour = \"red\"\n", "'colour'"},
           {whole + "options = { \"sweep.gamma\" = 20 }\n", "in quotes"},
           {whole + whole, "two datasets"}}) {
    const auto list = put("list.toml", text);
    expect_refusal(run("explore -q table -o " + at("out") + " --datasets " + list), 4, "explore-list", words);
  }
}

TEST_F(Explore, says_what_is_wrong_with_the_experiment_and_its_axes) {
  expect_refusal(explore("gama"), 2, "usage", "did you mean 'gamma'?");
  expect_refusal(explore("grid"), 4, "explore-axis", "--grid");
  expect_refusal(explore("grid", "--grid gama=1,2"), 4, "option-unknown", "did you mean 'gamma'?");
  expect_refusal(explore("quality", "--grid gamma=1,2"), 4, "explore-axis", "does not vary");
  expect_refusal(explore("gamma", "--most-runs 3"), 4, "explore-runs", "--most-runs");
  expect_refusal(run("explore -q table -o " + at("out")), 2, "usage", "--datasets");
}

TEST_F(Explore, overwrites_nothing_silently) {
  fs::create_directories(at("out"));
  put("out/mine.txt", "mine");
  const auto outcome = explore("table");
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_THAT(outcome.err, HasSubstr("output-exists"));
  put("out/run-1-above.png", "somebody else's: there is no report beside it");
  EXPECT_EQ(explore("table", "--overwrite --no-pictures").exit, 0);
  EXPECT_EQ(read(at("out") + "/mine.txt"), "mine");
  EXPECT_TRUE(fs::exists(at("out/run-1-above.png")));
  put("out/run-7-above.png", "of an earlier run");
  put("out/run-7-notes.png", "mine");
  EXPECT_EQ(explore("table", "--overwrite --no-pictures").exit, 0);
  EXPECT_FALSE(fs::exists(at("out/run-7-above.png")));
  EXPECT_TRUE(fs::exists(at("out/run-7-notes.png")));
  EXPECT_EQ(read(at("out") + "/mine.txt"), "mine");
}

}  // namespace
}  // namespace mansard::cli
