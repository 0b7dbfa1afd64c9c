#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "explore/helpers.hpp"
#include "lab/explore/detail/measure.hpp"
#include "lab/explore/explore.hpp"

namespace mansard::explore {
namespace {

using nlohmann::json;
using test::Xml;
using testing::HasSubstr;
using testing::Not;

class Investigate : public testing::Test {
 protected:
  auto request(Experiment experiment, const std::vector<Axis>& asked = {}) const -> Request {
    Request request;
    request.experiment = experiment;
    request.datasets = {houses_.dataset("houses")};
    request.axes = *axes_of(experiment, asked);
    request.command = {"mansard", "explore", "a & b's <mesh>.obj"};
    request.version = "1.2.3";
    request.pictures = false;
    return request;
  }

  static auto files_of(const Request& request) -> std::map<std::string, std::string> {
    const auto study = investigate(request);
    EXPECT_TRUE(study.has_value()) << study.error().message;
    if (!study) return {};
    const auto files = report(*study);
    return {files.begin(), files.end()};
  }

  test::Houses houses_;
};

/// Without what differs from run to run.
auto without_seconds(const std::string& name, const std::string& bytes) -> std::string {
  if (name == "index.html") return std::regex_replace(bytes, std::regex("<td class=\"seconds\">[0-9.]+</td>"), "");
  if (name == "results.json") return std::regex_replace(bytes, std::regex("\"(optimise_cpu|cpu)\": [0-9.e-]+"), "");
  if (name == "results.csv") return std::regex_replace(bytes, std::regex(",[0-9.e-]+,[0-9.e-]+,\n"), "\n");
  return bytes;
}

TEST_F(Investigate, has_a_row_a_setting_with_the_numbers_of_the_pipeline) {
  const auto study = investigate(request(Experiment::gamma, {{"sweep.gamma", {"1", "40", "4000"}}}));
  ASSERT_TRUE(study.has_value()) << study.error().message;
  ASSERT_EQ(study->rows.size(), 3U);
  const auto dataset = houses_.dataset("");
  const auto scene = ingest::read_scene(dataset.meshes, dataset.footprints, {});
  ASSERT_TRUE(scene.has_value());
  pipeline::Options options;
  options.sweep.gamma = 40;
  const auto again = pipeline::reconstruct(*scene, options);
  ASSERT_TRUE(again.has_value());
  const auto& numbers = study->rows[1].numbers;
  EXPECT_EQ(numbers.sweep_edges, again->blocks[0].sweep_edges);
  EXPECT_EQ(numbers.objective, again->blocks[0].objective);
  EXPECT_EQ(numbers.scores.mse, again->scores.mse);
  EXPECT_EQ(numbers.footprints, 2U);
  EXPECT_EQ(numbers.full + numbers.fallback + numbers.covered + numbers.refused, 2U);
  EXPECT_GT(study->rows[0].numbers.sweep_edges, numbers.sweep_edges);
  EXPECT_EQ(study->rows[2].numbers.sweep_edges, 0U);
}

TEST_F(Investigate, gives_the_same_report_twice_but_for_seconds) {
  for (const auto& asked : {request(Experiment::alpha_beta, {{"segment.alpha", {"1", "40"}}, {"segment.beta", {"60"}}}),
                            request(Experiment::profiles), request(Experiment::table)}) {
    const auto once = files_of(asked), again = files_of(asked);
    ASSERT_EQ(once.size(), 3U);
    for (const auto& [name, bytes] : once) {
      EXPECT_NE(without_seconds(name, bytes), bytes) << name << " has no seconds to leave out";
      EXPECT_EQ(without_seconds(name, bytes), without_seconds(name, again.at(name))) << name;
    }
  }
}

TEST_F(Investigate, writes_a_page_that_is_whole_and_needs_no_network) {
  for (const auto& name : experiment_names()) {
    const auto experiment = *experiment_of(name);
    std::vector<Axis> asked;
    if (experiment == Experiment::grid)
      asked = {{"sweep.gamma", {"10", "40"}}, {"profile.quality", {"simple", "high"}}};
    if (experiment == Experiment::gamma) asked = {{"sweep.gamma", {"10", "40"}}};
    if (experiment == Experiment::alpha_beta) asked = {{"segment.alpha", {"10"}}, {"segment.beta", {"10", "60"}}};
    const auto files = files_of(request(experiment, asked));
    const auto& page = files.at("index.html");
    const Xml html(page);
    EXPECT_EQ(html.error, "") << name;
    for (const auto* outside : {"http:", "https:", "//", "@import", "url("}) EXPECT_THAT(page, Not(HasSubstr(outside)));
    for (const auto& element : html.elements) {
      EXPECT_NE(element.name, "script");
      for (const auto* reference : {"src", "href"})
        if (const auto target = element.get(reference); !target.empty()) {
          EXPECT_TRUE(files.contains(target)) << name << " refers to " << target;
        }
      if (element.name == "svg") {
        EXPECT_NE(element.get("aria-label"), "");
      }
    }
    EXPECT_THAT(html.words_of_all, HasSubstr("mansard explore 'a & b'\\''s <mesh>.obj'")) << name;
    EXPECT_EQ(html.count("svg") > 0, experiment != Experiment::table && experiment != Experiment::datasets) << name;
  }
}

TEST_F(Investigate, writes_pictures_beside_the_page_with_words_for_those_who_cannot_see_them) {
  auto asked = request(Experiment::quality, {{"profile.quality", {"simple"}}});
  asked.pictures = true;
  const auto files = files_of(asked);
  EXPECT_THAT(files.at("run-1-models.png"), testing::StartsWith("\x89PNG"));
  EXPECT_THAT(files.at("run-1-error.png"), testing::StartsWith("\x89PNG"));
  const Xml html(files.at("index.html"));
  std::size_t images = 0;
  for (const auto& element : html.elements) {
    if (element.name != "img") continue;
    ++images;
    EXPECT_TRUE(files.contains(element.get("src")));
    EXPECT_NE(element.get("alt"), "");
  }
  EXPECT_EQ(images, 2U);
}

TEST_F(Investigate, shows_models_plan_and_error_of_every_setting) {
  auto asked = request(Experiment::alpha_beta, {{"segment.alpha", {"40", "80"}}, {"segment.beta", {"60"}}});
  asked.pictures = true;
  const auto files = files_of(asked);
  const Xml html(files.at("index.html"));
  std::vector<std::string> images;
  for (const auto& element : html.elements)
    if (element.name == "img") images.push_back(element.get("src"));
  EXPECT_THAT(images,
              testing::ElementsAre("run-1-models.png", "run-1-error.png", "run-2-models.png", "run-2-error.png"));
  for (const auto& image : images) EXPECT_TRUE(files.contains(image)) << image;
}

TEST_F(Investigate, tells_every_number_as_json_and_as_csv) {
  const auto files = files_of(request(Experiment::gamma, {{"sweep.gamma", {"10", "40"}}}));
  const auto results = json::parse(files.at("results.json"));
  EXPECT_EQ(results["experiment"], "gamma");
  EXPECT_EQ(results["version"], "1.2.3");
  EXPECT_EQ(results["datasets"][0]["inputs"].size(), 2U);
  EXPECT_EQ(results["datasets"][0]["inputs"][0]["sha256"].get<std::string>().size(), 64U);
  ASSERT_EQ(results["runs"].size(), 2U);
  EXPECT_EQ(results["runs"][1]["setting"]["sweep.gamma"], "40");
  EXPECT_THAT(results["runs"][1]["command"].get<std::string>(), HasSubstr("--sweep-gamma 40 -o out"));
  const auto& numbers = results["runs"][1]["numbers"];

  std::istringstream csv(files.at("results.csv"));
  std::string head, first, second;
  std::getline(csv, head);
  std::getline(csv, first);
  std::getline(csv, second);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all;
    std::istringstream in(line + ",");
    for (std::string cell; std::getline(in, cell, ',');) all.push_back(cell);
    return all;
  };
  const auto names = cells(head), values = cells(second);
  ASSERT_EQ(names.size(), values.size());
  std::size_t compared = 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (numbers.contains(names[i])) {
      EXPECT_EQ(std::stod(values[i]), numbers[names[i]].get<double>()) << names[i];
      ++compared;
    }
  EXPECT_EQ(compared + 1, numbers.size());  // and "seconds"
}

TEST_F(Investigate, counts_what_the_profiles_are) {
  const auto results = json::parse(files_of(request(Experiment::profiles)).at("results.json"));
  const auto& profiles = results["runs"][0]["profiles"];
  EXPECT_GT(profiles["profiles"].get<int>(), 3);
  EXPECT_GT(profiles["one_pitch_m"].get<double>(), 40);  // the eaves of both houses are 48 m
  EXPECT_GT(profiles["vertical_m"].get<double>(), 10);   // and there are gables
  EXPECT_NEAR(profiles["vertical_m"].get<double>() + profiles["one_pitch_m"].get<double>() +
                  profiles["more_pitches_m"].get<double>(),
              profiles["edges_m"].get<double>(), 1e-9);
}

TEST_F(Investigate, makes_a_row_of_a_dataset_that_cannot_be_read) {
  auto asked = request(Experiment::gamma, {{"sweep.gamma", {"10", "40"}}});
  auto lost = houses_.dataset("lost");
  lost.footprints = "nowhere <&> \"lost\".geojson";
  asked.datasets.push_back(lost);
  const auto study = investigate(asked);
  ASSERT_TRUE(study.has_value()) << study.error().message;
  ASSERT_EQ(study->rows.size(), 3U);
  EXPECT_FALSE(study->rows[1].failure.has_value());
  ASSERT_TRUE(study->rows[2].failure.has_value());
  for (const auto& [name, bytes] : report(*study)) {
    EXPECT_THAT(bytes, HasSubstr("lost")) << name;
    if (name == "index.html") {
      EXPECT_EQ(Xml(bytes).error, "");
    }
  }
}

TEST_F(Investigate, fails_where_nothing_can_be_read_or_too_many_runs_are_requested) {
  auto lost = request(Experiment::table);
  lost.datasets.front().meshes = {"nowhere.obj"};
  EXPECT_EQ(investigate(lost).error().code, "file-missing");
  auto many = request(Experiment::gamma);
  many.most_runs = 9;
  many.datasets.push_back(houses_.dataset("again"));
  EXPECT_EQ(investigate(many).error().code, "explore-runs");
  auto none = request(Experiment::table);
  none.datasets.clear();
  EXPECT_EQ(investigate(none).error().code, "explore-list");
  auto wrong = request(Experiment::table);
  wrong.datasets.front().options = {{"ingest.nothing", "1"}};
  EXPECT_EQ(investigate(wrong).error().code, "option-unknown");
}

TEST_F(Investigate, stops_when_asked) {
  base::Cancel cancel;
  base::Run run;
  run.cancel = &cancel;
  run.progress = [&](auto, auto, double fraction) {
    if (fraction > 0.4) cancel.request();
  };
  const auto study = investigate(request(Experiment::gamma), run);
  ASSERT_FALSE(study.has_value());
  EXPECT_EQ(study.error().code, "cancelled");
}

/// Two squares side by side in a larger one that is not inside: two faces, eight half-edges around them, two of them
/// between the two.
TEST(ReferenceVariables, follow_the_formula) {
  const std::vector<fracture::Cut> cuts{{{{0, 0}, {20, 0}}, 0},
                                        {{{20, 10}, {0, 10}}, 1},
                                        {{{0, 10}, {0, 0}}, 2},
                                        {{{20, 0}, {20, 10}}, 3},
                                        {{{10, 0}, {10, 10}}, 4}};
  fracture::Options options;
  options.continuation = 0;
  report::SegmentedBlock block;
  geometry::Box2 region;
  region.add({0, 0});
  region.add({20, 10});
  auto arrangement = fracture::arrange(cuts, region, options);
  ASSERT_TRUE(arrangement.has_value());
  block.arrangement = *arrangement;
  EXPECT_EQ(detail::reference_variables(block), 0U);  // nothing was segmented
  segment::Segmentation segmentation;
  std::size_t corners = 0;
  for (std::uint32_t f = 0; f < block.arrangement.faces.size(); ++f) {
    const auto ring = block.arrangement.ring(f);
    geometry::Point2 centre{0, 0};
    for (const auto& p : ring) centre = centre + (1.0 / static_cast<double>(ring.size())) * p;
    const bool inside = centre.x > 0 && centre.x < 20 && centre.y > 0 && centre.y < 10;
    if (inside) corners += ring.size();
    segmentation.faces.push_back({inside, 0, true, 1, std::nullopt});
  }
  segmentation.conflicts = {{0, std::nullopt}, {1, std::nullopt}, {2, std::nullopt}};
  block.segmentation = segmentation;
  ASSERT_EQ(std::ranges::count_if(segmentation.faces, &segment::FaceEvidence::inside), 2);
  ASSERT_EQ(corners, 8U);
  EXPECT_EQ(detail::reference_variables(block), 6U * 2 + 4U * 8 + 6U * 2 + 3U);
}

}  // namespace
}  // namespace mansard::explore
