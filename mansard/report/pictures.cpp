// The pictures of a run, in the manner of the paper's Figure 5 and its error maps.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mansard/formats/written.hpp"
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

/// The triangles whose centres lie in the frame and pass the test.
template <class Keep>
auto part_of(const geometry::Mesh& mesh, const geometry::Box2& frame, Keep keep) -> geometry::Mesh {
  geometry::Mesh out;
  out.vertices = mesh.vertices;
  for (const auto& t : mesh.triangles) {
    const Point3 centre = (1.0 / 3) * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
    if (frame.contains(geometry::xy(centre)) && keep(centre)) out.triangles.push_back(t);
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

/// Whether a place is within a metre of an outline.
auto near_outline(const model::Scene& scene, Point2 p) -> bool {
  constexpr double near = 1;
  const auto along = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (distance(p, ring[i], ring[(i + 1) % ring.size()]) < near) return true;
    return false;
  };
  return std::ranges::any_of(scene.footprints, [&](const auto& footprint) {
    return std::ranges::any_of(footprint.polygons, [&](const auto& polygon) {
      return geometry::bounds(polygon.outer).grown(near).contains(p) &&
             (along(polygon.outer) || std::ranges::any_of(polygon.holes, along));
    });
  });
}

/// The scan without its buildings: neither what is over a footprint nor the walls along it, which would show through
/// those of the models.
template <class InFootprint>
auto street_of(const picture::Layer& scan, const model::Scene& scene, InFootprint in_footprint) -> picture::Layer {
  picture::Layer out{{scan.mesh.vertices, {}}, scan.colours, {}};
  std::vector<std::size_t> kept;
  for (std::size_t t = 0; t < scan.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = scan.mesh.triangles[t];
    const Point3 &p = scan.mesh.vertices[a], &q = scan.mesh.vertices[b], &r = scan.mesh.vertices[c];
    const Point3 middle = (1.0 / 3) * (p + q + r);
    constexpr double steep = 0.7;  // the cosine of about 45°
    const bool wall = geometry::normalised(cross(q - p, r - p)).z < steep;
    if (in_footprint(middle) || (wall && near_outline(scene, geometry::xy(middle)))) continue;
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
    layer.mesh = part_of(scene.mesh, frame, [&](Point3 p) { return texture::colour_at(*tree, p, reach).has_value(); });
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
  const auto lines = [&] {
    const rays::Scene surface(scene.mesh);  // not in memory beside those of the pictures
    return footprint_lines(scene, surface);
  }();
  const auto in_footprint = [&](Point3 p) {
    return std::ranges::any_of(scene.footprints, [&](const auto& footprint) {
      return std::ranges::any_of(footprint.polygons, [&](const auto& polygon) {
        return geometry::bounds(polygon.outer).contains(geometry::xy(p)) &&
               geometry::contains(polygon, geometry::xy(p));
      });
    });
  };
  const picture::Layer plain{part_of(scene.mesh, frame, [](Point3) { return true; }), {picture::mesh_blue}};
  const picture::Layer& scan = textured != nullptr ? textured->scan : plain;
  // The street of the scan stays in the second picture, for scale, in a quieter blue; the scan's buildings go.
  const picture::Layer street =
      textured != nullptr
          ? street_of(textured->scan, scene, in_footprint)
          : picture::Layer{part_of(scene.mesh, frame, [&](Point3 p) { return !in_footprint(p); }), {{206, 216, 232}}};
  const auto models = textured != nullptr ? textured->models : models_of(reconstruction.city);

  const auto pair = [&](picture::View view) {
    const std::vector<picture::Layer> before{scan}, after{street, models};
    const std::vector<picture::Lines> drawn = textured != nullptr ? std::vector<picture::Lines>() : std::vector{lines};
    const std::vector<picture::Image> images{picture::draw(before, drawn, view, run),
                                             picture::draw(after, {}, view, run)};
    return picture::beside(images);
  };
  picture::View above, angle;
  above.kind = picture::View::Kind::above;
  const auto map = evaluate::merged(reconstruction.error_maps);
  return {pair(above), pair(angle),
          picture::error_map(map.difference, map.columns, map.rows, limit, "model - mesh, m")};
}

}  // namespace mansard::report
