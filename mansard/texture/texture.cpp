// The steps: the faces' grids, the scan near them, what it shows of each, the building's colours, what it does not
// show.
#include "mansard/texture/texture.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/pack.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/formats/written.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/ingest/textured.hpp"
#include "mansard/texture/detail/fill.hpp"
#include "mansard/texture/detail/project.hpp"
#include "mansard/texture/detail/splat.hpp"

namespace mansard::texture {
namespace {

using detail::FaceGrid;
using detail::FaceLight;
using detail::Light;
using detail::NearTriangle;
using geometry::Box2;
using geometry::Box3;
using geometry::Point3;
using model::FaceClass;

/// The furthest that the scan's surface may be from a face, plus what a texel sticks out.
auto reach_of(const Options& options) -> double { return std::max(options.outward, options.inward) + options.size; }

/// The same for points: what decides on those has its neighbours, too.
auto point_reach_of(const Options& options) -> double { return reach_of(options) + 2 * options.point_reach; }

auto grown(Box3 box, double by) -> Box3 {
  const Point3 reach{by, by, by};
  return {box.least - reach, box.most + reach};
}

/// The faces of all solids, in their order.
struct Faces {
  std::vector<FaceGrid> grids;
  std::vector<Box3> boxes;
};

auto faces_of(const std::vector<model::LabelledSolid>& solids, const detail::Placed& placed, const Options& options,
              std::uint32_t side) -> Faces {
  Faces out;
  for (std::size_t s = 0; s < solids.size(); ++s)
    for (std::size_t f = 0; f < solids[s].solid.faces.size(); ++f) {
      const auto& face = solids[s].solid.faces[f];
      out.grids.push_back(detail::grid_of(face, solids[s].classes[f], placed.vertices[s], options.size, side));
      Box3 box;
      for (const auto& loop : face.loops)
        for (const auto v : loop) box.add(placed.vertices[s][v]);
      out.boxes.push_back(grown(box, reach_of(options)));
    }
  return out;
}

/// Relative to the building: exactly, since the origin is whole metres and corners are multiples of 2⁻²⁰ m.
auto near_triangles(const std::vector<ScanTriangle>& scan, const std::array<double, 3>& origin)
    -> std::vector<NearTriangle> {
  std::vector<NearTriangle> out;
  const Point3 from{origin[0], origin[1], origin[2]};
  for (const auto& triangle : scan) {
    auto& own = out.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) own.corners[c] = triangle.corners[c] - from;
    own.normal = geometry::normalised(cross(own.corners[1] - own.corners[0], own.corners[2] - own.corners[0]));
    own.box = Box3::of(own.corners);
    own.source = &triangle;
  }
  return out;
}

auto project_all(const Faces& faces, const std::vector<NearTriangle>& triangles,
                 const std::vector<detail::Splat>& splats, const Scan& scan, const Options& options)
    -> std::vector<FaceLight> {
  std::vector<Box2> boxes;
  for (const auto& triangle : triangles) boxes.push_back(triangle.box.plan());
  const geometry::BoxIndex index(boxes);
  std::vector<Box3> spots;
  boxes.clear();
  for (const auto& splat : splats)
    boxes.push_back(spots.emplace_back(grown({splat.at, splat.at}, splat.radius)).plan());
  const geometry::BoxIndex index_of_splats(boxes);
  std::vector<FaceLight> out(faces.grids.size());
  base::parallel_for(out.size(), [&](std::size_t f) {
    if (faces.grids[f].columns == 0) return;
    std::vector<const NearTriangle*> near;
    for (const auto t : index.overlapping(faces.boxes[f].plan()))
      if (triangles[t].box.overlaps(faces.boxes[f])) near.push_back(&triangles[t]);
    std::vector<const detail::Splat*> near_splats;
    for (const auto s : index_of_splats.overlapping(faces.boxes[f].plan()))
      if (spots[s].overlaps(faces.boxes[f])) near_splats.push_back(&splats[s]);
    const auto of_points = near_splats.empty() ? std::vector<std::optional<Light>>()
                                               : detail::splatted(faces.grids[f], near_splats, options);
    out[f] = detail::project(faces.grids[f], near, scan, of_points, options);
  });
  return out;
}

/// What roofs, and all other faces, of the building look like on average.
struct MeanColours {
  Light roof{}, wall{};
};

auto is_roof(FaceClass kind) -> bool { return kind == FaceClass::roof; }

/// Where nothing is known of either: the colours that viewers give the classes (formats/detail/parts.hpp).
constexpr std::array<std::uint8_t, 3> usual_roof{176, 98, 80}, usual_wall{216, 212, 204};

auto linear(const std::array<std::uint8_t, 3>& srgb) -> Light {
  return {formats::linear_of(srgb[0]), formats::linear_of(srgb[1]), formats::linear_of(srgb[2])};
}

auto srgb(const Light& light) -> std::array<std::uint8_t, 3> {
  return {formats::srgb_of(light[0]), formats::srgb_of(light[1]), formats::srgb_of(light[2])};
}

auto means_of(const Faces& faces, const std::vector<FaceLight>& lights) -> MeanColours {
  std::array<std::array<std::uint64_t, 3>, 2> sums{};
  std::array<std::uint64_t, 2> counts{};
  for (std::size_t f = 0; f < lights.size(); ++f) {
    const std::size_t kind = is_roof(faces.grids[f].kind) ? 0 : 1;
    for (std::size_t c = 0; c < 3; ++c) sums[kind][c] += lights[f].sum[c];
    counts[kind] += lights[f].known;
  }
  std::array<Light, 2> mean{linear(usual_roof), linear(usual_wall)};
  for (std::size_t kind = 0; kind < 2; ++kind) {
    const std::size_t from = counts[kind] > 0 ? kind : 1 - kind;  // a wall of which nothing is known as the roof
    if (counts[from] == 0) continue;
    for (std::size_t c = 0; c < 3; ++c)
      mean[kind][c] = static_cast<std::uint16_t>((sums[from][c] + counts[from] / 2) / counts[from]);
  }
  return {mean[0], mean[1]};
}

/// A face of one colour: a pixel, with every point in its middle.
auto plain(const Light& light) -> model::FaceTexture {
  model::FaceTexture out;
  out.frame.start = {0.5, 0.5};
  const auto colour = srgb(light);
  out.pixels = {1, 1, {colour.begin(), colour.end()}};
  return out;
}

auto finished(const FaceGrid& grid, FaceLight light, const MeanColours& means, const std::array<double, 3>& origin,
              const Options& options) -> model::FaceTexture {
  const Light& mean = is_roof(grid.kind) ? means.roof : means.wall;
  if (light.known == 0) return plain(mean);
  const bool continued = static_cast<double>(light.known) >= options.fill_share * static_cast<double>(light.inside);
  std::vector<bool> fixed(light.state.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const bool unknown = light.state[i] == detail::unknown;
    if (unknown && !continued) light.light[i] = mean;
    fixed[i] = light.state[i] == detail::seen || (unknown && !continued);
  }
  detail::continue_from(light.light, fixed, grid.columns, grid.rows);
  model::FaceTexture out;
  out.frame = detail::frame_of(grid, origin);
  out.pixels.width = grid.columns;
  out.pixels.height = grid.rows;
  out.pixels.rgb.reserve(3 * light.light.size());
  for (const Light& texel : light.light)
    for (const std::uint8_t channel : srgb(texel)) out.pixels.rgb.push_back(channel);
  return out;
}

/// By area, of what can be seen from outside.
auto known_share(const Faces& faces, const std::vector<FaceLight>& lights) -> double {
  double known = 0, all = 0;
  for (std::size_t f = 0; f < lights.size(); ++f) {
    const auto& grid = faces.grids[f];
    if (grid.kind != FaceClass::roof && grid.kind != FaceClass::wall) continue;
    const double area = grid.texel * grid.texel;  // of each sample, but for a factor
    known += area * static_cast<double>(lights[f].known);
    all += area * static_cast<double>(lights[f].inside);
  }
  return all > 0 ? known / all : 0;
}

}  // namespace

