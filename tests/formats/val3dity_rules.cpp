#include "val3dity_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "mansard/geometry/polygon.hpp"  // GEOS, which solid::check() does not use
#include "mansard/solid/solid.hpp"

namespace val3dity {
namespace {

using Json = nlohmann::json;
__extension__ using Wide = __int128;

/// Whole multiples of the file's scale, from its first vertex.
using Point = std::array<std::int64_t, 3>;
using Flat = std::array<std::int64_t, 2>;
using Ring = std::vector<std::size_t>;
using Face = std::vector<Ring>;
using Vector = std::array<double, 3>;

auto sign(Wide v) -> int { return (v > 0) - (v < 0); }

auto side(const Flat& a, const Flat& b, const Flat& c) -> int {
  return sign(Wide(b[0] - a[0]) * (c[1] - a[1]) - Wide(b[1] - a[1]) * (c[0] - a[0]));
}

auto above(const Point& a, const Point& b, const Point& c, const Point& d) -> int {
  const auto m = [](const Point& p, const Point& q, std::size_t i) { return Wide(p[i] - q[i]); };
  const Wide x = m(b, a, 1) * m(c, a, 2) - m(b, a, 2) * m(c, a, 1),
             y = m(b, a, 2) * m(c, a, 0) - m(b, a, 0) * m(c, a, 2),
             z = m(b, a, 0) * m(c, a, 1) - m(b, a, 1) * m(c, a, 0);
  return sign(x * m(d, a, 0) + y * m(d, a, 1) + z * m(d, a, 2));
}

auto on_segment(const Flat& a, const Flat& b, const Flat& p) -> bool {
  return side(a, b, p) == 0 && std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

enum class Meeting { none, point, crossing, overlap };
auto meeting(const Flat& a, const Flat& b, const Flat& c, const Flat& d) -> Meeting {
  const int c1 = side(a, b, c), d1 = side(a, b, d), a1 = side(c, d, a), b1 = side(c, d, b);
  if (c1 * d1 < 0 && a1 * b1 < 0) return Meeting::crossing;
  std::set<Flat> touching;
  for (const Flat& p : {c, d})
    if (on_segment(a, b, p)) touching.insert(p);
  for (const Flat& p : {a, b})
    if (on_segment(c, d, p)) touching.insert(p);
  return touching.empty() ? Meeting::none : touching.size() == 1 ? Meeting::point : Meeting::overlap;
}

/// 1 inside, 0 on the ring, −1 outside.
auto place(const std::vector<Flat>& ring, const Flat& p) -> int {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    Flat a = ring[i], b = ring[(i + 1) % ring.size()];
    if (on_segment(a, b, p)) return 0;
    if (a[1] > b[1]) std::swap(a, b);
    if (a[1] <= p[1] && p[1] < b[1] && side(a, b, p) > 0) inside = !inside;
  }
  return inside ? 1 : -1;
}

auto doubled_area(const std::vector<Flat>& ring) -> Wide {
  Wide sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Flat &a = ring[i], &b = ring[(i + 1) % ring.size()];
    sum += Wide(a[0]) * b[1] - Wide(a[1]) * b[0];
  }
  return sum;
}

auto segment_meets_triangle(const Point& p, const Point& q, const std::array<Point, 3>& t) -> bool {
  const int op = above(t[0], t[1], t[2], p), oq = above(t[0], t[1], t[2], q);
  if (op * oq > 0) return false;
  if (op != 0 || oq != 0) {
    std::set<int> sides;
    for (std::size_t i = 0; i < 3; ++i) sides.insert(above(p, q, t[i], t[(i + 1) % 3]));
    return !(sides.contains(1) && sides.contains(-1));
  }
  for (std::size_t drop = 0; drop < 3; ++drop) {  // in one plane: seen along an axis that does not make it a line
    const auto flat = [&](const Point& v) { return Flat{v[(drop + 1) % 3], v[(drop + 2) % 3]}; };
    const std::vector<Flat> ring{flat(t[0]), flat(t[1]), flat(t[2])};
    if (side(ring[0], ring[1], ring[2]) == 0) continue;
    for (std::size_t i = 0; i < 3; ++i)
      if (meeting(flat(p), flat(q), ring[i], ring[(i + 1) % 3]) != Meeting::none) return true;
    return place(ring, flat(p)) >= 0;
  }
  return false;
}

using Triangle = std::array<std::size_t, 3>;  // vertices

auto triangles_meet(const std::vector<Point>& points, const Triangle& s, const Triangle& t) -> bool {
  std::vector<std::size_t> shared;
  for (const auto v : s)
    if (std::ranges::find(t, v) != t.end()) shared.push_back(v);
  const auto corners = [&](const Triangle& u) { return std::array{points[u[0]], points[u[1]], points[u[2]]}; };
  const auto others = [&](const Triangle& u) {
    std::vector<std::size_t> rest;
    for (const auto v : u)
      if (std::ranges::find(shared, v) == shared.end()) rest.push_back(v);
    return rest;
  };
  if (shared.size() == 3) return true;
  if (shared.size() == 2) {  // folded onto each other
    const Point &a = points[shared[0]], &b = points[shared[1]], &c = points[others(s)[0]], &d = points[others(t)[0]];
    if (above(a, b, c, d) != 0) return false;
    for (std::size_t drop = 0; drop < 3; ++drop) {
      const auto flat = [&](const Point& v) { return Flat{v[(drop + 1) % 3], v[(drop + 2) % 3]}; };
      const int with = side(flat(a), flat(b), flat(c));
      if (with != 0) return with == side(flat(a), flat(b), flat(d));
    }
    return false;
  }
  const auto edges_meet = [&](const Triangle& u, const Triangle& v) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto from = u[i], to = u[(i + 1) % 3];
      const bool touches_shared = !shared.empty() && (from == shared[0] || to == shared[0]);
      if (!touches_shared && segment_meets_triangle(points[from], points[to], corners(v))) return true;
    }
    return false;
  };
  return edges_meet(s, t) || edges_meet(t, s);
}

