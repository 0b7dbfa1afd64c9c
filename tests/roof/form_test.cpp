// Attributes as files have them.
#include "roof/houses.hpp"

#include "mansard/base/text.hpp"

namespace mansard::roof::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Tags = model::Attributes;

auto text(const char* value) -> model::Value { return std::string(value); }

auto height_of(const char* value) -> std::optional<double> {
  const auto read = form_of({{"height", text(value)}}, {});
  if (read.form.source != Source::height) return std::nullopt;
  return read.form.height;
}

TEST(Values, of_heights_are_read_as_mappers_write_them) {
  const std::vector<std::pair<const char*, double>> table{{"12", 12},
                                                          {"12.5", 12.5},
                                                          {"12 m", 12},
                                                          {"12m", 12},
                                                          {" 12.5 metres ", 12.5},
                                                          {"12,5", 12.5},
                                                          {"+3", 3},
                                                          {"1250 cm", 12.5},
                                                          {"0.1 km", 100},
                                                          {"40 ft", 12.192},
                                                          {"39'4\"", 11.9888},
                                                          {"39' 4\"", 11.9888},
                                                          {"39'", 11.8872},
                                                          {"39 ft 4 in", 11.9888},
                                                          {"39′4″", 11.9888},
                                                          {"472\"", 11.9888},
                                                          {"3;4", 4},
                                                          {"10 m; 12 m", 12}};
  for (const auto& [given, metres] : table) {
    const auto height = height_of(given);
    ASSERT_TRUE(height) << given;
    EXPECT_NEAR(*height, metres, 1e-9) << given;
  }
}

TEST(Values, that_are_none_are_named_in_a_warning_and_left_out) {
  for (const auto* bad : {"tall", "-3", "0", "12 storeys", "12-15", "~12", "12'-4\"", "1e9", "nan", "inf", "12 13", "m",
                          "3;tall", ";", "99999999999999999999"}) {
    const auto read = form_of({{"name", text("church")}, {"height", text(bad)}}, {});
    EXPECT_EQ(read.form.source, Source::assumed) << bad;
    EXPECT_EQ(read.form.height, 6) << bad;
    ASSERT_EQ(read.warnings.size(), 1U) << bad;
    EXPECT_EQ(read.warnings[0].code, "roof-value");
    EXPECT_THAT(read.warnings[0].message, HasSubstr(std::string("height = \"") + bad + "\"")) << bad;
  }
}

TEST(Values, of_several_take_the_maximum_and_say_so) {
  const auto read = form_of({{"building:levels", text("3;4")}}, {});
  EXPECT_EQ(read.form.height, 12);
  EXPECT_THAT(codes_of(read.warnings), ElementsAre("roof-value"));
}

TEST(Values, of_directions_are_degrees_and_points_of_the_compass) {
  const std::vector<std::pair<const char*, double>> table{
      {"0", 0},   {"90", 90},     {"135°", 135}, {"-90", 270},   {"360", 0},          {"450", 90},        {"N", 0},
      {"ne", 45}, {"ESE", 112.5}, {"SE", 135},   {"south", 180}, {"North-West", 315}, {"south east", 135}};
  for (const auto& [given, degrees] : table) {
    const auto read = form_of({{"roof:shape", text("skillion")}, {"roof:direction", text(given)}}, {});
    ASSERT_TRUE(read.form.direction) << given;
    EXPECT_NEAR(*read.form.direction * 180 / std::numbers::pi, degrees, 1e-9) << given;
  }
  for (const auto* bad : {"down", "clockwise", "NNN", "12 m"}) {
    const auto read = form_of({{"roof:shape", text("skillion")}, {"roof:direction", text(bad)}}, {});
    EXPECT_FALSE(read.form.direction) << bad;
    EXPECT_THAT(codes_of(read.warnings), ElementsAre("roof-value")) << bad;
  }
}

