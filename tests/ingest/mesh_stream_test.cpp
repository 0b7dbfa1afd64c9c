// Mesh files that are read piece by piece: the same mesh, hash and errors as of those that are read whole.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <mutex>
#include <span>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/mesh/append.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"
#include "mansard/formats/mesh/mesh_stream.hpp"
#include "mansard/ingest/detail/spooled_mesh.hpp"

namespace mansard::ingest::test {
namespace {

using formats::RawMesh;

template <class T>
void put(std::string& bytes, T value, bool big = false) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

/// More than one window of a file, so that vertices and faces lie across its end.
constexpr std::uint32_t many = 700'000;

auto place_of(std::uint32_t i) -> geometry::Point3 { return {84000.5 + i % 1000, 447000.25 + i / 1000, i % 17 * 0.5}; }

/// Triangles and a polygon of five corners now and then; some name vertices that do not exist, one has two corners.
template <class Take>
void each_face(Take take) {
  std::array<std::uint32_t, 5> corners{};
  for (std::uint32_t i = 0; i + 5 < many; ++i) {
    const std::size_t count = i == 77 ? 2 : i % 1000 == 0 ? 5 : 3;
    for (std::uint32_t k = 0; k < count; ++k) corners[k] = i + k;
    if (i % 5000 == 3) corners[1] = many + 9;
    take(std::span(corners).first(count));
  }
}

auto binary_ply(bool big, const std::string& list) -> std::string {
  std::string faces;
  std::size_t count = 0;
  each_face([&](std::span<const std::uint32_t> corners) {
    ++count;
    if (list == "uchar") put(faces, static_cast<std::uint8_t>(corners.size()), big);
    else put(faces, static_cast<std::uint16_t>(corners.size()), big);
    for (const auto v : corners) put(faces, v, big);
    put(faces, std::uint8_t{1}, big);
  });
  std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\nelement vertex " +
                    std::to_string(many) +
                    "\nproperty double x\nproperty double y\nproperty uchar grey\nproperty double z\nelement face " +
                    std::to_string(count) + "\nproperty list " + list +
                    " uint vertex_indices\nproperty uchar class\nend_header\n";
  for (std::uint32_t i = 0; i < many; ++i) {
    const auto p = place_of(i);
    put(out, p.x, big);
    put(out, p.y, big);
    put(out, 'g', big);
    put(out, p.z, big);
  }
  return out + faces;
}

auto obj() -> std::string {
  std::string out = "\xef\xbb\xbf# hills\n";
  for (std::uint32_t i = 0; i < many; ++i) {
    const auto p = place_of(i);
    out += "v " + std::to_string(p.x) + (i % 3000 == 1 ? " \\\n " : " ") + std::to_string(p.y) + " " +
           std::to_string(p.z) + "\n";
    // Indices that count back, far behind the beginning of the file.
    if (i % 100'000 == 99'999) out += "f -1 -2 -" + std::to_string(i) + "\nf 1 2 " + std::to_string(many) + "\n";
  }
  each_face([&](std::span<const std::uint32_t> corners) {
    out += "f";
    for (const auto v : corners) out += " " + std::to_string(v + 1);
    out += "\n";
  });
  return out;
}

struct Streamed {
  std::optional<formats::MeshPiece> piece;
  RawMesh mesh;
  std::size_t pieces = 0;
};

auto stream(const std::filesystem::path& path, formats::UpAxis up = formats::UpAxis::automatic) -> Streamed {
  Streamed out;
  out.piece = formats::stream_mesh_file(
      path, up,
      [&](const RawMesh& piece) {
        out.mesh.vertices.insert(out.mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
        out.mesh.triangles.insert(out.mesh.triangles.end(), piece.triangles.begin(), piece.triangles.end());
        out.mesh.short_faces += piece.short_faces;
        ++out.pieces;
      },
      {});
  return out;
}

void expect_same(const std::filesystem::path& path, formats::UpAxis up = formats::UpAxis::automatic) {
  const auto whole = formats::read_mesh_file(path, up);
  const auto streamed = stream(path, up);
  ASSERT_TRUE(streamed.piece);
  ASSERT_FALSE(streamed.piece->failure);
  ASSERT_FALSE(whole.failure);
  EXPECT_GT(streamed.pieces, 2U);
  EXPECT_TRUE(whole.mesh.vertices == streamed.mesh.vertices);
  EXPECT_TRUE(whole.mesh.triangles == streamed.mesh.triangles);
  EXPECT_EQ(whole.mesh.short_faces, streamed.mesh.short_faces);
  EXPECT_EQ(streamed.piece->vertices, whole.mesh.vertices.size());
  EXPECT_EQ(streamed.piece->triangles, whole.mesh.triangles.size());
  ASSERT_EQ(whole.inputs.size(), 1U);
  ASSERT_EQ(streamed.piece->inputs.size(), 1U);
  EXPECT_EQ(whole.inputs[0].path, streamed.piece->inputs[0].path);
  EXPECT_EQ(whole.inputs[0].bytes, streamed.piece->inputs[0].bytes);
  EXPECT_EQ(whole.inputs[0].sha256, streamed.piece->inputs[0].sha256);
}

void expect_same_failure(const std::filesystem::path& path) {
  const auto whole = formats::read_mesh_file(path, formats::UpAxis::automatic);
  const auto streamed = stream(path);
  ASSERT_TRUE(streamed.piece);
  ASSERT_TRUE(whole.failure);
  ASSERT_TRUE(streamed.piece->failure);
  EXPECT_EQ(base::to_string(*whole.failure), base::to_string(*streamed.piece->failure));
}

TEST(MeshStream, is_the_mesh_of_a_ply_that_is_read_whole) {
  const mansard::test::Scratch folder;
  for (const bool big : {false, true})
    for (const std::string list : {"uchar", "ushort"}) {
      ASSERT_TRUE(base::write_file(folder / "hills ü.ply", binary_ply(big, list)));
      expect_same(folder / "hills ü.ply");
    }
  expect_same(folder / "hills ü.ply", formats::UpAxis::y);
}

TEST(MeshStream, is_the_mesh_of_an_obj_that_is_read_whole) {
  const mansard::test::Scratch folder;
  ASSERT_TRUE(base::write_file(folder / "hills.obj", obj()));
  expect_same(folder / "hills.obj");
}

TEST(MeshStream, fails_as_reading_whole_does) {
  const mansard::test::Scratch folder;
  const auto path = folder / "broken.obj";
  const std::string text = obj();
  const auto rewrite = [&](const std::string& bytes, const std::filesystem::path& to) {
    ASSERT_TRUE(base::write_file(to, bytes));
    expect_same_failure(to);
  };
  rewrite(text + "v 1 2\nf 1 2 3\n", path);
  rewrite(text.substr(0, 30'000'000) + "f 1 two 3\n" + text.substr(30'000'000), path);
  rewrite(text + "f 1 2", path);
  rewrite("f 1 two 3\n" + text + std::string(1, '\0'), path);
  rewrite("# nothing\nthat is known\n", path);
  const std::string ply = binary_ply(false, "uchar");
  for (const std::size_t missing : {std::size_t{1}, std::size_t{9}, ply.size() / 2})
    rewrite(ply.substr(0, ply.size() - missing), folder / "broken.ply");
}

TEST(MeshStream, leaves_other_files_to_other_readers) {
  const mansard::test::Scratch folder;
  const std::map<std::string, std::string> files{
      {"text.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
       "z\nend_header\n1 2 3\n"},
      {"mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"empty.obj", ""},
      {"mark.obj", "\xef\xbb\xbf"},
      {"header.ply", "ply\nformat binary_little_endian 1.0\n"}};
  for (const auto& [name, bytes] : files) {
    ASSERT_TRUE(base::write_file(folder / name, bytes));
    EXPECT_FALSE(stream(folder / name).piece) << name;
  }
  EXPECT_FALSE(stream(folder / "missing.obj").piece);
}

TEST(SpooledMesh, gives_every_triangle_once_with_its_own_vertices) {
  auto spooled = detail::SpooledMesh::open();
  ASSERT_TRUE(spooled);
  RawMesh all;
  for (std::uint32_t i = 0; i < many; ++i) all.vertices.push_back(place_of(i));
  // In no order, with triangles that name later vertices and vertices that do not exist.
  for (std::uint64_t i = 0; i < 600'000; ++i) {
    const auto v = static_cast<std::uint32_t>(i * 7919 % (many + 50));
    all.triangles.push_back({v, v + 1, static_cast<std::uint32_t>(i % many)});
  }
  RawMesh faces;
  faces.triangles = all.triangles;
  faces.short_faces = 2;
  (*spooled)->add(faces);  // before the vertices
  RawMesh points;
  points.vertices = all.vertices;
  (*spooled)->add(points);
  EXPECT_EQ((*spooled)->short_faces(), 2U);
  std::mutex mutex;
  std::vector<std::array<geometry::Point3, 3>> expected, found;
  const geometry::Point3 missing{-1, -1, -1};
  const auto corners = [&](const RawMesh& mesh, std::vector<std::array<geometry::Point3, 3>>& out) {
    for (const auto& t : mesh.triangles) {
      auto& own = out.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) own[k] = t[k] < mesh.vertices.size() ? mesh.vertices[t[k]] : missing;
    }
  };
  ASSERT_TRUE((*spooled)->each({}, [&](const RawMesh& piece) {
    const std::scoped_lock lock(mutex);
    corners(piece, found);
  }));
  corners(all, expected);
  std::ranges::sort(expected);
  std::ranges::sort(found);
  EXPECT_TRUE(expected == found);
}

}  // namespace
}  // namespace mansard::ingest::test
