#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/scratch.hpp"
#include "edit/plans.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "pipeline/houses.hpp"

namespace mansard::edit {
namespace {

/// Everything that is exported, by name.
auto files_of(const model::City& city) -> std::map<std::string, std::string> {
  auto obj = formats::obj(city, "model.mtl");
  return {{"model.city.json", *formats::cityjson(city)},
          {"model.obj", obj->obj},
          {"model.mtl", obj->mtl},
          {"model.glb", *formats::glb(city)},
          {"plans.json", formats::plans(city)}};
}

void expect_same_bytes(const model::City& a, const model::City& b) {
  const auto x = files_of(a), y = files_of(b);
  for (const auto& [name, bytes] : x) {
    const auto differs = static_cast<std::size_t>(std::ranges::mismatch(bytes, y.at(name)).in1 - bytes.begin());
    const std::size_t from = differs - std::min<std::size_t>(differs, 60);
    EXPECT_TRUE(bytes == y.at(name)) << name << ": …" << bytes.substr(from, 120) << "… or …"
                                     << y.at(name).substr(from, 120) << "…";
  }
}

template <class T>
auto value(const model::Attributes& attributes, std::string_view name) -> std::optional<T> {
  for (const auto& [key, v] : attributes)
    if (key == name)
      if (const auto* found = std::get_if<T>(&v)) return *found;
  return std::nullopt;
}

struct Town {
  model::Scene scene = mansard::test::terrace();
  pipeline::Options options;
  report::Reconstruction run = *pipeline::reconstruct(scene, options);
  rays::Scene mesh{scene.mesh};
  History history{run.city};

  [[nodiscard]] auto exported() const -> model::City {
    auto city = edited_city(
        run.city, history, [&](auto) { return &mesh; }, options);
    EXPECT_TRUE(city) << base::to_string(city.error());
    return std::move(*city);
  }
  void change(const std::string& building, std::vector<NamedPlan> parts) {
    const auto done = history.apply({"", {{building, history.revision(building), std::move(parts)}}});
    EXPECT_TRUE(done) << base::to_string(done.error());
  }
};

TEST(EditedCity, is_the_city_of_the_run_to_the_byte_without_edits) {
  Town town;
  expect_same_bytes(town.exported(), town.run.city);
  town.change("low", {});
  ASSERT_TRUE(town.history.undo());
  expect_same_bytes(town.exported(), town.run.city);
}

TEST(EditedCity, has_attributes_that_are_true_of_the_new_model) {
  Town town;
  auto parts = *town.history.parts("low");
  const double cap = 4.0;
  parts[0].plan = profile::vertical_plan(model::polygon_of(parts[0].plan), parts[0].plan.base, cap);
  town.run.city.buildings[0].attributes.emplace_back("ms_reasons", "the scan is above the model");
  town.change("low", parts);
  const auto city = town.exported();
  const auto& low = city.buildings[0];
  EXPECT_EQ(value<std::string>(low.attributes, "ms_quality"), "unknown");
  EXPECT_FALSE(value<std::string>(low.attributes, "ms_reasons")) << "they were of the model before";
  const auto& attributes = low.parts[0].attributes;
  const double z0 = static_cast<double>(city.frame.origin[2]);
  EXPECT_EQ(value<bool>(attributes, "ms_edited"), true);
  EXPECT_EQ(value<bool>(low.attributes, "ms_edited"), true);
  EXPECT_NEAR(value<double>(attributes, "ms_h_roof_max").value(), z0 + low.parts[0].plan.base + cap, 1e-3);
  EXPECT_NEAR(value<double>(attributes, "ms_volume_lod22").value(), cap * test::area_of(low.parts[0].plan), 0.1);
  EXPECT_EQ(value<double>(attributes, "ms_volume_lod22"), value<double>(low.attributes, "ms_volume_lod22"));
  EXPECT_NEAR(value<double>(attributes, "ms_rmse_lod22").value(), 6 - cap, 0.2);
  EXPECT_EQ(value<std::string>(attributes, "ms_block"), "block-low");
  EXPECT_EQ(value<std::string>(low.attributes, "ms_outcome"), "full");
  EXPECT_EQ(value<std::string>(low.attributes, "use"), "home");

  // The neighbour was not touched, but less of its wall is shared now.
  const auto &high = city.buildings[1].parts[0], &was = town.run.city.buildings[1].parts[0];
  EXPECT_FALSE(value<bool>(high.attributes, "ms_edited"));
  EXPECT_EQ(value<double>(high.attributes, "ms_area_party_wall"), label::areas(high.model).party_wall);
  EXPECT_LT(label::areas(high.model).party_wall, label::areas(was.model).party_wall - 1);
  EXPECT_EQ(value<double>(high.attributes, "ms_volume_lod22"), value<double>(was.attributes, "ms_volume_lod22"));
}

TEST(EditedCity, comes_back_from_its_plans_to_the_byte) {
  Town town;
  const std::vector<geometry::Point2> line{{-1, 4}, {5, 4.5}, {13, 5}};
  auto parts = split("low", *town.history.parts("low"), "low-1", line);
  ASSERT_TRUE(parts);
  parts->at(1).plan.cap = 3.3;
  town.change("low", *parts);
  town.change("high", {});
  const auto city = town.exported();
  EXPECT_EQ(value<std::string>(city.buildings[0].parts[1].attributes, "ms_block"), "block-low");
  EXPECT_EQ(value<std::string>(city.buildings[1].attributes, "ms_outcome"), "covered");
  EXPECT_FALSE(value<double>(city.buildings[1].attributes, "ms_volume_lod22"));

  const mansard::test::Scratch folder;
  const auto path = folder / "plans.json";
  ASSERT_TRUE(base::write_file(path, formats::plans(city)));
  auto read = formats::read_plans(path);
  ASSERT_TRUE(read) << base::to_string(read.error());
  const auto again = pipeline::raise_plans(std::move(*read), town.options);
  ASSERT_TRUE(again);
  expect_same_bytes(again->city, city);
}

TEST(EditedCity, is_the_same_at_any_thread_count) {
  std::vector<std::map<std::string, std::string>> files;
  for (const std::size_t threads : {1, 2}) {
    base::limit_threads(threads);
    Town town;
    auto parts = *town.history.parts("high");
    parts[0].plan.cap -= 0.7;
    town.change("high", parts);
    files.push_back(files_of(town.exported()));
  }
  base::limit_threads(0);
  EXPECT_EQ(files[0], files[1]);
}

}  // namespace
}  // namespace mansard::edit
