// Lettering by strokes, as on an engineer's drawing: no fonts to install, the same everywhere.
#pragma once

#include <string_view>

#include "mansard/picture/detail/canvas.hpp"

namespace mansard::picture::detail {

/// Width in pixels of a line of UTF-8 text whose capitals are `height` pixels tall.
[[nodiscard]] auto text_width(std::string_view text, double height) -> double;

/// Writes with the left end of the baseline at `at`. Characters without a drawing show as an empty box.
void write_text(Ink& ink, std::string_view text, Spot at, double height);

}  // namespace mansard::picture::detail
