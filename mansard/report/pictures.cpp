// The pictures of a run, in the manner of the paper's Figure 5 and its error maps.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mansard/formats/written.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/report/pictures.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/texture/options.hpp"

namespace mansard::report {
namespace {

using geometry::Point2;
using geometry::Point3;

/// Where the buildings are, with some street around them: what the pictures show.
auto frame_of(const model::Scene& scene) -> geometry::Box2 {
  constexpr double street = 8;
  geometry::Box2 box;
  for (const auto& footprint : scene.footprints) box.include(geometry::bounds(footprint.polygons));
  return box.grown(street);
}

/// The triangles whose centres lie in the frame and pass the test, and their vertices.
template <class Keep>
auto part_of(const geometry::Mesh& mesh, const geometry::Box2& frame, Keep keep) -> geometry::Mesh {
  constexpr auto none = ~std::uint32_t{0};
  geometry::Mesh out;
  std::vector<std::uint32_t> places(mesh.vertices.size(), none);
  for (const auto& t : mesh.triangles) {
    const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (!frame.contains(geometry::xy((1.0 / 3) * (a + b + c))) || !keep(a, b, c)) continue;
    auto& corners = out.triangles.emplace_back(t);
    for (auto& corner : corners) {
      auto& place = places[corner];
      if (place == none) {
        place = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[corner]);
      }
      corner = place;
    }
  }
  return out;
}

auto footprint_lines(const model::Scene& scene, const rays::Scene& surface) -> picture::Lines {
  picture::Lines lines;
  const auto add = [&](const geometry::Ring& ring) {
    constexpr double piece = 1.0;  // short pieces follow the surface they are drawn on
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      const auto n = static_cast<std::size_t>(std::ceil(geometry::length(b - a) / piece));
      // The height is taken a little inside, where the roof is: on the wall itself it would jump up and down.
      const Point2 inside = 0.75 * geometry::left_of(geometry::normalised(b - a));
      const auto on = [&](std::size_t k) -> std::optional<Point3> {
        const Point2 p = a + (static_cast<double>(k) / static_cast<double>(n)) * (b - a);
        const auto z = surface.top(p + inside);
        return z ? std::optional(Point3{p.x, p.y, *z}) : std::nullopt;
      };
      for (std::size_t k = 0; k < n; ++k)
        if (const auto from = on(k), to = on(k + 1); from && to) lines.segments.push_back({*from, *to});
    }
  };
  for (const auto& footprint : scene.footprints)
    for (const auto& polygon : footprint.polygons) {
      add(polygon.outer);
      for (const auto& hole : polygon.holes) add(hole);
    }
  return lines;
}

auto colour_of(model::FaceClass kind) -> picture::Colour {
  switch (kind) {
    case model::FaceClass::wall: return picture::wall_grey;
    case model::FaceClass::party_wall: return picture::party_grey;
    case model::FaceClass::roof: return picture::roof_red;
    case model::FaceClass::ground:
    case model::FaceClass::soffit: return picture::ground_grey;
  }
  return {};
}

/// A solid in triangles; one that cannot be cut into them is not left out but has its faces as fans. Its writers say
/// what is wrong with it.
auto cut_or_fans(const model::Solid& solid) -> solid::Triangulated {
  if (auto cut = solid::triangulate(solid)) return std::move(*cut);
  const auto finite = [&](std::uint32_t v) {
    const Point3& p = solid.vertices[v];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  solid::Triangulated fans;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    if (solid.faces[f].loops.empty()) continue;
    const auto& loop = solid.faces[f].loops.front();
    for (std::size_t i = 2; i < loop.size(); ++i) {
      const std::array<std::uint32_t, 3> corners{loop[0], loop[i - 1], loop[i]};
      if (!std::ranges::all_of(corners, finite)) continue;
      fans.triangles.push_back(corners);
      fans.face_of.push_back(f);
    }
  }
  return fans;
}

/// Adds a model, and calls `more` with the face of each of its triangles.
template <class More>
void append(const model::LabelledSolid& model, picture::Layer& layer, More more) {
  const auto cut = cut_or_fans(model.solid);
  const auto first = static_cast<std::uint32_t>(layer.mesh.vertices.size());
  layer.mesh.vertices.insert(layer.mesh.vertices.end(), model.solid.vertices.begin(), model.solid.vertices.end());
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const auto& corners = cut.triangles[t];
    layer.mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
    layer.colours.push_back(colour_of(model.classes[cut.face_of[t]]));
    more(cut.face_of[t]);
  }
}

