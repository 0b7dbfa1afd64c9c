#include "mansard/solid/levels.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/solid/detail/roof_field.hpp"
#include "mansard/solid/eaves.hpp"
#include "mansard/solid/flat_roof.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::solid {
namespace {

using detail::Contact;
using detail::RoofFace;
using detail::RoofField;
using detail::RoofPlane;
using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;
using model::LabelledSolid;

/// Halves go up everywhere, so that a shift by whole metres shifts the result.
auto on_grid(double v) -> double { return std::floor(v * model::quanta_per_metre + 0.5) / model::quanta_per_metre; }

/// m; planes of faces are rounded to 0.1 mm at corners that may be a metre apart.
constexpr double same_plane = 5e-3;

/// A face that goes on over a structure, where the planes around it show it.
struct Neighbour {
  std::uint32_t face = 0;
  std::vector<Point2> middles;  ///< of the edges to it
  double length = 0;
};

/// Which plane is the roof: the lowest of all, as over a ridge, or the highest, as over a valley.
enum class Envelope : std::uint8_t { lowest, highest };

auto agrees(const std::vector<Neighbour>& around, const RoofField& field, Envelope envelope) -> bool {
  for (const auto& own : around)
    for (const auto middle : own.middles)
      for (const auto& other : around) {
        const double rise = field.faces[other.face].plane.height(middle) - field.faces[own.face].plane.height(middle);
        if (envelope == Envelope::lowest ? rise < -same_plane : rise > same_plane) return false;
      }
  return true;
}

/// What of a polygon lies where one plane is below another one (or above it).
auto where(const Polygon& polygon, const RoofPlane& own, const RoofPlane& other, Envelope envelope)
    -> std::vector<Polygon> {
  // own(p) - other(p) = c + g·p, with p relative to a corner of the polygon.
  const Point2 o = polygon.outer.front();
  const double sign = envelope == Envelope::lowest ? 1 : -1;
  const double c = sign * (own.height(o) - other.height(o));
  const Point2 g{sign * (own.height(o + Point2{1, 0}) - other.height(o + Point2{1, 0})) - c,
                 sign * (own.height(o + Point2{0, 1}) - other.height(o + Point2{0, 1})) - c};
  const double steep = length(g);
  constexpr double parallel = 1e-9;
  if (steep < parallel) return c <= 0 ? std::vector{polygon} : std::vector<Polygon>();
  const auto box = geometry::bounds(polygon.outer);
  const double reach = 2 * length(box.most - box.least) + 1;
  const Point2 down = (-1 / steep) * g, along = geometry::left_of(down);
  const Point2 middle = o + (c / steep) * down;  // on the line where both are equal
  const Point2 near = middle + dot(0.5 * (box.least + box.most) - middle, along) * along;
  const Polygon half{{near - reach * along, near + reach * along, near + reach * along + 2 * reach * down,
                      near - reach * along + 2 * reach * down},
                     {}};
  auto pieces = geometry::intersect(polygon, geometry::oriented(half));
  return pieces ? std::move(*pieces) : std::vector<Polygon>();
}

/// The loops of a polygon in a plane, on the grid of files. Corners of the roof around it stay as high as they are.
auto loops_in(const Polygon& polygon, const RoofPlane& plane, const std::map<Point2, double>& corners)
    -> std::vector<std::vector<Point3>> {
  std::vector<std::vector<Point3>> out;
  const auto add = [&](const geometry::Ring& ring) {
    auto& loop = out.emplace_back();
    for (const auto p : ring) {
      const Point2 at{on_grid(p.x), on_grid(p.y)};
      double z = on_grid(plane.height(p));
      if (const auto corner = corners.find(at); corner != corners.end() && std::abs(corner->second - z) < same_plane)
        z = corner->second;
      const Point3 q{at.x, at.y, z};
      if (loop.empty() || loop.back() != q) loop.push_back(q);
    }
    while (loop.size() > 1 && loop.back() == loop.front()) loop.pop_back();
    if (loop.size() < 3) out.pop_back();
  };
  const auto upright = geometry::oriented(polygon);
  add(upright.outer);
  if (out.empty()) return {};
  for (const auto& hole : upright.holes) add(hole);
  return out;
}

/// One neighbour of each plane, that with the longest contact: rounding cuts slopes into triangles, whose planes differ
/// by less than what counts here.
auto distinct(std::vector<Neighbour> around, const RoofField& field) -> std::vector<Neighbour> {
  // Rounded, so that equal lengths stay equal wherever the building is.
  const auto by_length = [](const Neighbour& one) { return std::llround(one.length * model::quanta_per_metre); };
  std::ranges::stable_sort(around, std::greater(), by_length);
  std::vector<Neighbour> out;
  for (auto& one : around) {
    const auto& plane = field.faces[one.face].plane;
    const auto same = std::ranges::find_if(out, [&](const Neighbour& kept) {
      const auto agree = [&](Point2 p) {
        return std::abs(field.faces[kept.face].plane.height(p) - plane.height(p)) < same_plane;
      };
      return std::ranges::all_of(kept.middles, agree) && std::ranges::all_of(one.middles, agree);
    });
    if (same == out.end()) {
      out.push_back(std::move(one));
      continue;
    }
    same->length += one.length;
    same->middles.insert(same->middles.end(), one.middles.begin(), one.middles.end());
  }
  std::ranges::stable_sort(out, std::greater(), by_length);
  return out;
}

/// What a structure gives way to: loops, by the face in whose plane they lie.
using Filling = std::vector<std::pair<std::uint32_t, std::vector<std::vector<Point3>>>>;

/// Volume below some faces, from z = 0, in m³.
auto volume_below(const std::vector<std::vector<Point3>>& loops) -> double {
  double sum = 0;
  for (const auto& loop : loops)
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      sum += cross(xy(loop[i] - loop[0]), xy(loop[i + 1] - loop[0])) * (loop[0].z + loop[i].z + loop[i + 1].z) / 6;
  return sum;
}

auto filling_of(const std::vector<const RoofFace*>& structure, const std::vector<Neighbour>& around,
                const RoofField& field, double base) -> Filling {
  std::vector<Polygon> faces;
  for (const RoofFace* face : structure)
    faces.push_back(geometry::oriented(geometry::polygon_of(face->loops, [](Point3 p) { return xy(p); })));
  auto ground = faces.size() == 1 ? base::Result<std::vector<Polygon>>(faces) : geometry::unite(faces);
  if (!ground) return {};
  std::map<Point2, double> corners;
  for (const auto& one : around)
    for (const auto& loop : field.faces[one.face].loops)
      for (const auto p : loop) corners.emplace(xy(p), p.z);
  std::vector<Neighbour> planes = distinct(around, field);
  auto envelope = Envelope::lowest;
  if (!agrees(planes, field, envelope)) envelope = Envelope::highest;
  if (!agrees(planes, field, envelope)) planes.resize(1);
  Filling out;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    std::vector<Polygon> own = *ground;
    const auto& plane = field.faces[planes[i].face].plane;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      if (k == i) continue;
      std::vector<Polygon> left;
      for (const auto& polygon : own) {
        auto pieces = where(polygon, plane, field.faces[planes[k].face].plane, envelope);
        left.insert(left.end(), pieces.begin(), pieces.end());
      }
      own = std::move(left);
    }
    for (const auto& polygon : own) {
      auto loops = loops_in(polygon, plane, corners);
      for (const auto& loop : loops)
        for (const auto p : loop)
          if (p.z <= base) return {};  // the plane would go into the ground
      if (!loops.empty()) out.emplace_back(planes[i].face, std::move(loops));
    }
  }
  return out;
}

