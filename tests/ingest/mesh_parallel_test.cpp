// Files of many pieces that are read side by side: the same as if they were read from front to back.
#include <gmock/gmock.h>
#include <cstring>

#include "ingest/workshop.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/text_chunks.hpp"
#include "mansard/ingest/detail/clean.hpp"

namespace mansard::ingest::test {
namespace {

using formats::RawMesh;
using geometry::Point3;
using geometry::Triangle;
using ::testing::HasSubstr;

/// Hills of n by n squares, with numbers that need all kinds of reading.
auto hills(std::uint32_t n) -> formats::RawMesh {
  formats::RawMesh mesh;
  base::Random random(3);
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      mesh.vertices.push_back(
          {84000 + 0.25 * i, 447000 + 0.25 * j + random.uniform(-1e-9, 1e-9), random.uniform(-20, 20)});
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const auto at = j * (n + 1) + i;
      mesh.triangles.push_back({at, at + 1, at + n + 2});
      mesh.triangles.push_back({at, at + n + 2, at + n + 1});
    }
  return mesh;
}

auto words(Point3 p) -> std::string {
  return base::to_text(p.x, 2) + " " + base::to_text(p.y) + " " + base::to_text(p.z) + "\n";
}
auto words(const Triangle& t, std::uint32_t from) -> std::string {
  return std::to_string(t[0] + from) + " " + std::to_string(t[1] + from) + " " + std::to_string(t[2] + from) + "\n";
}

auto as_obj(const formats::RawMesh& mesh) -> std::string {
  std::string text = "# hills\n";
  for (const auto p : mesh.vertices) text += "v " + words(p);
  for (const auto& t : mesh.triangles) text += "f " + words(t, 1);
  return text;
}
auto as_off(const formats::RawMesh& mesh) -> std::string {
  std::string text =
      "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n# next\n\n";
  for (const auto p : mesh.vertices) text += words(p);
  for (const auto& t : mesh.triangles) text += "3 " + words(t, 0);
  return text;
}
auto ply_header(const formats::RawMesh& mesh, const std::string& format, const std::string& kind) -> std::string {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) + "\nproperty " +
         kind + " x\nproperty " + kind + " y\nproperty uchar grey\nproperty " + kind + " z\nelement face " +
         std::to_string(mesh.triangles.size()) +
         "\nproperty uchar class\nproperty list uchar int vertex_indices\nend_header\n";
}
auto as_text_ply(const formats::RawMesh& mesh) -> std::string {
  std::string text = ply_header(mesh, "ascii", "double");
  for (const auto p : mesh.vertices)
    text += base::to_text(p.x) + " " + base::to_text(p.y) + " 7 " + base::to_text(p.z) + "\n";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    text += std::to_string(i % 5) + " 3 " + words(mesh.triangles[i], 0);
  return text;
}

template <class T>
void put(std::string& bytes, T value, bool big) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}
auto as_binary_ply(const formats::RawMesh& mesh, bool big) -> std::string {
  std::string bytes = ply_header(mesh, big ? "binary_big_endian" : "binary_little_endian", "double");
  for (const auto p : mesh.vertices) {
    put(bytes, p.x, big);
    put(bytes, p.y, big);
    put(bytes, '\7', big);
    put(bytes, p.z, big);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    put(bytes, static_cast<std::uint8_t>(i % 5), big);
    put(bytes, std::uint8_t{3}, big);
    for (const auto v : mesh.triangles[i]) put(bytes, v, big);
  }
  return bytes;
}

void expect_hills(const base::Result<formats::RawMesh>& read, const formats::RawMesh& hills) {
  ASSERT_TRUE(read) << base::to_string(read.error());
  EXPECT_TRUE(read->vertices == hills.vertices);
  EXPECT_TRUE(read->triangles == hills.triangles);
}
void expect_classes(const base::Result<formats::RawMesh>& read) {
  ASSERT_TRUE(read);
  ASSERT_EQ(read->classes.size(), read->triangles.size());
  for (std::size_t i = 0; i < read->classes.size(); ++i) ASSERT_EQ(read->classes[i], std::min<std::size_t>(i % 5, 3));
}

class ManyPieces : public ::testing::Test {
 protected:
  static inline const formats::RawMesh expected = hills(220);
  static inline const std::string name = "hills";
};

