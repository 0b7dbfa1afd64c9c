#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

#include "mansard/base/text.hpp"
#include "mansard/ingest/detail/mesh_formats.hpp"
#include "mansard/ingest/detail/words.hpp"

namespace mansard::ingest::detail {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

auto size_of(Type type) -> std::size_t {
  static constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

auto to_type(std::string_view word) -> std::optional<Type> {
  static constexpr std::array<std::array<std::string_view, 2>, 8> names{{{"char", "int8"},
                                                                         {"uchar", "uint8"},
                                                                         {"short", "int16"},
                                                                         {"ushort", "uint16"},
                                                                         {"int", "int32"},
                                                                         {"uint", "uint32"},
                                                                         {"float", "float32"},
                                                                         {"double", "float64"}}};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (word == names[i][0] || word == names[i][1]) return static_cast<Type>(i);
  return std::nullopt;
}

struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> count;  ///< of a list
};

/// The class of a face: what `mansard simulate` and `mansard label` write.
auto is_class(const Property& property) -> bool { return property.name == "class" && !property.count; }

auto to_class(double value) -> std::uint8_t {
  constexpr std::uint8_t other = 3;
  return value >= 0 && value < other ? static_cast<std::uint8_t>(value) : other;
}

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { none, ascii, little, big };

struct Header {
  Format format = Format::none;
  std::vector<Element> elements;
};

/// The body's values one after the other, as text. After the end, or a word that is no number, `failed` stays set.
struct TextValues {
  std::string_view rest;
  bool failed = false;

  auto take(Type) -> double {
    const auto value = to_coordinate(take_word(rest));
    failed = failed || !value;
    return value.value_or(0);
  }
  static auto least(Type) -> std::size_t { return 2; }  // a digit and a blank
  /// Whether what failed was a bad word rather than the end.
  [[nodiscard]] auto more() const -> bool {
    std::string_view look = rest;
    return !take_word(look).empty();
  }
};

template <std::endian order>
struct BinaryValues {
  std::string_view rest;
  bool failed = false;

  auto take(Type type) -> double {
    switch (type) {
      case Type::int8: return take_as<std::int8_t>();
      case Type::uint8: return take_as<std::uint8_t>();
      case Type::int16: return take_as<std::int16_t>();
      case Type::uint16: return take_as<std::uint16_t>();
      case Type::int32: return take_as<std::int32_t>();
      case Type::uint32: return take_as<std::uint32_t>();
      case Type::float32: return static_cast<double>(take_as<float>());
      case Type::float64: return take_as<double>();
    }
    return 0;
  }
  static auto least(Type type) -> std::size_t { return size_of(type); }
  /// Bytes cannot be bad, only too few.
  [[nodiscard]] static auto more() -> bool { return false; }

 private:
  template <class T>
  auto take_as() -> T {
    std::array<char, sizeof(T)> bytes{};
    if (rest.size() < sizeof(T)) return failed = true, T{};
    std::memcpy(bytes.data(), rest.data(), sizeof(T));
    rest.remove_prefix(sizeof(T));
    if constexpr (order != std::endian::native)
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    return std::bit_cast<T>(bytes);
  }
};

auto truncated(const std::string& what, const std::string& name) -> base::Diagnostic {
  return base::error("ingest-mesh-truncated", "the file ends before " + what + "; copy or export it again", name);
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

template <class Values>
auto take_elements(Values values, const Header& header, const std::string& name) -> base::Result<RawMesh> {
  RawMesh mesh;
  std::vector<double> list;
  std::vector<std::uint32_t> corners;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    double least = 0;
    for (const Property& property : element.properties)
      least += static_cast<double>(values.least(property.count.value_or(property.type)));
    // Before anything is allocated: a header can promise what no file holds.
    if (least * static_cast<double>(element.count) > static_cast<double>(values.rest.size()) + 1)
      return truncated("the " + std::to_string(element.count) + " elements '" + element.name + "' it promises", name);

    const bool vertices = element.name == "vertex", faces = element.name == "face",
               strips = element.name == "tristrips";
    const bool classed = faces && std::ranges::any_of(element.properties, is_class);
    if (vertices) mesh.vertices.reserve(static_cast<std::size_t>(element.count));
    if (faces) mesh.triangles.reserve(static_cast<std::size_t>(element.count));
    constexpr std::size_t nowhere = 3;
    std::vector<std::size_t> target;  // where each property of a vertex goes
    for (const Property& property : element.properties)
      target.push_back(property.name == "x" ? 0U : property.name == "y" ? 1U : property.name == "z" ? 2U : nowhere);

    for (std::int64_t i = 0; i < element.count; ++i) {
      std::array<double, 4> point{};
      double of_face = 0;
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (!property.count) {
          const double value = values.take(property.type);
          if (classed && is_class(property)) of_face = value;
          point[target[p]] = value;
          continue;
        }
        const double size = values.take(*property.count);
        if (!(size >= 0) ||
            size * static_cast<double>(values.least(property.type)) > static_cast<double>(values.rest.size()) + 1)
          values.failed = true;
        if (values.failed) break;
        const bool indices = property.name == "vertex_indices" || property.name == "vertex_index";
        list.clear();
        for (double k = 0; k < size; ++k) list.push_back(values.take(property.type));
        if (strips && indices) take_strip(mesh, list, corners);
        if (!faces || !indices) continue;
        corners.clear();
        for (const double value : list) corners.push_back(corner_of(value));
        add_face(mesh, corners);
      }
      if (values.failed) {
        const std::string which =
            "element " + std::to_string(i + 1) + " of " + std::to_string(element.count) + " of '" + element.name + "'";
        if (!values.more()) return truncated(which, name);
        return base::error("ingest-mesh-format", which + " is broken; export the mesh again", name);
      }
      if (vertices) mesh.vertices.push_back({point[0], point[1], point[2]});
      if (classed) mesh.classes.resize(mesh.triangles.size(), to_class(of_face));
    }
  }
  return mesh;
}

