// Decisions of people on models in a project: kept, lapsed, merged, written into exports, and what they are shown.
#include "apps/server/review_place.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;

/// Rectangles that are level: x from, x to, y from, y to, z.
auto level(const std::vector<std::array<double, 5>>& rectangles) -> rays::Scene {
  geometry::Mesh mesh;
  for (const auto& [x0, x1, y0, y1, z] : rectangles) {
    const auto from = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
    mesh.triangles.push_back({from, from + 1, from + 2});
    mesh.triangles.push_back({from, from + 2, from + 3});
  }
  return rays::Scene(std::move(mesh));
}

TEST(ReviewPlace, is_where_the_main_reason_for_doubt_is) {
  const std::vector<geometry::Polygon> footprint{{{{0, 0}, {10, 0}, {10, 8}, {0, 8}}, {}}};
  const std::vector<geometry::Polygon> neighbour{{{{-9, 0}, {0, 0}, {0, 8}, {-9, 8}}, {}}};
  const evaluate::Options options;
  const auto model = level({{0, 10, 0, 8, 6}});
  const auto place = [&](const rays::Scene& scan, const char* reason) {
    return place_of(reason, {model, scan, footprint, neighbour, 0, options});
  };
  // A chimney of 2 × 2 m that is 2 m higher.
  const auto roof = place(level({{-20, 20, -20, 20, 6}, {3, 5, 3, 5, 8}}), "");
  ASSERT_TRUE(roof);
  EXPECT_EQ(roof->what, Doubted::roof);
  EXPECT_NEAR(roof->at.x, 4, 0.75);
  EXPECT_NEAR(roof->at.y, 4, 0.75);
  EXPECT_NEAR(roof->at.z, 8, 1e-9);
  EXPECT_NEAR(*roof->difference, -2, 1e-9);
  // The building goes on to the east; what is as high on the footprint of the neighbour in the west is no reason.
  const auto larger = level({{-20, 0, -20, 20, 9}, {0, 13, 0, 8, 6}});
  const auto outside = place(larger, "confidence-beside");
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->what, Doubted::outside);
  EXPECT_TRUE(outside->at.x > 10.4 && outside->at.x < 11.3) << outside->at.x;
  EXPECT_NEAR(*outside->difference, -6, 1e-9);
  // It ends a metre before the outline in the north.
  const auto inside = place(level({{0, 10, 0, 6.9, 6}, {0, 10, 6.9, 8, 0}}), "confidence-rim");
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->what, Doubted::inside);
  EXPECT_GT(inside->at.y, 6.9);
  EXPECT_NEAR(*inside->difference, 6, 1e-9);
  // The scan does not cover the east.
  const auto unseen = place(level({{0, 7, 0, 8, 6}}), "confidence-unseen");
  ASSERT_TRUE(unseen);
  EXPECT_EQ(unseen->what, Doubted::unseen);
  EXPECT_NEAR(unseen->at.x, 8.5, 0.3);
  EXPECT_FALSE(unseen->difference);
  EXPECT_FALSE(place(level({{100, 101, 0, 1, 6}}), ""));
  // A tower is 0.6 m farther east in the scan: the place is at one of its walls, and not on a roof away from walls.
  const auto tower = level({{0, 10, 0, 8, 6}, {4, 6, 2, 6, 20}});
  const auto displaced = level({{0, 10, 0, 8, 6}, {4.6, 6.6, 2, 6, 20}, {0, 1, 0, 8, 6.5}});
  const auto wall = place_of("confidence-walls", {tower, displaced, footprint, neighbour, 0, options});
  ASSERT_TRUE(wall);
  EXPECT_TRUE(std::abs(wall->at.x - 4.3) < 0.6 || std::abs(wall->at.x - 6.3) < 0.6) << wall->at.x;
  const auto elsewhere = place_of("confidence-form", {tower, displaced, footprint, neighbour, 0, options});
  ASSERT_TRUE(elsewhere);
  EXPECT_LT(elsewhere->at.x, 2) << "0.5 m higher in the scan, in the west";
}

