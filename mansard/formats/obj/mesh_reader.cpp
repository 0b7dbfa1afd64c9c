// Pieces of the file are read side by side, each as if it stood alone; what goes wrong is what the first of them says.
#include <algorithm>
#include <optional>
#include <string>

#include "mansard/base/run.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/mesh_stream.hpp"
#include "mansard/formats/mesh/text_chunks.hpp"

namespace mansard::formats {
namespace {

/// What a piece of the file gave.
struct Piece {
  RawMesh mesh;
  std::size_t lines = 0;     ///< up to where it was read
  bool known = false;        ///< some line starts as OBJ's do
  bool counts_back = false;  ///< some index is negative
  bool binary = false;       ///< there is a zero byte in it
  bool truncated = false;    ///< the failure is at the very end of the file
  std::optional<std::string> failure;
};

class ObjReader {
 public:
  /// `first`: vertices before this piece. `at_end`: whether the file ends with it.
  ObjReader(std::string_view bytes, std::size_t first, bool at_end)
      : rest_(bytes), first_(first), breaks_off_(at_end && !bytes.ends_with('\n')) {}

  auto read() -> Piece {
    // So much that few pieces need more; what is not used costs no memory.
    out_.mesh.vertices.reserve(rest_.size() / 24 + 1);
    out_.mesh.triangles.reserve(rest_.size() / 16 + 1);
    while (!rest_.empty() && !out_.failure) {
      std::string_view line = take_statement();
      if (line.size() > 2 && line[0] == 'v' && line[1] == ' ' && took_plain_vertex(line)) continue;
      if (line.size() > 2 && line[0] == 'f' && line[1] == ' ' && took_plain_triangle(line)) continue;
      const std::string_view keyword = take_word(line);
      if (keyword.empty() || keyword.front() == '#') continue;
      out_.known = out_.known || is_keyword(keyword);
      if (keyword == "v") take_vertex(line);
      else if (keyword == "f") take_face(line);
    }
    return std::move(out_);
  }

 private:
  static auto is_keyword(std::string_view word) -> bool {
    return word == "v" || word == "f" || word == "vn" || word == "vt" || word == "o" || word == "g" || word == "mtllib";
  }

  /// A line, with the lines a backslash at its end continues it on.
  auto take_statement() -> std::string_view {
    ++out_.lines;
    std::string_view line = take_line(rest_);
    if (!line.ends_with('\\')) return line;
    joined_.clear();
    while (line.ends_with('\\') && !rest_.empty()) {
      joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
      line = take_line(rest_);
      ++out_.lines;
    }
    joined_.append(line.ends_with('\\') ? line.substr(0, line.size() - 1) : line);
    return joined_;
  }

  void fail(std::string what) {
    out_.truncated = rest_.empty() && breaks_off_;
    out_.failure = std::move(what);
  }

  /// What nearly every vertex is: three plain numbers at the front. Nothing happens where it is not.
  auto took_plain_vertex(std::string_view line) -> bool {
    const char *at = line.data() + 2, *end = line.data() + line.size();
    geometry::Point3 p;
    if (!take_plain_number(at, end, p.x) || !take_plain_number(at, end, p.y) || !take_plain_number(at, end, p.z))
      return false;
    out_.mesh.vertices.push_back(p);
    return out_.known = true;
  }

  /// What nearly every face is: three indices from 1 upwards and no more.
  auto took_plain_triangle(std::string_view line) -> bool {
    const char *at = line.data() + 2, *end = line.data() + line.size();
    geometry::Triangle t;
    for (auto& corner : t)
      if (!take_plain_index(at, end, corner)) return false;
    skip_blanks(at, end);
    if (at != end) return false;
    for (auto& corner : t) corner = corner > 0 ? corner - 1 : no_vertex;
    out_.mesh.triangles.push_back(t);
    return out_.known = true;
  }

  void take_vertex(std::string_view line) {
    const auto x = to_coordinate(take_word(line)), y = to_coordinate(take_word(line)),
               z = to_coordinate(take_word(line));
    if (!x || !y || !z) return fail("a vertex needs three numbers");
    out_.mesh.vertices.push_back({*x, *y, *z});
  }

  void take_face(std::string_view line) {
    corners_.clear();
    for (std::string_view word = take_word(line); !word.empty() && word.front() != '#'; word = take_word(line)) {
      const auto corner = to_corner(word);
      if (!corner) return fail("'" + std::string(word) + "' is not the index of a corner");
      out_.counts_back = out_.counts_back || *corner < 0;
      // From 1 upwards, or from −1 backwards among the vertices so far; 0 names none.
      const auto so_far = static_cast<std::int64_t>(first_ + out_.mesh.vertices.size());
      corners_.push_back(to_index(*corner > 0 ? *corner - 1 : *corner < 0 ? so_far + *corner : -1));
    }
    if (corners_.size() < 3 && rest_.empty() && breaks_off_) return fail("");
    add_face(out_.mesh, corners_);
  }

