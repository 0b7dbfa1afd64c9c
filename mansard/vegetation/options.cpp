#include "mansard/vegetation/vegetation.hpp"

namespace mansard::vegetation {

auto option_list(Options& options) -> base::OptionList {
  base::OptionList list("vegetation");
  auto& o = options;
  list.flag("mask", o.mask, "Whether the crowns of trees over footprints do not count as evidence of roofs.")
      .source("measured: docs/decisions/0062");
  list.number("grid", o.grid, "m", {0.1, 1}, "Sample spacing of the surface in which crowns are looked for.")
      .advanced("that of refine.grid");
  list.number("reach", o.reach, "m", {0, 50}, "Distance from the outline of a block up to which crowns are looked for.")
      .advanced("the radius of a large crown over a facade; not measured");
  list.number("window", o.window, "m", {0.75, 10}, "Side of the squares in which the surface is compared with a plane.")
      .advanced("measured on simulated crowns of odd seeds: docs/decisions/0062");
  list.number("roughness", o.roughness, "m", {0.01, 2},
              "Minimum root mean square distance from the best plane of a square that is no roof.")
      .advanced("measured on simulated crowns of odd seeds: docs/decisions/0062");
  list.number("width", o.width, "m", {0.25, 10}, "Minimum width of a crown; narrower ones are edges and chimneys.")
      .advanced("chosen by hand; not measured");
  list.number("even", o.even, "m", {0.005, 1},
              "Maximum root mean square distance from a plane of places from which planes are grown.")
      .advanced("measured on simulated crowns of odd seeds: docs/decisions/0062");
  list.number("plane_distance", o.plane_distance, "m", {0.01, 1}, "Maximum distance of samples from a grown plane.")
      .advanced("twice the noise of a scan");
  list.number("plane_area", o.plane_area, "m²", {1, 50},
              "Minimum area of a grown plane for it to be a roof; the top of a crown has less.")
      .advanced("measured on simulated crowns of odd seeds: docs/decisions/0062");
  list.number("step", o.step, "m", {0.1, 10}, "Maximum difference in height of neighbouring samples of one crown.")
      .advanced("chosen by hand; not measured");
  list.number("min_area", o.min_area, "m²", {0.5, 100}, "Minimum area of a crown.").advanced("a radius of 1 m");
  list.number("max_area", o.max_area, "m²", {1, 1e4}, "Maximum area of a crown, or of crowns that touch.")
      .advanced("a radius of 8 m");
  list.number("min_inside", o.min_inside, "m²", {0, 100}, "Minimum area of a crown over the footprints.")
      .advanced("chosen by hand; not measured");
  list.number("overhang", o.overhang, "", {0, 1}, "Minimum share of a crown below which its underside is visible.")
      .advanced("roof structures have up to 0.05: docs/decisions/0062");
  list.number("rise_beside", o.rise_beside, "m", {0, 50},
              "Minimum height from the lowest to the highest sample of the crown of a tree beside the building.")
      .advanced("balconies have less: docs/decisions/0062");
  list.number("rise_within", o.rise_within, "m", {0, 50},
              "Minimum height from the lowest to the highest sample of a crown within the footprints.")
      .advanced("roof structures that overhang have less: docs/decisions/0062");
  list.number("near_underside", o.near_underside, "m", {0, 50},
              "Maximum distance from a visible underside of what belongs to a crown, over the footprints.")
      .advanced("measured on simulated crowns of odd seeds: docs/decisions/0062");
  list.number("margin", o.margin, "m", {0, 5}, "Width around a crown that does not count as evidence either.")
      .advanced("where a scan smooths the crown into the roof; that of refine.samples_melt");
  return list;
}

auto codes() -> std::vector<base::Code> {
  return {{"vegetation-crowns",
           "Crowns of trees cover part of a roof; what is below them is continued from its surroundings.",
           "Nothing is wrong. To have the surface as it was scanned, set vegetation.mask to false.", 0}};
}

}  // namespace mansard::vegetation
