// Each triangle is drawn into the plane of the face, with the distance along the normal in place of a depth: the same
// as a ray from every sample, at the cost of what is drawn. All decisions are in doubles relative to the building, in
// an order that depends on the triangles alone; colours are summed as integers. So results are the same everywhere.
#include "mansard/texture/detail/project.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::texture::detail {
namespace {

constexpr std::uint32_t nothing = ~0U;
/// Samples that are in memory at a time, 12 bytes each.
constexpr std::size_t most_samples = std::size_t{1} << 21U;

/// A triangle in the plane: u and v in samples, d in metres in front of the face.
struct Flat {
  std::array<Point2, 3> at;
  std::array<double, 3> ahead;
  /// d = gradient · (u, v) + d0
  Point2 gradient;
  double d0 = 0;
  double twice_area = 0;
  const ScanTriangle* source = nullptr;
};

struct Band {
  std::size_t width = 0, first = 0, rows = 0;  ///< samples; rows from the bottom
  std::vector<double> ahead;
  std::vector<std::uint32_t> shown;  ///< number of the triangle
};

auto flat_of(const NearTriangle& triangle, const FaceGrid& grid, double samples) -> Flat {
  Flat out;
  out.source = triangle.source;
  const double scale = samples / grid.texel;
  for (std::size_t c = 0; c < 3; ++c) {
    const Point3 p = triangle.corners[c] - grid.start;
    out.at[c] = {scale * dot(grid.right, p), scale * dot(grid.up, p)};
    out.ahead[c] = dot(grid.normal, p);
  }
  const Point2 ab = out.at[1] - out.at[0], ac = out.at[2] - out.at[0];
  out.twice_area = cross(ab, ac);
  if (!(out.twice_area > 0)) return out;
  const double db = out.ahead[1] - out.ahead[0], dc = out.ahead[2] - out.ahead[0];
  out.gradient = {(db * ac.y - dc * ab.y) / out.twice_area, (dc * ab.x - db * ac.x) / out.twice_area};
  out.d0 = out.ahead[0] - dot(out.gradient, out.at[0]);
  return out;
}

void draw(const Flat& t, std::uint32_t number, const Options& options, Band& band) {
  const auto [low, high] = std::minmax({t.at[0].y, t.at[1].y, t.at[2].y});
  const auto from = static_cast<double>(band.first), to = static_cast<double>(band.first + band.rows);
  // Samples are at halves.
  const double first = std::max(std::ceil(low - 0.5), from), last = std::min(std::floor(high - 0.5), to - 1);
  for (double row = first; row <= last; ++row) {
    const double v = row + 0.5;
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 a = t.at[i], b = t.at[(i + 1) % 3];
      if (std::min(a.y, b.y) > v || std::max(a.y, b.y) < v) continue;
      const double u = a.y == b.y ? a.x : a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x);
      left = std::min({left, u, a.y == b.y ? b.x : u});
      right = std::max({right, u, a.y == b.y ? b.x : u});
    }
    const double begin = std::max(std::ceil(left - 0.5), 0.0),
                 end = std::min(std::floor(right - 0.5), static_cast<double>(band.width) - 1);
    const std::size_t line = (static_cast<std::size_t>(row) - band.first) * band.width;
    for (double column = begin; column <= end; ++column) {
      const double ahead = t.gradient.x * (column + 0.5) + t.gradient.y * v + t.d0;
      if (ahead > options.outward || ahead < -options.inward) continue;
      const std::size_t at = line + static_cast<std::size_t>(column);
      if (std::abs(ahead) >= band.ahead[at]) continue;
      band.ahead[at] = std::abs(ahead);
      band.shown[at] = number;
    }
  }
}

auto wrapped(std::int64_t i, std::int64_t size, formats::Wrap wrap) -> std::size_t {
  if (wrap == formats::Wrap::clamp) return static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, size - 1));
  const std::int64_t period = wrap == formats::Wrap::mirror ? 2 * size : size;
  std::int64_t in = i % period;
  if (in < 0) in += period;
  return static_cast<std::size_t>(in < size ? in : period - 1 - in);
}

