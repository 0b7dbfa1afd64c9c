// Terrain and buildings as one closed surface.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/unite.hpp"
#include "mansard/terrain/terrain.hpp"

namespace mansard::terrain {
namespace {

using geometry::Point3;
using model::FaceClass;
using model::LabelledSolid;
using Flat = std::array<std::int64_t, 2>;

constexpr double scale = model::quanta_per_metre;

auto place_of(Point3 p) -> Place {
  return {std::llround(p.x * scale), std::llround(p.y * scale), std::llround(p.z * scale)};
}
auto flat(const Place& p) -> Flat { return {p[0], p[1]}; }
auto metres(const Place& p) -> Point3 {
  return {static_cast<double>(p[0]) / scale, static_cast<double>(p[1]) / scale, static_cast<double>(p[2]) / scale};
}

/// Faces without the ground, and the rings that the terrain meets.
struct Shell {
  std::vector<std::vector<std::vector<Place>>> faces;  ///< loops
  std::vector<Point3> normals;
  Ground ground;
};

/// The models of one building.
struct Models {
  std::string id;
  std::vector<LabelledSolid> solids;
};

auto models_of(const model::Building& building) -> Models {
  Models out{building.id, {}};
  if (!building.solids.empty()) {
    for (const auto& solid : building.solids) out.solids.push_back(solid.model);
    return out;
  }
  std::vector<const LabelledSolid*> parts;
  for (const auto& part : building.parts)
    if (!part.model.solid.faces.empty()) parts.push_back(&part.model);
  if (!parts.empty())
    for (auto& one : solid::unite(parts).solids) out.solids.push_back(std::move(one.model));
  return out;
}

/// An edge of the ground of a building.
struct Foot {
  Flat from{}, to{};
  std::int64_t z = 0;
  std::size_t owner = 0;

  [[nodiscard]] auto along(const Flat& p) const -> std::int64_t {
    return (to[0] - from[0]) * (p[0] - from[0]) + (to[1] - from[1]) * (p[1] - from[1]);
  }
  [[nodiscard]] auto aside(const Flat& p) const -> std::int64_t {
    return (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0]);
  }
};

class Feet {
 public:
  explicit Feet(std::span<const Ground> grounds) {
    std::vector<geometry::Box2> boxes;
    for (std::size_t g = 0; g < grounds.size(); ++g)
      for (const auto& ring : grounds[g].rings)
        for (std::size_t i = 0; i < ring.corners.size(); ++i) {
          feet_.push_back({ring.corners[i], ring.corners[(i + 1) % ring.corners.size()], ring.heights[i], g});
          boxes.push_back(box_of(feet_.back().from, feet_.back().to));
        }
    index_ = geometry::BoxIndex(boxes);
  }
  [[nodiscard]] static auto box_of(const Flat& a, const Flat& b) -> geometry::Box2 {
    geometry::Box2 box;
    for (const auto& end : {a, b}) box.add({static_cast<double>(end[0]), static_cast<double>(end[1])});
    return box;
  }
  [[nodiscard]] auto all() const -> const std::vector<Foot>& { return feet_; }
  [[nodiscard]] auto near(const Flat& a, const Flat& b) const -> std::vector<std::uint32_t> {
    return index_.overlapping(box_of(a, b).grown(2));  // units: rounding
  }

