// What other files name, and pipes.
#include "mansard/formats/files/named_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/files/uri.hpp"
#include "mansard/formats/given.hpp"

namespace mansard::formats {
namespace {

using testing::HasSubstr;

TEST(Pipes, are_refused_at_once_whether_somebody_writes_or_not) {
  const test::Scratch folder;
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto refused = [&] {
    for (const auto& words :
         std::vector{check_given(pipe).error(), base::read_file(pipe).error(), Bytes::of(pipe).error()}) {
      EXPECT_EQ(words.code, "file-read");
      EXPECT_THAT(words.message, HasSubstr("to a file, and give that file"));
    }
  };
  refused();
  const int held = ::open(pipe.c_str(), O_RDWR);  // somebody has it open, and says nothing
  refused();
  ASSERT_EQ(::write(held, "all of it", 9), 9);  // or says all there is, and goes
  refused();
  ::close(held);
  refused();
  EXPECT_TRUE(check_given(folder / "nothing"));  // reading it says what is wrong
  ASSERT_TRUE(base::write_file(folder / "file", "x"));
  EXPECT_TRUE(check_given(folder / "file"));
}

TEST(Texts, in_encodings_that_are_not_read_are_told) {
  const test::Scratch folder;
  const auto told = [&](std::string bytes) {
    EXPECT_TRUE(base::write_file(folder / "file", bytes));
    const auto checked = check_text(folder / "file");
    return checked ? std::string() : checked.error().message;
  };
  const auto wide = [](std::string_view text, std::size_t before, std::size_t after) {
    std::string out;
    for (const char c : text) out += std::string(before, '\0') + c + std::string(after, '\0');
    return out;
  };
  EXPECT_THAT(told("\xFF\xFE" + wide("{\"type\":", 0, 1)), HasSubstr("UTF-16; save it in UTF-8"));
  EXPECT_THAT(told("\xFE\xFF" + wide("{\"type\":", 1, 0)), HasSubstr("UTF-16"));
  EXPECT_THAT(told(wide("{\"type\":", 0, 1)), HasSubstr("UTF-16"));
  EXPECT_THAT(told(wide("id,name", 1, 0)), HasSubstr("UTF-16"));
  EXPECT_THAT(told(std::string("\xFF\xFE\0\0", 4) + wide("v 0 0", 0, 3)), HasSubstr("UTF-32"));
  EXPECT_THAT(told(std::string("\0\0\xFE\xFF", 4) + wide("v 0 0", 3, 0)), HasSubstr("UTF-32"));
  for (const auto& bytes : {std::string(), std::string("{"), std::string("\xEF\xBB\xBFv 0 0 0\n"),
                            std::string(80, '\0'), std::string("LASF\0\0\0\0\0", 9), "\xFF\xFE" + wide("<?xml", 0, 1),
                            "\xFE\xFF" + wide("<?xml", 1, 0), wide("<?xml", 0, 1)})
    EXPECT_EQ(told(bytes), "") << bytes;
  EXPECT_TRUE(check_text(folder / "nothing"));
  EXPECT_TRUE(check_text(folder));
}

TEST(DataUris, have_a_type_or_none_and_escapes_or_base64) {
  const auto read = [](std::string_view uri) {
    const auto found = data_uri(uri);
    return found ? std::pair(found->data, found->base64) : std::pair(std::string("none"), false);
  };
  using Pair = std::pair<std::string, bool>;
  EXPECT_EQ(read("data:;base64,QUJD"), Pair("QUJD", true));
  EXPECT_EQ(read("data:application/octet-stream;base64,QUJD"), Pair("QUJD", true));
  EXPECT_EQ(read("DATA:text/plain;charset=utf-8;BASE64,QUI%3D"), Pair("QUI=", true));
  EXPECT_EQ(read("data:,A%20B%00"), Pair(std::string("A B\0", 4), false));
  EXPECT_EQ(read("data:base64,QUJD"), Pair("QUJD", false));
  EXPECT_EQ(read("data:;base64"), Pair("none", false));  // no comma
  EXPECT_EQ(read("database.bin"), Pair("none", false));
  EXPECT_EQ(read(""), Pair("none", false));
}

}  // namespace
}  // namespace mansard::formats
