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

TEST(Zip, is_unpacked_as_it_was) {
  const Folder folder;
  fs::create_directories(folder / "a/content");
  write(folder / "a/tileset.json", "{}");
  write(folder / "a/content/0.glb", std::string(100'000, 'x') + '\0');
  write(folder / "a.zip", *zip_of(folder / "a"));
  EXPECT_THAT(*names_in_zip(folder / "a.zip"), testing::ElementsAre("content/0.glb", "tileset.json"));
  ASSERT_TRUE(unzip(folder / "a.zip", folder / "b"));
  for (const auto* name : {"tileset.json", "content/0.glb"})
    EXPECT_EQ(read(folder / "b" / name) == read(folder / "a" / name), true) << name;
}

TEST(Zip, is_refused_if_it_is_damaged_compressed_or_would_leave_its_folder) {
  const Folder folder;
  fs::create_directories(folder / "a");
  write(folder / "a/name.txt", "123456789");
  const auto zip = *zip_of(folder / "a");
  const auto code = [&](std::string bytes) {
    write(folder / "x.zip", bytes);
    const auto done = unzip(folder / "x.zip", folder / "x");
    return done ? std::string() : done.error().code;
  };
  const auto with = [&](const std::string& what, const std::string& by) {
    auto bytes = zip;
    for (auto at = bytes.find(what); at != bytes.npos; at = bytes.find(what, at + by.size()))
      bytes.replace(at, what.size(), by);
    return bytes;
  };
  EXPECT_EQ(code(zip), "");
  EXPECT_EQ(code(with("name.txt", "../n.txt")), "server-archive");
  EXPECT_EQ(code(with("name.txt", "/ame.txt")), "server-archive");
  EXPECT_EQ(code(with("123456789", "123456780")), "server-archive") << "the check sum";
  for (std::size_t length = 0; length < zip.size(); length += 7)
    EXPECT_EQ(code(zip.substr(0, length)), "server-archive") << length;
  auto deflated = zip;
  deflated[deflated.find("PK\x01\x02") + 10] = 8;
  EXPECT_EQ(code(deflated), "server-archive");
  EXPECT_FALSE(fs::exists(folder / "n.txt"));
  EXPECT_EQ(names_in_zip(folder / "none.zip").error().code, "file-missing");
}

}  // namespace
}  // namespace mansard::server
