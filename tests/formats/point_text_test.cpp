// Point clouds as text: which column is what, and errors that name the line.
#include "mansard/formats/xyz/point_reader.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/scratch.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using geometry::Point3;

class PointText : public testing::Test {
 protected:
  auto file(const std::string& name, const std::string& text) -> fs::path {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  auto points_of(const std::string& text, PointInfo* info = nullptr) -> std::vector<CloudPoint> {
    const auto cloud = open_point_text(file("cloud.xyz", text));
    EXPECT_TRUE(cloud) << cloud.error().message;
    if (!cloud) return {};
    if (info != nullptr) *info = (*cloud)->info();
    std::vector<CloudPoint> out;
    for (std::size_t i = 0; i < (*cloud)->pieces(); ++i) {
      const auto piece = (*cloud)->read(i);
      EXPECT_TRUE(piece);
      out.insert(out.end(), piece->begin(), piece->end());
    }
    EXPECT_EQ(out.size(), (*cloud)->info().points);
    return out;
  }
  auto said_of(const std::string& text) -> std::string {
    const auto cloud = open_point_text(file("cloud.xyz", text));
    return cloud ? "no error" : cloud.error().code + ": " + cloud.error().message;
  }

 private:
  test::Scratch folder_;
};

TEST_F(PointText, without_a_header_is_x_y_z_by_any_separator) {
  for (const auto* text :
       {"1 2 3.5\n-4 5e1 6\n", "1,2,3.5\n-4,5e1,6\n", "1;2;3,5\r\n-4;50;6\r\n", "1\t2\t3.5\n-4\t50\t6",
        "1,0 2,0 3,5\n-4 50,0 6\n", "1, 2, 3.5\n-4, 50, 6\n", "\n# made by hand\n  1   2  3.5  \n\n// end\n-4 50 6\n",
        "\xEF\xBB\xBF"
        "1 2 3.5\n-4 50 6\n",
        "2\n1 2 3.5\n-4 50 6\n", "1,2,3.5,\n-4,50,6,\n", "1 2 3.5 17\n-4 50 6 18\n"}) {
    PointInfo info;
    const auto points = points_of(text, &info);
    ASSERT_EQ(points.size(), 2U) << text;
    EXPECT_EQ(points[0].position, (Point3{1, 2, 3.5})) << text;
    EXPECT_EQ(points[1].position, (Point3{-4, 50, 6})) << text;
    EXPECT_FALSE(info.has_classes);
    EXPECT_FALSE(info.has_colours) << text;
    ASSERT_TRUE(info.stated_bounds);
    EXPECT_EQ(info.stated_bounds->most, (Point3{1, 50, 6}));
  }
}

TEST_F(PointText, with_a_header_has_its_columns_in_any_order) {
  PointInfo info;
  const auto points = points_of(
      "\"Northing [m]\";class;Easting;scan angle;Height;red;green;blue;returns;return\n"
      "447400,5;6;84800,25;-3;12,5;255;128;0;3;2\n",
      &info);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].position, (Point3{84800.25, 447400.5, 12.5}));
  EXPECT_EQ(points[0].classification, 6);
  EXPECT_EQ(points[0].returns, 3);
  EXPECT_EQ(points[0].return_number, 2);
  EXPECT_THAT(points[0].colour, testing::ElementsAre(255, 128, 0));
  EXPECT_TRUE(info.has_classes && info.has_returns && info.has_colours);
  EXPECT_EQ(points_of("# x y z classification\n1 2 3 2\n")[0].classification, 2) << "a header that is a comment";
  EXPECT_EQ(points_of("x y z\n1,5 2,5 3,5\n")[0].position, (Point3{1.5, 2.5, 3.5})) << "decimal commas";
  EXPECT_EQ(points_of("//X,Y,Z,Intensity\n1,2,3,700\n")[0].position.z, 3);
}

TEST_F(PointText, of_six_and_seven_columns_has_colours) {
  EXPECT_THAT(points_of("1 2 3 10 20 30\n")[0].colour, testing::ElementsAre(10, 20, 30));
  const auto points = points_of("1 2 3 -400 10 20 30\n4 5 6 90 1 2 3\n");
  EXPECT_THAT(points[0].colour, testing::ElementsAre(10, 20, 30));
  EXPECT_EQ(points[0].intensity, 0);
  EXPECT_EQ(points[1].intensity, 90);
  EXPECT_THAT(points_of("x y z r g b\n1 2 3 1.0 0.5 0.0\n")[0].colour, testing::ElementsAre(255, 128, 0)) << "shares";
}

TEST_F(PointText, that_is_broken_names_the_line) {
  EXPECT_THAT(said_of("1 2 3\n4 5\n"), testing::AllOf(testing::StartsWith("ingest-points-format: line 2"),
                                                      testing::HasSubstr("2 of 3 columns")));
  EXPECT_THAT(said_of("# c\n1 2 3\n\n4 five 6\n"), testing::HasSubstr("line 4 has 'five'"));
  EXPECT_THAT(said_of("1 2\n"), testing::HasSubstr("line 1 has 2 of the three numbers"));
  EXPECT_THAT(said_of("x y red\n1 2 3\n"), testing::HasSubstr("without a column z"));
  EXPECT_THAT(said_of("x y z x\n1 2 3 4\n"), testing::HasSubstr("two columns x"));
  EXPECT_TRUE(std::isnan(points_of("1 2 nan\n")[0].position.z)) << "left to those who use it";
  EXPECT_TRUE(points_of("").empty());
  EXPECT_TRUE(points_of("# nothing\n").empty());
}

TEST_F(PointText, is_told_from_other_text) {
  EXPECT_TRUE(is_point_text("x,y,z\n1,2,3\n"));
  EXPECT_TRUE(is_point_text("84800.1 447400.2 3\n84800.1 4474"));
  EXPECT_FALSE(is_point_text("id,name,height\n1,a,3\n"));
  EXPECT_FALSE(is_point_text("This is what we know of the scan.\n"));
  EXPECT_FALSE(is_point_text(""));
  EXPECT_FALSE(is_point_text(std::string("1 2 3\n\0\0", 8)));
  EXPECT_TRUE(is_point_cloud(file("a.csv", "X;Y;Z\n1;2;3\n")));
  EXPECT_FALSE(is_point_cloud(file("b.csv", "id;height\n1;2\n")));
  const auto named = read_mesh_file(file("d.csv", "X;Y;Deutung\n1;2;3\n"), UpAxis::automatic);
  ASSERT_TRUE(named.failure);
  EXPECT_THAT(named.failure->message, testing::HasSubstr("a header with the columns x, y and z"));
  EXPECT_FALSE(is_point_cloud(file("readme.txt", "Points of the survey of 2026\n")));
  EXPECT_TRUE(is_point_cloud(file("c.pts", "not looked into")));
}

}  // namespace
}  // namespace mansard::formats
