#include "mansard/formats/levels.hpp"

#include <algorithm>
#include <optional>

#include "mansard/base/options.hpp"
#include "mansard/formats/detail/drawn.hpp"
#include "mansard/formats/detail/flat_level.hpp"

namespace mansard::formats {
namespace {

constexpr std::array<std::string_view, lod_count> names{"0", "1.2", "1.3", "2.0", "2.2"};

/// The text up to a separator, which is taken off with it.
auto take_until(std::string_view& text, char separator) -> std::string_view {
  const auto at = text.find(separator);
  const auto taken = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + 1);
  return taken;
}

auto trimmed(std::string_view text) -> std::string_view {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

auto wrong(const std::string& what) -> base::Diagnostic {
  return base::error("option-value",
                     what + "; expected levels such as '1.2,2.2', or levels by format such as 'cityjson=0,1.2;obj=1.3'",
                     "write.lod");
}

auto levels_in(std::string_view list) -> base::Result<Lods> {
  Lods out;
  while (!list.empty()) {
    const auto word = trimmed(take_until(list, ','));
    const auto found = std::ranges::find(names, word);
    if (found == names.end())
      return wrong("'" + std::string(word) + "' is not a level of detail: 0, 1.2, 1.3, 2.0 and 2.2 are");
    const auto lod = static_cast<Lod>(found - names.begin());
    if (std::ranges::find(out, lod) == out.end()) out.push_back(lod);
  }
  std::ranges::sort(out);
  return out;
}

struct Asked {
  std::optional<Lods> all;
  std::vector<std::pair<Format, Lods>> some;
};

auto parse(std::string_view text) -> base::Result<Asked> {
  Asked out;
  while (!text.empty()) {
    auto item = trimmed(take_until(text, ';'));
    if (item.empty()) continue;
    if (item.find('=') == std::string_view::npos) {
      auto levels = levels_in(item);
      if (!levels) return levels.failure();
      out.all = std::move(*levels);
      continue;
    }
    const auto name = trimmed(take_until(item, '='));
    const auto driver =
        std::ranges::find_if(drivers(), [&](const Driver& d) { return d.name == name && d.writes.has_value(); });
    if (driver == drivers().end()) {
      std::string known;
      for (const auto& d : drivers())
        if (d.writes && !possible_lods(*d.writes).empty()) known += (known.empty() ? "" : ", ") + std::string(d.name);
      return wrong("'" + std::string(name) + "' is not the name of a format with levels of detail; these are " + known);
    }
    auto levels = levels_in(item);
    if (!levels) return levels.failure();
    const auto possible = possible_lods(*driver->writes);
    for (const auto lod : *levels)
      if (std::ranges::find(possible, lod) == possible.end())
        return wrong(std::string(driver->title) + " has no LoD " + std::string(name_of(lod)));
    if (levels->size() > 1 && default_lods(*driver->writes).size() == 1)
      return wrong(std::string(driver->title) + " has one solid a building, so one level of detail");
    out.some.emplace_back(*driver->writes, std::move(*levels));
  }
  return out;
}

}  // namespace

auto name_of(Lod lod) -> std::string_view { return names[static_cast<std::size_t>(lod)]; }

auto suffix_of(Lod lod) -> std::string {
  std::string out = "lod";
  for (const char c : name_of(lod))
    if (c != '.') out += c;
  return out;
}

auto possible_lods(Format format) -> Lods {
  using enum Lod;
  switch (format) {
    case Format::cityjson:
    case Format::cityjsonseq:
    case Format::geopackage:
    case Format::citygml: return {lod0, lod12, lod13, lod20, lod22};
    case Format::obj:
    case Format::glb:
    case Format::stl:
    case Format::dxf: return {lod12, lod13, lod20, lod22};
    case Format::tiles: return {lod22};
    case Format::geojson:
    case Format::flatgeobuf: return {lod0};
    case Format::plans: break;
  }
  return {};
}

auto default_lods(Format format) -> Lods {
  using enum Lod;
  switch (format) {
    case Format::cityjson:
    case Format::cityjsonseq:
    case Format::geopackage:
    case Format::citygml: return {lod0, lod12, lod13, lod22};
    case Format::obj:
    case Format::glb:
    case Format::stl:
    case Format::dxf:
    case Format::tiles: return {lod22};
    case Format::geojson:
    case Format::flatgeobuf: return {lod0};
    case Format::plans: break;
  }
  return {};
}

auto lods_of(std::string_view text, Format format) -> base::Result<Lods> {
  auto asked = parse(text);
  if (!asked) return asked.failure();
  const auto& all = asked->all;
  for (auto& [of, levels] : asked->some)
    if (of == format) return std::move(levels);
  const auto usual = default_lods(format);
  if (!all) return usual;
  const auto possible = possible_lods(format);
  Lods out;
  for (const auto lod : *all)
    if (std::ranges::find(possible, lod) != possible.end()) out.push_back(lod);
  if (usual.size() == 1 && !out.empty()) out = {out.back()};
  return out.empty() ? usual : out;
}

auto check_lods(std::string_view text) -> base::Result<void> {
  if (const auto asked = parse(text); !asked) return asked.failure();
  return {};
}

auto Levels::at(Lod lod) const -> const model::LabelledSolid& {
  switch (lod) {
    case Lod::lod12: return lod12;
    case Lod::lod13: return lod13;
    case Lod::lod20: return lod20;
    default: return lod22;
  }
}

auto levels_of(const model::Building& building, const model::Frame& frame, const solid::LevelOptions& options)
    -> std::vector<Levels> {
  detail::Gate::Keyed keys{building.id, {}};
  for (const auto& part : building.parts) keys.parts.push_back(part.id);
  std::vector<Levels> out;
  using enum Lod;
  const auto drawn = detail::drawn(building, keys, Solids::building);
  const auto all = detail::level_surfaces(drawn, frame, {lod12, lod13, lod20}, options);
  for (std::size_t i = 0; i < all.size(); ++i)
    out.push_back({detail::solid_of(all[i].lod12), detail::solid_of(all[i].lod13), detail::solid_of(all[i].lod20),
                   drawn.solids[i].part.model});
  return out;
}

}  // namespace mansard::formats
