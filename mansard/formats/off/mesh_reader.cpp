#include <array>
#include <span>
#include <string>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/text_chunks.hpp"

namespace mansard::formats {
namespace {

/// Takes lines until one holds more than blanks and a comment, and cuts its comment off.
auto take_content(std::string_view& rest, std::size_t& count) -> std::string_view {
  while (!rest.empty()) {
    ++count;
    std::string_view line = take_line(rest);
    line = line.substr(0, line.find('#'));
    std::string_view look = line;
    if (!take_word(look).empty()) return line;
  }
  return {};
}

auto is_keyword(std::string_view word) -> bool {
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  return word == "OFF";
}

/// The next word as a coordinate.
auto take_coordinate(std::string_view& line, double& value) -> bool {
  const char *at = line.data(), *end = line.data() + line.size();
  if (take_plain_number(at, end, value)) {
    line.remove_prefix(static_cast<std::size_t>(at - line.data()));
    return true;
  }
  const auto number = to_coordinate(take_word(line));
  value = number.value_or(0);
  return number.has_value();
}

auto add_vertex(std::string_view line, RawMesh& mesh) -> bool {
  geometry::Point3 p;
  if (!take_coordinate(line, p.x) || !take_coordinate(line, p.y) || !take_coordinate(line, p.z)) return false;
  mesh.vertices.push_back(p);
  return true;
}

/// Only faces of plain indices, and of no more corners than have room.
auto add_plain_face(std::string_view line, RawMesh& mesh) -> bool {
  const char *at = line.data(), *end = line.data() + line.size();
  std::uint32_t size = 0;
  std::array<std::uint32_t, 16> corners{};
  if (!take_plain_index(at, end, size) || !is_digit(at[-1]) || size > corners.size()) return false;
  for (std::uint32_t k = 0; k < size; ++k)
    if (!take_plain_index(at, end, corners[k])) return false;
  add_face(mesh, std::span(corners).first(size));
  return true;
}

}  // namespace

auto read_off(std::string_view bytes, const std::string& name) -> base::Result<RawMesh> {
  std::size_t count = 0;
  const auto bad = [&](const std::string& what) {
    return base::error("ingest-mesh-format", "line " + std::to_string(count) + ": " + what + "; export the mesh again",
                       name);
  };
  const auto truncated = [&](const std::string& what) {
    return base::error("ingest-mesh-truncated", "the file ends before " + what + "; copy or export it again", name);
  };

  std::string_view line = take_content(bytes, count);
  std::string_view look = line;
  const std::string_view keyword = take_word(look);
  if (is_keyword(keyword)) {
    std::string_view more = look;
    const std::string_view next = take_word(more);
    if (next == "BINARY") return bad("binary OFF is not read; write it as text");
    line = next.empty() ? take_content(bytes, count) : look;
  } else if (keyword.ends_with("OFF")) {
    return bad("'" + std::string(keyword) + "' has more than three dimensions");
  }
  if (line.empty()) return truncated("its counts");
  const auto vertices = base::to_integer(take_word(line)), faces = base::to_integer(take_word(line));
  if (!vertices || !faces || *vertices < 0 || *faces < 0) return bad("this is not the number of vertices and faces");

  // "0 0 0\n" and "3 0 1 2\n" are the shortest a vertex and a face can be: a wrong count must not cost the memory.
  const auto least = 6.0 * static_cast<double>(*vertices) + 2.0 * static_cast<double>(*faces);
  if (least > static_cast<double>(bytes.size()) + 1)
    return truncated("the " + std::to_string(*vertices) + " vertices and " + std::to_string(*faces) +
                     " faces it promises");

  const auto points = static_cast<std::size_t>(*vertices);
  if (auto side_by_side = read_lines(bytes, points + static_cast<std::size_t>(*faces), '#',
                                     [&](std::string_view text, std::size_t number, RawMesh& piece) {
                                       text = text.substr(0, text.find('#'));
                                       return number < points ? add_vertex(text, piece) : add_plain_face(text, piece);
                                     }))
    return *std::move(side_by_side);

  RawMesh mesh;
  mesh.vertices.reserve(points);
  mesh.triangles.reserve(static_cast<std::size_t>(*faces));
  for (std::int64_t i = 0; i < *vertices; ++i) {
    line = take_content(bytes, count);
    if (line.empty()) return truncated("vertex " + std::to_string(i + 1) + " of " + std::to_string(*vertices));
    const auto x = to_coordinate(take_word(line)), y = to_coordinate(take_word(line)),
               z = to_coordinate(take_word(line));
    if (!x || !y || !z) return bytes.empty() ? truncated("its last vertex") : bad("a vertex needs three numbers");
    mesh.vertices.push_back({*x, *y, *z});
  }
  std::vector<std::uint32_t> corners;
  for (std::int64_t i = 0; i < *faces; ++i) {
    line = take_content(bytes, count);
    if (line.empty()) return truncated("face " + std::to_string(i + 1) + " of " + std::to_string(*faces));
    const auto size = base::to_integer(take_word(line));
    if (!size || *size < 0) return bad("a face starts with the number of its corners");
    corners.clear();
    for (std::int64_t k = 0; k < *size; ++k) {
      const auto corner = to_corner(take_word(line));
      if (!corner) return bytes.empty() ? truncated("its last face") : bad("a face has fewer corners than it says");
      corners.push_back(to_index(*corner));
    }
    add_face(mesh, corners);
  }
  return mesh;
}

}  // namespace mansard::formats
