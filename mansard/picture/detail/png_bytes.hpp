// PNG through libpng.
#pragma once

#include <string>

#include "mansard/picture/picture.hpp"

namespace mansard::picture::detail {

/// 8 bits a channel, sRGB, no time and no text: the same image gives the same bytes.
[[nodiscard]] auto png_bytes(const Image& image) -> base::Result<std::string>;

}  // namespace mansard::picture::detail
