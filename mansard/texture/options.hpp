// The options of textures.
#pragma once

#include <cstdint>

#include "mansard/base/options.hpp"

namespace mansard::texture {

struct Options {
  bool bake = false;                  ///< whether models get textures at all
  double size = 0.1;                  ///< m along a texel
  std::int64_t samples = 3;           ///< per texel, along each side
  double outward = 1.0;               ///< m in front of a face, up to which the scan's surface is its picture
  double inward = 1.5;                ///< m behind it
  double angle = 1.0471975511965976;  ///< rad between the normals of a face and of the scan's surface; 60°
  double fill_share = 0.5;            ///< of a face; with more of it known, the rest is continued from it
  double point_reach = 1.5;           ///< m around a coloured point, up to which it colours a surface
  double image_memory = 256;          ///< MB of decoded images in memory
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

}  // namespace mansard::texture
