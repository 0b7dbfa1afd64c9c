// Each row of eaves is an edit of the loops around it: the roof's corners move outward and down to the edge of the
// roof, the wall's move down to the soffit, and a soffit (and at an end that no gable closes, a small upright face)
// fills what opens between them.
//
//          R                      a: a corner of the eaves, where wall and roof meet
//         /                       a' = out, at the edge of the roof
//        a                        a" = under, on the wall below a, at the height of a'
//       /|
//     a'-a"
//        |  W
#include "mansard/solid/eaves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "mansard/model/file_grid.hpp"
#include "mansard/solid/half_edges.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::solid {
namespace {

using geometry::Point2;
using geometry::Point3;
using model::FaceClass;
using model::LabelledSolid;

constexpr double per_metre = model::quanta_per_metre;
constexpr double level = 0.5;        // quanta; corners are multiples of one
constexpr double upright = 0.02;     // sine of the lean of a wall: what rounding makes of one, and no more
constexpr double beside = 0.08;      // m; walls are on the line of their edge, within the tolerance of the extrusion
constexpr double aligned = 0.03;     // sine of the angle between a wall and its edge
constexpr double shallowest = 0.05;  // slope; flatter roofs have no eaves
constexpr double least_drop = 0.02;  // m; less is no soffit but a crack
constexpr double same_drop = 0.05;   // m; between neighbouring eaves that have one soffit
constexpr double mitre = 4;          // times the overhang, as extrude.eaves_mitre
constexpr double across = 0.5;       // sine of the angle between a wall and the gable at its end

/// In quanta from a corner of the solid, so that a shift by whole metres changes nothing.
class Places {
 public:
  explicit Places(const model::Solid& solid) : solid_(solid) {
    if (solid.vertices.empty()) return;
    const Point3 v = solid.vertices.front();
    origin_ = {whole(v.x), whole(v.y), whole(v.z)};
  }
  [[nodiscard]] auto at(Point3 p) const -> Point3 {
    return {static_cast<double>(whole(p.x) - origin_[0]), static_cast<double>(whole(p.y) - origin_[1]),
            static_cast<double>(whole(p.z) - origin_[2])};
  }
  [[nodiscard]] auto at(std::uint32_t vertex) const -> Point3 { return at(solid_.vertices[vertex]); }
  [[nodiscard]] auto back(Point3 p) const -> Point3 {
    const auto metres = [&](double value, std::size_t axis) {
      return static_cast<double>(static_cast<std::int64_t>(std::floor(value + 0.5)) + origin_[axis]) / per_metre;
    };
    return {metres(p.x, 0), metres(p.y, 1), metres(p.z, 2)};
  }

 private:
  static auto whole(double metres) -> std::int64_t { return std::llround(metres * per_metre); }
  const model::Solid& solid_;
  std::array<std::int64_t, 3> origin_{};
};

/// One edge between a wall and the roof that rises from it, as the roof walks it: the building is on the left.
struct Eave {
  std::uint32_t half_edge = 0;  ///< the roof's
  std::uint32_t from = 0, to = 0, roof = 0, wall = 0;
  Point2 along, out;  ///< unit
  double length = 0;  ///< quanta
  double slope = 0;
  double drop = 0;  ///< quanta; wanted
  std::size_t wanted = 0;
};

/// A row of eaves with one soffit.
struct Row {
  std::vector<Eave> eaves;
  bool closed = false;  ///< around a building or a courtyard
  double drop = 0;      ///< quanta
  [[nodiscard]] auto length() const -> double {
    double sum = 0;
    for (const Eave& eave : eaves) sum += eave.length;
    return sum;
  }
};

auto is_upright(const model::Face& face) -> bool { return std::abs(face.normal.z) < upright; }

/// Corners that have given way.
void drop_unused(model::Solid& solid) {
  std::vector<std::uint32_t> number(solid.vertices.size(), 0);
  for (const auto& face : solid.faces)
    for (const auto& loop : face.loops)
      for (const auto v : loop) number[v] = 1;
  std::vector<Point3> kept;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    number[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(solid.vertices[v]);
  }
  for (auto& face : solid.faces)
    for (auto& loop : face.loops)
      for (auto& v : loop) v = number[v];
  solid.vertices = std::move(kept);
}

class Edit {
 public:
  Edit(const LabelledSolid& solid, const HalfEdges& edges)
      : solid_(solid), edges_(edges), places_(solid.solid), made_(solid) {}

