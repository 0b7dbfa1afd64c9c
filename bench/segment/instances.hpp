// What is measured: planted blocks, and blocks of real scans. Both go through the modules as the pipeline takes them.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mansard/segment/segment.hpp"
#include "planted.hpp"

namespace mansard::bench {

struct Instance {
  std::string family, name;
  std::size_t sweep_edges = 0, inside_faces = 0;
  segment::Segmentation segmentation;
  double choose_seconds = 0;  ///< of segment::choose, with measuring
};

[[nodiscard]] auto planted_instance(const planted::Recipe& recipe, const std::string& family,
                                    const segment::Options& options) -> Instance;

/// A scan and its footprints, as tools/real_inputs.sh lists them.
struct RealInput {
  std::string name;
  std::filesystem::path mesh, footprints;  ///< under the folder with the data
  std::array<double, 3> mesh_offset{0, 0, 0};
};
[[nodiscard]] auto real_inputs() -> std::vector<RealInput>;

/// Calls `use` with every block of the input. Ends the program where the input cannot be read or a block not segmented.
void for_each_block(const RealInput& input, const std::filesystem::path& data, const segment::Options& options,
                    const std::function<void(Instance)>& use);

}  // namespace mansard::bench