 private:
  std::vector<Foot> feet_;
  geometry::BoxIndex index_;
};

/// Grounds that have a corner in common, or one on an edge of another.
auto groups_of(const Feet& feet, std::size_t count) -> std::vector<std::vector<std::size_t>> {
  base::DisjointSets sets(count);
  for (const auto& foot : feet.all())
    for (const auto other : feet.near(foot.from, foot.to)) {
      const auto& o = feet.all()[other];
      if (o.owner == foot.owner || foot.aside(o.from) != 0) continue;
      if (const auto at = foot.along(o.from); at >= 0 && at <= foot.along(foot.to))
        sets.join(static_cast<std::uint32_t>(std::max(o.owner, foot.owner)),
                  static_cast<std::uint32_t>(std::min(o.owner, foot.owner)));
    }
  std::map<std::uint32_t, std::vector<std::size_t>> groups;
  for (std::size_t g = 0; g < count; ++g) groups[sets.of(static_cast<std::uint32_t>(g))].push_back(g);
  std::vector<std::vector<std::size_t>> out;
  for (auto& [first, members] : groups) out.push_back(std::move(members));
  return out;
}

/// The same solid with all its ground at one height, below everything: its walls go down to there.
auto lowered(const LabelledSolid& model, double z) -> LabelledSolid {
  LabelledSolid out = model;
  std::set<std::uint32_t> ground;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f)
    if (model.classes[f] == FaceClass::ground)
      for (const auto& loop : model.solid.faces[f].loops) ground.insert(loop.begin(), loop.end());
  for (const auto v : ground) out.solid.vertices[v].z = z;
  out.solid.faces.clear();
  out.classes.clear();
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    const auto& face = model.solid.faces[f];
    // Walls between grounds of two heights have nothing above the lower one now.
    const bool flat_now = model.classes[f] != FaceClass::ground &&
                          std::ranges::all_of(face.loops.front(), [&](auto v) { return ground.contains(v); });
    if (flat_now) continue;
    out.solid.faces.push_back(face);
    // Walls that were rounded to the grid may lean by less than that; a union takes those that lean out for eaves.
    auto& normal = out.solid.faces.back().normal;
    const bool wall = model.classes[f] == FaceClass::wall || model.classes[f] == FaceClass::party_wall;
    constexpr double lean = 0.05;
    if (wall && std::abs(normal.z) < lean) normal = geometry::normalised(Point3{normal.x, normal.y, 0});
    out.classes.push_back(model.classes[f]);
  }
  return out;
}

/// Whether a point is on an edge but for rounding.
auto is_on(const Foot& foot, const Flat& p) -> bool {
  constexpr double off = 1.5;  // units of files
  const auto square = [](std::int64_t v) { return static_cast<double>(v) * static_cast<double>(v); };
  const double length2 = square(foot.to[0] - foot.from[0]) + square(foot.to[1] - foot.from[1]);
  const auto at = static_cast<double>(foot.along(p));
  return at >= -off * std::sqrt(length2) && at <= length2 + off * std::sqrt(length2) &&
         square(foot.aside(p)) <= off * off * length2;
}

/// The height of the ground at an edge that a union has cut off a corner, or that ends at one: that of the building
/// that has both of its ends on its edges, on one where there is such a one.
auto height_of_cut(const Flat& from, const Flat& to, const Feet& feet) -> std::optional<std::int64_t> {
  std::optional<std::int64_t> on_one, on_two;
  std::map<std::size_t, std::array<bool, 2>> ends;
  std::map<std::size_t, std::int64_t> heights;
  const auto lower = [](std::optional<std::int64_t>& z, std::int64_t other) { z = z ? std::min(*z, other) : other; };
  for (const auto number : feet.near(from, to)) {
    const Foot& foot = feet.all()[number];
    const bool first = is_on(foot, from), last = is_on(foot, to);
    if (first && last) lower(on_one, foot.z);
    auto& both = ends[foot.owner];
    both = {both[0] || first, both[1] || last};
    heights.try_emplace(foot.owner, foot.z);
  }
  for (const auto& [owner, both] : ends)
    if (both[0] && both[1]) lower(on_two, heights[owner]);
  return on_one ? on_one : on_two;
}

/// The pieces of an edge of a united ground, each with the height of the building whose edge it is; nothing where some
/// of it is that of none.
struct Piece {
  Flat from{}, to{};
  std::int64_t z = 0;
};
auto pieces_of(const Flat& from, const Flat& to, const Feet& feet) -> std::vector<Piece> {
  const Foot whole{from, to, 0, 0};
  std::vector<const Foot*> on;
  std::vector<Flat> ends{from, to};
  for (const auto number : feet.near(from, to)) {
    const auto& foot = feet.all()[number];
    if (whole.aside(foot.from) != 0 || whole.aside(foot.to) != 0 || whole.along(foot.to) <= whole.along(foot.from))
      continue;
    if (whole.along(foot.to) <= 0 || whole.along(foot.from) >= whole.along(to)) continue;
    on.push_back(&foot);
    for (const auto& end : {foot.from, foot.to})
      if (whole.along(end) > 0 && whole.along(end) < whole.along(to)) ends.push_back(end);
  }
  std::ranges::sort(ends, {}, [&](const Flat& p) { return whole.along(p); });
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Piece> out;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const Foot* owner = nullptr;
    for (const auto* foot : on)
      if (whole.along(foot->from) <= whole.along(ends[i]) && whole.along(foot->to) >= whole.along(ends[i + 1]) &&
          (owner == nullptr || foot->z < owner->z))
        owner = foot;
    if (owner == nullptr) {
      const auto z = height_of_cut(from, to, feet);
      return z ? std::vector<Piece>{{from, to, *z}} : std::vector<Piece>{};
    }
    if (!out.empty() && out.back().z == owner->z) out.back().to = ends[i + 1];
    else out.push_back({ends[i], ends[i + 1], owner->z});
  }
  return out;
}

