#include "mansard/formats/input_name.hpp"

#include <gmock/gmock.h>
#include <fstream>

#include "ingest/workshop.hpp"
#include "mansard/formats/files/address.hpp"

namespace mansard::ingest::test {
namespace {

namespace fs = std::filesystem;

TEST(InputName, hides_every_password_that_a_database_takes) {
  const std::vector<std::pair<std::string, std::string>> shown{
      {"PG:dbname=a password = se&cret host=b", "PG:dbname=a password = *** host=b"},
      {"PG:password=a\\ b dbname=c", "PG:password=*** dbname=c"},
      {"PG:password='never closed", "PG:password=***"},
      {"PG:sslpassword=a password=b", "PG:sslpassword=*** password=***"},
      {"PG:host=h passfile=f user=password", "PG:host=h passfile=f user=password"},
      {"PG:postgresql://me:secret@host/a", "PG:postgresql://me:***@host/a"},
      {"postgresql://me:s@cret@host/a?sslpassword=b&password=c",
       "postgresql://me:***@host/a?sslpassword=***&password=***"},
      {"postgresql://host:5432/a@b", "postgresql://host:5432/a@b"},
      {"PG:dbname='a://b:c@d'", "PG:dbname='a://b:c@d'"},
      {"PG:password=", "PG:password="},
      {"PG:password=\\", "PG:password=***"},
      {"PG:=", "PG:="}};
  for (const auto& [name, text] : shown) EXPECT_EQ(formats::name_to_show(name), text) << name;
  EXPECT_EQ(formats::shown_text("`PG:dbname=a password='se cret'' was refused: no \"se cret\"",
                                "PG:dbname=a password='se cret'"),
            "`PG:dbname=a password=***' was refused: no \"***\"");
}

TEST(InputName, keeps_all_of_a_database_but_its_password) {
  const std::vector<std::pair<std::string, std::string>> kept{
      {"PG:dbname=a password=secret host=b", "PG:dbname=a host=b"},
      {"PG:password = 'se cret' host=b", "PG:host=b"},
      {"PG:host=b sslpassword=x password=y", "PG:host=b"},
      {"postgresql://me:secret@host/a", "postgresql://me@host/a"},
      {"postgresql://me@host/a?password=secret&x=1", "postgresql://me@host/a?x=1"},
      {"postgresql://me@host/a?x=1&password=secret", "postgresql://me@host/a?x=1"},
      {"postgresql://me@host/a?password=secret", "postgresql://me@host/a"},
      {"PG:host=b user=c", "PG:host=b user=c"},
      {"/data/password=secret", "/data/password=secret"}};
  for (const auto& [name, text] : kept) EXPECT_EQ(formats::name_to_keep(name), text) << name;
}

TEST(InputName, means_the_password_that_is_known_where_it_says_stars) {
  const std::string known = "PG:host=b password=secret";
  EXPECT_EQ(formats::meant_by("PG:host=b password=***", known), known);
  EXPECT_EQ(formats::meant_by("PG:host=b password=other", known), "PG:host=b password=other");
  EXPECT_EQ(formats::meant_by("PG:host=c password=***", known), "PG:host=c") << "it is for another host";
  EXPECT_EQ(formats::meant_by("PG:host=b password=***", ""), "PG:host=b");
  EXPECT_EQ(formats::meant_by("/a/b.gpkg", known), "/a/b.gpkg");
}

class InputPlace : public Workshop {};

TEST_F(InputPlace, is_on_disk_in_an_archive_there_or_elsewhere) {
  const auto path = file("a.zip", "no archive");
  EXPECT_TRUE(formats::is_disk_name(path));
  EXPECT_TRUE(formats::is_disk_name("relative/a.obj.gz"));
  EXPECT_FALSE(formats::is_disk_name("/vsizip/" + path.string() + "/a.obj"));
  EXPECT_FALSE(formats::is_disk_name("PG:dbname=a"));
  EXPECT_EQ(formats::disk_place_of(path), path);
  EXPECT_EQ(formats::disk_place_of("/vsizip/" + path.string() + "/a.obj"), path);
  EXPECT_EQ(formats::disk_place_of("/vsizip/{" + path.string() + "}/a.obj"), path);
  EXPECT_FALSE(formats::disk_place_of("PG:dbname=a"));
  EXPECT_FALSE(formats::disk_place_of("/vsizip//vsicurl/http://127.0.0.1:9/a.zip"));

  const auto code = [](const fs::path& name) {
    const auto checked = formats::check_input(name);
    return checked ? std::string() : checked.error().code;
  };
  EXPECT_EQ(code(path), "");
  EXPECT_EQ(code(path.parent_path()), "");
  EXPECT_EQ(code(path.parent_path() / "none"), "file-missing");
  EXPECT_EQ(code("/vsizip/" + (path.parent_path() / "none.zip").string() + "/a.obj"), "file-missing");
  EXPECT_EQ(code("/vsinone/a"), "file-missing");
  EXPECT_EQ(code("PG:host=127.0.0.1 port=9"), "") << "nobody is asked";
  EXPECT_EQ(code("/vsicurl/http://127.0.0.1:9/a.obj"), "");
}

}  // namespace
}  // namespace mansard::ingest::test
