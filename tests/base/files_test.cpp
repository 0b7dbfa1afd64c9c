#include "mansard/base/files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "base/scratch.hpp"

namespace mansard::base {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  mansard::test::Scratch folder_;
};

TEST_F(Files, come_back_as_they_were_written) {
  const std::string bytes("a\0b\r\n\xff", 6);
  ASSERT_TRUE(write_file(folder_ / "x", bytes));
  ASSERT_TRUE(write_file(folder_ / "x", bytes + "!"));
  EXPECT_EQ(*read_file(folder_ / "x"), bytes + "!");
}

TEST_F(Files, leave_nothing_half_written_behind) {
  fs::create_directory(folder_ / "taken");
  const auto written = write_file(folder_ / "taken", "bytes");  // a folder is in the way of the rename
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, "file-write");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
  EXPECT_FALSE(write_file(folder_ / "no such folder" / "x", "bytes"));
}

TEST_F(Files, that_are_missing_or_folders_are_told_apart) {
  EXPECT_EQ(read_file(folder_ / "nothing").error().code, "file-missing");
  EXPECT_EQ(read_file(folder_).error().code, "file-read");
}

TEST_F(Files, that_have_no_size_are_read_to_their_end) {
  const auto status = read_file("/proc/self/status");  // says that it has no bytes
  ASSERT_TRUE(status);
  EXPECT_NE(status->find("VmPeak"), std::string::npos);
  EXPECT_TRUE(read_file("/dev/null")->empty());
}

TEST_F(Files, that_are_pipes_are_refused_without_waiting) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_FALSE(read_file(pipe));
  EXPECT_EQ(read_file(pipe).error().code, "file-read");
  EXPECT_TRUE(check_no_pipe(folder_ / "nothing"));
}

}  // namespace
}  // namespace mansard::base
