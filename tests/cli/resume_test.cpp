// Runs that are stopped, killed, repeated or shared: the same command goes on, and its files are those of a run that
// nothing disturbed.
#include <fcntl.h>
#include <sys/file.h>
#include <chrono>
#include <csignal>
#include <functional>
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

  /// How far runs that are killed at random moments come.
  struct Killed {
    std::function<std::string(const std::string& out, const std::string& more)> command;
    std::function<std::map<std::string, std::string>(const std::string& out)> results;
    std::string kept;        ///< the folder in which "out" keeps what is done
    std::string whole, out;  ///< outputs
  };
  /// 50 of them, or as many as tools/nightly.sh says. Every run that comes to its end has the bytes of a run that
  /// nothing disturbed, and nothing that was kept is lost.
  void survives_kills(const Killed& of) const {
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(run(of.command(of.whole, "-q --no-resume")).exit, 0);
    const auto took = std::chrono::steady_clock::now() - begin;
    const auto expected = of.results(of.whole);

    std::mt19937 random(7);
    std::size_t last = 0;
    int kills = 0;
    const auto* more = std::getenv("MANSARD_KILLS");
    const int wanted = more != nullptr ? std::atoi(more) : 50;
    for (int round = 0; kills < wanted && round < 8 * wanted; ++round) {
      const pid_t child = start(of.command(of.out, "-q -j 1"));
      const auto wait =
          std::chrono::duration_cast<std::chrono::microseconds>(took) * static_cast<int>(random() % 1000) / 1000;
      std::this_thread::sleep_for(wait);
      ::kill(child, SIGKILL);
      const int ended = end_of(child);
      const auto now = status(of.out);
      // Also where the kill came between the run's end and that of its process.
      const bool done =
          WIFSIGNALED(ended) && (now.is_object() ? now["state"] == "finished" : fs::is_regular_file(at(of.out)));
      if (WIFSIGNALED(ended) && !done) {
        ++kills;
        if (now.is_object()) {
          EXPECT_EQ(now["state"], "stopped");
        }
        std::size_t blocks = 0;
        if (fs::exists(at(of.kept) + "/blocks"))
          for (const auto& entry : fs::recursive_directory_iterator(at(of.kept) + "/blocks"))
            blocks += entry.is_regular_file() && entry.path().string().find(".part") == std::string::npos ? 1 : 0;
        EXPECT_GE(blocks, last) << "nothing that was kept is lost";
        last = blocks;
      } else {
        ASSERT_TRUE(done || WEXITSTATUS(ended) == 0) << read(at("stderr"));
        EXPECT_THAT(different(of.results(of.out), expected), testing::IsEmpty());
        last = 0;
        fs::remove_all(at(of.out));
        fs::remove_all(at(of.kept));  // where the kill came before it went
      }
    }
    EXPECT_EQ(kills, wanted);
    ASSERT_EQ(run(of.command(of.out, "-q --overwrite")).exit, 0);
    EXPECT_THAT(different(of.results(of.out), expected), testing::IsEmpty());
    for (const auto& entry : fs::directory_iterator(fs::path(at(of.kept)).parent_path()))
      EXPECT_THAT(entry.path().filename(), testing::Not(HasSubstr(".part"))) << "left by a killed run";
  }
};

