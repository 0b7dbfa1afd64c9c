// Bytes → a point cloud; the first says which format it is taken for. Reading must not throw or run away, must give an
// error of the module's or as many points as it says.
#include <array>
#include <exception>

#include "fuzz/files.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/points.hpp"
#include "mansard/ingest/ingest.hpp"

namespace {

using namespace mansard;
using fuzz::promise;

auto codes() -> const std::vector<base::Code>& {
  static const auto all = fuzz::with_common(ingest::codes());
  return all;
}

void check(const formats::PointCloud& cloud) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < cloud.pieces(); ++i) {
    const auto points = cloud.read(i);
    if (!points) return fuzz::check_error(points.error(), codes());
    promise(points->size() == cloud.points_of(i), "another number of points than a piece has");
    sum += points->size();
  }
  promise(sum == cloud.info().points, "another number of points than the header says");
  const auto inputs = cloud.inputs();
  promise(inputs && !inputs->empty() && inputs->front().sha256.size() == 64, "an input that is not told");
}

}  // namespace

auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int {
  static const fuzz::Folder folder("points");
  static const std::array paths{folder.name("a.laz"), folder.name("a.las"), folder.name("a.copc.laz"),
                                folder.name("a.ply"),
                                // An index of which every part is the same bytes.
                                folder.name("ept/ept.json")};
  static const std::array parts{folder.name("ept/ept-hierarchy/0-0-0-0.json"), folder.name("ept/ept-data/0-0-0-0.laz")};
  static_cast<void>(parts);
  if (size == 0) return 0;
  folder.hold({reinterpret_cast<const char*>(bytes) + 1, size - 1});
  try {
    const auto cloud = formats::open_points(paths[bytes[0] % paths.size()]);
    if (cloud) check(**cloud);
    else fuzz::check_error(cloud.error(), codes());
  } catch (const std::exception& thrown) {
    promise(false, "an exception left the module", [&] { return thrown.what(); });
  }
  return 0;
}
