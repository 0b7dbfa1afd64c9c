#include "mansard/solid/detail/union_faces.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "mansard/solid/detail/outline.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using model::FaceClass;

constexpr std::uint32_t no_face = UINT32_MAX;

/// A part of a wall over one step of the plan.
struct Piece {
  std::uint32_t solid = 0, face = no_face;  ///< whose wall it was
  Step step;                                ///< as it runs from left to right, seen from outside
  FaceClass kind = FaceClass::wall;
  Path path;
};

class Building {
 public:
  Building(const Sheets& sheets, std::span<const model::LabelledSolid* const> parts) : s_(sheets), parts_(parts) {}

  auto build() -> Union {
    const auto sides = sides_of(s_);
    if (!sides) return failed("parts overlap");
    find_walls();
    find_stations(*sides);
    for (const auto& [step, left] : *sides) {
      const auto back = sides->find({step.second, step.first});
      if (back == sides->end()) add_pieces(step, left, nullptr);
      else add_pieces(step, left, &back->second);
    }
    add_roofs();
    if (!add_ground()) return failed("ground floors overlap");
    add_walls();
    return std::move(out_);
  }

 private:
  auto failed(std::string why) -> Union {
    out_.why = std::move(why);
    return std::move(out_);
  }

  [[nodiscard]] auto solid_of(const Side& side) const -> std::uint32_t { return s_.sheets[side.sheet].solid; }
  [[nodiscard]] auto source(const Sheet& sheet) const -> const model::Face& {
    return parts_[sheet.solid]->solid.faces[sheet.face];
  }

  void find_walls() {
    for (const Sheet& sheet : s_.sheets) {
      if (sheet.facing != Facing::aside) continue;
      for (const Path& path : sheet.paths)
        for (std::size_t i = 0; i < path.size(); ++i) {
          const auto [a, b] = std::minmax(path[i].at, path[(i + 1) % path.size()].at);
          if (a != b) wall_over_.try_emplace({Step{a, b}, sheet.solid}, sheet.face);
        }
    }
  }

  /// All heights at which something meets the upright line over a point.
  void find_stations(const Sides& sides) {
    stations_.resize(s_.places.size());
    for (const auto& [step, side] : sides) {
      const std::int64_t base = s_.base[solid_of(side)];
      stations_[step.first].insert({side.z0, base});
      stations_[step.second].insert({side.z1, base});
    }
  }

  /// What of the left side stands above or below the right one.
  void add_pieces(const Step& step, const Side& left, const Side* right) {
    const std::int64_t base = s_.base[solid_of(left)];
    const std::array low{base, base}, high{left.z0, left.z1};
    if (right == nullptr) return add_piece(step, left, low, high, true);
    const std::int64_t other = s_.base[solid_of(*right)];
    const std::array other_high{right->z1, right->z0};
    if (base < other) add_piece(step, left, low, {std::min(high[0], other), std::min(high[1], other)}, false);
    add_piece(step, left, {std::max(base, other_high[0]), std::max(base, other_high[1])}, high, false);
  }

  void add_piece(const Step& step, const Side& side, std::array<std::int64_t, 2> low, std::array<std::int64_t, 2> high,
                 bool outside) {
    const auto [a, b] = step;
    high = {std::max(low[0], high[0]), std::max(low[1], high[1])};
    if (high == low) return;
    Piece piece{solid_of(side), no_face, step, FaceClass::wall, {}};
    const auto found = wall_over_.find({Step(std::minmax(a, b)), piece.solid});
    if (found != wall_over_.end()) {
      piece.face = found->second;
      const FaceClass was = parts_[piece.solid]->classes[piece.face];
      if (outside && was == FaceClass::party_wall) piece.kind = was;
    }
    piece.path.push_back({a, low[0]});
    piece.path.push_back({b, low[1]});
    for (auto z = stations_[b].upper_bound(low[1]); z != stations_[b].end() && *z < high[1]; ++z)
      piece.path.push_back({b, *z});
    if (high[1] > low[1]) piece.path.push_back({b, high[1]});
    if (high[0] > low[0]) piece.path.push_back({a, high[0]});
    for (auto z = std::make_reverse_iterator(stations_[a].lower_bound(high[0]));
         z != stations_[a].rend() && *z > low[0]; ++z)
      piece.path.push_back({a, *z});
    pieces_.push_back(std::move(piece));
  }

