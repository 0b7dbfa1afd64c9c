// Texels that the scan does not show.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/texture/detail/project.hpp"

namespace mansard::texture::detail {

/// Every texel that is not `fixed` becomes a smooth continuation of those that are: near them their mean, further away
/// that of ever larger squares (an image pyramid: Gortler et al., The Lumigraph, 1996, section 3.4: pull and push). At
/// least one must be fixed. In integers.
void continue_from(std::vector<Light>& light, const std::vector<bool>& fixed, std::uint32_t width,
                   std::uint32_t height);

}  // namespace mansard::texture::detail
