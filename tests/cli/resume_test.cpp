// Runs that are stopped, killed, repeated or shared: the same command goes on, and its files are those of a run that
// nothing disturbed.
#include <fcntl.h>
#include <sys/file.h>
#include <chrono>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class Resume : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    town(6);
  }

  /// side × side gabled houses apart from each other, on a field.
  void town(int side, double longer = 0) {
    std::string mesh, features;
    for (int i = 0; i < side * side; ++i) {
      const double x = 40.0 * (i % side), y = 40.0 * (i / side), l = 12 + (i == 0 ? longer : 0);
      const auto v = [&](double dx, double dy, double z) {
        mesh += "v " + std::to_string(x + dx) + " " + std::to_string(y + dy) + " " + std::to_string(z) + "\n";
      };
      for (const double z : {0.0, 5.0})
        for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {l, 0.0}, {l, 8.0}, {0.0, 8.0}}) v(dx, dy, z);
      v(0, 4, 8), v(l, 4, 8);
      for (const auto& [dx, dy] : {std::pair{-14.0, -14.0}, {26.0, -14.0}, {26.0, 26.0}, {-14.0, 26.0}}) v(dx, dy, 0);
      mesh +=
          "f -14 -13 -9 -10\nf -13 -12 -8 -5 -9\nf -12 -11 -7 -8\nf -11 -14 -10 -6 -7\nf -10 -9 -5 -6\nf -8 -7 -6 -5\n";
      mesh += "f -4 -3 -2 -1\n";
      const auto corner = [&](double dx, double dy) {
        return "[" + std::to_string(x + dx) + "," + std::to_string(y + dy) + "]";
      };
      features +=
          std::string(i > 0 ? "," : "") + R"({"type":"Feature","properties":{"id":"h)" + std::to_string(i) +
          R"("},"geometry":)" +
          polygon(corner(0, 0) + "," + corner(l, 0) + "," + corner(l, 8) + "," + corner(0, 8) + "," + corner(0, 0)) +
          "}";
    }
    put("town.obj", mesh);
    put("town.geojson",
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)" +
            features + "]}");
  }

  [[nodiscard]] auto command(const std::string& out, const std::string& more = "") const -> std::string {
    return "reconstruct " + at("town.obj") + " " + at("town.geojson") + " -o " + at(out) +
           " --formats cityjson,obj,geopackage,plans,tiles " + more;
  }

  /// Every result with its bytes; of run.json all but times.
  [[nodiscard]] auto results(const std::string& out) const -> std::map<std::string, std::string> {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(at(out))) {
      const auto name = fs::relative(entry.path(), at(out)).string();
      if (!entry.is_regular_file() || name.starts_with(".mansard")) continue;
      all[name] = read(entry.path());
    }
    auto run = Json::parse(all.at("run.json"));
    run.erase("times");
    for (auto& block : run["blocks"]) block.erase("times");
    all["run.json"] = run.dump();
    return all;
  }

  /// The names of results that are in one only, or differ.
  static auto different(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b)
      -> std::vector<std::string> {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : a)
      if (!b.contains(name) || b.at(name) != bytes) names.push_back(name);
    for (const auto& [name, bytes] : b)
      if (!a.contains(name)) names.push_back(name);
    return names;
  }

  /// Starts it in a process of its own; the words have no spaces.
  [[nodiscard]] auto start(const std::string& words) const -> pid_t {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl("/bin/sh", "sh", "-c",
              ("exec " + std::string(MANSARD_BINARY) + " " + words + " >/dev/null 2>" + at("stderr")).c_str(), nullptr);
      ::_exit(127);
    }
    return child;
  }
  static auto end_of(pid_t child) -> int {
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  }
  [[nodiscard]] auto status(const std::string& out) const -> Json {
    const auto shown = run("status --json " + at(out));
    return shown.exit == 0 ? Json::parse(shown.out) : Json();
  }
};

