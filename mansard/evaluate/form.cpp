// What a person who draws roofs would object to.
#include "mansard/evaluate/form.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "mansard/evaluate/detail/corners.hpp"
#include "mansard/evaluate/detail/degree.hpp"
#include "mansard/evaluate/detail/shared_boundary.hpp"
#include "mansard/evaluate/detail/steep.hpp"
#include "mansard/evaluate/planes.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::evaluate {
namespace {

using detail::degree;
using geometry::Point3;

void count_twins(const RoofPlanes& planes, Form& out) {
  const double opposite = -geometry::cosine(twin_azimuth * degree);
  const auto pitched = [](double pitch) { return pitch >= twin_least_pitch && pitch <= twin_most_pitch; };
  const auto& all = planes.planes;
  for (std::size_t p = 0; p < all.size(); ++p) {
    const double own = pitch_of(all[p]) / degree;
    if (!pitched(own)) continue;
    for (auto q = p + 1; q < all.size() && all[q].building == all[p].building; ++q) {
      const double other = pitch_of(all[q]) / degree, off = std::abs(own - other);
      if (!pitched(other) || off > twin_pitch) continue;
      if (dot(normalised(xy(all[p].normal)), normalised(xy(all[q].normal))) > opposite) continue;
      ++out.twins;
      out.unequal += off >= twin_equal ? 1 : 0;
    }
  }
}

void count_steep(const FormInput& model, const geometry::Mesh& scan, Form& out) {
  std::vector<std::vector<const model::ModelFace*>> faces(model.planes.planes.size());
  std::size_t number = 0;
  for (const auto& building : model.model.buildings)
    for (const auto& part : building.parts)
      for (const auto& face : part.faces)
        if (const auto plane = model.planes.plane_of_face[number++]; plane != no_plane) faces[plane].push_back(&face);
  std::vector<detail::SteepPlane> steep;
  for (std::size_t p = 0; p < faces.size(); ++p)
    if (const auto& plane = model.planes.planes[p]; plane.normal.z < geometry::cosine(steep_pitch * degree))
      steep.push_back({&plane, std::move(faces[p])});
  out.steep = steep.size();
  for (const auto& area : detail::carried(steep, scan)) {
    if (!area) ++out.unchecked;
    else if (*area < steep_evidence) ++out.steep_bare;
  }
}

/// One part: the ground it is on, how high it is, and its longest ridge.
struct Extent {
  base::Result<Outline> outline = Outline();
  double height = 0;
  std::optional<double> ridge;
};

auto extents_of(const FormInput& model) -> std::vector<Extent> {
  std::vector<const model::ModelPart*> parts;
  for (const auto& building : model.model.buildings)
    for (const auto& part : building.parts) parts.push_back(&part);
  std::vector<Extent> out(parts.size());
  base::parallel_for(parts.size(), [&](std::size_t p) {
    out[p].outline = outline_of({parts[p], 1});
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& face : parts[p]->faces)
      for (const auto at : face.loops.front()) low = std::min(low, at.z), high = std::max(high, at.z);
    out[p].height = high - low;
  });
  std::vector<double> longest(parts.size(), 0);
  for (const auto& line : model.lines) {
    const double l = length(line.end - line.start);
    if (line.kind != RoofLineKind::ridge || l <= longest[line.part]) continue;
    longest[line.part] = l;
    out[line.part].ridge = (line.start.z + line.end.z) / 2;
  }
  return out;
}

void count_parts(const std::vector<Extent>& parts, Form& out) {
  for (const auto& part : parts) {
    if (!part.outline) {
      ++out.unchecked;
      continue;
    }
    double area = 0;
    for (const auto& polygon : *part.outline) area += geometry::area(polygon);
    out.tall += area > 0 && part.height > tall_ratio * std::sqrt(area) ? 1 : 0;
  }
}

/// Pairs of parts that touch along a metre or more and whose ridges are at almost one height.
void count_ridges(const std::vector<Extent>& parts, Form& out) {
  constexpr double least_touch = 1;  // m
  for (std::size_t a = 0; a < parts.size(); ++a) {
    const Extent& one = parts[a];
    if (!one.ridge || !one.outline) continue;
    for (auto b = a + 1; b < parts.size(); ++b) {
      const Extent& other = parts[b];
      if (!other.ridge || !other.outline) continue;
      const double off = std::abs(*one.ridge - *other.ridge);
      if (off >= ridge_near || detail::shared_boundary(*one.outline, *other.outline) < least_touch) continue;
      ++out.ridges;
      out.ridges_unequal += off > ridge_equal ? 1 : 0;
    }
  }
}

void count_edges(const model::Model& model, Form& out) {
  const auto planes = planes_of(model);
  std::size_t face = 0;
  for (const auto& building : model.buildings) {
    const detail::Corners corners(building);
    out.vertices += corners.points.size();
    std::size_t corner = 0;
    // Per edge the planes of its faces: an edge inside one plane is none.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> at;
    for (const auto& part : building.parts)
      for (const auto& one : part.faces) {
        for (const auto& loop : one.loops) {
          for (std::size_t i = 0; i < loop.size(); ++i) {
            const auto from = corners.of_corner[corner + i], to = corners.of_corner[corner + (i + 1) % loop.size()];
            if (from != to) at[std::minmax(from, to)].push_back(planes.of_face[face]);
          }
          corner += loop.size();
        }
        ++face;
      }
    for (const auto& [ends, of] : at) {
      if (of.size() > 1 && std::ranges::all_of(of, [&](auto p) { return p == of.front(); })) continue;
      ++out.edges;
      out.short_edges += length(corners.points[ends.first] - corners.points[ends.second]) < short_edge ? 1 : 0;
    }
  }
}

}  // namespace

auto form_of(const FormInput& model, const geometry::Mesh& scan) -> Form {
  Form out;
  out.buildings = model.model.buildings.size();
  out.planes = model.planes.planes.size();
  out.unchecked = model.planes.unchecked;
  for (const auto& plane : model.planes.planes) out.narrow += !plane.plan.empty() && plane.width < narrow_width ? 1 : 0;
  count_twins(model.planes, out);
  count_steep(model, scan, out);
  const auto parts = extents_of(model);
  out.parts = parts.size();
  count_parts(parts, out);
  count_ridges(parts, out);
  count_edges(model.model, out);
  for (const auto& one : model.structures) ++(one.dormer ? out.dormers : out.structures);
  return out;
}

}  // namespace mansard::evaluate