/// What may be left out: a piece of roof, or faces of a larger piece that meet it at edges, as the roof of a dormer
/// does.
struct Structure {
  std::vector<std::uint32_t> faces;
  bool is_piece = true;
  double outline = 0;  ///< m
};

auto perimeter(const RoofFace& face) -> double {
  double sum = 0;
  for (const auto& loop : face.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) sum += length(xy(loop[(i + 1) % loop.size()] - loop[i]));
  return sum;
}

/// Small pieces, and in larger ones the small faces that are connected without a valley between them.
auto structures_of(const RoofField& field, std::span<const Contact> seams, double limit) -> std::vector<Structure> {
  std::vector<double> areas(field.pieces);
  for (const auto& face : field.faces) areas[face.piece] += face.area;
  // A roof bends upwards where a dormer meets the slope behind it. Less than this is one plane, rounded.
  constexpr double even = 1e-3;
  base::DisjointSets sets(field.faces.size());
  for (const auto& seam : seams) {
    const auto &a = field.faces[seam.face], &b = field.faces[seam.other];
    if (areas[a.piece] < limit || (a.area < limit && b.area < limit && seam.rise < even))
      sets.join(seam.face, seam.other);
  }
  std::map<std::size_t, Structure> all;
  for (std::uint32_t f = 0; f < field.faces.size(); ++f) {
    auto& one = all[sets.of(f)];
    one.faces.push_back(f);
    one.is_piece = areas[field.faces[f].piece] < limit;
    one.outline += perimeter(field.faces[f]);
  }
  for (const auto& seam : seams)
    if (const auto set = sets.of(seam.face); set == sets.of(seam.other)) all[set].outline -= seam.length;
  std::vector<Structure> out;
  for (auto& [set, one] : all) {
    double area = 0;
    for (const auto f : one.faces) area += field.faces[f].area;
    if (area < limit) out.push_back(std::move(one));
  }
  return out;
}

