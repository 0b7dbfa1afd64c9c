#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <sstream>

#include "mansard/base/files.hpp"
#include "mansard/formats/plans/plan_items.hpp"
#include "mansard/formats/terrain.hpp"

namespace mansard::formats {
namespace {

/// Read in pieces: files of models may be larger than memory.
auto has_word(const std::filesystem::path& path, std::string_view word) -> bool {
  std::ifstream file(path, std::ios::binary);
  std::string piece(std::size_t{1} << 20, '\0');
  for (std::size_t kept = 0; file;) {
    file.read(piece.data() + kept, static_cast<std::streamsize>(piece.size() - kept));
    const auto size = kept + static_cast<std::size_t>(file.gcount());
    if (std::string_view(piece.data(), size).find(word) != std::string_view::npos) return true;
    kept = std::min(size, word.size() - 1);  // the word may lie across two pieces
    std::copy_n(piece.begin() + static_cast<std::ptrdiff_t>(size - kept), kept, piece.begin());
  }
  return false;
}

struct Transform {
  std::array<double, 3> scale{1, 1, 1}, translate{0, 0, 0};
};

/// The rings of surfaces, at whatever depth: lists of indices of vertices.
void take_rings(const Json& boundaries, std::set<std::size_t>& used, std::size_t& triangles) {
  if (!boundaries.is_array() || boundaries.empty()) return;
  if (!boundaries.front().is_number()) {
    for (const auto& inner : boundaries) take_rings(inner, used, triangles);
    return;
  }
  if (boundaries.size() >= 3) triangles += boundaries.size() - 2;
  for (const auto& index : boundaries) used.insert(index.get<std::size_t>());
}

/// Of a document, or of one feature; `transform` is that of the first line of a sequence.
void take(const Json& json, const Transform& transform, TerrainInfo& info) {
  std::set<std::size_t> used;
  for (const auto& [id, object] : json.at("CityObjects").items()) {
    if (object.value("type", "") != "TINRelief") {
      ++info.others;
      continue;
    }
    ++info.surfaces;
    if (!object.contains("geometry")) continue;
    for (const auto& geometry : object["geometry"]) {
      take_rings(geometry.at("boundaries"), used, info.triangles);
      if (info.lod.empty() && geometry.contains("lod"))
        info.lod = geometry["lod"].is_string() ? geometry["lod"].get<std::string>() : geometry["lod"].dump();
    }
  }
  const auto& vertices = json.at("vertices");
  info.vertices += used.size();
  for (const auto v : used) {
    std::array<double, 3> p{};
    for (std::size_t i = 0; i < 3; ++i)
      p[i] = vertices.at(v).at(i).get<double>() * transform.scale[i] + transform.translate[i];
    info.box.add({p[0], p[1], p[2]});
  }
}

void take_head(const Json& json, Transform& transform, TerrainInfo& info) {
  if (json.contains("transform"))
    transform = {json["transform"].at("scale").get<std::array<double, 3>>(),
                 json["transform"].at("translate").get<std::array<double, 3>>()};
  if (json.contains("+mansard")) {
    const detail::Item own{json["+mansard"], {}};
    info.made_by = detail::read_made_by(own.member("made_by"));
  }
  const auto system = json.contains("metadata") ? json["metadata"].value("referenceSystem", "") : "";
  if (system.find("EPSG") != std::string::npos) info.crs = "EPSG:" + system.substr(system.find_last_of("/:") + 1);
}

}  // namespace

auto terrain_info(const std::filesystem::path& path) -> std::optional<TerrainInfo> {
  if (!has_word(path, "\"TINRelief\"")) return std::nullopt;
  const auto bytes = base::read_file(path);
  if (!bytes) return std::nullopt;
  TerrainInfo info;
  Transform transform;
  try {
    if (const auto whole = Json::parse(*bytes, nullptr, false); !whole.is_discarded()) {
      take_head(whole, transform, info);
      take(whole, transform, info);
    } else {
      std::istringstream lines(*bytes);
      for (std::string line; std::getline(lines, line);) {
        if (line.empty()) continue;
        const auto json = Json::parse(line);
        if (json.at("type") == "CityJSON") take_head(json, transform, info);
        take(json, transform, info);
      }
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const detail::Defect&) {
    return std::nullopt;
  }
  return info.surfaces > 0 ? std::optional(info) : std::nullopt;
}

}  // namespace mansard::formats