TEST(Shape, is_read_in_all_spellings_and_the_nearest_is_taken_of_others) {
  const std::vector<std::tuple<const char*, Shape, bool>> table{
      {"flat", Shape::flat, true},
      {"gabled", Shape::gabled, true},
      {"Hipped", Shape::hipped, true},
      {"half-hipped", Shape::half_hipped, true},
      {"half_hipped", Shape::half_hipped, true},
      {"mansard", Shape::mansard, true},
      {"gambrel", Shape::gambrel, true},
      {"pyramidal", Shape::pyramidal, true},
      {"skillion", Shape::skillion, true},
      {"lean_to", Shape::skillion, true},
      {"dome", Shape::dome, true},
      {"spherical", Shape::dome, true},
      {"onion", Shape::onion, true},
      {"round", Shape::round, true},
      {"cone", Shape::cone, true},
      {"saltbox", Shape::saltbox, true},
      {"sawtooth", Shape::sawtooth, true},
      {"butterfly", Shape::butterfly, true},
      {"side_hipped", Shape::side_hipped, true},
      {"side_half-hipped", Shape::side_half_hipped, true},
      {"hipped-and-gabled", Shape::hipped_and_gabled, true},
      {"bellcast_gable", Shape::bellcast_gable, true},
      {"gabled_height_moved", Shape::gabled_height_moved, true},
      {"crosspitched", Shape::gabled, false},
      {"many", Shape::flat, false},
      {"quadruple_saltbox", Shape::mansard, false},
      {"wavy", Shape::hipped, false}};
  Options options;
  options.shape = Shape::hipped;
  for (const auto& [given, shape, exact] : table) {
    const auto read = form_of({{"roof:shape", text(given)}}, options);
    EXPECT_EQ(read.form.shape, shape) << given;
    EXPECT_EQ(read.warnings.empty(), exact) << given;
    if (!exact) {
      EXPECT_THAT(read.warnings[0].message, HasSubstr(given));
    }
  }
  EXPECT_EQ(form_of({}, options).form.shape, Shape::hipped);
  EXPECT_EQ(form_of({}, {}).form.shape, Shape::flat);
}

