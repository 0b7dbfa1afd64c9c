// Bytes → a polygon with profiles → raise. It must not throw, must refuse only what is really wrong, and what it gives
// must pass the check, lie between nothing and the prism, say why when it is less than full, and be full for a plan
// without small details.
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "fuzz/fuzz.hpp"
#include "mansard/base/text.hpp"

namespace {

using namespace mansard;
using fuzz::promise;
using geometry::Point2;
using geometry::Ring;
using model::Plan;
using model::Profile;

/// Numbers from the bytes; zeros when they have run out.
class Bytes {
 public:
  Bytes(const std::uint8_t* bytes, std::size_t size) : rest_(bytes, size) {}
  auto byte() -> int {
    if (rest_.empty()) return 0;
    const int value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }
  auto index(int count) -> int { return byte() % count; }
  /// −32768 … 32767
  auto word() -> int {
    const int high = byte();
    return static_cast<std::int16_t>((high << 8) | byte());
  }
  /// Metres from 0 on, mostly round: whole, half, tenth, or any 1/256.
  auto length(int most) -> double {
    const int kind = index(8), value = byte();
    switch (kind) {
      case 0: return 0;
      case 1: return (value % (10 * most)) / 10.0;
      case 2: return value * most / 256.0;
      case 3:
      case 4: return value % (2 * most) / 2.0;
      default: return value % most;
    }
  }

