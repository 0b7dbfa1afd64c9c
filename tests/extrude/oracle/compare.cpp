#include "compare.hpp"

#include <algorithm>
#include <map>

#include "strips.hpp"

namespace oracle {
namespace {

auto points_of(const ExactSurface& surface) -> std::vector<Point3> {
  std::vector<Point3> points(surface.places.size());
  std::vector<bool> known(points.size(), false);
  for (const auto& face : surface.faces)
    for (const auto& loop : face.loops)
      for (const std::uint32_t v : loop) {
        if (!known[v]) points[v] = exact_point(surface, v);
        known[v] = true;
      }
  return points;
}

template <class Call>
void for_each_edge(const std::vector<std::vector<std::uint32_t>>& loops, Call call) {
  for (const auto& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) call(loop[i], loop[(i + 1) % loop.size()]);
}

auto text(const Point3& p) -> std::string {
  return "(" + std::to_string(p.x.get_d()) + ", " + std::to_string(p.y.get_d()) + ", " + std::to_string(p.z.get_d()) +
         ")";
}

auto text(const Face& face) -> std::string {
  std::string out = "kind " + std::to_string(static_cast<int>(face.kind));
  if (face.provenance)
    out += " of " + std::to_string(face.provenance->ring) + "/" + std::to_string(face.provenance->edge) + "/" +
           std::to_string(face.provenance->part);
  for (const auto& [from, to] : face.boundary) out += " " + text(from) + "-" + text(to);
  return out;
}

/// Calls with every place where an edge of an upright or sloped face passes the height z, and whether it goes up.
template <class Call>
void for_each_crossing(const ExactSurface& surface, const Rational& z, Call call) {
  const auto points = points_of(surface);
  for (const auto& face : surface.faces) {
    if (face.node.kind != FaceKind::side && face.node.kind != FaceKind::connector) continue;
    for_each_edge(face.loops, [&](std::uint32_t a, std::uint32_t b) {
      const Point3 &p = points[a], &q = points[b];
      if ((p.z < z) == (q.z < z)) return;
      const Rational s = (z - p.z) / (q.z - p.z);
      call(face.node, Point{p.x + s * (q.x - p.x), p.y + s * (q.y - p.y)}, p.z < z);
    });
  }
}

/// Terraces that share an edge become one, named after the first: how the kernel cuts a level surface up is its affair.
void join_terraces(std::vector<Face>& faces) {
  std::map<std::array<Point3, 2>, std::size_t> edges;
  std::vector<std::size_t> parent(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    parent[f] = f;
    if (faces[f].kind == FaceKind::terrace)
      for (const auto& ends : faces[f].boundary) edges[ends] = f;
  }
  const auto root = [&](std::size_t f) {
    while (parent[f] != f) f = parent[f];
    return f;
  };
  std::vector<Face> out = faces;
  for (Face& face : out)
    if (face.kind == FaceKind::terrace) face.boundary.clear();
  for (const auto& [ends, f] : edges)
    if (const auto opposite = edges.find({ends[1], ends[0]}); opposite != edges.end())
      parent[root(f)] = root(opposite->second);
  for (const auto& [ends, f] : edges) {
    Face& face = out[root(f)];
    if (*faces[f].provenance < *face.provenance) face.provenance = faces[f].provenance;
    if (!edges.contains({ends[1], ends[0]})) face.boundary.push_back(ends);
  }
  std::erase_if(out, [](const Face& face) { return face.boundary.empty(); });
  faces = std::move(out);
}

/// Where vertical walls meet in one line exactly, the kernel has an edge for each pair of them: cut at each other's
/// ends.
void cut_upright_edges(std::vector<Face>& faces) {
  std::map<Point, std::vector<Rational>> heights;
  for (const Face& face : faces)
    for (const auto& [from, to] : face.boundary) heights[{from.x, from.y}].push_back(from.z);
  for (Face& face : faces) {
    std::vector<std::array<Point3, 2>> cut;
    for (const auto& [from, to] : face.boundary) {
      std::vector<Rational> stops{from.z, to.z};
      if (from.x == to.x && from.y == to.y)
        for (const Rational& z : heights[{from.x, from.y}])
          if (z > std::min(from.z, to.z) && z < std::max(from.z, to.z)) stops.push_back(z);
      if (stops.size() == 2) {
        cut.push_back({from, to});
        continue;
      }
      std::ranges::sort(stops, std::less<>());
      stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
      if (from.z > to.z) std::ranges::reverse(stops);
      for (std::size_t i = 0; i + 1 < stops.size(); ++i)
        cut.push_back({Point3{from.x, from.y, stops[i]}, Point3{from.x, from.y, stops[i + 1]}});
    }
    face.boundary = std::move(cut);
  }
}

}  // namespace

auto volume(const ExactSurface& surface) -> Rational {
  const auto points = points_of(surface);
  Rational sum = 0;
  for (const auto& face : surface.faces) {
    const Point3& at = points[face.loops[0][0]];
    Rational x = 0, y = 0, z = 0;  // twice the area along the normal
    for_each_edge(face.loops, [&](std::uint32_t a, std::uint32_t b) {
      const Point3 &p = points[a], &q = points[b];
      x += p.y * q.z - p.z * q.y;
      y += p.z * q.x - p.x * q.z;
      z += p.x * q.y - p.y * q.x;
    });
    sum += at.x * x + at.y * y + at.z * z;
  }
  return sum / 6;
}

auto faces(const ExactSurface& surface) -> std::vector<Face> {
  const auto points = points_of(surface);
  std::vector<Face> out;
  std::array<Face, 2> level;  // base, cap
  for (const auto& face : surface.faces) {
    const FaceKind kind = face.node.kind;
    const bool joined = kind == FaceKind::base || kind == FaceKind::cap;
    if (!joined) out.emplace_back();
    Face& to = joined ? level[kind == FaceKind::cap ? 1 : 0] : out.back();
    to.kind = kind;
    if (kind == FaceKind::side || kind == FaceKind::terrace) to.provenance = face.node.provenance;
    for_each_edge(face.loops, [&](std::uint32_t a, std::uint32_t b) { to.boundary.push_back({points[a], points[b]}); });
  }
  for (Face& face : level)
    if (!face.boundary.empty()) out.push_back(std::move(face));
  join_terraces(out);
  cut_upright_edges(out);
  return tidied(std::move(out));
}

auto section_corners(const ExactSurface& surface, const Rational& z) -> std::vector<Point> {
  std::vector<Point> corners;
  for_each_crossing(surface, z, [&](const auto&, const Point& p, bool up) {
    if (up) corners.push_back(p);
  });
  std::ranges::sort(corners, std::less<>());
  return corners;
}

auto section_area(const ExactSurface& surface, const Rational& z) -> Rational {
  // A face's stretch of the section runs along its direction, from where its boundary goes down to where it goes up.
  Rational sum = 0;
  for_each_crossing(surface, z, [&](const auto& node, const Point& p, bool up) {
    const auto& d = node.direction;
    const Rational across = d.a * p.y - d.b * p.x, along = d.a * p.x + d.b * p.y;
    const Rational part = across * along / (Rational(d.l) * d.l);
    if (up) sum -= part;
    else sum += part;
  });
  return sum / 2;
}

auto difference(const ExactSurface& surface, const Solid& solid) -> std::string {
  const Rational measured = volume(surface);
  if (measured != solid.volume)
    return "volume " + std::to_string(measured.get_d()) + " for " + std::to_string(solid.volume.get_d());
  const auto ours = faces(surface);
  for (std::size_t i = 0; i < std::min(ours.size(), solid.faces.size()); ++i)
    if (ours[i].kind != solid.faces[i].kind || ours[i].boundary != solid.faces[i].boundary)
      return "face " + text(ours[i]) + " for " + text(solid.faces[i]);
  if (ours.size() != solid.faces.size())
    return std::to_string(ours.size()) + " faces for " + std::to_string(solid.faces.size());
  return "";
}

auto misnamed(const mansard::extrude::detail::Footprint& footprint, const std::vector<Face>& ours,
              const std::vector<Face>& judged) -> std::string {
  using mansard::extrude::detail::CanonicalEdge;
  using mansard::model::Provenance;
  std::vector<const CanonicalEdge*> edges;
  for (const auto& ring : footprint.rings)
    for (const CanonicalEdge& edge : ring) edges.push_back(&edge);
  const auto moves_as = [](const CanonicalEdge& p, const CanonicalEdge& q) {
    return p.direction == q.direction && p.offset == q.offset && p.track == q.track;
  };
  const auto is = [](const CanonicalEdge& edge, const Provenance& name) {
    return edge.provenance.ring == name.ring && edge.provenance.edge == name.edge;
  };
  const auto any_pair = [&](const auto& wanted) {
    return std::ranges::any_of(edges, [&](const auto* p) {
      return std::ranges::any_of(edges, [&](const auto* q) { return p != q && moves_as(*p, *q) && wanted(*p, *q); });
    });
  };
  for (std::size_t f = 0; f < std::min(ours.size(), judged.size()); ++f) {
    if (ours[f].provenance == judged[f].provenance) continue;
    if (ours[f].provenance && judged[f].provenance) {
      const Provenance a = *ours[f].provenance, b = *judged[f].provenance;
      const bool level = ours[f].kind == FaceKind::terrace;
      if (a.part == b.part &&
          any_pair([&](const auto& p, const auto& q) { return level ? is(p, a) || is(p, b) : is(p, a) && is(q, b); }))
        continue;
    }
    return "name of a face differs: " + text(ours[f]) + " and " + text(judged[f]);
  }
  return "";
}

}  // namespace oracle
