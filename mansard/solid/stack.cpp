#include "mansard/solid/stack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/append.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/solid/detail/disjoint.hpp"
#include "mansard/solid/detail/uniting.hpp"

namespace mansard::solid {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Polygon;
using model::FaceClass;
using model::LabelledSolid;

constexpr double apart = 1e-3;   // m; heights nearer than this are the same
constexpr double narrow = 1e-2;  // m; half of the width of what is rounding

/// A part, or a piece of one, in its place. Plan in whole units of files.
struct Piece {
  std::size_t part = 0;
  std::vector<Polygon> plan;
  Box2 box;
  double base = 0, own_base = 0, top = 0;  ///< m
  bool whole = true;                       ///< all of its part
};

auto units(double metres) -> double { return std::floor(metres * model::quanta_per_metre + 0.5); }

auto plan_of(const LabelledSolid& model) -> std::vector<Polygon> {
  std::vector<Polygon> out;
  for (std::size_t f = 0; f < model.classes.size(); ++f)
    if (model.classes[f] == FaceClass::ground)
      out.push_back(geometry::oriented(geometry::polygon_of(model.solid.faces[f].loops, [&](std::uint32_t v) {
        const auto& p = model.solid.vertices[v];
        return Point2{units(p.x), units(p.y)};
      })));
  return out;
}

/// None for what is not vertical walls under a roof, on one level of ground.
auto piece_of(std::size_t part, const LabelledSolid& model) -> std::optional<Piece> {
  if (std::ranges::find(model.classes, FaceClass::soffit) != model.classes.end()) return std::nullopt;
  Piece out{part, plan_of(model), {}, 1e300, 0, -1e300, true};
  double highest_ground = -1e300;
  for (std::size_t f = 0; f < model.classes.size(); ++f)
    if (model.classes[f] == FaceClass::ground)
      for (const auto v : model.solid.faces[f].loops.front()) {
        out.base = std::min(out.base, model.solid.vertices[v].z);
        highest_ground = std::max(highest_ground, model.solid.vertices[v].z);
      }
  if (out.plan.empty() || highest_ground > out.base) return std::nullopt;
  for (const auto& v : model.solid.vertices) out.top = std::max(out.top, v.z);
  out.box = geometry::bounds(out.plan);
  out.own_base = out.base;
  return out;
}

/// Without what is rounding; none where the library fails.
auto wide(std::vector<Polygon> given) -> std::optional<std::vector<Polygon>> {
  std::vector<Polygon> out;
  for (auto& one : given) {
    const auto core = geometry::buffer(one, -narrow * model::quanta_per_metre);
    if (!core) return std::nullopt;
    if (!core->empty()) out.push_back(std::move(one));
  }
  return out;
}

template <class Operation>
auto each(const std::vector<Polygon>& some, const std::vector<Polygon>& others, Operation operation)
    -> std::optional<std::vector<Polygon>> {
  std::vector<Polygon> out;
  for (const auto& a : some)
    for (const auto& b : others) {
      if (!geometry::bounds(a.outer).overlaps(geometry::bounds(b.outer))) continue;
      auto made = operation(a, b);
      if (!made) return std::nullopt;
      std::ranges::move(*made, std::back_inserter(out));
    }
  return out;
}

auto shared(const std::vector<Polygon>& some, const std::vector<Polygon>& others)
    -> std::optional<std::vector<Polygon>> {
  auto all = each(some, others, [](const Polygon& a, const Polygon& b) { return geometry::intersect(a, b); });
  return all ? wide(std::move(*all)) : std::nullopt;
}

auto rest(std::vector<Polygon> from, const std::vector<Polygon>& others) -> std::optional<std::vector<Polygon>> {
  for (const auto& other : others) {
    std::vector<Polygon> left;
    for (const auto& one : from) {
      auto made = geometry::subtract(one, other);
      if (!made) return std::nullopt;
      std::ranges::move(*made, std::back_inserter(left));
    }
    from = std::move(left);
  }
  return wide(std::move(from));
}

/// Whether what two share in plan is wider than rounding, or that cannot be computed.
auto overlap(const Piece& a, const Piece& b) -> bool {
  if (!a.box.overlaps(b.box)) return false;
  const auto both = shared(a.plan, b.plan);
  return !both || !both->empty();
}

auto touch_in_height(const Piece& a, const Piece& b) -> bool {
  return std::min(a.top, b.top) >= std::max(a.base, b.base) - apart;
}

/// The pieces of a part on those that are there already, whose bases are lower.
void put(Piece piece, std::vector<Piece>& placed) {
  std::vector<Piece> on;
  std::vector<Polygon> left = piece.plan;
  for (const Piece& under : placed) {
    const bool stands = under.base < piece.base - apart && under.top >= piece.base - apart;
    if (!stands || !under.box.overlaps(piece.box)) continue;
    auto over = shared(left, under.plan);
    if (!over || over->empty()) continue;
    auto beside = rest(left, under.plan);
    if (!beside) continue;
    on.push_back({piece.part, std::move(*over), {}, under.base, piece.base, piece.top, false});
    left = std::move(*beside);
  }
  if (on.empty()) {
    placed.push_back(std::move(piece));
    return;
  }
  if (!left.empty()) on.push_back({piece.part, std::move(left), {}, piece.base, piece.base, piece.top, false});
  // All on the same base: the part as it is, but longer.
  if (std::ranges::all_of(on, [&](const Piece& one) { return std::abs(one.base - on.front().base) <= apart; })) {
    piece.base = on.front().base;
    placed.push_back(std::move(piece));
    return;
  }
  for (auto& one : on) {
    one.box = geometry::bounds(one.plan);
    placed.push_back(std::move(one));
  }
}

/// A model whose ground is at z, below its own: with walls down to there, as its roof may begin on its ground.
auto let_down(LabelledSolid model, double z) -> LabelledSolid {
  auto& [vertices, faces] = model.solid;
  std::vector<std::optional<std::uint32_t>> below(vertices.size());
  const auto lowered = [&](std::uint32_t v) {
    if (!below[v]) {
      below[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back({vertices[v].x, vertices[v].y, z});
    }
    return *below[v];
  };
  std::vector<model::Face> walls;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (model.classes[f] != FaceClass::ground) continue;
    for (auto& loop : faces[f].loops) {
      std::vector<std::uint32_t> down;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
        const Point2 out = left_of(normalised(geometry::xy(vertices[to]) - geometry::xy(vertices[from])));
        down.push_back(lowered(from));
        walls.push_back({{{lowered(to), lowered(from), from, to}}, model::FaceKind::side, {}, {out.x, out.y, 0}});
      }
      loop = std::move(down);
    }
  }
  for (auto& wall : walls) {
    faces.push_back(std::move(wall));
    model.classes.push_back(FaceClass::wall);
  }
  return model;
}

