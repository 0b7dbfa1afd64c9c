#include "apps/server/ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "apps/server/disk.hpp"
#include "apps/server/exports.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/terrain.hpp"
#include "mansard/pipeline/terrain.hpp"

namespace mansard::server {
namespace {

struct Around {
  std::vector<terrain::Ground> grounds;
  terrain::Heights heights;
};

auto around(const model::City& city, const OpenScene& scene, const pipeline::Options& options) -> base::Result<Around> {
  Around out;
  for (const auto& building : city.buildings)
    if (auto ground = terrain::ground_of(building); !ground.rings.empty()) out.grounds.push_back(std::move(ground));
  const auto area = terrain::area_around(out.grounds, options.terrain);
  if (area.empty()) return base::error("pipeline-nothing", "there are no models, so there is no terrain around them");
  const auto whole = scene.with_mesh();
  if (!whole) return whole.failure();
  auto heights = pipeline::terrain_heights(*whole, nullptr, area, options.terrain);
  if (!heights) return heights.failure();
  out.heights = std::move(*heights);
  return out;
}

auto surface(const model::City& city, const OpenScene& scene, const pipeline::Options& options, bool closed)
    -> base::Result<geometry::Mesh> {
  const auto from = around(city, scene, options);
  if (!from) return from.failure();
  if (closed) {
    auto made = terrain::closed(from->heights, city.buildings, options.terrain);
    return made ? base::Result<geometry::Mesh>(std::move(made->mesh)) : made.failure();
  }
  const auto made = terrain::make(from->heights, from->grounds, options.terrain);
  return made ? base::Result<geometry::Mesh>(terrain::mesh_of(*made)) : made.failure();
}

template <class T>
void append_value(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

auto terrain_bytes(const model::City& city, const OpenScene& scene, const pipeline::Options& options)
    -> base::Result<std::string> {
  const auto mesh = surface(city, scene, options, false);
  if (!mesh) return mesh.failure();
  const auto box = geometry::Box3::of(mesh->vertices);
  const auto middle = 0.5 * (box.least + box.most);
  const geometry::Point3 centre{std::round(middle.x), std::round(middle.y), std::round(middle.z)};
  std::string bytes;
  for (const double c : {centre.x, centre.y, centre.z}) append_value(bytes, c);
  append_value(bytes, static_cast<std::uint32_t>(mesh->vertices.size()));
  append_value(bytes, static_cast<std::uint32_t>(mesh->triangles.size()));
  for (const auto& v : mesh->vertices)
    for (const double c : {v.x - centre.x, v.y - centre.y, v.z - centre.z}) append_value(bytes, static_cast<float>(c));
  for (const auto& triangle : mesh->triangles)
    for (const std::uint32_t v : triangle) append_value(bytes, v);
  return bytes;
}

auto terrain_files() -> const std::vector<std::string>& {
  static const std::vector<std::string> names{"terrain.city.json", "terrain.glb", "terrain.stl"};
  return names;
}

auto terrain_file(const model::City& city, const OpenScene& scene, const pipeline::Options& options,
                  std::string_view file, const std::filesystem::path& work) -> base::Result<std::string> {
  const auto format = formats::terrain_format_of(file);
  if (std::ranges::find(terrain_files(), file) == terrain_files().end() || !format)
    return base::error("server-unknown", "unknown file of a terrain; expected terrain.city.json, .glb or .stl",
                       base::on_one_line(std::string(file)));
  const auto mesh = surface(city, scene, options, *format == formats::Format::stl);
  if (!mesh) return mesh.failure();
  const WorkFolder folder(work);
  if (auto made = make_folder(folder.path()); !made) return made.error();
  const auto path = folder.path() / file;
  base::Outputs outputs;
  const auto written = formats::write_terrain(*format, path, *mesh, {city.frame, city.made_by}, options.write, outputs);
  if (!written) return written.failure();
  if (auto committed = outputs.commit(); !committed) return committed.error();
  return base::read_file(path);
}

}  // namespace mansard::server