/// Eaves are on the solids of parts together.
auto has_soffits(const model::Building& building) -> bool {
  return std::ranges::any_of(building.solids, [](const model::PartsSolid& one) {
    return std::ranges::find(one.model.classes, model::FaceClass::soffit) != one.model.classes.end();
  });
}

auto models_of(const model::City& city) -> picture::Layer {
  picture::Layer layer;
  for (const auto& building : city.buildings)
    if (has_soffits(building))
      for (const auto& one : building.solids) append(one.model, layer, [](std::uint32_t) {});
    else
      for (const auto& part : building.parts) append(part.model, layer, [](std::uint32_t) {});
  return layer;
}

auto distance(Point2 p, Point2 a, Point2 b) -> double {
  const Point2 ab = b - a;
  const double square = dot(ab, ab);
  const double t = square > 0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0;
  return geometry::length(p - (a + t * ab));
}

/// Where the footprints are, to ask for many places.
class Grounds {
 public:
  explicit Grounds(const model::Scene& scene) {
    std::vector<geometry::Box2> boxes;
    for (const auto& footprint : scene.footprints)
      for (const auto& polygon : footprint.polygons) {
        polygons_.push_back(&polygon);
        boxes.push_back(geometry::bounds(polygon.outer).grown(near));
      }
    index_ = geometry::BoxIndex(boxes);
  }

  /// Whether a triangle of the scan is part of the street: neither over a footprint nor one of the walls along it,
  /// which would show through those of the models or hide them.
  [[nodiscard]] auto is_street(const Point3& a, const Point3& b, const Point3& c) const -> bool {
    constexpr double steep = 0.7;  // the cosine of about 45°
    const Point2 middle = geometry::xy((1.0 / 3) * (a + b + c));
    const bool wall = geometry::normalised(cross(b - a, c - a)).z < steep;
    return std::ranges::none_of(index_.overlapping({middle, middle}), [&](std::uint32_t k) {
      return geometry::contains(*polygons_[k], middle) || (wall && along(*polygons_[k], middle));
    });
  }

 private:
  static constexpr double near = 1;  // m

  /// Whether a place is within a metre of the outline.
  static auto along(const geometry::Polygon& polygon, Point2 p) -> bool {
    const auto along_ring = [&](const geometry::Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (distance(p, ring[i], ring[(i + 1) % ring.size()]) < near) return true;
      return false;
    };
    return along_ring(polygon.outer) || std::ranges::any_of(polygon.holes, along_ring);
  }

  std::vector<const geometry::Polygon*> polygons_;
  geometry::BoxIndex index_;
};

/// The street of a textured scan.
auto street_of(const picture::Layer& scan, const Grounds& grounds) -> picture::Layer {
  picture::Layer out{{scan.mesh.vertices, {}}, scan.colours, {}};
  std::vector<std::size_t> kept;
  for (std::size_t t = 0; t < scan.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = scan.mesh.triangles[t];
    if (!grounds.is_street(scan.mesh.vertices[a], scan.mesh.vertices[b], scan.mesh.vertices[c])) continue;
    out.mesh.triangles.push_back(scan.mesh.triangles[t]);
    kept.push_back(t);
  }
  out.picture = [from = scan.picture, kept = std::move(kept)](std::size_t t, Point3 p) { return from(kept[t], p); };
  return out;
}

}  // namespace

auto textured_models(const model::City& city, formats::Solids solids) -> picture::Layer {
  picture::Layer layer;
  std::vector<const model::FaceTexture*> textures;
  for (const auto& building : city.buildings) {
    const auto written = formats::written_solids(building, solids);
    const bool textured = building.texture && building.texture->solids.size() == written.size();
    for (std::size_t s = 0; s < written.size(); ++s)
      append(written[s], layer, [&](std::uint32_t face) {
        textures.push_back(textured ? &building.texture->solids[s].faces[face] : nullptr);
      });
  }
  layer.picture = [textures = std::move(textures)](std::size_t t, Point3 p) -> std::optional<picture::Colour> {
    if (textures[t] == nullptr) return std::nullopt;
    const auto [x, y] = textures[t]->frame.at(p);
    const auto& pixels = textures[t]->pixels;
    const auto column = static_cast<std::size_t>(std::clamp(x, 0.0, pixels.width - 1.0)),
               row = static_cast<std::size_t>(std::clamp(y, 0.0, pixels.height - 1.0));
    const auto* rgb = &pixels.rgb[3 * (row * pixels.width + column)];
    return picture::Colour{rgb[0], rgb[1], rgb[2]};
  };
  return layer;
}