/// A gabled house of 12 × 8 m, eaves at 5 m and the ridge at 8 m, in a field.
class House : public testing::Test {
 protected:
  void SetUp() override {
    write(folder_ / "house.obj",
          "v -20 -20 0\nv 40 -20 0\nv 40 40 0\nv -20 40 0\nv 0 0 0\nv 12 0 0\nv 12 8 0\nv 0 8 0\nv 0 0 5\nv 12 0 5\n"
          "v 12 8 5\nv 0 8 5\nv 0 4 8\nv 12 4 8\nf 1 2 3 4\nf 5 6 10 9\nf 6 7 11 14 10\nf 7 8 12 11\nf 8 5 9 13 12\n"
          "f 9 10 14 13\nf 11 12 13 14\n");
    write(folder_ / "house.geojson",
          R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)"
          R"({"type":"Feature","properties":{"id":"a","street":"Lange Geer"},"geometry":{"type":"Polygon",)"
          R"("coordinates":[[[0,0],[12,0],[12,8],[0,8],[0,0]]]}}]})");
    start();
    ASSERT_EQ(server_
                  ->post("/api/project/inputs", {{"meshes", {(folder_ / "house.obj").string()}},
                                                 {"footprints", (folder_ / "house.geojson").string()}})
                  .status,
              200);
    server_->settle();
    ASSERT_EQ(server_->reconstruct(), "run-1");
  }
  void start() {
    server_ = std::make_unique<Running>(folder_ / "project", std::vector<std::string>{"--reviewer", "Ann"});
  }
  [[nodiscard]] auto building(const std::string& run = "run-1") const -> Json {
    return server_->buildings(run)["buildings"][0];
  }
  [[nodiscard]] auto decide(const Json& verdict, const std::string& note = "") const -> Reply {
    return server_->post(
        "/api/runs/run-1/review",
        {{"building", "a"}, {"revision", building()["revision"]}, {"decision", verdict}, {"note", note}});
  }
  [[nodiscard]] auto review(const std::string& run = "run-1") const -> Json {
    return server_->get("/api/runs/" + run + "/review").json();
  }
  [[nodiscard]] auto attributes() const -> Json {
    return Json::parse(server_->get("/api/runs/run-1/export/model.city.json").text)["CityObjects"]["a"]["attributes"];
  }
  void edit() {
    const auto reply = server_->post("/api/runs/run-1/edits", lift(building(), 1));
    ASSERT_EQ(reply.status, 200) << reply.text;
  }
  [[nodiscard]] auto found(const std::string& words) const -> std::size_t {
    return server_->get("/api/runs/run-1/search?words=" + words).json()["ids"].size();
  }

  Folder folder_;
  std::unique_ptr<Running> server_;
};

TEST_F(House, decisions_are_kept_lapse_with_the_model_and_are_attributes_of_exports) {
  EXPECT_TRUE(review()["decisions"].empty());
  EXPECT_EQ(review()["reviewer"], "Ann");
  EXPECT_FALSE(attributes().contains("ms_review"));
  const auto reply = decide("wrong", "the ridge");
  ASSERT_EQ(reply.status, 200) << reply.text;
  const auto decided = reply.json()["decided"];
  EXPECT_EQ(decided["decision"], "wrong");
  EXPECT_EQ(decided["note"], "the ridge");
  EXPECT_EQ(decided["reviewer"], "Ann");
  EXPECT_EQ(decided["lapsed"], false);

  // A restart, without a chance to save anything.
  server_->kill();
  start();
  server_->settle();
  ASSERT_EQ(review()["decisions"].size(), 1U);
  EXPECT_EQ(review()["decisions"][0], decided);
  EXPECT_EQ(attributes()["ms_review"], "wrong");
  EXPECT_EQ(attributes()["ms_review_note"], "the ridge");
  EXPECT_EQ(attributes()["ms_reviewer"], "Ann");
  EXPECT_EQ(attributes()["ms_review_time"], decided["time"]);
  EXPECT_EQ(attributes()["street"], "Lange Geer");
  EXPECT_EQ(found("ms_review%3Dwrong"), 1U);
  EXPECT_EQ(found("ms_review%3Dright"), 0U);

  // An edit makes it lapse, and its undo makes it hold again.
  edit();
  EXPECT_EQ(review()["decisions"][0]["lapsed"], true);
  EXPECT_FALSE(attributes().contains("ms_review")) << "it is not about this model";
  EXPECT_EQ(found("ms_review%3Dwrong"), 0U);
  ASSERT_EQ(server_->post("/api/runs/run-1/undo", Json::object()).status, 200);
  EXPECT_EQ(review()["decisions"][0]["lapsed"], false);

  // Another run that makes the same model has the decision too; one that makes another does not.
  ASSERT_EQ(server_->reconstruct(), "run-2");
  EXPECT_EQ(review("run-2")["decisions"][0]["lapsed"], false);
  ASSERT_EQ(server_->reconstruct({{"options", {{"profile.cap_clear", "2"}}}}), "run-3");
  EXPECT_EQ(review("run-3")["decisions"][0]["lapsed"], true);
}

TEST_F(House, a_decision_is_taken_back_and_one_about_an_earlier_model_refused) {
  const auto before = building()["revision"];
  ASSERT_EQ(decide("right").status, 200);
  const auto back = decide(nullptr);
  ASSERT_EQ(back.status, 200) << back.text;
  EXPECT_TRUE(back.json()["decided"].is_null());
  EXPECT_TRUE(review()["decisions"].empty());
  edit();
  const auto late = server_->post("/api/runs/run-1/review",
                                  {{"building", "a"}, {"revision", before}, {"decision", "right"}, {"note", ""}});
  EXPECT_EQ(late.status, 409);
  EXPECT_EQ(late.code(), "edit-stale");
  EXPECT_EQ(decide("perhaps").code(), "server-body");
  EXPECT_EQ(server_->post("/api/runs/run-1/review", {{"building", "z"}, {"revision", 0}, {"decision", "right"}}).code(),
            "edit-building");
  EXPECT_TRUE(review()["decisions"].empty());
}

