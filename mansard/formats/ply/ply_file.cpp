#include "mansard/formats/ply/ply_file.hpp"

#include "mansard/base/text.hpp"

namespace mansard::formats::ply {
namespace {

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

}  // namespace

auto size_of(Type type) -> std::size_t {
  static constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

auto truncated(const std::string& what, const std::string& name) -> base::Diagnostic {
  return base::error("ingest-mesh-truncated", "the file ends before " + what + "; copy or export it again", name);
}

auto take_header(std::string_view& bytes, const std::string& name) -> base::Result<PlyHeader> {
  PlyHeader header;
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
      if (header.format == Encoding::none) return bad("the header names no format");
      return header;
    }
    if (keyword == "format") {
      const std::string_view word = take_word(line);
      header.format = word == "ascii"                  ? Encoding::ascii
                      : word == "binary_little_endian" ? Encoding::little
                      : word == "binary_big_endian"    ? Encoding::big
                                                       : Encoding::none;
      if (header.format == Encoding::none) return bad("format '" + std::string(word) + "' is not known");
    } else if (keyword == "element") {
      const std::string element(take_word(line));
      const auto size = base::to_integer(take_word(line));
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

auto PlyHeader::find(std::string_view name) const -> const Element* {
  for (const auto& element : elements)
    if (element.name == name) return &element;
  return nullptr;
}

}  // namespace mansard::formats::ply
