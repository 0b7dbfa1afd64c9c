// Why a scan does not fit its footprints: another axis, unit, handedness or place.
#pragma once

#include <optional>

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// An error that names what makes the scan fit, as align::Match counts it; none where nothing does. Takes a pass over
/// the mesh for each that is tried.
[[nodiscard]] auto other_place(const model::Scene& scene, const Options& options, const base::Run& run)
    -> std::optional<base::Diagnostic>;

}  // namespace mansard::pipeline::detail
