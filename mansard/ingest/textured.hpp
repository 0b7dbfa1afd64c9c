// The meshes of a scene once more, with their textures.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "mansard/formats/textured_mesh.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::ingest {

/// Receives a mesh in the local frame of the scene; from one thread at a time, in the order of the sources.
using TakeTextured = std::function<base::Result<void>(formats::TexturedMesh mesh)>;
/// The same for points of clouds.
using TakePoints = std::function<base::Result<void>(std::vector<formats::ColouredPoint> points)>;
struct TakeColours {
  TakeTextured meshes;
  TakePoints points;
};

/// Reads the meshes that a scene was read from again, with what colours them, piece by piece: no more than a few files
/// or tiles are in memory. `frame` is that of the scene, `within` a box in it: tiles beside it are left out. Corners
/// are where those of the scene's mesh are; those that no mesh can have are NaN. Rasters have no textures and are left
/// out. Of clouds, the coloured points that can be a surface: neither noise, withheld points, vegetation and wires, nor
/// returns before the last one, nor black ones, which is how files mark points without a colour. Returns what is to be
/// told. Fails as read_scene does, and as `take`.
[[nodiscard]] auto read_textured(const std::vector<std::filesystem::path>& meshes, const Options& options,
                                 const model::Frame& frame, const geometry::Box2& within, const TakeColours& take,
                                 const base::Run& run = {}) -> base::Result<std::vector<base::Diagnostic>>;

}  // namespace mansard::ingest
