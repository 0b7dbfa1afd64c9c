// PLY with its textures and colours: the second reader of the format, since the first one, of geometry alone, is made
// for speed. PLY itself knows neither: the names are those that MeshLab, OpenMVS and Blender write.
#include <algorithm>
#include <cmath>
#include <span>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/text_chunks.hpp"
#include "mansard/formats/mesh/textured_formats.hpp"
#include "mansard/formats/ply/ply_file.hpp"

namespace mansard::formats {
namespace {

using namespace ply;

/// The names in the header's lines "comment TextureFile NAME", in their order; a name may have blanks in it.
auto texture_files(std::string_view header) -> std::vector<std::string> {
  std::vector<std::string> out;
  while (!header.empty()) {
    std::string_view line = take_line(header);
    if (take_word(line) != "comment" || take_word(line) != "TextureFile") continue;
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    if (!line.empty()) out.emplace_back(line);
  }
  return out;
}

/// Whole numbers of 8 and 16 bits are shares of the largest one; others are from 0 to 1, of some programs to 255.
auto light_of(double value, Type type) -> std::uint16_t {
  double most = 1;
  const bool wide = type == Type::uint16 || type == Type::int16;
  if (wide) most = 65535;
  else if (type == Type::uint8 || type == Type::int8 || value > 1) most = 255;
  const double share = value > 0 ? std::min(value / most, 1.0) : 0;  // NaN is black
  return linear_of(static_cast<std::uint8_t>(std::lround(share * 255)));
}

/// What a property of a vertex or a face says.
enum class Meaning : std::uint8_t { none, x, y, z, u, v, red, green, blue, corners, places, image };

auto meaning_of(const Property& property) -> Meaning {
  const std::string_view name = property.name;
  if (property.count) {
    if (name == "vertex_indices" || name == "vertex_index") return Meaning::corners;
    return name == "texcoord" ? Meaning::places : Meaning::none;
  }
  struct Named {
    std::string_view name;
    Meaning meaning;
  };
  static constexpr std::array<Named, 18> all{{{"x", Meaning::x},
                                              {"y", Meaning::y},
                                              {"z", Meaning::z},
                                              {"u", Meaning::u},
                                              {"s", Meaning::u},
                                              {"texture_u", Meaning::u},
                                              {"v", Meaning::v},
                                              {"t", Meaning::v},
                                              {"texture_v", Meaning::v},
                                              {"red", Meaning::red},
                                              {"diffuse_red", Meaning::red},
                                              {"green", Meaning::green},
                                              {"diffuse_green", Meaning::green},
                                              {"blue", Meaning::blue},
                                              {"diffuse_blue", Meaning::blue},
                                              {"texnumber", Meaning::image},
                                              {"texture_number", Meaning::image},
                                              {"tex_id", Meaning::image}}};
  const auto found = std::ranges::find(all, name, &Named::name);
  return found == all.end() ? Meaning::none : found->meaning;
}

/// One vertex or face as the file has it.
struct One {
  std::array<double, 3> position{};
  std::array<double, 2> uv{};
  LinearColour colour = white;
  double image = 0;
  std::vector<double> corners, places;
};

class Layout {
 public:
  explicit Layout(const Element& element) : element_(element) {
    for (const auto& property : element.properties) meanings_.push_back(meaning_of(property));
  }
  [[nodiscard]] auto has(Meaning meaning) const -> bool {
    return std::ranges::find(meanings_, meaning) != meanings_.end();
  }
  [[nodiscard]] auto coloured() const -> bool { return has(Meaning::red) && has(Meaning::green) && has(Meaning::blue); }

  /// False where the next one is broken, or not there.
  template <class Values>
  auto took(Values& values, One& out) const -> bool {
    for (std::size_t p = 0; p < meanings_.size(); ++p) {
      const auto& property = element_.properties[p];
      if (property.count) {
        if (!took_list(values, property, list_of(meanings_[p], out))) return false;
        continue;
      }
      const double value = values.take(property.type);
      switch (meanings_[p]) {
        case Meaning::x: out.position[0] = value; break;
        case Meaning::y: out.position[1] = value; break;
        case Meaning::z: out.position[2] = value; break;
        case Meaning::u: out.uv[0] = value; break;
        case Meaning::v: out.uv[1] = value; break;
        case Meaning::red: out.colour[0] = light_of(value, property.type); break;
        case Meaning::green: out.colour[1] = light_of(value, property.type); break;
        case Meaning::blue: out.colour[2] = light_of(value, property.type); break;
        case Meaning::image: out.image = value; break;
        default: break;
      }
    }
    return !values.failed;
  }

 private:
  static auto list_of(Meaning meaning, One& out) -> std::vector<double>* {
    if (meaning == Meaning::corners) return &out.corners;
    return meaning == Meaning::places ? &out.places : nullptr;
  }

  template <class Values>
  static auto took_list(Values& values, const Property& property, std::vector<double>* into) -> bool {
    if (!property.count) return false;
    const double size = values.take(*property.count);
    // Before anything is allocated: a list can promise what no file holds.
    if (!(size >= 0) ||
        size * static_cast<double>(values.least(property.type)) > static_cast<double>(values.rest.size()) + 1)
      values.failed = true;
    if (values.failed) return false;
    if (into != nullptr) into->clear();
    for (double k = 0; k < size; ++k) {
      const double value = values.take(property.type);
      if (into != nullptr) into->push_back(value);
    }
    return !values.failed;
  }

  const Element& element_;
  std::vector<Meaning> meanings_;
};

class Reader {
 public:
  Reader(const PlyHeader& header, std::string_view header_text, const std::filesystem::path& path)
      : header_(header), name_(path.string()) {
    for (const auto& name : texture_files(header_text)) {
      out_.materials.push_back({ImageSource::beside(path, path, name), {Wrap::repeat, Wrap::repeat}});
    }
  }

