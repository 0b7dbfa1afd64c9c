// Files and folders that appear together or not at all.
#include "mansard/base/outputs.hpp"
#include "base/scratch.hpp"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>
#include <fstream>
#include <set>

#include "mansard/base/files.hpp"

namespace {

namespace fs = std::filesystem;
using namespace mansard::base;

class OutputsTest : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  [[nodiscard]] auto read(const std::string& name) const -> std::string {
    const auto text = read_file(folder_ / name);
    return text ? *text : text.error().code;
  }
  [[nodiscard]] auto names() const -> std::set<std::string> {
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      all.insert(fs::relative(entry.path(), folder_).string());
    return all;
  }

  mansard::test::Scratch folder_;
};

using Names = std::set<std::string>;

TEST_F(OutputsTest, appear_with_the_commit_and_not_before) {
  Outputs outputs;
  const auto a = outputs.file(folder_ / "a"), b = outputs.file(folder_ / "b");
  ASSERT_TRUE(a && b);
  (*a)->append("one ");
  (*a)->append({});
  (*b)->append("three");
  (*a)->append("two");
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  ASSERT_TRUE(outputs.commit());
  EXPECT_EQ(names(), (Names{"a", "b"}));
  EXPECT_EQ(read("a"), "one two");
  EXPECT_EQ(read("b"), "three");
}

TEST_F(OutputsTest, leave_nothing_when_they_are_not_committed) {
  write("a", "old");
  {
    Outputs outputs;
    (*outputs.file(folder_ / "a"))->append("new");
    const auto folder = outputs.folder(folder_ / "tiles");
    std::ofstream(*folder / "inside") << "new";
    std::ofstream(*outputs.place(folder_ / "placed")) << "new";
  }
  EXPECT_EQ(names(), Names{"a"});
  EXPECT_EQ(read("a"), "old");
}

TEST_F(OutputsTest, replace_files_and_whole_folders) {
  write("a", "old");
  fs::create_directories(folder_ / "tiles");
  write("tiles/gone", "old");
  Outputs outputs;
  (*outputs.file(folder_ / "a"))->append("new");
  std::ofstream(*outputs.folder(folder_ / "tiles") / "stays") << "new";
  ASSERT_TRUE(outputs.commit());
  EXPECT_EQ(names(), (Names{"a", "tiles", "tiles/stays"}));
  EXPECT_EQ(read("a"), "new");
}

TEST_F(OutputsTest, put_everything_back_when_one_cannot_take_its_place) {
  write("a", "old");
  fs::create_directories(folder_ / "tiles");
  write("tiles/inside", "old");
  Outputs outputs;
  (*outputs.file(folder_ / "a"))->append("new");
  (*outputs.file(folder_ / "b"))->append("new");
  std::ofstream(*outputs.folder(folder_ / "tiles") / "other") << "new";
  ASSERT_TRUE(outputs.place(folder_ / "never-made"));
  const auto committed = outputs.commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, "file-write");
  EXPECT_EQ(committed.error().subject, (folder_ / "never-made").string());
  EXPECT_EQ(read("a"), "old");
  EXPECT_EQ(read("tiles/inside"), "old");
  EXPECT_FALSE(fs::exists(folder_ / "b"));
  EXPECT_FALSE(fs::exists(folder_ / "tiles/other"));
}

TEST_F(OutputsTest, leave_no_second_name_of_what_could_not_be_replaced) {
  write("a", "old");
  Outputs outputs;
  ASSERT_TRUE(outputs.place(folder_ / "a"));  // and never made
  ASSERT_FALSE(outputs.commit());
  EXPECT_EQ(read("a"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(OutputsTest, are_not_written_when_cancelled) {
  write("a", "old");
  Cancel cancel;
  cancel.request();
  {
    Outputs outputs;
    (*outputs.file(folder_ / "a"))->append("new");
    const auto committed = outputs.commit(&cancel);
    ASSERT_FALSE(committed);
    EXPECT_EQ(committed.error().code, "cancelled");
  }
  EXPECT_EQ(names(), Names{"a"});
  EXPECT_EQ(read("a"), "old");
}

TEST_F(OutputsTest, of_a_killed_process_do_not_look_like_results_and_are_taken_over) {
  write("a", "old");
  const auto child = ::fork();
  if (child == 0) {
    Outputs outputs;
    (*outputs.file(folder_ / "a"))->append("half");
    ::_exit(1);  // without destructors, as when killed
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(read("a"), "old");
  for (const auto& name : names()) EXPECT_TRUE(name == "a" || name.starts_with("a.part")) << name;
}

TEST_F(OutputsTest, say_what_is_wrong_with_a_place) {
  Outputs outputs;
  fs::create_directories(folder_ / "full");
  EXPECT_EQ(outputs.file(folder_ / "full").error().code, "file-write") << "a folder is not replaced by a file";
  EXPECT_EQ(outputs.file(folder_ / "none" / "a").error().subject, (folder_ / "none" / "a").string());
}

TEST(Spools, give_back_what_was_put_aside_whole_and_in_pieces) {
  auto spool = Spool::open();
  ASSERT_TRUE(spool);
  std::string all;
  for (int i = 0; i < 300000; ++i) {
    const std::string piece = std::to_string(i) + ",";
    (*spool)->append(piece);
    all += piece;
  }
  EXPECT_EQ((*spool)->size(), all.size());
  EXPECT_EQ(*(*spool)->read(1000000, 20), all.substr(1000000, 20));
  (*spool)->append("end");
  TextSink sink;
  ASSERT_TRUE((*spool)->copy_to(sink));
  EXPECT_EQ(sink.text, all + "end");
  EXPECT_FALSE((*spool)->read(all.size(), 100)) << "beyond the end";
}

}  // namespace
