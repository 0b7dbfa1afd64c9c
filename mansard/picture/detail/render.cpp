#include "mansard/picture/detail/render.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mansard/base/statistics.hpp"

namespace mansard::picture::detail {
namespace {

using geometry::Point3;

// A low number of rays a pixel, different ones in each pixel of a square pattern, and the mean over such a square of
// what lies in the same surface: as smooth as 64 rays for the price of one (interleaved sampling, Keller and Heidrich
// 2001). The rays are fixed, so a picture is always the same. The sun, whose shadows have edges, has a smaller square.
constexpr std::size_t sky_pattern = 8, sun_pattern = 4, sky_rays = 1;
constexpr std::uint32_t nothing = ~0U;  ///< no triangle: paper

/// What one ray found, and how much light it gets there. As little as there can be: a picture has millions.
struct Found {
  float depth = std::numeric_limits<float>::infinity();  ///< along the ray, m; infinite where nothing is to be lit
  std::uint32_t triangle = nothing;
  float sky = 1, sun = 1;  ///< the parts of sky and sun that it sees
  [[nodiscard]] auto lit() const -> bool { return depth < std::numeric_limits<float>::infinity(); }
};

/// Where a ray ended, and the direction of the surface there, to the camera.
struct Surface {
  Point3 point, normal;
};

/// Sun and sky make a level roof about as bright as its colour says.
struct Lamp {
  Point3 direction;  ///< to the sun
  Light sun{0.74F, 0.71F, 0.65F}, sky{0.45F, 0.47F, 0.51F};
};

/// Above the camera's left shoulder, where draughtsmen put it; on a map, in the north-west.
auto lamp_for(const Camera& camera) -> Lamp {
  const bool above = camera.towards.z > 0.99;
  const Point3 ahead = normalised(above ? camera.up : Point3{camera.towards.x, camera.towards.y, 0});
  Lamp lamp;
  lamp.direction = normalised(-0.55 * camera.right + 0.6 * ahead + Point3{0, 0, 0.95});
  return lamp;
}

/// Van der Corput's sequence in base 2.
auto radical_inverse(std::uint32_t i) -> double {
  double value = 0, weight = 0.5;
  for (; i != 0; i >>= 1U, weight /= 2)
    if ((i & 1U) != 0) value += weight;
  return value;
}

/// Directions about +z, denser where the cosine is larger. A pixel takes one of each quarter of them.
using SkyDirections = std::array<Point3, sky_pattern * sky_pattern * sky_rays>;
auto sky_directions() -> SkyDirections {
  SkyDirections directions;
  for (std::uint32_t i = 0; i < directions.size(); ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(directions.size());
    const double angle = 2 * std::numbers::pi * radical_inverse(i);
    directions[i] = {std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle), std::sqrt(1 - u)};
  }
  return directions;
}

/// Points of a disc, one for each pixel of the pattern: the sun is not a point, and shadows have soft edges.
using SunDisc = std::array<geometry::Point2, sun_pattern * sun_pattern>;
auto sun_disc() -> SunDisc {
  constexpr double radius = 0.03;  // rad; the real one is 0.0047
  SunDisc disc;
  for (std::uint32_t i = 0; i < disc.size(); ++i) {
    const double r = radius * std::sqrt((i + 0.5) / static_cast<double>(disc.size()));
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    disc[i] = {r * std::cos(angle), r * std::sin(angle)};
  }
  return disc;
}

/// A pixel's number in a pattern, neighbours far apart (Bayer's matrix): the bits of x ^ y and y, taken in turn.
auto place_in_pattern(std::size_t x, std::size_t y, std::size_t size) -> std::size_t {
  std::size_t place = 0;
  x %= size;
  y %= size;
  for (std::size_t bit = 1; bit < size; bit <<= 1U) place = 4 * place + ((x ^ y) & bit ? 2 : 0) + (y & bit ? 1 : 0);
  return place;
}

/// Two unit vectors at right angles to n.
auto frame_about(const Point3& n) -> std::array<Point3, 2> {
  const Point3 other = std::abs(n.z) < 0.9 ? Point3{0, 0, 1} : Point3{1, 0, 0};
  const Point3 a = normalised(cross(other, n));
  return {a, cross(n, a)};
}

class Renderer {
 public:
  Renderer(Canvas& canvas, const Model& model, const rays::Scene& scene, const Camera& camera)
      : canvas_(canvas),
        model_(model),
        scene_(scene),
        camera_(camera),
        lamp_(lamp_for(camera)),
        found_(canvas.width * canvas.height),
        sky_(sky_directions()),
        disc_(sun_disc()),
        across_sun_(frame_about(lamp_.direction)) {
    std::vector<double> heights;
    geometry::Box3 box;
    for (const auto& t : model.mesh.triangles)
      for (const auto v : t) {
        const Point3& p = model.mesh.vertices[v];
        heights.push_back(p.z);
        box.add(p);
      }
    // Scans have debris far below the ground; the paper lies under all but the lowest hundredth.
    const auto hundredth = heights.size() / 100;
    paper_height_ = base::ranked(std::move(heights), hundredth) - 1e-3;
    const double size = length(box.most - box.least);
    reach_ = 0.2 * size;
    lift_ = 1e-3 + 2e-5 * size;
  }