TEST(Attributes, are_found_under_the_names_that_drivers_give_them) {
  const std::vector<Tags> same{
      {{"building:levels", text("3")}, {"roof:shape", text("gabled")}, {"roof:height", text("2")}},
      {{"building_levels", std::int64_t{3}}, {"roof_shape", text("gabled")}, {"roof_height", 2.0}},
      {{"BUILDING_L", std::int64_t{3}}, {"ROOF_SHAPE", text("gabled")}, {"ROOF_HEIGH", 2.0}},
      {{"building:l", 3.0}, {"roof:shape", text("gabled")}, {"roof:heigh", text("2 m")}},
      {{"num_floors", std::int64_t{3}}, {"roof_shape", text("gabled")}, {"roof_height", 2.0}},
      {{"other_tags",
        text(R"("building:levels"=>"3","roof:shape"=>"gabled", "roof:height"=>"2","name"=>"a \"b\", c")")}},
      {{"tags", text(R"({"building:levels": 3, "roof:shape": "gabled", "roof:height":"2"})")}},
      {{"building:levels", {}},
       {"roof_shape", text(" ")},
       {"other_tags", text(R"("building:levels"=>"3","roof:shape"=>"gabled","roof:height"=>"2")")}}};
  for (std::size_t i = 0; i < same.size(); ++i) {
    const auto [form, warnings] = form_of(same[i], {});
    EXPECT_THAT(warnings, IsEmpty()) << i;
    EXPECT_EQ(form.shape, Shape::gabled) << i;
    EXPECT_EQ(form.source, Source::levels) << i;
    EXPECT_EQ(form.height, 9) << i;
    EXPECT_FALSE(form.roof_included) << i;
    EXPECT_EQ(form.rise, 2) << i;
  }
}

TEST(Attributes, are_the_ones_that_options_name) {
  Options options;
  options.building_height_attribute = "h_dak";
  options.shape_attribute = "dakvorm";
  options.ground_attribute = "maaiveld";
  const auto read =
      form_of({{"height", 50.0}, {"H_DAK", 7.5}, {"dakvorm", text("hipped")}, {"maaiveld", -1.25}}, options);
  EXPECT_EQ(read.form.height, 7.5);
  EXPECT_EQ(read.form.shape, Shape::hipped);
  EXPECT_EQ(read.form.ground, -1.25);
  EXPECT_TRUE(check_attributes({{"h_dak", {}}, {"Dakvorm", {}}, {"maaiveld", {}}}, options));
  EXPECT_TRUE(check_attributes({{"name", {}}, {"other_tags", {}}}, options));
  const auto missing = check_attributes({{"h_dak", {}}, {"dak_vorm", {}}, {"maaiveld", {}}}, options);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, "roof-attribute");
  EXPECT_THAT(missing.error().message, testing::AllOf(HasSubstr("'dakvorm'"), HasSubstr("did you mean 'dak_vorm'")));
}

TEST(Heights, come_from_height_then_levels_then_the_default) {
  Options options;
  options.level_height = 3.5;
  options.default_height = 11;
  EXPECT_EQ(form_of({{"height", 20.0}, {"building:levels", std::int64_t{4}}}, options).form.height, 20);
  EXPECT_EQ(form_of({{"building:levels", std::int64_t{4}}}, options).form.height, 14);
  EXPECT_EQ(form_of({}, options).form.height, 11);
  const auto bad = form_of({{"height", text("tall")}, {"building:levels", std::int64_t{4}}}, options);
  EXPECT_EQ(bad.form.height, 14);
  EXPECT_EQ(bad.warnings.size(), 1U);
}

TEST(Heights, of_bases_and_roofs_come_from_heights_then_levels) {
  const auto with = [](const Tags& more) {
    Tags all{{"roof:shape", text("gabled")}, {"height", 12.0}};
    for (const auto& tag : more) all.push_back(tag);
    return form_of(all, {});
  };
  EXPECT_EQ(with({{"min_height", text("4 m")}}).form.base, 4);
  EXPECT_EQ(with({{"building:min_level", std::int64_t{2}}}).form.base, 6);
  EXPECT_EQ(with({{"roof:height", text("10'")}}).form.rise, 3.048);
  EXPECT_EQ(with({{"roof:levels", std::int64_t{2}}}).form.rise, 6);
  EXPECT_FALSE(with({{"roof:levels", std::int64_t{0}}}).form.rise);
  EXPECT_NEAR(with({{"roof:angle", text("45")}}).form.angle.value_or(0), std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(with({{"roof:orientation", text("across")}}).form.orientation, Orientation::across);
}

TEST(Heights, of_bases_in_levels_are_those_of_the_levels_that_height_gives) {
  const Tags upper{{"height", 5.0},
                   {"building:levels", std::int64_t{1}},
                   {"building:min_level", std::int64_t{1}},
                   {"roof:shape", text("gabled")},
                   {"roof:height", text("2.2")}};
  const auto read = form_of(upper, {});
  EXPECT_NEAR(read.form.base, 2.8, 1e-9);
  EXPECT_NEAR(read.form.rise.value_or(0), 2.2, 1e-9);
  EXPECT_THAT(read.warnings, IsEmpty());
  EXPECT_EQ(form_of({{"building:levels", std::int64_t{4}}, {"building:min_level", std::int64_t{2}}}, {}).form.base, 6);
}

TEST(Heights, that_contradict_each_other_are_left_out_with_a_warning) {
  const auto high = form_of({{"roof:shape", text("gabled")}, {"height", 6.0}, {"roof:height", text("9")}}, {});
  EXPECT_FALSE(high.form.rise);
  ASSERT_THAT(codes_of(high.warnings), ElementsAre("roof-conflict"));
  EXPECT_THAT(high.warnings[0].message, testing::AllOf(HasSubstr("roof:height = \"9\""), HasSubstr("6 m")));
  const auto stilts = form_of({{"height", 6.0}, {"min_height", 6.0}}, {});
  EXPECT_EQ(stilts.form.base, 0);
  EXPECT_THAT(codes_of(stilts.warnings), ElementsAre("roof-conflict"));
  for (const auto& [key, value] :
       {std::pair{"roof:angle", "95"}, std::pair{"roof:angle", "steep"}, std::pair{"roof:orientation", "diagonal"},
        std::pair{"roof:height", "-1"}, std::pair{"min_height", "-2"}, std::pair{"roof:levels", "attic"}}) {
    const auto read = form_of({{"roof:shape", text("gabled")}, {"height", 6.0}, {key, text(value)}}, {});
    ASSERT_THAT(codes_of(read.warnings), ElementsAre("roof-value")) << key;
    EXPECT_THAT(read.warnings[0].message, testing::AllOf(HasSubstr(key), HasSubstr(value)));
  }
}

TEST(Heights, of_no_levels_are_a_roof_on_the_ground) {
  const auto hut = form_of(
      {{"building:levels", std::int64_t{0}}, {"roof:shape", text("gabled")}, {"roof:levels", std::int64_t{1}}}, {});
  EXPECT_EQ(hut.form.height, 0);
  const auto house = built(box(6, 4), hut.form);
  EXPECT_NEAR(house.volume, 24 * 1.5, 0.01);
  const auto flat = form_of({{"building:levels", std::int64_t{0}}}, {});
  EXPECT_EQ(flat.form.source, Source::assumed);
  EXPECT_EQ(flat.warnings.size(), 1U);
}

TEST(Codes, of_this_module_are_all_listed) {
  std::vector<std::string> listed;
  for (const auto& code : codes()) listed.push_back(code.code);
  for (const auto* used : {"roof-value", "roof-conflict", "roof-shape-unknown", "roof-shape-here", "roof-height",
                           "roof-orientation", "roof-corner-cut", "roof-form", "roof-profile"})
    EXPECT_THAT(listed, testing::Contains(used));
}

}  // namespace
}  // namespace mansard::roof::test