/// Takes the header off the front; the body follows its last line's end exactly.
auto take_header(std::string_view& bytes, const std::string& name) -> base::Result<Header> {
  Header header;
  std::size_t count = 1;
  const auto bad = [&](const std::string& what) {
    return base::error("ingest-mesh-format", "line " + std::to_string(count) + ": " + what + "; export the mesh again",
                       name);
  };
  if (take_line(bytes) != "ply") return bad("a PLY file starts with the line 'ply'");
  while (!bytes.empty()) {
    ++count;
    std::string_view line = take_line(bytes);
    const std::string_view keyword = take_word(line);
    if (keyword == "end_header") {
      if (header.format == Format::none) return bad("the header names no format");
      return header;
    }
    if (keyword == "format") {
      const std::string_view word = take_word(line);
      header.format = word == "ascii"                  ? Format::ascii
                      : word == "binary_little_endian" ? Format::little
                      : word == "binary_big_endian"    ? Format::big
                                                       : Format::none;
      if (header.format == Format::none) return bad("format '" + std::string(word) + "' is not known");
    } else if (keyword == "element") {
      const std::string element(take_word(line));
      const auto size = base::to_whole(take_word(line));
      if (element.empty() || !size || *size < 0) return bad("an element needs a name and a count");
      header.elements.push_back({element, *size, {}});
    } else if (keyword == "property") {
      if (header.elements.empty()) return bad("a property before any element");
      Property property;
      std::string_view word = take_word(line);
      if (word == "list") {
        property.count = to_type(take_word(line));
        word = take_word(line);
        if (!property.count) return bad("the count of a list has no known type");
      }
      const auto type = to_type(word);
      property.name = take_word(line);
      if (!type || property.name.empty()) return bad("a property needs a known type and a name");
      property.type = *type;
      header.elements.back().properties.push_back(std::move(property));
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      return bad("'" + std::string(keyword.substr(0, 40)) + "' does not belong in a PLY header");
    }
  }
  return truncated("its header does", name);
}

auto find(const Header& header, std::string_view name) -> const Element* {
  for (const auto& element : header.elements)
    if (element.name == name) return &element;
  return nullptr;
}

}  // namespace

auto read_ply(std::string_view bytes, const std::string& name) -> base::Result<RawMesh> {
  const auto header = take_header(bytes, name);
  if (!header) return header.error();
  const Element* vertices = find(*header, "vertex");
  int axes = 0;
  if (vertices != nullptr)
    for (const auto& property : vertices->properties)
      if (property.name == "x" || property.name == "y" || property.name == "z") axes += property.count ? 0 : 1;
  if (axes != 3) return base::error("ingest-mesh-format", "the PLY file has no vertices with x, y and z", name);
  switch (header->format) {
    case Format::little: return take_elements(BinaryValues<std::endian::little>{bytes}, *header, name);
    case Format::big: return take_elements(BinaryValues<std::endian::big>{bytes}, *header, name);
    default: return take_elements(TextValues{bytes}, *header, name);
  }
}

}  // namespace mansard::ingest::detail
