#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string>

#include "mansard/base/run.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/mesh_stream.hpp"
#include "mansard/formats/mesh/text_chunks.hpp"
#include "mansard/formats/ply/ply_file.hpp"

namespace mansard::formats {
namespace {

using namespace ply;

/// The class of a face: what `mansard simulate` and `mansard label` write.
auto is_class(const Property& property) -> bool { return property.name == "class" && !property.count; }

auto to_class(double value) -> std::uint8_t {
  constexpr std::uint8_t other = 3;
  return value >= 0 && value < other ? static_cast<std::uint8_t>(value) : other;
}

/// A list index as 32 bits; −1, NaN and the like name no vertex.
auto corner_of(double value) -> std::uint32_t {
  return value >= 0 && value < static_cast<double>(no_vertex) ? static_cast<std::uint32_t>(value) : no_vertex;
}

void take_strip(RawMesh& mesh, const std::vector<double>& list, std::vector<std::uint32_t>& corners) {
  corners.clear();
  for (std::size_t i = 0; i <= list.size(); ++i) {
    if (i < list.size() && list[i] >= 0) {
      corners.push_back(corner_of(list[i]));
      continue;
    }
    add_strip(mesh, corners);
    corners.clear();
  }
}

auto is_indices(const Property& property) -> bool {
  return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
}

// ---- Bodies as nearly all files have them, read side by side. Each says whether the body is like that; where not, it
// is taken value by value below, which also finds out what is wrong with it.

template <class T, std::endian order>
auto load(const char* at) -> T {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), at, sizeof(T));
  if constexpr (order != std::endian::native) std::ranges::reverse(bytes);
  return std::bit_cast<T>(bytes);
}

/// Work on `count` elements in blocks that never depend on the number of threads.
constexpr std::size_t block_size = std::size_t{1} << 16;
template <class Work>
void each_block(std::size_t count, const Work& work) {
  if (count == 0) return;
  if (count <= block_size) return work(0, 0, count);
  base::parallel_for((count + block_size - 1) / block_size,
                     [&](std::size_t b) { work(b, b * block_size, std::min(count, (b + 1) * block_size)); });
}

/// Vertices without lists whose x, y and z are all of type T.
template <class T, std::endian order>
void load_vertices(const char* start, std::size_t stride, const std::array<std::size_t, 3>& at,
                   std::span<geometry::Point3> out) {
  each_block(out.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const char* vertex = start + i * stride;
      out[i] = {static_cast<double>(load<T, order>(vertex + at[0])),
                static_cast<double>(load<T, order>(vertex + at[1])),
                static_cast<double>(load<T, order>(vertex + at[2]))};
    }
  });
}

template <std::endian order>
auto took_vertices(std::string_view& rest, const Element& element, RawMesh& mesh) -> bool {
  std::size_t stride = 0, found = 0;
  std::array<std::size_t, 3> at{};
  std::array<Type, 3> type{};
  for (const Property& property : element.properties) {
    if (property.count) return false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (property.name == std::string_view("xyz").substr(axis, 1)) {
        at[axis] = stride;
        type[axis] = property.type;
        ++found;
      }
    stride += size_of(property.type);
  }
  const auto count = static_cast<std::size_t>(element.count);
  if (found != 3 || type[0] != type[1] || type[0] != type[2] || count > rest.size() / stride) return false;
  if (type[0] != Type::float32 && type[0] != Type::float64) return false;
  const std::size_t before = mesh.vertices.size();
  mesh.vertices.resize(before + count);
  const auto out = std::span(mesh.vertices).subspan(before);
  if (type[0] == Type::float32) load_vertices<float, order>(rest.data(), stride, at, out);
  else load_vertices<double, order>(rest.data(), stride, at, out);
  rest.remove_prefix(stride * count);
  return true;
}

/// Where things are in a face that has one list of 8-bit length, of indices of 32 bits.
struct FaceLayout {
  std::size_t before = 0, after = 0;  ///< bytes of other properties
  bool is_signed = false;
  std::optional<std::size_t> class_before, class_after;  ///< byte of an 8-bit class among them

  static auto of(const Element& element) -> std::optional<FaceLayout> {
    FaceLayout out;
    bool listed = false;
    for (const Property& property : element.properties) {
      std::size_t& bytes = listed ? out.after : out.before;
      if (property.count) {
        if (listed || !is_indices(property) || property.count != Type::uint8) return std::nullopt;
        if (property.type != Type::int32 && property.type != Type::uint32) return std::nullopt;
        out.is_signed = property.type == Type::int32;
        listed = true;
        continue;
      }
      if (is_class(property)) {
        if (property.type != Type::uint8) return std::nullopt;
        (listed ? out.class_after : out.class_before) = bytes;
      }
      bytes += size_of(property.type);
    }
    if (!listed || (out.class_before && out.class_after)) return std::nullopt;
    return out;
  }
};