/// Makes one face of those that are in one plane with a face that has changed: of the triangles that rounding cut a
/// slope with dormers into.
void join_triangles(RoofField& field, std::span<const Contact> seams, const std::vector<bool>& changed,
                    const std::vector<bool>& gone) {
  constexpr double flat = 1e-3;  // m
  const auto contains = [&](const RoofFace& face, const RoofFace& other) {
    return std::ranges::all_of(other.loops[0],
                               [&](Point3 p) { return std::abs(face.plane.height(xy(p)) - p.z) < flat; });
  };
  std::vector<std::uint32_t> order(field.faces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::greater(), [&](std::uint32_t f) {
    // Twice an area is a whole number of units of the grid.
    return std::llround(2 * field.faces[f].area * model::quanta_per_metre * model::quanta_per_metre);
  });
  std::vector<std::vector<std::uint32_t>> beside(field.faces.size());
  for (const auto& seam : seams) beside[seam.face].push_back(seam.other);
  std::vector<bool> taken = gone;
  for (const auto first : order) {
    if (!changed[first] || taken[first]) continue;
    taken[first] = true;
    std::vector<std::uint32_t> open{first};
    for (std::size_t i = 0; i < open.size(); ++i)
      for (const auto f : beside[open[i]]) {
        if (taken[f] || !contains(field.faces[first], field.faces[f])) continue;
        taken[f] = true;
        open.push_back(f);
        auto& loops = field.faces[f].loops;
        std::ranges::move(loops, std::back_inserter(field.faces[first].loops));
        loops.clear();
      }
  }
}

/// Takes out every structure that is on a larger piece. Whether there was one. `dormers`: also those that are not
/// pieces of their own.
auto take_out(RoofField& field, double base, const LevelOptions& options, bool dormers) -> bool {
  const auto seams = field.seams();
  const auto structures = structures_of(field, seams, options.lod20_structure);
  std::vector<std::optional<std::size_t>> of(field.faces.size());
  for (std::size_t s = 0; s < structures.size(); ++s)
    for (const auto f : structures[s].faces) of[f] = s;
  // By structure and by the piece beside it. A dormer is on its own piece, of which other dormers are not the roof.
  std::vector<std::map<std::uint32_t, std::vector<Contact>>> beside(structures.size());
  std::vector<double> walls(structures.size());
  const auto add = [&](const Contact& contact, bool wall) {
    const auto own = of[contact.face];
    if (!own || of[contact.other] == own) return;
    const auto piece = field.faces[contact.other].piece;
    if (!structures[*own].is_piece && (piece != field.faces[contact.face].piece || of[contact.other])) return;
    beside[*own][piece].push_back(contact);
    if (wall) walls[*own] += contact.length;
  };
  for (const auto& contact : field.contacts()) add(contact, true);
  for (const auto& seam : seams) add(seam, false);
  std::vector<double> areas(field.pieces);
  for (const auto& face : field.faces) areas[face.piece] += face.area;
  std::vector<bool> gone(field.faces.size()), changed(field.faces.size());
  std::vector<std::vector<std::vector<std::vector<Point3>>>> more(field.faces.size());
  for (std::size_t s = 0; s < structures.size(); ++s) {
    const auto& structure = structures[s];
    if (beside[s].empty() || (!dormers && !structure.is_piece)) continue;
    const auto host = std::ranges::max_element(beside[s], {}, [](const auto& other) {
      double sum = 0;
      for (const auto& contact : other.second) sum += contact.length;
      return sum;
    });
    double own = 0, touched = 0;
    for (const auto f : structure.faces) own += field.faces[f].area;
    if (areas[host->first] - (structure.is_piece ? 0 : own) <= own) continue;
    std::map<std::uint32_t, Neighbour> around;
    for (const auto& contact : host->second) {
      touched += contact.length;
      auto& one = around[contact.other];
      one.face = contact.other;
      one.length += contact.length;
      one.middles.push_back(contact.middle);
    }
    if (touched <= options.lod20_surrounded * structure.outline) continue;
    // Roofs of wings and hips meet the roof at edges alone; a dormer whose front is in the wall of the house has
    // cheeks.
    constexpr double least_walls = 0.2;  // of the outline
    if (!structure.is_piece && walls[s] <= least_walls * structure.outline) continue;
    if (std::ranges::any_of(structure.faces, [&](std::uint32_t f) { return changed[f]; }) ||
        std::ranges::any_of(around, [&](const auto& one) { return gone[one.first]; }))
      continue;
    std::vector<const RoofFace*> faces;
    for (const auto f : structure.faces) faces.push_back(&field.faces[f]);
    std::vector<Neighbour> list;
    for (const auto& [face, one] : around) list.push_back(one);
    auto filling = filling_of(faces, list, field, base);
    double raised = 0;  // m³
    for (const auto& [face, loops] : filling) raised += volume_below(loops);
    for (const auto* face : faces) raised -= volume_below(face->loops);
    if (filling.empty() || raised >= options.lod13_step * own) continue;  // light wells
    for (auto& [face, loops] : filling) more[face].push_back(std::move(loops));
    for (const auto f : structure.faces) gone[f] = true;
    for (const auto& [face, one] : around) changed[face] = true;
  }
  if (std::ranges::none_of(gone, std::identity())) return false;
  for (std::size_t f = 0; f < field.faces.size(); ++f)
    for (auto& loops : more[f])
      for (auto& loop : loops) field.faces[f].loops.push_back(std::move(loop));
  join_triangles(field, seams, changed, gone);
  std::vector<RoofFace> kept;
  for (std::size_t f = 0; f < field.faces.size(); ++f)
    if (!gone[f] && !field.faces[f].loops.empty()) kept.push_back(std::move(field.faces[f]));
  field.faces = std::move(kept);
  return true;
}

