#include <gmock/gmock.h>
#include <sys/resource.h>
#include <fstream>

#include "ingest/workshop.hpp"
#include "mansard/base/run.hpp"

namespace mansard::ingest::test {
namespace {

using geometry::Triangle;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Ends the process, with 42 for the error there should be.
[[noreturn]] void read_in_little_memory(const fs::path& mesh, const fs::path& footprints) {
  // The address space of this very process (many libraries), and too little beside.
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t limit = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (48U << 20);
  const rlimit both{limit, limit};
  ::setrlimit(RLIMIT_AS, &both);
  const auto scene = read_scene({mesh}, footprints, {});
  std::_Exit(!scene && scene.error().code == "ingest-memory" ? 42 : 1);
}

class MeshFaults : public Workshop {
 protected:
  static constexpr const char* corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
};

TEST_F(MeshFaults, triangles_at_nan_or_infinity_are_dropped_and_counted) {
  const auto scene =
      mesh(file("m.obj", std::string(corners) + "v nan 0 0\nv 0 -inf 0\nv 1.#QNAN 0 0\nv 1e400 0 0\nv 1e30 0 0\n"
                                                "f 1 2 3\nf 1 2 5\nf 1 2 6\nf 1 2 7\nf 1 2 8\nf 1 2 9\n"));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->mesh_counts.not_finite, 5U);
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(scene->mesh.vertices.size(), 3U);
  EXPECT_TRUE(has_warning(*scene, "ingest-mesh-not-finite"));
}

TEST_F(MeshFaults, indices_out_of_range_are_dropped_and_counted) {
  const auto scene =
      mesh(file("m.obj", std::string(corners) + "f 1 2 3\nf 1 2 9\nf 0 1 2\nf -9 1 2\nf 1 2 99999999999999999999\n"));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->mesh_counts.out_of_range, 4U);
  EXPECT_EQ(scene->mesh_counts.triangles, 1U);
  EXPECT_TRUE(has_warning(*scene, "ingest-mesh-index"));
}

TEST_F(MeshFaults, triangles_without_area_are_dropped_and_counted) {
  const auto scene = mesh(file("m.obj", std::string(corners) + "v 2 0 0\nf 1 2 3\nf 1 1 2\nf 1 2 5\nf 1 2\n"));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->mesh_counts.degenerate, 3U);
  EXPECT_EQ(scene->mesh_counts.triangles, 1U);
  EXPECT_TRUE(has_warning(*scene, "ingest-mesh-degenerate"));
}

TEST_F(MeshFaults, repeated_triangles_are_dropped_whichever_way_round) {
  const auto scene = mesh(file("m.obj", std::string(corners) + "v 0 0 -0\nf 1 2 3\nf 2 3 1\nf 5 3 2\nf 2 4 3\n"));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->mesh_counts.duplicate, 2U);
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
  EXPECT_TRUE(has_warning(*scene, "ingest-mesh-duplicate"));
}

TEST_F(MeshFaults, of_a_triangle_given_both_ways_round_the_same_one_is_kept_in_any_order) {
  const auto one = mesh(file("m.obj", std::string(corners) + "f 1 2 3\nf 1 3 2\n"));
  const auto other = mesh(file("n.obj", std::string(corners) + "f 3 2 1\nf 2 3 1\n"));
  ASSERT_TRUE(one && other);
  ASSERT_EQ(one->mesh.triangles.size(), 1U);
  const auto normal = [](const model::Scene& scene) {
    const auto& t = scene.mesh.triangles[0];
    const auto& v = scene.mesh.vertices;
    return cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]);
  };
  EXPECT_EQ(normal(*one), normal(*other));
}