auto bake(const std::vector<model::LabelledSolid>& solids, const Scan& scan, const Options& options, std::uint32_t side)
    -> base::Result<model::BuildingTexture> {
  model::BuildingTexture out;
  const auto placed = detail::placed(solids);
  const Faces faces = faces_of(solids, placed, options, side);
  Box3 box;
  for (const Box3& one : faces.boxes) box.include(one);
  if (box.empty()) return out;
  const Point3 origin{placed.origin[0], placed.origin[1], placed.origin[2]};
  const auto near = scan.near({box.least + origin, box.most + origin});
  if (!near) return near.failure();
  const auto around = grown({box.least + origin, box.most + origin}, point_reach_of(options) - reach_of(options));
  const auto points = scan.points_near(around);
  if (!points) return points.failure();
  auto lights = project_all(faces, near_triangles(*near, placed.origin),
                            detail::splats_of(*points, placed.origin, options), scan, options);
  const MeanColours means = means_of(faces, lights);
  out.known = known_share(faces, lights);
  std::vector<model::FaceTexture> textures(lights.size());
  base::parallel_for(lights.size(), [&](std::size_t f) {
    textures[f] = finished(faces.grids[f], std::move(lights[f]), means, placed.origin, options);
  });
  std::size_t next = 0;
  for (const auto& solid : solids) {
    auto& own = out.solids.emplace_back();
    own.roof = srgb(means.roof);
    own.wall = srgb(means.wall);
    for (std::size_t f = 0; f < solid.solid.faces.size(); ++f) own.faces.push_back(std::move(textures[next++]));
  }
  return out;
}

auto PutAside::open() -> base::Result<std::unique_ptr<PutAside>> {
  auto spool = base::Spool::open();
  if (!spool) return spool.failure();
  auto out = std::make_unique<PutAside>();
  out->spool_ = std::move(*spool);
  return out;
}

