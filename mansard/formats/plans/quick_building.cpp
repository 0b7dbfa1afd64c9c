#include "mansard/formats/plans/quick_building.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mansard/formats/plans/plan_items.hpp"

namespace mansard::formats::detail {
namespace {

/// Members of one object, none of which may come twice.
template <std::size_t N>
class Members {
 public:
  Members(JsonCursor& json, const std::string_view (&names)[N]) : json_(json) {  // NOLINT: deduces N
    std::ranges::copy(names, names_.begin());
  }
  /// The place of the name in the list; fails where it is not there or was here before.
  auto operator()(std::string_view name) -> std::size_t {
    const auto at = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
    if (at == names_.size() || (seen_ & (1U << at)) != 0) json_.fail();
    seen_ |= 1U << at;
    return at;
  }
  [[nodiscard]] auto has(std::size_t at) const -> bool { return (seen_ & (1U << at)) != 0; }

 private:
  JsonCursor& json_;
  std::array<std::string_view, N> names_;
  unsigned seen_ = 0;
};

void require(JsonCursor& json, bool holds) {
  if (!holds) json.fail();
}

/// As Item::number: of the two zeros always the one.
auto number(JsonCursor& json) -> double { return json.number() + 0.0; }

auto number_up_to(JsonCursor& json, double most) -> double {
  const double value = number(json);
  require(json, std::abs(value) <= most);
  return value;
}

auto pair(JsonCursor& json) -> std::pair<double, double> {
  std::pair<double, double> out;
  std::size_t count = 0;
  json.array([&] {
    const double value = number(json);
    if (count == 0) out.first = value;
    else out.second = value;
    ++count;
  });
  require(json, count == 2);
  return out;
}

auto ring(JsonCursor& json) -> geometry::Ring {
  geometry::Ring out;
  json.array([&] {
    const auto [x, y] = pair(json);
    require(json, std::max(std::abs(x), std::abs(y)) <= farthest);
    out.push_back({x, y});
  });
  require(json, out.size() >= 3);
  return out;
}

auto footprint(JsonCursor& json) -> std::vector<geometry::Polygon> {
  std::vector<geometry::Polygon> out;
  json.array([&] {
    auto& polygon = out.emplace_back();
    Members which(json, {"outer", "holes"});
    json.object([&](std::string_view name) {
      if (which(name) == 0) polygon.outer = ring(json);
      else json.array([&] { polygon.holes.push_back(ring(json)); });
    });
    require(json, which.has(0));
  });
  return out;
}

auto plan_ring(JsonCursor& json) -> model::PlanRing {
  model::PlanRing out;
  Members which(json, {"points", "profile_of_edge", "overhang_of_edge"});
  json.object([&](std::string_view name) {
    switch (which(name)) {
      case 0: out.points = ring(json); break;
      case 1:
        json.array([&] {
          const auto value = json.value();
          const auto* edge = std::get_if<std::int64_t>(&value);
          require(json, edge != nullptr && *edge >= 0 && *edge < std::int64_t{1} << 31U);
          if (json.good()) out.profile_of_edge.push_back(static_cast<std::uint32_t>(*edge));
        });
        break;
      default:
        json.array([&] {
          const double metres = number(json);
          require(json, metres >= 0 && metres <= farthest_overhang);
          out.overhang_of_edge.push_back(metres);
        });
    }
  });
  require(json, which.has(0) && which.has(1) && out.profile_of_edge.size() == out.points.size());
  require(json, !which.has(2) || out.overhang_of_edge.size() == out.points.size());
  return out;
}

auto profile(JsonCursor& json) -> model::Profile {
  model::Profile out;
  json.array([&] {
    const auto [inward, height] = pair(json);
    out.push_back({inward, height});
  });
  require(json, out.size() >= 2 && out.front() == model::ProfilePoint{0, 0});
  for (std::size_t i = 1; i < out.size(); ++i) {
    const auto &a = out[i - 1], &b = out[i];
    require(json, std::max(b.inward, b.height) <= longest_profile && !(a == b) && b.inward >= a.inward &&
                      b.height >= a.height);
  }
  return out;
}

auto plan(JsonCursor& json) -> model::Plan {
  model::Plan out;
  Members which(json, {"base", "cap", "outer", "holes", "profiles"});
  json.object([&](std::string_view name) {
    switch (which(name)) {
      case 0: out.base = number_up_to(json, farthest); break;
      case 1:
        out.cap = number(json);
        require(json, out.cap > 0 && out.cap <= highest_cap);
        break;
      case 2: out.outer = plan_ring(json); break;
      case 3: json.array([&] { out.holes.push_back(plan_ring(json)); }); break;
      default: json.array([&] { out.profiles.push_back(profile(json)); });
    }
  });
  for (std::size_t i = 0; i < 5; ++i) require(json, which.has(i));
  const auto known = [&](const model::PlanRing& one) {
    return std::ranges::all_of(one.profile_of_edge, [&](auto edge) { return edge < out.profiles.size(); });
  };
  require(json, known(out.outer) && std::ranges::all_of(out.holes, known));
  return out;
}

/// Whether no two are of one name. Most buildings have the names of others, which are not compared again.
auto are_different(const model::Attributes& attributes) -> bool {
  constexpr std::size_t most_known = 32;
  thread_local std::vector<std::vector<std::string>> known;
  const auto is_of = [&](const std::vector<std::string>& names) {
    return std::ranges::equal(names, attributes, {}, {}, &model::Attributes::value_type::first);
  };
  if (std::ranges::any_of(known, is_of)) return true;
  std::vector<std::string> names;
  for (const auto& one : attributes) names.push_back(one.first);
  auto sorted = names;
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end()) return false;
  if (known.size() == most_known) known.clear();
  known.push_back(std::move(names));
  return true;
}

auto attributes(JsonCursor& json) -> model::Attributes {
  model::Attributes out;
  out.reserve(16);
  json.object([&](std::string_view name) { out.emplace_back(name, json.value()); });
  require(json, json.good() && are_different(out));
  return out;
}

auto part(JsonCursor& json, bool attributes_only) -> model::Part {
  model::Part out;
  Members which(json, {"id", "attributes", "plan"});
  json.object([&](std::string_view name) {
    switch (which(name)) {
      case 0: out.id = json.text(); break;
      case 1: out.attributes = attributes(json); break;
      default:
        if (attributes_only) json.leave_out();
        else out.plan = plan(json);
    }
  });
  require(json, which.has(0) && which.has(2));
  return out;
}

}  // namespace

auto quick_building(std::string_view text, model::Building& building, bool attributes_only) -> bool {
  JsonCursor json(text);
  Members which(json, {"id", "attributes", "ground", "footprint", "parts"});
  json.object([&](std::string_view name) {
    switch (which(name)) {
      case 0: building.id = json.text(); break;
      case 1: building.attributes = attributes(json); break;
      case 2: building.ground = number_up_to(json, farthest); break;
      case 3:
        if (attributes_only) json.leave_out();
        else building.footprint = footprint(json);
        break;
      default:
        json.array([&] {
          auto next = part(json, attributes_only);
          for (const auto& other : building.parts) require(json, other.id != next.id);
          building.parts.push_back(std::move(next));
        });
    }
  });
  return json.done() && which.has(0) && which.has(4);
}

}  // namespace mansard::formats::detail
