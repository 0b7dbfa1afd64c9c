// The pictures of a run, in the manner of the paper's Figure 5 and its error maps.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "mansard/base/outputs.hpp"
#include "mansard/base/pack.hpp"
#include "mansard/formats/written.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/curve.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/report/measures.hpp"
#include "mansard/report/pictures.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/texture/options.hpp"

namespace mansard::report {
namespace {

using geometry::Point2;
using geometry::Point3;

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

/// The outlines of the footprints on the scan.
class FootprintLines {
 public:
  explicit FootprintLines(const model::Scene& scene) {
    // Short pieces follow the surface they are drawn on; less than half a pixel need none be.
    const auto frame = frame_of(scene);
    const auto pixels = static_cast<double>(picture::View{}.width);
    if (!frame.empty())
      piece_ =
          std::max({1.0, 0.5 * (frame.most.x - frame.least.x) / pixels, 0.5 * (frame.most.y - frame.least.y) / pixels});
    std::vector<geometry::Box2> boxes;
    const auto add = [&](const geometry::Ring& ring) {
      rings_.push_back({&ring, heights_.size()});
      boxes.push_back(geometry::bounds(ring).grown(2 * inside));
      for (std::size_t i = 0; i < ring.size(); ++i)
        heights_.resize(heights_.size() + Edge(ring, i, piece_).count + 1, unseen);
    };
    for (const auto& footprint : scene.footprints)
      for (const auto& polygon : footprint.polygons) {
        if (footprint.defect) continue;
        add(polygon.outer);
        for (const auto& hole : polygon.holes) add(hole);
      }
    index_ = geometry::BoxIndex(boxes);
  }

  /// What a piece of the scan has there.
  void look_at(const geometry::Mesh& mesh) {
    const auto plan = geometry::Box3::of(mesh.vertices).plan();
    const rays::Scene surface(mesh);
    const auto near = index_.overlapping(plan);
    base::parallel_for(near.size(), [&](std::size_t k) {
      const auto& [ring, first] = rings_[near[k]];
      double* height = &heights_[first];
      for (std::size_t i = 0; i < ring->size(); ++i) {
        const Edge edge(*ring, i, piece_);
        for (std::size_t n = 0; n <= edge.count; ++n, ++height) {
          const Point2 at = edge.at(n) + edge.inwards;
          if (!plan.contains(at)) continue;
          if (const auto z = surface.top(at)) *height = std::max(*height, *z);
        }
      }
    });
  }

  [[nodiscard]] auto lines() const -> picture::Lines {
    picture::Lines lines;
    for (const auto& [ring, first] : rings_) {
      const double* height = &heights_[first];
      for (std::size_t i = 0; i < ring->size(); ++i) {
        const Edge edge(*ring, i, piece_);
        for (std::size_t n = 0; n < edge.count; ++n) {
          const Point2 a = edge.at(n), b = edge.at(n + 1);
          if (height[n] > unseen && height[n + 1] > unseen)
            lines.segments.push_back({Point3{a.x, a.y, height[n]}, Point3{b.x, b.y, height[n + 1]}});
        }
        height += edge.count + 1;
      }
    }
    return lines;
  }

 private:
  static constexpr double unseen = -std::numeric_limits<double>::infinity();
  // The height is taken a little inside, where the roof is: on the wall itself it would jump up and down.
  static constexpr double inside = 0.75;  // m

  struct Edge {
    Edge(const geometry::Ring& ring, std::size_t i, double piece)
        : a(ring[i]),
          b(ring[(i + 1) % ring.size()]),
          inwards(inside * geometry::left_of(geometry::normalised(b - a))),
          count(static_cast<std::size_t>(std::ceil(geometry::length(b - a) / piece))) {}
    [[nodiscard]] auto at(std::size_t n) const -> Point2 {
      return a + (static_cast<double>(n) / static_cast<double>(count)) * (b - a);
    }
    Point2 a, b, inwards;
    std::size_t count;
  };
  struct Outline {
    const geometry::Ring* ring = nullptr;
    std::size_t first = 0;  ///< of its heights
  };