auto ground_level(const LabelledSolid& solid) -> double {
  for (std::size_t f = 0; f < solid.classes.size(); ++f)
    if (solid.classes[f] == model::FaceClass::ground) return solid.solid.vertices[solid.solid.faces[f].loops[0][0]].z;
  return 0;
}

/// Pieces that are joined as one flat one: the number of each, and its height.
struct Terraces {
  std::vector<std::uint32_t> of;
  std::map<std::uint32_t, double> height;
};

auto height_of(const RoofField& field, const std::vector<std::uint32_t>& of, std::uint32_t terrace) -> double {
  std::vector<const RoofFace*> own;
  for (const auto& face : field.faces)
    if (of[face.piece] == terrace) own.push_back(&face);
  return on_grid(detail::height_at(own, 0.7));
}

/// Of all adjacent terraces those of the most similar height are joined, until a step is between any two.
auto terraces_of(const RoofField& field, double step) -> Terraces {
  Terraces out;
  out.of.resize(field.pieces);
  std::iota(out.of.begin(), out.of.end(), 0U);
  for (std::uint32_t p = 0; p < field.pieces; ++p) out.height[p] = height_of(field, out.of, p);
  std::set<std::pair<std::uint32_t, std::uint32_t>> adjacent;
  for (const auto& contact : field.contacts())
    if (const auto a = field.faces[contact.face].piece, b = field.faces[contact.other].piece; a != b)
      adjacent.insert(std::minmax(a, b));
  for (;;) {
    std::optional<std::pair<std::uint32_t, std::uint32_t>> best;
    double least = step;
    for (const auto& [a, b] : adjacent) {
      if (out.of[a] == out.of[b]) continue;
      const double off = std::abs(out.height[out.of[a]] - out.height[out.of[b]]);
      if (off < least) least = off, best = {out.of[a], out.of[b]};
    }
    if (!best) return out;
    const auto kept = std::min(best->first, best->second), other = std::max(best->first, best->second);
    std::ranges::replace(out.of, other, kept);
    out.height.erase(other);
    out.height[kept] = height_of(field, out.of, kept);
  }
}

}  // namespace