/// Walls that were cut into triangles since they are narrow, put together across edges that begin at the lowest height
/// and end above another corner: raised to several heights, the two sides of such an edge would differ.
auto without_diagonals(const LabelledSolid& model, std::int64_t low) -> LabelledSolid {
  LabelledSolid out = model;
  auto& [vertices, faces] = out.solid;
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Edge, std::size_t> face_of;
  const auto enter = [&](std::size_t f) {
    const auto& loop = faces[f].loops.front();
    for (std::size_t i = 0; i < loop.size(); ++i) face_of[{loop[i], loop[(i + 1) % loop.size()]}] = f;
  };
  const auto is_diagonal = [&](std::uint32_t a, std::uint32_t b) {
    const Place p = place_of(vertices[a]), q = place_of(vertices[b]);
    return (p[2] == low) != (q[2] == low) && flat(p) != flat(q);
  };
  for (std::size_t f = 0; f < faces.size(); ++f) enter(f);
  std::vector<Edge> diagonals;
  for (const auto& [edge, f] : face_of)
    if (edge.first < edge.second && is_diagonal(edge.first, edge.second)) diagonals.push_back(edge);
  for (const auto& [a, b] : diagonals) {
    const auto there = face_of.find({a, b}), back = face_of.find({b, a});
    if (there == face_of.end() || back == face_of.end() || there->second == back->second) continue;
    const std::size_t f = there->second, g = back->second;
    auto &into = faces[f].loops.front(), &from = faces[g].loops.front();
    const auto shared = std::ranges::count_if(into, [&](auto v) { return std::ranges::find(from, v) != from.end(); });
    if (shared != 2) continue;                              // it would come to a corner twice
    std::ranges::rotate(into, std::ranges::find(into, b));  // b … a
    std::ranges::rotate(from, std::ranges::find(from, a));  // a … b
    into.insert(into.end(), from.begin() + 1, from.end() - 1);
    faces[f].loops.insert(faces[f].loops.end(), faces[g].loops.begin() + 1, faces[g].loops.end());
    faces[g].loops.clear();
    face_of.erase({a, b});
    face_of.erase({b, a});
    enter(f);
  }
  std::size_t next = 0;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (!faces[f].loops.empty()) {
      if (next != f) faces[next] = std::move(faces[f]);
      out.classes[next++] = out.classes[f];
    }
  faces.resize(next);
  out.classes.resize(next);
  return out;
}