auto cross(const Vector& a, const Vector& b) -> Vector {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
auto dot(const Vector& a, const Vector& b) -> double { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
auto unit(Vector a) -> Vector {
  const double l = std::sqrt(dot(a, a));
  for (double& v : a) v /= l;
  return a;
}

/// The least of a symmetric matrix' axes, by Jacobi's turns.
auto least_axis(std::array<Vector, 3> m) -> Vector {
  std::array<Vector, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < 30; ++sweep)
    for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      if (m[p][q] == 0) continue;
      const double angle = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]), c = std::cos(angle), s = std::sin(angle);
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
      }
      for (auto& axis : axes) {
        const double a = axis[p], b = axis[q];
        axis[p] = c * a - s * b, axis[q] = s * a + c * b;
      }
    }
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (m[i][i] < m[least][least]) least = i;
  return unit({axes[0][least], axes[1][least], axes[2][least]});
}

class Judge {
 public:
  Judge(const Json& city, const Tolerances& tolerances)
      : tolerances_(tolerances), scale_(city["transform"]["scale"][0]) {
    for (const auto& v : city["vertices"]) points_.push_back(v.get<Point>());
    if (!points_.empty())
      for (const Point first = points_.front(); Point & p : points_)
        for (std::size_t i = 0; i < 3; ++i) p[i] -= first[i];
  }

  void solid(const Json& shell, const std::string& object) {
    object_ = object;
    const std::size_t before = found.size();
    std::vector<Face> faces = shell.get<std::vector<Face>>();
    triangles_.clear(), face_of_.clear();
    for (std::size_t f = 0; f < faces.size(); ++f) judge_face(faces[f], f);
    if (found.size() > before) return;  // as val3dity: no shell is judged whose faces are broken
    if (faces.size() < 4) return find(301, "fewer than four faces");
    judge_shell(faces);
  }

  std::vector<Finding> found;

 private:
  void find(int code, const std::string& what) { found.push_back({code, object_, what}); }
  [[nodiscard]] auto at(std::size_t v) const -> Vector {
    return {scale_ * static_cast<double>(points_[v][0]), scale_ * static_cast<double>(points_[v][1]),
            scale_ * static_cast<double>(points_[v][2])};
  }

  // ---- a face

