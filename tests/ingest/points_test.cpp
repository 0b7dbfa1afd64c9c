// Points of one class, from all clouds among the inputs.
#include "mansard/ingest/points.hpp"

#include <unistd.h>

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

}  // namespace
}  // namespace mansard::ingest
