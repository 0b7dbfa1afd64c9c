// Points of one class, from all clouds among the inputs.
#include "mansard/ingest/points.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>

#include "ingest/workshop.hpp"

namespace mansard::ingest {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t building = 6;

class ReadPointsOfClass : public test::Workshop {
 protected:
  /// What it says to a user who is not root, whom every folder is open to.
  static auto points_for_others(const fs::path& path) -> base::Result<std::vector<geometry::Point3>> {
    constexpr uid_t nobody = 65534;
    const uid_t user = ::geteuid();
    EXPECT_EQ(::seteuid(user == 0 ? nobody : user), 0);
    auto points = read_points_of_class({path}, building, {}, {});
    EXPECT_EQ(::seteuid(user), 0);
    return points;
  }
};

TEST_F(ReadPointsOfClass, passes_over_other_files) {
  file("folder/inside/ground.obj", "v 0 0 0\n");
  file("folder/.hidden.laz", "");
  const auto points = read_points_of_class({at("folder")}, building, {}, {});
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_TRUE(points->empty());
}

TEST_F(ReadPointsOfClass, fails_where_a_folder_cannot_be_listed) {
  file("folder/closed/a.laz", "");
  fs::permissions(at("folder/closed"), fs::perms::none);
  fs::permissions(at(""), static_cast<fs::perms>(0755));
  const auto points = points_for_others(at("folder"));
  fs::permissions(at("folder/closed"), fs::perms::owner_all);
  ASSERT_FALSE(points);
  EXPECT_EQ(points.error().code, "file-read");
  EXPECT_EQ(points.error().subject, at("folder").string());
}

/// Points of 16 to a square metre, text PLY.
auto ply_of(const std::vector<geometry::Point3>& points) -> std::string {
  std::string out = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (const auto& p : points) out += base::to_text(p.x) + " " + base::to_text(p.y) + " " + base::to_text(p.z) + "\n";
  return out;
}

class CloudDensity : public test::Workshop {
 protected:
  /// What is said of the surface of a level cloud of 16 points/m² where `has` holds, within 48 m by 48 m.
  template <class Has>
  [[nodiscard]] auto said_of(Has has) const -> std::string {
    std::vector<geometry::Point3> points;
    for (double y = 0.125; y < 48; y += 0.25)
      for (double x = 0.125; x < 48; x += 0.25)
        if (has(x, y)) points.push_back({x, y, 0});
    const auto scene = mesh(file("cloud.ply", ply_of(points)));
    if (!scene) return scene.error().message;
    for (const auto& warning : scene->warnings)
      if (warning.code == "ingest-points-surface") return warning.message;
    return "nothing";
  }
};

TEST_F(CloudDensity, of_a_few_points_is_said_to_be_too_little_for_a_surface) {
  const auto said = said_of([](double x, double y) { return x < 1 && y < 1; });
  EXPECT_THAT(said, testing::HasSubstr("none of its 16 points"));
  EXPECT_THAT(said, testing::HasSubstr("cloud.isolated"));
}

TEST_F(CloudDensity, of_a_square_is_that_of_its_box) {
  EXPECT_THAT(said_of([](double, double) { return true; }), testing::HasSubstr("(16.2 points/m²)"));
}

TEST_F(CloudDensity, of_a_cloud_that_is_cut_out_along_a_street_is_that_of_the_street) {
  // Three quarters of the box have none: over all of it there are 4.4 points/m², too few for cells of 0.5 m.
  const auto said = said_of([](double x, double y) { return std::abs(x - y) < 7; });
  EXPECT_THAT(said, testing::HasSubstr("cells of 0.5 m"));
}

}  // namespace
}  // namespace mansard::ingest