/// The model of a piece. None where it cannot be made.
auto model_of(const Piece& piece, const LabelledSolid& part) -> std::optional<LabelledSolid> {
  LabelledSolid out = part;
  if (!piece.whole) {
    const auto cut = detail::clipped(part, piece.plan);
    if (!cut) return std::nullopt;
    const std::array<const LabelledSolid*, 1> alone{&*cut};
    const auto closed = detail::united_by(alone, {});
    if (closed.solids.empty() || !closed.warnings.empty()) return std::nullopt;
    out = {};
    for (const auto& one : closed.solids) model::append(one.model, out);
  }
  return piece.base < piece.own_base - apart ? let_down(std::move(out), piece.base) : std::move(out);
}

/// Pieces that overlap in plan and touch in height are in one layer; of others that overlap in plan no two are.
auto layers_of(const std::vector<Piece>& pieces) -> std::vector<std::size_t> {
  const auto count = static_cast<std::uint32_t>(pieces.size());
  base::DisjointSets sets(count);
  std::vector<std::array<std::uint32_t, 2>> above;
  std::vector<Box2> boxes;
  for (const auto& piece : pieces) boxes.push_back(piece.box);
  const geometry::BoxIndex index(boxes);
  for (std::uint32_t i = 0; i < count; ++i)
    for (const std::uint32_t k : index.overlapping(boxes[i])) {
      if (k >= i || !overlap(pieces[i], pieces[k])) continue;
      if (touch_in_height(pieces[i], pieces[k])) sets.join(i, k);
      else above.push_back({i, k});
    }
  std::vector<std::optional<std::size_t>> layer_of_set(count);
  std::vector<std::size_t> out;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t own = sets.of(i);
    if (!layer_of_set[own]) {
      std::vector<bool> taken(count + 1, false);
      for (const auto& [a, b] : above) {
        const std::uint32_t sa = sets.of(a), sb = sets.of(b);
        if (sa == sb || (sa != own && sb != own)) continue;
        if (const auto other = layer_of_set[sa == own ? sb : sa]) taken[*other] = true;
      }
      layer_of_set[own] = static_cast<std::size_t>(std::ranges::find(taken, false) - taken.begin());
    }
    out.push_back(*layer_of_set[own]);
  }
  return out;
}

