#include "apps/server/zip.hpp"

#include <gmock/gmock.h>

#include "server/running.hpp"

namespace mansard::server {
namespace {

TEST(Zip, has_the_files_of_a_folder_and_is_reproducible) {
  const Folder folder;
  fs::create_directories(folder / "a/content");
  write(folder / "a/tileset.json", "{}");
  write(folder / "a/content/0.glb", std::string(100'000, 'x') + '\0');
  write(folder / "a/empty", "");
  const auto zip = zip_of(folder / "a");
  ASSERT_TRUE(zip);
  fs::last_write_time(folder / "a/tileset.json",
                      fs::last_write_time(folder / "a/tileset.json") - std::chrono::hours(50));
  EXPECT_EQ(*zip_of(folder / "a") == *zip, true);
  // CMake unpacks with libarchive.
  write(folder / "a.zip", *zip);
  fs::create_directories(folder / "b");
  ASSERT_EQ(std::system(("cd " + (folder / "b").string() + " && cmake -E tar xf ../a.zip").c_str()), 0);
  for (const auto* name : {"tileset.json", "content/0.glb", "empty"})
    EXPECT_EQ(read(folder / "b" / name) == read(folder / "a" / name), true) << name;
  EXPECT_EQ(zip_of(folder / "none").error().code, "file-read");
}

TEST(Zip, has_valid_check_sums) {
  const Folder folder;
  fs::create_directories(folder / "a");
  write(folder / "a/digits", "123456789");  // the check value of CRC-32
  const auto zip = zip_of(folder / "a");
  ASSERT_TRUE(zip);
  const auto sum = zip->substr(14, 4);
  EXPECT_EQ(sum, "\x26\x39\xF4\xCB");
  EXPECT_EQ(zip->substr(zip->find("PK\x01\x02") + 16, 4), sum) << "also in the central directory";
}

}  // namespace
}  // namespace mansard::server
