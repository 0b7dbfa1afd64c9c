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
constexpr std::size_t lone_rays = 16;  ///< to the sky, from a pixel with nothing of its surface around that asked

// Where a scene is in pieces, every ray goes through one after the other: it ends at the nearest of what it meets, and
// is blocked where one of them blocks it. That is what it does in the scene as a whole. So there are three rounds
// through the pieces: for what the pixels see, for the light there and for the lines, and for the edges.

/// A number from 0 to 1 in two bytes.
class Share {
 public:
  Share() = default;  ///< 1
  Share(float value) : steps_(static_cast<std::uint16_t>(std::lround(most * std::clamp(value, 0.0F, 1.0F)))) {}
  operator float() const { return static_cast<float>(steps_) / most; }

 private:
  static constexpr float most = 65535;
  std::uint16_t steps_ = 65535;
};

/// What one ray found, and how much light it gets there. As little as there can be: a picture has millions.
struct Found {
  float depth = std::numeric_limits<float>::infinity();  ///< along the ray, m; infinite where nothing is to be lit
  std::array<std::int16_t, 3> normal{0, 0, unit};        ///< to the camera
  Piece::Look look;
  bool surface = false;  ///< no paper
  Share sky, sun;        ///< the parts of sky and sun that it sees
  [[nodiscard]] auto lit() const -> bool { return depth < std::numeric_limits<float>::infinity(); }
  static constexpr std::int16_t unit = 32767;
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

/// The pixels from `left` and `top` to before `right` and `bottom`.
struct Window {
  std::size_t left = 0, top = 0, right = 0, bottom = 0;
};

/// Lines, and what of them is hidden: each is sampled every half pixel.
class SeenLines {
 public:
  SeenLines(const Lines& lines, const Camera& camera) : lines_(lines) {
    first_.reserve(lines.segments.size() + 1);
    first_.push_back(0);
    for (const auto& segment : lines.segments) first_.push_back(first_.back() + Strip(segment, camera).steps);
    hidden_.assign(first_.back(), 0);
  }

  /// Notes what a piece hides, which shows in no pixel outside of the window; of the only piece no more than it takes.
  void hide(const rays::Scene& scene, const Window& window, const Camera& camera, bool only) {
    base::parallel_for(lines_.segments.size(), [&](std::size_t s) {
      const auto& [start, end] = lines_.segments[s];
      const Strip strip(lines_.segments[s], camera);
      const auto within = [&](double v, std::size_t low, std::size_t high) {
        return v >= static_cast<double>(low) - 1 && v <= static_cast<double>(high) + 1;
      };
      for (std::size_t i = 0; i < strip.steps; ++i) {
        char& hidden = hidden_[first_[s] + i];
        if (hidden == all_hidden) continue;
        const double middle = strip.middle(i);
        const Spot spot = strip.at(middle);
        if (!within(spot.x, window.left, window.right) || !within(spot.y, window.top, window.bottom)) continue;
        const double depth = camera.depth((1 - middle) * start + middle * end);
        const auto closed = [&](Spot place) {
          const auto hit = scene.cast(camera.start(place), -1.0 * camera.towards);
          return hit && hit->distance < depth - lift - tolerance;
        };
        // A line along the foot of a wall, seen from above, coincides with the edge of the roof: whether the surface
        // there hides it would be chance. It shows when a place just beside it does.
        const std::array places{spot, Spot{spot.x + strip.aside.x, spot.y + strip.aside.y},
                                Spot{spot.x - strip.aside.x, spot.y - strip.aside.y}};
        for (unsigned k = 0; k < places.size(); ++k) {
          if ((hidden >> k & 1) == 0 && closed(places[k])) hidden = static_cast<char>(hidden | 1 << k);
          if (only && (hidden >> k & 1) == 0) break;  // it is seen
        }
      }
    });
  }