TEST_F(Resume, gives_the_bytes_of_an_undisturbed_run_after_many_kills) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run(command("whole", "-q --no-resume")).exit, 0);
  const auto took = std::chrono::steady_clock::now() - begin;
  EXPECT_FALSE(fs::exists(at("whole") + "/.mansard/blocks/last"));
  const auto expected = results("whole");

  std::mt19937 random(7);
  std::size_t last = 0;
  int kills = 0, finished = 0;
  const auto* more = std::getenv("MANSARD_KILLS");  // tools/nightly.sh
  const int wanted = more != nullptr ? std::atoi(more) : 50;
  for (int round = 0; kills < wanted && round < 8 * wanted; ++round) {
    const pid_t child = start(command("out", "-q -j 1 " + std::string(finished > 0 ? "--overwrite" : "")));
    const auto wait =
        std::chrono::duration_cast<std::chrono::microseconds>(took) * static_cast<int>(random() % 1000) / 1000;
    std::this_thread::sleep_for(wait);
    ::kill(child, SIGKILL);
    const int ended = end_of(child);
    const auto now = status("out");
    // Also where the kill came between the run's end and that of its process.
    const bool done = WIFSIGNALED(ended) && now.is_object() && now["state"] == "finished";
    if (WIFSIGNALED(ended) && !done) {
      ++kills;
      if (now.is_object()) {
        EXPECT_EQ(now["state"], "stopped");
      }
      std::size_t blocks = 0;
      if (fs::exists(at("out") + "/.mansard/blocks"))
        for (const auto& entry : fs::recursive_directory_iterator(at("out") + "/.mansard/blocks"))
          blocks += entry.is_regular_file() && entry.path().string().find(".part") == std::string::npos ? 1 : 0;
      EXPECT_GE(blocks, last) << "nothing that was kept is lost";
      last = blocks;
    } else {
      ASSERT_TRUE(done || WEXITSTATUS(ended) == 0) << read(at("stderr"));
      EXPECT_THAT(different(results("out"), expected), testing::IsEmpty());
      ++finished;
      last = 0;
      fs::remove_all(at("out"));
      finished = 0;
    }
  }
  EXPECT_EQ(kills, wanted);
  ASSERT_EQ(run(command("out", "-q --overwrite")).exit, 0);
  EXPECT_THAT(different(results("out"), expected), testing::IsEmpty());
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(at("out"))) names.insert(entry.path().filename());
  for (const auto& name : names) EXPECT_THAT(name, testing::Not(HasSubstr(".part"))) << "left by a killed run";
}

TEST_F(Resume, goes_on_after_an_interrupt_and_says_so) {
  town(20);
  const pid_t child = start(command("out", "-j 1"));
  const auto blocks = at("out") + "/.mansard/blocks";
  const auto kept = [&] {
    std::size_t files = 0;
    std::error_code gone;
    for (auto at = fs::recursive_directory_iterator(blocks, gone); !gone && at != fs::recursive_directory_iterator();
         at.increment(gone))
      files += at->is_regular_file(gone) ? 1 : 0;
    return files;
  };
  int waited = 0;  // ms
  for (; kept() < 20 && waited < 60'000; ++waited) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_LT(waited, 60'000) << read(at("stderr"));
  ::kill(child, SIGINT);
  const int ended = end_of(child);
  ASSERT_TRUE(WIFEXITED(ended));
  ASSERT_EQ(WEXITSTATUS(ended), 6) << read(at("stderr"));
  EXPECT_THAT(read(at("stderr")), HasSubstr("of 400 blocks are done and kept; the same command goes on from there"));
  EXPECT_EQ(status("out")["state"], "stopped");
  EXPECT_THAT(run("status " + at("out")).out, HasSubstr("the same command goes on from there"));

  const auto second = run(command("out"));
  ASSERT_EQ(second.exit, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("of 400 blocks were taken over from an earlier run"));
  EXPECT_THAT(second.err, testing::Not(HasSubstr("made again")));
  const auto now = status("out");
  EXPECT_EQ(now["state"], "finished");
  EXPECT_EQ(now["blocks"]["done"], 400);
  EXPECT_GE(now["blocks"]["taken_over"], 20);
}

