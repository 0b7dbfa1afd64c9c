// Recipes of known sizes.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planted.hpp"

namespace mansard::planted {
namespace {

auto recipe(std::string name, Kind kind, std::size_t houses, double clutter) -> Recipe {
  Recipe r;
  r.name = std::move(name);
  r.kind = kind;
  r.houses = houses;
  r.clutter = clutter;
  return r;
}

auto one_feature(Recipe r) -> Recipe {
  r.features = Features::per_block;
  return r;
}

auto slabs() -> Recipe {
  Recipe r = one_feature(recipe("new_york", Kind::towers, 256, 0));
  r.width_least = 4;
  r.width_most = 10;
  r.eaves_least = 8;
  r.step_least = 3;
  r.step_most = 25;
  return r;
}

auto wings() -> Recipe {
  Recipe r = one_feature(recipe("copenhagen", Kind::courtyard, 15, 1.1));
  r.width_least = 10;
  r.width_most = 18;
  return r;
}

}  // namespace

auto presets() -> std::vector<Recipe> {
  return {recipe("glasgow_small", Kind::terrace, 3, 0.7), recipe("madrid", Kind::perimeter, 14, 0.4),         wings(),
          recipe("glasgow", Kind::perimeter, 18, 0.8),    one_feature(recipe("london", Kind::grid, 34, 1.2)), slabs()};
}

auto preset(std::string_view name, std::uint64_t seed) -> Recipe {
  const auto all = presets();
  const auto found = std::ranges::find(all, name, &Recipe::name);
  if (found == all.end()) throw std::invalid_argument("no preset " + std::string(name));
  Recipe r = *found;
  r.seed = seed;
  return r;
}

auto large(std::size_t faces, std::uint64_t seed) -> Recipe {
  // Lines reach farther into larger districts, so that a house is cut into more faces there; fitted.
  const auto n = static_cast<double>(faces);
  const auto houses = static_cast<std::size_t>(n / (4.75 + n / 3000));
  Recipe r = one_feature(recipe("large_" + std::to_string(faces), Kind::grid, houses, 1));
  r.seed = seed;
  return r;
}

}  // namespace mansard::planted
