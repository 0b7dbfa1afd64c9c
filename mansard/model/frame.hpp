// The local metric frame, and the files that a result was made from.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace mansard::model {

/// From local to file coordinates: add the origin. The origin is whole metres, so that adding and taking off is exact
/// for coordinates that are multiples of 2^-20 m, and for every coordinate at least as far from zero as from the
/// origin.
struct Frame {
  std::array<std::int64_t, 3> origin{0, 0, 0};
  std::string crs;  ///< "EPSG:n" where known, WKT otherwise, empty for a local frame
};

struct InputFile {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

}  // namespace mansard::model