  void draw(Image& image, const Camera& camera) const {
    Ink ink(image.width, image.height);
    for (std::size_t s = 0; s < lines_.segments.size(); ++s) {
      const Strip strip(lines_.segments[s], camera);
      double since = 0;  // where the visible piece began
      bool before_seen = false;
      for (std::size_t i = 0; i < strip.steps; ++i) {
        const double before = static_cast<double>(i) / static_cast<double>(strip.steps);
        const bool seen = hidden_[first_[s] + i] != all_hidden;
        if (seen && !before_seen) since = before;
        if (!seen && before_seen) ink.stroke(strip.at(since), strip.at(before), lines_.width);
        before_seen = seen;
      }
      if (before_seen) ink.stroke(strip.at(since), strip.b, lines_.width);
    }
    ink.spread_on(image, lines_.colour);
  }

 private:
  static constexpr double lift = 0.05, tolerance = 0.10;  // m
  static constexpr char all_hidden = 7;                   ///< the place itself, and those to both sides

  /// A segment in the picture.
  struct Strip {
    Strip(const std::array<Point3, 2>& segment, const Camera& camera)
        : a(camera.spot(segment[0])), b(camera.spot(segment[1])) {
      const double across = std::hypot(b.x - a.x, b.y - a.y);
      steps = std::max<std::size_t>(1, static_cast<std::size_t>(2 * across));
      if (across > 0) aside = {-0.75 * (b.y - a.y) / across, 0.75 * (b.x - a.x) / across};
    }
    [[nodiscard]] auto middle(std::size_t step) const -> double {
      return (static_cast<double>(step) + 0.5) / static_cast<double>(steps);
    }
    [[nodiscard]] auto at(double t) const -> Spot { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }
    Spot a, b, aside{};
    std::size_t steps = 1;
  };

  const Lines& lines_;
  std::vector<std::size_t> first_;  ///< of the samples, by segment
  std::vector<char> hidden_;        ///< a bit for each place of a sample that something hides
};

/// Whether a ray may meet a piece.
class Reach {
 public:
  /// A piece that every ray is for: the only one.
  Reach() = default;
  explicit Reach(const geometry::Box3& box) : box_(box), all_(false) {
    constexpr double rounding = 0.01;  // m; more than what single precision makes of a place in a city
    box_.add(box.least - Point3{rounding, rounding, rounding});
    box_.add(box.most + Point3{rounding, rounding, rounding});
  }
  /// Within so many lengths of its direction.
  [[nodiscard]] auto operator()(const rays::Ray& ray, double most = std::numeric_limits<double>::infinity()) const
      -> bool {
    if (all_) return true;
    double from = 0, to = most;
    const auto cut = [&](double origin, double direction, double low, double high) {
      if (direction == 0) return origin >= low && origin <= high;
      const double a = (low - origin) / direction, b = (high - origin) / direction;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
      return from <= to;
    };
    return cut(ray.origin.x, ray.direction.x, box_.least.x, box_.most.x) &&
           cut(ray.origin.y, ray.direction.y, box_.least.y, box_.most.y) &&
           cut(ray.origin.z, ray.direction.z, box_.least.z, box_.most.z);
  }

 private:
  geometry::Box3 box_;
  bool all_ = true;
};

class Renderer {
 public:
  Renderer(Image& image, const Scenery& scenery, std::span<const Lines> lines, const Camera& camera,
           const base::Run& run)
      : image_(image),
        scenery_(scenery),
        camera_(camera),
        run_(run),
        lamp_(lamp_for(camera)),
        found_(image.width * image.height),
        sky_(sky_directions()),
        disc_(sun_disc()),
        across_sun_(frame_about(lamp_.direction)) {
    const double size = length(scenery.box().most - scenery.box().least);
    paper_height_ = scenery.low() - 1e-3;
    reach_ = 0.2 * size;
    lift_ = 1e-3 + 2e-5 * size;
    for (const Lines& layer : lines) lines_.emplace_back(layer, camera);
  }