/// A lowered solid raised again to the heights of its buildings, edge by edge. None where that cannot be done.
auto raised(const LabelledSolid& lowered, std::int64_t low, const Feet& feet) -> std::optional<Shell> {
  Shell out;
  const LabelledSolid model = without_diagonals(lowered, low);
  const auto& [vertices, faces] = model.solid;
  std::map<Flat, std::set<std::int64_t>> heights;  // of the ground at each corner
  std::map<std::pair<Flat, Flat>, std::vector<Piece>> pieces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (model.classes[f] != FaceClass::ground) continue;
    for (const auto& loop : faces[f].loops) {
      GroundRing ring;
      for (std::size_t i = loop.size(); i-- > 0;) {
        const Place a = place_of(vertices[loop[i]]), b = place_of(vertices[loop[(i + loop.size() - 1) % loop.size()]]);
        if (a[2] != low || b[2] != low) return std::nullopt;
        auto of_edge = pieces_of(flat(a), flat(b), feet);
        if (of_edge.empty()) return std::nullopt;
        for (const auto& piece : of_edge) {
          ring.corners.push_back(piece.from);
          ring.heights.push_back(piece.z);
          heights[piece.from].insert(piece.z);
          heights[piece.to].insert(piece.z);
        }
        pieces.emplace(std::pair{flat(a), flat(b)}, std::move(of_edge));
      }
      out.ground.rings.push_back(std::move(ring));
    }
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (model.classes[f] == FaceClass::ground) continue;
    std::vector<std::vector<Place>> loops;
    for (const auto& loop : faces[f].loops) {
      std::vector<Place> path;
      const auto put = [&](const Place& p) {
        if (path.empty() || path.back() != p) path.push_back(p);
      };
      const std::size_t count = loop.size();
      for (std::size_t i = 0; i < count; ++i) {
        const Place a = place_of(vertices[loop[i]]), b = place_of(vertices[loop[(i + 1) % count]]);
        if (a[2] != low && b[2] != low) {
          put(a);
        } else if (a[2] == low && b[2] == low) {
          const auto at = pieces.find({flat(a), flat(b)});
          if (at == pieces.end()) return std::nullopt;
          for (const auto& piece : at->second) {
            put({piece.from[0], piece.from[1], piece.z});
            put({piece.to[0], piece.to[1], piece.z});
          }
        } else {
          // A side of a wall, down or up. What of it is above this wall's own ground and is a corner of the terrain.
          if (flat(a) != flat(b)) return std::nullopt;
          if (b[2] == low) put(a);
          const Place& end = loop.size() > 2 && b[2] == low ? place_of(vertices[loop[(i + 2) % count]])
                                                            : place_of(vertices[loop[(i + count - 1) % count]]);
          if (end[2] != low) return std::nullopt;
          const auto at = b[2] == low ? pieces.find({flat(b), flat(end)}) : pieces.find({flat(end), flat(a)});
          if (at == pieces.end()) return std::nullopt;
          const std::int64_t own = b[2] == low ? at->second.front().z : at->second.back().z;
          const std::int64_t top = std::max(a[2], b[2]);
          std::vector<std::int64_t> between;
          for (const auto z : heights[flat(a)]) {
            if (z >= top) return std::nullopt;
            if (z > own) between.push_back(z);
          }
          if (b[2] == low) std::ranges::reverse(between);
          for (const auto z : between) put({a[0], a[1], z});
        }
      }
      while (path.size() > 1 && path.front() == path.back()) path.pop_back();
      loops.push_back(std::move(path));
    }
    out.faces.push_back(std::move(loops));
    out.normals.push_back(faces[f].normal);
  }
  return out;
}

/// A building as it is, where all its ground is at one height.
auto plain(const LabelledSolid& model) -> std::optional<Shell> {
  Shell out;
  std::optional<std::int64_t> z;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    std::vector<std::vector<Place>> loops;
    for (const auto& loop : model.solid.faces[f].loops) {
      loops.emplace_back();
      for (const auto v : loop) loops.back().push_back(place_of(model.solid.vertices[v]));
    }
    if (model.classes[f] != FaceClass::ground) {
      out.faces.push_back(std::move(loops));
      out.normals.push_back(model.solid.faces[f].normal);
      continue;
    }
    for (const auto& loop : loops) {
      GroundRing ring;
      for (auto p = loop.rbegin(); p != loop.rend(); ++p) {
        if (z && *z != (*p)[2]) return std::nullopt;
        z = (*p)[2];
        ring.corners.push_back(flat(*p));
        ring.heights.push_back((*p)[2]);
      }
      out.ground.rings.push_back(std::move(ring));
    }
  }
  return out;
}