  template <class Values>
  auto read(Values values) -> base::Result<TexturedMesh> {
    for (const Element& element : header_.elements) {
      if (element.properties.empty()) continue;
      const Layout layout(element);
      for (std::int64_t i = 0; i < element.count; ++i) {
        One one;
        if (!layout.took(values, one)) return broken(values.more(), i + 1, element);
        if (element.name == "vertex") take_vertex(layout, one);
        else if (element.name == "face") take_face(layout, one);
        else if (element.name == "tristrips") take_strip(one.corners);
      }
    }
    if (!coloured_ && !std::ranges::any_of(out_.material_of, [](auto m) { return m != no_material; })) {
      out_.corners.clear();  // triangles alone
      out_.material_of.clear();
      out_.materials.clear();
    }
    return std::move(out_);
  }

 private:
  auto broken(bool more, std::int64_t number, const Element& element) const -> base::Diagnostic {
    const std::string which =
        "element " + std::to_string(number) + " of " + std::to_string(element.count) + " of '" + element.name + "'";
    if (!more) return truncated(which, name_);
    return base::error("ingest-mesh-format", which + " is broken; export the mesh again", name_);
  }

  void take_vertex(const Layout& layout, const One& one) {
    out_.mesh.vertices.push_back({one.position[0], one.position[1], one.position[2]});
    if (layout.coloured()) {
      coloured_ = true;
      colours_.push_back(one.colour);
    }
    if (layout.has(Meaning::u) && layout.has(Meaning::v)) uv_.push_back(place(one.uv[0], one.uv[1]));
  }

  void take_face(const Layout& layout, const One& one) {
    const std::size_t corners = one.corners.size();
    const bool own_places = one.places.size() == 2 * corners && corners > 0;
    if (layout.coloured()) coloured_ = true;
    const auto whole = one.image >= 0 && one.image < static_cast<double>(out_.materials.size());
    const auto material = whole ? static_cast<std::uint32_t>(one.image) : no_material;
    for (std::size_t i = 1; i + 1 < corners; ++i) {
      const std::array<std::size_t, 3> picked{0, i, i + 1};
      std::array<std::uint32_t, 3> triangle{};
      TexturedCorners paint;
      bool placed = true;
      for (std::size_t c = 0; c < 3; ++c) {
        triangle[c] = index_of(one.corners[picked[c]]);
        if (own_places) paint.uv[c] = place(one.places[2 * picked[c]], one.places[2 * picked[c] + 1]);
        else if (triangle[c] < uv_.size()) paint.uv[c] = uv_[triangle[c]];
        else placed = false;
        if (triangle[c] < colours_.size()) paint.colour[c] = colours_[triangle[c]];
        else if (layout.coloured()) paint.colour[c] = one.colour;
      }
      add(triangle, paint, placed ? material : no_material);
    }
  }

  /// Every other triangle of a strip is turned; a negative index begins a new one.
  void take_strip(std::span<const double> corners) {
    std::size_t length = 0;
    std::array<std::uint32_t, 2> last{};
    for (const double corner : corners) {
      if (!(corner >= 0)) {
        length = 0;
        continue;
      }
      const auto index = index_of(corner);
      if (length >= 2) {
        const bool turned = length % 2 == 1;
        const std::array<std::uint32_t, 3> triangle{last[turned ? 1 : 0], last[turned ? 0 : 1], index};
        TexturedCorners paint;
        for (std::size_t c = 0; c < 3; ++c)
          if (triangle[c] < colours_.size()) paint.colour[c] = colours_[triangle[c]];
        add(triangle, paint, no_material);
      }
      last = {last[1], index};
      ++length;
    }
  }

  /// A picture is not multiplied with colours of vertices: programs that write both mean the same by them.
  void add(const std::array<std::uint32_t, 3>& triangle, TexturedCorners paint, std::uint32_t material) {
    if (material != no_material) paint.colour = {white, white, white};
    out_.mesh.triangles.push_back(triangle);
    out_.corners.push_back(paint);
    out_.material_of.push_back(material);
  }

  static auto index_of(double value) -> std::uint32_t {
    return value >= 0 && value < static_cast<double>(no_vertex) ? static_cast<std::uint32_t>(value) : no_vertex;
  }
  /// v counts upwards in the file.
  static auto place(double u, double v) -> std::array<float, 2> {
    return {static_cast<float>(u), static_cast<float>(1 - v)};
  }

  const PlyHeader& header_;
  std::string name_;
  TexturedMesh out_;
  std::vector<LinearColour> colours_;
  std::vector<std::array<float, 2>> uv_;
  bool coloured_ = false;
};

}  // namespace

auto read_textured_ply(std::string_view bytes, const std::filesystem::path& path) -> base::Result<TexturedMesh> {
  std::string_view body = bytes;
  const auto header = take_header(body, path.string());
  if (!header) return header.error();
  const auto* vertices = header->find("vertex");
  if (vertices == nullptr || !Layout(*vertices).has(Meaning::x) || !Layout(*vertices).has(Meaning::y) ||
      !Layout(*vertices).has(Meaning::z))
    return base::error("ingest-mesh-format", "the PLY file has no vertices with x, y and z", path.string());
  Reader reader(*header, bytes.substr(0, bytes.size() - body.size()), path);
  switch (header->format) {
    case Encoding::little: return reader.read(BinaryValues<std::endian::little>{body});
    case Encoding::big: return reader.read(BinaryValues<std::endian::big>{body});
    default: return reader.read(TextValues{body});
  }
}

}  // namespace mansard::formats
