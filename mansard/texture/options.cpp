#include "mansard/texture/options.hpp"

namespace mansard::texture {

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("texture");
  list.flag("bake", o.bake, "Give the models the textures of the scan.").alias("texture").source("off by default");
  list.number("size", o.size, "m", {0.005, 10}, "Side length of a texel of the models' textures.")
      .source("docs/texture.md");
  list.integer("samples", o.samples, "", {1, 16}, "Samples of the scan along each side of a texel.")
      .source("docs/texture.md");
  list.number("outward", o.outward, "m", {0, 100},
              "Distance in front of a face up to which the scan's surface is its picture.")
      .source("docs/texture.md");
  list.number("inward", o.inward, "m", {0, 100},
              "Distance behind a face up to which the scan's surface is its picture.")
      .source("docs/texture.md");
  list.number("angle", o.angle, "rad", {0, 1.5707963267948966},
              "Angle between the normals of a face and of the scan's surface up to which it is its picture.")
      .source("docs/texture.md");
  list.number(
          "fill_share", o.fill_share, "", {0, 1},
          "Known share of a face from which its other texels are continued from it; below, they get the mean colour "
          "of the building's roofs or walls.")
      .source("docs/texture.md");
  list.number("point_reach", o.point_reach, "m", {0.01, 100},
              "Maximum distance to which a point of a coloured cloud colours a surface; where points are closer "
              "together, they reach to their neighbours.")
      .source("docs/texture.md");
  list.number("image_memory", o.image_memory, "MB", {1, 1e6},
              "Memory for decoded images of the scan; images that are needed again after that are decoded again.")
      .advanced("about 80 images of 1024 × 1024 pixels");
  return list;
}

}  // namespace mansard::texture
