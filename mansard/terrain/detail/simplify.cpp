#include "mansard/terrain/detail/simplify.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "mansard/model/file_grid.hpp"

namespace mansard::terrain::detail {
namespace {

class Simplifier {
 public:
  Simplifier(Plan& plan, const Heights& heights, double tolerance)
      : plan_(plan), heights_(heights), grid_(heights.grid), tolerance_(tolerance * model::quanta_per_metre) {}

  void run(const base::Run& run) {
    distribute();
    for (std::uint32_t t = 0; t < of_.size(); ++t) weigh(t);
    std::size_t done = 0;
    const double worst = queue_.empty() ? 1 : std::max(queue_.top().error, 1.0);
    while (!queue_.empty()) {
      const auto next = queue_.top();
      queue_.pop();
      if (next.stamp != stamps_[next.triangle]) continue;
      if (++done % 4096 == 0) {
        if (run.cancelled()) return;
        run.report("terrain", "",
                   1 - std::log(std::max(next.error / tolerance_, 1.0)) /
                           std::max(std::log(std::max(worst / tolerance_, 2.0)), 1e-9));
      }
      add(next.node, next.triangle);
    }
  }

 private:
  struct Worst {
    double error = 0;
    std::uint32_t node = 0, triangle = 0, stamp = 0;
    /// The largest error first, then the first node.
    friend auto operator<(const Worst& a, const Worst& b) -> bool {
      return a.error != b.error ? a.error < b.error : a.node > b.node;
    }
  };

  [[nodiscard]] auto site(std::uint32_t node) const -> Site {
    return site_of(grid_, node % grid_.columns, node / grid_.columns);
  }
  [[nodiscard]] auto height(std::uint32_t node) const -> std::int64_t {
    return std::llround((static_cast<double>(grid_.values[node]) - grid_.base) * model::quanta_per_metre);
  }

  /// Nodes that are nearer to an outline than half a cell.
  [[nodiscard]] auto beside_outlines() const -> std::vector<bool> {
    std::vector<bool> out(grid_.columns * grid_.rows, false);
    const double near = grid_.cell / 2, scale = 1 / model::quanta_per_metre;
    for (const auto& [edge, z] : plan_.outline) {
      const Site a = plan_.net.sites()[edge.first], b = plan_.net.sites()[edge.second];
      const geometry::Segment2 segment{{static_cast<double>(a.x) * scale, static_cast<double>(a.y) * scale},
                                       {static_cast<double>(b.x) * scale, static_cast<double>(b.y) * scale}};
      const auto box = geometry::Box2::of(segment).grown(near);
      const auto first = [&](double p, double from) {
        return static_cast<std::size_t>(std::max(0.0, std::ceil((p - from) / grid_.cell)));
      };
      for (std::size_t j = first(box.least.y, grid_.centre.y); j < grid_.rows; ++j) {
        const double y = grid_.centre.y + grid_.cell * static_cast<double>(j);
        if (y > box.most.y) break;
        for (std::size_t i = first(box.least.x, grid_.centre.x); i < grid_.columns; ++i) {
          const double x = grid_.centre.x + grid_.cell * static_cast<double>(i);
          if (x > box.most.x) break;
          if (geometry::distance(segment, {x, y}) < near) out[j * grid_.columns + i] = true;
        }
      }
    }
    return out;
  }

  /// Every node to the triangle that it is in; those on the ground of buildings and beside it are left out.
  void distribute() {
    of_.resize(plan_.net.triangles().size());
    stamps_.assign(of_.size(), 0);
    const auto beside = beside_outlines();
    std::uint32_t from = 0;
    std::size_t around = 0, unknown = 0;
    for (std::size_t j = 0; j < grid_.rows; ++j)
      for (std::size_t k = 0; k < grid_.columns; ++k) {
        const std::size_t i = j % 2 == 0 ? k : grid_.columns - 1 - k;  // there and back: the next one is near
        const auto node = static_cast<std::uint32_t>(j * grid_.columns + i);
        if (beside[node]) continue;
        const auto place = plan_.net.locate(site(node), from);
        if (place.triangle == Triangulation::none) continue;
        from = place.triangle;
        if (!plan_.inside[place.triangle]) {
          ++around;
          if (!heights_.known.empty() && !heights_.known[node]) ++unknown;
        }
        if (place.on != Triangulation::Place::On::vertex && !plan_.inside[place.triangle])
          of_[place.triangle].push_back(node);
      }
    if (around > 0) plan_.filled = static_cast<double>(unknown) / static_cast<double>(around);
    for (auto& nodes : of_) std::ranges::sort(nodes);
  }

