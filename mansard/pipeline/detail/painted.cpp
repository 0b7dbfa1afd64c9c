#include "mansard/pipeline/detail/painted.hpp"

#include <algorithm>

#include "mansard/model/find.hpp"
#include "mansard/picture/picture.hpp"

namespace mansard::pipeline::detail {
namespace {

using model::FaceClass;
using roof::Colour;

/// What in_hex() wrote.
auto colour_in(const model::Attributes& attributes, std::string_view name) -> std::optional<Colour> {
  const auto* text = model::find<std::string>(attributes, name);
  if (text == nullptr || text->size() != 7) return std::nullopt;
  const auto digit = [&](std::size_t i) {
    const char c = (*text)[i];
    return c <= '9' ? c - '0' : c - 'a' + 10;
  };
  Colour out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = static_cast<std::uint8_t>(16 * digit(1 + 2 * i) + digit(2 + 2 * i));
  return out;
}

struct Colours {
  Colour wall = picture::wall_grey, roof = picture::roof_red;
};

auto colour_of(FaceClass kind, const Colours& colours) -> Colour {
  switch (kind) {
    case FaceClass::wall:
    case FaceClass::party_wall: return colours.wall;
    case FaceClass::roof: return colours.roof;
    case FaceClass::soffit:
    case FaceClass::ground: break;
  }
  return picture::ground_grey;
}

auto plain(const Colour& colour) -> model::FaceTexture {
  model::FaceTexture out;
  out.frame.start = {0.5, 0.5};
  out.pixels = {1, 1, {colour.begin(), colour.end()}};
  return out;
}

}  // namespace

auto has_colours(const model::Scene& scene, const Options& options) -> bool {
  const auto is_coloured = [&](const model::Attributes& attributes) {
    const auto read = roof::paint_of(attributes, options.roof);
    return read.paint.wall || read.paint.roof;
  };
  return std::ranges::any_of(scene.footprints, [&](const model::Footprint& footprint) {
    return is_coloured(footprint.attributes) ||
           std::ranges::any_of(footprint.parts, is_coloured, &model::FootprintPart::attributes);
  });
}

auto painted(const model::Building& building) -> std::optional<model::BuildingTexture> {
  std::vector<Colours> of_part;
  for (const auto& part : building.parts) {
    auto& colours = of_part.emplace_back();
    colours.wall = colour_in(part.attributes, "ms_wall_colour").value_or(colours.wall);
    colours.roof = colour_in(part.attributes, "ms_roof_colour").value_or(colours.roof);
  }
  model::BuildingTexture out;
  for (const auto& [parts, model, part_of_face] : building.solids) {
    const bool known = part_of_face.size() == model.solid.faces.size();
    if (!known && parts.size() != 1) return std::nullopt;
    auto& solid = out.solids.emplace_back();
    solid.wall = of_part[parts.front()].wall;
    solid.roof = of_part[parts.front()].roof;
    for (std::size_t f = 0; f < model.solid.faces.size(); ++f)
      solid.faces.push_back(plain(colour_of(model.classes[f], of_part[known ? part_of_face[f] : parts.front()])));
  }
  if (out.solids.empty()) return std::nullopt;
  return out;
}

}  // namespace mansard::pipeline::detail