 private:
  std::span<const std::uint8_t> rest_;
};

/// Turns at right angles, over whole or half metres or anything: ties.
auto walk(Bytes& bytes, int steps) -> Ring {
  Ring ring;
  Point2 at{0, 0};
  for (int i = 0; i < steps; ++i) {
    ring.push_back(at);
    const double sign = bytes.index(2) == 0 ? 1 : -1, by = sign * std::max(bytes.length(9), 0.25);
    (i % 2 == 0 ? at.x : at.y) += by;
  }
  if (at.x != 0 || at.y != 0) ring.push_back(at);  // back along x, then along y
  if (at.x != 0 && at.y != 0) ring.push_back({0, at.y});
  return ring;
}

auto points(Bytes& bytes, int count) -> Ring {
  constexpr std::array<double, 4> scales{0x1.0p-16, 0x1.0p-10, 0x1.0p-8, 1e-3};
  const double scale = scales[static_cast<std::size_t>(bytes.index(4))];
  Ring ring;
  for (int i = 0; i < count; ++i) {
    const double x = scale * bytes.word();
    ring.push_back({x, scale * bytes.word()});
  }
  return ring;
}

/// Round the origin, so that it is simple whatever the bytes are.
auto star(Bytes& bytes, int count) -> Ring {
  const bool regular = bytes.index(2) == 0;
  Ring ring;
  for (int i = 0; i < count; ++i) {
    const double within = regular ? 0.5 : 0.1 + 0.8 * bytes.byte() / 256;
    const double angle = 2 * std::numbers::pi * (i + within) / count, r = 3 + bytes.length(9);
    ring.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return ring;
}

auto ring_of(Bytes& bytes) -> Ring {
  const int kind = bytes.index(4), count = 3 + bytes.index(30);
  Ring ring = kind == 0 ? points(bytes, count) : kind == 1 ? star(bytes, count) : walk(bytes, count);
  if (bytes.index(2) == 0) {
    const double angle = bytes.word() / 10000.0, c = std::cos(angle), s = std::sin(angle);
    for (Point2& p : ring) p = {c * p.x - s * p.y, s * p.x + c * p.y};
  }
  return ring;
}

auto profile_of(Bytes& bytes) -> Profile {
  Profile profile{{0, 0}};
  const int parts = 1 + bytes.index(5);
  for (int i = 0; i < parts; ++i) {
    const auto last = profile.back();
    const double inward = bytes.index(3) == 0 ? 0 : bytes.length(4), height = bytes.index(4) == 0 ? 0 : bytes.length(8);
    profile.push_back({last.inward + inward, last.height + (inward == 0 && height == 0 ? 1 : height)});
  }
  return profile;
}

auto plan_of(Bytes& bytes) -> Plan {
  Plan plan;
  const int profiles = 1 + bytes.index(4), holes = std::max(0, bytes.index(6) - 3);
  for (int i = 0; i < profiles; ++i) plan.profiles.push_back(profile_of(bytes));
  plan.cap = bytes.index(3) == 0 ? 1000 : 0.5 + bytes.length(20);
  plan.base = bytes.index(2) == 0 ? 0 : bytes.word() / 16.0;
  geometry::Polygon polygon{ring_of(bytes), {}};
  for (int i = 0; i < holes; ++i) {
    Ring hole = bytes.index(2) == 0 ? Ring{{0, 0}, {2, 0}, {2, 2}, {0, 2}} : ring_of(bytes);
    const double size = 1.0 / (1 + bytes.index(8)), x = bytes.word() / 2048.0, y = bytes.word() / 2048.0;
    for (Point2& p : hole) p = size * p + Point2{x, y};
    polygon.holes.push_back(std::move(hole));
  }
  polygon = geometry::oriented(std::move(polygon));
  const auto fill = [&](model::PlanRing& ring, Ring& from) {
    ring.points = std::move(from);
    for (std::size_t i = 0; i < ring.points.size(); ++i)
      ring.profile_of_edge.push_back(static_cast<std::uint32_t>(bytes.index(profiles)));
  };
  fill(plan.outer, polygon.outer);
  for (Ring& hole : polygon.holes) fill(plan.holes.emplace_back(), hole);
  return plan;
}

auto text(const Plan& plan) -> std::string {
  std::string out;
  const auto number = [&](double value) { out += base::to_text(value) + " "; };
  const auto ring = [&](const model::PlanRing& r) {
    for (std::size_t i = 0; i < r.points.size(); ++i) {
      number(r.points[i].x);
      number(r.points[i].y);
      out += "p" + std::to_string(r.profile_of_edge[i]) + ", ";
    }
    out += "\n";
  };
  out += "\nbase ";
  number(plan.base);
  out += "cap ";
  number(plan.cap);
  out += "\n";
  ring(plan.outer);
  for (const auto& hole : plan.holes) ring(hole);
  for (const Profile& profile : plan.profiles) {
    out += "profile ";
    for (const auto& knot : profile) {
      number(knot.inward);
      number(knot.height);
      out += ", ";
    }
    out += "\n";
  }
  return out;
}

/// The smallest distance between what is not next to each other on the outline, or between neighbours' ends, in metres.
auto smallest_detail(const geometry::Polygon& polygon) -> double {
  std::vector<geometry::Segment2> edges;
  std::vector<std::pair<std::size_t, std::size_t>> place;  // ring's first edge and size
  const auto add = [&](const Ring& ring) {
    const std::size_t first = edges.size();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
      place.emplace_back(first, ring.size());
    }
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [first, size] = place[e];
    least = std::min(least, length(edges[e].end - edges[e].start));
    for (std::size_t v = 0; v < edges.size(); ++v) {
      const bool own = v == e || v == first + (e - first + 1) % size;
      if (!own) least = std::min(least, geometry::distance(edges[e], edges[v].start));
    }
  }
  return least;
}

/// Rings that do not meet, holes inside and beside each other.
auto valid(const geometry::Polygon& polygon) -> bool {
  const auto clear_of_others = [&](const Ring& hole) {
    return std::ranges::none_of(
        polygon.holes, [&](const Ring& other) { return &other != &hole && geometry::contains(other, hole[0]); });
  };
  return geometry::is_simple(polygon) && std::ranges::all_of(polygon.holes, [&](const Ring& hole) {
           return geometry::contains(polygon.outer, hole[0]) && clear_of_others(hole);
         });
}

/// Whether a plan has neither details under 30 cm nor corners under 6° nor setbacks at the ground, which can leave
/// nothing: then only its full solid will do.
auto harmless(const Plan& plan, const geometry::Polygon& polygon) -> bool {
  constexpr double detail = 0.3, sharp = 0.1;
  const auto blunt = [](const Ring& ring) {
    for (std::size_t i = 0, n = ring.size(); i < n; ++i) {
      const Point2 in = ring[(i + 1) % n] - ring[i], out = ring[(i + 2) % n] - ring[(i + 1) % n];
      if (dot(in, out) < 0 && std::abs(cross(in, out)) < sharp * length(in) * length(out)) return false;
    }
    return true;
  };
  const auto starts_upwards = [](const Profile& profile) { return profile[1].height > 0; };
  return std::ranges::all_of(plan.profiles, starts_upwards) && smallest_detail(polygon) >= detail &&
         blunt(polygon.outer) && std::ranges::all_of(polygon.holes, blunt);
}

void try_plan(const Plan& plan) {
  const auto shown = [&] { return text(plan); };
  const auto with = [&](const std::string& more) { return [&plan, more] { return more + text(plan); }; };
  const geometry::Polygon polygon = model::polygon_of(plan);
  const auto raised = extrude::raise(plan);
  if (!raised) {
    const std::string refusal = base::to_string(raised.error());
    const auto codes = extrude::codes();
    const auto known = std::ranges::find(codes, raised.error().code, &base::Code::code);
    promise(known != codes.end() && known->code.starts_with("extrude-") && known->exit_code != 0,
            "an error that is not the module's", with(refusal));
    promise(!valid(polygon) || smallest_detail(polygon) < 0.01, "a simple polygon is refused", with(refusal));
    return;
  }
  const auto faults = solid::check(raised->solid);
  promise(faults.empty(), "not a valid solid", [&] { return base::to_string(faults[0]) + text(plan); });
  const double volume = solid::volume(raised->solid), most = geometry::area(polygon) * plan.cap;
  const double slack = 1e-6 * most + 0.3 * geometry::perimeter(polygon.outer) * plan.cap;
  promise(volume > 0 && volume < most + slack, "a volume that cannot be", with(base::to_text(volume)));
  for (const geometry::Point3 v : raised->solid.vertices)
    promise(v.z >= plan.base - 1e-6 && v.z <= plan.base + plan.cap + 1e-3, "a vertex below or above all", shown);

  std::string reasons;
  for (const base::Diagnostic& w : raised->warnings)
    if (w.code == "extrude-simplified" || w.code == "extrude-two-part" || w.code == "extrude-prism")
      reasons += base::to_string(w) + "\n";
  const bool full = raised->outcome == extrude::Outcome::full;
  promise(full || !reasons.empty(), "a step down without a reason", shown);
  promise(!full || reasons.empty(), "a step down that was none", with(reasons));
  promise(full || !harmless(plan, polygon), "a step down without need", with(reasons));
}

}  // namespace

auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int {
  Bytes rest(bytes, size);
  const Plan plan = plan_of(rest);
  try {
    try_plan(plan);
  } catch (const std::exception& thrown) {
    promise(false, "an exception left the module", [&] { return thrown.what() + text(plan); });
  }
  return 0;
}
