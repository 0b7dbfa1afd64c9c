// Files in archives, compressed, and not there at all.
#include "mansard/formats/files/virtual_files.hpp"

#include <gdal/cpl_string.h>
#include <gdal/cpl_vsi.h>
#include <gmock/gmock.h>

#include <set>

#include "ingest/workshop.hpp"
#include "mansard/formats/files/zip_directory.hpp"
#include "mansard/ingest/detail/files_below.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::HasSubstr;

class VirtualFiles : public Workshop {
 protected:
  /// Writes through GDAL: "/vsizip/…" and "/vsigzip/…" pack.
  static void pack(const std::string& name, std::string_view bytes) {
    VSILFILE* file = VSIFOpenL(name.c_str(), "wb");
    ASSERT_NE(file, nullptr) << name;
    ASSERT_EQ(VSIFWriteL(bytes.data(), 1, bytes.size(), file), bytes.size());
    VSIFCloseL(file);
  }
  static auto text_of(const fs::path& path) -> std::string {
    const auto bytes = formats::Bytes::of(path);
    return bytes ? std::string(bytes->view()) : base::to_string(bytes.error());
  }
};

constexpr std::string_view triangle = "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n";

TEST_F(VirtualFiles, on_disk_are_mapped_and_those_packed_are_unpacked) {
  EXPECT_EQ(text_of(file("t.obj", triangle)), triangle);
  EXPECT_EQ(text_of(file("none.obj", "")), "");
  pack("/vsigzip/" + at("t.obj.gz").string(), triangle);
  EXPECT_LT(base::read_file(at("t.obj.gz")).value().substr(0, 2), triangle);
  EXPECT_EQ(text_of(at("t.obj.gz")), triangle);
  EXPECT_EQ(text_of("/vsigzip/" + at("t.obj.gz").string()), triangle);
  EXPECT_FALSE(fs::exists(at("t.obj.gz.properties")));
  const std::string zip = "/vsizip/" + at("t.zip").string();
  pack(zip + "/folder/t.obj", triangle);
  EXPECT_EQ(text_of(zip + "/folder/t.obj"), triangle);
  const std::string large(5000000, 'x');
  pack("/vsigzip/" + at("large.gz").string(), large);
  EXPECT_EQ(text_of(at("large.gz")), large);
}

TEST_F(VirtualFiles, that_grow_as_no_input_does_are_refused) {
  const std::string zeros(std::size_t{100} << 20, '\0');
  for (const auto& name : {"/vsigzip/" + at("bomb.gz").string(), "/vsizip/" + at("bomb.zip").string() + "/mesh.ply"}) {
    VSILFILE* file = VSIFOpenL(name.c_str(), "wb");
    ASSERT_NE(file, nullptr);
    for (int i = 0; i < 3; ++i) ASSERT_EQ(VSIFWriteL(zeros.data(), 1, zeros.size(), file), zeros.size());
    VSIFCloseL(file);
    EXPECT_THAT(text_of(name), HasSubstr("200 times the size of its archive")) << name;
  }
}

TEST_F(VirtualFiles, in_an_archive_are_listed_in_one_pass) {
  const std::string zip = at("t.zip").string();
  std::set<std::string> expected;
  for (int i = 0; i < 300; ++i) {
    const auto name = (i % 3 == 0 ? "a/b/" : i % 3 == 1 ? "a/" : "") + std::to_string(i) + ".obj";
    pack("/vsizip/" + zip + "/" + name, triangle);
    expected.insert(name);
  }
  const auto names = formats::names_in_zip(zip);
  ASSERT_TRUE(names);
  EXPECT_EQ(std::set<std::string>(names->begin(), names->end()), expected);
  EXPECT_EQ(names->size(), expected.size());  // each once, and no folders
  std::size_t below = 0;
  const auto listed = detail::files_below("/vsizip/" + zip + "/a");
  ASSERT_TRUE(listed);
  for (const auto& path : *listed) {
    EXPECT_EQ(path.string().rfind("/vsizip/" + zip + "/a/", 0), 0U) << path;
    ++below;
  }
  EXPECT_EQ(below, 200U);
  EXPECT_EQ(detail::files_below("/vsizip/" + zip)->size(), 300U);
  // As GDAL calls them, whatever that is.
  pack("/vsizip/" + at("other.zip").string() +
           "/Stra\xc3\x9f"
           "e.obj",
       triangle);
  EXPECT_FALSE(formats::names_in_zip(at("other.zip")));
  const auto other = detail::files_below("/vsizip/" + at("other.zip").string());
  ASSERT_TRUE(other);
  ASSERT_EQ(other->size(), 1U);
  EXPECT_EQ(text_of(other->front()), triangle);
  EXPECT_FALSE(formats::names_in_zip(file("no.zip", triangle)));
  const auto bytes = base::read_file(zip).value();
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{21}, bytes.size() / 2, bytes.size() - 23, bytes.size() - 1})
    EXPECT_FALSE(formats::names_in_zip(file("cut.zip", bytes.substr(0, length)))) << length;
}

