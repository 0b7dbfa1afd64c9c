#include <string>

#include "mansard/ingest/detail/mesh_formats.hpp"
#include "mansard/ingest/detail/words.hpp"

namespace mansard::ingest::detail {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& name)
      : rest_(bytes), name_(name), whole_(bytes.ends_with('\n')) {}

  auto read() -> base::Result<RawMesh> {
    while (!rest_.empty()) {
      std::string_view line = take_statement();
      const std::string_view keyword = take_word(line);
      if (keyword.empty() || keyword.front() == '#') continue;
      known_ = known_ || is_keyword(keyword);
      if (keyword == "v") {
        if (auto done = take_vertex(line); !done) return done.error();
      } else if (keyword == "f") {
        if (auto done = take_face(line); !done) return done.error();
      }
    }
    if (!known_ && count_ > 0)
      return base::error("ingest-mesh-format", "not an OBJ file: no line starts with v or f; check what it is", name_);
    return std::move(mesh_);
  }

 private:
  static auto is_keyword(std::string_view word) -> bool {
    return word == "v" || word == "f" || word == "vn" || word == "vt" || word == "o" || word == "g" || word == "mtllib";
  }

  /// A line, with the lines a backslash at its end continues it on.
  auto take_statement() -> std::string_view {
    ++count_;
    std::string_view line = take_line(rest_);
    if (!line.ends_with('\\')) return line;
    joined_.clear();
    while (line.ends_with('\\') && !rest_.empty()) {
      joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
      line = take_line(rest_);
      ++count_;
    }
    joined_.append(line.ends_with('\\') ? line.substr(0, line.size() - 1) : line);
    return joined_;
  }

  auto bad(const std::string& what) const -> base::Diagnostic {
    if (rest_.empty() && !whole_)
      return base::error("ingest-mesh-truncated",
                         "the file breaks off in line " + std::to_string(count_) + "; copy or export it again", name_);
    return base::error("ingest-mesh-format", "line " + std::to_string(count_) + ": " + what + "; export the mesh again",
                       name_);
  }

  auto take_vertex(std::string_view line) -> base::Result<void> {
    const auto x = to_coordinate(take_word(line)), y = to_coordinate(take_word(line)),
               z = to_coordinate(take_word(line));
    if (!x || !y || !z) return bad("a vertex needs three numbers");
    mesh_.vertices.push_back({*x, *y, *z});
    return {};
  }

  auto take_face(std::string_view line) -> base::Result<void> {
    corners_.clear();
    for (std::string_view word = take_word(line); !word.empty() && word.front() != '#'; word = take_word(line)) {
      const auto corner = to_corner(word);
      if (!corner) return bad("'" + std::string(word) + "' is not the index of a corner");
      // From 1 upwards, or from −1 backwards among the vertices so far; 0 names none.
      const auto so_far = static_cast<std::int64_t>(mesh_.vertices.size());
      corners_.push_back(to_index(*corner > 0 ? *corner - 1 : *corner < 0 ? so_far + *corner : -1));
    }
    if (corners_.size() < 3 && rest_.empty() && !whole_) return bad("");
    add_face(mesh_, corners_);
    return {};
  }

  std::string_view rest_;
  const std::string& name_;
  bool whole_;  // whether the last line has its end
  std::size_t count_ = 0;
  bool known_ = false;
  RawMesh mesh_;
  std::vector<std::uint32_t> corners_;
  std::string joined_;
};

}  // namespace

auto read_obj(std::string_view bytes, const std::string& name) -> base::Result<RawMesh> {
  if (bytes.find('\0') != bytes.npos)
    return base::error("ingest-mesh-format", "not an OBJ file: it holds binary data; check what it is", name);
  return ObjReader(bytes, name).read();
}

}  // namespace mansard::ingest::detail