  /// The roofs' edges over walls in the open that are wanted, by half-edge.
  [[nodiscard]] auto eaves(std::span<const Eaves> wanted) const -> std::vector<Eave> {
    std::vector<Eave> out;
    for (std::uint32_t h = 0; h < edges_.size(); ++h)
      if (auto eave = eave_at(h, wanted)) out.push_back(*eave);
    return out;
  }

  /// Rows of eaves that follow each other, parted where their soffits are not at one height.
  [[nodiscard]] auto rows(const std::vector<Eave>& eaves) const -> std::vector<Row> {
    const auto starts_at = [&](std::uint32_t vertex) -> const Eave* {
      const Eave* found = nullptr;
      for (const Eave& eave : eaves)
        if (eave.from == vertex) {
          if (found != nullptr) return nullptr;
          found = &eave;
        }
      return found;
    };
    const auto follows = [&](const Eave& eave) -> const Eave* {
      const Eave* next = starts_at(eave.to);
      if (next == nullptr || std::abs(next->drop - eave.drop) > same_drop * per_metre) return nullptr;
      return turns(eave, *next, std::max(eave.drop, next->drop)) ? next : nullptr;
    };
    std::set<std::uint32_t> followed, used;
    for (const Eave& eave : eaves)
      if (const Eave* next = follows(eave)) followed.insert(next->half_edge);
    std::vector<Row> out;
    const auto walk = [&](const Eave& first) {
      Row row;
      const Eave* at = &first;
      while (at != nullptr && used.insert(at->half_edge).second) {
        row.eaves.push_back(*at);
        at = follows(*at);
      }
      row.closed = at == &first;
      double sum = 0;
      for (const Eave& eave : row.eaves) sum += eave.drop * eave.length;
      row.drop = std::floor(sum / row.length() + 0.5);
      if (row.drop >= least_drop * per_metre) out.push_back(std::move(row));
    };
    for (const Eave& eave : eaves)
      if (!followed.contains(eave.half_edge)) walk(eave);
    for (const Eave& eave : eaves)
      if (!used.contains(eave.half_edge)) walk(eave);
    return out;
  }

  /// Nothing, and why, where the row's surroundings do not allow for it.
  [[nodiscard]] auto with(const Row& row, std::string& why) -> std::optional<LabelledSolid> {
    row_ = &row;
    const std::size_t n = row.eaves.size(), corners = row.closed ? n : n + 1;
    outer_.assign(corners, 0);
    under_.assign(corners, 0);
    for (std::size_t i = 0; i < corners; ++i) under_[i] = add(lowered(vertex(i)));
    for (std::size_t i = row.closed ? 0 : 1; i < n; ++i)
      if (!turn(i)) return why = "another face meets the eaves in the middle", std::nullopt;
    if (!row.closed && (!end(0) || !end(n))) return why = "something meets the end of the eaves", std::nullopt;
    close();
    return std::move(made_);
  }

 private:
  [[nodiscard]] auto class_of(std::uint32_t face) const -> FaceClass { return solid_.classes[face]; }
  [[nodiscard]] auto face(std::uint32_t f) const -> const model::Face& { return solid_.solid.faces[f]; }

  [[nodiscard]] auto eave_at(std::uint32_t h, std::span<const Eaves> wanted) const -> std::optional<Eave> {
    Eave out;
    out.half_edge = h;
    out.from = edges_.origin[h];
    out.to = edges_.target(h);
    out.roof = edges_.face[h];
    out.wall = edges_.face[edges_.twin[h]];
    if (class_of(out.roof) != FaceClass::roof || class_of(out.wall) != FaceClass::wall) return std::nullopt;
    if (!is_upright(face(out.wall))) return std::nullopt;
    const Point3 a = places_.at(out.from), b = places_.at(out.to), normal = face(out.roof).normal;
    if (std::abs(a.z - b.z) > level || a == b || normal.z <= 0) return std::nullopt;
    out.length = length(xy(b) - xy(a));
    out.along = (1 / out.length) * (xy(b) - xy(a));
    out.out = {out.along.y, -out.along.x};
    out.slope = dot(xy(normal), out.out) / normal.z;  // up inward where the normal leans outward
    if (out.slope < shallowest || dot(xy(face(out.wall).normal), out.out) < 0.99) return std::nullopt;
    // Of several edges on one line, that over which the middle of the eaves is.
    const Point2 middle = 0.5 * (xy(solid_.solid.vertices[out.from]) + xy(solid_.solid.vertices[out.to]));
    double nearest = beside;
    bool any = false;
    for (std::size_t w = 0; w < wanted.size(); ++w) {
      const Point2 way = wanted[w].to - wanted[w].from;
      const double far = length(way);
      if (!(far > 0) || !(wanted[w].overhang > 0)) continue;
      const Point2 unit = (1 / far) * way;
      const double on = dot(middle - wanted[w].from, unit), off = std::abs(cross(unit, middle - wanted[w].from));
      if (dot(unit, out.along) <= 0 || std::abs(cross(unit, out.along)) > aligned) continue;
      if (on < -beside || on > far + beside || off > nearest) continue;
      nearest = off;
      any = true;
      out.wanted = w;
      out.drop = wanted[w].overhang * out.slope * per_metre;
    }
    if (!any) return std::nullopt;
    return out;
  }

