#include "mansard/cloud/classes.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "mansard/base/text.hpp"

namespace mansard::cloud {
namespace {

constexpr std::size_t none = 256;

/// The numbers of a list with commas; none where something else is in it.
auto numbers_in(std::string_view list) -> std::optional<std::vector<std::uint8_t>> {
  std::vector<std::uint8_t> out;
  while (!list.empty()) {
    auto end = std::min(list.find(','), list.size());
    auto word = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (word.starts_with(' ')) word.remove_prefix(1);
    while (word.ends_with(' ')) word.remove_suffix(1);
    std::uint8_t number = 0;
    const auto [at, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || at != word.data() + word.size()) return std::nullopt;
    out.push_back(number);
  }
  return out;
}

/// What a class is used for, in words.
auto in_words(Use use) -> std::string_view {
  switch (use) {
    case Use::terrain: return "the ground";
    case Use::buildings: return "buildings";
    case Use::surface: return "surface";
    case Use::vegetation:
    case Use::wires:
    case Use::outliers: return "left out";
    case Use::undecided: break;
  }
  return "surface where buildings are found by shape";
}

template <class Take>
void each_by_count(const std::array<std::uint64_t, 256>& counts, Take take) {
  std::vector<std::size_t> order;
  for (std::size_t c = 0; c < counts.size(); ++c)
    if (counts[c] > 0) order.push_back(c);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t c) { return counts[c]; });
  for (const auto c : order) take(static_cast<std::uint8_t>(c), counts[c]);
}

}  // namespace

auto class_map(const Options& options) -> base::Result<ClassMap> {
  ClassMap map{};
  for (std::size_t c = 0; c < map.size(); ++c) map[c] = static_cast<std::uint8_t>(c);
  struct List {
    const char* option;
    const std::string& classes;
    std::uint8_t as;
  };
  const std::array lists{List{"cloud.building_classes", options.building_classes, building},
                         List{"cloud.ground_classes", options.ground_classes, ground},
                         List{"cloud.left_out_classes", options.left_out_classes, noise}};
  map[building] = map[ground] = unclassified;
  std::array<std::size_t, 256> in{};
  in.fill(none);
  for (std::size_t k = 0; k < lists.size(); ++k) {
    const auto& [option, classes, as] = lists[k];
    const auto numbers = numbers_in(classes);
    if (!numbers)
      return base::error("option-value",
                         "'" + classes +
                             "' is not a list of classes; expected numbers from 0 to 255 "
                             "with commas between them, such as 6,67",
                         option);
    for (const auto number : *numbers) {
      if (in[number] != none && in[number] != k)
        return base::error(
            "option-value",
            "class " + std::to_string(number) + " is in " + lists[in[number]].option + ", too; give it once", option);
      in[number] = k;
      map[number] = as;
    }
  }
  return map;
}

auto any_ground(const std::array<std::uint64_t, 256>& counts) -> bool {
  for (std::size_t c = 0; c < counts.size(); ++c)
    if (const auto use = use_of(static_cast<std::uint8_t>(c));
        counts[c] > 0 && (use == Use::terrain || use == Use::surface))
      return true;
  return false;
}

auto class_name(std::uint8_t classification) -> std::string_view {
  switch (classification) {
    case 0: return "never classified";
    case 1: return "unclassified";
    case 2: return "ground";
    case 3: return "low vegetation";
    case 4: return "medium vegetation";
    case 5: return "high vegetation";
    case 6: return "building";
    case 7: return "low noise";
    case 8: return "model key point";
    case 9: return "water";
    case 10: return "rail";
    case 11: return "road";
    case 12: return "overlap";
    case 13: return "wire guard";
    case 14: return "wire";
    case 15: return "transmission tower";
    case 16: return "wire connector";
    case 17: return "bridge deck";
    case 18: return "high noise";
    case 19: return "overhead structure";
    case 20: return "ignored ground";
    case 21: return "snow";
    case 22: return "temporal exclusion";
    case 26: return "civil structure";  // of AHN
    default: return {};
  }
}

auto classes_in_words(const std::array<std::uint64_t, 256>& counts, const ClassMap& map) -> std::string {
  std::uint64_t all = 0;
  for (const auto count : counts) all += count;
  std::string out;
  each_by_count(counts, [&](std::uint8_t c, std::uint64_t count) {
    const auto name = class_name(c);
    out += (out.empty() ? "" : ", ") + std::to_string(c) + (name.empty() ? "" : " " + std::string(name)) + " " +
           base::to_text(100 * static_cast<double>(count) / static_cast<double>(all), 1) + " % (" +
           std::string(in_words(use_of(map[c]))) + ")";
  });
  return out;
}

auto unknown_classes(const std::array<std::uint64_t, 256>& counts, const ClassMap& map) -> std::string {
  std::string out;
  each_by_count(counts, [&](std::uint8_t c, std::uint64_t count) {
    if (map[c] == c && class_name(c).empty())
      out += (out.empty() ? "" : ", ") + std::to_string(c) + " (" + std::to_string(count) + " points)";
  });
  return out;
}

}  // namespace mansard::cloud
