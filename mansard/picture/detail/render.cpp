#include "mansard/picture/detail/render.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "mansard/base/statistics.hpp"

namespace mansard::picture::detail {
namespace {

using geometry::Point3;

// A low number of rays a pixel, different ones in each pixel of a square pattern, and the mean over such a square of
// what lies in the same surface: as smooth as 64 rays for the price of one (interleaved sampling, Keller and Heidrich
// 2001). The rays are fixed, so a picture is always the same. The sun, whose shadows have edges, has a smaller square.
// What a place sees of the sky changes slowly: one pixel in four asks, and the others take it from those around them.
constexpr std::size_t sky_pattern = 8, sun_pattern = 4, sky_step = 2;
constexpr std::size_t lone_rays = 16;   ///< to the sky, from a pixel with nothing of its surface around that asked
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

/// Directions about +z, denser where the cosine is larger.
using SkyDirections = std::array<Point3, sky_pattern * sky_pattern>;
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
  Renderer(Canvas& canvas, const Model& model, const rays::Scene& scene, std::span<const Point3> points,
           const Camera& camera)
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
    for (const Point3& p : points) {
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
    rows([&](std::size_t y, Rays& rays) {
      for (std::size_t x = 0; x < canvas_.width; ++x) rays.add(towards(middle(x, y)));
      const auto hits = rays.hits(scene_);
      for (std::size_t x = 0; x < canvas_.width; ++x) at(x, y) = found_by(middle(x, y), hits[x]);
    });
  }
  void light() {
    rows([&](std::size_t y, Rays& rays) { light_of_sun(y, rays); });
    smooth_sun();
    light_of_sky();
  }
  void paint() {
    find_edges();
    rows([&](std::size_t y, Rays& rays) {
      std::vector<std::size_t> edges;
      for (std::size_t x = 0; x < canvas_.width; ++x)
        if (on_edge(x, y)) edges.push_back(x);
        else canvas_.light[y * canvas_.width + x] = colour_of(at(x, y), middle(x, y));
      supersample(y, edges, rays);
    });
  }

 private:
  /// The rays of a row, and what they meet.
  class Rays {
   public:
    void add(const rays::Ray& ray) { rays_.push_back(ray); }
    auto hits(const rays::Scene& scene) -> std::span<const std::optional<rays::Hit>> {
      hits_.resize(rays_.size());
      scene.cast_all(rays_, hits_);
      return hits_;
    }
    auto blocked(const rays::Scene& scene) -> std::span<const char> {
      blocked_.resize(rays_.size());
      scene.cast_any(rays_, blocked_);
      return blocked_;
    }

   private:
    std::vector<rays::Ray> rays_;
    std::vector<std::optional<rays::Hit>> hits_;
    std::vector<char> blocked_;
  };

  template <class Work>
  void rows(Work work) const {
    base::parallel_for(canvas_.height, [&](std::size_t y) {
      Rays rays;
      work(y, rays);
    });
  }

  auto at(std::size_t x, std::size_t y) -> Found& { return found_[y * canvas_.width + x]; }
  [[nodiscard]] auto at(std::size_t x, std::size_t y) const -> const Found& { return found_[y * canvas_.width + x]; }

