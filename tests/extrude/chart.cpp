// Orientation in the plane of a face is exact, wherever the face is.
#include "mansard/extrude/detail/chart.hpp"

#include <gmock/gmock.h>

#include "mansard/base/run.hpp"

namespace {

using namespace mansard;
using namespace mansard::extrude;
using namespace mansard::extrude::detail;

/// A vertical wall and points on it, by their quanta along it and up.
struct Wall {
  Planes planes;
  std::vector<TracePoint> points;
  std::vector<geometry::Point3> places;
  FaceNode node;
  PlaneId plane;

  Wall(const Direction& direction, const Rational& offset)
      : node{model::FaceKind::side, {}, direction, 0}, plane(planes.add(plane_of(direction, offset, 0))) {}

  auto add(const Rational& along, std::int64_t up) -> std::uint32_t {
    // Of the direction turned left, n is the direction turned back: −along.
    const PlaneId across = planes.add(plane_of(node.direction.left(), -along, 0));
    points.push_back({{plane, across, planes.add(moment_plane(up))}, false, 0});
    places.push_back(quantum * planes.nearest(points.back().planes));
    return static_cast<std::uint32_t>(points.size() - 1);
  }
};

// Far from the origin, and near 0 along itself: what is rounded is much larger than what is left.
TEST(Chart, finds_three_points_of_a_far_wall_on_one_line) {
  base::Random random(3);
  for (int i = 0; i < 3000; ++i) {
    const auto below = [&](std::size_t most) { return static_cast<std::int64_t>(random.index(most)); };
    Wall wall(direction_of({below(400'000), static_cast<int>(random.index(4))}), Rational(below(1LL << 34)));
    const std::int64_t start = below(1000), step = 1 + below(3000), rise = 1 + below(3000);
    Rational along(start, 3), by(step, 7);
    along.canonicalize();
    by.canonicalize();
    const auto a = wall.add(along, 5), b = wall.add(along + by, 5 + rise), c = wall.add(along + 2 * by, 5 + 2 * rise);
    const Places places(wall.planes, wall.points, wall.places);
    const Chart chart(places, wall.node);
    EXPECT_EQ(chart.cross_sign(a, b, b, c), 0) << i;
  }
}

TEST(Chart, tells_on_which_side_of_a_line_a_point_of_a_far_wall_is) {
  base::Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const auto below = [&](std::size_t most) { return static_cast<std::int64_t>(random.index(most)); };
    Wall wall(direction_of({below(400'000), static_cast<int>(random.index(4))}), Rational(below(1LL << 34)));
    const std::int64_t step = 1 + below(3000), rise = 1 + below(3000);
    const Rational little(1, mpz_class(1) << 40);
    const auto a = wall.add(0, 5), b = wall.add(Rational(step), 5 + rise);
    const auto right = wall.add(2 * step + little, 5 + 2 * rise), left = wall.add(2 * step - little, 5 + 2 * rise);
    const Places places(wall.planes, wall.points, wall.places);
    const Chart chart(places, wall.node);
    EXPECT_EQ(chart.cross_sign(a, b, b, left), 1) << i;
    EXPECT_EQ(chart.cross_sign(a, b, b, right), -1) << i;
  }
}

}  // namespace