  /// The node of a triangle that is farthest from it goes into the queue, where that is more than the tolerance.
  void weigh(std::uint32_t t) {
    ++stamps_[t];
    const auto& c = plan_.net.triangles()[t].corner;
    const auto& s = plan_.net.sites();
    const Site a = s[c[0]];
    const auto ux = static_cast<double>(s[c[1]].x - a.x), uy = static_cast<double>(s[c[1]].y - a.y),
               vx = static_cast<double>(s[c[2]].x - a.x), vy = static_cast<double>(s[c[2]].y - a.y);
    const double det = ux * vy - uy * vx, z = static_cast<double>(plan_.heights[c[0]]),
                 du = static_cast<double>(plan_.heights[c[1]]) - z, dv = static_cast<double>(plan_.heights[c[2]]) - z;
    Worst worst{tolerance_, 0, t, stamps_[t]};
    bool found = false;
    for (const auto node : of_[t]) {
      const Site p = site(node);
      const auto x = static_cast<double>(p.x - a.x), y = static_cast<double>(p.y - a.y);
      const double error =
          std::abs(z + (du * (x * vy - y * vx) + dv * (ux * y - uy * x)) / det - static_cast<double>(height(node)));
      if (error > worst.error) {
        worst.error = error;
        worst.node = node;
        found = true;
      }
    }
    if (found) queue_.push(worst);
  }

  void add(std::uint32_t node, std::uint32_t t) {
    const auto before = static_cast<std::uint32_t>(plan_.net.triangles().size());
    changed_.clear();
    pool_.clear();
    const Site at = site(node);
    const auto v = plan_.net.insert(at, plan_.net.locate(at, t), [&](std::uint32_t u) {
      if (u >= before || std::ranges::find(changed_, u) != changed_.end()) return;
      changed_.push_back(u);
      pool_.insert(pool_.end(), of_[u].begin(), of_[u].end());
      of_[u].clear();
    });
    if (v >= plan_.heights.size()) {
      plan_.heights.push_back(height(node));
      plan_.on_outline.push_back(false);
    }
    const auto after = static_cast<std::uint32_t>(plan_.net.triangles().size());
    of_.resize(after);
    stamps_.resize(after, 0);
    plan_.inside.resize(after, false);
    for (std::uint32_t u = before; u < after; ++u) changed_.push_back(u);
    const auto& sites = plan_.net.sites();
    for (const auto other : pool_) {
      if (other == node) continue;
      const Site p = site(other);
      for (const auto u : changed_) {
        const auto& c = plan_.net.triangles()[u].corner;
        if (twice_area(sites[c[0]], sites[c[1]], p) >= 0 && twice_area(sites[c[1]], sites[c[2]], p) >= 0 &&
            twice_area(sites[c[2]], sites[c[0]], p) >= 0) {
          of_[u].push_back(other);
          break;
        }
      }
    }
    for (const auto u : changed_) weigh(u);
  }

  Plan& plan_;
  const Heights& heights_;
  const model::HeightGrid& grid_;
  double tolerance_;
  std::vector<std::vector<std::uint32_t>> of_;  ///< the nodes in each triangle
  std::vector<std::uint32_t> stamps_;           ///< of each triangle: what of the queue is still true
  std::priority_queue<Worst> queue_;
  std::vector<std::uint32_t> changed_, pool_;
};

}  // namespace

void simplify(Plan& plan, const Heights& heights, double tolerance, const base::Run& run) {
  Simplifier(plan, heights, tolerance).run(run);
}

}  // namespace mansard::terrain::detail
