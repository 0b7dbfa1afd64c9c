// What the server keeps of a mesh on disk and in memory.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "apps/server/mesh_file.hpp"
#include "apps/server/used_last.hpp"

namespace mansard::server {
namespace {

/// A strip of so many triangles.
auto strip(std::uint32_t triangles) -> geometry::Mesh {
  geometry::Mesh mesh;
  for (std::uint32_t v = 0; v < triangles + 2; ++v) mesh.vertices.push_back({0.1 * v, 1.0 * (v % 2), 1e-7 * v});
  for (std::uint32_t t = 0; t < triangles; ++t) mesh.triangles.push_back({t, t + 1, t + 2});
  return mesh;
}

TEST(MeshFile, gives_back_what_was_put_there_to_the_bit) {
  const auto file = MeshFile::open(4);
  ASSERT_TRUE(file);
  const auto large = strip(100'000), small = strip(1);  // the large one is several pieces of the file
  (*file)->put(2, large);
  (*file)->put(0, small);
  (*file)->put(3, {});
  ASSERT_TRUE((*file)->check());
  for (const auto& [number, mesh] : {std::pair{2, large}, {0, small}, {1, geometry::Mesh{}}, {3, geometry::Mesh{}}}) {
    const auto read = (*file)->read(static_cast<std::size_t>(number));
    ASSERT_TRUE(read) << number;
    EXPECT_EQ(read->vertices, mesh.vertices) << number;
    EXPECT_EQ(read->triangles, mesh.triangles) << number;
    EXPECT_EQ((*file)->triangles(static_cast<std::size_t>(number)), mesh.triangles.size());
  }
}

TEST(UsedLast, keeps_those_used_last_within_the_sum_of_their_sizes) {
  UsedLast<int> used(5, 100);
  int made = 0;
  const auto get = [&](std::size_t number, std::size_t size) {
    return used.get(number, size, [&] {
      ++made;
      return std::make_shared<const int>(static_cast<int>(number));
    });
  };
  EXPECT_EQ(*get(0, 40), 0);
  EXPECT_EQ(*get(1, 40), 1);
  EXPECT_EQ(*get(0, 40), 0);
  EXPECT_EQ(made, 2) << "the first is still there";
  EXPECT_EQ(*get(2, 40), 2);  // 1 goes, which was used least recently
  EXPECT_EQ(*get(0, 40), 0);
  EXPECT_EQ(made, 3);
  EXPECT_EQ(*get(1, 40), 1);
  EXPECT_EQ(made, 4);
  EXPECT_EQ(*get(3, 1000), 3) << "larger than the bound: kept alone";
  EXPECT_EQ(*get(3, 1000), 3);
  EXPECT_EQ(made, 5);
  EXPECT_EQ(*get(1, 40), 1);
  EXPECT_EQ(made, 6);
}

TEST(UsedLast, gives_what_somebody_still_uses_and_keeps_no_failure) {
  UsedLast<int> used(2, 10);
  int made = 0;
  const auto get = [&](std::size_t number) {
    return used.get(number, 10, [&] { return std::make_shared<const int>(++made); });
  };
  const auto held = get(0);
  (void)get(1);  // 0 is no longer kept, but still used
  EXPECT_EQ(get(0), held);
  EXPECT_EQ(made, 2);
  UsedLast<int> failing(1, 10);
  EXPECT_EQ(failing.get(0, 1, [] { return std::shared_ptr<const int>(); }), nullptr);
  EXPECT_EQ(*failing.get(0, 1, [] { return std::make_shared<const int>(7); }), 7);
}

TEST(UsedLast, makes_one_for_several_threads) {
  UsedLast<int> used(1, 10);
  std::atomic<int> made{0};
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 100; ++k) (void)used.get(0, 1, [&] { return std::make_shared<const int>(++made); });
    });
  threads.clear();
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace mansard::server
