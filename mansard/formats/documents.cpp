#include "mansard/formats/documents.hpp"

#include "mansard/base/outputs.hpp"
#include "mansard/formats/cityjson/cityjson.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/gltf/glb_bytes.hpp"
#include "mansard/formats/obj/obj_text.hpp"

namespace mansard::formats {
namespace {

/// What every format with geometry asks of a city first.
auto checked_keys(const model::City& city) -> base::Result<detail::Keys> {
  if (const auto sound = detail::check_models(city); !sound) return sound.error();
  return detail::keys_of(city);
}

}  // namespace

auto cityjson(const model::City& city, Solids solids, std::vector<base::Diagnostic>* warnings)
    -> base::Result<std::string> {
  const auto keys = checked_keys(city);
  if (!keys) return keys.error();
  const Header header{city.frame, city.made_by};
  base::TextSink vertices;
  std::vector<base::Diagnostic> unheard;
  detail::CityJsonOptions options;
  options.solids = solids;
  options.lods = default_lods(Format::cityjson);
  detail::CityObjects text(header, options, vertices, 0);
  for (std::size_t b = 0; b < city.buildings.size(); ++b)
    text.add(city.buildings[b], {keys->buildings[b], keys->parts[b]}, warnings ? *warnings : unheard);
  detail::JsonText json = detail::cityjson_head(header, options, text.extent(), 0);
  json.raw(text.end()).line().key("vertices").begin_array();
  if (!vertices.text.empty()) json.raw(vertices.text);
  return json.end_array().line().end_object().take() + "\n";
}

auto obj(const model::City& city, const std::string& mtl_name, Solids solids) -> base::Result<ObjFiles> {
  const auto keys = checked_keys(city);
  if (!keys) return keys.error();
  const Header header{city.frame, city.made_by};
  detail::ObjText text(header, solids);
  ObjFiles files{text.head(header, mtl_name), detail::mtl_text()};
  for (std::size_t b = 0; b < city.buildings.size(); ++b) {
    const auto more = text.of(city.buildings[b], {keys->buildings[b], keys->parts[b]});
    if (!more) return more.error();
    files.obj += *more;
  }
  return files;
}

auto glb(const model::City& city, Solids solids) -> base::Result<std::string> {
  const auto keys = checked_keys(city);
  if (!keys) return keys.error();
  return detail::glb_bytes(city, *keys, solids);
}

}  // namespace mansard::formats
