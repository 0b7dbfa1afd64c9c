// What a run that ended before its time left is removed by the next one.
#include "mansard/base/unfinished.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <fstream>
#include <functional>
#include <set>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/outputs.hpp"

namespace {

namespace fs = std::filesystem;
using namespace mansard::base;
using testing::ElementsAre;
using testing::IsEmpty;

class UnfinishedTest : public testing::Test {
 protected:
  void write(const fs::path& path, const std::string& text) const { std::ofstream(path) << text; }
  [[nodiscard]] auto names() const -> std::set<std::string> {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.insert(entry.path().filename().string());
    return all;
  }
  /// In a process that ends as if it had been killed.
  static void in_killed_process(const std::function<void()>& work) {
    const auto child = ::fork();
    if (child == 0) {
      work();
      ::_exit(1);
    }
    ::waitpid(child, nullptr, 0);
  }
  /// The name of the place, as a process that is gone had it.
  auto of_killed(const fs::path& path, Beside what) const -> fs::path {
    in_killed_process([&] { write(folder_ / "name", beside(path, what).string()); });
    const auto name = read_file(folder_ / "name").value();
    fs::remove(folder_ / "name");
    return name;
  }

  mansard::test::Scratch folder_;
};

TEST_F(UnfinishedTest, names_say_what_is_on_its_way_to_its_place) {
  const auto part = beside(folder_ / "a.gpkg", Beside::part);
  EXPECT_TRUE(is_part(part));
  EXPECT_TRUE(is_part(part.string() + "-journal"));
  EXPECT_TRUE(is_part(of_killed(folder_ / "b", Beside::part)));
  EXPECT_FALSE(is_part(beside(folder_ / "a.gpkg", Beside::old)));
  for (const auto* name : {"a", "a.part", "a.part7", "spare.parts.obj", ".part7@host", "a.part0@host", "a.party@host"})
    EXPECT_FALSE(is_part(folder_ / name)) << name;
}

TEST_F(UnfinishedTest, files_and_folders_of_killed_processes_are_swept_by_the_next_that_writes_there) {
  in_killed_process([&] {
    Outputs outputs;
    (*outputs.file(folder_ / "a"))->append("half");
    std::ofstream(*outputs.folder(folder_ / "tiles") / "inside") << "half";
    write(beside(folder_ / "a.gpkg", Beside::part).string() + "-journal", "of the database");
    ::_exit(1);  // without destructors
  });
  ASSERT_EQ(names().size(), 3U);
  ASSERT_TRUE(write_file(folder_ / "b", "new"));  // another file, and other names than theirs
  EXPECT_THAT(names(), ElementsAre("b"));
}

TEST_F(UnfinishedTest, files_of_running_processes_stay) {
  const auto own = beside(folder_ / "a", Beside::part);
  write(own, "half");
  auto other = (folder_ / "a").string() + ".part" + std::to_string(::getppid());
  write(other + own.string().substr(own.string().rfind('@')), "half");
  sweep(folder_);
  EXPECT_EQ(names().size(), 2U);
}

TEST_F(UnfinishedTest, files_of_other_machines_stay_for_a_day) {
  const fs::path far = folder_ / "a.part4711@elsewhere.example";
  write(far, "half");
  sweep(folder_);
  EXPECT_EQ(names().size(), 1U);
  fs::last_write_time(far, fs::file_time_type::clock::now() - std::chrono::hours(25));
  sweep(folder_);
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(UnfinishedTest, what_was_about_to_be_replaced_is_put_back) {
  write(of_killed(folder_ / "a", Beside::old), "old a");
  write(of_killed(folder_ / "b", Beside::old), "old b");
  write(folder_ / "b", "new b");
  sweep(folder_);
  EXPECT_THAT(names(), ElementsAre("a", "b"));
  EXPECT_EQ(read_file(folder_ / "a").value(), "old a");
  EXPECT_EQ(read_file(folder_ / "b").value(), "new b");
}

TEST_F(UnfinishedTest, names_that_only_look_alike_stay) {
  const auto host = beside("a", Beside::part).string().substr(beside("a", Beside::part).string().rfind('@'));
  for (const std::string name : {"a.part", "a.part12", "a.partial", "a.part-5@x", "a.part12x@y", "a.old", ".part1@x"})
    write(folder_ / name, "of the user");
  write(folder_ / ("a.part0" + host), "of the user");
  sweep(folder_);
  EXPECT_EQ(names().size(), 8U);
}

TEST_F(UnfinishedTest, paths_are_removed_where_a_process_ends_at_once_and_the_others_are_not) {
  in_killed_process([&] {
    Outputs outputs;
    (*outputs.file(folder_ / "kept"))->append("whole");
    if (!outputs.commit()) ::_exit(2);
    (*outputs.file(folder_ / "a"))->append("half");
    std::ofstream(*outputs.folder(folder_ / "tiles") / "inside") << "half";
    write(beside(folder_ / "a", Beside::part).string() + "-wal", "of the database");
    remove_unfinished();
    ::_exit(1);
  });
  EXPECT_THAT(names(), ElementsAre("kept"));
}

}  // namespace