/// Between the four nearest pixels, with weights in 1/256.
auto sampled(const model::Pixels& pixels, const std::array<formats::Wrap, 2>& wrap, double u, double v) -> Light {
  const auto place = [](double coordinate, std::uint32_t size) {
    const double sound = std::isfinite(coordinate) ? std::clamp(coordinate, -1e6, 1e6) : 0;
    const double at = sound * size - 0.5;
    const double whole = std::floor(at);
    return std::pair(static_cast<std::int64_t>(whole), static_cast<std::uint32_t>((at - whole) * 256));
  };
  const auto [x, wx] = place(u, pixels.width);
  const auto [y, wy] = place(v, pixels.height);
  const std::array<std::size_t, 2> columns{wrapped(x, pixels.width, wrap[0]), wrapped(x + 1, pixels.width, wrap[0])};
  const std::array<std::size_t, 2> rows{wrapped(y, pixels.height, wrap[1]), wrapped(y + 1, pixels.height, wrap[1])};
  const std::array<std::uint32_t, 2> across{256 - wx, wx}, down{256 - wy, wy};
  std::array<std::uint64_t, 3> sum{};
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint8_t* pixel = &pixels.rgb[3 * (rows[j] * pixels.width + columns[i])];
      const std::uint64_t weight = std::uint64_t{across[i]} * down[j];
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * formats::linear_of(pixel[c]);
    }
  Light out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<std::uint16_t>((sum[c] + 32768) >> 16U);
  return out;
}

/// The weights of the corners at a sample.
auto weights_at(const Flat& t, Point2 p) -> std::array<double, 3> {
  std::array<double, 3> weight{};
  weight[1] = std::clamp(cross(p - t.at[0], t.at[2] - t.at[0]) / t.twice_area, 0.0, 1.0);
  weight[2] = std::clamp(cross(t.at[1] - t.at[0], p - t.at[0]) / t.twice_area, 0.0, 1.0 - weight[1]);
  weight[0] = 1 - weight[1] - weight[2];
  return weight;
}

/// The colour of a triangle; `pixels` is that of its material, if any.
auto mixed(const ScanTriangle& t, const std::array<double, 3>& weight, const model::Pixels* pixels,
           const std::array<formats::Wrap, 2>& wrap) -> Light {
  Light own{};
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += weight[c] * t.colour[c][k];
    own[k] = static_cast<std::uint16_t>(std::lround(sum));
  }
  if (pixels == nullptr) return own;
  double u = 0, v = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    u += weight[c] * static_cast<double>(t.uv[c][0]);
    v += weight[c] * static_cast<double>(t.uv[c][1]);
  }
  Light light = sampled(*pixels, wrap, u, v);
  if (own != formats::white)
    for (std::size_t k = 0; k < 3; ++k)
      light[k] = static_cast<std::uint16_t>((std::uint32_t{light[k]} * own[k] + 32767) / 65535);
  return light;
}

/// What is summed for a texel.
struct Sum {
  std::array<std::uint64_t, 3> light{};
  std::uint32_t inside = 0, shown = 0;
};

/// Sums of the texels of a band, from the bottom. Images are taken one after the other.
void sum_up(const Band& band, const std::vector<Flat>& flats, const FaceGrid& grid, const Scan& scan,
            std::size_t samples, std::vector<Sum>& sums) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> wanted;  // material, sample
  const auto texel_of = [&](std::size_t sample) {
    return (sample / band.width) / samples * grid.columns + (sample % band.width) / samples;
  };
  sums.assign(band.rows / samples * grid.columns, {});
  for (std::size_t row = 0; row < band.rows; ++row) {
    const double v = (static_cast<double>(band.first + row) + 0.5) / static_cast<double>(samples);
    const auto spans = spans_at(grid.loops, v);
    for (std::size_t s = 0; s + 1 < spans.size(); s += 2) {
      const double scale = static_cast<double>(samples);
      const double begin = std::max(std::ceil(spans[s] * scale - 0.5), 0.0),
                   end = std::min(std::floor(spans[s + 1] * scale - 0.5), static_cast<double>(band.width) - 1);
      for (double column = begin; column <= end; ++column) {
        const std::size_t sample = row * band.width + static_cast<std::size_t>(column);
        ++sums[texel_of(sample)].inside;
        if (band.shown[sample] != nothing)
          wanted.emplace_back(flats[band.shown[sample]].source->material, static_cast<std::uint32_t>(sample));
      }
    }
  }
  std::ranges::stable_sort(wanted, {}, &std::pair<std::uint32_t, std::uint32_t>::first);
  static const std::array<formats::Wrap, 2> plain{};
  for (std::size_t i = 0; i < wanted.size();) {
    const auto material = wanted[i].first;
    const auto pixels = material == no_material ? nullptr : scan.image(material);
    const auto& wrap = material == no_material ? plain : scan.wrap(material);
    for (; i < wanted.size() && wanted[i].first == material; ++i) {
      if (material != no_material && !pixels) continue;
      const std::size_t sample = wanted[i].second;
      const std::size_t column = sample % band.width, row = band.first + sample / band.width;
      const Point2 p{static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5};
      const Flat& flat = flats[band.shown[sample]];
      const Light light = mixed(*flat.source, weights_at(flat, p), pixels.get(), wrap);
      Sum& sum = sums[texel_of(sample)];
      for (std::size_t c = 0; c < 3; ++c) sum.light[c] += light[c];
      ++sum.shown;
    }
  }
}

}  // namespace

