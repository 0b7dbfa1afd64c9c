// Tiles are coarser than the scan, and their triangles others: each gets a patch of its own, whose texels are coloured
// by the nearest place of the scan. Models are baked as for files.
#include "apps/server/textures.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "apps/server/options.hpp"
#include "mansard/base/stopped.hpp"
#include "mansard/formats/image.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::server {
namespace {

using geometry::Box3;
using geometry::Point3;

constexpr double image_memory = 128;                       // MB of decoded images
constexpr double finest = 0.05;                            // m along a texel
constexpr double coarser = 1.25;                           // where the texels do not fit
constexpr double reach = 1.5;                              // m, at least, between a tile and the scan that colours it
constexpr double piece = 64;                               // m; so much of a tile is coloured at once
constexpr std::array<std::uint32_t, 2> sides{1024, 2048};  // pixels of the picture of a tile, the second at need
constexpr std::uint32_t building_side = 2048;              // pixels of the picture of a building
constexpr std::uint32_t cell = 16;                         // pixels that JPEG codes together
constexpr std::uint32_t gutter = 2;  // pixels around the picture of a face, which repeat its border
constexpr int quality = 85;          // of JPEG
constexpr std::array<std::uint8_t, 3> plain{122, 154, 204};  // of the mesh in the view, where the scan has no colour

template <class T>
void append(std::string& bytes, const T& value) {
  static_assert(std::endian::native == std::endian::little);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Places rectangles in rows, in the order in which they come.
class Shelves {
 public:
  Shelves(std::uint32_t width, std::uint32_t height) : width_(width), height_(height) {}
  /// The corner of the next one; none where there is no room.
  auto place(std::uint32_t wide, std::uint32_t high) -> std::optional<std::array<std::uint32_t, 2>> {
    if (x_ + wide > width_) {
      y_ += row_;
      x_ = row_ = 0;
    }
    if (x_ + wide > width_ || y_ + high > height_) return std::nullopt;
    const std::array at{x_, y_};
    x_ += wide;
    row_ = std::max(row_, high);
    return at;
  }
  [[nodiscard]] auto used() const -> std::uint32_t { return y_ + row_; }

 private:
  std::uint32_t width_, height_, x_ = 0, y_ = 0, row_ = 0;
};

/// Half of a square of texels for a triangle: corner 0 is at the right angle, the others `legs` texels away from it.
struct Patch {
  std::uint32_t x = 0, y = 0, legs = 1;
  bool turned = false;  ///< the other half, by half a turn

  /// Two halves with what bilinear sampling takes beyond the longest side: texels with i + j <= legs + 1.
  [[nodiscard]] auto square() const -> std::uint32_t { return legs + 3; }
  [[nodiscard]] auto texel(std::uint32_t i, std::uint32_t j) const -> std::array<std::uint32_t, 2> {
    return turned ? std::array{x + square() - 1 - i, y + square() - 1 - j} : std::array{x + i, y + j};
  }
};

auto corners_of(const picture::Tile& tile, std::size_t triangle) -> std::array<Point3, 3> {
  std::array<Point3, 3> out;
  for (std::size_t c = 0; c < 3; ++c) {
    const float* p = &tile.positions[std::size_t{3} * tile.triangles[3 * triangle + c]];
    out[c] = tile.centre + Point3{p[0], p[1], p[2]};
  }
  return out;
}

/// Patches with texels of that size; none where they do not fit into a picture of that side.
auto patches_of(const std::vector<double>& legs, double texel, std::uint32_t side)
    -> std::optional<std::vector<Patch>> {
  std::vector<Patch> out(legs.size());
  std::vector<std::uint32_t> order(legs.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t t = 0; t < legs.size(); ++t)
    out[t].legs = static_cast<std::uint32_t>(std::clamp(std::ceil(legs[t] / texel), 1.0, side / 2.0));
  std::ranges::stable_sort(order, std::ranges::greater(), [&](auto t) { return out[t].legs; });
  Shelves shelves(side, side);
  for (std::size_t i = 0; i < order.size(); i += 2) {
    Patch& first = out[order[i]];
    const auto at = shelves.place(first.square(), first.square());
    if (!at) return std::nullopt;
    first.x = (*at)[0];
    first.y = (*at)[1];
    if (i + 1 == order.size()) break;
    out[order[i + 1]] = first;
    out[order[i + 1]].turned = true;
  }
  return out;
}

/// A texel, and where the scan is nearest to it.
struct Texel {
  std::size_t pixel = 0;
  Point3 at;
  std::uint32_t triangle = 0, material = texture::no_material;
  bool known = false;
};

/// The texels of one patch, in space.
void add_texels(const std::array<Point3, 3>& corners, const Patch& patch, std::uint32_t side, std::vector<Texel>& out) {
  const double n = patch.legs;
  for (std::uint32_t i = 0; i <= patch.legs + 1; ++i)
    for (std::uint32_t j = 0; i + j <= patch.legs + 1; ++j) {
      double u = i / n, v = j / n;
      if (const double over = (u + v - 1) / 2; over > 0) u -= over, v -= over;
      u = std::clamp(u, 0.0, 1.0);
      v = std::clamp(v, 0.0, 1.0);
      const auto [x, y] = patch.texel(i, j);
      out.push_back(
          {std::size_t{y} * side + x, corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0])});
    }
}

