// `mansard report` as its users meet it.
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class RunReport : public Command {
 protected:
  void make() {
    auto footprints = geojson(polygon(square));
    const auto id = footprints.find(R"("id":"a")");
    put("house.geojson", footprints.replace(id, 8, R"("id":"<a> & \"b\"")"));
    ASSERT_EQ(run("reconstruct -q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out")).exit, 0);
  }
  auto made() const -> nlohmann::json { return nlohmann::json::parse(read(at("out/run.json"))); }
};

TEST_F(RunReport, is_one_page_with_the_numbers_of_the_run) {
  make();
  const auto outcome = run("report -q " + at("out") + " --date 2026-11-28");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, at("out/report.html") + "\n");
  EXPECT_EQ(outcome.err, "");
  const auto page = read(at("out/report.html"));
  EXPECT_THAT(
      page, AllOf(HasSubstr("<title>Building models of out</title>"), HasSubstr("lang=\"en\""), HasSubstr("2026-11-28"),
                  HasSubstr("1 building: 1 with a full model"), HasSubstr("EPSG:28992"),
                  HasSubstr("&lt;a&gt; &amp; &quot;b&quot;"), HasSubstr("the scan on the left, the model on the right"),
                  HasSubstr("data:image/png;base64,"), HasSubstr("No decisions of people"), Not(HasSubstr("<a>")),
                  Not(HasSubstr("http://")), Not(HasSubstr("<script"))));
  const auto report = made();
  const auto fixed = [](double value, int decimals) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    return std::string(text.data());
  };
  const auto& scores = report["scores"];
  EXPECT_THAT(page, AllOf(HasSubstr(">" + fixed(scores["vertical_mse_m2"], 4) + "<"),
                          HasSubstr(">" + fixed(std::sqrt(scores["footprint_mse_m2"].get<double>()), 3) + "<"),
                          HasSubstr(">" + std::to_string(scores["cells"].get<int>()) + "<"),
                          HasSubstr(report["inputs"][0]["sha256"].get<std::string>())));
  const auto refused = run("report -q " + at("out"));
  EXPECT_EQ(refused.exit, 2);
  EXPECT_THAT(refused.err, HasSubstr("output-exists"));
  const auto again = run("report -q " + at("out") + " --date 2026-11-28 -o " + at("again.html"));
  EXPECT_EQ(again.exit, 0) << again.err;
  EXPECT_EQ(read(at("again.html")), page);
}

TEST_F(RunReport, of_a_run_that_was_moved_has_pictures_without_the_scan) {
  make();
  fs::create_directories(at("elsewhere"));
  fs::rename(at("out"), at("elsewhere/run"));
  fs::remove(at("house.obj"));
  const auto outcome = run("report " + at("elsewhere/run"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("report-scan"), HasSubstr("house.obj")));
  EXPECT_THAT(read(at("elsewhere/run/report.html")),
              AllOf(HasSubstr("The scan is not there any more"), HasSubstr("from two sides: the model\"")));
  put("moved.obj", house);
  EXPECT_EQ(run("report -q --overwrite " + at("elsewhere/run") + " --scan " + at("moved.obj")).exit, 0);
  EXPECT_THAT(read(at("elsewhere/run/report.html")), HasSubstr("the scan on the left"));
  EXPECT_EQ(run("report -q --overwrite --no-scan " + at("elsewhere/run")).exit, 0);
  EXPECT_THAT(read(at("elsewhere/run/report.html")),
              AllOf(HasSubstr("from two sides: the model\""), Not(HasSubstr("not there any more"))));
}

TEST_F(RunReport, tells_what_people_decided_and_what_has_changed) {
  make();
  const auto decisions = [&](const std::string& model) {
    return R"({"type":"mansard-review","version":1,"decisions":[{"building":"<a> & \"b\"","decision":"wrong","note":"",)"
           R"("reviewer":"Ann","time":"2026-11-28T10:00:00Z","model":")" +
           model +
           R"("},{"building":"gone","decision":"right","note":"","reviewer":"","time":"2026-11-28T10:00:00Z",)"
           R"("model":"x"}]})";
  };
  const std::string report = "report -q --overwrite " + at("out");
  EXPECT_EQ(run(report + " --review " + put("review.json", decisions("other"))).exit, 0);
  EXPECT_THAT(read(at("out/report.html")), AllOf(HasSubstr("1 decision has lapsed"),
                                                 HasSubstr("1 decision is on buildings that are not in this run"),
                                                 HasSubstr("decided on 0 of 1 building")));
  ASSERT_EQ(run("compare -q " + at("out") + " " + at("out") + " -o " + at("changes")).exit, 0);
  EXPECT_EQ(run(report + " --changes " + at("changes")).exit, 0);
  EXPECT_THAT(read(at("out/report.html")),
              AllOf(HasSubstr("Compared with " + at("out")), HasSubstr("<th scope=\"row\">unchanged</th>")));
  const auto no_changes = run(report + " --changes " + at("out/run.json"));
  EXPECT_EQ(no_changes.exit, 3);
  EXPECT_THAT(no_changes.err, HasSubstr("report-changes"));
  const auto no_review = run(report + " --review " + at("out/run.json"));
  EXPECT_EQ(no_review.exit, 3);
  EXPECT_THAT(no_review.err, HasSubstr("review-file"));
}

TEST_F(RunReport, of_models_without_a_scan_says_that_nothing_was_measured) {
  ASSERT_EQ(run("extrude -q " + at("house.geojson") + " --default-height 6 -o " + at("out")).exit, 0);
  const auto outcome = run("report " + at("out"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(read(at("out/report.html")),
              AllOf(HasSubstr("made without a scan"), HasSubstr("without a probability: 1"), Not(HasSubstr("± ")),
                    Not(HasSubstr("<img"))));
}

TEST_F(RunReport, names_a_folder_that_has_no_run) {
  fs::create_directories(at("empty"));
  expect_refusal(run("report -q " + at("empty")), 3, "report-run", "run.json");
  expect_refusal(run("report -q " + at("none")), 3, "report-run", "run.json");
  put("empty/run.json", "{}");
  expect_refusal(run("report -q " + at("empty")), 3, "report-run");
  put("empty/run.json", R"({"buildings":[]})");
  expect_refusal(run("report -q " + at("empty")), 3, "report-models", "--formats");
}

}  // namespace
}  // namespace mansard::cli