/// Takes as many of the faces as are in `rest` as a whole. Nothing where faces are not like that.
template <std::endian order>
auto took_whole_faces(std::string_view& rest, const Element& element, RawMesh& mesh) -> std::optional<std::size_t> {
  const auto layout = FaceLayout::of(element);
  if (!layout || !mesh.triangles.empty()) return std::nullopt;
  struct Start {
    std::size_t byte = 0, triangle = 0;
  };
  // Faces differ in length: hop over all, and remember where every block starts.
  std::vector<Start> starts;
  std::size_t byte = 0, triangles = 0, short_faces = 0, count = 0;
  for (const auto all = static_cast<std::size_t>(element.count); count < all; ++count) {
    const std::size_t at = byte + layout->before;
    if (at >= rest.size()) break;
    const auto size = static_cast<unsigned char>(rest[at]);
    const std::size_t end = at + 1 + 4 * std::size_t{size} + layout->after;
    if (end > rest.size()) break;
    if (count % block_size == 0) starts.push_back({byte, triangles});
    byte = end;
    if (size < 3) ++short_faces;
    else triangles += size - 2U;
  }
  mesh.triangles.resize(triangles);
  const bool classed = layout->class_before || layout->class_after;
  if (classed) mesh.classes.resize(triangles);
  each_block(count, [&](std::size_t block, std::size_t first, std::size_t end) {
    const char* at = rest.data() + starts[block].byte;
    std::size_t out = starts[block].triangle;
    const auto corner = [&](std::size_t k) {
      const auto index = load<std::uint32_t, order>(at + layout->before + 1 + 4 * k);
      return layout->is_signed && index > 0x7fffffffU ? no_vertex : index;
    };
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t size = static_cast<unsigned char>(at[layout->before]);
      const char* behind = at + layout->before + 1 + 4 * size;
      const char* kind = layout->class_before  ? at + *layout->class_before
                         : layout->class_after ? behind + *layout->class_after
                                               : nullptr;
      for (std::size_t k = 1; k + 1 < size; ++k, ++out) {
        mesh.triangles[out] = {corner(0), corner(k), corner(k + 1)};
        if (kind != nullptr) mesh.classes[out] = to_class(static_cast<unsigned char>(*kind));
      }
      at = behind + layout->after;
    }
  });
  mesh.short_faces += short_faces;
  rest.remove_prefix(byte);
  return count;
}

template <std::endian order>
auto took_faces(std::string_view& rest, const Element& element, RawMesh& mesh) -> bool {
  if (!mesh.triangles.empty()) return false;
  std::string_view look = rest;
  RawMesh faces;
  const auto count = took_whole_faces<order>(look, element, faces);
  if (!count || *count != static_cast<std::size_t>(element.count)) return false;
  mesh.triangles = std::move(faces.triangles);
  mesh.classes = std::move(faces.classes);
  mesh.short_faces += faces.short_faces;
  rest = look;
  return true;
}

/// One element of a text as a line of it: every value, and nothing behind them.
auto took_line(std::string_view line, const Element& element, bool classed, RawMesh& mesh) -> bool {
  const char *at = line.data(), *end = line.data() + line.size();
  const auto take = [&](double& value) {
    if (take_plain_number(at, end, value)) return true;
    std::string_view rest(at, static_cast<std::size_t>(end - at));
    const auto number = to_coordinate(take_word(rest));
    at = end - rest.size();
    value = number.value_or(0);
    return number.has_value();
  };
  const bool vertices = element.name == "vertex", faces = element.name == "face";
  geometry::Point3 point;
  double of_face = 0;
  std::array<std::uint32_t, 16> corners{};
  for (const Property& property : element.properties) {
    double value = 0;
    if (!take(value)) return false;
    if (property.count) {
      if (!(value >= 0 && value <= 16) || value != std::floor(value)) return false;
      const auto size = static_cast<std::size_t>(value);
      for (std::size_t k = 0; k < size; ++k) {
        if (!take(value)) return false;
        corners[k] = corner_of(value);
      }
      if (faces && is_indices(property)) add_face(mesh, std::span(corners).first(size));
    } else if (property.name == "x") {
      point.x = value;
    } else if (property.name == "y") {
      point.y = value;
    } else if (property.name == "z") {
      point.z = value;
    } else if (classed && is_class(property)) {
      of_face = value;
    }
  }
  skip_blanks(at, end);
  if (at != end) return false;
  if (vertices) mesh.vertices.push_back(point);
  if (classed) mesh.classes.resize(mesh.triangles.size(), to_class(of_face));
  return true;
}