TEST_F(ManyPieces, of_every_format_are_the_same_mesh) {
  const std::string obj = as_obj(expected);
  ASSERT_GT(formats::chunks_of(obj, true).size(), 3U);
  expect_hills(formats::read_obj(obj, name), expected);
  expect_hills(formats::read_off(as_off(expected), name), expected);
  for (const bool big : {false, true}) {
    const auto binary = formats::read_ply(as_binary_ply(expected, big), name);
    expect_hills(binary, expected);
    expect_classes(binary);
  }
  const auto text = formats::read_ply(as_text_ply(expected), name);
  expect_hills(text, expected);
  expect_classes(text);
}

TEST_F(ManyPieces, may_break_their_lines_anywhere) {
  // Two vertices on the first line: nothing is where a line says it is.
  std::string ply = as_text_ply(expected);
  const std::size_t body = ply.find("end_header\n") + 11;
  ply[ply.find('\n', body)] = ' ';
  expect_hills(formats::read_ply(ply, name), expected);
  // A continued line every so often, Windows line ends, blanks and comments.
  std::string obj;
  std::size_t line = 0;
  for (const char c : as_obj(expected)) {
    if (c == '\n') obj += ++line % 3 == 0 ? " # of a line\r" : "";
    if (c == ' ' && line % 7 == 5) obj += " \\\r\n";
    obj += c;
  }
  expect_hills(formats::read_obj(obj, name), expected);
}

TEST_F(ManyPieces, count_negative_indices_back_over_all_before) {
  std::string obj;
  for (const auto p : expected.vertices) obj += "v " + words(p);
  const auto count = static_cast<std::int64_t>(expected.vertices.size());
  for (const auto& t : expected.triangles) {
    obj += "f";
    for (const auto v : t) obj += " " + std::to_string(static_cast<std::int64_t>(v) - count) + "//1";
    obj += "\n";
  }
  expect_hills(formats::read_obj(obj, name), expected);
}

TEST_F(ManyPieces, of_faces_of_any_length_become_fans_in_their_order) {
  formats::RawMesh some = expected;
  some.triangles.resize(3);
  std::string bytes = ply_header(some, "binary_little_endian", "double");
  const std::size_t body = bytes.size();
  bytes = as_binary_ply(some, false);
  bytes.resize(body + some.vertices.size() * 25);
  const auto face = [&](std::initializer_list<std::uint32_t> corners) {
    put(bytes, std::uint8_t{1}, false);
    put(bytes, static_cast<std::uint8_t>(corners.size()), false);
    for (const auto v : corners) put(bytes, v, false);
  };
  face({0, 1, 2, 3, 4});
  face({7, 8});
  face({5, 6, 0xffffffffU});
  const auto read = formats::read_ply(bytes, name);
  ASSERT_TRUE(read) << base::to_string(read.error());
  const std::vector<Triangle> fans{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {5, 6, formats::no_vertex}};
  EXPECT_EQ(read->triangles, fans);
  EXPECT_EQ(read->short_faces, 1U);
  EXPECT_EQ(read->classes, (std::vector<std::uint8_t>{1, 1, 1, 1}));
}

TEST_F(ManyPieces, name_the_line_of_the_first_fault) {
  const auto line_of = [](std::string_view text, std::size_t at) {
    return "line " + std::to_string(1 + std::ranges::count(text.substr(0, at), '\n')) + ":";
  };
  std::string obj = as_obj(expected);
  const std::size_t last = obj.rfind("\nf ", obj.size() - 5000) + 3, early = obj.find("\nv ", obj.size() / 3) + 3;
  obj[last] = 'x';
  const auto late_fault = formats::read_obj(obj, name);
  ASSERT_FALSE(late_fault);
  EXPECT_THAT(late_fault.error().message, HasSubstr(line_of(obj, last)));
  obj[early] = 'y';
  const auto both = formats::read_obj(obj, name);
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().code, "ingest-mesh-format");
  EXPECT_THAT(both.error().message, HasSubstr(line_of(obj, early)));
  obj[obj.size() / 2] = '\0';
  EXPECT_THAT(formats::read_obj(obj, name).error().message, HasSubstr("binary data"));
  const std::string sound = as_obj(expected);
  const auto cut = formats::read_obj(sound.substr(0, sound.rfind(' ')), name);
  ASSERT_FALSE(!cut && cut.error().code != "ingest-mesh-truncated");
  std::string off = as_off(expected);
  const std::size_t bad = off.find("\n3 ", off.size() - 3000) + 3;
  off[bad] = 'x';
  EXPECT_THAT(formats::read_off(off, name).error().message, HasSubstr(line_of(off, bad)));
  const std::string ply = as_text_ply(expected);
  const auto short_ply = formats::read_ply(ply.substr(0, ply.size() - 40), name);
  ASSERT_FALSE(short_ply);
  EXPECT_EQ(short_ply.error().code, "ingest-mesh-truncated");
  const std::string binary = as_binary_ply(expected, false);
  EXPECT_EQ(formats::read_ply(binary.substr(0, binary.size() - 1), name).error().code, "ingest-mesh-truncated");
}