TEST_F(Resume, gives_the_bytes_of_an_undisturbed_run_after_many_kills) {
  survives_kills({[&](const auto& out, const auto& more) { return command(out, more); },
                  [&](const auto& out) { return results(out); }, "out/.mansard", "whole", "out"});
  EXPECT_FALSE(fs::exists(at("whole") + "/.mansard/blocks/last"));
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
  EXPECT_THAT(run(command("out", "--overwrite --refine-detail 0.2")).err, HasSubstr("36 (options)"));
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

TEST_F(Resume, shares_begin_in_a_new_folder_at_the_same_time) {
  for (int round = 0; round < 5; ++round) {
    const auto folder = "out" + std::to_string(round);
    std::vector<pid_t> shares;
    for (int i = 1; i <= 8; ++i)
      shares.push_back(start(command(folder, "-q -j 1 --shares 8 --share " + std::to_string(i))));
    for (const auto share : shares) EXPECT_EQ(end_of(share), 0) << read(at("stderr"));
  }
}

TEST_F(Resume, refuses_shares_that_make_no_sense) {
  for (const std::string words :
       {"--share 1", "--shares 3", "--share 4 --shares 3", "--share 1 --shares 3 --no-resume"}) {
    const auto refused = run(command("out", "-q " + words));
    EXPECT_EQ(refused.exit, 2) << words;
    EXPECT_FALSE(fs::exists(at("out"))) << words;
  }
}

/// The same of footprints without a mesh: what is kept are tasks of many blocks.
class ResumeExtrude : public Resume {
 protected:
  void SetUp() override {
    Command::SetUp();
    houses(160);
  }

  /// Houses of four corners and a few heights in rows, 20 m apart; the first one is `longer`.
  void houses(int count, double longer = 0) {
    std::string features;
    for (int i = 0; i < count; ++i) {
      const double x = 84'000 + 20.0 * (i % 20), y = 447'000 + 20.0 * (i / 20), l = 12 + (i == 0 ? longer : 0);
      const auto corner = [&](double dx, double dy) {
        return "[" + std::to_string(x + dx) + "," + std::to_string(y + dy) + "]";
      };
      features +=
          std::string(i > 0 ? "," : "") + R"({"type":"Feature","properties":{"id":"h)" + std::to_string(i) +
          R"(","building:levels":)" + std::to_string(1 + i % 5) + R"(,"roof:shape":"hipped"},"geometry":)" +
          polygon(corner(0, 0) + "," + corner(l, 0) + "," + corner(l, 8) + "," + corner(0, 8) + "," + corner(0, 0)) +
          "}";
    }
    put("houses.geojson",
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)" +
            features + "]}");
  }

  [[nodiscard]] auto extrude(const std::string& out, const std::string& more = "") const -> std::string {
    return "extrude " + at("houses.geojson") + " -o " + at(out) + " --ingest-task-footprints 8 " + more;
  }
  [[nodiscard]] auto in_folder(const std::string& out, const std::string& more = "") const -> std::string {
    return extrude(out, "--formats cityjson,glb,tiles " + more);
  }
  [[nodiscard]] auto file(const std::string& out) const -> std::map<std::string, std::string> {
    return {{"the file", read(at(out))}};
  }
  /// What is in the folder of the test beside inputs and what a command printed.
  [[nodiscard]] auto outputs() const -> std::set<std::string> {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(at("")))
      if (const auto name = entry.path().filename().string();
          name != "stdout" && name != "stderr" && !name.starts_with("house"))
        names.insert(name);
    return names;
  }
};

TEST_F(ResumeExtrude, gives_the_bytes_of_an_undisturbed_run_after_many_kills) {
  survives_kills({[&](const auto& out, const auto& more) { return in_folder(out, more); },
                  [&](const auto& out) { return results(out); }, "out/.mansard", "whole", "out"});
  EXPECT_FALSE(fs::exists(at("whole/.mansard"))) << "nothing was kept";
}

TEST_F(ResumeExtrude, gives_one_file_as_it_is_undisturbed_after_many_kills) {
  survives_kills({[&](const auto& out, const auto& more) { return extrude(out, more); },
                  [&](const auto& out) { return file(out); }, "city.glb.mansard", "whole.glb", "city.glb"});
  EXPECT_EQ(outputs(), (std::set<std::string>{"city.glb", "whole.glb"}));
}

TEST_F(ResumeExtrude, goes_on_after_an_interrupt_and_says_so) {
  houses(1500);
  const pid_t child = start(extrude("city.city.jsonl", "-j 1"));
  const auto kept = [&] {
    std::size_t files = 0;
    std::error_code gone;
    for (auto at = fs::recursive_directory_iterator(this->at("city.city.jsonl.mansard/blocks"), gone);
         !gone && at != fs::recursive_directory_iterator(); at.increment(gone))
      files += at->is_regular_file(gone) ? 1 : 0;
    return files;
  };
  int waited = 0;  // ms
  for (; kept() < 10 && waited < 60'000; ++waited) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_LT(waited, 60'000) << read(at("stderr"));
  EXPECT_EQ(status("city.city.jsonl")["state"], "working");
  const auto busy = run(extrude("city.city.jsonl", "-q"));
  EXPECT_EQ(busy.exit, 2);
  EXPECT_THAT(busy.err, HasSubstr("error[output-busy]"));
  EXPECT_THAT(busy.err, HasSubstr("'mansard extrude' works there since 20"));
  ::kill(child, SIGINT);
  const int ended = end_of(child);
  ASSERT_TRUE(WIFEXITED(ended));
  ASSERT_EQ(WEXITSTATUS(ended), 6) << read(at("stderr"));
  EXPECT_FALSE(fs::exists(at("city.city.jsonl")));
  EXPECT_EQ(status("city.city.jsonl")["state"], "stopped");
  EXPECT_EQ(status("city.city.jsonl")["buildings"]["all"], 1500);
  EXPECT_THAT(run("status " + at("city.city.jsonl")).out, HasSubstr("the same command goes on from there"));

  const auto second = run(extrude("city.city.jsonl"));
  ASSERT_EQ(second.exit, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr(" tasks were taken over from an earlier run"));
  EXPECT_THAT(second.err, testing::Not(HasSubstr("made again")));
  EXPECT_EQ(outputs(), std::set<std::string>{"city.city.jsonl"});
  ASSERT_EQ(run(extrude("whole.city.jsonl", "-q --no-resume -j 1")).exit, 0);
  EXPECT_EQ(file("city.city.jsonl"), file("whole.city.jsonl"));
}