/// A polygon without rings that touch, cut across where they do.
auto simple(const Polygon& polygon) -> std::vector<Polygon> {
  if (geometry::is_simple(polygon)) return {polygon};
  std::vector<Point2> corners = polygon.outer;
  for (const auto& hole : polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
  std::ranges::sort(corners);
  std::vector<double> cuts;
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (corners[i] == corners[i - 1] && (cuts.empty() || cuts.back() != corners[i].x)) cuts.push_back(corners[i].x);
  if (cuts.empty()) return {polygon};
  const Box2 box = geometry::bounds(polygon.outer);
  cuts.insert(cuts.begin(), box.least.x - 1);
  cuts.push_back(box.most.x + 1);
  std::vector<Polygon> out;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i + 1] <= cuts[i]) continue;
    const double low = box.least.y - 1, high = box.most.y + 1;
    auto strip =
        geometry::intersect(polygon, {{{cuts[i], low}, {cuts[i + 1], low}, {cuts[i + 1], high}, {cuts[i], high}}, {}});
    if (!strip) return {polygon};
    std::ranges::move(*strip, std::back_inserter(out));
  }
  return out;
}

/// Of pieces of one layer that share ground, the higher keeps it. Pieces in several polygons become several.
void share_out(std::vector<Piece>& pieces, std::vector<std::size_t>& layers) {
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return pieces[i].top; });
  std::vector<Piece> out;
  std::vector<std::size_t> out_layers;
  for (std::size_t o = 0; o < order.size(); ++o) {
    Piece& own = pieces[order[o]];
    for (std::size_t h = 0; h < o && !own.plan.empty(); ++h) {
      const Piece& higher = pieces[order[h]];
      if (layers[order[h]] != layers[order[o]] || !touch_in_height(own, higher) || !overlap(own, higher)) continue;
      auto left = rest(own.plan, higher.plan);
      if (!left) continue;
      own.plan = std::move(*left);
      own.whole = false;
    }
    if (own.whole) {
      out.push_back(own);
      out_layers.push_back(layers[order[o]]);
      continue;
    }
    for (const auto& polygon : own.plan)
      for (auto& one : simple(polygon)) {
        out.push_back({own.part, {std::move(one)}, {}, own.base, own.own_base, own.top, false});
        out.back().box = geometry::bounds(out.back().plan);
        out_layers.push_back(layers[order[o]]);
      }
  }
  pieces = std::move(out);
  layers = std::move(out_layers);
}

/// Pieces of a part in different layers, whose unions are made apart, share a wall: the higher ones are drawn back from
/// it, by so much that rounding does not make them overlap.
void keep_apart(std::vector<Piece>& pieces, const std::vector<std::size_t>& layers) {
  constexpr double gap = 2.0 * model::least_apart;  // units of files
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].whole) continue;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      if (pieces[k].part != pieces[i].part || layers[k] >= layers[i]) continue;
      for (const auto& other : pieces[k].plan) {
        const auto grown = geometry::buffer(other, gap);
        if (!grown) continue;
        if (auto left = rest(pieces[i].plan, *grown); left && !left->empty()) pieces[i].plan = std::move(*left);
      }
    }
  }
}

}  // namespace

auto stack(std::span<const LabelledSolid* const> parts) -> std::vector<Stacked> {
  std::vector<Piece> pieces;
  std::vector<std::size_t> others;  // parts that stay as they are, in the lowest layer
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (auto piece = piece_of(p, *parts[p])) pieces.push_back(std::move(*piece));
    else others.push_back(p);
  }
  bool any = false;
  {
    std::vector<Box2> boxes;
    for (const auto& piece : pieces) boxes.push_back(piece.box);
    const geometry::BoxIndex index(boxes);
    for (std::size_t i = 0; i < pieces.size() && !any; ++i)
      for (const std::uint32_t k : index.overlapping(boxes[i])) any = any || (k < i && overlap(pieces[i], pieces[k]));
  }
  if (!any) return {};
  std::ranges::stable_sort(pieces, {}, [](const Piece& piece) { return std::pair(piece.base, piece.part); });
  std::vector<Piece> placed;
  for (auto& piece : pieces) put(std::move(piece), placed);
  auto layers = layers_of(placed);
  share_out(placed, layers);
  keep_apart(placed, layers);
  std::vector<Stacked> out;
  for (const auto p : others) out.push_back({p, 0, *parts[p]});
  std::vector<bool> failed(parts.size(), false);
  std::vector<std::optional<LabelledSolid>> models;
  for (const auto& piece : placed) {
    models.push_back(model_of(piece, *parts[piece.part]));
    if (!models.back()) failed[piece.part] = true;
  }
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const std::size_t p = placed[i].part;
    if (!failed[p]) out.push_back({p, layers[i], std::move(*models[i])});
    else if (std::ranges::none_of(out, [&](const Stacked& one) { return one.part == p; }))
      out.push_back({p, layers[i], *parts[p]});  // as it is: the union says what it cannot do
  }
  std::ranges::stable_sort(out, {}, [](const Stacked& one) { return std::pair(one.layer, one.part); });
  return out;
}

}  // namespace mansard::solid