/// The outline of all grounds at the lowest height, with a flat roof at half of the heights.
auto prism(std::span<const LabelledSolid* const> models) -> std::optional<Shell> {
  std::vector<geometry::Polygon> polygons;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto* model : models) {
    for (std::size_t f = 0; f < model->solid.faces.size(); ++f) {
      if (model->classes[f] != FaceClass::ground) continue;
      geometry::Polygon polygon;
      for (const auto& loop : model->solid.faces[f].loops) {
        geometry::Ring ring;
        for (auto v = loop.rbegin(); v != loop.rend(); ++v) ring.push_back(xy(model->solid.vertices[*v]));
        low = std::min(low, model->solid.vertices[loop.front()].z);
        (polygon.outer.empty() ? polygon.outer : polygon.holes.emplace_back()) = std::move(ring);
      }
      polygons.push_back(std::move(polygon));
    }
    for (const auto& v : model->solid.vertices) high = std::max(high, v.z);
  }
  if (polygons.empty() || !(high > low)) return std::nullopt;
  const auto united = geometry::unite(polygons);
  if (!united) return std::nullopt;
  Shell out;
  const std::int64_t bottom = std::llround(low * scale), top = std::llround((low + high) / 2 * scale);
  if (top <= bottom) return std::nullopt;
  for (const auto& polygon : *united) {
    std::vector<std::vector<Place>> roof;
    for (std::size_t r = 0; r <= polygon.holes.size(); ++r) {
      const auto& ring = r == 0 ? polygon.outer : polygon.holes[r - 1];
      GroundRing ground;
      for (const auto& p : ring) {
        const Flat at{std::llround(p.x * scale), std::llround(p.y * scale)};
        if (!ground.corners.empty() && ground.corners.back() == at) continue;
        ground.corners.push_back(at);
        ground.heights.push_back(bottom);
      }
      while (ground.corners.size() > 1 && ground.corners.front() == ground.corners.back()) {
        ground.corners.pop_back();
        ground.heights.pop_back();
      }
      if (ground.corners.size() < 3) {
        if (r == 0) break;
        continue;
      }
      roof.emplace_back();
      for (std::size_t i = 0; i < ground.corners.size(); ++i) {
        const auto &a = ground.corners[i], &b = ground.corners[(i + 1) % ground.corners.size()];
        roof.back().push_back({a[0], a[1], top});
        out.faces.push_back({{{a[0], a[1], bottom}, {b[0], b[1], bottom}, {b[0], b[1], top}, {a[0], a[1], top}}});
        out.normals.push_back(
            geometry::normalised(Point3{static_cast<double>(b[1] - a[1]), static_cast<double>(a[0] - b[0]), 0}));
      }
      out.ground.rings.push_back(std::move(ground));
    }
    if (roof.empty()) continue;
    out.faces.push_back(std::move(roof));
    out.normals.push_back({0, 0, 1});
  }
  return out;
}

/// A solid with a flat roof half-way between the lowest and the highest corner of its roofs.
auto flattened(const LabelledSolid& model) -> LabelledSolid {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f)
    if (model.classes[f] == FaceClass::roof)
      for (const auto v : model.solid.faces[f].loops.front()) {
        low = std::min(low, model.solid.vertices[v].z);
        high = std::max(high, model.solid.vertices[v].z);
      }
  return solid::prism_over_ground(model, std::round((low + high) / 2 * scale) / scale);
}

/// Solids that touch as one closed surface: with their roofs, else with as many of these as can be found quickly.
class Joining {
 public:
  struct Joined {
    std::vector<Shell> shells;  ///< none where there is no such surface
    std::size_t flat = 0;       ///< solids whose roofs are flat in it
    std::string why;            ///< they are
  };

  Joining(std::span<const LabelledSolid* const> solids, const Feet& feet) : feet_(feet), solids_(solids) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto* solid : solids)
      for (const auto& v : solid->solid.vertices) lowest = std::min(lowest, v.z);
    low_ = std::llround((lowest - 1) * scale);
    const double z = static_cast<double>(low_) / scale;
    for (const auto* solid : solids) {
      with_roofs_.push_back(lowered(*solid, z));
      flat_.push_back(lowered(flattened(*solid), z));
    }
  }

  /// With `some_flat`, some roofs may be flat.
  auto run(bool some_flat) -> Joined {
    Joined out;
    std::vector<std::uint8_t> flat(solids_.size(), 0);
    if (attempt(flat, out)) return out;
    out.why = why_;
    const std::vector<std::uint8_t> all(solids_.size(), 1);
    if (!some_flat || !attempt(all, out)) {
      out.flat = solids_.size();
      return out;
    }
    // Of the first solids so many must be flat that the last of them does: it stays flat, and the others are tried
    // again.
    constexpr int most = 8;
    for (int i = 0; i < most; ++i) {
      std::size_t fails = 0, works = solids_.size();
      while (fails + 1 < works) {
        const std::size_t middle = (fails + works) / 2;
        auto first = flat;
        std::fill_n(first.begin(), middle, std::uint8_t{1});
        if (attempt(first, out)) works = middle;
        else fails = middle;
      }
      if (works == 0) break;
      flat[works - 1] = 1;
      if (attempt(flat, out)) break;
    }
    return out;
  }

 private:
  /// With these solids flat. Replaces shells that have more of them.
  auto attempt(const std::vector<std::uint8_t>& flat, Joined& out) -> bool {
    std::vector<const LabelledSolid*> parts;
    for (std::size_t i = 0; i < flat.size(); ++i) parts.push_back(flat[i] != 0 ? &flat_[i] : &with_roofs_[i]);
    if (std::ranges::any_of(parts, [](const auto* part) { return part->solid.faces.empty(); })) return false;
    const auto united = solid::unite(parts);
    const auto bad = std::ranges::find_if(united.warnings, [](const auto& w) {
      return w.code == "solid-not-united" || w.code == "solid-left-out" || w.code == "solid-simplified";
    });
    if (bad != united.warnings.end()) return why_ = bad->message, false;
    std::vector<Shell> shells;
    for (const auto& one : united.solids) {
      auto shell = raised(one.model, low_, feet_);
      if (!shell) return why_ = "a wall does not end on the ground of its building", false;
      shells.push_back(std::move(*shell));
    }
    const auto count = static_cast<std::size_t>(std::ranges::count(flat, 1));
    if (out.shells.empty() || count < out.flat) out.shells = std::move(shells), out.flat = count;
    return true;
  }

  const Feet& feet_;
  std::span<const LabelledSolid* const> solids_;
  std::vector<LabelledSolid> with_roofs_, flat_;
  std::int64_t low_ = 0;
  std::string why_;
};

