#include "mansard/formats/copc/hierarchy.hpp"

#include <array>
#include <cmath>
#include <set>

#include "mansard/formats/las/las_header.hpp"

namespace mansard::formats {
namespace {

struct Page {
  std::uint64_t offset = 0, bytes = 0;
};

}  // namespace

auto read_copc_hierarchy(std::string_view info, const RangeFile& file, const std::string& name)
    -> base::Result<CopcHierarchy> {
  const auto bad = [&](const std::string& what) { return base::error("ingest-points-format", what, name); };
  if (info.size() < 56) return bad("its record is cut off");
  const geometry::Point3 centre{number_at<double>(info, 0), number_at<double>(info, 8), number_at<double>(info, 16)};
  const auto half = number_at<double>(info, 24);
  if (!std::isfinite(centre.x) || !std::isfinite(centre.y) || !std::isfinite(centre.z) || !std::isfinite(half) ||
      half <= 0)
    return bad("its cube is not finite");

  CopcHierarchy out;
  constexpr std::size_t entry = 32;
  std::vector<Page> open{{number_at<std::uint64_t>(info, 40), number_at<std::uint64_t>(info, 48)}};
  std::set<std::uint64_t> seen;
  std::set<std::array<std::int32_t, 4>> keys;
  while (!open.empty()) {
    const Page page = open.back();
    open.pop_back();
    if (page.bytes > file.size() || page.offset > file.size() - page.bytes)
      return bad("a page is beyond the file's end");
    if (page.bytes % entry != 0) return bad("a page is cut off");
    if (!seen.insert(page.offset).second) return bad("a page is named twice");
    const auto bytes = file.read(page.offset, page.bytes);
    if (!bytes) return bytes.failure();
    for (std::size_t at = 0; at + entry <= bytes->view().size(); at += entry) {
      const auto row = bytes->view().substr(at, entry);
      const std::array<std::int32_t, 4> key{number_at<std::int32_t>(row, 0), number_at<std::int32_t>(row, 4),
                                            number_at<std::int32_t>(row, 8), number_at<std::int32_t>(row, 12)};
      const auto offset = number_at<std::uint64_t>(row, 16);
      const auto size = number_at<std::int32_t>(row, 24), points = number_at<std::int32_t>(row, 28);
      const std::string node = std::to_string(key[0]) + "-" + std::to_string(key[1]) + "-" + std::to_string(key[2]) +
                               "-" + std::to_string(key[3]);
      if (key[0] < 0 || key[0] > 30) return bad("node " + node + " has no such level");
      for (std::size_t axis = 1; axis < 4; ++axis)
        if (key[axis] < 0 || key[axis] >= 1 << key[0]) return bad("node " + node + " is outside its level");
      if (size < 0 || static_cast<std::uint64_t>(size) > file.size() ||
          offset > file.size() - static_cast<std::uint64_t>(size))
        return bad("node " + node + " is beyond the file's end");
      if (points == -1) {
        open.push_back({offset, static_cast<std::uint64_t>(size)});
        continue;
      }
      if (points < -1) return bad("node " + node + " has " + std::to_string(points) + " points");
      if (!keys.insert(key).second) return bad("node " + node + " is listed twice");
      const double side = std::ldexp(2 * half, -key[0]), margin = side / 1000;
      const geometry::Point3 least{centre.x - half + side * key[1] - margin, centre.y - half + side * key[2] - margin,
                                   centre.z - half + side * key[3] - margin};
      const double reach = side + 2 * margin;
      out.nodes.push_back({offset,
                           static_cast<std::uint64_t>(size),
                           static_cast<std::uint64_t>(points),
                           {least, {least.x + reach, least.y + reach, least.z + reach}}});
    }
  }
  return out;
}

}  // namespace mansard::formats