auto textured_scan(const texture::Scan& scan, const model::Scene& scene) -> base::Result<picture::Layer> {
  constexpr double far = 1e6;  // m, of heights
  const auto frame = frame_of(scene);
  auto near = scan.near({{frame.least.x, frame.least.y, -far}, {frame.most.x, frame.most.y, far}});
  if (!near) return near.failure();
  picture::Layer layer;
  layer.colours = {picture::mesh_blue};
  if (near->empty() && scan.has_points()) {  // the surface that was made of them, in their colours
    constexpr double reach = texture::Options{}.point_reach;
    auto points = scan.points_near({{frame.least.x, frame.least.y, -far}, {frame.most.x, frame.most.y, far}});
    if (!points) return points.failure();
    const auto tree = std::make_shared<const texture::PointTree>(*std::move(points));
    layer.mesh = part_of(scene.mesh, frame, [&](const Point3& a, const Point3& b, const Point3& c) {
      return texture::colour_at(*tree, (1.0 / 3) * (a + b + c), reach).has_value();
    });
    layer.picture = [tree](std::size_t, Point3 p) { return texture::colour_at(*tree, p, reach); };
    return layer;
  }
  std::map<std::uint32_t, std::shared_ptr<const model::Pixels>> images;
  for (const auto& triangle : *near) {
    const auto first = static_cast<std::uint32_t>(layer.mesh.vertices.size());
    layer.mesh.vertices.insert(layer.mesh.vertices.end(), triangle.corners.begin(), triangle.corners.end());
    layer.mesh.triangles.push_back({first, first + 1, first + 2});
    if (triangle.material != texture::no_material && !images.contains(triangle.material))
      images[triangle.material] = scan.image(triangle.material);
  }
  layer.picture = [&scan, triangles = std::move(*near), images = std::move(images)](std::size_t t, Point3 p) {
    const auto& triangle = triangles[t];
    const auto image = images.find(triangle.material);
    return texture::colour_at(
        triangle, p, image == images.end() ? nullptr : image->second.get(),
        triangle.material == texture::no_material ? std::array<formats::Wrap, 2>{} : scan.wrap(triangle.material));
  };
  return layer;
}

auto picture_of(const model::City& city, const picture::View& view, const base::Run& run) -> picture::Image {
  const std::vector<picture::Layer> layers{models_of(city)};
  return picture::draw(layers, {}, view, run);
}

auto pictures(const Reconstruction& reconstruction, const model::Scene& scene, double limit, const base::Run& run,
              const TexturedLayers* textured) -> Pictures {
  const auto frame = frame_of(scene);
  const picture::Lines lines = [&] {
    const rays::Scene surface(scene.mesh);  // not in memory beside those of the pictures
    return footprint_lines(scene, surface);
  }();
  picture::View from_above, at_an_angle;
  from_above.kind = picture::View::Kind::above;
  const std::array views{from_above, at_an_angle};
  const auto left = [&] {  // what was drawn is not in memory beside what comes next
    if (textured != nullptr) return picture::draw_views({&textured->scan, 1}, {}, views, run);
    const auto everything = [](const Point3&, const Point3&, const Point3&) { return true; };
    const picture::Layer scan{part_of(scene.mesh, frame, everything), {picture::mesh_blue}};
    return picture::draw_views({&scan, 1}, {&lines, 1}, views, run);
  }();
  // The street of the scan stays in the second picture, for scale, in a quieter blue; the scan's buildings go.
  const auto right = [&] {
    const Grounds grounds(scene);
    const auto is_street = [&](const Point3& a, const Point3& b, const Point3& c) {
      return grounds.is_street(a, b, c);
    };
    const std::vector<picture::Layer> layers{
        textured != nullptr ? street_of(textured->scan, grounds)
                            : picture::Layer{part_of(scene.mesh, frame, is_street), {{206, 216, 232}}},
        textured != nullptr ? textured->models : models_of(reconstruction.city)};
    return picture::draw_views(layers, {}, views, run);
  }();
  const auto pair = [&](std::size_t view) { return picture::beside(std::array{left[view], right[view]}); };
  const auto map = evaluate::merged(reconstruction.error_maps);
  return {pair(0), pair(1), picture::error_map(map.difference, map.columns, map.rows, limit, "model - mesh, m")};
}

}  // namespace mansard::report