/// Collects triangles with corners in single precision.
class Surface {
 public:
  auto vertex(Point3 p) -> std::uint32_t {
    const auto single = [](double v) { return static_cast<double>(static_cast<float>(v)); };
    const Point3 at{single(p.x), single(p.y), single(p.z)};
    const auto [found, fresh] = numbers_.emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back(at);
    return found->second;
  }
  /// One without corners in common; its other edges are one in single precision.
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  }
  geometry::Mesh mesh;

 private:
  std::map<Point3, std::uint32_t> numbers_;
};

auto add_shell(const Shell& shell, Surface& out) -> base::Result<void> {
  model::Solid faces;
  for (std::size_t f = 0; f < shell.faces.size(); ++f) {
    model::Face face;
    for (const auto& loop : shell.faces[f]) {
      std::vector<std::uint32_t> corners;
      for (const auto& p : loop) {
        const auto v = out.vertex(metres(p));
        if (corners.empty() || corners.back() != v) corners.push_back(v);
      }
      while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
      if (corners.size() >= 3) face.loops.push_back(std::move(corners));
    }
    if (face.loops.empty()) continue;
    face.normal = shell.normals[f];
    faces.faces.push_back(std::move(face));
  }
  faces.vertices = out.mesh.vertices;
  const auto cut = solid::triangulate(faces);
  if (!cut) return cut.failure();
  for (const auto& t : cut->triangles) out.triangle(t[0], t[1], t[2]);
  return {};
}

void add_terrain(const Terrain& terrain, double depth, Surface& out) {
  std::int64_t lowest = std::numeric_limits<std::int64_t>::max();
  for (const auto& v : terrain.vertices) lowest = std::min(lowest, v[2]);
  const std::int64_t bottom = lowest - std::llround(depth * scale);
  std::vector<std::uint32_t> numbers;
  for (const auto& v : terrain.vertices) numbers.push_back(out.vertex(metres(v)));
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : terrain.triangles) {
    out.triangle(numbers[t[0]], numbers[t[1]], numbers[t[2]]);
    for (std::size_t i = 0; i < 3; ++i) edges.emplace(t[i], t[(i + 1) % 3]);
  }
  const auto quanta = [](double v) { return std::llround(v * scale); };
  const auto& area = terrain.area;
  const Place middle{(quanta(area.least.x) + quanta(area.most.x)) / 2, (quanta(area.least.y) + quanta(area.most.y)) / 2,
                     bottom};
  const auto centre = out.vertex(metres(middle));
  for (const auto& [from, to] : edges) {
    if (edges.contains({to, from})) continue;
    const Place &a = terrain.vertices[from], &b = terrain.vertices[to];
    const auto both = [&](std::size_t axis, double side) { return a[axis] == quanta(side) && b[axis] == quanta(side); };
    if (flat(a) == flat(b) ||
        !(both(0, area.least.x) || both(0, area.most.x) || both(1, area.least.y) || both(1, area.most.y)))
      continue;
    const auto below_a = out.vertex(metres({a[0], a[1], bottom})), below_b = out.vertex(metres({b[0], b[1], bottom}));
    out.triangle(numbers[to], numbers[from], below_a);
    out.triangle(numbers[to], below_a, below_b);
    out.triangle(below_b, below_a, centre);
  }
}

