#include "mansard/formats/atlas/atlas.hpp"

#include <algorithm>
#include <numeric>

namespace mansard::formats::detail {
namespace {

auto in_cells(std::uint32_t pixels) -> std::uint32_t {
  return (pixels + 2 * atlas_gutter + atlas_cell - 1) / atlas_cell * atlas_cell;
}

/// The smallest power of two, from a cell on, whose square holds so many pixels with a tenth to spare; `most` at most.
auto side_for(std::uint64_t area, std::uint32_t widest, std::uint32_t most) -> std::uint32_t {
  std::uint64_t side = atlas_cell;
  while (side < most && (side * side < area + area / 10 || side < widest)) side *= 2;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(side, most));
}

}  // namespace

auto Atlas::add(const model::Pixels& picture) -> std::size_t {
  if (picture.width == 1 && picture.height == 1) {
    const auto [entry, added] = plain_.try_emplace(picture.rgb, pictures_.size());
    if (!added) return entry->second;
  }
  pictures_.push_back(&picture);
  return pictures_.size() - 1;
}

void Atlas::settle() {
  std::vector<std::size_t> order(pictures_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const auto &p = *pictures_[a], &q = *pictures_[b];
    const auto h = in_cells(p.height), k = in_cells(q.height);
    return h != k ? h > k : in_cells(p.width) > in_cells(q.width);
  });
  std::uint64_t area = 0;
  std::uint32_t widest = 0;
  for (const auto* picture : pictures_) {
    area += std::uint64_t{in_cells(picture->width)} * in_cells(picture->height);
    widest = std::max(widest, in_cells(picture->width));
  }
  places_.assign(pictures_.size(), {});
  const std::uint32_t width = side_for(area, widest, side_);
  std::uint32_t x = 0, y = 0, row = 0;
  for (const std::size_t number : order) {
    const auto w = in_cells(pictures_[number]->width), h = in_cells(pictures_[number]->height);
    if (sizes_.empty()) sizes_.push_back({width, 0});
    if (x + w > width) y += row, x = row = 0;
    if (y + h > side_) {
      sizes_.push_back({width, 0});
      x = y = row = 0;
    }
    row = std::max(row, h);
    places_[number] = {static_cast<std::uint32_t>(sizes_.size() - 1), x + atlas_gutter, y + atlas_gutter};
    sizes_.back()[1] = std::max(sizes_.back()[1], y + h);
    x += w;
  }
}

auto Atlas::uv(std::size_t number, const std::array<double, 2>& pixel) const -> std::array<double, 2> {
  const auto& [page, x, y] = places_[number];
  const auto& picture = *pictures_[number];
  // Rounding may put corners a little outside.
  const double across = std::clamp(pixel[0], 0.0, static_cast<double>(picture.width)),
               down = std::clamp(pixel[1], 0.0, static_cast<double>(picture.height));
  return {(x + across) / sizes_[page][0], (y + down) / sizes_[page][1]};
}

auto Atlas::page(std::size_t page) const -> model::Pixels {
  model::Pixels out;
  out.width = sizes_[page][0];
  out.height = sizes_[page][1];
  constexpr std::uint8_t middle = 128;
  out.rgb.assign(std::size_t{3} * out.width * out.height, middle);
  for (std::size_t number = 0; number < pictures_.size(); ++number) {
    if (places_[number].page != page) continue;
    const auto& picture = *pictures_[number];
    const std::uint32_t left = places_[number].x - atlas_gutter, top = places_[number].y - atlas_gutter;
    const auto inner = [](std::uint32_t i, std::uint32_t size) {
      return std::min(i < atlas_gutter ? 0 : i - atlas_gutter, size - 1);
    };
    for (std::uint32_t j = 0; j < in_cells(picture.height); ++j)
      for (std::uint32_t i = 0; i < in_cells(picture.width); ++i) {
        const std::size_t from = std::size_t{inner(j, picture.height)} * picture.width + inner(i, picture.width);
        const std::size_t to = std::size_t{top + j} * out.width + left + i;
        std::copy_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * from), 3,
                    out.rgb.begin() + static_cast<std::ptrdiff_t>(3 * to));
      }
  }
  return out;
}

auto SolidAtlas::add(const model::SolidTexture& solid) -> std::size_t {
  solids_.push_back(&solid);
  auto& numbers = numbers_.emplace_back();
  for (const auto& face : solid.faces) numbers.push_back(atlas_.add(face.pixels));
  return solids_.size() - 1;
}

auto SolidAtlas::page_of(std::size_t solid, std::size_t face) const -> std::uint32_t {
  return atlas_.place(numbers_[solid][face]).page;
}

auto SolidAtlas::uv(std::size_t solid, std::size_t face, geometry::Point3 p) const -> std::array<double, 2> {
  return atlas_.uv(numbers_[solid][face], solids_[solid]->faces[face].frame.at(p));
}

auto area_in_atlas(const model::Building& building) -> std::uint64_t {
  std::uint64_t area = 0;
  if (building.texture)
    for (const auto& solid : building.texture->solids)
      for (const auto& face : solid.faces)
        area += std::uint64_t{in_cells(face.pixels.width)} * in_cells(face.pixels.height);
  return area;
}

}  // namespace mansard::formats::detail
