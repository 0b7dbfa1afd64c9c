#include "mansard/formats/obj/obj_text.hpp"
#include "mansard/solid/solid.hpp"

#include <algorithm>
#include <map>

#include "mansard/base/text.hpp"
#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/triangles.hpp"

namespace mansard::formats::detail {
namespace {

/// Names end at white space in OBJ, and a line at a line break.
auto one_word(std::string_view name) -> std::string {
  std::string word;
  for (const char c : name) word += static_cast<unsigned char>(c) <= ' ' || c == '#' ? '_' : c;
  return word.empty() ? "_" : word;
}

/// On one line, which importers can read: longer texts, a CRS as WKT among them, are in the file beside in full.
auto one_line(std::string_view words) -> std::string {
  constexpr std::size_t most = 900;  // characters, so that a comment has less than 1,000
  const bool cut = words.size() > most;
  if (cut) {
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0U) == 0x80) --end;  // not inside a character
    words = words.substr(0, end);
  }
  std::string line(words);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return cut ? line + " ..." : line;
}

auto material_name(std::size_t kind, std::uint32_t page) -> std::string {
  return std::string(class_name(static_cast<model::FaceClass>(kind))) + "_" + std::to_string(page);
}

}  // namespace

/// The faces of a part as corners: whole where they have no holes, as triangles where they have.
auto ObjText::facets_of(const model::Part& part) -> base::Result<Facets> {
  const auto& solid = part.model.solid;
  Facets facets;
  std::optional<solid::Triangulated> triangulated;
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    auto& list = facets[static_cast<std::size_t>(part.model.classes[f])];
    if (solid.faces[f].loops.size() == 1) {
      list.push_back({f, solid.faces[f].loops[0]});
      continue;
    }
    if (!triangulated) {
      auto triangles = triangles_of(solid, part.id);
      if (!triangles) return triangles.error();
      triangulated = *std::move(triangles);
    }
    for (std::size_t t = 0; t < triangulated->triangles.size(); ++t)
      if (triangulated->face_of[t] == f) {
        const auto& corners = triangulated->triangles[t];
        list.push_back({f, {corners.begin(), corners.end()}});
      }
  }
  return facets;
}

auto ObjText::head(const Header& header, const std::string& mtl_name) const -> std::string {
  std::string out = "# mansard " + one_line(header.made_by.version) + "\n";
  if (!header.frame.crs.empty()) out += "# crs " + one_line(header.frame.crs) + "\n";
  if (y_up_) out += "# up y\n";
  if (local_) {
    out += "# origin";
    for (const auto metres : frame_.origin) out += " " + std::to_string(metres);
    out += "\n# metres, relative to the origin\n";
  } else {
    out += "# metres, coordinates in full: nothing was taken off\n";
  }
  constexpr std::size_t few = 20;  // a tileset has thousands of files; the file beside names all
  for (std::size_t i = 0; i < std::min(few, header.made_by.inputs.size()); ++i)
    out += "# input " + one_line(header.made_by.inputs[i].path) + "\n";
  if (header.made_by.inputs.size() > few)
    out += "# and " + std::to_string(header.made_by.inputs.size() - few) + " more inputs\n";
  for (const auto& [name, value] : header.made_by.options)
    out += "# option " + one_line(name) + " = " + one_line(value) + "\n";
  return out + "mtllib " + one_line(mtl_name) + "\n";
}

auto ObjText::of(const model::Building& building, const Gate::Keyed& keys, const TexturedSolids* textured)
    -> base::Result<std::string> {
  std::string out;
  Drawn solids = drawn(building, keys, solids_);
  level_.apply(solids, frame_);
  warnings_.insert(warnings_.end(), solids.warnings.begin(), solids.warnings.end());
  if (!solids.solids.empty()) out += "o " + one_word(keys.building) + "\n";
  // Pictures are of the faces of LoD 2.2.
  if (level_.lod != Lod::lod22 || textures_for(building, solids.solids.size()) == nullptr) textured = nullptr;
  for (std::size_t s = 0; s < solids.solids.size(); ++s) {
    const auto& part = solids.solids[s].part;
    const auto facets = facets_of(part);
    if (!facets) return facets.error();
    out += "g " + one_word(part.id) + "\n";
    append_part(out, part, *facets, textured, textured != nullptr ? textured->first + s : 0);
  }
  return out;
}

void ObjText::append_part(std::string& out, const model::Part& part, const Facets& facets,
                          const TexturedSolids* textured, std::size_t solid) {
  std::map<geometry::Point3, std::size_t> number_of;
  std::string faces;
  for (std::size_t c = 0; c < class_count; ++c) {
    std::string material;
    for (const auto& [face, corners] : facets[c]) {
      const auto wanted = textured == nullptr
                              ? std::string(class_name(static_cast<model::FaceClass>(c)))
                              : material_name(c, textured->first_page + textured->atlas->page_of(solid, face));
      if (wanted != material) faces += "usemtl " + wanted + "\n";
      material = wanted;
      faces += 'f';
      for (const auto corner : corners) {
        const auto local = part.model.solid.vertices[corner];
        const auto full = local_ ? local : in_file_frame(frame_, local);
        const auto v = y_up_ ? geometry::Point3{full.x, full.z, full.y == 0 ? 0.0 : -full.y} : full;
        const auto [entry, added] = number_of.try_emplace(v, written_ + 1);
        if (added) {
          ++written_;
          out += "v " + base::to_text(v.x) + " " + base::to_text(v.y) + " " + base::to_text(v.z) + "\n";
        }
        faces += ' ' + std::to_string(entry->second);
        if (textured == nullptr) continue;
        const auto [u, w] = textured->atlas->uv(solid, face, local);
        out += "vt " + base::to_text(u, 6) + " " + base::to_text(1 - w, 6) + "\n";  // v counts upwards
        faces += '/' + std::to_string(++placed_);
      }
      faces += '\n';
    }
  }
  out += faces;
}

auto obj_plans(const Path& path) -> Path { return Path(path).replace_extension(".plans.jsonl"); }

auto textured_mtl_text(std::uint32_t page, const std::string& image) -> std::string {
  std::string out;
  for (std::size_t c = 0; c < class_count; ++c)
    out += "newmtl " + material_name(c, page) + "\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1\nmap_Kd " + image + "\n";
  return out;
}

auto mtl_text() -> std::string {
  std::string out = "# mansard: a material per class of surface\n";
  for (std::size_t c = 0; c < class_count; ++c) {
    out += "newmtl ";
    out += class_name(static_cast<model::FaceClass>(c));
    out += "\nKd";
    for (const int channel : class_colours[c]) out += " " + base::to_text(channel / 255.0, 4);
    out += "\nKs 0 0 0\nd 1\nillum 1\n";
  }
  return out;
}

}  // namespace mansard::formats::detail