TEST_F(ManyPieces, are_cleaned_alike_at_any_number_of_threads) {
  // Every triangle's corners for itself, some triangles twice or turned, some of no area, some at places that are none.
  base::Random random(11);
  formats::RawMesh soup;
  for (std::size_t i = 0; i < expected.triangles.size(); ++i) {
    Triangle t = expected.triangles[i];
    for (int copies = random.index(20) == 0 ? 2 : 1; copies > 0; --copies, std::swap(t[0], t[1]))
      for (const auto v : t) soup.vertices.push_back(expected.vertices[v]);
    if (random.index(500) == 0) soup.vertices.back() = soup.vertices[soup.vertices.size() - 2];
    if (random.index(500) == 0) soup.vertices.back().z = std::numeric_limits<double>::quiet_NaN();
  }
  for (std::uint32_t v = 0; v < soup.vertices.size(); v += 3) soup.triangles.push_back({v, v + 1, v + 2});
  soup.triangles[9][1] = 0xfffffff0U;
  const auto at_threads = [&](std::size_t threads) {
    base::limit_threads(threads);
    auto clean = detail::clean(soup, {-84000, -447000, 0}, std::nullopt);
    base::limit_threads(0);
    return clean;
  };
  const auto one = at_threads(1), two = at_threads(2), five = at_threads(5);
  for (const auto* other : {&two, &five}) {
    EXPECT_TRUE(one.mesh.vertices == other->mesh.vertices);
    EXPECT_TRUE(one.mesh.triangles == other->mesh.triangles);
    EXPECT_EQ(one.counts.duplicate, other->counts.duplicate);
    EXPECT_EQ(one.counts.flipped_edges, other->counts.flipped_edges);
    EXPECT_EQ(one.counts.boundary_edges, other->counts.boundary_edges);
  }
  EXPECT_EQ(one.counts.out_of_range, 1U);
  EXPECT_GT(one.counts.duplicate, 3000U);
  EXPECT_GT(one.counts.not_finite, 50U);
  EXPECT_GT(one.counts.degenerate, 50U);
  const auto& c = one.counts;
  EXPECT_EQ(c.triangles + c.duplicate + c.not_finite + c.degenerate + c.out_of_range, c.triangles_read);
  // The first of several corners at one place stays, so that vertices keep the order in which triangles first name
  // them.
  EXPECT_LE(one.mesh.vertices.size(), expected.vertices.size());
  EXPECT_EQ(one.mesh.vertices.front(), soup.vertices.front() + (Point3{-84000, -447000, 0}));
}

TEST(PlainNumbers, are_what_the_careful_way_gives) {
  base::Random random(5);
  std::size_t plain = 0;
  for (int i = 0; i < 200000; ++i) {
    std::string text = random.index(2) == 0 ? "-" : "";
    for (std::size_t k = 1 + random.index(9); k > 0; --k) text += static_cast<char>('0' + random.index(10));
    if (random.index(4) != 0) text += ".";
    for (std::size_t k = random.index(11); k > 0 && text.find('.') != text.npos; --k)
      text += static_cast<char>('0' + random.index(10));
    const char* at = text.data();
    double value = 0;
    if (!formats::take_plain_number(at, text.data() + text.size(), value)) continue;
    ++plain;
    const auto careful = formats::to_coordinate(text);
    ASSERT_TRUE(careful.has_value()) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(*careful)) << text;
    ASSERT_EQ(at, text.data() + text.size());
  }
  EXPECT_GT(plain, 100000U);
  for (const std::string text :
       {"", "-", ".", "+1", ".5", "1e3", "nan", "1.#QNAN", "12345678901234567890", "1,5", "0x10"}) {
    const char* at = text.data();
    double value = 0;
    EXPECT_FALSE(formats::take_plain_number(at, text.data() + text.size(), value)) << text;
    EXPECT_EQ(at, text.data()) << text;
  }
}

}  // namespace
}  // namespace mansard::ingest::test
