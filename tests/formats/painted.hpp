// Cities made by hand with pictures on their faces.
#pragma once

#include <algorithm>
#include <cmath>

#include "formats/cities.hpp"
#include "mansard/formats/written.hpp"

namespace cities {

inline auto plain(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 3> colour)
    -> mansard::model::Pixels {
  mansard::model::Pixels out{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) out.rgb.insert(out.rgb.end(), colour.begin(), colour.end());
  return out;
}

/// The colour of a face of a building, by which it is found again: JPEG keeps it within a few values.
inline auto colour_of(std::size_t building, std::size_t face) -> std::array<std::uint8_t, 3> {
  return {static_cast<std::uint8_t>(40 + 20 * (face % 10)), static_cast<std::uint8_t>(60 + 40 * (building % 4)),
          static_cast<std::uint8_t>(face % 2 == 0 ? 200 : 90)};
}

/// A picture along the first edge of every face, larger than the face.
inline auto painted(mansard::model::Building building, std::size_t number) -> mansard::model::Building {
  mansard::model::BuildingTexture texture;
  for (const auto& solid : mansard::formats::written_solids(building, mansard::formats::Solids::building)) {
    auto& own = texture.solids.emplace_back();
    own.roof = {200, 10, 10};
    own.wall = {10, 200, 10};
    for (std::size_t f = 0; f < solid.solid.faces.size(); ++f) {
      const auto& face = solid.solid.faces[f];
      const auto a = solid.solid.vertices[face.loops[0][0]], b = solid.solid.vertices[face.loops[0][1]];
      auto& picture = own.faces.emplace_back();
      const auto right = mansard::geometry::normalised(b - a), below = cross(right, face.normal);
      picture.frame.right = right;
      picture.frame.below = below;
      double least_x = 1e9, least_y = 1e9, most_x = -1e9, most_y = -1e9;
      for (const auto& loop : face.loops)
        for (const auto v : loop) {
          const auto [x, y] = picture.frame.at(solid.solid.vertices[v]);
          least_x = std::min(least_x, x), most_x = std::max(most_x, x);
          least_y = std::min(least_y, y), most_y = std::max(most_y, y);
        }
      picture.frame.start = {-least_x, -least_y};
      picture.pixels = plain(static_cast<std::uint32_t>(std::ceil(most_x - least_x)),
                             static_cast<std::uint32_t>(std::ceil(most_y - least_y)), colour_of(number, f));
    }
  }
  building.texture = std::move(texture);
  return building;
}

inline auto painted_street() -> mansard::model::City {
  auto city = cities::street();
  for (std::size_t b = 0; b < city.buildings.size(); ++b) city.buildings[b] = painted(city.buildings[b], b);
  return city;
}

}  // namespace cities
