// The guarantees of docs/extrude.md on exact surfaces, before rounding: rationals are compared for being equal, with
// compared with the oracle. RC_PARAMS and MANSARD_RUNS steer the random plans (forall.hpp).
#include <gmock/gmock.h>

#include <map>
#include <set>

#include "exact.hpp"
#include "forall.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace model = mansard::model;

using namespace plans;
using model::FaceKind;
using oracle::Point3;

/// The edge of the footprint that a face is named after.
auto edge_of(const Footprint& footprint, const model::Provenance& name) -> const CanonicalEdge& {
  for (const auto& ring : footprint.rings)
    for (const CanonicalEdge& edge : ring)
      if (edge.provenance.ring == name.ring && edge.provenance.edge == name.edge) return edge;
  throw std::runtime_error("provenance of no edge of the footprint");
}

auto part_of(const Footprint& footprint, const CanonicalEdge& edge, const model::Provenance& name, bool terrace)
    -> const extrude::detail::TrackPart& {
  // What goes on upwards after a last terrace bears that terrace's number.
  for (const auto& part : footprint.tracks[edge.track])
    if (part.part == name.part && part.horizontal == terrace) return part;
  throw std::runtime_error("provenance of no part of the edge's profile");
}

TEST(Guarantee, two_the_roof_over_the_base_has_exactly_its_area) {
  for_all_plans(30, 16, [](const Plan& p) -> std::string {
    Rational roofs = 0;
    for (const auto& face : oracle::faces(surface_of(p)))
      for (const auto& [from, to] : face.boundary) roofs += from.x * to.y - from.y * to.x;
    return roofs == 0 ? "" : "area seen from above and from below differ";
  });
}

TEST(Guarantee, three_the_volume_is_the_exact_integral_of_the_wavefronts_area) {
  for_all_plans(30, 14, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    const Rational ours = oracle::volume(surface_of(footprint, cap_of(p))),
                   judged = oracle::raise(footprint, cap_of(p)).volume;
    return ours == judged ? "" : "volume " + std::to_string(ours.get_d()) + " for " + std::to_string(judged.get_d());
  });
}

TEST(Guarantee, four_a_slice_is_the_wavefront_at_that_height) {
  for_all_plans(30, 14, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    const ExactSurface surface = surface_of(footprint, cap_of(p));
    for (const auto& slab : oracle::raise(footprint, cap_of(p)).slabs)
      for (const Rational& share : {Rational(1, 7), Rational(5, 8)}) {
        const Rational z = slab.from + share * (slab.to - slab.from);
        if (oracle::section_area(surface, z) != slab.area(z))
          return "area of the section at " + std::to_string(z.get_d());
        std::set<oracle::Point> corners;
        for (const auto& [start, end] : slab.at(z)) corners.insert(start);
        const auto ours = oracle::section_corners(surface, z);
        if (std::set(ours.begin(), ours.end()) != corners)
          return "corners of the section at " + std::to_string(z.get_d());
      }
    return "";
  });
}

TEST(Guarantee, five_every_vertex_lies_exactly_on_the_planes_of_its_faces) {
  for_all_plans(60, 18, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    const Rational cap = cap_of(p);
    const ExactSurface surface = surface_of(footprint, cap);
    for (const auto& face : surface.faces) {
      const auto& node = face.node;
      const Point3 first = oracle::exact_point(surface, face.loops[0][0]);
      for (const auto& loop : face.loops)
        for (const auto v : loop) {
          const Point3 at = oracle::exact_point(surface, v);
          const auto off_line = [&](const Direction& d) { return Rational((d.a * at.y - d.b * at.x) / Rational(d.l)); };
          bool on = true;
          switch (node.kind) {
            case FaceKind::base: on = at.z == 0; break;
            case FaceKind::cap: on = at.z == cap; break;
            default: return "kind of face that no sweep makes";
            case FaceKind::connector: {
              const Direction& d = node.direction;
              on = d.a * at.y - d.b * at.x == d.a * first.y - d.b * first.x;
              break;
            }
            case FaceKind::terrace:
            case FaceKind::side: {
              const CanonicalEdge& edge = edge_of(footprint, node.provenance);
              const auto& part = part_of(footprint, edge, node.provenance, node.kind == FaceKind::terrace);
              if (node.kind == FaceKind::terrace) on = part.horizontal && at.z == part.height;
              else on = off_line(edge.direction) == edge.offset + part.inward + part.slope * (at.z - part.height);
              break;
            }
          }
          if (!on) return "vertex off its plane, kind " + std::to_string(static_cast<int>(node.kind));
        }
    }
    return "";
  });
}