/// Colours texels by the triangles of the scan near them; picture by picture, so that one is in memory at a time.
auto colour(std::vector<Texel>& texels, const std::vector<texture::ScanTriangle>& near, const texture::Scan& scan,
            double within, model::Pixels& to) -> bool {
  if (near.empty()) return false;
  geometry::Mesh mesh;
  for (const auto& triangle : near) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), triangle.corners.begin(), triangle.corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const rays::Scene surface(std::move(mesh));
  constexpr std::size_t together = 1024;
  base::parallel_for((texels.size() + together - 1) / together, [&](std::size_t p) {
    for (std::size_t i = p * together; i < std::min(texels.size(), (p + 1) * together); ++i) {
      const auto nearest = surface.nearest(texels[i].at, within);
      if (!nearest) continue;
      texels[i].known = true;
      texels[i].at = nearest->point;
      texels[i].triangle = nearest->triangle;
      texels[i].material = near[nearest->triangle].material;
    }
  });
  std::ranges::stable_sort(texels, {}, &Texel::material);
  bool any = false;
  for (std::size_t from = 0; from < texels.size();) {
    const auto material = texels[from].material;
    std::size_t end = from;
    while (end < texels.size() && texels[end].material == material) ++end;
    const bool pictured = material != texture::no_material;
    const auto image = pictured ? scan.image(material) : nullptr;
    const auto wrap = pictured ? scan.wrap(material) : std::array<formats::Wrap, 2>{};
    for (; from < end; ++from) {
      const Texel& texel = texels[from];
      if (!texel.known) continue;
      const auto rgb = texture::colour_at(near[texel.triangle], texel.at, image.get(), wrap);
      if (!rgb) continue;
      any = true;
      std::ranges::copy(*rgb, to.rgb.begin() + static_cast<std::ptrdiff_t>(3 * texel.pixel));
    }
  }
  return any;
}

/// The same by points.
auto colour(const std::vector<Texel>& texels, const texture::PointTree& points, double within, model::Pixels& to)
    -> bool {
  std::atomic<bool> any = false;
  constexpr std::size_t together = 1024;
  base::parallel_for((texels.size() + together - 1) / together, [&](std::size_t p) {
    for (std::size_t i = p * together; i < std::min(texels.size(), (p + 1) * together); ++i) {
      const auto rgb = texture::colour_at(points, texels[i].at, within);
      if (!rgb) continue;
      any = true;
      std::ranges::copy(*rgb, to.rgb.begin() + static_cast<std::ptrdiff_t>(3 * texels[i].pixel));
    }
  });
  return any;
}