  double piece_ = 1;  ///< m
  std::vector<Outline> rings_;
  std::vector<double> heights_;  ///< z at the ends of the pieces of all edges
  geometry::BoxIndex index_;
};

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

/// Whether every face of its solids has one colour: that of a tag.
auto is_painted(const model::Building& building) -> bool {
  if (!building.texture || building.texture->solids.size() != building.solids.size()) return false;
  for (std::size_t s = 0; s < building.solids.size(); ++s) {
    const auto& faces = building.texture->solids[s].faces;
    const auto is_plain = [](const model::FaceTexture& face) { return face.pixels.rgb.size() == 3; };
    if (faces.size() != building.solids[s].model.solid.faces.size() || !std::ranges::all_of(faces, is_plain))
      return false;
  }
  return true;
}

void append(const model::Building& building, picture::Layer& layer) {
  if (is_painted(building))
    for (std::size_t s = 0; s < building.solids.size(); ++s)
      append(building.solids[s].model, layer, [&](std::uint32_t face) {
        const auto& rgb = building.texture->solids[s].faces[face].pixels.rgb;
        layer.colours.back() = {rgb[0], rgb[1], rgb[2]};
      });
  else if (has_soffits(building))
    for (const auto& one : building.solids) append(one.model, layer, [](std::uint32_t) {});
  else
    for (const auto& part : building.parts) append(part.model, layer, [](std::uint32_t) {});
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
        if (footprint.defect) continue;
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

/// Coloured triangles put aside, from which those that are near each other are drawn together.
class Store {
 public:
  [[nodiscard]] static auto open() -> base::Result<std::unique_ptr<Store>> {
    auto spool = base::Spool::open();
    if (!spool) return spool.failure();
    std::unique_ptr<Store> out(new Store);
    out->spool_ = std::move(*spool);
    return out;
  }

  void add(const picture::Layer& layer) {
    if (layer.mesh.triangles.empty()) return;
    const auto box = geometry::Box3::of(layer.mesh.vertices);
    const auto metre = [](double at) { return static_cast<std::int64_t>(std::floor(std::clamp(at, -1e9, 1e9))); };
    const auto bytes = base::packed(std::pair(layer.mesh, layer.colours));
    chunks_.push_back(
        {geometry::along_curve(metre(0.5 * (box.least.x + box.most.x)), metre(0.5 * (box.least.y + box.most.y))),
         spool_->size(), bytes.size(), layer.mesh.triangles.size()});
    spool_->append(bytes);
  }

  /// After the last one. The store must outlive them.
  [[nodiscard]] auto pieces() -> picture::Pieces {
    std::size_t triangles = 0;
    for (const auto& chunk : chunks_) triangles += chunk.triangles;
    // All of one piece stay in the order in which they came.
    const std::size_t most = piece_triangles(triangles);
    if (triangles > most) std::ranges::stable_sort(chunks_, {}, &Chunk::place);
    firsts_.clear();
    std::size_t in_piece = 0;
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
      if (i == 0 || in_piece + chunks_[i].triangles > most) {
        firsts_.push_back(i);
        in_piece = 0;
      }
      in_piece += chunks_[i].triangles;
    }
    return {firsts_.size(), [this](std::size_t piece) { return load(piece); }};
  }

 private:
  struct Chunk {
    std::uint64_t place = 0, offset = 0;
    std::size_t bytes = 0, triangles = 0;
  };

  [[nodiscard]] auto load(std::size_t piece) const -> base::Result<std::vector<picture::Layer>> {
    std::vector<picture::Layer> layers;
    const std::size_t last = piece + 1 < firsts_.size() ? firsts_[piece + 1] : chunks_.size();
    for (std::size_t i = firsts_[piece]; i < last; ++i) {
      const auto bytes = spool_->read(chunks_[i].offset, chunks_[i].bytes);
      if (!bytes) return bytes.failure();
      std::pair<geometry::Mesh, std::vector<picture::Colour>> own;
      base::Unpacker from(*bytes);
      if (!from.take(own) || !from.done())
        return base::error("file-write",
                           "what was put aside in the folder for temporary files (TMPDIR) was changed there");
      layers.push_back({std::move(own.first), std::move(own.second), {}});
    }
    return layers;
  }

  std::unique_ptr<base::Spool> spool_;
  std::vector<Chunk> chunks_;
  std::vector<std::size_t> firsts_;  ///< the first chunk of each piece
};

using Images = base::Result<std::vector<picture::Image>>;

/// A quieter blue than that of the scan.
constexpr picture::Colour street_blue{206, 216, 232};

/// rad; where a camera stands that looks at the longest edge of an outline: clockwise from south.
auto long_side_of(const std::vector<geometry::Polygon>& polygons) -> double {
  double longest = 0, azimuth = 0;
  for (const auto& polygon : polygons)
    for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
      const Point2 along = polygon.outer[(i + 1) % polygon.outer.size()] - polygon.outer[i];
      if (geometry::length(along) <= longest) continue;
      longest = geometry::length(along);
      azimuth = std::atan2(-along.y, along.x);  // its outside is on the right
    }
  return azimuth;
}

/// The scan in `frame` with the footprints on it.
auto scan_images(const Drawn& drawn, const geometry::Box2& frame, std::span<const picture::View> views,
                 const base::Run& run) -> Images {
  FootprintLines outlines(drawn.scene);
  for (std::size_t i = 0; i < drawn.scan.count && !run.cancelled(); ++i) {
    const auto mesh = drawn.scan.load(i);
    if (!mesh) return mesh.failure();
    outlines.look_at(**mesh);
  }
  const auto lines = outlines.lines();
  const auto everything = [](const Point3&, const Point3&, const Point3&) { return true; };
  const picture::Pieces pieces{drawn.scan.count, [&](std::size_t i) -> base::Result<std::vector<picture::Layer>> {
                                 const auto mesh = drawn.scan.load(i);
                                 if (!mesh) return mesh.failure();
                                 std::vector<picture::Layer> layers;
                                 layers.push_back({part_of(**mesh, frame, everything), {picture::mesh_blue}, {}});
                                 return layers;
                               }};
  return picture::draw_views(pieces, {&lines, 1}, views, run);
}

/// The models in the scan's street, which stays for scale, in a quieter blue; the scan's buildings go.
auto model_images(const Drawn& drawn, const geometry::Box2& frame, std::span<const picture::View> views,
                  const base::Run& run) -> Images {
  auto store = Store::open();
  if (!store) return store.failure();
  const Grounds grounds(drawn.scene);
  const auto is_street = [&](const Point3& a, const Point3& b, const Point3& c) { return grounds.is_street(a, b, c); };
  for (std::size_t i = 0; i < drawn.scan.count && !run.cancelled(); ++i) {
    const auto mesh = drawn.scan.load(i);
    if (!mesh) return mesh.failure();
    (*store)->add({part_of(**mesh, frame, is_street), {street_blue}, {}});
  }
  auto visited = drawn.each_building([&](const model::Building& building) -> base::Result<void> {
    picture::Layer layer;
    append(building, layer);
    (*store)->add(layer);
    return {};
  });
  if (!visited) return visited.failure();
  return picture::draw_views((*store)->pieces(), {}, views, run);
}

}  // namespace

