// What becomes of a run when what it prints cannot be taken.
#include "cli/command.hpp"

namespace mansard::cli {
namespace {

class Streams : public Command {
 protected:
  /// A command line for the shell, with MANSARD for the program.
  auto shell(std::string words) const -> Outcome {
    const std::string name = "MANSARD";
    for (auto at = words.find(name); at != words.npos; at = words.find(name, at))
      words.replace(at, name.size(), MANSARD_BINARY);
    const int status = std::system(("bash -o pipefail -c '" + words + "' 2>" + at("stderr")).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, {}, read(at("stderr"))};
  }
};

TEST_F(Streams, a_full_disk_behind_stdout_is_no_success) {
  for (const std::string& words : {std::string("options --json"), std::string("explain"), "info " + at("house.obj")}) {
    const auto outcome = shell("MANSARD " + words + " >/dev/full");
    EXPECT_EQ(outcome.exit, 3) << words;
    EXPECT_THAT(outcome.err, testing::HasSubstr("error[file-write] standard output: "));
  }
}

TEST_F(Streams, a_reader_that_had_enough_is_no_failure) {
  const auto listed = shell("MANSARD options --json | head -c 10 >/dev/null");
  EXPECT_EQ(listed.exit, 0);
  EXPECT_EQ(listed.err, "");
  const auto made = shell("MANSARD extrude " + at("house.geojson") + " -o " + at("out") + " 2>&1 | true");
  EXPECT_EQ(made.exit, 0) << made.err;
  EXPECT_TRUE(fs::exists(at("out/model.city.json")));
}

TEST_F(Streams, closed_ones_are_not_written_into_results) {
  const std::string words = "MANSARD extrude " + at("house.geojson") + " -o ";
  ASSERT_EQ(shell(words + at("open") + " >/dev/null 2>/dev/null").exit, 0);
  ASSERT_EQ(shell(words + at("shut") + " <&- >&- 2>&-").exit, 0);
  for (const char* name : {"model.city.json", "model.gpkg", "model.glb", "model.obj", "plans.json"})
    EXPECT_EQ(read(at("open/" + std::string(name))), read(at("shut/" + std::string(name)))) << name;
}

}  // namespace
}  // namespace mansard::cli