TEST_F(ResumeExtrude, makes_again_what_changed_and_says_why) {
  const auto reuse = [&](const std::string& what) {
    return Json::parse(read(at("out") + "/run.json"))["times"]["reuse"][what];
  };
  const auto expect_bytes_of_a_fresh_run = [&](const std::string& more = "") {
    ASSERT_EQ(run(in_folder("fresh", "-q --no-resume --overwrite " + more)).exit, 0);
    EXPECT_THAT(different(results("out"), results("fresh")), testing::IsEmpty());
  };
  ASSERT_EQ(run(in_folder("out", "-q")).exit, 0);
  EXPECT_EQ(status("out")["state"], "finished");
  const auto same = run(in_folder("out", "--overwrite"));
  EXPECT_THAT(same.err, HasSubstr(" tasks were taken over from an earlier run\n"));
  const int all = reuse("tasks_taken_over");
  EXPECT_GT(all, 20);
  EXPECT_THAT(same.err, HasSubstr(std::to_string(all) + " of " + std::to_string(all) + " tasks"));

  houses(160, 1.0);  // one house is longer: its task is made again, and those within 50 m
  EXPECT_THAT(run(in_folder("out", "--overwrite")).err, HasSubstr("; made again because of what changed: "));
  const int here = static_cast<int>(reuse("tasks_made_again")["footprints"].size());
  EXPECT_GE(here, 1);
  EXPECT_LE(here, 6);
  EXPECT_EQ(reuse("tasks_taken_over"), all - here);
  expect_bytes_of_a_fresh_run();

  houses(200, 1.0);  // two rows more: the frame begins elsewhere
  EXPECT_EQ(run(in_folder("out", "-q --overwrite")).exit, 0);
  EXPECT_GE(reuse("tasks_taken_over"), all / 2);
  expect_bytes_of_a_fresh_run();

  EXPECT_THAT(run(in_folder("out", "--overwrite --pitch 0.7")).err, HasSubstr(" (options)"));
  EXPECT_EQ(reuse("tasks_taken_over"), 0);
  expect_bytes_of_a_fresh_run("--pitch 0.7");
}

TEST_F(ResumeExtrude, goes_on_when_a_full_disk_has_space_again) {
  // A file beyond the limit fails as one on a full disk does.
  const auto full = [&](const std::string& words) {
    return std::system(("bash -c 'ulimit -f 500 && exec " + std::string(MANSARD_BINARY) + " " + words + "' >" +
                        at("stdout") + " 2>" + at("stderr"))
                           .c_str());
  };
  houses(800);
  const int ended = full(extrude("city.city.jsonl"));
  EXPECT_EQ(WEXITSTATUS(ended), 3) << read(at("stderr"));
  EXPECT_THAT(read(at("stderr")), HasSubstr("error[file-write]"));
  EXPECT_THAT(read(at("stderr")), HasSubstr("of 800 blocks are done and kept; the same command goes on from there"));
  EXPECT_EQ(outputs(), std::set<std::string>{"city.city.jsonl.mansard"});
  const auto second = run(extrude("city.city.jsonl"));
  EXPECT_EQ(second.exit, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr(" tasks were taken over from an earlier run"));
  ASSERT_EQ(run(extrude("whole.city.jsonl", "-q --no-resume")).exit, 0);
  EXPECT_EQ(file("city.city.jsonl"), file("whole.city.jsonl"));
}

TEST_F(ResumeExtrude, keeps_nothing_of_a_run_of_one_task) {
  const auto whole = "extrude -q " + at("houses.geojson") + " --formats cityjson -o " + at("out");
  ASSERT_EQ(run(whole).exit, 0);
  EXPECT_FALSE(fs::exists(at("out/.mansard")));
  ASSERT_EQ(run("extrude -q " + at("out/model.city.json") + " -o " + at("plans.json")).exit, 0);
  EXPECT_EQ(outputs(), (std::set<std::string>{"out", "plans.json"}));
  EXPECT_THAT(run("status " + at("out")).err, HasSubstr("error[status-none]"));
  // The output is locked all the same.
  fs::create_directory(at("plans.json.mansard"));
  const int lock = ::open((at("plans.json.mansard/lock")).c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_GE(lock, 0);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  EXPECT_THAT(run("extrude -q " + at("houses.geojson") + " --overwrite -o " + at("plans.json")).err,
              HasSubstr("error[output-busy]"));
  ::close(lock);
  EXPECT_EQ(run("extrude -q " + at("houses.geojson") + " --overwrite -o " + at("plans.json")).exit, 0);
  EXPECT_EQ(outputs(), (std::set<std::string>{"out", "plans.json"}));
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