  void look() {
    rows([&](std::size_t x, std::size_t y) { found_[y * canvas_.width + x] = cast(middle(x, y)); });
  }
  void light() {
    rows([&](std::size_t x, std::size_t y) {
      Found& found = found_[y * canvas_.width + x];
      if (!found.lit()) return;
      const Surface surface = surface_of(middle(x, y), found);
      ask_for_sky(found, surface, place_in_pattern(x, y, sky_pattern));
      ask_for_sun(found, surface, place_in_pattern(x, y, sun_pattern));
    });
  }
  /// The mean sky and sun around every pixel. Bands of rows, so that what a band needs stays near the processor.
  void smooth() {
    constexpr std::size_t band = 32;
    std::vector<std::array<float, 2>> smooth(found_.size());
    base::parallel_for((canvas_.height + band - 1) / band,
                       [&](std::size_t b) { smooth_rows(b * band, std::min((b + 1) * band, canvas_.height), smooth); });
    for (std::size_t i = 0; i < found_.size(); ++i) {
      found_[i].sky = smooth[i][0];
      found_[i].sun = smooth[i][1];
    }
  }
  void paint() {
    rows([&](std::size_t x, std::size_t y) {
      const std::size_t i = y * canvas_.width + x;
      canvas_.light[i] = on_edge(x, y) ? supersampled(x, y) : colour_of(found_[i], middle(x, y));
    });
  }

 private:
  template <class Work>
  void rows(Work work) const {
    base::parallel_for(canvas_.height, [&](std::size_t y) {
      for (std::size_t x = 0; x < canvas_.width; ++x) work(x, y);
    });
  }