TEST(Guarantee, six_the_roof_has_no_local_minimum_inside) {
  for_all_plans(60, 18, [](const Plan& p) -> std::string {
    // A level piece of the surface: corners joined by level edges or by one level face. It needs a way down.
    const auto faces = oracle::faces(surface_of(p));
    std::map<Point3, Point3> parent;
    const auto root = [&](Point3 at) {
      for (auto up = parent.find(at); up != parent.end() && !(up->second == at); up = parent.find(at)) at = up->second;
      return at;
    };
    const auto join = [&](const Point3& a, const Point3& b) {
      parent.try_emplace(a, a);
      parent.try_emplace(b, b);
      parent[root(a)] = root(b);
    };
    for (const auto& face : faces) {
      const bool level = face.kind == FaceKind::terrace;
      for (const auto& [from, to] : face.boundary) {
        if (level) join(face.boundary[0][0], from);
        if (from.z == to.z) join(from, to);
      }
    }
    std::set<Point3> has_way_down, all;
    for (const auto& face : faces)
      for (const auto& [from, to] : face.boundary) {
        all.insert(root(from));
        if (to.z < from.z) has_way_down.insert(root(from));
      }
    for (const Point3& at : all)
      if (at.z > 0 && !has_way_down.contains(at)) return "minimum at the height " + std::to_string(at.z.get_d());
    return "";
  });
}

TEST(Guarantee, seven_over_a_convex_footprint_the_roof_is_the_lower_envelope_of_its_planes) {
  for_all_plans(30, 14, [](const Plan& seed) -> std::string {
    // Another plan of the same numbers: a convex ring, a slope for every edge.
    const std::size_t n = seed.outer.points.size();
    base::Random random(static_cast<std::uint64_t>(std::llround(seed.cap * 4)) + n * 1000);
    Ring ring;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle =
          2 * std::numbers::pi * (static_cast<double>(i) + random.uniform(0.2, 0.8)) / static_cast<double>(n);
      ring.push_back({9 * std::cos(angle), 9 * std::sin(angle)});
    }
    Plan p = plan(ring, {});
    for (std::size_t i = 0; i < n; ++i) {
      p.profiles.push_back({{0, 0}, {static_cast<double>(1 + random.index(6)), 4}});
      p.outer.profile_of_edge[i] = static_cast<std::uint32_t>(i);
    }
    const Footprint footprint = footprint_of(p);
    const ExactSurface surface = surface_of(footprint, 100);
    for (const auto& face : surface.faces)
      for (const auto v : face.loops[0]) {
        const Point3 at = oracle::exact_point(surface, v);
        bool touches = at.z == 0;
        for (const CanonicalEdge& edge : footprint.rings[0]) {
          const Rational off =
              (edge.direction.a * at.y - edge.direction.b * at.x) / Rational(edge.direction.l) - edge.offset;
          const Rational height = off / footprint.tracks[edge.track][0].slope;
          if (height < at.z) return "vertex above a plane";
          touches = touches || height == at.z;
        }
        if (!touches) return "vertex on no plane";
      }
    return "";
  });
}

