// Outlines and their building:parts as one building.
#include <gmock/gmock.h>
#include <filesystem>
#include <fstream>

#include "base/scratch.hpp"
#include "mansard/formats/osm/tags.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::ingest {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A plan, a letter a corner of the box that the letter spans: 10 m a character.
class Drawn {
 public:
  explicit Drawn(std::vector<std::string> rows) : rows_(std::move(rows)) {}

  /// A feature over the box that a letter spans, with these properties as JSON.
  auto with(char letter, const std::string& properties) -> Drawn& {
    std::size_t left = 1000, right = 0, top = 1000, bottom = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r)
      for (std::size_t c = 0; c < rows_[r].size(); ++c)
        if (rows_[r][c] == letter) {
          left = std::min(left, c), right = std::max(right, c);
          top = std::min(top, r), bottom = std::max(bottom, r);
        }
    const auto at = [&](std::size_t c, std::size_t r) {
      return "[" + std::to_string(10 * c) + "," + std::to_string(10 * (rows_.size() - r)) + "]";
    };
    features_ += std::string(features_.empty() ? "" : ",") + R"({"type":"Feature","properties":{"id":")" + letter +
                 "\"," + properties + R"(},"geometry":{"type":"Polygon","coordinates":[[)" + at(left, bottom) + "," +
                 at(right, bottom) + "," + at(right, top) + "," + at(left, top) + "," + at(left, bottom) + "]]}}";
    return *this;
  }
  [[nodiscard]] auto read(const Options& options = {}) const -> model::Scene {
    const mansard::test::Scratch folder;
    const auto path = folder / "osm.geojson";
    std::ofstream(path) << R"({"type":"FeatureCollection","features":[)" << features_ << "]}";
    auto scene = read_footprints(path, options);
    EXPECT_TRUE(scene) << base::to_string(scene.error());
    return scene ? std::move(*scene) : model::Scene();
  }

 private:
  std::vector<std::string> rows_;
  std::string features_;
};

auto ids(const std::vector<model::Footprint>& footprints) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& footprint : footprints) {
    out.push_back(footprint.id);
    for (const auto& part : footprint.parts) out.back() += " " + part.id;
  }
  return out;
}
auto warned(const model::Scene& scene, const char* code) -> std::string {
  for (const auto& warning : scene.warnings)
    if (warning.code == code) return warning.message;
  return {};
}

constexpr const char* building = R"("building":"yes")";
constexpr const char* part = R"("building:part":"yes")";

TEST(BuildingParts, belong_to_the_outline_that_has_most_of_them) {
  const auto scene = Drawn({"a..p..a..b......b", "...............r.r", "a..p..a..b..q...b", "............q....",
                            "p..p........q...q", "...............r.r"})
                         .with('a', building)
                         .with('b', building)
                         .with('p', part)
                         .with('q', part)
                         .read();
  EXPECT_THAT(ids(scene.footprints), ElementsAre("a p", "b", "q"));
  EXPECT_THAT(warned(scene, "ingest-parts"), HasSubstr("1 features tagged building:part are parts of 1 buildings"));
  EXPECT_THAT(warned(scene, "ingest-part-alone"), HasSubstr(": q"));
}

TEST(BuildingParts, within_several_outlines_belong_to_the_smallest) {
  const auto scene = Drawn({"a........a", ".b..b.....", "..pp......", "..pp......", ".b..b.....", "a........a"})
                         .with('a', building)
                         .with('b', building)
                         .with('p', part)
                         .read();
  EXPECT_THAT(ids(scene.footprints), ElementsAre("a", "b p"));
}

