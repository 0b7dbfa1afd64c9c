#include "mansard/formats/mesh/text_chunks.hpp"

#include <algorithm>
#include <atomic>

#include "mansard/base/run.hpp"
#include "mansard/formats/files/words.hpp"

namespace mansard::formats {
namespace {

/// After the first line end at or after `at` that ends a statement.
auto statement_end(std::string_view text, std::size_t at, bool continued) -> std::size_t {
  for (;;) {
    at = text.find('\n', at);
    if (at == text.npos) return text.size();
    std::string_view line = text.substr(0, at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++at;
    if (!continued || !line.ends_with('\\')) return at;
  }
}

/// Calls act(line) for every line with anything in it, until it says no.
template <class Act>
auto each_line(std::string_view text, char comment, const Act& act) -> bool {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const char* at = line.data();
    skip_blanks(at, line.data() + line.size());
    if (at == line.data() + line.size() || (comment != 0 && *at == comment)) continue;
    if (!act(line)) return false;
  }
  return true;
}

template <class T>
void append(std::vector<T>& all, std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
  more = {};
}

}  // namespace

auto chunks_of(std::string_view text, bool continued, std::size_t size) -> std::vector<std::string_view> {
  std::vector<std::string_view> out;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = statement_end(text, std::min(text.size(), start + size) - 1, continued);
    out.push_back(text.substr(start, end - start));
    start = end;
  }
  return out;
}

auto join(std::vector<RawMesh>& pieces) -> RawMesh {
  if (pieces.size() == 1) return std::move(pieces.front());
  std::size_t vertices = 0, triangles = 0, classes = 0;
  for (const auto& piece : pieces) {
    vertices += piece.vertices.size();
    triangles += piece.triangles.size();
    classes += piece.classes.size();
  }
  RawMesh all;
  all.vertices.reserve(vertices);
  for (auto& piece : pieces) append(all.vertices, piece.vertices);
  all.triangles.reserve(triangles);
  for (auto& piece : pieces) append(all.triangles, piece.triangles);
  all.classes.reserve(classes);
  for (auto& piece : pieces) {
    append(all.classes, piece.classes);
    all.short_faces += piece.short_faces;
  }
  return all;
}

auto read_lines(std::string_view text, std::size_t count, char comment,
                const std::function<bool(std::string_view, std::size_t, RawMesh&)>& read) -> std::optional<RawMesh> {
  const auto chunks = chunks_of(text, false);
  std::vector<std::size_t> first(chunks.size() + 1, 0);
  base::parallel_for(chunks.size(), [&](std::size_t i) {
    each_line(chunks[i], comment, [&](std::string_view) { return ++first[i + 1], true; });
  });
  for (std::size_t i = 0; i < chunks.size(); ++i) first[i + 1] += first[i];
  if (first.back() < count) return std::nullopt;
  std::vector<RawMesh> pieces(chunks.size());
  std::atomic<bool> sound{true};
  base::parallel_for(chunks.size(), [&](std::size_t i) {
    std::size_t number = first[i];
    if (number >= count || !sound.load(std::memory_order_relaxed)) return;
    const bool read_all = each_line(
        chunks[i], comment, [&](std::string_view line) { return number >= count || read(line, number++, pieces[i]); });
    if (!read_all) sound.store(false, std::memory_order_relaxed);
  });
  if (!sound) return std::nullopt;
  return join(pieces);
}

}  // namespace mansard::formats
