// segment_exported_blocks OUTDIR: segments planted blocks of many sizes, with many options. Leaves the integer program
// of each as MPS, and in expected.json what the answer costs in it ("objective", thousandths) and what it is said to
// cost ("stated"). judge.mjs has HiGHS solve them again.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "mansard/base/files.hpp"
#include "mansard/segment/segment.hpp"
#include "mansard/solver/solver.hpp"
#include "planted.hpp"

namespace mansard::segment {
namespace {

struct Case {
  planted::Recipe recipe;
  Options options;
};

/// Both of all that there are two of, and all three kinds of GIS edges, in combinations that change with the number.
auto options_of(std::size_t number) -> Options {
  Options options;
  options.thin_rule = (number & 1U) != 0 ? ThinRule::all : ThinRule::unsupported;
  options.thin_reach = (number & 2U) != 0 ? ThinReach::block : ThinReach::face;
  options.continuations = (number & 4U) != 0 ? Continuations::sweep : Continuations::plain;
  options.height_measure = (number & 8U) != 0 ? HeightMeasure::along : HeightMeasure::median;
  constexpr std::array gis{GisEdges::hard, GisEdges::candidate, GisEdges::ignore};
  options.gis_edges = gis[number % gis.size()];
  options.cliques = number / 5 % 2 != 0;
  return options;
}

/// Those that differ from block to block, as on the command line.
auto in_words(Options options) -> std::string {
  const base::OptionList list = option_list(options);
  std::string words;
  for (const std::string_view name :
       {"thin_rule", "thin_reach", "continuations", "height_measure", "gis_edges", "cliques"})
    words += (words.empty() ? "" : " ") + list.find(name)->get();
  return words;
}

/// Every kind of block in four sizes, the sizes of the paper's table 1, and two in a single feature.
auto cases() -> std::vector<Case> {
  using planted::Kind;
  std::vector<planted::Recipe> recipes;
  for (const std::size_t houses : {2, 4, 8, 14})
    for (const auto& [name, kind] : {std::pair("terrace", Kind::terrace), std::pair("perimeter", Kind::perimeter),
                                     std::pair("courtyard", Kind::courtyard), std::pair("towers", Kind::towers),
                                     std::pair("detached", Kind::detached), std::pair("grid", Kind::grid)}) {
      planted::Recipe recipe;
      recipe.name = name;
      recipe.kind = kind;
      recipe.houses = houses;
      recipe.seed = recipes.size() + 1;
      recipes.push_back(recipe);
    }
  for (const planted::Recipe& preset : planted::presets()) recipes.push_back(preset);
  for (const std::size_t faces : {300, 480}) recipes.push_back(planted::large(faces, 1));

  std::vector<Case> cases;
  // There are six kinds: one step more with every size, so that a kind meets other options in every size.
  for (std::size_t i = 0; i < recipes.size(); ++i) cases.push_back({recipes[i], options_of(i + i / 6)});
  return cases;
}

/// What the answer costs, by the program's own costs: s of the candidates, and a y wherever both of a pair are cut.
auto cost_of(const solver::Program& program, const Segmentation& segmentation) -> double {
  std::vector<bool> cut;
  for (const Candidate& c : segmentation.candidates) cut.push_back(c.solved);
  for (const Conflict& conflict : segmentation.conflicts)
    if (conflict.second) cut.push_back(cut[conflict.first] && cut[*conflict.second]);
  double cost = program.constant;
  for (std::size_t i = 0; i < cut.size(); ++i)
    if (cut[i]) cost += program.variables.at(i).cost;
  return cost;
}

struct Exported {
  std::string program;
  nlohmann::ordered_json expected;
};

auto exported(const Case& made, const std::string& name) -> base::Result<Exported> {
  const planted::Block block = planted::make(made.recipe);
  const auto arrangement = planted::fractured(block, made.options);
  const auto answer = choose(arrangement, block.edges, block.block, rays::Scene(block.block.mesh), made.options);
  if (!answer) return answer.error();
  const solver::Program program = program_of(*answer);
  auto text = solver::mps(program, name);
  if (!text) return text.error();
  return Exported{std::move(*text),
                  {{"block", made.recipe.name},
                   {"options", in_words(made.options)},
                   {"faces", std::ranges::count_if(answer->faces, &FaceEvidence::inside)},
                   {"variables", program.variables.size()},
                   {"rows", program.rows.size()},
                   {"status", answer->status},
                   {"objective", std::llround(cost_of(program, *answer))},
                   {"stated", answer->objective},
                   {"candidates", answer->candidates.size()}}};
}

auto export_all(const std::filesystem::path& folder) -> base::Result<void> {
  std::vector<std::pair<std::string, std::string>> texts;
  nlohmann::ordered_json expected;
  for (const Case& made : cases()) {
    const std::string number = std::to_string(texts.size());
    const std::string name = "block" + std::string(number.size() < 2, '0') + number;
    auto result = exported(made, name);
    if (!result) return result.error();
    texts.emplace_back(name + ".mps", std::move(result->program));
    expected[name + ".mps"] = std::move(result->expected);
  }
  texts.emplace_back("expected.json", expected.dump(1) + "\n");
  std::vector<base::FileToWrite> files;
  for (const auto& [name, text] : texts) files.push_back({folder / name, text});
  return base::write_files(files);
}

}  // namespace
}  // namespace mansard::segment

auto main(int count, char** arguments) -> int {
  if (count != 2) {
    std::cerr << "usage: segment_exported_blocks OUTDIR\n";
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  const auto done = mansard::segment::export_all(folder);
  if (!done) std::cerr << mansard::base::to_string(done.error()) << "\n";
  return done ? 0 : 1;
}
