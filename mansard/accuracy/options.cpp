#include "mansard/accuracy/accuracy.hpp"

namespace mansard::accuracy {

auto option_list(Options& options) -> base::OptionList {
  base::OptionList list("accuracy");
  auto& o = options;
  constexpr const char* measured = "measured per block: docs/accuracy.md";
  list.number("noise", o.noise, "m", {0, 10},
              "Standard deviation of the scan along the normal of its surfaces; measured where it is not given.")
      .source(measured)
      .number("correlated_area", o.correlated_area, "m²", {1e-6, 1e4},
              "Area over which the noise of the scan counts as one error; measured where it is not given.")
      .source(measured)
      .number("spacing", o.spacing, "m", {1e-3, 100},
              "Nominal spacing of the points or vertices of the scan; measured where it is not given.")
      .source(measured)
      .number("blur", o.blur, "m", {0, 10},
              "Standard deviation of the smoothing by which the scan rounds edges and steps; measured where it is not "
              "given.")
      .source(measured)
      .number("edge_noise", o.edge_noise, "m", {0, 10},
              "Standard deviation of where the scan shows a straight edge, along it; measured where it is not given.")
      .source(measured)
      .number("walls", o.walls, "", {0, 1},
              "Share of the height of the walls that the scan shows; measured where it is not given.")
      .source(measured)
      .number("offset_x", o.offset_x, "m", {-100, 100},
              "Eastward offset of the scan from the footprints; measured where it is not given.")
      .source(measured)
      .number("offset_y", o.offset_y, "m", {-100, 100},
              "Northward offset of the scan from the footprints; measured where it is not given.")
      .source(measured)
      .number("offset_spread", o.offset_spread, "m", {0, 100},
              "Standard deviation of that offset from wall to wall; measured where it is not given.")
      .source(measured);
  return list;
}

}  // namespace mansard::accuracy