  /// Where the edges of two roofs meet, in plan, that drop by as much; nothing where that is too far out.
  [[nodiscard]] auto turns(const Eave& before, const Eave& after, double drop) const -> std::optional<Point2> {
    const double p = drop / before.slope, q = drop / after.slope;
    const Point2 corner = xy(places_.at(after.from));
    const double sine = cross(before.along, after.along);
    Point2 by;
    if (std::abs(sine) < aligned) {
      if (dot(before.along, after.along) < 0 || std::abs(p - q) > 2 * level) return std::nullopt;
      by = 0.5 * (p * before.out + q * after.out);
    } else {
      // x·out1 = p and x·out2 = q; the outward normals turn as the edges do.
      by = {(p * after.out.y - q * before.out.y) / sine, (q * before.out.x - p * after.out.x) / sine};
    }
    if (length(by) > mitre * std::max(p, q)) return std::nullopt;
    return corner + by;
  }

  [[nodiscard]] auto vertex(std::size_t i) const -> std::uint32_t {
    return i < row_->eaves.size() ? row_->eaves[i].from : row_->eaves.back().to;
  }
  [[nodiscard]] auto soffit() const -> double { return places_.at(row_->eaves.front().from).z - row_->drop; }
  [[nodiscard]] auto lowered(std::uint32_t v) const -> Point3 {
    const Point3 p = places_.at(v);
    return {p.x, p.y, soffit()};
  }
  auto add(Point3 place) -> std::uint32_t {
    made_.solid.vertices.push_back(places_.back(place));
    return static_cast<std::uint32_t>(made_.solid.vertices.size() - 1);
  }

  /// The faces around a vertex, each once.
  [[nodiscard]] auto around(std::uint32_t v) const -> std::set<std::uint32_t> {
    std::set<std::uint32_t> out;
    std::uint32_t h = edges_.leaving[v];
    do {
      out.insert(edges_.face[h]);
      h = edges_.next[edges_.twin[h]];
    } while (h != edges_.leaving[v]);
    return out;
  }

  /// In every loop of the face: a vertex gives way to others.
  void put(std::uint32_t f, std::uint32_t v, const std::vector<std::uint32_t>& others) {
    for (auto& loop : made_.solid.faces[f].loops)
      if (const auto at = std::ranges::find(loop, v); at != loop.end()) {
        const auto place = loop.erase(at);
        loop.insert(place, others.begin(), others.end());
      }
  }
  /// `other` after `v` in the loop in which `then` follows it.
  void put_between(std::uint32_t f, std::uint32_t v, std::uint32_t then, std::uint32_t other) {
    for (auto& loop : made_.solid.faces[f].loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (loop[i] == v && loop[(i + 1) % loop.size()] == then) {
          loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(i) + 1, other);
          return;
        }
  }

  /// A corner between two eaves of the row.
  auto turn(std::size_t i) -> bool {
    const Eave &after = row_->eaves[i], &before = row_->eaves[(i + row_->eaves.size() - 1) % row_->eaves.size()];
    const auto out = turns(before, after, row_->drop);
    if (!out) return false;
    const std::uint32_t v = after.from;
    for (const auto f : around(v))
      if (f != before.roof && f != after.roof && f != before.wall && f != after.wall) return false;
    outer_[i] = add({out->x, out->y, soffit()});
    for (const auto f : {before.roof, after.roof}) put(f, v, {outer_[i]});
    for (const auto f : {before.wall, after.wall}) put(f, v, {under_[i]});
    return true;
  }