auto frame_of(const model::Scene& scene) -> geometry::Box2 {
  constexpr double street = 8;
  geometry::Box2 box;
  for (const auto& footprint : scene.footprints)
    if (!footprint.defect) box.include(geometry::bounds(footprint.polygons));
  return box.grown(street);
}

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

auto close_up(const CloseUp& shown, std::size_t panel_width, std::size_t panel_height, const base::Run& run)
    -> std::optional<picture::Image> {
  picture::Layer models;
  for (const auto* one : solids_of(shown.building)) append(*one, models, [](std::uint32_t) {});
  model::Scene scene;
  scene.footprints.emplace_back();
  scene.footprints.front().polygons = shown.building.footprint;
  geometry::Box2 plan = geometry::bounds(shown.building.footprint);
  geometry::Box3 frame = geometry::Box3::of(models.mesh.vertices);
  if (!frame.empty()) plan.include(frame.plan());
  if (plan.empty()) return std::nullopt;
  plan = plan.grown(close_up_margin);
  picture::Layer scan;
  std::vector<picture::Layer> models_in_street;
  std::vector<picture::Lines> outline;
  if (shown.scan != nullptr) {
    const auto everything = [](const Point3&, const Point3&, const Point3&) { return true; };
    scan = {part_of(*shown.scan, plan, everything), {picture::mesh_blue}, {}};
    if (frame.empty()) frame = geometry::Box3::of(scan.mesh.vertices);
  }
  if (frame.empty()) return std::nullopt;
  const bool scanned = !scan.mesh.triangles.empty();
  if (scanned) {
    FootprintLines lines(scene);
    lines.look_at(scan.mesh);
    outline.push_back(lines.lines());
    const Grounds grounds(scene);
    models_in_street.push_back(
        {part_of(scan.mesh, plan,
                 [&](const Point3& a, const Point3& b, const Point3& c) { return grounds.is_street(a, b, c); }),
         {street_blue},
         {}});
  }
  picture::View front;
  front.width = panel_width;
  front.height = panel_height;
  front.frame = {{plan.least.x, plan.least.y, frame.least.z}, {plan.most.x, plan.most.y, frame.most.z + 1}};
  front.azimuth = long_side_of(shown.building.footprint) + 0.5;
  auto back = front;
  back.azimuth += std::numbers::pi;
  const std::array views{front, back};
  std::vector<std::vector<picture::Image>> columns;
  if (scanned) columns.push_back(picture::draw_views({&scan, 1}, outline, views, run));
  if (!models.mesh.triangles.empty()) {
    models_in_street.push_back(std::move(models));
    columns.push_back(picture::draw_views(models_in_street, {}, views, run));
  }
  if (columns.empty()) return std::nullopt;
  std::vector<picture::Image> rows;
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::vector<picture::Image> row;
    for (const auto& column : columns) row.push_back(column[v]);
    rows.push_back(picture::beside(row));
  }
  return picture::below(rows);
}