/// What is wrong with a closed surface, in words; empty for nothing.
auto faults_of(const geometry::Mesh& mesh) -> std::string {
  model::Solid solid;
  solid.vertices = mesh.vertices;
  for (const auto& t : mesh.triangles) {
    model::Face face;
    face.loops = {{t[0], t[1], t[2]}};
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    face.normal = geometry::normalised(cross(b - a, c - a));
    solid.faces.push_back(std::move(face));
  }
  solid::Rules rules;
  rules.planar = 1;  // of triangles there is nothing to ask
  for (const auto& wrong : solid::check(solid, rules))
    if (wrong.code != "solid-needle" && wrong.code != "solid-not-planar") return wrong.code + ": " + wrong.message;
  return {};
}

/// With prisms over the outlines of all groups that have no union, or only of those that have none with flat roofs.
auto closed_with(bool prisms, const Heights& heights, std::span<const model::Building> buildings,
                 const Options& options, const base::Run& run) -> base::Result<Closed> {
  Closed out;
  std::vector<Models> models;
  std::vector<Ground> grounds;
  for (const auto& building : buildings) {
    models.push_back(models_of(building));
    grounds.push_back(ground_of(building));
  }
  const Feet feet(grounds);
  std::vector<Shell> shells;
  for (const auto& group : groups_of(feet, grounds.size())) {
    std::vector<const LabelledSolid*> all;
    std::string id;
    for (const auto member : group) {
      if (id.empty()) id = models[member].id;
      for (const auto& solid : models[member].solids) all.push_back(&solid);
    }
    if (all.empty()) continue;
    std::vector<Shell> made;
    if (all.size() == 1)
      if (auto shell = plain(*all.front())) made.push_back(std::move(*shell));
    if (made.empty()) {
      auto joined = Joining(all, feet).run(!prisms);
      const bool flat_roofs = !joined.shells.empty();
      made = std::move(joined.shells);
      if (made.empty())
        if (auto shell = prism(all)) made.push_back(std::move(*shell));
      if (joined.flat > 0)
        out.warnings.push_back(base::warning(
            "terrain-simplified",
            flat_roofs ? "the buildings that touch this one have no union that is a closed surface (" + joined.why +
                             "), so that " + std::to_string(joined.flat) + " of " + std::to_string(all.size()) +
                             " solids have flat roofs in the closed surface"
                       : "the buildings that touch this one have no union that is a closed surface (" + joined.why +
                             "), so that the closed surface has a prism over their outline (" +
                             std::to_string(group.size()) + " buildings)",
            id));
    }
    for (auto& shell : made) {
      shell.ground.id = id;
      shells.push_back(std::move(shell));
    }
  }
  std::vector<Ground> met;
  for (const auto& shell : shells) met.push_back(shell.ground);
  auto terrain = make(heights, met, options, run);
  if (!terrain) return terrain.failure();
  Surface surface;
  std::set<std::string> left_out;
  for (const auto& warning : terrain->warnings) {
    if (warning.code == "terrain-overlap") left_out.insert(warning.subject);
    out.warnings.push_back(warning);
  }
  add_terrain(*terrain, options.depth, surface);
  for (const auto& shell : shells) {
    if (left_out.contains(shell.ground.id)) continue;  // the terrain goes on below it
    if (auto added = add_shell(shell, surface); !added) return added.failure();
  }
  if (const auto wrong = faults_of(surface.mesh); !wrong.empty())
    return base::error("terrain-closed", "the closed surface of terrain and buildings is not valid (" + wrong + ")");
  out.mesh = std::move(surface.mesh);
  return out;
}

}  // namespace

auto closed(const Heights& heights, std::span<const model::Building> buildings, const Options& options,
            const base::Run& run) -> base::Result<Closed> {
  auto made = closed_with(false, heights, buildings, options, run);
  if (made || made.error().code != "terrain-closed") return made;
  return closed_with(true, heights, buildings, options, run);  // the simplest
}

}  // namespace mansard::terrain