  /// The first corner of a row that is not closed, or its last.
  auto end(std::size_t i) -> bool {
    const bool first = i == 0;
    const Eave& eave = first ? row_->eaves.front() : row_->eaves.back();
    const std::uint32_t v = vertex(i);
    const auto faces = around(v);
    if (faces.size() == 3)
      for (const auto f : faces)
        if (f != eave.roof && f != eave.wall && class_of(f) == FaceClass::wall && is_upright(face(f)))
          if (const auto done = in_plane_of(f, eave, i)) return *done;
    return across_wall(eave, i);
  }

  /// In the plane of the gable, or of a wall that comes outward: that face goes on below the roof. Nothing where the
  /// wall's own line is too near to that of the face.
  auto in_plane_of(std::uint32_t gable, const Eave& eave, std::size_t i) -> std::optional<bool> {
    const bool first = i == 0;
    const Point2 normal = (1 / length(xy(face(gable).normal))) * xy(face(gable).normal);
    const Point2 along{-normal.y, normal.x};
    const double sine = dot(along, eave.out);  // how much outward the gable's line goes
    if (std::abs(sine) < across) return std::nullopt;
    const Point2 corner = xy(places_.at(vertex(i)));
    const Point2 out = corner + (row_->drop / eave.slope / sine) * along;
    const std::uint32_t v = vertex(i);
    outer_[i] = add({out.x, out.y, soffit()});
    put(eave.roof, v, {outer_[i]});
    put(eave.wall, v, {under_[i]});
    put(gable, v, first ? std::vector{under_[i], outer_[i]} : std::vector{outer_[i], under_[i]});
    return true;
  }

  /// Upright and at right angles to the wall, by a face of its own.
  auto across_wall(const Eave& eave, std::size_t i) -> bool {
    const bool first = i == 0;
    const std::uint32_t v = vertex(i), under = under_[i];
    const Point3 corner = places_.at(v);
    const Point2 out = xy(corner) + (row_->drop / eave.slope) * eave.out;
    const std::uint32_t outer = outer_[i] = add({out.x, out.y, soffit()});
    // The wall's edge at v that is not the eaves.
    const std::uint32_t top = edges_.twin[eave.half_edge];
    std::uint32_t beyond = 0, other = 0;  // the vertex there, and the face on the other side
    if (first) {
      const std::uint32_t h = edges_.next[top];
      beyond = edges_.target(h);
      other = edges_.face[edges_.twin[h]];
    } else {
      std::uint32_t h = edges_.next[top];
      while (edges_.next[h] != top) h = edges_.next[h];
      beyond = edges_.origin[h];
      other = edges_.face[edges_.twin[h]];
    }
    const Point3 b = places_.at(beyond);
    if (length(xy(b) - xy(corner)) < 2) {  // straight down; two quanta as rounding has it
      if (b.z >= soffit() - model::least_apart) return false;
      put(eave.wall, v, {under});
      if (first) put_between(other, beyond, v, under);
      else put_between(other, v, beyond, under);
    } else {
      put(eave.wall, v, first ? std::vector{under, v} : std::vector{v, under});
    }
    put(eave.roof, v, first ? std::vector{v, outer} : std::vector{outer, v});
    model::Face side;
    side.kind = model::FaceKind::connector;
    side.loops = {first ? std::vector{outer, v, under} : std::vector{v, outer, under}};
    const Point2 away = first ? -1 * eave.along : eave.along;
    side.normal = {away.x, away.y, 0};
    made_.solid.faces.push_back(std::move(side));
    made_.classes.push_back(FaceClass::wall);
    return true;
  }

  void close() {
    model::Face face;
    face.kind = model::FaceKind::soffit;
    face.normal = {0, 0, -1};
    std::vector<std::uint32_t> inner = under_, outer(outer_.rbegin(), outer_.rend());
    if (!row_->closed) {
      inner.insert(inner.end(), outer.begin(), outer.end());
      face.loops = {std::move(inner)};
    } else {
      const auto area = [&](const std::vector<std::uint32_t>& loop) {
        double sum = 0;
        for (std::size_t i = 0; i < loop.size(); ++i)
          sum += cross(xy(places_.at(made_.solid.vertices[loop[i]])),
                       xy(places_.at(made_.solid.vertices[loop[(i + 1) % loop.size()]])));
        return std::abs(sum);
      };
      face.loops = {std::move(outer), std::move(inner)};
      if (area(face.loops[0]) < area(face.loops[1])) std::swap(face.loops[0], face.loops[1]);  // around a courtyard
    }
    made_.solid.faces.push_back(std::move(face));
    made_.classes.push_back(FaceClass::soffit);
    drop_unused(made_.solid);
  }

