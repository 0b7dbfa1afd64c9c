// OBJ as modellers write it: `o` is a building, groups and materials are classes.
#include <algorithm>
#include <fstream>
#include <map>
#include <optional>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/formats/models.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;

/// The class that a group or a material is named for, if any. Soffits are the undersides of roofs.
auto class_in(std::string_view name) -> std::optional<model::SurfaceClass> {
  const std::string word = base::lower(name);
  const auto has = [&](std::string_view part) { return word.find(part) != word.npos; };
  if (has("wall")) return model::SurfaceClass::wall;
  if (has("roof") || has("soffit")) return model::SurfaceClass::roof;
  if (has("ground")) return model::SurfaceClass::ground;
  return std::nullopt;
}

auto trimmed(std::string_view text) -> std::string {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return std::string(text);
}

/// What a face is, by the lines above it.
class ClassAbove {
 public:
  /// A line that begins with `o`, `g` or `usemtl`; others change nothing.
  void take(std::string_view keyword, std::string_view rest) {
    if (keyword == "usemtl") by_material_ = class_in(rest);
    if (keyword == "g") by_group_ = class_in(rest);
    if (keyword == "o") by_group_ = by_material_ = std::nullopt;
  }
  [[nodiscard]] auto of_group() const -> bool { return by_group_.has_value(); }
  [[nodiscard]] auto now() const -> std::optional<model::SurfaceClass> {
    return by_material_ ? by_material_ : by_group_;
  }

 private:
  std::optional<model::SurfaceClass> by_group_, by_material_;
};

class ObjModelReader {
 public:
  ObjModelReader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  auto read() -> base::Result<RawModel> {
    while (!rest_.empty()) {
      ++line_;
      std::string_view line = take_line(rest_);
      const std::string_view keyword = take_word(line);
      base::Result<void> done;
      above_.take(keyword, line);
      if (keyword == "v") done = take_vertex(line);
      else if (keyword == "f") done = take_face(line);
      else if (keyword == "o") start_object(trimmed(line));
      else if (keyword == "g") start_group(trimmed(line));
      else if (keyword == "#") take_comment(line);
      if (!done) return done.error();
    }
    if (vertices_.empty())
      return base::error("ingest-model-format", "not an OBJ file: no line starts with v; check what it is", name_);
    return std::move(model_);
  }

 private:
  auto bad(const std::string& what) const -> base::Diagnostic {
    return base::error("ingest-model-format", "line " + std::to_string(line_) + ": " + what + "; export it again",
                       name_);
  }

  /// What mansard's own files say of their coordinates.
  void take_comment(std::string_view line) {
    const auto word = take_word(line);
    if (word == "crs") model_.crs = trimmed(line);
    if (word == "up") y_up_ = trimmed(line) == "y";
    if (word != "origin") return;
    const auto x = to_coordinate(take_word(line)), y = to_coordinate(take_word(line)),
               z = to_coordinate(take_word(line));
    if (x && y && z) origin_ = {*x, *y, *z};
  }

  auto take_vertex(std::string_view line) -> base::Result<void> {
    const auto x = to_coordinate(take_word(line)), y = to_coordinate(take_word(line)),
               z = to_coordinate(take_word(line));
    if (!x || !y || !z) return bad("a vertex needs three numbers");
    vertices_.push_back(origin_ + (y_up_ ? Point3{*x, -*z, *y} : Point3{*x, *y, *z}));
    return {};
  }

  auto take_face(std::string_view line) -> base::Result<void> {
    model::ModelFace face;
    auto& loop = face.loops.emplace_back();
    for (std::string_view word = take_word(line); !word.empty() && word.front() != '#'; word = take_word(line)) {
      const auto corner = to_corner(word);
      if (!corner) return bad("'" + std::string(word) + "' is not the index of a corner");
      const auto so_far = static_cast<std::int64_t>(vertices_.size());
      const auto index = to_index(*corner > 0 ? *corner - 1 : *corner < 0 ? so_far + *corner : -1);
      if (index >= vertices_.size()) return bad("corner " + std::string(word) + " names no vertex above it");
      loop.push_back(vertices_[index]);
    }
    const auto kind = above_.now();
    face.kind = kind.value_or(model::SurfaceClass::other);
    face.by_normal = !kind;
    part().faces.push_back(std::move(face));
    return {};
  }

  void start_object(const std::string& name) {
    objects_ = true;
    enter(name, name);
  }

  /// A group is a class, or a building where there are no objects, or a part of one.
  void start_group(const std::string& name) {
    if (above_.of_group() || name.empty()) return;
    if (objects_) enter(model_.buildings[building_].id, name);
    else enter(name, name);
  }

  void enter(const std::string& building, const std::string& part) {
    const auto [b, is_new] = building_of_.try_emplace(building, model_.buildings.size());
    if (is_new) model_.buildings.push_back({building, {}});
    building_ = b->second;
    auto& parts = model_.buildings[building_].parts;
    const auto [p, is_first] = part_of_.try_emplace({building_, part}, parts.size());
    if (is_first) parts.push_back({part, {}});
    part_ = p->second;
  }

  auto part() -> model::ModelPart& {
    if (model_.buildings.empty()) enter("model", "model");
    return model_.buildings[building_].parts[part_];
  }

  std::string_view rest_;
  const std::string& name_;
  std::size_t line_ = 0;
  bool objects_ = false, y_up_ = false;
  Point3 origin_;
  std::vector<Point3> vertices_;
  RawModel model_;
  std::size_t building_ = 0, part_ = 0;
  std::map<std::string, std::size_t> building_of_;
  std::map<std::pair<std::size_t, std::string>, std::size_t> part_of_;
  ClassAbove above_;
};

}  // namespace

auto labels_every_face(const std::filesystem::path& obj) -> bool {
  std::ifstream file(obj, std::ios::binary);
  ClassAbove above;
  bool any = false;
  for (std::string text; std::getline(file, text);) {
    std::string_view line = text;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const auto keyword = take_word(line);
    above.take(keyword, line);
    if (keyword != "f") continue;
    if (!above.now()) return false;
    any = true;
  }
  return any;
}

auto read_labelled_obj(std::string_view bytes, const std::string& name) -> base::Result<RawModel> {
  return ObjModelReader(without_mark(bytes), name).read();
}

}  // namespace mansard::formats