auto project(const FaceGrid& grid, std::span<const NearTriangle* const> triangles, const Scan& scan,
             const std::vector<std::optional<Light>>& of_points, const Options& options) -> FaceLight {
  FaceLight out;
  const auto samples = static_cast<std::size_t>(options.samples);
  const std::size_t texels = std::size_t{grid.columns} * grid.rows;
  out.light.resize(texels);
  out.state.assign(texels, outside);
  std::vector<Flat> flats;
  const double facing = std::cos(options.angle);
  const double width = static_cast<double>(grid.columns * samples), height = static_cast<double>(grid.rows * samples);
  for (const auto* triangle : triangles) {
    if (dot(triangle->normal, grid.normal) < facing) continue;
    Flat flat = flat_of(*triangle, grid, static_cast<double>(samples));
    if (!(flat.twice_area > 0)) continue;
    const auto [near, far] = std::minmax({flat.ahead[0], flat.ahead[1], flat.ahead[2]});
    if (near > options.outward || far < -options.inward) continue;
    const auto [left, right] = std::minmax({flat.at[0].x, flat.at[1].x, flat.at[2].x});
    const auto [low, high] = std::minmax({flat.at[0].y, flat.at[1].y, flat.at[2].y});
    if (right < 0 || left > width || high < 0 || low > height) continue;
    flats.push_back(flat);
  }
  const std::size_t band_texels = std::max<std::size_t>(1, most_samples / (grid.columns * samples * samples));
  std::vector<Sum> sums;
  for (std::size_t first = 0; first < grid.rows; first += band_texels) {
    Band band;
    band.width = grid.columns * samples;
    band.first = first * samples;
    band.rows = std::min<std::size_t>(band_texels, grid.rows - first) * samples;
    band.ahead.assign(band.width * band.rows, std::numeric_limits<double>::infinity());
    band.shown.assign(band.width * band.rows, nothing);
    for (std::uint32_t t = 0; t < flats.size(); ++t) draw(flats[t], t, options, band);
    sum_up(band, flats, grid, scan, samples, sums);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Sum& sum = sums[i];
      if (sum.inside == 0) continue;
      const std::size_t row = grid.rows - 1 - (first + i / grid.columns), at = row * grid.columns + i % grid.columns;
      const bool shown = sum.shown > 0 && 2 * sum.shown >= sum.inside;
      std::optional<Light> pointed;
      if (!shown && !of_points.empty()) pointed = of_points[first * grid.columns + i];
      out.state[at] = shown || pointed.has_value() ? seen : unknown;
      out.inside += sum.inside;
      if (!shown && !pointed) continue;
      out.known += sum.inside;
      for (std::size_t c = 0; c < 3; ++c) {
        out.light[at][c] =
            pointed ? (*pointed)[c] : static_cast<std::uint16_t>((sum.light[c] + sum.shown / 2) / sum.shown);
        out.sum[c] += std::uint64_t{out.light[at][c]} * sum.inside;
      }
    }
  }
  return out;
}

}  // namespace mansard::texture::detail

namespace mansard::texture {

auto colour_at(const ScanTriangle& triangle, geometry::Point3 p, const model::Pixels* pixels,
               const std::array<formats::Wrap, 2>& wrap) -> std::optional<std::array<std::uint8_t, 3>> {
  if (triangle.material != no_material && pixels == nullptr) return std::nullopt;
  const auto& [a, b, c] = triangle.corners;
  const auto normal = cross(b - a, c - a);
  const double area = dot(normal, normal);
  if (!(area > 0)) return std::nullopt;
  std::array<double, 3> weight{};
  weight[1] = std::clamp(dot(normal, cross(p - a, c - a)) / area, 0.0, 1.0);
  weight[2] = std::clamp(dot(normal, cross(b - a, p - a)) / area, 0.0, 1.0 - weight[1]);
  weight[0] = 1 - weight[1] - weight[2];
  const auto light = detail::mixed(triangle, weight, pixels, wrap);
  return std::array{formats::srgb_of(light[0]), formats::srgb_of(light[1]), formats::srgb_of(light[2])};
}

}  // namespace mansard::texture