  const LabelledSolid& solid_;
  const HalfEdges& edges_;
  Places places_;
  LabelledSolid made_;
  const Row* row_ = nullptr;
  std::vector<std::uint32_t> outer_, under_;  ///< by corner of the row
};

/// The rows of a solid that are wanted, with the longest first.
auto rows_of(const LabelledSolid& solid, std::span<const Eaves> wanted) -> std::vector<Row> {
  const auto edges = half_edges(solid.solid);
  if (!edges) return {};
  const Edit edit(solid, *edges);
  auto rows = edit.rows(edit.eaves(wanted));
  std::ranges::stable_sort(rows, std::greater<>(), &Row::length);
  return rows;
}

/// One row more; nothing, and why, where that cannot be.
auto with_row(const LabelledSolid& solid, const Row& row, std::string& why) -> std::optional<LabelledSolid> {
  const auto edges = half_edges(solid.solid);
  if (!edges) return why = edges.error().message, std::nullopt;
  return Edit(solid, *edges).with(row, why);
}

auto is_valid(const LabelledSolid& solid, std::string& why) -> bool {
  const auto faults = check(solid.solid, written_rules());
  if (!faults.empty()) why = "they would not be valid: " + faults.front().message;
  return faults.empty();
}

/// The corners of a soffit at the edges of roofs, each with the one on the wall that it belongs to. Nothing for what
/// with_eaves() does not make.
auto pairs_of(const LabelledSolid& solid, const HalfEdges& edges, std::uint32_t face)
    -> std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> {
  std::vector<std::vector<std::uint32_t>> loops;  // half-edges
  std::vector<std::vector<bool>> at_roof;
  const auto last = face + 1 < edges.first_loop_of_face.size()
                        ? edges.first_loop_of_face[face + 1]
                        : static_cast<std::uint32_t>(edges.first_of_loop.size() - 1);
  for (auto l = edges.first_loop_of_face[face]; l < last; ++l) {
    auto& loop = loops.emplace_back();
    auto& roofs = at_roof.emplace_back();
    for (auto h = edges.first_of_loop[l]; h < edges.first_of_loop[l + 1]; ++h) {
      loop.push_back(h);
      roofs.push_back(solid.classes[edges.face[edges.twin[h]]] == FaceClass::roof);
    }
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
  if (loops.size() == 1) {
    // Along the roofs' edges, and back along the walls.
    const std::size_t n = loops[0].size();
    const auto& roofs = at_roof[0];
    std::size_t first = n, runs = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (roofs[i] && !roofs[(i + n - 1) % n]) first = i, ++runs;
    const auto count = static_cast<std::size_t>(std::ranges::count(roofs, true));
    if (runs != 1 || 2 * (count + 1) != n) return std::nullopt;
    for (std::size_t j = 0; j <= count; ++j)
      out.emplace_back(edges.origin[loops[0][(first + j) % n]], edges.origin[loops[0][(first + n - 1 - j) % n]]);
    return out;
  }
  if (loops.size() != 2 || loops[0].size() != loops[1].size()) return std::nullopt;
  const std::size_t outer = at_roof[0][0] ? 0 : 1, n = loops[0].size();
  if (std::ranges::count(at_roof[outer], true) != std::ssize(at_roof[outer])) return std::nullopt;
  if (std::ranges::count(at_roof[1 - outer], true) != 0) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t shift = 0; shift < n; ++shift) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> some;
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      some.emplace_back(edges.origin[loops[outer][j]], edges.origin[loops[1 - outer][(shift + n - j) % n]]);
      sum += length(solid.solid.vertices[some.back().first] - solid.solid.vertices[some.back().second]);
    }
    if (sum < least) least = sum, out = std::move(some);
  }
  return out;
}