/// Where triangles are, in squares of `piece` metres.
auto pieces_of(const picture::Tile& tile) -> std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> {
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> out;
  for (std::size_t t = 0; t < tile.triangles.size() / 3; ++t) {
    const auto corners = corners_of(tile, t);
    const Point3 middle = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
    out[{std::llround(middle.x / piece), std::llround(middle.y / piece)}].push_back(t);
  }
  return out;
}

struct Framed {
  std::vector<std::array<std::uint32_t, 2>> corners;  ///< by face
  std::uint32_t height = 0;
};

/// Begins every picture at a multiple of `cell`, so that JPEG codes no pixels of two of them together. None where they
/// do not fit.
auto framed(const std::vector<const model::FaceTexture*>& faces) -> std::optional<Framed> {
  const auto cells = [](std::uint32_t pixels) { return (pixels + 2 * gutter + cell - 1) / cell * cell; };
  std::vector<std::size_t> order(faces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](auto f) { return faces[f]->pixels.height; });
  Framed out;
  out.corners.resize(faces.size());
  Shelves shelves(building_side, building_side);
  for (const auto f : order) {
    const auto at = shelves.place(cells(faces[f]->pixels.width), cells(faces[f]->pixels.height));
    if (!at) return std::nullopt;
    out.corners[f] = *at;
  }
  out.height = shelves.used();
  return out;
}

/// The picture of a face and, up to the next multiple of `cell`, its border.
void draw(const model::Pixels& face, std::array<std::uint32_t, 2> corner, model::Pixels& to) {
  const auto inner = [](std::uint32_t i, std::uint32_t size) {
    return std::min(i < gutter ? 0 : i - gutter, size - 1);
  };
  const auto cells = [](std::uint32_t pixels) { return (pixels + 2 * gutter + cell - 1) / cell * cell; };
  for (std::uint32_t j = 0; j < cells(face.height); ++j)
    for (std::uint32_t i = 0; i < cells(face.width); ++i) {
      const std::size_t from = std::size_t{inner(j, face.height)} * face.width + inner(i, face.width);
      const std::size_t at = std::size_t{corner[1] + j} * to.width + corner[0] + i;
      std::copy_n(face.rgb.begin() + static_cast<std::ptrdiff_t>(3 * from), 3,
                  to.rgb.begin() + static_cast<std::ptrdiff_t>(3 * at));
    }
}

auto blank(std::uint32_t width, std::uint32_t height) -> model::Pixels {
  model::Pixels out{width, height, {}};
  out.rgb.reserve(std::size_t{3} * width * height);
  for (std::size_t i = 0; i < std::size_t{width} * height; ++i)
    out.rgb.insert(out.rgb.end(), plain.begin(), plain.end());
  return out;
}

}  // namespace

auto Textures::read(const Inputs& inputs, const OpenScene& scene, const base::Run& run)
    -> base::Result<std::shared_ptr<const Textures>> {
  pipeline::Options options;
  if (auto set = set_all(options, inputs.reading); !set) return set.error();
  auto scan = texture::Scan::open(image_memory);
  if (!scan) return scan.failure();
  const Point3 more{reach, reach, reach};
  const auto box = scene.mesh_box();
  if (!box.empty()) (*scan)->expect({box.least - more, box.most + more});
  const std::vector<std::filesystem::path> meshes(inputs.meshes.begin(), inputs.meshes.end());
  const auto told = texture::read(**scan, meshes, options.ingest, scene.scene().frame, run);
  if (!told) return told.failure();
  if (run.cancelled()) return base::stopped();
  if ((*scan)->empty())
    return base::error("server-no-textures",
                       "the mesh has neither textures nor colours; OBJ, PLY, glTF, 3D Tiles and LAS can have them",
                       inputs.meshes.empty() ? "" : inputs.meshes.front());
  return std::shared_ptr<const Textures>(new Textures(std::move(*scan)));
}

