// OBJ with its materials: the second reader of the format, since the first one, of geometry alone, is made for speed.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/text_chunks.hpp"
#include "mansard/formats/mesh/textured_formats.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

auto material_name(std::string_view text) -> std::string {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

auto light_of(double srgb) -> std::uint16_t {
  return linear_of(static_cast<std::uint8_t>(std::lround((srgb > 0 ? std::min(srgb, 1.0) : 0) * 255)));  // NaN is black
}

struct ObjMaterial {
  TextureMaterial texture;
  LinearColour colour = white;
};

/// A library of materials.
class Library {
 public:
  explicit Library(fs::path mesh) : mesh_(std::move(mesh)) {}

  void read(std::string_view text) {
    ObjMaterial* material = nullptr;
    while (!text.empty()) {
      std::string_view line = take_line(text);
      const auto keyword = base::lower(take_word(line));
      if (keyword == "newmtl") material = &materials[material_name(line)];
      if (material == nullptr) continue;
      if (keyword == "kd" && !material->texture.image) take_colour(line, *material);
      if (keyword == "map_kd" || keyword == "map_kd.") take_picture(line, *material);
    }
  }

  std::map<std::string, ObjMaterial> materials;

 private:
  static void take_colour(std::string_view line, ObjMaterial& material) {
    for (auto& channel : material.colour)
      if (const auto value = to_coordinate(take_word(line)); value && std::isfinite(*value)) channel = light_of(*value);
  }

  /// Options come first, then the name, which may have blanks in it.
  void take_picture(std::string_view line, ObjMaterial& material) {
    for (;;) {
      std::string_view rest = line;
      const auto option = take_word(rest);
      if (option.size() < 2 || option.front() != '-') break;
      const auto name = base::lower(option);
      if (name == "-clamp") {
        if (base::lower(take_word(rest)) == "on") material.texture.wrap = {Wrap::clamp, Wrap::clamp};
      } else if (name == "-s" || name == "-o" || name == "-t" || name == "-mm") {
        for (int i = 0; i < (name == "-mm" ? 2 : 3); ++i) {
          std::string_view after = rest;
          if (!to_coordinate(take_word(after))) break;
          rest = after;
        }
      } else {
        (void)take_word(rest);
      }
      line = rest;
    }
    const auto name = material_name(line);
    if (name.empty()) return;
    material.texture.image = ImageSource::beside(mesh_, mesh_, name);
    material.colour = white;  // exporters write any colour beside a picture, black too
  }

  fs::path mesh_;
};

class TexturedObjReader {
 public:
  TexturedObjReader(std::string_view bytes, const fs::path& path) : rest_(bytes), path_(path), library_(path) {}

  auto read() -> base::Result<TexturedMesh> {
    while (!rest_.empty()) {
      std::string_view line = take_statement();
      const auto keyword = take_word(line);
      base::Result<void> done;
      if (keyword == "v") done = take_vertex(line);
      else if (keyword == "vt") take_coordinates(line);
      else if (keyword == "f") done = take_face(line);
      else if (keyword == "usemtl") use(material_name(line));
      else if (keyword == "mtllib") done = take_libraries(line);
      if (!done) return done.error();
    }
    if (out_.mesh.vertices.empty())
      return base::error("ingest-mesh-format", "not an OBJ file: no line starts with v or f; check what it is",
                         path_.string());
    // Colours behind the coordinates are from 0 to 1, of some programs from 0 to 255.
    return std::move(out_);
  }

 private:
  auto bad(const std::string& what) const -> base::Diagnostic {
    return base::error("ingest-mesh-format", "line " + std::to_string(line_) + ": " + what + "; export the mesh again",
                       path_.string());
  }

  auto take_statement() -> std::string_view {
    ++line_;
    std::string_view line = take_line(rest_);
    if (!line.ends_with('\\')) return line;
    joined_.clear();
    while (line.ends_with('\\') && !rest_.empty()) {
      joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
      line = take_line(rest_);
      ++line_;
    }
    joined_.append(line.ends_with('\\') ? line.substr(0, line.size() - 1) : line);
    return joined_;
  }

  static auto take_numbers(std::string_view line, std::span<double> numbers) -> std::size_t {
    std::size_t count = 0;
    const char *at = line.data(), *end = line.data() + line.size();
    for (; count < numbers.size(); ++count) {
      if (take_plain_number(at, end, numbers[count])) continue;
      std::string_view rest(at, static_cast<std::size_t>(end - at));
      const auto value = to_coordinate(take_word(rest));
      if (!value) break;
      numbers[count] = *value;
      at = rest.data();
    }
    return count;
  }

  auto take_vertex(std::string_view line) -> base::Result<void> {
    std::array<double, 7> numbers{};
    const auto count = take_numbers(line, numbers);
    if (count < 3) return bad("a vertex needs three numbers");
    out_.mesh.vertices.push_back({numbers[0], numbers[1], numbers[2]});
    if (count == 6) {
      const double most = std::max({numbers[3], numbers[4], numbers[5]}) > 1 ? 255.0 : 1.0;
      colours_.resize(out_.mesh.vertices.size() - 1, white);
      colours_.push_back({light_of(numbers[3] / most), light_of(numbers[4] / most), light_of(numbers[5] / most)});
    }
    return {};
  }

  void take_coordinates(std::string_view line) {
    std::array<double, 2> numbers{};
    (void)take_numbers(line, numbers);
    uv_.push_back({static_cast<float>(numbers[0]), static_cast<float>(1 - numbers[1])});  // v counts upwards
  }

  struct Corner {
    std::uint32_t vertex = no_vertex, uv = no_vertex;
  };

  auto take_face(std::string_view line) -> base::Result<void> {
    corners_.clear();
    for (auto word = take_word(line); !word.empty() && word.front() != '#'; word = take_word(line)) {
      const auto index = [](std::optional<std::int64_t> given, std::size_t so_far) {
        if (!given) return no_vertex;
        return to_index(*given > 0 ? *given - 1 : *given < 0 ? static_cast<std::int64_t>(so_far) + *given : -1);
      };
      const auto vertex = to_corner(word);
      if (!vertex) return bad("'" + std::string(word) + "' is not the index of a corner");
      Corner corner;
      corner.vertex = index(vertex, out_.mesh.vertices.size());
      if (const auto slash = word.find('/'); slash != word.npos && slash + 1 < word.size() && word[slash + 1] != '/')
        corner.uv = index(to_corner(word.substr(slash + 1)), uv_.size());
      corners_.push_back(corner);
    }
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) add({corners_[0], corners_[i], corners_[i + 1]});
    return {};
  }

  void add(const std::array<Corner, 3>& corners) {
    TexturedCorners paint;
    bool placed = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const bool known = corners[c].uv < uv_.size();
      placed = placed && known;
      if (known) paint.uv[c] = uv_[corners[c].uv];
      paint.colour[c] = colour_;
      if (pictured_ || corners[c].vertex >= colours_.size()) continue;
      for (std::size_t k = 0; k < 3; ++k)
        paint.colour[c][k] =
            static_cast<std::uint16_t>(std::uint32_t{paint.colour[c][k]} * colours_[corners[c].vertex][k] / 65535);
    }
    out_.mesh.triangles.push_back({corners[0].vertex, corners[1].vertex, corners[2].vertex});
    out_.corners.push_back(paint);
    out_.material_of.push_back(pictured_ && placed ? material_ : no_material);
  }

  void use(const std::string& name) {
    pictured_ = false;
    colour_ = white;
    const auto found = library_.materials.find(name);
    if (found == library_.materials.end()) return;
    colour_ = found->second.colour;
    pictured_ = found->second.texture.image.has_value();
    if (!pictured_) return;
    const auto [entry, added] = numbers_.try_emplace(name, static_cast<std::uint32_t>(out_.materials.size()));
    if (added) out_.materials.push_back(found->second.texture);
    material_ = entry->second;
  }

  /// Several names, or one with blanks in it.
  auto take_libraries(std::string_view line) -> base::Result<void> {
    const auto whole = material_name(line);
    const auto all = named_beside(path_, path_, whole);
    if (all && is_there(*all)) return take_library(*all);
    bool any = false;
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto path = named_beside(path_, path_, std::string(word));
      if (!path || !is_there(*path)) continue;
      any = true;
      if (auto done = take_library(*path); !done) return done;
    }
    if (!any && !all)
      out_.warnings.push_back(base::warning("texture-outside", all.error().message, all.error().subject));
    else if (!any)
      out_.warnings.push_back(base::warning(
          "texture-missing", "the library of materials '" + whole + "' is missing; copy it beside the mesh",
          path_.string()));
    return {};
  }

  auto take_library(const fs::path& path) -> base::Result<void> {
    const auto bytes = bytes_of_named(path);
    if (!bytes) return bytes.error();
    library_.read(without_mark(bytes->view()));
    return {};
  }

  std::string_view rest_;
  const fs::path& path_;
  Library library_;
  TexturedMesh out_;
  std::size_t line_ = 0;
  std::string joined_;
  std::vector<std::array<float, 2>> uv_;
  std::vector<LinearColour> colours_;
  std::vector<Corner> corners_;
  std::map<std::string, std::uint32_t> numbers_;
  LinearColour colour_ = white;
  std::uint32_t material_ = no_material;
  bool pictured_ = false;
};

}  // namespace

auto read_textured_obj(std::string_view bytes, const fs::path& path) -> base::Result<TexturedMesh> {
  return TexturedObjReader(bytes, path).read();
}

}  // namespace mansard::formats