/// The corners of a loop with some of them given way to others, and no corner twice in a row.
auto renamed(const std::vector<std::uint32_t>& loop, const std::vector<std::uint32_t>& now)
    -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> out;
  for (const auto v : loop)
    if (out.empty() || out.back() != now[v]) out.push_back(now[v]);
  while (out.size() > 1 && out.back() == out.front()) out.pop_back();
  return out;
}

}  // namespace

auto without_eaves(const LabelledSolid& solid) -> LabelledSolid {
  if (std::ranges::find(solid.classes, FaceClass::soffit) == solid.classes.end()) return solid;
  const auto edges = half_edges(solid.solid);
  if (!edges) return solid;
  const Places places(solid.solid);
  LabelledSolid made = solid;
  std::vector<std::uint32_t> now(solid.solid.vertices.size());
  std::iota(now.begin(), now.end(), 0U);
  for (std::uint32_t f = 0; f < solid.classes.size(); ++f) {
    if (solid.classes[f] != FaceClass::soffit) continue;
    const auto pairs = pairs_of(solid, *edges, f);
    if (!pairs) return solid;
    for (const auto& [outer, under] : *pairs) {
      // The roof that has its edge there.
      std::uint32_t h = edges->leaving[outer];
      while (solid.classes[edges->face[h]] != FaceClass::roof) {
        h = edges->next[edges->twin[h]];
        if (h == edges->leaving[outer]) return solid;
      }
      const Point3 normal = solid.solid.faces[edges->face[h]].normal, from = places.at(outer), foot = places.at(under);
      const double rise = -(normal.x * (foot.x - from.x) + normal.y * (foot.y - from.y)) / normal.z;
      const Point3 top{foot.x, foot.y, std::floor(from.z + rise + 0.5)};
      // At an end across the wall that corner is still there.
      now[under] = under;
      for (std::uint32_t v = 0; v < now.size(); ++v)
        if (const Point3 p = places.at(v);
            v != under && v != outer && p.x == top.x && p.y == top.y && std::abs(p.z - top.z) <= 3)
          now[under] = v;
      if (now[under] == under) made.solid.vertices[under] = places.back(top);
      now[outer] = now[under];
    }
  }
  std::vector<model::Face> faces;
  std::vector<FaceClass> classes;
  for (std::uint32_t f = 0; f < solid.classes.size(); ++f) {
    if (solid.classes[f] == FaceClass::soffit) continue;
    model::Face face = made.solid.faces[f];
    for (auto& loop : face.loops) loop = renamed(loop, now);
    if (face.loops.front().size() < 3) continue;
    faces.push_back(std::move(face));
    classes.push_back(solid.classes[f]);
  }
  made.solid.faces = std::move(faces);
  made.classes = std::move(classes);
  drop_unused(made.solid);
  std::string why;
  return is_valid(made, why) ? made : solid;
}

auto with_eaves(const LabelledSolid& solid, std::span<const Eaves> wanted) -> WithEaves {
  WithEaves out{solid, std::vector<bool>(wanted.size(), false), {}};
  // One row at a time, found anew: the faces around a corner change with the rows that meet it.
  std::set<std::pair<Point3, Point3>> tried;  // by their ends: numbers of corners change
  const auto ends_of = [](const Row& row, const LabelledSolid& of) {
    return std::pair(of.solid.vertices[row.eaves.front().from], of.solid.vertices[row.eaves.back().to]);
  };
  const auto leave = [&](const std::string& why) {
    if (std::ranges::find(out.left, why) == out.left.end()) out.left.push_back(why);
  };
  for (bool checked = false;;) {
    LabelledSolid at = solid;
    std::vector<std::size_t> done;
    std::vector<std::string> reasons;
    tried.clear();
    for (bool more = true; more;) {
      more = false;
      for (const Row& row : rows_of(at, wanted)) {
        if (!tried.insert(ends_of(row, at)).second) continue;
        std::string why;
        auto next = with_row(at, row, why);
        if (next && checked && !is_valid(*next, why)) next.reset();
        if (!next) {
          reasons.push_back(why);
          continue;
        }
        at = std::move(*next);
        for (const Eave& eave : row.eaves) done.push_back(eave.wanted);
        more = true;
        break;
      }
    }
    std::string why;
    if (!done.empty() && !checked && !is_valid(at, why)) {
      checked = true;  // each by itself
      continue;
    }
    out.model = std::move(at);
    for (const auto w : done) out.made[w] = true;
    for (const auto& reason : reasons) leave(reason);
    return out;
  }
}

}  // namespace mansard::solid
