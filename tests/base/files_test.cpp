#include "mansard/base/files.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace mansard::base
