// Points of one class, in the frame of a scene or a model.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::ingest {

/// The points of `classification`, or of what the lists of classes in the options say is that, in all clouds among the
/// paths (files, and those in folders), in metres of the frame, with the offset of the options; other files are passed
/// over. Those that are not finite are left out; of several clouds, each place is there once. 24 bytes a point. Fails
/// as read_scene does for clouds.
[[nodiscard]] auto read_points_of_class(const std::vector<std::filesystem::path>& paths, std::uint8_t classification,
                                        const model::Frame& frame, const Options& options, const base::Run& run = {})
    -> base::Result<std::vector<geometry::Point3>>;

}  // namespace mansard::ingest
