#include "mansard/solid/solid.hpp"

#include <cmath>

#include "mansard/solid/detail/measure.hpp"

namespace mansard::solid {

auto volume(const model::Solid& solid) -> double {
  if (solid.vertices.empty()) return 0;
  const geometry::Point3 o = solid.vertices.front();  // near the solid, so that far-away ones keep their digits
  double sum = 0;
  for (const model::Face& face : solid.faces)
    if (!face.loops.empty() && !face.loops[0].empty())
      sum += dot(detail::area_vector(solid, face), solid.vertices[face.loops[0][0]] - o) / 6;
  return sum;
}

auto area(const model::Solid& solid, const model::Face& face) -> double {
  return length(detail::area_vector(solid, face)) / 2;
}

auto triangulate(const model::Solid& solid) -> base::Result<Triangulated> {
  // The exact predicates take no coordinate that is not a number.
  for (const auto& v : solid.vertices)
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
      return base::error("solid-degenerate", "a vertex is not finite");
  Triangulated out;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const auto part = detail::triangles_of(solid, solid.faces[f]);
    if (!part) return part.error();
    out.triangles.insert(out.triangles.end(), part->begin(), part->end());
    out.face_of.insert(out.face_of.end(), part->size(), f);
  }
  return out;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"solid-open", "A solid has an edge with a face on one side only.",
       "This is a fault of the program that made it.", 1},
      {"solid-non-manifold", "More than two faces meet at an edge, or faces meet at a vertex only.",
       "Separate the parts that touch.", 1},
      {"solid-orientation", "A solid or one of its faces is inside out.",
       "This is a fault of the program that made it.", 1},
      {"solid-not-planar", "A face bends by more than 0.1 mm.", "This is a fault of the program that made it.", 1},
      {"solid-needle", "A face has a triangle so narrow that its normal deviates by more than 20 degrees.",
       "This is a fault of the program that made it.", 1},
      {"solid-self-intersection", "Faces of a solid cross or touch where they are no neighbours.",
       "This is a fault of the program that made it.", 1},
      {"solid-degenerate", "A solid has a face without area, a repeated vertex or a value that is not finite.",
       "This is a fault of the program that made it.", 1},
      {"solid-near-vertices", "Two vertices of a solid are less than 1 mm apart.",
       "Validators merge them; merge them in the file.", 1},
      {"solid-several-shells", "The faces of a solid are not all connected.", "Write each shell as a solid.", 1},
      {"solid-overlap", "Two solids of a building share space, be it a tenth of a millimetre.",
       "Separate them, or write the building as one solid.", 1},
      {"solid-not-united", "The parts of a building are several solids.",
       "Parts that touch in an edge or a point only, or that overlap, have no union that is a valid solid; edit their "
       "plans where the message says so.",
       0},
      {"solid-parted", "Parts of a building share ground, which the higher one keeps.",
       "Edit the plans of its parts so that they do not overlap.", 0},
      {"solid-simplified", "A part of a building is written as a prism, because its solid is not valid in a file.",
       "Look for edges shorter than 1 mm, and for places narrower than that, in its plan.", 1},
      {"solid-left-out", "A part of a building is neither written nor measured: no valid solid can be made of it.",
       "Remove the part, or widen it.", 1},
  };
}

}  // namespace mansard::solid
