// The mesh of a scene in pieces that memory can hold, for the pictures of a run.
#pragma once

#include "mansard/ingest/ingest.hpp"
#include "mansard/report/pictures.hpp"

namespace mansard::pipeline {

/// What lies in `box`, in pieces of report::piece_triangles each, or of one cell. The city must outlive it. Fails as
/// ingest::MeshCells::load.
[[nodiscard]] auto scan_pieces(const ingest::CityScene& city, const geometry::Box2& box) -> report::ScanPieces;

}  // namespace mansard::pipeline