  static auto middle(std::size_t x, std::size_t y) -> Spot {
    return {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
  }

  [[nodiscard]] auto cast(Spot spot) const -> Found {
    const Point3 start = camera_.start(spot);
    Found found;
    if (const auto hit = scene_.cast(start, -1.0 * camera_.towards)) {
      found.triangle = hit->triangle;
      found.depth = static_cast<float>(hit->distance);
    } else if (camera_.towards.z > 0.05) {
      found.depth = static_cast<float>((start.z - paper_height_) / camera_.towards.z);
    }
    return found;
  }

  [[nodiscard]] auto normal_of(const Found& found) const -> Point3 {
    if (found.triangle == nothing) return {0, 0, 1};
    const Point3& normal = model_.normals[found.triangle];
    if (length(normal) < 0.5) return camera_.towards;  // a triangle without area
    return dot(normal, camera_.towards) < 0 ? -1.0 * normal : normal;
  }
  /// Of what is lit.
  [[nodiscard]] auto surface_of(Spot spot, const Found& found) const -> Surface {
    return {camera_.start(spot) - static_cast<double>(found.depth) * camera_.towards, normal_of(found)};
  }

  void ask_for_sky(Found& found, const Surface& surface, std::size_t place) const {
    const auto [a, b] = frame_about(surface.normal);
    const Point3 origin = surface.point + lift_ * surface.normal;
    float open = 0;
    for (std::size_t k = 0; k < sky_rays; ++k) {
      const Point3& d = sky_[k * sky_pattern * sky_pattern + place];
      const auto hit = scene_.cast(origin, d.x * a + d.y * b + d.z * surface.normal);
      // Light that bounces between walls is not followed: what is far away counts as half open instead.
      open += hit ? static_cast<float>(std::min(hit->distance / reach_, 1.0)) : 1.0F;
    }
    found.sky = open / static_cast<float>(sky_rays);
  }

  void ask_for_sun(Found& found, const Surface& surface, std::size_t place) const {
    const Point3 origin = surface.point + lift_ * surface.normal;
    if (dot(surface.normal, lamp_.direction) <= 0) {
      found.sun = 0;
      return;
    }
    found.sun = scene_.cast(origin, lamp_.direction + disc_[place].x * across_sun_[0] + disc_[place].y * across_sun_[1])
                    ? 0.0F
                    : 1.0F;
  }

  /// A pixel in the work on a band.
  struct Lit : Surface {
    bool lit = false;
    std::array<float, 2> light{1, 1};  ///< sky, sun
  };

  /// The mean of the pixels along a row or a column that lie in the same surface, `step` apart, up to `reach` to both
  /// sides where there are so many. A line of a pattern's size and one more, with half the weight at its ends, counts
  /// every place of the pattern the same.
  [[nodiscard]] auto mean_along(const Lit* own, std::size_t before, std::size_t after, std::size_t step,
                                std::size_t which, std::size_t reach) const -> float {
    const double near = 3 * camera_.pixel;
    const double at = dot(own->normal, own->point);
    float sum = 0, weights = 0;
    const auto first = static_cast<std::ptrdiff_t>(std::min(before, reach)),
               last = static_cast<std::ptrdiff_t>(std::min(after, reach));
    for (std::ptrdiff_t d = -first; d <= last; ++d) {
      const Lit& other = own[d * static_cast<std::ptrdiff_t>(step)];
      if (!other.lit || dot(own->normal, other.normal) < 0.7) continue;
      if (std::abs(dot(own->normal, other.point) - at) > near) continue;
      const float weight = static_cast<std::size_t>(std::abs(d)) == reach ? 0.5F : 1.0F;
      sum += weight * other.light[which];
      weights += weight;
    }
    return sum / weights;
  }

  /// The mean over a square as that of the means of its rows: on one surface they are the same, and they are the
  /// fewer sums.
  void smooth_rows(std::size_t from, std::size_t to, std::vector<std::array<float, 2>>& smooth) const {
    constexpr std::array reaches{sky_pattern / 2, sun_pattern / 2};
    constexpr std::size_t reach = std::max(reaches[0], reaches[1]);
    const std::size_t width = canvas_.width, low = from > reach ? from - reach : 0,
                      high = std::min(to + reach, canvas_.height);
    std::vector<Lit> rows((high - low) * width);
    for (std::size_t y = low; y < high; ++y)
      for (std::size_t x = 0; x < width; ++x) {
        const Found& found = found_[y * width + x];
        if (!found.lit()) continue;
        Lit& lit = rows[(y - low) * width + x];
        static_cast<Surface&>(lit) = surface_of(middle(x, y), found);
        lit.lit = true;
        lit.light = {found.sky, found.sun};
      }
    std::vector<std::array<float, 2>> line(width);
    for (std::size_t y = low; y < high; ++y) {
      Lit* const row = &rows[(y - low) * width];
      for (std::size_t x = 0; x < width; ++x)
        for (std::size_t k = 0; k < 2; ++k)
          line[x][k] = row[x].lit ? mean_along(row + x, x, width - 1 - x, 1, k, reaches[k]) : row[x].light[k];
      for (std::size_t x = 0; x < width; ++x) row[x].light = line[x];
    }
    for (std::size_t y = from; y < to; ++y)
      for (std::size_t x = 0; x < width; ++x) {
        const Lit& own = rows[(y - low) * width + x];
        for (std::size_t k = 0; k < 2; ++k)
          smooth[y * width + x][k] =
              own.lit ? mean_along(&own, y - low, high - 1 - y, width, k, reaches[k]) : own.light[k];
      }
  }

  [[nodiscard]] auto colour_of(const Found& found, Spot spot) const -> Light {
    static const Light sheet = to_light(paper);
    if (!found.lit()) return sheet;
    const Point3 normal = normal_of(found);
    const auto facing = static_cast<float>(std::max(0.0, dot(normal, lamp_.direction)));
    // Walls see half the sky, and the ground, which gives back some of it.
    const auto up = static_cast<float>(0.8 + 0.2 * normal.z);
    const Light sky = (0.15F + 0.85F * found.sky) * up * lamp_.sky, sun = facing * found.sun * lamp_.sun;
    if (found.triangle != nothing) {
      const Light light = sky + sun;
      if (const auto colour = model_.picture_at(found.triangle, surface_of(spot, found).point))
        return to_light(*colour) * (0.5F * light + Light{0.5F, 0.5F, 0.5F});
      return model_.albedo[found.triangle] * light;
    }
    // The paper is white where nothing shades it, and keeps some white where something does.
    const Light full = lamp_.sky + facing * lamp_.sun, here = sky + sun;
    Light shade;
    for (std::size_t c = 0; c < 3; ++c) shade[c] = sheet[c] * (0.35F + 0.65F * std::min(1.0F, here[c] / full[c]));
    return shade;
  }

  /// Whether a neighbour shows another colour, another direction or another distance.
  [[nodiscard]] auto on_edge(std::size_t x, std::size_t y) const -> bool {
    const Found& own = found_[y * canvas_.width + x];
    const auto differs = [&](std::size_t i, std::size_t j) {
      const Found& other = found_[j * canvas_.width + i];
      if (other.triangle == own.triangle) return false;
      if (other.triangle == nothing || own.triangle == nothing) return true;
      if (model_.albedo[other.triangle] != model_.albedo[own.triangle]) return true;
      const Surface here = surface_of(middle(x, y), own), there = surface_of(middle(i, j), other);
      if (dot(there.normal, here.normal) < 0.97) return true;
      return std::abs(dot(here.normal, there.point - here.point)) > 4 * camera_.pixel;
    };
    return (x > 0 && differs(x - 1, y)) || (x + 1 < canvas_.width && differs(x + 1, y)) ||
           (y > 0 && differs(x, y - 1)) || (y + 1 < canvas_.height && differs(x, y + 1));
  }

  /// The mean of a 2 × 2 grid of rays; their light is that of the pixel around that found the most similar surface.
  [[nodiscard]] auto supersampled(std::size_t x, std::size_t y) const -> Light {
    constexpr int grid = 2;
    Light sum{};
    for (int j = 0; j < grid; ++j)
      for (int i = 0; i < grid; ++i) {
        const Spot spot{static_cast<double>(x) + (i + 0.5) / grid, static_cast<double>(y) + (j + 0.5) / grid};
        Found found = cast(spot);
        if (found.lit()) take_light(found, surface_of(spot, found), x, y);
        sum = sum + colour_of(found, spot);
      }
    return (1.0F / (grid * grid)) * sum;
  }

  void take_light(Found& found, const Surface& surface, std::size_t x, std::size_t y) const {
    double best = 1e300;
    for (std::size_t j = y >= 1 ? y - 1 : 0; j < std::min(y + 2, canvas_.height); ++j)
      for (std::size_t i = x >= 1 ? x - 1 : 0; i < std::min(x + 2, canvas_.width); ++i) {
        const Found& other = found_[j * canvas_.width + i];
        if (!other.lit()) continue;
        const Surface there = surface_of(middle(i, j), other);
        const double unlike = (1 - dot(surface.normal, there.normal)) * 10 +
                              std::abs(dot(surface.normal, there.point - surface.point)) / camera_.pixel;
        if (unlike < best) {
          best = unlike;
          found.sky = other.sky;
          found.sun = other.sun;
        }
      }
  }

  Canvas& canvas_;
  const Model& model_;
  const rays::Scene& scene_;
  const Camera& camera_;
  Lamp lamp_;
  std::vector<Found> found_;
  SkyDirections sky_;
  SunDisc disc_;
  std::array<Point3, 2> across_sun_;
  double paper_height_ = 0, reach_ = 1, lift_ = 0;
};

}  // namespace

auto joined(std::span<const Layer> layers) -> Model {
  Model model;
  for (const Layer& layer : layers) {
    const auto first = static_cast<std::uint32_t>(model.mesh.vertices.size());
    if (layer.picture) model.pictured.emplace_back(model.mesh.triangles.size(), &layer);
    model.mesh.vertices.insert(model.mesh.vertices.end(), layer.mesh.vertices.begin(), layer.mesh.vertices.end());
    for (std::size_t t = 0; t < layer.mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = layer.mesh.triangles[t];
      model.mesh.triangles.push_back({first + a, first + b, first + c});
      const Point3 &p = layer.mesh.vertices[a], &q = layer.mesh.vertices[b], &r = layer.mesh.vertices[c];
      model.normals.push_back(normalised(cross(q - p, r - p)));
      const Colour colour = layer.colours.empty()
                                ? mesh_blue
                                : layer.colours[layer.colours.size() == layer.mesh.triangles.size() ? t : 0];
      model.albedo.push_back(to_light(colour));
    }
  }
  return model;
}

auto Model::picture_at(std::size_t triangle, Point3 point) const -> std::optional<Colour> {
  for (const auto& [first, layer] : pictured)
    if (triangle >= first && triangle - first < layer->mesh.triangles.size())
      return layer->picture(triangle - first, point);
  return std::nullopt;
}

void render(Canvas& canvas, const Model& model, const rays::Scene& scene, const Camera& camera, const base::Run& run) {
  Renderer renderer(canvas, model, scene, camera);
  renderer.look();
  run.report("picture", "", 0.2);
  if (run.cancelled()) return;
  renderer.light();
  run.report("picture", "", 0.7);
  if (run.cancelled()) return;
  renderer.smooth();
  renderer.paint();
}

void draw_lines(Canvas& canvas, const Lines& lines, const rays::Scene& scene, const Camera& camera) {
  constexpr double lift = 0.05, tolerance = 0.10;  // m
  struct Piece {
    Spot a, b;
  };
  std::vector<std::vector<Piece>> visible(lines.segments.size());
  base::parallel_for(lines.segments.size(), [&](std::size_t s) {
    const auto& [start, end] = lines.segments[s];
    const Spot a = camera.spot(start), b = camera.spot(end);
    const auto steps = std::max<std::size_t>(1, static_cast<std::size_t>(2 * std::hypot(b.x - a.x, b.y - a.y)));
    const auto at = [&](double t) { return Spot{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; };
    // A line along the foot of a wall, seen from above, coincides with the edge of the roof: whether the surface there
    // hides it would be chance. It shows when a place just beside it does.
    const double across = std::hypot(b.x - a.x, b.y - a.y);
    const Spot aside = across > 0 ? Spot{-0.75 * (b.y - a.y) / across, 0.75 * (b.x - a.x) / across} : Spot{};
    const auto open = [&](Spot spot, double depth) {
      const auto hit = scene.cast(camera.start(spot), -1.0 * camera.towards);
      return !hit || hit->distance >= depth - lift - tolerance;
    };
    double since = 0;  // where the visible piece began
    bool before_seen = false;
    for (std::size_t i = 0; i < steps; ++i) {
      const double before = static_cast<double>(i) / static_cast<double>(steps);
      const double middle = (static_cast<double>(i) + 0.5) / static_cast<double>(steps);
      const Point3 p = (1 - middle) * start + middle * end;
      const Spot spot = at(middle);
      const double depth = camera.depth(p);
      const bool seen = open(spot, depth) || open({spot.x + aside.x, spot.y + aside.y}, depth) ||
                        open({spot.x - aside.x, spot.y - aside.y}, depth);
      if (seen && !before_seen) since = before;
      if (!seen && before_seen) visible[s].push_back({at(since), at(before)});
      before_seen = seen;
    }
    if (before_seen) visible[s].push_back({at(since), b});
  });
  Ink ink(canvas.width, canvas.height);
  for (const auto& pieces : visible)
    for (const Piece& piece : pieces) ink.stroke(piece.a, piece.b, lines.width);
  ink.spread_on(canvas, lines.colour);
}

}  // namespace mansard::picture::detail