  void judge_face(const Face& face, std::size_t number) {
    const std::string name = "face " + std::to_string(number);
    const std::size_t before = found.size();
    for (const Ring& ring : face) {
      if (ring.size() < 3) return find(101, name);
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (points_[ring[i]] == points_[ring[(i + 1) % ring.size()]]) return find(102, name);
    }
    const Vector normal = newell(face[0]);
    if (dot(normal, normal) == 0) return find(104, name + " is a line");
    axis_ = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (std::abs(normal[i]) > std::abs(normal[axis_])) axis_ = i;
    mirrored_ = normal[axis_] < 0;
    std::vector<std::vector<Flat>> rings;
    for (const Ring& ring : face) rings.push_back(flat(ring));
    for (const auto& ring : rings)
      if (crosses_itself(ring)) find(104, name);
    if (found.size() == before) judge_rings(rings, name);
    if (found.size() == before) judge_plane(face, name, number, normal);
  }

  [[nodiscard]] auto newell(const Ring& ring) const -> Vector {
    Vector sum{};
    const Vector o = at(ring[0]);
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const Vector a = at(ring[i]), b = at(ring[i + 1]);
      const Vector c = cross({a[0] - o[0], a[1] - o[1], a[2] - o[2]}, {b[0] - o[0], b[1] - o[1], b[2] - o[2]});
      for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k];
    }
    return sum;
  }

  /// Seen from outside along an axis.
  [[nodiscard]] auto flat(const Ring& ring) const -> std::vector<Flat> {
    std::vector<Flat> out;
    for (const auto v : ring) {
      const auto x = points_[v][(axis_ + 1) % 3], y = points_[v][(axis_ + 2) % 3];
      out.push_back(mirrored_ ? Flat{y, x} : Flat{x, y});
    }
    return out;
  }

  static auto crosses_itself(const std::vector<Flat>& ring) -> bool {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = i + 1; k < n; ++k) {
        const bool next = k == i + 1 || (i == 0 && k == n - 1);
        const auto how = meeting(ring[i], ring[(i + 1) % n], ring[k], ring[(k + 1) % n]);
        if (how == Meeting::overlap || how == Meeting::crossing || (how == Meeting::point && !next)) return true;
      }
    return false;
  }

  void judge_rings(const std::vector<std::vector<Flat>>& rings, const std::string& name) {
    std::vector<std::size_t> set(rings.size());  // rings that touch
    std::iota(set.begin(), set.end(), std::size_t{0});
    const auto root = [&](std::size_t r) {
      while (set[r] != r) r = set[r];
      return r;
    };
    for (std::size_t r = 0; r < rings.size(); ++r)
      for (std::size_t q = r + 1; q < rings.size(); ++q) {
        auto a = rings[r], b = rings[q];
        std::ranges::sort(a), std::ranges::sort(b);
        if (a == b) return find(202, name);
        std::set<Flat> touches;
        for (std::size_t i = 0; i < rings[r].size(); ++i)
          for (std::size_t k = 0; k < rings[q].size(); ++k) {
            const Flat &s = rings[r][i], &t = rings[r][(i + 1) % rings[r].size()], &u = rings[q][k],
                       &v = rings[q][(k + 1) % rings[q].size()];
            const auto how = meeting(s, t, u, v);
            if (how == Meeting::crossing || how == Meeting::overlap) return find(201, name);
            if (how == Meeting::point)
              touches.insert(on_segment(s, t, u) ? u : on_segment(s, t, v) ? v : on_segment(u, v, s) ? s : t);
          }
        for (std::size_t t = 0; t < touches.size(); ++t) {
          if (root(r) == root(q)) return find(205, name);
          set[root(q)] = root(r);
        }
      }
    const auto within = [](const std::vector<Flat>& inner, const std::vector<Flat>& outer) {
      for (const Flat& p : inner)
        if (const int where = place(outer, p); where != 0) return where > 0;
      return true;
    };
    for (std::size_t r = 1; r < rings.size(); ++r) {
      if (!within(rings[r], rings[0])) return find(206, name);
      if (sign(doubled_area(rings[r])) == sign(doubled_area(rings[0]))) return find(208, name);
      for (std::size_t q = 1; q < rings.size(); ++q)
        if (q != r && within(rings[r], rings[q])) return find(207, name);
    }
  }

  void judge_plane(const Face& face, const std::string& name, std::size_t number, Vector normal) {
    std::vector<std::size_t> all;
    for (const Ring& ring : face) all.insert(all.end(), ring.begin(), ring.end());
    Vector middle{};
    for (const auto v : all)
      for (std::size_t k = 0; k < 3; ++k) middle[k] += at(v)[k] / static_cast<double>(all.size());
    std::array<Vector, 3> spread{};
    for (const auto v : all)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) spread[i][k] += (at(v)[i] - middle[i]) * (at(v)[k] - middle[k]);
    Vector plane = least_axis(spread);
    if (dot(plane, normal) < 0)
      for (double& v : plane) v = -v;
    for (const auto v : all) {
      const Vector p = at(v);
      const double off = dot(plane, {p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]});
      if (std::abs(off) > tolerances_.distance) return find(203, name + " by " + std::to_string(off) + " m");
    }
    mansard::geometry::Polygon polygon;
    for (std::size_t r = 0; r < face.size(); ++r) {
      mansard::geometry::Ring ring;
      for (const Flat& p : flat(face[r])) ring.push_back({static_cast<double>(p[0]), static_cast<double>(p[1])});
      if (r == 0) polygon.outer = ring;
      else polygon.holes.push_back(ring);
    }
    const auto triangles = mansard::geometry::triangulate(polygon);
    if (!triangles) return find(104, name + " cannot be cut into triangles");
    for (const auto& [a, b, c] : *triangles) {
      const Triangle triangle{all[a], all[b], all[c]};
      const Vector n = newell({triangle.begin(), triangle.end()});
      const double cosine = dot(n, plane) / std::sqrt(dot(n, n));
      if (!(cosine >= std::cos(tolerances_.angle * M_PI / 180))) return find(204, name);
      triangles_.push_back(triangle);
      face_of_.push_back(number);
    }
  }

  // ---- a shell

  void judge_shell(const std::vector<Face>& faces) {
    const std::size_t before = found.size();
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> walked;  // by face
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (const Ring& ring : faces[f])
        for (std::size_t i = 0; i < ring.size(); ++i) walked[{ring[i], ring[(i + 1) % ring.size()]}].push_back(f);
    std::map<std::pair<std::size_t, std::size_t>, std::pair<std::size_t, std::size_t>> lines;  // there, back
    for (const auto& [edge, by] : walked) {
      auto& [there, back] = lines[std::minmax({edge.first, edge.second})];
      (edge.first < edge.second ? there : back) += by.size();
    }
    std::set<int> codes;
    for (const auto& [line, count] : lines) {
      const auto [there, back] = count;
      if (there + back == 1) codes.insert(302);
      else if (there + back > 2) codes.insert(303);
      else if (there != back) codes.insert(307);
    }
    for (const int code : codes) find(code, "edges");
    if (found.size() > before) return;
    judge_connection(faces, walked);
    if (found.size() == before) judge_vertices(faces);
    if (found.size() == before) judge_meetings();
    if (found.size() == before && volume() <= 0) find(307, "the shell is inside out");
  }

  using Walked = std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>>;
  void judge_connection(const std::vector<Face>& faces, const Walked& walked) {
    std::vector<bool> seen(faces.size());
    std::vector<std::size_t> due{0};
    seen[0] = true;
    while (!due.empty()) {
      const std::size_t f = due.back();
      due.pop_back();
      for (const Ring& ring : faces[f])
        for (std::size_t i = 0; i < ring.size(); ++i)
          for (const std::size_t g : walked.at({ring[(i + 1) % ring.size()], ring[i]}))
            if (!seen[g]) seen[g] = true, due.push_back(g);
    }
    if (std::ranges::find(seen, false) != seen.end()) find(305, "more than one shell");
  }

  /// Around every vertex the corners, each from the edge that comes to the edge that goes, must make one circle.
  void judge_vertices(const std::vector<Face>& faces) {
    std::map<std::size_t, std::map<std::size_t, std::size_t>> corners;  // vertex → where it goes → where it came from
    for (const Face& face : faces)
      for (const Ring& ring : face)
        for (std::size_t i = 0; i < ring.size(); ++i)
          corners[ring[i]][ring[(i + 1) % ring.size()]] = ring[(i + ring.size() - 1) % ring.size()];
    for (const auto& [vertex, turns] : corners) {
      std::size_t steps = 0;
      const std::size_t first = turns.begin()->first;
      for (std::size_t on = first; steps == 0 || on != first; ++steps) on = turns.at(on);
      if (steps != turns.size()) return find(303, "vertex " + std::to_string(vertex));
    }
  }

  void judge_meetings() {
    const auto range = [&](const Triangle& t, std::size_t axis) {
      return std::minmax({points_[t[0]][axis], points_[t[1]][axis], points_[t[2]][axis]});
    };
    std::vector<std::size_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t t) { return range(triangles_[t], 0).first; });
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t k = i + 1; k < order.size(); ++k) {
        const std::size_t s = order[i], t = order[k];
        if (range(triangles_[t], 0).first > range(triangles_[s], 0).second) break;
        if (face_of_[s] == face_of_[t]) continue;
        bool apart = false;
        for (const std::size_t axis : {1U, 2U}) {
          const auto a = range(triangles_[s], axis), b = range(triangles_[t], axis);
          apart = apart || a.second < b.first || b.second < a.first;
        }
        if (!apart && triangles_meet(points_, triangles_[s], triangles_[t]))
          return find(306, "faces " + std::to_string(face_of_[s]) + " and " + std::to_string(face_of_[t]));
      }
  }

  [[nodiscard]] auto volume() const -> double {
    double six = 0;
    for (const auto& [a, b, c] : triangles_) six += dot(at(a), cross(at(b), at(c)));
    return six / 6;
  }

  const Tolerances tolerances_;
  const double scale_;
  std::vector<Point> points_;
  std::string object_;
  std::size_t axis_ = 0;
  bool mirrored_ = false;
  std::vector<Triangle> triangles_;
  std::vector<std::size_t> face_of_;
};