auto read_text_lines(std::string_view body, const PlyHeader& header) -> std::optional<RawMesh> {
  std::size_t lines = 0;
  std::vector<std::pair<std::size_t, const Element*>> ends;  // the line after each element's last
  bool any_class = false;
  std::size_t face_elements = 0;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    if (element.name == "tristrips" || static_cast<std::size_t>(element.count) > body.size()) return std::nullopt;
    if (element.name == "face") {
      ++face_elements;
      any_class = any_class || std::ranges::any_of(element.properties, is_class);
    }
    ends.emplace_back(lines += static_cast<std::size_t>(element.count), &element);
  }
  if (face_elements > 1) return std::nullopt;
  return read_lines(body, lines, 0, [&](std::string_view line, std::size_t number, RawMesh& piece) {
    const auto at = std::ranges::find_if(ends, [&](const auto& end) { return number < end.first; });
    return took_line(line, *at->second, any_class && at->second->name == "face", piece);
  });
}

// ---- Any body, value by value.

template <class Values>
auto took_side_by_side(Values&, const Element&, RawMesh&) -> bool {
  return false;
}
template <std::endian order>
auto took_side_by_side(BinaryValues<order>& values, const Element& element, RawMesh& mesh) -> bool {
  if (element.name == "vertex") return took_vertices<order>(values.rest, element, mesh);
  return element.name == "face" && took_faces<order>(values.rest, element, mesh);
}

/// Takes elements of one kind value by value.
class ByValue {
 public:
  explicit ByValue(const Element& element) : element_(element) {
    constexpr std::size_t nowhere = 3;
    for (const Property& property : element.properties)
      target_.push_back(property.name == "x" ? 0U : property.name == "y" ? 1U : property.name == "z" ? 2U : nowhere);
  }
  [[nodiscard]] auto vertices() const -> bool { return vertices_; }
  [[nodiscard]] auto faces() const -> bool { return faces_; }

  /// Adds the next one to the mesh. False where it is broken; the mesh may then have some of it.
  template <class Values>
  auto took(Values& values, RawMesh& mesh) -> bool {
    std::array<double, 4> point{};
    double of_face = 0;
    for (std::size_t p = 0; p < element_.properties.size(); ++p) {
      const Property& property = element_.properties[p];
      if (!property.count) {
        const double value = values.take(property.type);
        if (classed_ && is_class(property)) of_face = value;
        point[target_[p]] = value;
        continue;
      }
      const double size = values.take(*property.count);
      if (!(size >= 0) ||
          size * static_cast<double>(values.least(property.type)) > static_cast<double>(values.rest.size()) + 1)
        values.failed = true;
      if (values.failed) break;
      const bool indices = is_indices(property);
      list_.clear();
      for (double k = 0; k < size; ++k) list_.push_back(values.take(property.type));
      if (strips_ && indices) take_strip(mesh, list_, corners_);
      if (!faces_ || !indices) continue;
      corners_.clear();
      for (const double value : list_) corners_.push_back(corner_of(value));
      add_face(mesh, corners_);
    }
    if (values.failed) return false;
    if (vertices_) mesh.vertices.push_back({point[0], point[1], point[2]});
    if (classed_) mesh.classes.resize(mesh.triangles.size(), to_class(of_face));
    return true;
  }

 private:
  const Element& element_;
  bool vertices_ = element_.name == "vertex", faces_ = element_.name == "face", strips_ = element_.name == "tristrips";
  bool classed_ = faces_ && std::ranges::any_of(element_.properties, is_class);
  std::vector<std::size_t> target_;  // where each property of a vertex goes
  std::vector<double> list_;
  std::vector<std::uint32_t> corners_;
};

/// Before anything is allocated: a header can promise what no file holds.
template <class Values>
auto check_promise(const Values& values, const Element& element, double left, const std::string& name)
    -> base::Result<void> {
  double least = 0;
  for (const Property& property : element.properties)
    least += static_cast<double>(values.least(property.count.value_or(property.type)));
  if (least * static_cast<double>(element.count) <= left + 1) return {};
  return truncated("the " + std::to_string(element.count) + " elements '" + element.name + "' it promises", name);
}

auto number_in_words(std::int64_t number, const Element& element) -> std::string {
  return "element " + std::to_string(number) + " of " + std::to_string(element.count) + " of '" + element.name + "'";
}