TEST_F(VirtualFiles, are_called_what_gdal_calls_them) {
  using formats::name_for_gdal;
  EXPECT_EQ(formats::name_for_gdal("a/b.geojson.GZ"), "/vsigzip/a/b.geojson.GZ");
  EXPECT_EQ(formats::name_for_gdal("/a/b.zip"), "/vsizip//a/b.zip");
  EXPECT_EQ(formats::name_for_gdal("/vsizip/a.zip/b.shp"), "/vsizip/a.zip/b.shp");
  EXPECT_EQ(formats::name_for_gdal("a.gpkg"), "a.gpkg");
  EXPECT_EQ(formats::plain_name("a/b.obj.gz"), "a/b.obj");
  EXPECT_EQ(formats::plain_name("a/b.obj"), "a/b.obj");
  EXPECT_TRUE(formats::is_virtual("/vsicurl/https://host/a.obj"));
  EXPECT_FALSE(formats::is_virtual("a.zip"));
}

TEST_F(VirtualFiles, that_are_missing_say_what_there_is) {
  pack("/vsizip/" + at("t.zip").string() + "/folder/t.obj", triangle);
  const std::string zip = "/vsizip/" + at("t.zip").string();
  const auto why = [](const std::string& path) {
    const auto bytes = formats::Bytes::of(path);
    EXPECT_FALSE(bytes) << path;
    return bytes ? std::string() : bytes.error().code + ": " + bytes.error().message;
  };
  EXPECT_THAT(why(zip + "/folder/u.obj"), HasSubstr("file-missing: the archive has no 'folder/u.obj'; it has: folder"));
  EXPECT_THAT(why("/vsizip/" + at("u.zip").string() + "/t.obj"), HasSubstr("file-missing: no such archive"));
  EXPECT_THAT(why(at("u.obj.gz").string()), HasSubstr("file-missing: no such file"));
  EXPECT_THAT(why("https://host/u.obj"), HasSubstr("by the name /vsicurl/https://host/u.obj"));
  EXPECT_THAT(why("/vsinothing/a"), HasSubstr("file-missing: GDAL here knows no files under '/vsinothing/'"));
  file("broken.zip", "PK\3\4 and no more");
  EXPECT_THAT(why("/vsizip/" + at("broken.zip").string() + "/t.obj"), HasSubstr("file-read: "));
  file("broken.obj.gz", "not packed at all");
  EXPECT_THAT(why(at("broken.obj.gz").string()), HasSubstr("file-read: "));
  pack("/vsigzip/" + at("cut.obj.gz").string(), std::string(100000, 'v'));
  const auto whole = base::read_file(at("cut.obj.gz")).value();
  file("cut.obj.gz", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(why(at("cut.obj.gz").string()), HasSubstr("file-read: "));
}

TEST_F(VirtualFiles, a_mesh_is_found_in_its_archive_alone_or_among_others) {
  pack("/vsizip/" + at("one.zip").string() + "/t.obj", triangle);
  pack("/vsizip/" + at("deep.zip").string() + "/city/t.obj", triangle);
  pack("/vsizip/" + at("two.zip").string() + "/t.obj", triangle);
  pack("/vsizip/" + at("two.zip").string() + "/read.me", "words");
  for (const char* name : {"one.zip", "deep.zip", "two.zip"}) {
    const auto scene = mesh(at(name));
    ASSERT_TRUE(scene) << name << ": " << base::to_string(scene.error());
    EXPECT_EQ(scene->mesh.triangles.size(), 1U);
    EXPECT_THAT(scene->inputs.at(0).path, HasSubstr("/t.obj"));
  }
  pack("/vsizip/" + at("none.zip").string() + "/read.me", "words");
  EXPECT_EQ(code(mesh(at("none.zip"))), "ingest-mesh-empty");
  file("broken.zip", "PK\3\4 and no more");
  EXPECT_EQ(code(mesh(at("broken.zip"))), "file-read");
}

TEST_F(VirtualFiles, on_a_server_that_does_not_answer_give_gdals_words) {
  // Port 9 of this machine: no network is needed to be refused.
  const auto bytes = formats::Bytes::of("/vsicurl/http://127.0.0.1:9/t.obj");
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, "file-read");
  EXPECT_THAT(bytes.error().message, HasSubstr("the server does not give it"));
  EXPECT_FALSE(formats::is_there("/vsicurl/http://127.0.0.1:9/t.obj"));
}

}  // namespace
}  // namespace mansard::ingest::test