auto PutAside::add(const model::Building& building, const Scan& scan, const Options& options,
                   const formats::WriteOptions& write) -> base::Result<void> {
  const auto solids = formats::written_solids(building, write.solids);
  if (solids.empty()) {
    places_.emplace_back();
    return {};
  }
  const auto texture = bake(solids, scan, options, formats::largest_picture(write));
  if (!texture) return texture.failure();
  const std::string bytes = base::packed(*texture);
  places_.push_back({spool_->size(), bytes.size()});
  spool_->append(bytes);
  return {};
}

auto PutAside::apply(std::size_t number, model::Building& building) const -> base::Result<void> {
  if (number >= places_.size() || places_[number].bytes == 0) return {};
  const auto bytes = spool_->read(places_[number].offset, places_[number].bytes);
  if (!bytes) return bytes.failure();
  model::BuildingTexture texture;
  base::Unpacker from(*bytes);
  if (!from.take(texture) || !from.done())
    return base::error("file-write", "what was put aside in the folder for temporary files (TMPDIR) was changed there");
  constexpr double thousandths = 1000;
  building.attributes.emplace_back(known_attribute, std::round(texture.known * thousandths) / thousandths);
  building.texture = std::move(texture);
  return {};
}

auto read(Scan& scan, const std::vector<std::filesystem::path>& meshes, const ingest::Options& options,
          const model::Frame& frame, const base::Run& run) -> base::Result<std::vector<base::Diagnostic>> {
  if (scan.expected().empty()) return std::vector<base::Diagnostic>();
  std::vector<base::Diagnostic> told;
  auto done = ingest::read_textured(meshes, options, frame, scan.expected(),
                                    {[&](formats::TexturedMesh mesh) -> base::Result<void> {
                                       scan.add(mesh);
                                       told.insert(told.end(), mesh.warnings.begin(), mesh.warnings.end());
                                       return {};
                                     },
                                     [&](const std::vector<formats::ColouredPoint>& points) -> base::Result<void> {
                                       scan.add(points);
                                       return {};
                                     }},
                                    run);
  if (!done) return done.failure();
  return told;  // what else reading warns of was told when the scene was read
}

auto bake_all(const EachBuilding& each, const std::vector<std::filesystem::path>& meshes, const ingest::Options& ingest,
              const model::Frame& frame, const Options& options, const formats::WriteOptions& write,
              const base::Run& run) -> base::Result<Baked> {
  auto scan = Scan::open(options.image_memory);
  if (!scan) return scan.failure();
  std::size_t count = 0;
  auto done = each([&](const model::Building& building) -> base::Result<void> {
    Box3 box;
    for (const auto& part : building.parts)
      for (const Point3& v : part.model.solid.vertices) box.add(v);
    for (const auto& solid : building.solids)
      for (const Point3& v : solid.model.solid.vertices) box.add(v);
    if (!box.empty()) (*scan)->expect(grown(box, point_reach_of(options)));
    ++count;
    return {};
  });
  if (!done) return done.failure();
  Baked out;
  auto told = read(**scan, meshes, ingest, frame, run);
  if (!told) return told.failure();
  out.warnings = std::move(*told);
  auto textures = PutAside::open();
  if (!textures) return textures.failure();
  std::size_t number = 0;
  done = each([&](const model::Building& building) -> base::Result<void> {
    if (run.cancelled()) return base::stopped();
    run.report("texture", building.id, static_cast<double>(number++) / static_cast<double>(count));
    return (*textures)->add(building, **scan, options, write);
  });
  if (!done) return done.failure();
  const auto found = (*scan)->warnings();
  out.warnings.insert(out.warnings.end(), found.begin(), found.end());
  out.textures = std::move(*textures);
  out.scan = std::move(*scan);
  return out;
}

auto codes() -> std::vector<base::Code> {
  return {
      {"texture-missing", "A picture, or a library of materials, that a mesh names is missing.",
       "Copy it to where the mesh names it. Faces that only it shows get the mean colour of the building.", 0},
      {"texture-outside", "A mesh names a picture, or a library of materials, that is not in its folder.",
       "Copy it into the folder of the mesh, or set the environment variable MANSARD_OUTSIDE=yes if the mesh is to be "
       "trusted.",
       0},
      {"texture-image", "A picture on a mesh cannot be read: it is damaged, too large or of a kind that is not read.",
       "Export the mesh with JPEG, PNG or WebP textures; KTX2 is not read.", 0},
      {"texture-none",
       "Textures were asked for, and neither meshes nor point clouds have textures or colours near the models.",
       "Give a textured mesh (OBJ with its MTL, glTF, 3D Tiles) or a point cloud with colours, or leave --texture out.",
       0},
      {"texture-encode", "Textures could not be encoded, because GDAL lacks the codec.",
       "Choose another write.texture_format, or install GDAL with it.", 70},
  };
}

}  // namespace mansard::texture