auto Textures::of_tile(const picture::Tile& tile) const -> base::Result<std::string> {
  std::string bytes;
  const std::size_t count = tile.triangles.size() / 3;
  std::vector<double> legs(count);
  for (std::size_t t = 0; t < count; ++t) {
    const auto corners = corners_of(tile, t);
    legs[t] = std::max(geometry::length(corners[1] - corners[0]), geometry::length(corners[2] - corners[0]));
  }
  const double longest = legs.empty() ? 0 : *std::ranges::max_element(legs);
  std::optional<std::vector<Patch>> patches;
  std::uint32_t side = 0;
  for (std::size_t s = 0; !patches && s < sides.size(); ++s) {
    side = sides[s];
    for (double texel = finest; !patches && texel <= coarser * std::max(longest, finest); texel *= coarser)
      patches = patches_of(legs, texel, side);
  }
  bool any = false;
  model::Pixels picture;
  if (patches) {
    picture = blank(side, side);
    const double within = std::max(reach, 2 * tile.cell);
    const Point3 more{within, within, within};
    const std::scoped_lock lock(mutex_);
    for (const auto& [place, triangles] : pieces_of(tile)) {
      std::vector<Texel> texels;
      Box3 box;
      for (const auto t : triangles) {
        const auto corners = corners_of(tile, t);
        for (const auto& corner : corners) box.add(corner);
        add_texels(corners, (*patches)[t], side, texels);
      }
      const auto near = scan_->near({box.least - more, box.most + more});
      if (!near) return near.failure();
      any = colour(texels, *near, *scan_, within, picture) || any;
      if (!near->empty() || !scan_->has_points()) continue;
      auto points = scan_->points_near({box.least - more, box.most + more});
      if (!points) return points.failure();
      any = colour(texels, texture::PointTree(*std::move(points)), within, picture) || any;
    }
  }
  append(bytes, static_cast<std::uint32_t>(any ? count : 0));
  if (!any) return bytes;
  for (const auto& patch : *patches)
    for (const auto& [i, j] : {std::array{0U, 0U}, std::array{patch.legs, 0U}, std::array{0U, patch.legs}})
      for (const auto pixel : patch.texel(i, j))
        append(bytes, static_cast<std::uint16_t>(std::lround((pixel + 0.5) / side * 65535)));
  const auto image = formats::encode_image(picture, formats::ImageCodec::png, quality);
  if (!image) return image.failure();
  return bytes + *image;
}

auto Textures::of_building(const std::vector<model::LabelledSolid>& solids, std::uint64_t revision) const
    -> base::Result<std::string> {
  texture::Options options;
  model::BuildingTexture baked;
  std::vector<const model::FaceTexture*> faces;
  std::optional<Framed> places;
  for (; !places; options.size *= 1.5) {
    {
      const std::scoped_lock lock(mutex_);
      auto made = texture::bake(solids, *scan_, options, building_side - 2 * cell);
      if (!made) return made.failure();
      baked = std::move(*made);
    }
    faces.clear();
    for (const auto& solid : baked.solids)
      for (const auto& face : solid.faces) faces.push_back(&face);
    places = framed(faces);
    if (!places && options.size > 100) break;  // more faces than a picture has cells
  }
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(revision));
  append(bytes, static_cast<std::uint32_t>(places ? faces.size() : 0));
  if (!places || faces.empty()) return bytes;
  auto picture = blank(building_side, places->height);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    draw(faces[f]->pixels, places->corners[f], picture);
    const auto& frame = faces[f]->frame;
    const std::array<Point3, 2> axes{frame.right, frame.below};
    for (std::size_t a = 0; a < 2; ++a) {
      const double size = a == 0 ? building_side : places->height;
      for (const double value : {axes[a].x, axes[a].y, axes[a].z, frame.start[a] + places->corners[f][a] + gutter})
        append(bytes, value / size);
    }
  }
  const auto image = formats::encode_image(picture, formats::ImageCodec::jpeg, quality);
  if (!image) return image.failure();
  return bytes + *image;
}

}  // namespace mansard::server
