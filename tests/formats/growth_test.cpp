// Writers do not keep what they have written: the heap grows by a bounded number of bytes a building (docs/formats.md).
#include <gtest/gtest.h>

#include <malloc.h>
#include <algorithm>
#include <filesystem>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/formats/stream.hpp"

namespace {

using namespace cities;
using namespace mansard;
using formats::Format;

/// Bytes on the heap by now, of every library in the process.
auto live_heap() -> double {
  const auto heap = ::mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

/// A gabled house of its own, 20 m from the next.
auto house(std::size_t n) -> Building {
  const double x = 20 * static_cast<double>(n % 100), y = 20 * static_cast<double>(n / 100);
  Building building;
  building.id = "a building with a name of some length, number " + std::to_string(n);
  building.attributes = {{"street", std::string(200, 's')}, {"number", static_cast<std::int64_t>(n)}};
  building.footprint = {rectangle(x, y, 10, 8)};
  building.parts.push_back({building.id + ", part 1",
                            plan_of(building.footprint[0], 0, 9),
                            gable(x, y, 10, 8, 0, 5, 9),
                            {{"ms_h_roof_70p", 8.0}}});
  return building;
}

/// The most that writing `count` houses adds to the heap, the houses themselves aside.
auto most_while_writing(Format format, std::size_t count) -> double {
  const test::Scratch folder;
  double most = 0;
  {
    const double before = live_heap();
    base::Outputs outputs;
    const auto name = format == Format::tiles ? "city" : "city.out";
    auto writer = formats::open_writer(format, folder / name, {{{84800, 447400, 0}, "EPSG:28992"}, {}}, {}, outputs);
    EXPECT_TRUE(writer) << (writer ? "" : to_string(writer.error()));
    for (std::size_t n = 0; writer && n < count; ++n) {
      const auto added = (*writer)->add(house(n));
      if (!added) ADD_FAILURE() << to_string(added.error());
      if (!added) break;
      if (n % 500 == 0) most = std::max(most, live_heap() - before);
    }
    if (writer) {
      EXPECT_TRUE((*writer)->finish());
    }
    most = std::max(most, live_heap() - before);
  }  // not committed: nothing stays
  return most;
}

/// Of every format: what may come once (tables of a fixed size, as they fill), and what comes with every building.
struct Bound {
  Format format;
  const char* name;
  double once, a_building;   ///< bytes
  std::size_t many = 20000;  ///< buildings, against a tenth of them
};

class Growth : public testing::TestWithParam<Bound> {};

TEST_P(Growth, is_bounded_by_what_the_documentation_says) {
  const Bound& bound = GetParam();
  most_while_writing(bound.format, 10);  // libraries set themselves up
  const double growth =
      most_while_writing(bound.format, bound.many) - most_while_writing(bound.format, bound.many / 10);
  const auto more = static_cast<double>(bound.many - bound.many / 10);
  RecordProperty("bytes_a_building", std::to_string(growth / more));
  EXPECT_LT(growth, bound.once + bound.a_building * more) << growth / more << " bytes a building";
}

constexpr double mebibyte = 1 << 20;

INSTANTIATE_TEST_SUITE_P(Formats, Growth,
                         testing::Values(Bound{Format::cityjson, "cityjson", 16 * mebibyte, 100},
                                         Bound{Format::cityjsonseq, "cityjsonseq", 0, 100},
                                         Bound{Format::obj, "obj", 0, 100}, Bound{Format::plans, "plans", 0, 100},
                                         Bound{Format::glb, "glb", 0, 100}, Bound{Format::tiles, "tiles", 0, 400},
                                         Bound{Format::geopackage, "geopackage", 4 * mebibyte, 100, 4000},
                                         Bound{Format::stl, "stl", 0, 100}, Bound{Format::geojson, "geojson", 0, 100}),
                         [](const auto& which) { return std::string(which.param.name); });

}  // namespace
