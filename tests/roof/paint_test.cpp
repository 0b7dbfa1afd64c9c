// Colours and materials as files have them, and what parts take from their outline.
#include "roof/houses.hpp"

namespace mansard::roof::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using Tags = model::Attributes;

auto text(const char* value) -> model::Value { return std::string(value); }

TEST(Paint, is_read_as_mappers_write_it) {
  const std::vector<std::pair<const char*, Colour>> table{
      {"#b03020", {0xb0, 0x30, 0x20}}, {"#B32", {0xbb, 0x33, 0x22}},    {"red", {255, 0, 0}},
      {"Dark Grey", {169, 169, 169}},  {"light_grey", {211, 211, 211}}, {"slategray", {112, 128, 144}},
      {"white;red", {255, 255, 255}}};
  for (const auto& [given, colour] : table)
    for (const char* key : {"building:colour", "building:color", "BUILDING_COLOUR"}) {
      const auto read = paint_of({{key, text(given)}}, {});
      EXPECT_EQ(read.paint.wall, colour) << given << " " << key;
      EXPECT_FALSE(read.paint.roof);
      EXPECT_THAT(read.warnings, IsEmpty());
    }
  EXPECT_EQ(paint_of({{"other_tags", text(R"("roof:colour"=>"#000000")")}}, {}).paint.roof, Colour{});
}

TEST(Paint, of_no_known_colour_is_left_out_and_named) {
  for (const auto* bad : {"#12345", "#ggg", "rgb(1,2,3)", "nice", "#", "0xff0000", "#1234567"}) {
    const auto read = paint_of({{"roof:colour", text(bad)}}, {});
    EXPECT_FALSE(read.paint.roof) << bad;
    ASSERT_EQ(read.warnings.size(), 1U) << bad;
    EXPECT_THAT(read.warnings[0].message, HasSubstr(std::string("roof:colour = \"") + bad + "\""));
  }
}

TEST(Paint, of_a_material_is_its_colour_unless_there_is_one) {
  const auto brick = paint_of({{"building:material", text("brick")}}, {});
  EXPECT_TRUE(brick.paint.wall);
  EXPECT_EQ(brick.paint.wall_material, "brick");
  const auto white = paint_of({{"building:material", text("brick")}, {"building:colour", text("white")}}, {});
  EXPECT_EQ(white.paint.wall, (Colour{255, 255, 255}));
  EXPECT_EQ(white.paint.wall_material, "brick");
  const auto other = paint_of({{"roof:material", text("unobtainium")}}, {});
  EXPECT_FALSE(other.paint.roof);
  EXPECT_EQ(other.paint.roof_material, "unobtainium");
  EXPECT_THAT(other.warnings, IsEmpty());
  EXPECT_TRUE(paint_of({{"height", 5.0}}, {}).paint.empty());
}

TEST(Parts, without_heights_take_those_of_their_outline) {
  const Tags outline{{"building:levels", text("4")},
                     {"roof:shape", text("hipped")},
                     {"building:colour", text("red")},
                     {"min_height", text("2")}};
  const auto bare = form_of(inherited({{"building:part", text("yes")}}, outline, {}), {});
  EXPECT_EQ(bare.form.height, 12);
  EXPECT_EQ(bare.form.base, 2);
  EXPECT_EQ(bare.form.shape, Shape::hipped);
  const auto own = inherited({{"building:part", text("yes")}, {"height", text("7")}}, outline, {});
  EXPECT_EQ(form_of(own, {}).form.height, 7);
  EXPECT_EQ(form_of(own, {}).form.base, 0);
  EXPECT_EQ(form_of(own, {}).form.shape, Shape::flat);
  EXPECT_EQ(paint_of(own, {}).paint.wall, (Colour{255, 0, 0}));
}

TEST(Parts, keep_a_material_of_their_own_from_the_colour_of_their_outline) {
  const auto of =
      inherited({{"building:material", text("glass")}}, {{"building:colour", text("red")}, {"height", 9.0}}, {});
  EXPECT_NE(paint_of(of, {}).paint.wall, (Colour{255, 0, 0}));
  EXPECT_EQ(paint_of(of, {}).paint.wall_material, "glass");
}

TEST(Parts, take_what_options_name) {
  Options options;
  options.building_height_attribute = "h_dak";
  EXPECT_EQ(form_of(inherited({}, {{"h_dak", 7.5}, {"height", 3.0}}, options), options).form.height, 7.5);
}

}  // namespace
}  // namespace mansard::roof::test