/// A solid as it stands on the ground.
struct Standing {
  std::string key, building;
  mansard::geometry::Polygon plan;
  mansard::geometry::Box2 box;
  double low = 0, high = 0;
};

auto standing(const Json& city, const std::string& key, const Json& geometry) -> Standing {
  const auto at = [&](std::size_t v, std::size_t k) {
    return city["vertices"][v][k].get<double>() * city["transform"]["scale"][k].get<double>();
  };
  Standing out{key, key, {}, {}, 1e9, -1e9};
  if (city["CityObjects"][key].contains("parents")) out.building = city["CityObjects"][key]["parents"][0];
  const auto& shell = geometry["boundaries"][0];
  for (std::size_t f = 0; f < shell.size(); ++f) {
    for (const auto& ring : shell[f])
      for (const std::size_t v : ring) out.low = std::min(out.low, at(v, 2)), out.high = std::max(out.high, at(v, 2));
    const auto& surface = geometry["semantics"]["surfaces"][geometry["semantics"]["values"][0][f].get<std::size_t>()];
    if (surface["type"] != "GroundSurface") continue;
    for (std::size_t r = 0; r < shell[f].size(); ++r) {
      mansard::geometry::Ring ring;
      for (const std::size_t v : shell[f][r]) ring.push_back({at(v, 0), at(v, 1)});
      if (r == 0) out.plan.outer = ring;
      else out.plan.holes.push_back(ring);
    }
  }
  out.plan = mansard::geometry::oriented(out.plan);
  out.box = mansard::geometry::bounds(out.plan.outer);
  return out;
}

}  // namespace

