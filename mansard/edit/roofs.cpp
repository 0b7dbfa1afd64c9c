#include "mansard/edit/roofs.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::edit {
namespace {

using geometry::Point2;

/// m along the edge from `a` to `b` that an edge of another outline covers.
auto covered(Point2 a, Point2 b, Point2 c, Point2 d) -> double {
  constexpr double beside = 0.05;  // m
  const double length = geometry::length(b - a);
  const Point2 along = (1 / length) * (b - a);
  if (std::abs(cross(along, c - a)) > beside || std::abs(cross(along, d - a)) > beside) return 0;
  const double from = std::min(dot(along, c - a), dot(along, d - a)),
               to = std::max(dot(along, c - a), dot(along, d - a));
  return std::max(0.0, std::min(length, to) - std::max(0.0, from));
}

auto measured(base::Result<model::Plan> plan, const rays::Scene& mesh, const pipeline::Options& options)
    -> base::Result<FittedRoof> {
  if (!plan) return plan.failure();
  const auto mse = error_of(*plan, mesh, options);
  return FittedRoof{std::move(*plan), mse};
}

}  // namespace

auto error_of(const model::Plan& plan, const rays::Scene& mesh, const pipeline::Options& options)
    -> std::optional<double> {
  const auto raised = pipeline::raise_part(plan, options);
  if (!raised) return std::nullopt;
  const double mse = evaluate::error_over(raised->solid, model::polygon_of(plan), mesh, options.evaluate);
  return std::isfinite(mse) ? std::optional(mse) : std::nullopt;
}

auto shared_edges(const model::Plan& plan, std::span<const model::Plan> others) -> std::vector<bool> {
  const auto& ring = plan.outer.points;
  std::vector<bool> out(ring.size(), false);
  const auto box = geometry::bounds(ring).grown(1);
  std::vector<double> sum(ring.size(), 0);
  for (const auto& other : others) {
    const auto& points = other.outer.points;
    if (!box.overlaps(geometry::bounds(points))) continue;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (!(geometry::length(b - a) > 0)) continue;
      for (std::size_t j = 0; j < points.size(); ++j)
        sum[i] += covered(a, b, points[j], points[(j + 1) % points.size()]);
    }
  }
  for (std::size_t i = 0; i < ring.size(); ++i)
    out[i] = sum[i] > geometry::length(ring[(i + 1) % ring.size()] - ring[i]) / 3;
  return out;
}

auto doubts_of(const RaisedBuilding& building, std::optional<double> before, const rays::Scene& mesh)
    -> std::vector<base::Diagnostic> {
  constexpr double half_more = 1.5, least = 0.05 /* m */, metres = 2,
                   spacing = 0.5 /* m, between samples of the scan */;
  std::vector<base::Diagnostic> out;
  const auto words = [](double value) { return base::to_text(value, 2) + " m"; };
  if (before && building.mse) {
    const double was = std::sqrt(*before), is = std::sqrt(*building.mse);
    if (is > half_more * was && is > was + least)
      out.push_back(base::warning(
          "edit-error", "the error against the scan rises from " + words(was) + " to " + words(is) + " (RMSE)"));
  }
  for (const auto& part : building.parts) {
    if (!part.model || part.model->solid.vertices.empty()) continue;
    const auto& vertices = part.model->solid.vertices;
    geometry::Box2 box;
    for (const auto& vertex : vertices) box.add({vertex.x, vertex.y});
    std::optional<double> seen;
    for (double x = box.least.x + spacing / 2; x < box.most.x; x += spacing)
      for (double y = box.least.y + spacing / 2; y < box.most.y; y += spacing)
        if (const auto z = mesh.top({x, y})) seen = std::max(seen.value_or(*z), *z);
    const double top = std::ranges::max(vertices, {}, &geometry::Point3::z).z;
    if (seen && top > *seen + metres)
      out.push_back(
          base::warning("edit-above", "it is " + words(top - *seen) + " above all that the scan shows there", part.id));
  }
  return out;
}

auto roof_of(refine::Kind kind, const model::Plan& plan, std::span<const model::Plan> others, const rays::Scene& mesh,
             const pipeline::Options& options, const base::Run& run) -> base::Result<FittedRoof> {
  return measured(refine::roof_of(kind, plan, shared_edges(plan, others), mesh, options.refine, options.extrude, run),
                  mesh, options);
}

auto fitted_roof(const model::Plan& plan, const rays::Scene& mesh, const pipeline::Options& options,
                 const base::Run& run) -> base::Result<FittedRoof> {
  return measured(refine::fitted(plan, mesh, options.refine, options.extrude, run), mesh, options);
}

}  // namespace mansard::edit