  static auto middle(std::size_t x, std::size_t y) -> Spot {
    return {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
  }

  [[nodiscard]] auto towards(Spot spot) const -> rays::Ray { return {camera_.start(spot), -1.0 * camera_.towards}; }
  [[nodiscard]] auto found_by(Spot spot, const std::optional<rays::Hit>& hit) const -> Found {
    Found found;
    if (hit) {
      found.triangle = hit->triangle;
      found.depth = static_cast<float>(hit->distance);
    } else if (camera_.towards.z > 0.05) {
      found.depth = static_cast<float>((camera_.start(spot).z - paper_height_) / camera_.towards.z);
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

  /// Whether two places lie in the same surface, as far as `near` metres show.
  static auto alike(const Surface& a, const Surface& b, double near) -> bool {
    return dot(a.normal, b.normal) >= 0.7 && std::abs(dot(a.normal, b.point - a.point)) <= near;
  }

  /// A place in the work on a band: a pixel, or every second one.
  struct Sample : Surface {
    bool lit = false;
    float light = 1;
  };

  /// The mean of the samples along a row or a column that lie in the same surface, `step` apart in memory, up to
  /// `reach` to both sides where there are so many. A line of a pattern's size and one more, with half the weight at
  /// its ends, counts every place of the pattern the same.
  static auto mean_along(const Sample* own, std::size_t before, std::size_t after, std::size_t step, std::size_t reach,
                         double near) -> float {
    float sum = 0, weights = 0;
    const auto first = static_cast<std::ptrdiff_t>(std::min(before, reach)),
               last = static_cast<std::ptrdiff_t>(std::min(after, reach));
    // In most places all are the same, in whatever surfaces they lie.
    bool same = true;
    for (std::ptrdiff_t d = -first; d <= last; ++d)
      same = same && own[d * static_cast<std::ptrdiff_t>(step)].light == own->light;
    if (same) return own->light;
    for (std::ptrdiff_t d = -first; d <= last; ++d) {
      const Sample& other = own[d * static_cast<std::ptrdiff_t>(step)];
      if (!other.lit || !alike(*own, other, near)) continue;
      const float weight = static_cast<std::size_t>(std::abs(d)) == reach ? 0.5F : 1.0F;
      sum += weight * other.light;
      weights += weight;
    }
    return sum / weights;
  }

  /// For each sample of a grid the mean over a square of a pattern's size around it, as that of the means of its rows:
  /// on one surface they are the same, and they are the fewer sums. Bands of rows, so that what a band needs stays near
  /// the processor. `sample(x, y)` makes a Sample, `keep(x, y, light)` takes the mean.
  template <class Make, class Keep>
  void smooth(std::size_t width, std::size_t height, std::size_t pattern, double near, Make sample, Keep keep) const {
    constexpr std::size_t band = 32;
    const std::size_t reach = pattern / 2;
    base::parallel_for((height + band - 1) / band, [&](std::size_t b) {
      const std::size_t from = b * band, to = std::min(from + band, height), low = from > reach ? from - reach : 0,
                        high = std::min(to + reach, height);
      std::vector<Sample> rows;
      rows.reserve((high - low) * width);
      for (std::size_t y = low; y < high; ++y)
        for (std::size_t x = 0; x < width; ++x) rows.push_back(sample(x, y));
      std::vector<float> line(width);
      for (std::size_t y = low; y < high; ++y) {
        Sample* const row = &rows[(y - low) * width];
        for (std::size_t x = 0; x < width; ++x)
          line[x] = row[x].lit ? mean_along(row + x, x, width - 1 - x, 1, reach, near) : row[x].light;
        for (std::size_t x = 0; x < width; ++x) row[x].light = line[x];
      }
      for (std::size_t y = from; y < to; ++y)
        for (std::size_t x = 0; x < width; ++x) {
          const Sample& own = rows[(y - low) * width + x];
          keep(x, y, own.lit ? mean_along(&own, y - low, high - 1 - y, width, reach, near) : own.light);
        }
    });
  }

  // ---- the sun: a ray from every pixel

  void light_of_sun(std::size_t y, Rays& rays) {
    std::vector<std::size_t> asking;
    for (std::size_t x = 0; x < canvas_.width; ++x) {
      if (!at(x, y).lit()) continue;
      const Surface surface = surface_of(middle(x, y), at(x, y));
      if (dot(surface.normal, lamp_.direction) <= 0) {
        at(x, y).sun = 0;
        continue;
      }
      const auto& [right, up] = disc_[place_in_pattern(x, y, sun_pattern)];
      asking.push_back(x);
      rays.add(
          {surface.point + lift_ * surface.normal, lamp_.direction + right * across_sun_[0] + up * across_sun_[1]});
    }
    const auto blocked = rays.blocked(scene_);
    for (std::size_t k = 0; k < asking.size(); ++k) at(asking[k], y).sun = blocked[k] != 0 ? 0.0F : 1.0F;
  }
  void smooth_sun() {
    std::vector<float> sun(found_.size());
    smooth(
        canvas_.width, canvas_.height, sun_pattern, 3 * camera_.pixel,
        [&](std::size_t x, std::size_t y) {
          Sample sample;
          if (const Found& found = at(x, y); found.lit()) {
            static_cast<Surface&>(sample) = surface_of(middle(x, y), found);
            sample.lit = true;
            sample.light = found.sun;
          }
          return sample;
        },
        [&](std::size_t x, std::size_t y, float light) { sun[y * canvas_.width + x] = light; });
    for (std::size_t i = 0; i < found_.size(); ++i) found_[i].sun = sun[i];
  }

  // ---- the sky: a ray from one pixel of every square of two by two

  struct Square {
    std::size_t x = 0, y = 0;  ///< the pixel that asks: the first that is lit
    bool lit = false;
  };
  [[nodiscard]] auto asking_of(std::size_t i, std::size_t j) const -> Square {
    for (std::size_t y = sky_step * j; y < std::min(sky_step * (j + 1), canvas_.height); ++y)
      for (std::size_t x = sky_step * i; x < std::min(sky_step * (i + 1), canvas_.width); ++x)
        if (at(x, y).lit()) return {x, y, true};
    return {};
  }

  [[nodiscard]] auto to_sky(const Surface& surface, std::size_t place) const -> rays::Ray {
    const auto [a, b] = frame_about(surface.normal);
    const Point3& d = sky_[place];
    return {surface.point + lift_ * surface.normal, d.x * a + d.y * b + d.z * surface.normal};
  }
  /// Light that bounces between walls is not followed: what is far away counts as half open instead.
  [[nodiscard]] auto openness(const std::optional<rays::Hit>& hit) const -> float {
    return hit ? static_cast<float>(std::min(hit->distance / reach_, 1.0)) : 1.0F;
  }

  void light_of_sky() {
    const std::size_t columns = (canvas_.width + sky_step - 1) / sky_step,
                      lines = (canvas_.height + sky_step - 1) / sky_step;
    std::vector<float> asked(columns * lines, 1.0F), sky(columns * lines, 1.0F);
    base::parallel_for(lines, [&](std::size_t j) {
      for (std::size_t i = 0; i < columns; ++i)
        if (const Square square = asking_of(i, j); square.lit) {
          const Surface surface = surface_of(middle(square.x, square.y), at(square.x, square.y));
          const rays::Ray ray = to_sky(surface, place_in_pattern(i, j, sky_pattern));
          asked[j * columns + i] = openness(scene_.cast(ray.origin, ray.direction));
        }
    });
    const double near = 3 * sky_step * camera_.pixel;
    const auto sample = [&](std::size_t i, std::size_t j) {
      Sample one;
      if (const Square square = asking_of(i, j); square.lit) {
        static_cast<Surface&>(one) = surface_of(middle(square.x, square.y), at(square.x, square.y));
        one.lit = true;
        one.light = asked[j * columns + i];
      }
      return one;
    };
    smooth(columns, lines, sky_pattern, near, sample,
           [&](std::size_t i, std::size_t j, float light) { sky[j * columns + i] = light; });
    base::parallel_for(lines, [&](std::size_t j) { spread_sky(j, columns, lines, near, sky); });
  }

  /// What the pixels of a line of squares see of the sky: that of the squares nearest to them, in their own surface.
  void spread_sky(std::size_t line, std::size_t columns, std::size_t lines, double near,
                  const std::vector<float>& sky) {
    std::array<std::vector<Sample>, 3> around;  // the lines above, of, and below
    for (std::size_t k = 0; k < 3; ++k) {
      if (line + k < 1 || line + k > lines) continue;
      const std::size_t j = line + k - 1;
      around[k].resize(columns);
      for (std::size_t i = 0; i < columns; ++i)
        if (const Square square = asking_of(i, j); square.lit) {
          static_cast<Surface&>(around[k][i]) = surface_of(middle(square.x, square.y), at(square.x, square.y));
          around[k][i].lit = true;
          around[k][i].light = sky[j * columns + i];
        }
    }
    for (std::size_t y = sky_step * line; y < std::min(sky_step * (line + 1), canvas_.height); ++y)
      for (std::size_t x = 0; x < canvas_.width; ++x) {
        Found& found = at(x, y);
        if (!found.lit()) continue;
        const Surface own = surface_of(middle(x, y), found);
        const std::size_t i = x / sky_step;
        const std::size_t beside = x % sky_step == 0 ? i - 1 : i + 1;  // may be none: wraps to a large number
        const std::size_t above = y % sky_step == 0 ? 0 : 2;           // or below
        float sum = 0, weights = 0;
        for (const auto& [k, column, weight] :
             {std::tuple{std::size_t{1}, i, 9.0F}, {1, beside, 3.0F}, {above, i, 3.0F}, {above, beside, 1.0F}}) {
          if (column >= around[k].size() || !around[k][column].lit || !alike(own, around[k][column], near)) continue;
          sum += weight * around[k][column].light;
          weights += weight;
        }
        found.sky = weights > 0 ? sum / weights : sky_alone(own);
      }
  }
  [[nodiscard]] auto sky_alone(const Surface& surface) const -> float {
    float open = 0;
    for (std::size_t k = 0; k < lone_rays; ++k) {
      const rays::Ray ray = to_sky(surface, k * (sky_pattern * sky_pattern / lone_rays));
      open += openness(scene_.cast(ray.origin, ray.direction));
    }
    return open / lone_rays;
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
  [[nodiscard]] auto differ(const Found& own, const Surface& here, const Found& other, const Surface& there) const
      -> bool {
    if (other.triangle == own.triangle) return false;
    if (other.triangle == nothing || own.triangle == nothing) return true;
    if (model_.albedo[other.triangle] != model_.albedo[own.triangle]) return true;
    if (dot(there.normal, here.normal) < 0.97) return true;
    return std::abs(dot(here.normal, there.point - here.point)) > 4 * camera_.pixel;
  }
  /// Between which pixels there is an edge: each pixel and those to the right and below.
  void find_edges() {
    edges_.assign(found_.size(), 0);
    base::parallel_for(canvas_.height, [&](std::size_t y) {
      const auto surface = [&](std::size_t x, std::size_t j) {
        return at(x, j).lit() ? surface_of(middle(x, j), at(x, j)) : Surface{};
      };
      Surface here = surface(0, y);
      for (std::size_t x = 0; x < canvas_.width; ++x) {
        Surface next;
        char& edge = edges_[y * canvas_.width + x];
        if (x + 1 < canvas_.width) {
          next = surface(x + 1, y);
          if (differ(at(x, y), here, at(x + 1, y), next)) edge |= edge_right;
        }
        if (y + 1 < canvas_.height && differ(at(x, y), here, at(x, y + 1), surface(x, y + 1))) edge |= edge_below;
        here = next;
      }
    });
  }
  [[nodiscard]] auto on_edge(std::size_t x, std::size_t y) const -> bool {
    const std::size_t i = y * canvas_.width + x;
    return edges_[i] != 0 || (x > 0 && (edges_[i - 1] & edge_right) != 0) ||
           (y > 0 && (edges_[i - canvas_.width] & edge_below) != 0);
  }

  /// The mean of a 2 × 2 grid of rays; their light is that of the pixel around that found the most similar surface.
  void supersample(std::size_t y, std::span<const std::size_t> edges, Rays& rays) {
    constexpr std::size_t grid = 2;
    const auto spot_of = [&](std::size_t x, std::size_t k) {
      return Spot{static_cast<double>(x) + (static_cast<double>(k % grid) + 0.5) / grid,
                  static_cast<double>(y) + (static_cast<double>(k / grid) + 0.5) / grid};
    };
    for (const std::size_t x : edges)
      for (std::size_t k = 0; k < grid * grid; ++k) rays.add(towards(spot_of(x, k)));
    const auto hits = rays.hits(scene_);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      Light sum{};
      for (std::size_t k = 0; k < grid * grid; ++k) {
        const Spot spot = spot_of(edges[e], k);
        Found found = found_by(spot, hits[e * grid * grid + k]);
        if (found.lit()) take_light(found, surface_of(spot, found), edges[e], y);
        sum = sum + colour_of(found, spot);
      }
      canvas_.light[y * canvas_.width + edges[e]] = (1.0F / (grid * grid)) * sum;
    }
  }

  void take_light(Found& found, const Surface& surface, std::size_t x, std::size_t y) const {
    // How unlike a pixel's own surface may be that is taken without a look at those around: half a pixel, or 18°.
    constexpr double like_enough = 0.5;
    double best = std::numeric_limits<double>::infinity();
    const auto take = [&](const Found& other, Spot spot) {
      if (!other.lit()) return;
      const Surface there = surface_of(spot, other);
      const double unlike = (1 - dot(surface.normal, there.normal)) * 10 +
                            std::abs(dot(surface.normal, there.point - surface.point)) / camera_.pixel;
      if (unlike >= best) return;
      best = unlike;
      found.sky = other.sky;
      found.sun = other.sun;
    };
    take(at(x, y), middle(x, y));
    if (best <= like_enough) return;
    for (std::size_t j = y >= 1 ? y - 1 : 0; j < std::min(y + 2, canvas_.height); ++j)
      for (std::size_t i = x >= 1 ? x - 1 : 0; i < std::min(x + 2, canvas_.width); ++i) take(at(i, j), middle(i, j));
  }

  Canvas& canvas_;
  const Model& model_;
  const rays::Scene& scene_;
  const Camera& camera_;
  Lamp lamp_;
  std::vector<Found> found_;
  static constexpr char edge_right = 1, edge_below = 2;
  std::vector<char> edges_;
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

void render(Canvas& canvas, const Model& model, const rays::Scene& scene, std::span<const Point3> points,
            const Camera& camera, const base::Run& run) {
  Renderer renderer(canvas, model, scene, points, camera);
  renderer.look();
  run.report("picture", "", 0.2);
  if (run.cancelled()) return;
  renderer.light();
  run.report("picture", "", 0.7);
  if (run.cancelled()) return;
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
