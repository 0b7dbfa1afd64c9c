#include "mansard/refine/detail/strips.hpp"

#include <array>
#include <map>
#include <numeric>

#include "mansard/geometry/arcs.hpp"

namespace mansard::refine::detail {

auto strips_of(const model::Plan& plan, const model::Solid& solid) -> FaceStrips {
  FaceStrips out;
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::vector<std::uint32_t>> curve_of_edge;  // by ring; empty: it has no curve
  std::uint32_t curves = 0;
  const auto add = [&](const model::PlanRing& ring) {
    auto& of = curve_of_edge.emplace_back();
    for (const auto& arc : geometry::arcs_of(ring.points)) {
      of.resize(ring.points.size(), none);
      for (std::size_t k = 0; k < arc.count; ++k) of[(arc.first + k) % of.size()] = curves;
      ++curves;
    }
  };
  add(plan.outer);
  for (const auto& hole : plan.holes) add(hole);

  out.of_face.resize(solid.faces.size());
  if (curves == 0) {
    std::iota(out.of_face.begin(), out.of_face.end(), 0U);
    out.count = static_cast<std::uint32_t>(solid.faces.size());
    return out;
  }
  std::map<std::array<std::uint32_t, 4>, std::uint32_t> known;  // by curve, profile, part and kind
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const auto& face = solid.faces[f];
    out.of_face[f] = out.count;
    if (face.provenance && face.kind != model::FaceKind::connector) {
      const auto [ring, edge, part] = *face.provenance;
      const auto& of = curve_of_edge[ring];
      if (!of.empty() && of[edge] != none) {
        const auto profile = (ring == 0 ? plan.outer : plan.holes[ring - 1]).profile_of_edge[edge];
        out.of_face[f] = known.try_emplace({of[edge], profile, part, static_cast<std::uint32_t>(face.kind)}, out.count)
                             .first->second;
      }
    }
    if (out.of_face[f] == out.count) ++out.count;
  }
  return out;
}

}  // namespace mansard::refine::detail