TEST_F(MeshFaults, flipped_neighbours_and_fins_are_kept_and_counted) {
  const auto flipped = mesh(file("m.obj", std::string(corners) + "f 1 2 3\nf 2 3 4\n"));
  ASSERT_TRUE(flipped);
  EXPECT_EQ(flipped->mesh_counts.flipped_edges, 1U);
  EXPECT_EQ(flipped->mesh_counts.boundary_edges, 4U);
  EXPECT_TRUE(has_warning(*flipped, "ingest-mesh-flipped"));
  const auto fin = mesh(file("n.obj", std::string(corners) + "v 0 0 1\nf 1 2 3\nf 2 4 3\nf 2 3 5\n"));
  ASSERT_TRUE(fin);
  EXPECT_EQ(fin->mesh_counts.non_manifold_edges, 1U);
  EXPECT_EQ(fin->mesh_counts.triangles, 3U);
  EXPECT_TRUE(has_warning(*fin, "ingest-mesh-non-manifold"));
}

TEST_F(MeshFaults, a_good_mesh_has_no_warnings_and_corners_of_tiles_are_joined) {
  const auto scene =
      mesh(file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 4 5 6\nv 9 9 9\n"));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->mesh.vertices.size(), 4U);
  EXPECT_EQ(scene->mesh_counts.vertices_read, 7U);
  EXPECT_EQ(scene->mesh_counts.boundary_edges, 4U);
  for (const auto& warning : scene->warnings) EXPECT_THAT(warning.code, Not(HasSubstr("mesh")));
}

TEST_F(MeshFaults, a_mesh_of_which_nothing_is_left_is_an_error) {
  EXPECT_EQ(code(mesh(file("points.obj", corners))), "ingest-mesh-unusable");
  EXPECT_EQ(code(mesh(file("none.off", "OFF\n0 0 0\n"))), "ingest-mesh-unusable");
  EXPECT_EQ(code(mesh(file("nan.obj", "v nan nan nan\nf 1 1 1\n"))), "ingest-mesh-unusable");
  EXPECT_EQ(code(mesh(file("line.obj", std::string(corners) + "f 1 2 1\n"))), "ingest-mesh-unusable");
}

TEST_F(MeshFaults, random_damage_never_crashes) {
  const std::string off = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      std::string(36, '\1') + std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/2 -1\n";
  base::Random random(7);
  std::size_t refused = 0;
  for (int round = 0; round < 300; ++round)
    for (const auto& [name, good] : {std::pair{"m.off", &off}, std::pair{"m.ply", &ply}, std::pair{"m.obj", &obj}}) {
      std::string bytes = *good;
      for (int k = 0; k < 3; ++k) bytes[random.index(bytes.size())] = static_cast<char>(random.index(256));
      if (round % 3 == 0) bytes.resize(random.index(bytes.size()) + 1);
      const auto scene = mesh(file(name, bytes));
      refused += scene ? 0 : 1;
      if (!scene) continue;
      for (const auto& t : scene->mesh.triangles)
        for (const auto v : t) ASSERT_LT(v, scene->mesh.vertices.size());
    }
  EXPECT_GT(refused, 100U);
}

TEST_F(MeshFaults, no_memory_is_an_error_not_a_crash) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's own memory does not fit under a limit";
#endif
  // Thirty megabytes of text are a mesh far larger than what the limit leaves.
  {
    std::ofstream out(at("huge.off"));
    out << "OFF\n3000000 1 0\n";
    for (int i = 0; i < 3000000; ++i) out << "0 0 0 0 0\n";
    out << "3 0 1 2\n";
  }
  const auto path = at("huge.off");
  const auto footprints = polygons({square()});
  EXPECT_EXIT(read_in_little_memory(path, footprints), ::testing::ExitedWithCode(42), "");
}

TEST_F(MeshFaults, a_stop_is_heeded) {
  base::Cancel cancel;
  cancel.request();
  base::Run run;
  run.cancel = &cancel;
  EXPECT_EQ(code(read_scene({ground()}, polygons({square()}), {}, run)), "cancelled");
}

}  // namespace
}  // namespace mansard::ingest::test
