#include "mansard/ingest/textured.hpp"

#include <limits>

#include "mansard/base/stopped.hpp"
#include "mansard/ingest/detail/clean.hpp"
#include "mansard/ingest/detail/mesh_files.hpp"

namespace mansard::ingest {

namespace detail {

auto MeshReading::each_textured(const std::vector<std::filesystem::path>& paths, const Options& options,
                                const std::string& working, const geometry::Box2& within, const TakeColours& take,
                                const base::Run& run) -> base::Result<std::vector<base::Diagnostic>> {
  MeshReading reading(options, nullptr);
  if (auto done = reading.list(paths); !done) return done.error();
  if (auto done = reading.find_places(run); !done) return done.error();
  if (auto done = reading.choose_ways(working); !done) return done.error();
  const geometry::Point2 offset{options.mesh_offset[0], options.mesh_offset[1]};
  const geometry::Box2 raw{within.least - offset, within.most - offset};
  if (auto done = reading.list_tiles(raw, run); !done) return done.error();

  struct Piece {
    const Source* source = nullptr;
    const formats::TileFile* tile = nullptr;  ///< none of a file
  };
  std::vector<Piece> pieces;
  for (const auto& source : reading.sources_) {
    if (source.kind == Kind::file) pieces.push_back({&source, nullptr});
    for (const auto& tile : source.tiles) pieces.push_back({&source, &tile});
  }
  constexpr std::size_t at_a_time = 8;  // bounds memory; threads are fewer on most machines
  for (std::size_t first = 0; first < pieces.size(); first += at_a_time) {
    if (run.cancelled()) return base::stopped();
    std::vector<std::optional<base::Result<formats::TexturedMesh>>> some(std::min(at_a_time, pieces.size() - first));
    base::parallel_for(some.size(), [&](std::size_t i) {
      const auto& [source, tile] = pieces[first + i];
      auto read =
          tile != nullptr ? formats::read_textured_tile(*tile) : formats::read_textured_file(source->path, options.up);
      if (read && source->way) source->way->take(read->mesh.vertices);
      some[i] = std::move(read);
    });
    for (auto& one : some) {
      if (!one) continue;  // each was read
      auto& read = *one;
      if (!read) return read.failure();
      if (auto taken = take.meshes(*std::move(read)); !taken) return taken.failure();
    }
    run.report("texture", pieces[first].source->path.string(),
               static_cast<double>(first) / static_cast<double>(pieces.size()));
  }
  if (auto done = reading.colours_of_clouds(raw, take.points, run); !done) return done.failure();
  return std::move(reading.warnings_);
}

}  // namespace detail

auto read_textured(const std::vector<std::filesystem::path>& meshes, const Options& options, const model::Frame& frame,
                   const geometry::Box2& within, const TakeColours& take, const base::Run& run)
    -> base::Result<std::vector<base::Diagnostic>> {
  std::array<double, 3> shift{};
  for (std::size_t i = 0; i < 3; ++i) shift[i] = options.mesh_offset[i] - static_cast<double>(frame.origin[i]);
  const geometry::Point2 origin{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1])};
  const auto moved = [&](geometry::Point3 v) -> geometry::Point3 {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    v = {v.x + shift[0], v.y + shift[1], v.z + shift[2]};
    if (!detail::usable(v)) return {none, none, none};
    return {model::rounded(v.x), model::rounded(v.y), model::rounded(v.z)};
  };
  const TakeColours into_frame{[&](formats::TexturedMesh mesh) -> base::Result<void> {
                                 for (auto& v : mesh.mesh.vertices) v = moved(v);
                                 return take.meshes(std::move(mesh));
                               },
                               [&](std::vector<formats::ColouredPoint> points) -> base::Result<void> {
                                 for (auto& point : points) point.position = moved(point.position);
                                 return take.points(std::move(points));
                               }};
  return detail::MeshReading::each_textured(meshes, options, frame.crs, {within.least + origin, within.most + origin},
                                            into_frame, run);
}

}  // namespace mansard::ingest