  [[nodiscard]] auto look() -> base::Result<void> {
    auto seen = each_piece([&](const Piece& piece, std::size_t i) {
      const Window window = window_of(i);
      rows(window.top, window.bottom, [&](std::size_t y, Rays& rays) {
        for (std::size_t x = window.left; x < window.right; ++x) rays.add(towards(middle(x, y)));
        const auto hits = rays.hits(piece.scene());
        for (std::size_t x = window.left; x < window.right; ++x)
          take_nearer(at(x, y), middle(x, y), hits[x - window.left], piece);
      });
    });
    if (seen)
      rows(0, image_.height, [&](std::size_t y, Rays&) {
        for (std::size_t x = 0; x < image_.width; ++x) put_on_paper(at(x, y), middle(x, y));
      });
    return seen;
  }
  [[nodiscard]] auto light() -> base::Result<void> {
    rows(0, image_.height, [&](std::size_t y, Rays&) {
      for (std::size_t x = 0; x < image_.width; ++x)
        if (Found& found = at(x, y); found.lit() && dot(normal_of(found), lamp_.direction) <= 0) found.sun = 0;
    });
    columns_ = (image_.width + sky_step - 1) / sky_step;
    lines_of_sky_ = (image_.height + sky_step - 1) / sky_step;
    asked_.assign(columns_ * lines_of_sky_, 1.0F);
    if (scenery_.size() > 1) find_lone();
    auto lit = each_piece([&](const Piece& piece, std::size_t i) {
      const Reach reach = scenery_.size() == 1 ? Reach() : Reach(scenery_.box(i));
      rows(0, image_.height, [&](std::size_t y, Rays& rays) { light_of_sun(piece.scene(), reach, y, rays); });
      base::parallel_for(lines_of_sky_, [&](std::size_t j) { light_of_sky(piece.scene(), reach, j); });
      base::parallel_for(lone_.size(), [&](std::size_t k) { light_of_lone(piece.scene(), reach, lone_[k]); });
      for (auto& layer : lines_) layer.hide(piece.scene(), window_of(i), camera_, scenery_.size() == 1);
    });
    if (!lit) return lit;
    smooth_sun();
    return smooth_sky();
  }
  [[nodiscard]] auto paint() -> base::Result<void> {
    find_edges();
    rows(0, image_.height, [&](std::size_t y, Rays&) {
      for (std::size_t x = 0; x < image_.width; ++x)
        if (!on_edge(x, y)) set_colour(image_, y * image_.width + x, to_colour(colour_of(at(x, y))));
    });
    for (std::size_t from = 0, to = 0; from < image_.height && !run_.cancelled(); from = to) {
      to = end_of_band(from);
      if (auto smoothed = supersample(from, to); !smoothed) return smoothed;
    }
    return {};
  }
  /// After all else.
  void draw_lines() {
    found_ = std::vector<Found>();  // not `= {}`, which leaves the memory
    for (const auto& layer : lines_) layer.draw(image_, camera_);
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
  void rows(std::size_t from, std::size_t to, Work work) const {
    base::parallel_for(to > from ? to - from : 0, [&](std::size_t k) {
      Rays rays;
      work(from + k, rays);
    });
  }

  /// work(piece, its number), in order; those after a cancellation are left out.
  template <class Work>
  [[nodiscard]] auto each_piece(Work work) const -> base::Result<void> {
    return each_piece(work, [](std::size_t) { return true; });
  }
  /// Only of those that are wanted.
  template <class Work, class Wanted>
  [[nodiscard]] auto each_piece(Work work, Wanted wanted) const -> base::Result<void> {
    for (std::size_t i = 0; i < scenery_.size(); ++i) {
      if (run_.cancelled()) return {};
      if (!wanted(i)) continue;
      const auto piece = scenery_.piece(i);
      if (!piece) return piece.failure();
      work(**piece, i);
    }
    return {};
  }

  /// The pixels in which a piece may be seen.
  [[nodiscard]] auto window_of(std::size_t piece) const -> Window {
    if (scenery_.size() == 1) return {0, 0, image_.width, image_.height};
    const auto& box = scenery_.box(piece);
    if (box.empty()) return {};
    geometry::Box2 seen;
    for (const double x : {box.least.x, box.most.x})
      for (const double y : {box.least.y, box.most.y})
        for (const double z : {box.least.z, box.most.z}) {
          const Spot spot = camera_.spot({x, y, z});
          seen.add({spot.x, spot.y});
        }
    const auto within = [](double v, std::size_t most) {
      return static_cast<std::size_t>(std::clamp(v, 0.0, static_cast<double>(most)));
    };
    return {within(seen.least.x - 1, image_.width), within(seen.least.y - 1, image_.height),
            within(seen.most.x + 2, image_.width), within(seen.most.y + 2, image_.height)};
  }

  auto at(std::size_t x, std::size_t y) -> Found& { return found_[y * image_.width + x]; }
  [[nodiscard]] auto at(std::size_t x, std::size_t y) const -> const Found& { return found_[y * image_.width + x]; }

  static auto middle(std::size_t x, std::size_t y) -> Spot {
    return {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
  }

  [[nodiscard]] auto towards(Spot spot) const -> rays::Ray { return {camera_.start(spot), -1.0 * camera_.towards}; }
  /// What a ray met in a piece, where that is nearer than what it met before.
  void take_nearer(Found& found, Spot spot, const std::optional<rays::Hit>& hit, const Piece& piece) const {
    if (!hit || !(static_cast<float>(hit->distance) < found.depth)) return;
    found.surface = true;
    found.depth = static_cast<float>(hit->distance);
    Point3 normal = piece.normal(hit->triangle);
    if (length(normal) < 0.5) normal = camera_.towards;  // a triangle without area
    else if (dot(normal, camera_.towards) < 0) normal = -1.0 * normal;
    const auto in_steps = [](double of_unit) { return static_cast<std::int16_t>(std::lround(Found::unit * of_unit)); };
    found.normal = {in_steps(normal.x), in_steps(normal.y), in_steps(normal.z)};
    found.look = piece.look(hit->triangle, point_of(spot, found));
  }
  /// After the last piece: what met nothing meets the paper.
  void put_on_paper(Found& found, Spot spot) const {
    if (!found.surface && camera_.towards.z > 0.05)
      found.depth = static_cast<float>((camera_.start(spot).z - paper_height_) / camera_.towards.z);
  }

  static auto normal_of(const Found& found) -> Point3 {
    constexpr double step = 1.0 / Found::unit;
    return {step * found.normal[0], step * found.normal[1], step * found.normal[2]};
  }
  [[nodiscard]] auto point_of(Spot spot, const Found& found) const -> Point3 {
    return camera_.start(spot) - static_cast<double>(found.depth) * camera_.towards;
  }
  /// Of what is lit.
  [[nodiscard]] auto surface_of(Spot spot, const Found& found) const -> Surface {
    return {point_of(spot, found), normal_of(found)};
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

  void light_of_sun(const rays::Scene& scene, const Reach& reach, std::size_t y, Rays& rays) {
    std::vector<std::size_t> asking;
    for (std::size_t x = 0; x < image_.width; ++x) {
      if (!at(x, y).lit() || at(x, y).sun == 0) continue;
      const Surface surface = surface_of(middle(x, y), at(x, y));
      const auto& [right, up] = disc_[place_in_pattern(x, y, sun_pattern)];
      const rays::Ray ray{surface.point + lift_ * surface.normal,
                          lamp_.direction + right * across_sun_[0] + up * across_sun_[1]};
      if (!reach(ray)) continue;
      asking.push_back(x);
      rays.add(ray);
    }
    const auto blocked = rays.blocked(scene);
    for (std::size_t k = 0; k < asking.size(); ++k)
      if (blocked[k] != 0) at(asking[k], y).sun = 0;
  }
  void smooth_sun() {
    std::vector<Share> sun(found_.size(), 0.0F);
    smooth(
        image_.width, image_.height, sun_pattern, 3 * camera_.pixel,
        [&](std::size_t x, std::size_t y) {
          Sample sample;
          if (const Found& found = at(x, y); found.lit()) {
            static_cast<Surface&>(sample) = surface_of(middle(x, y), found);
            sample.lit = true;
            sample.light = found.sun;
          }
          return sample;
        },
        [&](std::size_t x, std::size_t y, float light) { sun[y * image_.width + x] = light; });
    for (std::size_t i = 0; i < found_.size(); ++i) found_[i].sun = sun[i];
  }

  // ---- the sky: a ray from one pixel of every square of two by two

  struct Square {
    std::size_t x = 0, y = 0;  ///< the pixel that asks: the first that is lit
    bool lit = false;
  };
  [[nodiscard]] auto asking_of(std::size_t i, std::size_t j) const -> Square {
    for (std::size_t y = sky_step * j; y < std::min(sky_step * (j + 1), image_.height); ++y)
      for (std::size_t x = sky_step * i; x < std::min(sky_step * (i + 1), image_.width); ++x)
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

  /// How open the sky is in one direction, as far as a piece shows: the least of all pieces is that of the scene.
  [[nodiscard]] auto open_beside(const rays::Scene& scene, const Reach& reach, const Surface& surface,
                                 std::size_t place) const -> float {
    const rays::Ray ray = to_sky(surface, place);
    return reach(ray, reach_) ? openness(scene.cast(ray.origin, ray.direction)) : 1.0F;
  }

  void light_of_sky(const rays::Scene& scene, const Reach& reach, std::size_t j) {
    for (std::size_t i = 0; i < columns_; ++i)
      if (const Square square = asking_of(i, j); square.lit) {
        const Surface surface = surface_of(middle(square.x, square.y), at(square.x, square.y));
        float& asked = asked_[j * columns_ + i];
        asked = std::min(asked, open_beside(scene, reach, surface, place_in_pattern(i, j, sky_pattern)));
      }
  }

  [[nodiscard]] auto smooth_sky() -> base::Result<void> {
    std::vector<float> sky(asked_.size(), 1.0F);
    const auto sample = [&](std::size_t i, std::size_t j) {
      Sample one;
      if (const Square square = asking_of(i, j); square.lit) {
        static_cast<Surface&>(one) = surface_of(middle(square.x, square.y), at(square.x, square.y));
        one.lit = true;
        one.light = asked_[j * columns_ + i];
      }
      return one;
    };
    smooth(columns_, lines_of_sky_, sky_pattern, near_sky(), sample,
           [&](std::size_t i, std::size_t j, float light) { sky[j * columns_ + i] = light; });
    asked_ = std::move(sky);
    std::shared_ptr<const Piece> only;
    if (scenery_.size() == 1 && !run_.cancelled()) {
      auto piece = scenery_.piece(0);
      if (!piece) return piece.failure();
      only = std::move(*piece);
    }
    base::parallel_for(lines_of_sky_, [&](std::size_t j) {
      spread_sky(j, [&](Found& found, const Surface& own, float sum, float weights, std::size_t) {
        if (weights > 0) found.sky = sum / weights;
        else if (only) found.sky = sky_alone(only->scene(), own);
      });
    });
    for (const auto& [at, open] : lone_) {
      float sum = 0;
      for (const float one : open) sum += one;
      found_[at].sky = sum / lone_rays;
    }
    lone_ = std::vector<Lone>();
    return {};
  }
  [[nodiscard]] auto near_sky() const -> double { return 3 * sky_step * camera_.pixel; }

  /// A pixel with nothing of its surface around that asked, and what its own rays see.
  struct Lone {
    std::size_t at = 0;
    std::array<Share, lone_rays> open{};
  };
  void find_lone() {
    std::vector<std::vector<std::size_t>> found(lines_of_sky_);
    base::parallel_for(lines_of_sky_, [&](std::size_t j) {
      spread_sky(j, [&](const Found&, const Surface&, float, float weights, std::size_t at) {
        if (!(weights > 0)) found[j].push_back(at);
      });
    });
    for (const auto& line : found)
      for (const std::size_t at : line) lone_.push_back({at, {}});
  }
  void light_of_lone(const rays::Scene& scene, const Reach& reach, Lone& lone) const {
    const std::size_t x = lone.at % image_.width, y = lone.at / image_.width;
    const Surface surface = surface_of(middle(x, y), at(x, y));
    for (std::size_t k = 0; k < lone_rays; ++k)
      lone.open[k] = std::min<float>(lone.open[k], open_beside(scene, reach, surface, lone_place(k)));
  }
  static auto lone_place(std::size_t ray) -> std::size_t { return ray * (sky_pattern * sky_pattern / lone_rays); }

  /// What the pixels of a line of squares see of the sky: that of the squares nearest to them, in their own surface.
  /// take(pixel, its surface, sum of what they see, sum of their weights, number of the pixel).
  template <class Take>
  void spread_sky(std::size_t line, Take take) {
    const std::size_t columns = columns_, lines = lines_of_sky_;
    const double near = near_sky();
    std::array<std::vector<Sample>, 3> around;  // the lines above, of, and below
    for (std::size_t k = 0; k < 3; ++k) {
      if (line + k < 1 || line + k > lines) continue;
      const std::size_t j = line + k - 1;
      around[k].resize(columns);
      for (std::size_t i = 0; i < columns; ++i)
        if (const Square square = asking_of(i, j); square.lit) {
          static_cast<Surface&>(around[k][i]) = surface_of(middle(square.x, square.y), at(square.x, square.y));
          around[k][i].lit = true;
          around[k][i].light = asked_[j * columns + i];
        }
    }
    for (std::size_t y = sky_step * line; y < std::min(sky_step * (line + 1), image_.height); ++y)
      for (std::size_t x = 0; x < image_.width; ++x) {
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
        take(found, own, sum, weights, y * image_.width + x);
      }
  }
  [[nodiscard]] auto sky_alone(const rays::Scene& scene, const Surface& surface) const -> float {
    float open = 0;
    for (std::size_t k = 0; k < lone_rays; ++k) open += open_beside(scene, Reach(), surface, lone_place(k));
    return open / lone_rays;
  }

  [[nodiscard]] auto colour_of(const Found& found) const -> Light {
    static const Light sheet = to_light(paper);
    if (!found.lit()) return sheet;
    const Point3 normal = normal_of(found);
    const auto facing = static_cast<float>(std::max(0.0, dot(normal, lamp_.direction)));
    // Walls see half the sky, and the ground, which gives back some of it.
    const auto up = static_cast<float>(0.8 + 0.2 * normal.z);
    const Light sky = (0.15F + 0.85F * found.sky) * up * lamp_.sky, sun = facing * found.sun * lamp_.sun;
    if (found.surface) {
      const Light light = sky + sun;
      return to_light(found.look.colour) * (found.look.pictured ? 0.5F * light + Light{0.5F, 0.5F, 0.5F} : light);
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
    if (!own.surface && !other.surface) return false;
    if (own.surface != other.surface) return true;
    if (other.look.pictured != own.look.pictured) return true;
    if (!own.look.pictured && other.look.colour != own.look.colour) return true;
    if (dot(there.normal, here.normal) < 0.97) return true;
    return std::abs(dot(here.normal, there.point - here.point)) > 4 * camera_.pixel;
  }
  /// Between which pixels there is an edge: each pixel and those to the right and below.
  void find_edges() {
    edges_.assign(found_.size(), 0);
    base::parallel_for(image_.height, [&](std::size_t y) {
      const auto surface = [&](std::size_t x, std::size_t j) {
        return at(x, j).lit() ? surface_of(middle(x, j), at(x, j)) : Surface{};
      };
      Surface here = surface(0, y);
      for (std::size_t x = 0; x < image_.width; ++x) {
        Surface next;
        char& edge = edges_[y * image_.width + x];
        if (x + 1 < image_.width) {
          next = surface(x + 1, y);
          if (differ(at(x, y), here, at(x + 1, y), next)) edge |= edge_right;
        }
        if (y + 1 < image_.height && differ(at(x, y), here, at(x, y + 1), surface(x, y + 1))) edge |= edge_below;
        here = next;
      }
    });
  }
  [[nodiscard]] auto on_edge(std::size_t x, std::size_t y) const -> bool {
    const std::size_t i = y * image_.width + x;
    return edges_[i] != 0 || (x > 0 && (edges_[i - 1] & edge_right) != 0) ||
           (y > 0 && (edges_[i - image_.width] & edge_below) != 0);
  }

  /// The last row of a band and one more, so that its edges are not too many for memory.
  [[nodiscard]] auto end_of_band(std::size_t from) const -> std::size_t {
    constexpr std::size_t most_edges = 200'000;
    std::size_t edges = 0, y = from;
    for (; y < image_.height && (y == from || edges + image_.width <= most_edges); ++y)
      for (std::size_t x = 0; x < image_.width; ++x) edges += on_edge(x, y) ? 1 : 0;
    return y;
  }

  /// The edges of a band: the mean of a 2 × 2 grid of rays. Their light is that of the pixel around that found the most
  /// similar surface.
  [[nodiscard]] auto supersample(std::size_t from, std::size_t to) -> base::Result<void> {
    constexpr std::size_t grid = 2, samples = grid * grid;
    const auto spot_of = [](std::size_t x, std::size_t y, std::size_t k) {
      const std::size_t column = k % grid, row = k / grid;
      return Spot{static_cast<double>(x) + (static_cast<double>(column) + 0.5) / grid,
                  static_cast<double>(y) + (static_cast<double>(row) + 0.5) / grid};
    };
    struct Row {
      std::vector<std::size_t> edges;
      std::vector<Found> found;
    };
    std::vector<Row> band(to - from);
    for (std::size_t y = from; y < to; ++y) {
      Row& row = band[y - from];
      for (std::size_t x = 0; x < image_.width; ++x)
        if (on_edge(x, y)) row.edges.push_back(x);
      row.found.resize(samples * row.edges.size());
    }
    auto cast = each_piece(
        [&](const Piece& piece, std::size_t i) {
          const Window window = window_of(i);
          rows(std::max(from, window.top), std::min(to, window.bottom), [&](std::size_t y, Rays& rays) {
            Row& row = band[y - from];
            const auto first = std::ranges::lower_bound(row.edges, window.left) - row.edges.begin(),
                       last = std::ranges::lower_bound(row.edges, window.right) - row.edges.begin();
            for (auto e = static_cast<std::size_t>(first); e < static_cast<std::size_t>(last); ++e)
              for (std::size_t k = 0; k < samples; ++k) rays.add(towards(spot_of(row.edges[e], y, k)));
            const auto hits = rays.hits(piece.scene());
            for (std::size_t n = 0; n < hits.size(); ++n) {
              const std::size_t at = samples * static_cast<std::size_t>(first) + n;
              take_nearer(row.found[at], spot_of(row.edges[at / samples], y, at % samples), hits[n], piece);
            }
          });
        },
        [&](std::size_t i) {
          const Window window = window_of(i);
          return window.top < to && window.bottom > from;
        });
    if (!cast) return cast;
    rows(from, to, [&](std::size_t y, Rays&) {
      Row& row = band[y - from];
      for (std::size_t e = 0; e < row.edges.size(); ++e) {
        Light sum{};
        for (std::size_t k = 0; k < samples; ++k) {
          const Spot spot = spot_of(row.edges[e], y, k);
          Found& found = row.found[samples * e + k];
          put_on_paper(found, spot);
          if (found.lit()) take_light(found, surface_of(spot, found), row.edges[e], y);
          sum = sum + colour_of(found);
        }
        set_colour(image_, y * image_.width + row.edges[e], to_colour((1.0F / samples) * sum));
      }
    });
    return {};
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
    for (std::size_t j = y >= 1 ? y - 1 : 0; j < std::min(y + 2, image_.height); ++j)
      for (std::size_t i = x >= 1 ? x - 1 : 0; i < std::min(x + 2, image_.width); ++i) take(at(i, j), middle(i, j));
  }

  Image& image_;
  const Scenery& scenery_;
  const Camera& camera_;
  const base::Run& run_;
  std::vector<SeenLines> lines_;
  Lamp lamp_;
  std::vector<Found> found_;
  static constexpr char edge_right = 1, edge_below = 2;
  std::vector<char> edges_;
  SkyDirections sky_;
  SunDisc disc_;
  std::array<Point3, 2> across_sun_;
  double paper_height_ = 0, reach_ = 1, lift_ = 0;
  std::size_t columns_ = 0, lines_of_sky_ = 0;  ///< squares of the sky
  std::vector<float> asked_;                    ///< of each what it sees
  std::vector<Lone> lone_;
};

}  // namespace

auto render(Image& image, const Scenery& scenery, std::span<const Lines> lines, const Camera& camera,
            const base::Run& run) -> base::Result<void> {
  Renderer renderer(image, scenery, lines, camera, run);
  if (!scenery.box().empty()) {
    if (auto looked = renderer.look(); !looked) return looked;
    run.report("picture", "", 0.2);
    if (run.cancelled()) return {};
    if (auto lit = renderer.light(); !lit) return lit;
    run.report("picture", "", 0.7);
    if (run.cancelled()) return {};
    if (auto painted = renderer.paint(); !painted) return painted;
  }
  renderer.draw_lines();
  return {};
}

}  // namespace mansard::picture::detail
