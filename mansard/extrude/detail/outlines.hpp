// Canonical footprints of the outlines sketched last: a search sketches one outline under many roofs.
#pragma once

#include <string>

#include "mansard/extrude/detail/footprint.hpp"

namespace mansard::extrude::detail {

/// As canonical(); null, and why, where that gives nothing. What the lines become depends on the outline and, at most
/// (`Footprint::by_profiles`), on which profiles climb alike, so that only the tracks are made anew for an outline that
/// is among the last few of this thread. Valid until the next call on the thread.
[[nodiscard]] auto canonical_outline(const Source& source, const Options& options, std::string& why)
    -> const Footprint*;

}  // namespace mansard::extrude::detail
