#include "strips.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace oracle {
namespace {

using Ends = std::pair<std::size_t, std::size_t>;

auto straight(const Point3& a, const Point3& m, const Point3& b) -> bool {
  const Rational ux = m.x - a.x, uy = m.y - a.y, uz = m.z - a.z, vx = b.x - m.x, vy = b.y - m.y, vz = b.z - m.z;
  return ux * vy == uy * vx && uy * vz == uz * vy && ux * vz == uz * vx;
}

/// The points strictly inside a level edge, in order.
auto inside(const std::vector<Point3>& points, std::size_t from, std::size_t to) -> std::vector<std::size_t> {
  const Point3 &a = points[from], &b = points[to];
  std::vector<std::pair<Rational, std::size_t>> found;
  const auto level = std::ranges::equal_range(points, a.z, {}, &Point3::z);
  for (auto p = level.begin(); p != level.end(); ++p) {
    if (p->x < std::min(a.x, b.x) || p->x > std::max(a.x, b.x)) continue;
    const Rational dx = b.x - a.x, dy = b.y - a.y, px = p->x - a.x, py = p->y - a.y;
    if (px * dy != py * dx) continue;
    const Rational along = px * dx + py * dy;
    if (along > 0 && along < dx * dx + dy * dy) found.emplace_back(along, static_cast<std::size_t>(p - points.begin()));
  }
  std::ranges::sort(found);
  std::vector<std::size_t> order;
  for (const auto& [along, i] : found) order.push_back(i);
  return order;
}

/// All ends of edges, sorted, each once.
auto corners_of(const std::vector<Face>& faces) -> std::vector<Point3> {
  std::vector<Point3> points;
  for (const Face& face : faces)
    for (const auto& ends : face.boundary) points.insert(points.end(), ends.begin(), ends.end());
  std::ranges::sort(points, std::less<>());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

auto number(const std::vector<Point3>& points, const Point3& p) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::lower_bound(points, p, std::less<>()) - points.begin());
}

}  // namespace

auto tidied(std::vector<Face> faces) -> std::vector<Face> {
  const auto points = corners_of(faces);
  std::vector<std::vector<Ends>> boundaries;
  std::vector<std::set<std::size_t>> joined(points.size());
  for (const Face& face : faces) {
    boundaries.emplace_back();
    for (const auto& [from, to] : face.boundary) {
      const std::size_t a = number(points, from), b = number(points, to);
      boundaries.back().emplace_back(a, b);
      joined[a].insert(b);
      joined[b].insert(a);
    }
  }
  std::vector<bool> passing(points.size());
  for (std::size_t v = 0; v < points.size(); ++v)
    passing[v] = joined[v].size() == 2 && straight(points[*joined[v].begin()], points[v], points[*joined[v].rbegin()]);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    faces[f].boundary.clear();
    for (const auto& [a, b] : boundaries[f]) {
      if (passing[a]) continue;
      std::size_t before = a, at = b;
      while (passing[at]) {
        const std::size_t on = *joined[at].begin() == before ? *joined[at].rbegin() : *joined[at].begin();
        before = at;
        at = on;
      }
      faces[f].boundary.push_back({points[a], points[at]});
    }
    std::ranges::sort(faces[f].boundary);
  }
  std::ranges::sort(faces, std::less<>());
  return faces;
}

void Strips::draw(const Point3& from, const Point3& to) {
  if (!(from == to)) edges_.push_back({{from, to}, planes_.size() - 1});
}

void Strips::add(const Plane& plane, const Slab::Edge& swept, const Rational& from, const Rational& to) {
  planes_.push_back(plane);
  const Point3 a{swept.start.x, swept.start.y, from}, b{swept.end.x, swept.end.y, from},
      c{swept.end_above.x, swept.end_above.y, to}, d{swept.start_above.x, swept.start_above.y, to};
  draw(a, b);
  draw(b, c);
  draw(c, d);
  draw(d, a);
}

void Strips::border(const Plane& plane, const Point& start, const Point& end, const Rational& z) {
  if (planes_.empty() || !planes_.back().same_as(plane)) planes_.push_back(plane);
  draw({start.x, start.y, z}, {end.x, end.y, z});
}

auto Strips::faces() const -> std::vector<Face> {
  Face all;
  for (const Edge& e : edges_) all.boundary.push_back(e.ends);
  const auto points = corners_of({all});

  std::vector<std::size_t> plane(planes_.size()), parent(planes_.size());
  for (std::size_t s = 0; s < planes_.size(); ++s) {
    parent[s] = s;
    while (!planes_[plane[s]].same_as(planes_[s])) ++plane[s];
  }
  const auto root = [&](std::size_t s) {
    while (parent[s] != s) s = parent[s];
    return s;
  };

  // Edges that two strips of one plane walk in opposite directions are inside a face.
  std::map<std::pair<std::size_t, Ends>, std::vector<std::size_t>> open;  // plane, ends → strips
  for (const Edge& e : edges_) {
    std::size_t from = number(points, e.ends[0]);
    const std::size_t last = number(points, e.ends[1]);
    std::vector<std::size_t> stops;
    if (e.ends[0].z == e.ends[1].z) stops = inside(points, from, last);
    stops.push_back(last);
    for (const std::size_t to : stops) {
      const auto opposite = open.find({plane[e.strip], {to, from}});
      if (opposite == open.end()) {
        open[{plane[e.strip], {from, to}}].push_back(e.strip);
      } else {
        parent[root(opposite->second.back())] = root(e.strip);
        opposite->second.pop_back();
        if (opposite->second.empty()) open.erase(opposite);
      }
      from = to;
    }
  }

  std::vector<Face> faces(planes_.size());
  for (const auto& [where, strips] : open)
    for (const std::size_t s : strips)
      faces[root(s)].boundary.push_back({points[where.second.first], points[where.second.second]});
  for (std::size_t s = 0; s < planes_.size(); ++s) {
    Face& face = faces[root(s)];
    face.kind = planes_[s].kind;
    if (face.kind != FaceKind::side && face.kind != FaceKind::terrace) continue;
    if (!face.provenance || planes_[s].provenance < *face.provenance) face.provenance = planes_[s].provenance;
  }
  std::erase_if(faces, [](const Face& face) { return face.boundary.empty(); });
  return tidied(std::move(faces));
}

}  // namespace oracle
