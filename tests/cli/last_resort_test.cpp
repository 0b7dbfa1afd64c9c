// Memory and file sizes have limits, runs are stopped and killed: an error in one line, and nothing unfinished.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <chrono>
#include <csignal>
#include <thread>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class LastResort : public Command {
 protected:
  /// With limits that a shell sets: "-v 200000".
  auto limited(const std::string& limits, const std::string& arguments) const -> Outcome {
    const std::string command = "bash -c 'ulimit " + limits + " && exec " + MANSARD_BINARY + " " + arguments + "' >" +
                                at("stdout") + " 2>" + at("stderr") + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(at("stdout")), read(at("stderr"))};
  }
  /// Without what is kept for the same command to go on from.
  auto names_in(const std::string& folder) const -> std::vector<std::string> {
    std::vector<std::string> names;
    if (fs::exists(at(folder)))
      for (const auto& entry : fs::directory_iterator(at(folder)))
        if (entry.path().filename() != ".mansard") names.push_back(entry.path().filename().string());
    return names;
  }
  /// Squares that lie on each other, and are slow to work on.
  auto stack(int count) -> std::string {
    std::string features;
    for (int i = 0; i < count; ++i) {
      const auto x = std::to_string(0.001 * (i * 7919 % 3001)), y = std::to_string(0.001 * (i * 104729 % 2999));
      const auto far_x = std::to_string(10 + 0.001 * (i * 31 % 2003)),
                 far_y = std::to_string(9 + 0.001 * (i * 37 % 997));
      features += (i > 0 ? "," : "") + (R"({"type":"Feature","properties":{},"geometry":)" +
                                        polygon("[" + x + "," + y + "],[" + far_x + "," + y + "],[" + far_x + "," +
                                                far_y + "],[" + x + "," + far_y + "],[" + x + "," + y + "]") +
                                        "}");
    }
    return put("stack.geojson", R"({"type":"FeatureCollection","features":[)" + features + "]}");
  }
};

TEST_F(LastResort, ends_with_an_error_where_memory_runs_out) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's own memory does not fit under a limit";
#endif
  const std::string work = "reconstruct -q -j 2 " + at("house.obj") + " " + at("house.geojson") + " --formats all -o ";
  int without = 0, with = 0;
  for (int megabytes = 150; megabytes < 4000 && with < 2; megabytes += megabytes / 12) {
    const std::string out = "out" + std::to_string(megabytes);
    const auto outcome = limited("-v " + std::to_string(megabytes * 1024), work + at(out));
    if (outcome.exit == 127) continue;  // the program itself could not be loaded
    if (outcome.exit == 0) {
      ++with;
      continue;
    }
    ++without;
    EXPECT_EQ(outcome.exit, 3) << megabytes << " MB: " << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("mansard: error[")) << megabytes << " MB";
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_THAT(names_in(out), testing::IsEmpty()) << megabytes << " MB";
  }
  EXPECT_GT(with, 0);
  EXPECT_GT(without, 0);
}

TEST_F(LastResort, a_file_that_becomes_too_large_is_an_error) {
  for (const int blocks : {0, 1, 4}) {
    const auto outcome =
        limited("-f " + std::to_string(blocks),
                "reconstruct -q " + at("house.obj") + " " + at("house.geojson") + " --formats all -o " + at("out"));
    // The program's own messages are in files here too, but shorter.
    EXPECT_EQ(outcome.exit, 3) << blocks << ": " << outcome.err;
    if (blocks > 0) {
      EXPECT_THAT(outcome.err, HasSubstr("File too large"));
      EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    }
    EXPECT_THAT(names_in("out"), testing::IsEmpty()) << blocks;
  }
}

TEST_F(LastResort, a_stopped_run_ends_in_time_and_leaves_nothing) {
  const auto input = stack(3000);
  const auto child = ::fork();
  if (child == 0) {
    const int null = ::open("/dev/null", O_RDWR);
    ::dup2(null, 1), ::dup2(null, 2);
    ::execl(MANSARD_BINARY, "mansard", "extrude", input.c_str(), "-o", at("out").c_str(), nullptr);
    ::_exit(127);
  }
  using namespace std::chrono_literals;
  for (int i = 0; i < 500 && !fs::exists(at("out")); ++i) std::this_thread::sleep_for(10ms);
  std::this_thread::sleep_for(1s);
  ::kill(child, SIGTERM);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 6);
  EXPECT_FALSE(fs::exists(at("out")));
}

TEST_F(LastResort, what_a_killed_run_left_does_not_stand_in_the_way) {
  const std::string work = "reconstruct -q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out");
  // The name that a process has which ended long ago: that of this shell.
  ASSERT_EQ(
      std::system(
          ("mkdir " + at("out") + " && bash -c 'echo half >" + at("out") + "/model.gpkg.part$$@$(hostname)'").c_str()),
      0);
  ASSERT_EQ(names_in("out").size(), 1U);
  const auto outcome = run(work);
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  for (const auto& name : names_in("out")) EXPECT_THAT(name, testing::Not(HasSubstr(".part")));
}

TEST_F(LastResort, a_folder_for_temporary_files_is_missed_before_the_work) {
  for (const std::string& verb : {"reconstruct -q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out"),
                                  "segment -q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("why.gpkg"),
                                  "extrude -q " + at("house.geojson") + " -o " + at("house.city.json")}) {
    ::setenv("TMPDIR", at("none").c_str(), 1);
    const auto outcome = run(verb);
    ::unsetenv("TMPDIR");
    expect_refusal(outcome, 3, "file-write", "TMPDIR");
  }
}

TEST_F(LastResort, programs_of_an_earlier_run_are_found_before_the_work) {
  put("why-block-a.mps", "of an earlier run");
  const auto outcome = run("segment -q " + at("none.obj") + " " + at("house.geojson") + " -o " + at("why.gpkg") +
                           " --export-mps " + at("why.mps"));
  expect_refusal(outcome, 2, "output-exists", "why-block-a.mps");  // and not that there is no mesh
}

}  // namespace
}  // namespace mansard::cli
