// --texture: the synthetic houses of data/textured.
#include <array>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class Textured : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    fs::copy(fs::path(MANSARD_DATA) / "textured", folder_ / "textured");
  }
  [[nodiscard]] auto inputs(const std::string& mesh = "houses.obj") const -> std::string {
    return at("textured/" + mesh) + " " + at("textured/houses_footprints.geojson") + " --crs local";
  }
  /// ms_texture_known of every building.
  [[nodiscard]] auto known(const std::string& out) const -> std::vector<double> {
    std::vector<double> all;
    const auto file = Json::parse(read(at(out + "/model.city.json")));
    for (const auto& [id, object] : file.at("CityObjects").items())
      if (object.at("type") == "Building" && object.at("attributes").contains("ms_texture_known"))
        all.push_back(object.at("attributes").at("ms_texture_known"));
    return all;
  }
};

TEST_F(Textured, models_have_textures_in_every_format_that_can_have_them) {
  const auto done = run("reconstruct " + inputs() + " -o " + at("out") + " --texture --formats all");
  ASSERT_EQ(done.exit, 0) << done.err;
  EXPECT_THAT(done.err, Not(HasSubstr("warning[texture")));
  for (const char* name : {"out/model_obj_textures/0000.jpg", "out/model_city_json_textures/0000.jpg",
                           "out/model_city_jsonl_textures/0000.jpg"})
    EXPECT_TRUE(fs::exists(at(name))) << name;
  EXPECT_THAT(read(at("out/model.glb")), HasSubstr("\"mimeType\":\"image/jpeg\""));
  EXPECT_THAT(read(at("out/model.mtl")), HasSubstr("map_Kd model_obj_textures/0000.jpg"));
  const auto shares = known("out");
  ASSERT_EQ(shares.size(), 2U);
  for (const double share : shares) EXPECT_GT(share, 0.95);
}

TEST_F(Textured, models_have_none_unless_they_are_asked_for) {
  ASSERT_EQ(run("reconstruct " + inputs() + " -o " + at("out")).exit, 0);
  EXPECT_FALSE(fs::exists(at("out/model_obj_textures")));
  EXPECT_THAT(read(at("out/model.glb")), Not(HasSubstr("image/jpeg")));
  EXPECT_TRUE(known("out").empty());
}

TEST_F(Textured, files_are_the_same_at_any_number_of_threads_and_from_kept_blocks) {
  ASSERT_EQ(run("reconstruct " + inputs() + " -o " + at("one") + " --texture -j 1").exit, 0);
  ASSERT_EQ(run("reconstruct " + inputs() + " -o " + at("four") + " --texture -j 4").exit, 0);
  const auto again = run("reconstruct " + inputs() + " -o " + at("four") + " --texture --overwrite");
  ASSERT_EQ(again.exit, 0);
  EXPECT_THAT(again.err, HasSubstr("2 of 2 blocks were taken over"));
  for (const char* name : {"model.glb", "model.obj", "model.mtl", "model_obj_textures/0000.jpg", "model.city.json"})
    EXPECT_EQ(read(at(std::string("one/") + name)), read(at(std::string("four/") + name))) << name;
}

TEST_F(Textured, another_texel_size_makes_no_block_again) {
  ASSERT_EQ(run("reconstruct " + inputs() + " -o " + at("out")).exit, 0);
  const auto coarse = run("reconstruct " + inputs() + " -o " + at("out") + " --texture --texture-size 0.5 --overwrite");
  ASSERT_EQ(coarse.exit, 0);
  EXPECT_THAT(coarse.err, HasSubstr("2 of 2 blocks were taken over"));
  EXPECT_LT(fs::file_size(at("out/model_obj_textures/0000.jpg")), 60000U);
}