TEST(Guarantee, eight_mirrored_turned_renumbered_and_moved_the_surface_is_the_same) {
  for_all_plans(80, 16, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    const Rational cap = cap_of(p);
    const auto here = oracle::faces(surface_of(footprint, cap));
    const auto plain = mapped(here, [](Point3&) {});
    if (plain != mapped(oracle::faces(surface_of(renumbered(footprint), cap)), [](Point3&) {}))
      return "renumbered footprint gives another surface";
    const auto flipped = mapped(
        oracle::faces(surface_of(mirrored(footprint), cap)), [](Point3& q) { q.x = -q.x; }, true);
    if (plain != flipped) return "mirrored footprint gives another surface";
    bool turns = true, moves = true;  // where the image's numbers are still such as the canonicaliser gives
    for (const auto& ring : footprint.rings)
      for (const CanonicalEdge& e : ring) {
        turns = turns && e.direction.l < (std::int64_t{1} << 38);
        moves = moves && e.direction.l == 1;
      }
    const auto back = [](Point3& q) {
      const Rational x = (3 * q.x + 4 * q.y) / 5, y = (3 * q.y - 4 * q.x) / 5;
      q.x = x;
      q.y = y;
    };
    if (turns && plain != mapped(oracle::faces(surface_of(turned(footprint), cap)), back))
      return "turned footprint gives another surface";
    const Rational x(-5, 16), y(12345, 65536);
    const auto home = [&](Point3& q) {
      q.x -= x;
      q.y -= y;
    };
    if (moves && plain != mapped(oracle::faces(surface_of(moved(footprint, x, y), cap)), home))
      return "moved footprint gives another surface";
    return "";
  });
}

TEST(Guarantee, nine_an_empty_terrace_on_exact_lines_keeps_the_volume) {
  for_all_plans(40, 16, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    Footprint stepped = footprint;
    for (auto& track : stepped.tracks)
      for (std::size_t i = 1; i < track.size(); ++i) {
        if (track[i].horizontal || track[i - 1].horizontal) continue;
        extrude::detail::TrackPart terrace = track[i];
        terrace.horizontal = true;
        terrace.slope = terrace.run = 0;
        track.insert(track.begin() + static_cast<std::ptrdiff_t>(i), terrace);
        break;
      }
    if (oracle::volume(surface_of(footprint, cap_of(p))) != oracle::volume(surface_of(stepped, cap_of(p))))
      return "volume changed";
    return "";
  });
}

TEST(Guarantee, nine_a_lower_cap_cuts_the_higher_solid) {
  for_all_plans(30, 14, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    const Rational high = cap_of(p), low = high * Rational(5, 8);
    const ExactSurface cut = surface_of(footprint, low), whole = surface_of(footprint, high);
    const auto solid = oracle::raise(footprint, high);
    Rational volume = 0;
    for (const auto& slab : solid.slabs) {
      if (slab.from >= low) break;
      const Rational top = slab.to < low ? slab.to : low, middle = (slab.from + top) / 2;
      volume += (top - slab.from) / 6 * (slab.area(slab.from) + 4 * slab.area(middle) + slab.area(top));
      if (oracle::section_corners(cut, middle) != oracle::section_corners(whole, middle)) return "section differs";
    }
    return volume == oracle::volume(cut) ? "" : "volume differs";
  });
}

/// The footprint with more run in one part of one track, and all that comes after it further in by that.
auto wider(Footprint footprint, std::size_t track, std::size_t part, const Rational& more) -> Footprint {
  auto& parts = footprint.tracks[track];
  auto& widened = parts[part];
  if (widened.horizontal) widened.run += more;
  else if (part + 1 == parts.size()) widened.slope += more / 4;
  else widened.slope += more / (parts[part + 1].height - widened.height);
  for (std::size_t k = part + 1; k < parts.size(); ++k) parts[k].inward += more;
  return footprint;
}

