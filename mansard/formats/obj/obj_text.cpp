#include "mansard/formats/obj/obj_text.hpp"
#include "mansard/solid/solid.hpp"

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

auto one_line(std::string_view words) -> std::string {
  std::string line(words);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return line;
}

/// The faces of a part as corners: whole where they have no holes, as triangles where they have.
using Facets = std::array<std::vector<std::vector<std::uint32_t>>, class_count>;

auto facets_of(const model::Part& part) -> base::Result<Facets> {
  const auto& solid = part.model.solid;
  Facets facets;
  std::optional<solid::Triangulated> triangulated;
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    auto& list = facets[static_cast<std::size_t>(part.model.classes[f])];
    if (solid.faces[f].loops.size() == 1) {
      list.push_back(solid.faces[f].loops[0]);
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
        list.emplace_back(corners.begin(), corners.end());
      }
  }
  return facets;
}

}  // namespace

auto ObjText::head(const Header& header, const std::string& mtl_name) -> std::string {
  std::string out = "# mansard " + one_line(header.made_by.version) + "\n";
  if (!header.frame.crs.empty()) out += "# crs " + one_line(header.frame.crs) + "\n";
  out += "# metres, z up, coordinates in full: nothing was taken off\n";
  for (const auto& input : header.made_by.inputs)
    out += "# input " + one_line(input.path) + " sha256 " + one_line(input.sha256) + "\n";
  for (const auto& [name, value] : header.made_by.options)
    out += "# option " + one_line(name) + " = " + one_line(value) + "\n";
  out += std::string(obj_header) + header_record(header) + "\n";
  return out + "mtllib " + one_line(mtl_name) + "\n";
}

auto ObjText::of(const model::Building& building, const Gate::Keyed& keys) -> base::Result<std::string> {
  std::string out = std::string(obj_building) + building_record(building) + "\n";
  const Drawn solids = drawn(building, keys, solids_);
  warnings_.insert(warnings_.end(), solids.warnings.begin(), solids.warnings.end());
  if (!solids.solids.empty()) out += "o " + one_word(keys.building) + "\n";
  for (const auto& [part, parts] : solids.solids) {
    const auto facets = facets_of(part);
    if (!facets) return facets.error();
    out += "g " + one_word(part.id) + "\n";
    append_part(out, part, *facets);
  }
  return out;
}

void ObjText::append_part(std::string& out, const model::Part& part, const Facets& facets) {
  std::map<geometry::Point3, std::size_t> number_of;
  std::string faces;
  for (std::size_t c = 0; c < class_count; ++c) {
    if (facets[c].empty()) continue;
    faces += "usemtl ";
    faces += class_name(static_cast<model::FaceClass>(c));
    faces += '\n';
    for (const auto& corners : facets[c]) {
      faces += 'f';
      for (const auto corner : corners) {
        const auto v = in_file_frame(frame_, part.model.solid.vertices[corner]);
        const auto [entry, added] = number_of.try_emplace(v, written_ + 1);
        if (added) {
          ++written_;
          out += "v " + base::to_text(v.x) + " " + base::to_text(v.y) + " " + base::to_text(v.z) + "\n";
        }
        faces += ' ' + std::to_string(entry->second);
      }
      faces += '\n';
    }
  }
  out += faces;
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
