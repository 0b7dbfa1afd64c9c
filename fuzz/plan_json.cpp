// Bytes → the reader of plan + profiles. It must not throw, must give an error with a code of its module or a city, and
// a city that was read must come back the same from its own text.
#include <algorithm>
#include <exception>
#include <string>
#include <string_view>

#include "fuzz/files.hpp"
#include "mansard/formats/plans.hpp"

namespace {

using namespace mansard;
using fuzz::promise;

auto read(std::string_view bytes) -> base::Result<model::City> {
  static const fuzz::MemoryFile file;
  file.hold(bytes);
  return formats::read_plans(file.path());
}

}  // namespace

auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int {
  try {
    const auto city = read({reinterpret_cast<const char*>(bytes), size});
    if (!city) {
      promise(city.error().code.starts_with("write-plan-"), "an error that is not the reader's",
              [&] { return base::to_string(city.error()); });
      promise(!city.error().message.empty(), "an error that says nothing");
      return 0;
    }
    const std::string text = formats::plans(*city);
    const auto again = read(text);
    promise(again.has_value(), "what was written is not read", [&] { return base::to_string(again.error()) + text; });
    promise(formats::plans(*again) == text, "what was written and read is written differently", [&] { return text; });
    promise(std::ranges::equal(
                city->buildings, again->buildings, {}, [](const auto& building) { return building.parts.size(); },
                [](const auto& building) { return building.parts.size(); }),
            "parts were lost");
    for (std::size_t b = 0; b < city->buildings.size(); ++b)
      for (std::size_t p = 0; p < city->buildings[b].parts.size(); ++p)
        promise(city->buildings[b].parts[p].plan == again->buildings[b].parts[p].plan, "a plan changed on its way");
  } catch (const std::exception& thrown) {
    promise(false, "an exception left the module", [&] { return thrown.what(); });
  }
  return 0;
}