TEST_F(Textured, folders_of_textures_are_replaced_and_removed_but_never_with_files_of_others) {
  ASSERT_EQ(run("reconstruct " + inputs() + " -o " + at("out") + " --texture").exit, 0);
  std::ofstream(at("out/model_obj_textures/notes.txt")) << "mine";
  const auto refused = run("reconstruct " + inputs() + " -o " + at("out") + " --texture --overwrite");
  EXPECT_EQ(refused.exit, 2);
  EXPECT_THAT(refused.err, HasSubstr("error[output-exists]"));
  EXPECT_THAT(refused.err, HasSubstr("model_obj_textures"));
  fs::remove(at("out/model_obj_textures/notes.txt"));
  ASSERT_EQ(run("reconstruct " + inputs() + " -o " + at("out") + " --overwrite").exit, 0);
  EXPECT_FALSE(fs::exists(at("out/model_obj_textures")));
}

TEST_F(Textured, a_missing_picture_is_a_warning_with_its_name) {
  fs::remove(at("textured/l.png"));
  const auto done = run("reconstruct " + inputs() + " -o " + at("out") + " --texture");
  ASSERT_EQ(done.exit, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("warning[texture-missing]"));
  EXPECT_THAT(done.err, HasSubstr("l.png"));
  const auto shares = known("out");
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_LT(std::min(shares[0], shares[1]), 0.05);
}

TEST_F(Textured, a_mesh_without_textures_is_a_warning) {
  const auto done =
      run("reconstruct " + at("house.obj") + " " + at("house.geojson") + " --crs local -o " + at("out") + " --texture");
  EXPECT_THAT(done.err, HasSubstr("warning[texture-none]"));
  EXPECT_TRUE(fs::exists(at("out/model_obj_textures/0000.jpg")));
}

/// A cloud of the two houses with 25 points a square metre of every triangle of their mesh: red, or without a colour.
auto cloud_of_houses(const fs::path& obj, bool coloured) -> std::string {
  std::ifstream in(obj);
  std::vector<std::array<double, 3>> vertices;
  std::string points, line;
  std::size_t count = 0;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      auto& v = vertices.emplace_back();
      words >> v[0] >> v[1] >> v[2];
    }
    if (kind != "f") continue;
    std::array<std::size_t, 3> corner{};
    for (auto& c : corner) {
      std::string word;
      words >> word;
      c = std::stoul(word) - 1;
    }
    for (const auto& [u, v] : {std::pair(0.2, 0.2), std::pair(0.6, 0.2), std::pair(0.2, 0.6)}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = vertices[corner[0]][axis], b = vertices[corner[1]][axis], c = vertices[corner[2]][axis];
        points += std::to_string(a + u * (b - a) + v * (c - a)) + " ";
      }
      points += coloured ? "250 10 10\n" : "\n";
      ++count;
    }
  }
  std::string out = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count);
  for (const char* name : {"x", "y", "z"}) out += std::string("\nproperty double ") + name;
  for (const char* name : {"red", "green", "blue"}) out += coloured ? std::string("\nproperty uchar ") + name : "";
  return out + "\nend_header\n" + points;
}

TEST_F(Textured, a_cloud_with_colours_gives_them_to_the_models) {
  std::ofstream(at("textured/a cloud.ply")) << cloud_of_houses(at("textured/houses.obj"), true);
  const auto done = run("reconstruct '" + at("textured/a cloud.ply") + "' " + at("textured/houses_footprints.geojson") +
                        " --crs local -o " + at("out") + " --texture --picture");
  ASSERT_EQ(done.exit, 0) << done.err;
  EXPECT_THAT(done.err, Not(HasSubstr("warning[texture")));
  const auto shares = known("out");
  ASSERT_EQ(shares.size(), 2U);
  for (const double share : shares) EXPECT_GT(share, 0.9);
  EXPECT_TRUE(fs::exists(at("out/picture.png")));
}

TEST_F(Textured, a_cloud_without_colours_is_a_warning_that_says_so) {
  std::ofstream(at("textured/plain.ply")) << cloud_of_houses(at("textured/houses.obj"), false);
  const auto done = run("reconstruct " + inputs("plain.ply") + " -o " + at("out") + " --texture");
  ASSERT_EQ(done.exit, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("warning[texture-none]"));
  EXPECT_THAT(done.err, HasSubstr("point clouds no colours"));
}

}  // namespace
}  // namespace mansard::cli