TEST(BuildingParts, are_of_the_building_that_a_relation_names) {
  const std::string of_a =
      R"("@relations":[{"role":"part","rel":7,"reltags":{"type":"building"}},{"role":"","rel":8,"reltags":{"type":"site"}}])";
  const std::string outline =
      R"("building":"yes","@relations":[{"role":"outline","rel":7,"reltags":{"type":"building"}}])";
  // The parts p and q are in the outline b, and beside any.
  const auto scene = Drawn({"a..a..b....b", "........pp..", "........pp..", "a..a..b....b.qq", ".............qq"})
                         .with('a', outline)
                         .with('b', building)
                         .with('p', std::string(part) + "," + of_a)
                         .with('q', std::string(part) + "," + of_a)
                         .read();
  EXPECT_THAT(ids(scene.footprints), ElementsAre("a p q", "b"));
}

TEST(BuildingParts, are_no_features_of_other_kinds) {
  const auto scene =
      Drawn({"a....a", ".pp...", ".pp...", "a....a"}).with('a', R"("landuse":"residential")").with('p', part).read();
  EXPECT_THAT(ids(scene.footprints), ElementsAre("a", "p"));
  const auto none =
      Drawn({"a....a", ".pp...", ".pp...", "a....a"}).with('a', building).with('p', R"("building:part":"no")").read();
  EXPECT_THAT(ids(none.footprints), ElementsAre("a", "p"));
  EXPECT_EQ(warned(none, "ingest-parts"), "");
}

TEST(BuildingParts, include_an_outline_that_is_tagged_as_a_part_too) {
  const std::string both = R"("building":"yes","building:part":"yes")";
  const auto scene = Drawn({"a....a", ".pp...", ".pp...", "a....a"}).with('a', both).with('p', part).read();
  EXPECT_THAT(ids(scene.footprints), ElementsAre("a a p"));
  const auto alone = Drawn({"a....a", "......", "a....a"}).with('a', both).read();
  EXPECT_THAT(ids(alone.footprints), ElementsAre("a"));
}

TEST(BuildingParts, go_with_their_outline_through_filters) {
  Drawn drawn({"a....a..b..b", ".pp......q..", ".pp......qq.", "a....a..b..b"});
  drawn.with('a', R"("building":"church")").with('b', building).with('p', part).with('q', part);
  Options options;
  options.where = "building = 'church'";
  const auto church = drawn.read(options);
  EXPECT_THAT(ids(church.footprints), ElementsAre("a p"));
  options.where = "\"building:part\" = 'yes'";
  EXPECT_THAT(ids(drawn.read(options).footprints), ElementsAre("p", "q"));
}

TEST(BuildingParts, are_known_by_the_names_that_drivers_give_their_tags) {
  for (const model::Attributes& tags :
       {model::Attributes{{"building:part", std::string("yes")}}, model::Attributes{{"BUILDING_P", std::string("yes")}},
        model::Attributes{{"building_part", std::string("tower")}},
        model::Attributes{{"other_tags", std::string(R"("height"=>"3","building:part"=>"yes")")}},
        model::Attributes{{"tags", std::string(R"({"building:part": "yes", "height": 3})")}}}) {
    const auto role = formats::role_of(tags);
    EXPECT_TRUE(role.part && !role.outline);
  }
  for (const model::Attributes& tags :
       {model::Attributes{{"building:part", std::string("no")}}, model::Attributes{{"building:part", {}}},
        model::Attributes{{"other_tags", std::string("not hstore")}}, model::Attributes{{"tags", std::string("{")}},
        model::Attributes{{"@relations", std::string("[{]")}}}) {
    EXPECT_FALSE(formats::role_of(tags).part);
    EXPECT_THAT(formats::relations_of(tags), IsEmpty());
  }
}

TEST(BuildingParts, of_openstreetmap_files_are_found_by_their_relation) {
  for (const char* name : {"church.osm", "church.osm.pbf"}) {
    const auto path = fs::path(MANSARD_TEST_DATA) / "fixtures" / name;
    const auto scene = read_footprints(path, {});
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    // Way 104 is a few metres beside the outline, and 105 is far from it.
    EXPECT_THAT(ids(scene->footprints), ElementsAre("way/101 way/102 way/103 way/104", "way/105")) << name;
  }
}

}  // namespace
}  // namespace mansard::ingest