TEST(Guarantee, ten_more_run_all_round_never_gives_more_volume) {
  // Under one profile the wavefront is the footprint shrunk by the run. Where profiles differ, see below.
  for_all_plans(60, 16, [](Plan p) -> std::string {
    p.outer.profile_of_edge.assign(p.outer.points.size(), 0);
    for (auto& hole : p.holes) hole.profile_of_edge.assign(hole.points.size(), 0);
    p.profiles.resize(1);
    const Footprint footprint = footprint_of(p);
    const Rational before = oracle::volume(surface_of(footprint, cap_of(p)));
    base::Random random(footprint.tracks.size(), static_cast<std::uint64_t>(p.cap * 64));
    const std::size_t track = random.index(footprint.tracks.size());
    Rational more(static_cast<long>(1 + random.index(8)), 4);
    more.canonicalize();
    for (std::size_t part = 0; part < footprint.tracks[track].size(); ++part) {
      const auto after = surface_of(wider(footprint, track, part, more), cap_of(p));
      if (oracle::volume(after) > before) return "volume grew";
    }
    return "";
  });
}

TEST(Guarantee, ten_does_not_hold_for_an_edge_that_sets_off_late) {
  // A cut corner is upright up to 4 m and then set back by 3 m. Where its neighbours' roofs have met in front of it
  // before, nothing is set back: their greater run gives the greater volume.
  const auto volume = [](double run) {
    const Profile roof{{0, 0}, {0, 3}, {run, 4}, {run, 5}}, late{{0, 0}, {0, 4}, {3, 4}};
    return oracle::volume(
        surface_of(plan({{0, 0}, {10, 0}, {10, 9}, {9, 10}, {0, 10}}, {roof, late}, {0, 0, 1, 0, 0}, 8)));
  };
  EXPECT_GT(volume(0.5625), volume(0.4375));
}

TEST(Guarantee, eleven_kernel_and_oracle_agree_on_every_point_and_face) {
  for_all_plans(220, 12, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    return oracle::difference(surface_of(footprint, cap_of(p)), oracle::raise(footprint, cap_of(p)));
  });
}

TEST(Guarantee, eleven_a_face_is_named_after_an_edge_that_sweeps_it) {
  for_all_plans(30, 14, [](const Plan& p) -> std::string {
    const Footprint footprint = footprint_of(p);
    return oracle::misnamed(footprint, oracle::faces(surface_of(footprint, cap_of(p))),
                            oracle::raise(footprint, cap_of(p)).faces);
  });
}

TEST(Oracle, knows_the_volume_of_a_pyramid_a_ridge_and_a_tower) {
  const auto volume = [](const Plan& p) { return oracle::raise(footprint_of(p), cap_of(p)).volume; };
  EXPECT_EQ(volume(plan(box(10, 10), {hip})), 300 + Rational(500, 3));
  EXPECT_EQ(volume(plan(box(10, 6), {hip})), 180 + 36 + 36);
  EXPECT_EQ(volume(plan(box(12, 12), {setback}, {}, 9)), 144 * 3 + 64 * 6);
  EXPECT_EQ(volume(plan(box(10, 6), {hip, wall}, {0, 1, 0, 1})), 180 + 90);
}

TEST(Oracle, tells_the_heights_of_its_events) {
  const auto events = [](const Plan& p) { return oracle::raise(footprint_of(p), cap_of(p)).events; };
  EXPECT_THAT(events(plan(box(10, 6), {tent})), testing::ElementsAre(3));
  EXPECT_THAT(events(plan({{0, 0}, {12, 0}, {12, 4}, {6, 4}, {6, 12}, {0, 12}}, {tent})), testing::ElementsAre(2, 3));
}

TEST(Oracle, notices_a_surface_that_is_not_its_own) {
  const Footprint footprint = footprint_of(plan(box(10, 6), {hip}));
  const auto solid = oracle::raise(footprint, 100);
  EXPECT_EQ(oracle::difference(surface_of(footprint, 100), solid), "");
  EXPECT_NE(oracle::difference(surface_of(footprint, 4), solid), "");
  EXPECT_NE(oracle::difference(surface_of(plan(box(6, 10), {hip})), solid), "");  // of the same volume
}

}  // namespace
