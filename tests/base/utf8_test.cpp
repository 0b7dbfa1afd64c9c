#include "mansard/base/utf8.hpp"

#include <gmock/gmock.h>

namespace mansard::base {
namespace {

TEST(Utf8, markup_is_escaped_and_stays_well_formed) {
  EXPECT_EQ(markup_escaped("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; 'd'");
  EXPECT_EQ(markup_escaped("<script>&amp;"), "&lt;script&gt;&amp;amp;");
  EXPECT_EQ(markup_escaped(std::string_view("one\ttwo\nthree\x01\x1b\0four", 20)), "one\ttwo\nthree   four");
  EXPECT_EQ(markup_escaped("Straße \xE2\x82\xAC"), "Straße \xE2\x82\xAC");
  EXPECT_EQ(markup_escaped("Stra\xDF"
                           "e \xE2\x82"),
            "Stra\xEF\xBF\xBD"
            "e \xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(Utf8, text_that_is_not_utf8_becomes_it) {
  EXPECT_EQ(as_utf8("plain"), "plain");
  EXPECT_EQ(as_utf8("Stra\xDF"
                    "e"),
            "Stra\xEF\xBF\xBD"
            "e");
  EXPECT_EQ(as_utf8("\xC0\xAF"), "\xEF\xBF\xBD\xEF\xBF\xBD") << "an overlong sequence";
}

}  // namespace
}  // namespace mansard::base