auto findings(const Json& city, const Tolerances& tolerances) -> std::vector<Finding> {
  Judge judge(city, tolerances);
  for (const auto& [key, object] : city["CityObjects"].items())
    if (object.contains("geometry"))
      for (const auto& geometry : object["geometry"])
        if (geometry["type"] == "Solid")
          for (const auto& shell : geometry["boundaries"]) judge.solid(shell, key);
  return judge.found;
}

auto overlaps(const Json& city, const std::string& lod, double least) -> std::vector<Overlap> {
  std::vector<Standing> all;
  for (const auto& [key, object] : city["CityObjects"].items())
    if (object.contains("geometry"))
      for (const auto& geometry : object["geometry"])
        if (geometry["type"] == "Solid" && geometry["lod"] == lod) all.push_back(standing(city, key, geometry));
  std::vector<Overlap> found;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      const double height = std::min(all[i].high, all[k].high) - std::max(all[i].low, all[k].low);
      if (height <= 0 || !all[i].box.overlaps(all[k].box)) continue;
      const auto shared = mansard::geometry::intersect(all[i].plan, all[k].plan);
      double area = 0, width = 0;
      if (shared)
        for (const auto& polygon : *shared) {
          const double one = mansard::geometry::area(polygon);
          area += one;
          width = std::max(width, 2 * one / mansard::geometry::perimeter(polygon.outer));
        }
      if (area * height > least)
        found.push_back(
            {all[i].building == all[k].building ? 601 : 501, all[i].key, all[k].key, area, area * height, width});
    }
  return found;
}

}  // namespace val3dity