TEST_F(Resume, makes_again_what_changed_and_says_why) {
  ASSERT_EQ(run(command("out", "-q")).exit, 0);
  town(6, 1.0);  // one house is longer
  const auto changed = run(command("out", "--overwrite"));
  EXPECT_EQ(changed.exit, 0) << changed.err;
  EXPECT_THAT(changed.err, HasSubstr("35 of 36 blocks were taken over from an earlier run; made again because of what "
                                     "changed: 1 (footprints)"));
  const auto reuse = Json::parse(read(at("out") + "/run.json"))["times"]["reuse"];
  EXPECT_EQ(reuse["blocks_taken_over"], 35);
  EXPECT_EQ(reuse["blocks_made_again"]["footprints"], Json::array({"block-h0"}));
  ASSERT_EQ(run(command("fresh", "-q --no-resume")).exit, 0);
  EXPECT_THAT(different(results("out"), results("fresh")), testing::IsEmpty());
  EXPECT_THAT(run(command("out", "--overwrite --refine-face-price 0.4")).err, HasSubstr("36 (options)"));
}

TEST_F(Resume, lets_one_run_work_in_a_folder) {
  ASSERT_EQ(run(command("out", "-q")).exit, 0);
  const int lock = ::open((at("out") + "/.mansard/lock").c_str(), O_RDWR);
  ASSERT_GE(lock, 0);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  const auto second = run(command("out", "-q --overwrite"));
  EXPECT_EQ(second.exit, 2);
  EXPECT_THAT(second.err, HasSubstr("error[output-busy]"));
  EXPECT_THAT(second.err, HasSubstr("'mansard reconstruct' works there since 20"));
  EXPECT_EQ(run(command("out", "-q --overwrite --share 1 --shares 2")).exit, 2);
  ::close(lock);
  EXPECT_EQ(run(command("out", "-q --overwrite")).exit, 0);
}

TEST_F(Resume, adds_shares_of_several_processes_up_to_the_whole) {
  ASSERT_EQ(run(command("whole", "-q --no-resume")).exit, 0);
  std::vector<pid_t> shares;
  for (int i = 1; i <= 3; ++i)
    shares.push_back(start(command("out", "-q -j 1 --shares 3 --share " + std::to_string(i))));
  for (const auto share : shares) EXPECT_EQ(end_of(share), 0) << read(at("stderr"));
  const auto merged = run(command("out"));
  EXPECT_EQ(merged.exit, 0);
  EXPECT_THAT(merged.err, HasSubstr("36 of 36 blocks were taken over"));
  EXPECT_THAT(different(results("out"), results("whole")), testing::IsEmpty());
}

TEST_F(Resume, refuses_shares_that_make_no_sense) {
  for (const std::string words :
       {"--share 1", "--shares 3", "--share 4 --shares 3", "--share 1 --shares 3 --no-resume"}) {
    const auto refused = run(command("out", "-q " + words));
    EXPECT_EQ(refused.exit, 2) << words;
    EXPECT_FALSE(fs::exists(at("out"))) << words;
  }
}

TEST_F(Resume, knows_no_status_where_nothing_ran) {
  fs::create_directory(at("empty"));
  for (const auto* folder : {"empty", "nowhere"}) {
    const auto none = run("status " + at(folder));
    EXPECT_EQ(none.exit, 2);
    EXPECT_THAT(none.err, HasSubstr("error[status-none]"));
  }
}

TEST_F(Resume, leaves_nothing_where_a_run_fails_before_its_first_block) {
  put("town.obj", "no mesh at all\n");
  EXPECT_NE(run(command("out", "-q")).exit, 0);
  EXPECT_FALSE(fs::exists(at("out")));
}

}  // namespace
}  // namespace mansard::cli