TEST_F(House, the_place_of_the_largest_difference_and_other_models_are_shown) {
  const auto get = [&] { return server_->get("/api/runs/run-1/review/case?building=a").json(); };
  const auto before = get();
  ASSERT_FALSE(before["place"].is_null()) << before.dump();
  EXPECT_EQ(before["place"]["what"], "roof");
  EXPECT_NEAR(before["place"]["difference"].get<double>(), 0, 0.1);
  // None is as good: those that are offered are no worse than a model that counts as right.
  for (const auto& one : before["alternatives"]) EXPECT_LE(one["mse"].get<double>(), 0.5) << one.dump();
  for (const auto& one : before["alternatives"]) EXPECT_NE(one["parts"], building()["parts"]);

  edit();
  const auto after = get();
  EXPECT_EQ(after["revision"], building()["revision"]);
  EXPECT_NEAR(after["place"]["difference"].get<double>(), 1, 0.15);
  const auto at = after["place"]["at"];
  EXPECT_TRUE(at[0] > 0 && at[0] < 12 && at[1] > 0 && at[1] < 8) << at.dump();
  const double up = std::min(at[1].get<double>(), 8 - at[1].get<double>());
  EXPECT_NEAR(at[2].get<double>(), 5 + 0.75 * up, 0.1) << "it is on the scan";
  // Now what the run made and the gable that fits the scan are better than the model, and come first.
  EXPECT_EQ(after["alternatives"].size(), 3U) << after.dump();
  std::vector<std::string> names;
  for (const auto& one : after["alternatives"]) {
    names.push_back(one["what"]);
    if (names.size() > 2) continue;
    EXPECT_LT(one["mse"].get<double>(), 0.3 * building()["mse"].get<double>()) << one.dump();
  }
  EXPECT_THAT(names, testing::Contains("as the run made it"));
  EXPECT_THAT(names, testing::Contains("gable roof"));
  // The fit: eaves at 5 m, the ridge 3 m above.
  for (const auto& one : after["alternatives"]) {
    if (one["what"] != "gable roof") continue;
    EXPECT_EQ(one["roof_faces"], 2);
    double eaves = 0, pitch = 0;
    for (const auto& profile : one["parts"][0]["plan"]["profiles"])
      if (profile.size() > 2) {
        eaves = profile[1][1];
        pitch = (profile[2][1].get<double>() - eaves) / profile[2][0].get<double>();
      }
    EXPECT_NEAR(eaves, 5, 0.05);
    EXPECT_NEAR(pitch, 0.75, 0.02);
    // Taking it is an edit, which makes the place unremarkable.
    const auto taken = server_->post(
        "/api/runs/run-1/edits",
        {{"what", "gable roof"},
         {"changes", Json::array({{{"building", "a"}, {"revision", after["revision"]}, {"parts", one["parts"]}}})}});
    ASSERT_EQ(taken.status, 200) << taken.text;
  }
  EXPECT_NEAR(get()["place"]["difference"].get<double>(), 0, 0.1);
  EXPECT_EQ(server_->get("/api/runs/run-1/review/case?building=z").code(), "edit-building");
}

TEST_F(House, decisions_of_another_person_are_merged) {
  ASSERT_EQ(decide("right").status, 200);
  auto theirs = server_->get("/api/review").json();
  ASSERT_EQ(theirs["decisions"].size(), 1U);
  const auto mine = theirs["decisions"][0];
  theirs["decisions"][0]["decision"] = "wrong";
  theirs["decisions"][0]["time"] = "2199-01-01T00:00:00Z";
  theirs["decisions"][0]["reviewer"] = "Bob";
  auto other = mine;
  other["building"] = "elsewhere";
  theirs["decisions"].push_back(other);
  const auto reply = server_->post("/api/review/merge", theirs);
  ASSERT_EQ(reply.status, 200) << reply.text;
  EXPECT_EQ(reply.json()["added"], 1);
  EXPECT_EQ(reply.json()["replaced"], 1);
  ASSERT_EQ(reply.json()["conflicts"].size(), 1U);
  EXPECT_EQ(reply.json()["conflicts"][0]["kept"]["reviewer"], "Bob");
  ASSERT_EQ(review()["decisions"].size(), 1U) << "those of the run";
  EXPECT_EQ(review()["decisions"][0]["decision"], "wrong");
  EXPECT_EQ(server_->get("/api/review").json()["decisions"].size(), 2U);
  const auto refused = server_->post("/api/review/merge", {{"type", "mansard-project"}});
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(refused.code(), "review-file");
}

TEST_F(House, a_damaged_file_of_decisions_is_named_and_left_as_it_is) {
  ASSERT_EQ(server_->interrupt(), 0);
  write(folder_ / "project/review.json", "{\"type\":\"mansard-review\"");
  Running again(folder_ / "project");
  EXPECT_EQ(again.link(), "");
  EXPECT_THAT(again.complaint(), testing::AllOf(HasSubstr("review-file"), HasSubstr("review.json")));
  EXPECT_EQ(again.wait(), 3);
  EXPECT_EQ(read(folder_ / "project/review.json"), "{\"type\":\"mansard-review\"");
}

}  // namespace
}  // namespace mansard::server
