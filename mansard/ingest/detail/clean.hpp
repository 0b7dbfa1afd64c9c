// From what a file has to what the guarantees of the public function say.
#pragma once

#include <optional>

#include "mansard/base/run.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::ingest::detail {

/// Of the triangles that can be used, in raw coordinates plus the offset.
[[nodiscard]] auto bounds(const formats::RawMesh& raw, const std::array<double, 3>& offset) -> geometry::Box3;

struct CleanMesh {
  geometry::Mesh mesh;
  std::vector<std::uint8_t> classes;  ///< per triangle, where the raw mesh has them; else empty
  model::MeshCounts counts;
};

/// Whether a coordinate can be one of a mesh.
[[nodiscard]] auto usable(geometry::Point3 p) -> bool;

/// The cell that a mesh is one of, [least, most): what reaches into several cells is counted in one of them only, that
/// of its first corner by coordinates.
struct Home {
  geometry::Point2 least, most;
  [[nodiscard]] auto has(geometry::Point3 p) const -> bool {
    return p.x >= least.x && p.x < most.x && p.y >= least.y && p.y < most.y;
  }
};

/// Drops what cannot be used, makes corners at the same place one, takes out what then has no area or is there twice.
/// `shift` is added to all coordinates; with `within`, triangles whose box misses it are left out uncounted; with
/// `home`, what is at home elsewhere is uncounted. Without a result when cancelled. Cost: linear in vertices and
/// triangles but for sorting around each vertex.
[[nodiscard]] auto clean(formats::RawMesh raw, const std::array<double, 3>& shift,
                         const std::optional<geometry::Box2>& within, const std::optional<Home>& home = {},
                         const base::Run& run = {}) -> CleanMesh;

/// One warning for each kind of fault that was found.
[[nodiscard]] auto warnings_of(const model::MeshCounts& counts, const std::string& subject)
    -> std::vector<base::Diagnostic>;

}  // namespace mansard::ingest::detail