  std::string_view rest_;
  std::size_t first_;
  bool breaks_off_;  // the file's last line has no end
  Piece out_;
  std::vector<std::uint32_t> corners_;
  std::string joined_;
};

/// `before`: vertices before these bytes. `at_end`: whether the file ends with them.
auto read_pieces(std::string_view bytes, std::size_t before, bool at_end) -> std::vector<Piece> {
  const auto chunks = chunks_of(bytes, true);
  std::vector<Piece> pieces(chunks.size());
  const auto read = [&](std::size_t i, std::size_t first) {
    pieces[i] = ObjReader(chunks[i], first, at_end && i + 1 == chunks.size()).read();
    pieces[i].binary = chunks[i].find('\0') != std::string_view::npos;
  };
  base::parallel_for(chunks.size(), [&](std::size_t i) { read(i, before); });
  // Where indices count back, the number of vertices before the piece is needed: only now is it known.
  std::vector<std::size_t> first(pieces.size(), before);
  for (std::size_t i = 1; i < pieces.size(); ++i) first[i] = first[i - 1] + pieces[i - 1].mesh.vertices.size();
  base::parallel_for(chunks.size(), [&](std::size_t i) {
    if (pieces[i].counts_back && i > 0) read(i, first[i]);
  });
  return pieces;
}

/// What all pieces of a file say of it.
class Verdict {
 public:
  /// In the order of the file. False for what is behind the first failure.
  auto take(const Piece& piece) -> bool {
    binary_ = binary_ || piece.binary;
    if (failure_) return false;
    lines_ += piece.lines;
    known_ = known_ || piece.known;
    failure_ = piece.failure;
    truncated_ = piece.truncated;
    return !failure_;
  }

  [[nodiscard]] auto of(const std::string& name) const -> base::Result<void> {
    // First of all, wherever it is: what lines of binary data seem to lack helps nobody.
    if (binary_)
      return base::error("ingest-mesh-format", "not an OBJ file: it holds binary data; check what it is", name);
    if (failure_ && truncated_)
      return base::error("ingest-mesh-truncated",
                         "the file breaks off in line " + std::to_string(lines_) + "; copy or export it again", name);
    if (failure_)
      return base::error("ingest-mesh-format",
                         "line " + std::to_string(lines_) + ": " + *failure_ + "; export the mesh again", name);
    if (!known_ && lines_ > 0)
      return base::error("ingest-mesh-format", "not an OBJ file: no line starts with v or f; check what it is", name);
    return {};
  }

 private:
  std::size_t lines_ = 0;
  bool known_ = false, binary_ = false, truncated_ = false;
  std::optional<std::string> failure_;
};

/// The text up to the last line end that ends a statement; empty where there is none.
auto whole_statements(std::string_view text) -> std::string_view {
  for (std::size_t end = text.rfind('\n'); end != text.npos; end = end == 0 ? text.npos : text.rfind('\n', end - 1)) {
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!line.ends_with('\\')) return text.substr(0, end + 1);
  }
  return {};
}

}  // namespace

auto read_obj(std::string_view bytes, const std::string& name) -> base::Result<RawMesh> {
  auto pieces = read_pieces(bytes, 0, true);
  Verdict verdict;
  for (const auto& piece : pieces) (void)verdict.take(piece);
  if (auto sound = verdict.of(name); !sound) return sound.failure();
  std::vector<RawMesh> meshes;
  meshes.reserve(pieces.size());
  for (auto& piece : pieces) meshes.push_back(std::move(piece.mesh));
  return join(meshes);
}

auto stream_obj(FileWindow& file, const std::string& name, const TakePiece& take, const base::Run& run)
    -> base::Result<void> {
  Verdict verdict;
  std::size_t vertices = 0, wanted = FileWindow::usual;
  for (;;) {
    if (auto filled = file.fill(wanted); !filled) return filled;
    const auto text = file.at_end() ? file.view() : whole_statements(file.view());
    if (text.empty() && file.at_end()) break;
    if (text.empty()) {
      wanted *= 2;
      continue;
    }
    for (auto& piece : read_pieces(text, vertices, file.at_end())) {
      if (!verdict.take(piece)) continue;
      vertices += piece.mesh.vertices.size();
      if (vertices >= no_vertex) return too_many_vertices(name);
      take(std::move(piece.mesh));
    }
    file.advance(text.size());
    if (run.cancelled()) return {};
  }
  return verdict.of(name);
}

}  // namespace mansard::formats
