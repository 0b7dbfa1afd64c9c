// How well the readings of the model recover what was planted. Prints a table, a line for every combination:
//   bench_readings FIRST_SEED LAST_SEED [OPTION=VALUE,VALUE…]…     bench_readings 1 5 height_weight=1,8,16
//   thin_rule=all
// OPTION is one of segment's. Every kind of block with every seed, once with a feature for each house and once with one
// feature for all.
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/run.hpp"
#include "planted.hpp"
#include "score.hpp"

namespace {

using namespace mansard;

struct Grid {
  std::string name;
  std::vector<std::string> values;
};

auto grid_of(std::string_view word) -> std::optional<Grid> {
  const auto equals = word.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  Grid grid{std::string(word.substr(0, equals)), {}};
  for (auto rest = word.substr(equals + 1); !rest.empty();) {
    const auto comma = std::min(rest.find(','), rest.size());
    grid.values.emplace_back(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return grid;
}

struct Setting {
  std::string name;
  segment::Options options;
};

auto product(const std::vector<Grid>& grids) -> std::optional<std::vector<Setting>> {
  std::vector<Setting> settings{{"", {}}};
  for (const Grid& grid : grids) {
    std::vector<Setting> more;
    for (const Setting& setting : settings)
      for (const auto& value : grid.values) {
        Setting next{setting.name + "| " + value + " ", setting.options};
        const auto list = segment::option_list(next.options);
        const auto* option = list.find(grid.name);
        if (option == nullptr || !option->set(value)) {
          std::fprintf(stderr, "no such option or value: %s=%s\n", grid.name.c_str(), value.c_str());
          return std::nullopt;
        }
        more.push_back(std::move(next));
      }
    settings = std::move(more);
  }
  return settings;
}

/// Means over blocks.
struct Sum {
  double f1 = 0, walls = 0, false_splits = 0, rand = 0;
  std::size_t blocks = 0, proven = 0;
};

void add(Sum& sum, const planted::Score& score, const segment::Segmentation& segmentation) {
  const double both = score.parts.recall + score.parts.precision;
  sum.f1 += both > 0 ? 2 * score.parts.recall * score.parts.precision / both : 0;
  sum.walls += score.wall_recall;
  sum.false_splits += score.false_splits;
  sum.rand += score.rand;
  ++sum.blocks;
  sum.proven += segmentation.status == "optimal" ? 1 : 0;
}

auto measured(const planted::Recipe& recipe, const std::vector<Setting>& settings, std::vector<Sum>& sums) -> bool {
  const auto planted = planted::make(recipe);
  const rays::Scene mesh(planted.block.mesh);
  const auto truth = planted::plan_of(planted);
  std::vector<char> failed(settings.size(), 0);
  base::parallel_for(settings.size(), [&](std::size_t i) {
    const auto arrangement = planted::fractured(planted, settings[i].options);
    const auto found = segment::choose(arrangement, planted.edges, planted.block, mesh, settings[i].options);
    if (found) add(sums[i], planted::score(truth, planted::plan_of(found->parts)), *found);
    failed[i] = found ? 0 : 1;
  });
  return std::ranges::count(failed, 1) == 0;
}

auto number_of(const char* text) -> std::optional<std::uint64_t> {
  std::uint64_t value = 0;
  const std::string_view word(text);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

auto main(int argc, char** argv) -> int {
  const auto first = argc > 2 ? number_of(argv[1]) : std::nullopt, last = argc > 2 ? number_of(argv[2]) : std::nullopt;
  std::vector<Grid> grids;
  for (int i = 3; i < argc; ++i) {
    auto grid = grid_of(argv[i]);
    if (!grid) break;
    grids.push_back(std::move(*grid));
  }
  if (!first || !last || grids.size() + 3 != static_cast<std::size_t>(std::max(argc, 3))) {
    std::fprintf(stderr, "usage: bench_readings FIRST_SEED LAST_SEED [OPTION=VALUE,VALUE…]…\n");
    return 2;
  }
  const auto settings = product(grids);
  if (!settings) return 2;

  const std::vector<std::pair<planted::Kind, std::size_t>> kinds{
      {planted::Kind::terrace, 10}, {planted::Kind::perimeter, 14}, {planted::Kind::courtyard, 8},
      {planted::Kind::towers, 8},   {planted::Kind::detached, 8},   {planted::Kind::grid, 12}};
  std::vector<Sum> by_house(settings->size()), by_block(settings->size());
  for (const auto& [kind, houses] : kinds)
    for (std::uint64_t seed = *first; seed <= *last; ++seed)
      for (const auto features : {planted::Features::per_house, planted::Features::per_block}) {
        planted::Recipe recipe;
        recipe.kind = kind;
        recipe.houses = houses;
        recipe.seed = seed;
        recipe.features = features;
        if (!measured(recipe, *settings, features == planted::Features::per_house ? by_house : by_block)) return 1;
      }

  for (const Grid& grid : grids) std::printf("| %s ", grid.name.c_str());
  std::printf(
      "| F1 | walls found | false m a m | Rand | F1, one feature | walls found | false m a m | Rand | proven |\n");
  for (std::size_t i = 0; i < grids.size() + 9; ++i) std::printf("|---");
  std::printf("|\n");
  for (std::size_t i = 0; i < settings->size(); ++i) {
    std::printf("%s", (*settings)[i].name.c_str());
    for (const Sum& sum : {by_house[i], by_block[i]}) {
      const auto n = static_cast<double>(sum.blocks);
      std::printf("| %.3f | %.3f | %.2f | %.3f ", sum.f1 / n, sum.walls / n, sum.false_splits / n, sum.rand / n);
    }
    std::printf("| %zu of %zu |\n", by_house[i].proven + by_block[i].proven, by_house[i].blocks + by_block[i].blocks);
  }
  return 0;
}
