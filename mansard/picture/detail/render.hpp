// Ray-traced light on coloured triangles.
#pragma once

#include <span>

#include "mansard/base/run.hpp"
#include "mansard/picture/detail/camera.hpp"
#include "mansard/picture/detail/scenery.hpp"

namespace mansard::picture::detail {

inline constexpr Colour paper{250, 250, 248};

/// The scenery under a sun and an open sky, standing on a sheet of paper that takes its shadow, and the lines' visible
/// pieces: those with nothing more than 10 cm in front of them. Only the lines where there are no triangles. Fails as
/// Scenery::piece does.
[[nodiscard]] auto render(Image& image, const Scenery& scenery, std::span<const Lines> lines, const Camera& camera,
                          const base::Run& run) -> base::Result<void>;

}  // namespace mansard::picture::detail