  void add_roofs() {
    for (const Sheet& sheet : s_.sheets) {
      if (sheet.facing != Facing::up) continue;
      std::vector<Path> paths;
      for (const Path& path : sheet.paths) paths.push_back(with_stations(path));
      const Flat flat = [&](const Node& n) { return flat_of(n); };
      const bool upright = std::ranges::any_of(paths, [](const Path& path) {
        for (std::size_t i = 0; i < path.size(); ++i)
          if (path[i].at == path[(i + 1) % path.size()].at) return true;
        return false;
      });
      const auto faces = upright ? std::nullopt : united_faces(paths, flat);
      if (faces) {
        for (const auto& loops : *faces) add_face(loops, FaceClass::roof, sheet.solid, &source(sheet));
        continue;
      }
      std::vector<Path> loops;
      for (const Path& path : paths)
        for (auto& loop : simple_loops(path)) loops.push_back(std::move(loop));
      if (!loops.empty()) add_face(loops, FaceClass::roof, sheet.solid, &source(sheet));
    }
  }

  [[nodiscard]] auto with_stations(const Path& path) const -> Path {
    Path out;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Node &from = path[i], &to = path[(i + 1) % path.size()];
      out.push_back(from);
      if (from.at != to.at) continue;
      const auto& heights = stations_[from.at];
      if (from.z < to.z)
        for (auto z = heights.upper_bound(from.z); z != heights.end() && *z < to.z; ++z) out.push_back({from.at, *z});
      else
        for (auto z = std::make_reverse_iterator(heights.lower_bound(from.z)); z != heights.rend() && *z > to.z; ++z)
          out.push_back({from.at, *z});
    }
    return out;
  }

  [[nodiscard]] auto flat_of(const Node& node) const -> Point2 {
    return {static_cast<double>(s_.places[node.at][0]), static_cast<double>(s_.places[node.at][1])};
  }

  auto add_ground() -> bool {
    std::map<std::int64_t, std::vector<Path>> by_height;
    std::map<std::int64_t, const Sheet*> one;
    for (const Sheet& sheet : s_.sheets) {
      if (sheet.facing != Facing::down) continue;
      auto& paths = by_height[sheet.paths[0][0].z];
      paths.insert(paths.end(), sheet.paths.begin(), sheet.paths.end());
      one.try_emplace(sheet.paths[0][0].z, &sheet);
    }
    const Flat from_below = [&](const Node& n) { return Point2{-flat_of(n).x, flat_of(n).y}; };
    for (const auto& [z, paths] : by_height) {
      const auto faces = united_faces(paths, from_below);
      if (!faces) return false;
      for (const auto& loops : *faces) add_face(loops, FaceClass::ground, one[z]->solid, &source(*one[z]));
    }
    return true;
  }

  void add_walls() {
    using Key = std::tuple<std::uint32_t, std::uint32_t, FaceClass>;
    std::map<Key, std::vector<const Piece*>> groups;
    for (const Piece& piece : pieces_) {
      if (piece.face == no_face) add_face({piece.path}, piece.kind, piece.solid, nullptr);
      else groups[{piece.solid, piece.face, piece.kind}].push_back(&piece);
    }
    for (const auto& [key, group] : groups) {
      const auto& [solid, number, kind] = key;
      const model::Face& from = parts_[solid]->solid.faces[number];
      if (!add_united(group, from))
        for (const Piece* piece : group) add_face({piece->path}, kind, solid, &from);
    }
  }

  /// As one where they lie within half the rounding of one plane.
  auto add_united(const std::vector<const Piece*>& group, const model::Face& from) -> bool {
    const Piece* longest = group.front();
    const auto run = [&](const Piece& piece) {
      return flat_of({piece.step.second, 0}) - flat_of({piece.step.first, 0});
    };
    for (const Piece* piece : group)
      if (length(run(*piece)) > length(run(*longest))) longest = piece;
    const Point2 along = geometry::normalised(run(*longest)), start = flat_of({longest->step.first, 0});
    // A wall that another solid of the building has too must be the same there: validators compare them, and cut a wall
    // that bends a little at a corner into triangles that do not keep to it.
    const auto is_pinned = [&](const Node& node) {
      return node.at < s_.pinned.size() && s_.pinned[node.at] == of_a_solid;
    };
    const bool shared =
        std::ranges::any_of(group, [&](const Piece* piece) { return std::ranges::any_of(piece->path, is_pinned); });
    if (shared && !is_level_with_an_axis(group)) return false;
    constexpr double most = 1.5;  // quanta
    std::vector<Path> paths;
    for (const Piece* piece : group) {
      if (dot(run(*piece), along) <= 0) return false;
      for (const Node& node : piece->path)
        if (std::abs(cross(along, flat_of(node) - start)) > most) return false;
      paths.push_back(piece->path);
    }
    const Flat flat = [&](const Node& n) { return Point2{dot(flat_of(n) - start, along), static_cast<double>(n.z)}; };
    const auto faces = united_faces(paths, flat);
    if (!faces) return false;
    for (const auto& loops : *faces) add_face(loops, group.front()->kind, group.front()->solid, &from);
    return true;
  }

  /// Over one step, or along x or y. Only such walls are planar for those who read files: decimals become doubles,
  /// which are on no line but these.
  [[nodiscard]] auto is_level_with_an_axis(const std::vector<const Piece*>& group) const -> bool {
    const Step& first = group.front()->step;
    const auto is_same = [&](std::size_t k) {
      return std::ranges::all_of(group, [&](const Piece* piece) {
        return s_.places[piece->step.first][k] == s_.places[first.first][k] &&
               s_.places[piece->step.second][k] == s_.places[first.first][k];
      });
    };
    const bool one = std::ranges::all_of(group, [&](const Piece* piece) {
      return std::minmax(piece->step.first, piece->step.second) == std::minmax(first.first, first.second);
    });
    return one || is_same(0) || is_same(1);
  }

  void add_face(const std::vector<Path>& loops, FaceClass kind, std::uint32_t solid, const model::Face* from) {
    model::Face face;
    if (from != nullptr) face.kind = from->kind, face.provenance = from->provenance;
    Point3 area;
    for (const Path& path : loops) {
      auto& loop = face.loops.emplace_back();
      for (const Node& node : path) loop.push_back(vertex(node));
      const auto& vertices = out_.model.solid.vertices;
      const Point3 o = vertices[face.loops[0][0]];
      for (std::size_t i = 0; i < loop.size(); ++i)
        area = area + cross(vertices[loop[i]] - o, vertices[loop[(i + 1) % loop.size()]] - o);
    }
    face.normal = kind == FaceClass::roof && from != nullptr ? from->normal : geometry::normalised(area);
    if (kind == FaceClass::ground) face.normal = {0, 0, -1};
    out_.model.solid.faces.push_back(std::move(face));
    out_.model.classes.push_back(kind);
    out_.solid_of_face.push_back(solid);
  }

  auto vertex(const Node& node) -> std::uint32_t {
    auto& vertices = out_.model.solid.vertices;
    const auto [entry, added] = numbers_.try_emplace(node, static_cast<std::uint32_t>(vertices.size()));
    if (added) {
      const Place& place = s_.places[node.at];
      const auto metres = [](std::int64_t quanta) { return static_cast<double>(quanta) / quanta_per_metre; };
      vertices.push_back({metres(place[0]), metres(place[1]), metres(node.z - s_.level)});
      out_.pinned.push_back(node.at < s_.pinned.size() ? s_.pinned[node.at] : 0);
    }
    return entry->second;
  }

  const Sheets& s_;
  std::span<const model::LabelledSolid* const> parts_;
  std::map<std::pair<Step, std::uint32_t>, std::uint32_t> wall_over_;  ///< a face by step and solid
  std::vector<std::set<std::int64_t>> stations_;
  std::vector<Piece> pieces_;
  std::map<Node, std::uint32_t> numbers_;
  Union out_;
};

}  // namespace

auto union_of(const Sheets& sheets, std::span<const model::LabelledSolid* const> parts) -> Union {
  return Building(sheets, parts).build();
}

}  // namespace mansard::solid::detail