template <class Values>
auto take_elements(Values values, const PlyHeader& header, const std::string& name) -> base::Result<RawMesh> {
  RawMesh mesh;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    if (auto kept = check_promise(values, element, static_cast<double>(values.rest.size()), name); !kept)
      return kept.failure();
    if (took_side_by_side(values, element, mesh)) continue;
    ByValue by_value(element);
    if (by_value.vertices()) mesh.vertices.reserve(static_cast<std::size_t>(element.count));
    if (by_value.faces()) mesh.triangles.reserve(static_cast<std::size_t>(element.count));
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (by_value.took(values, mesh)) continue;
      const std::string which = number_in_words(i + 1, element);
      if (!values.more()) return truncated(which, name);
      return base::error("ingest-mesh-format", which + " is broken; export the mesh again", name);
    }
  }
  return mesh;
}

// ---- The same from a file of any size.

/// Takes as many whole elements, up to `element.count`, as there are at the front of `rest`.
template <std::endian order>
auto take_some(std::string_view& rest, const Element& element, RawMesh& mesh) -> std::size_t {
  if (element.name == "vertex") {
    std::size_t stride = 0;
    for (const Property& property : element.properties) stride += size_of(property.type);  // without lists, else below
    Element some = element;
    some.count = std::min(element.count, static_cast<std::int64_t>(rest.size() / stride));
    if (some.count > 0 && took_vertices<order>(rest, some, mesh)) return static_cast<std::size_t>(some.count);
  } else if (element.name == "face") {
    if (const auto taken = took_whole_faces<order>(rest, element, mesh)) return *taken;
  }
  ByValue by_value(element);
  std::size_t taken = 0;
  for (; taken < static_cast<std::size_t>(element.count); ++taken) {
    BinaryValues<order> values{rest};
    const std::size_t triangles = mesh.triangles.size();
    const auto short_faces = mesh.short_faces;
    if (!by_value.took(values, mesh)) {
      mesh.triangles.resize(triangles);
      mesh.short_faces = short_faces;
      break;
    }
    rest = values.rest;
  }
  return taken;
}

template <std::endian order>
auto stream_elements(FileWindow& file, const PlyHeader& header, const std::string& name, const TakePiece& take,
                     const base::Run& run) -> base::Result<void> {
  std::size_t vertices = 0;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    if (auto kept = check_promise(BinaryValues<order>{}, element, static_cast<double>(file.left()), name); !kept)
      return kept;
    Element left = element;
    for (std::size_t wanted = FileWindow::usual; left.count > 0;) {
      if (run.cancelled()) return {};
      if (auto filled = file.fill(wanted); !filled) return filled;
      std::string_view rest = file.view();
      RawMesh piece;
      const std::size_t taken = take_some<order>(rest, left, piece);
      if (taken == 0 && file.at_end()) return truncated(number_in_words(element.count - left.count + 1, element), name);
      if (taken == 0) {  // one that is larger than what is in memory
        wanted = 2 * std::max(wanted, file.view().size());
        continue;
      }
      left.count -= static_cast<std::int64_t>(taken);
      file.advance(file.view().size() - rest.size());
      vertices += piece.vertices.size();
      if (vertices >= no_vertex) return too_many_vertices(name);
      piece.classes.clear();
      take(std::move(piece));
    }
  }
  return {};
}

auto has_places(const PlyHeader& header) -> bool {
  const auto* vertices = header.find("vertex");
  int axes = 0;
  if (vertices != nullptr)
    for (const auto& property : vertices->properties)
      if (property.name == "x" || property.name == "y" || property.name == "z") axes += property.count ? 0 : 1;
  return axes == 3;
}

}  // namespace

auto read_ply(std::string_view bytes, const std::string& name) -> base::Result<RawMesh> {
  const auto header = ply::take_header(bytes, name);
  if (!header) return header.error();
  if (!has_places(*header))
    return base::error("ingest-mesh-format", "the PLY file has no vertices with x, y and z", name);
  switch (header->format) {
    case ply::Encoding::little: return take_elements(ply::BinaryValues<std::endian::little>{bytes}, *header, name);
    case ply::Encoding::big: return take_elements(ply::BinaryValues<std::endian::big>{bytes}, *header, name);
    default:
      if (auto lines = read_text_lines(bytes, *header)) return *std::move(lines);
      return take_elements(ply::TextValues{bytes}, *header, name);
  }
}

auto stream_ply(FileWindow& file, const std::string& name, const TakePiece& take, const base::Run& run)
    -> base::Result<bool> {
  if (auto filled = file.fill(FileWindow::usual); !filled) return filled.failure();  // more than any header
  std::string_view rest = file.view();
  const auto header = ply::take_header(rest, name);
  if (!header || !has_places(*header) || header->format == ply::Encoding::ascii) return false;
  file.advance(file.view().size() - rest.size());
  auto done = header->format == ply::Encoding::little
                  ? stream_elements<std::endian::little>(file, *header, name, take, run)
                  : stream_elements<std::endian::big>(file, *header, name, take, run);
  if (!done) return done.failure();
  return true;
}

}  // namespace mansard::formats
