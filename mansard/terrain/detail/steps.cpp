#include "mansard/terrain/detail/steps.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/model/file_grid.hpp"

namespace mansard::terrain::detail {
namespace {

/// Triangles of the terrain around a vertex of an outline, from one edge of an outline to the next.
struct Fan {
  std::vector<std::uint32_t> triangles;  ///< counter-clockwise
  std::int64_t first = 0, last = 0;      ///< heights of the two outlines
};

class Surface {
 public:
  explicit Surface(Plan& plan) : plan_(plan) {}

  auto make() -> Terrain {
    mark_steps();
    make_room();
    heights_.assign(triangles().size(), {});
    for (std::size_t t = 0; t < triangles().size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) heights_[t][i] = plan_.heights[triangles()[t].corner[i]];
    for (std::uint32_t v = 0; v < plan_.on_outline.size(); ++v)
      if (plan_.on_outline[v])
        for (const auto& fan : fans(v)) settle(v, fan);
    return collect();
  }

 private:
  [[nodiscard]] auto triangles() const -> const std::vector<Triangulation::Triangle>& { return plan_.net.triangles(); }
  [[nodiscard]] auto index_of(std::uint32_t t, std::uint32_t v) const -> std::size_t {
    const auto& c = triangles()[t].corner;
    return c[0] == v ? 0 : (c[1] == v ? 1 : 2);
  }
  /// The corner after v, and the one before it.
  [[nodiscard]] auto right(std::uint32_t t, std::uint32_t v) const -> std::uint32_t {
    return triangles()[t].corner[(index_of(t, v) + 1) % 3];
  }
  [[nodiscard]] auto left(std::uint32_t t, std::uint32_t v) const -> std::uint32_t {
    return triangles()[t].corner[(index_of(t, v) + 2) % 3];
  }

  void mark_steps() {
    step_.assign(plan_.on_outline.size(), false);
    std::map<std::uint32_t, std::int64_t> height;
    for (const auto& [edge, z] : plan_.outline)
      for (const auto v : {edge.first, edge.second})
        if (const auto [at, fresh] = height.emplace(v, z); !fresh && at->second != z) step_[v] = true;
  }

  [[nodiscard]] auto fans(std::uint32_t v) const -> std::vector<Fan> {
    auto all = plan_.net.around(v);
    const auto starts = [&](std::uint32_t t) { return plan_.outline.find({right(t, v), v}); };
    const auto begin = std::ranges::find_if(
        all, [&](std::uint32_t t) { return !plan_.inside[t] && starts(t) != plan_.outline.end(); });
    std::vector<Fan> out;
    if (begin == all.end()) return out;
    std::ranges::rotate(all, begin);
    for (const auto t : all) {
      if (plan_.inside[t]) continue;
      if (const auto at = starts(t); at != plan_.outline.end()) out.push_back({{}, at->second, at->second});
      if (out.empty()) continue;
      out.back().triangles.push_back(t);
      if (const auto at = plan_.outline.find({v, left(t, v)}); at != plan_.outline.end()) out.back().last = at->second;
    }
    return out;
  }

  /// The number of the triangle in a fan before which its height changes; 0 where no edge leads to a vertex without a
  /// step of its own.
  [[nodiscard]] auto turn_of(std::uint32_t v, const Fan& fan) const -> std::size_t {
    const std::size_t count = fan.triangles.size();
    std::size_t best = 0;
    for (std::size_t m = 1; m < count; ++m) {
      if (step_[right(fan.triangles[m], v)]) continue;
      const auto off = [&](std::size_t k) { return 2 * k > count ? 2 * k - count : count - 2 * k; };
      if (best == 0 || off(m) < off(best)) best = m;
    }
    return best;
  }

  /// Adds a vertex in a triangle of every fan that needs an edge for its step.
  void make_room() {
    constexpr int rounds = 8;  // one is enough but where fans share triangles
    for (int round = 0; round < rounds; ++round) {
      bool added = false;
      for (std::uint32_t v = 0; v < step_.size(); ++v) {
        if (!step_[v]) continue;
        for (const auto& fan : fans(v)) {
          if (fan.first == fan.last || turn_of(v, fan) != 0) continue;
          const auto t = fan.triangles[fan.triangles.size() / 2];
          const auto& c = triangles()[t].corner;
          const auto& s = plan_.net.sites();
          const Site middle{(s[c[0]].x + s[c[1]].x + s[c[2]].x) / 3, (s[c[0]].y + s[c[1]].y + s[c[2]].y) / 3};
          const auto place = plan_.net.locate(middle, t);
          if (place.triangle != t || place.on != Triangulation::Place::On::inside) continue;
          const std::int64_t z = (plan_.heights[c[0]] + plan_.heights[c[1]] + plan_.heights[c[2]]) / 3;
          plan_.net.insert(middle, place, {});
          plan_.heights.push_back(z);
          plan_.on_outline.push_back(false);
          step_.push_back(false);
          plan_.inside.resize(triangles().size(), false);
          added = true;
          break;  // the fans are other ones now
        }
      }
      if (!added) return;
    }
  }

  void settle(std::uint32_t v, const Fan& fan) {
    const std::size_t turn = fan.first == fan.last ? fan.triangles.size() : turn_of(v, fan);
    for (std::size_t k = 0; k < fan.triangles.size(); ++k)
      heights_[fan.triangles[k]][index_of(fan.triangles[k], v)] = k < turn ? fan.first : fan.last;
    if (turn > 0 && turn < fan.triangles.size())
      upright_.push_back({v, right(fan.triangles[turn], v), fan.first, fan.last});
  }

  auto vertex(std::uint32_t v, std::int64_t z) -> std::uint32_t {
    const Site s = plan_.net.sites()[v];
    const auto [at, fresh] = numbers_.emplace(Place{s.x, s.y, z}, static_cast<std::uint32_t>(out_.vertices.size()));
    if (fresh) out_.vertices.push_back(at->first);
    return at->second;
  }

  auto collect() -> Terrain {
    for (std::size_t t = 0; t < triangles().size(); ++t) {
      const auto& c = triangles()[t].corner;
      if (plan_.inside[t]) {
        auto& below = out_.below.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
          below[i] = {plan_.net.sites()[c[i]].x, plan_.net.sites()[c[i]].y, plan_.heights[c[i]]};
        continue;
      }
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) corners[i] = vertex(c[i], heights_[t][i]);
      out_.triangles.push_back(corners);
    }
    for (const auto& step : upright_)
      out_.triangles.push_back(
          {vertex(step.at, step.first), vertex(step.end, plan_.heights[step.end]), vertex(step.at, step.last)});
    const auto metres = [](Site s) {
      return geometry::Point2{static_cast<double>(s.x) / model::quanta_per_metre,
                              static_cast<double>(s.y) / model::quanta_per_metre};
    };
    out_.area = {metres(plan_.net.sites()[0]), metres(plan_.net.sites()[2])};
    return std::move(out_);
  }

  struct Upright {
    std::uint32_t at, end;
    std::int64_t first, last;
  };

  Plan& plan_;
  std::vector<bool> step_;                            ///< of each vertex, whether outlines of two heights meet there
  std::vector<std::array<std::int64_t, 3>> heights_;  ///< of the corners of each triangle
  std::vector<Upright> upright_;
  std::map<Place, std::uint32_t> numbers_;
  Terrain out_;
};

}  // namespace

auto surface_of(Plan& plan) -> Terrain { return Surface(plan).make(); }

}  // namespace mansard::terrain::detail