auto picture_of(const model::City& city, const picture::View& view, const base::Run& run) -> picture::Image {
  picture::Layer models;
  for (const auto& building : city.buildings) append(building, models);
  return picture::draw({&models, 1}, {}, view, run);
}

auto pictures(const Drawn& drawn, double limit, const base::Run& run, const TexturedLayers* textured)
    -> base::Result<Pictures> {
  constexpr std::size_t most_cells = 4'000'000;  // of the error map
  const auto frame = frame_of(drawn.scene);
  picture::View from_above, at_an_angle;
  from_above.kind = picture::View::Kind::above;
  const std::array views{from_above, at_an_angle};
  // What was drawn is not in memory beside what comes next.
  const auto left = textured != nullptr ? Images(picture::draw_views({&textured->scan, 1}, {}, views, run))
                                        : scan_images(drawn, frame, views, run);
  if (!left) return left.failure();
  const auto right = [&]() -> Images {
    if (textured == nullptr) return model_images(drawn, frame, views, run);
    const Grounds grounds(drawn.scene);
    const std::array layers{street_of(textured->scan, grounds), textured->models};
    return picture::draw_views(layers, {}, views, run);
  }();
  if (!right) return right.failure();
  const auto pair = [&](std::size_t view) { return picture::beside(std::array{(*left)[view], (*right)[view]}); };
  const auto map = evaluate::merged_from(drawn.each_error_map, most_cells);
  if (!map) return map.failure();
  return Pictures{pair(0), pair(1),
                  picture::error_map(map->difference, map->columns, map->rows, limit, "model - mesh, m")};
}

auto pictures(const Reconstruction& reconstruction, const model::Scene& scene, double limit, const base::Run& run)
    -> base::Result<Pictures> {
  const ScanPieces scan{1, [&](std::size_t) -> base::Result<std::shared_ptr<const geometry::Mesh>> {
                          return std::shared_ptr<const geometry::Mesh>(std::shared_ptr<const geometry::Mesh>(),
                                                                       &scene.mesh);  // which nobody owns
                        }};
  const auto each_building = [&](const Drawn::Visit& visit) -> base::Result<void> {
    for (const auto& building : reconstruction.city.buildings)
      if (auto visited = visit(building); !visited) return visited;
    return {};
  };
  const auto each_error_map = [&](const auto& visit) -> base::Result<void> {
    for (const auto& map : reconstruction.error_maps) visit(map);
    return {};
  };
  return pictures({scene, scan, each_building, each_error_map}, limit, run);
}

}  // namespace mansard::report