auto option_list(LevelOptions& o) -> base::OptionList {
  return std::move(
      base::OptionList("solid")
          .number("lod13_step", o.lod13_step, "m", {0, 1000},
                  "Smallest step of height between two roofs that LoD 1.3 keeps, and depth from which LoD 2.0 keeps a "
                  "small recess.")
          .source("that of roofer, its option lod13-step-height, so that models can be compared")
          .number("lod20_structure", o.lod20_structure, "m²", {0, 1e6},
                  "Area below which LoD 2.0 leaves out a structure on a roof.")
          .source("Biljecki, Ledoux and Stoter 2016, table 1: large building parts, 10 m²")
          .number("lod20_surrounded", o.lod20_surrounded, "", {0, 1},
                  "Share of the outline of a structure that one roof must touch, so that LoD 2.0 leaves it "
                  "out.")
          .advanced("more than half: an annex beside a house touches it on one side of four"));
}

auto main_roofs(const LabelledSolid& whole, const LevelOptions& options) -> LabelledSolid {
  LabelledSolid solid = without_eaves(whole);
  auto field = detail::roof_field(solid);
  if (!field) return solid;
  const double base = ground_level(solid);
  std::optional<LabelledSolid> best;
  LabelledSolid before = solid;
  // Again for what was on a structure.
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    std::optional<LabelledSolid> made;
    for (const bool dormers : {true, false}) {
      auto changed = *field;
      if (made || !take_out(changed, base, options, dormers)) break;
      made = detail::solid_below(changed, before);
    }
    if (!made) break;
    before = *made;
    best = std::move(made);
    field = detail::roof_field(before);
    if (!field) break;
  }
  return best ? *std::move(best) : solid;
}

namespace {

/// The solid with a flat roof over every terrace.
auto with_terraces(const RoofField& field, const Terraces& terraces, const LabelledSolid& solid) -> LabelledSolid {
  RoofField flat;
  for (const auto& [number, height] : terraces.height) {
    auto& face = flat.faces.emplace_back();
    face.plane = {{0, 0, height}, {0, 0, 1}};
    bool first = true;
    for (const auto& from : field.faces) {
      if (terraces.of[from.piece] != number) continue;
      if (first) face.face = from.face;
      first = false;
      for (auto loop : from.loops) {
        for (auto& p : loop) p.z = height;
        face.loops.push_back(std::move(loop));
      }
    }
  }
  auto made = detail::solid_below(flat, solid);
  return made ? *std::move(made) : LabelledSolid();
}

}  // namespace

auto flat_pieces(const LabelledSolid& whole, const LevelOptions& options) -> LabelledSolid {
  const LabelledSolid solid = without_eaves(whole);
  const auto field = detail::roof_field(solid);
  if (!field || field->pieces < 2) return {};
  const auto terraces = terraces_of(*field, options.lod13_step);
  return terraces.height.size() < 2 ? LabelledSolid() : with_terraces(*field, terraces, solid);
}

auto flat_roof(const LabelledSolid& whole, double z) -> LabelledSolid {
  const LabelledSolid solid = without_eaves(whole);
  const auto field = detail::roof_field(solid);
  if (!field || !(z > ground_level(solid))) return {};
  return with_terraces(*field, {std::vector<std::uint32_t>(field->pieces, 0), {{0, on_grid(z)}}}, solid);
}

auto roof_percentile(const LabelledSolid& solid, double share) -> double {
  const auto& model = solid.solid;
  std::vector<RoofFace> faces;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    if (solid.classes[f] != model::FaceClass::roof) continue;
    auto& face = faces.emplace_back();
    for (const auto& loop : model.faces[f].loops) {
      auto& points = face.loops.emplace_back();
      for (const auto v : loop) points.push_back(model.vertices[v]);
    }
  }
  std::vector<const RoofFace*> all;
  for (const auto& face : faces) all.push_back(&face);
  return all.empty() ? 0 : detail::height_at(all, share);
}

auto val3dity_codes(std::span<const base::Diagnostic> findings) -> std::vector<int> {
  constexpr std::array<std::pair<std::string_view, int>, 10> codes{{{"solid-degenerate", 104},
                                                                    {"solid-near-vertices", 102},
                                                                    {"solid-not-planar", 203},
                                                                    {"solid-needle", 204},
                                                                    {"solid-open", 302},
                                                                    {"solid-non-manifold", 303},
                                                                    {"solid-several-shells", 305},
                                                                    {"solid-self-intersection", 306},
                                                                    {"solid-orientation", 307},
                                                                    {"solid-overlap", 601}}};
  std::set<int> out;
  for (const auto& finding : findings)
    for (const auto& [code, number] : codes)
      if (finding.code == code) out.insert(number);
  return {out.begin(), out.end()};
}

}  // namespace mansard::solid
