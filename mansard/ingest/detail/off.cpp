#include <string>

#include "mansard/base/text.hpp"
#include "mansard/ingest/detail/mesh_formats.hpp"
#include "mansard/ingest/detail/words.hpp"

namespace mansard::ingest::detail {
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
  const auto vertices = base::to_whole(take_word(line)), faces = base::to_whole(take_word(line));
  if (!vertices || !faces || *vertices < 0 || *faces < 0) return bad("this is not the number of vertices and faces");

  // "0 0 0\n" and "3 0 1 2\n" are the shortest a vertex and a face can be: a wrong count must not cost the memory.
  const auto least = 6.0 * static_cast<double>(*vertices) + 2.0 * static_cast<double>(*faces);
  if (least > static_cast<double>(bytes.size()) + 1)
    return truncated("the " + std::to_string(*vertices) + " vertices and " + std::to_string(*faces) +
                     " faces it promises");

  RawMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(*vertices));
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
    const auto size = base::to_whole(take_word(line));
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

}  // namespace mansard::ingest::detail
