// bench_segment: the multicut of mansard/segment beside two other programs for the same choice, each block in the same
// run, on one thread, solved by the same CBC. Prints the tables of docs/bench.md; --help says the rest.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "instances.hpp"
#include "mansard/base/files.hpp"
#include "models.hpp"

namespace mansard::bench {
namespace {

using nlohmann::json;

struct Settings {
  double limit = 300;
  std::uint64_t seeds = 5;
  std::vector<std::string> families{"presets", "large", "real"};
  std::vector<std::size_t> large{500, 1000, 2000, 3000};
  std::filesystem::path data = "../shared/data", out, programs;
};

/// How a baseline fared with a block.
struct Attempt {
  double seconds = 0;
  bool is_optimal = false;
  std::optional<double> objective;  ///< of the best point found, thousandths
  double bound = 0;
  std::size_t variables = 0, rows = 0;
};

void write_or_end(const std::filesystem::path& path, const std::string& text) {
  if (const auto written = base::write_files({{path, text}}); !written) {
    std::cerr << base::to_string(written.error()) << "\n";
    std::exit(3);
  }
}

/// For other solvers: the program as FOLDER/<block>-<model>.mps.
void keep(const solver::Program& program, const std::filesystem::path& folder, std::string name,
          const std::string& model) {
  std::ranges::replace(name, '/', '-');
  if (const auto text = solver::mps(program, "MANSARD")) write_or_end(folder / (name + "-" + model + ".mps"), *text);
  else std::cerr << base::to_string(text.error()) << "\n";
}

auto attempt(const solver::Program& program, double limit) -> Attempt {
  Attempt made;
  made.variables = program.variables.size();
  made.rows = program.rows.size();
  const auto start = std::chrono::steady_clock::now();
  const auto solution = solver::minimise(program, {.seconds = limit, .nodes = std::nullopt, .gap = 0.99});
  made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!solution) {
    std::cerr << base::to_string(solution.error()) << "\n";
    return made;
  }
  made.is_optimal = solution->status == solver::Status::optimal;
  made.bound = solution->bound;
  if (!solution->values.empty()) made.objective = solution->objective;
  return made;
}

/// One block, solved by each.
struct Line {
  std::string family, name;
  std::size_t sweep_edges = 0, faces = 0, candidates = 0, conflicts = 0, variables = 0;
  std::string status;
  double objective = 0, bound = 0;  ///< thousandths, of the program
  double choose_seconds = 0, solve_seconds = 0;
  Attempt lean, half;
};

/// What the program's answer costs in it, in thousandths: what every model's objective is compared with.
auto program_objective(const segment::Segmentation& s) -> double {
  const solver::Program program = segment::program_of(s);
  double cost = program.constant;
  std::size_t y = s.candidates.size();
  for (std::size_t i = 0; i < s.candidates.size(); ++i)
    if (s.candidates[i].solved) cost += program.variables[i].cost;
  for (const auto& conflict : s.conflicts) {
    if (!conflict.second) continue;
    if (s.candidates[conflict.first].solved && s.candidates[*conflict.second].solved) cost += program.variables[y].cost;
    ++y;
  }
  return cost;
}

void must_agree(const std::string& name, const std::string& what, double found, double expected) {
  if (std::abs(found - expected) < 0.5) return;
  std::cerr << name << ": the optimum is " << expected << " thousandths, but " << found << " by " << what << "\n";
  std::exit(70);
}

/// Optima that were proven are the same number, and no point found is cheaper.
void compare(const Line& line, const Attempt& attempt, const std::string& what) {
  if (line.status != "optimal") return;
  if (attempt.is_optimal) must_agree(line.name, what, attempt.objective.value_or(NAN), line.objective);
  if (attempt.objective && *attempt.objective < line.objective - 0.5)
    must_agree(line.name, what, *attempt.objective, line.objective);
}

auto measure(const Instance& instance, const Settings& settings) -> Line {
  const segment::Segmentation& s = instance.segmentation;
  Line line;
  line.family = instance.family;
  line.name = instance.name;
  line.sweep_edges = instance.sweep_edges;
  line.faces = instance.inside_faces;
  line.candidates = s.candidates.size();
  line.conflicts = s.conflicts.size();
  line.variables = s.variables;
  line.status = s.status == "empty" ? "optimal" : s.status;
  line.objective = program_objective(s);
  line.bound = line.objective - 1000 * (s.objective - s.bound);
  line.choose_seconds = instance.choose_seconds;
  line.solve_seconds = s.solve_cpu_seconds;
  const solver::Program lean = lean_colours(s), half = half_edges(s);
  if (!settings.programs.empty()) {
    keep(lean, settings.programs, line.name, "colours");
    keep(half, settings.programs, line.name, "half-edges");
  }
  line.lean = attempt(lean, settings.limit);
  line.half = attempt(half, settings.limit);
  compare(line, line.lean, "four colours");
  compare(line, line.half, "half-edges");
  if (const auto tried = by_trying_all(s); tried && line.status == "optimal")
    must_agree(line.name, "trying all", *tried, line.objective);
  std::cerr << line.name << ": " << line.faces << " faces, " << line.solve_seconds << " s, " << line.lean.seconds
            << " s, " << line.half.seconds << " s\n";
  return line;
}

auto in_json(const Attempt& a) -> json {
  json out{{"seconds", a.seconds},
           {"optimal", a.is_optimal},
           {"bound", a.bound},
           {"variables", a.variables},
           {"rows", a.rows}};
  if (a.objective) out["objective"] = *a.objective;
  return out;
}

auto in_json(const Line& l) -> json {
  return {{"family", l.family},
          {"name", l.name},
          {"sweep_edges", l.sweep_edges},
          {"inside_faces", l.faces},
          {"candidates", l.candidates},
          {"conflicts", l.conflicts},
          {"variables", l.variables},
          {"status", l.status},
          {"objective", l.objective},
          {"bound", l.bound},
          {"choose_seconds", l.choose_seconds},
          {"solve_seconds", l.solve_seconds},
          {"lean_colours", in_json(l.lean)},
          {"half_edges", in_json(l.half)}};
}

auto rounded(double value) -> std::string {
  char text[32];
  std::snprintf(text, sizeof text, value >= 99.5 ? "%.0f" : "%.3g", value);
  return text;
}

auto range(const std::vector<Line>& lines, std::size_t Line::*what) -> std::string {
  const auto [least, most] = std::ranges::minmax(lines, {}, what);
  return least.*what == most.*what ? std::to_string(least.*what)
                                   : std::to_string(least.*what) + " … " + std::to_string(most.*what);
}

/// Time of a baseline over all lines, how often it was stopped and how far it was from the end then, and how many times
/// as long it took: at least that where it was stopped.
auto fared(const std::vector<Line>& lines, Attempt Line::*which, double ours) -> std::string {
  double seconds = 0, gap = 0;
  std::size_t stopped = 0, without = 0;
  for (const Line& l : lines) {
    const Attempt& a = l.*which;
    seconds += a.seconds;
    if (a.is_optimal) continue;
    ++stopped;
    if (!a.objective) ++without;
    else gap = std::max(gap, (*a.objective - a.bound) / std::max(1.0, std::abs(*a.objective)));
  }
  std::string text = (stopped > 0 ? "> " : "") + rounded(seconds);
  if (stopped > 0) {
    text += " (" + std::to_string(stopped) + " stopped";
    if (stopped > without) text += ", gap up to " + rounded(100 * gap) + " %";
    if (without > 0) text += ", " + std::to_string(without) + " without a point";
    text += ")";
  }
  return text + " | " + (stopped > 0 ? "≥ " : "") + rounded(seconds / ours) + "×";
}

void print_row(const std::string& title, const std::vector<Line>& lines) {
  double choose = 0, solve = 0;
  std::size_t proven = 0;
  for (const Line& l : lines) {
    choose += l.choose_seconds;
    solve += l.solve_seconds;
    if (l.status == "optimal") ++proven;
  }
  std::cout << "| " << title << " | " << lines.size() << " | " << range(lines, &Line::sweep_edges) << " | "
            << range(lines, &Line::faces) << " | " << rounded(choose) << " | " << rounded(solve) << " | " << proven
            << " | " << fared(lines, &Line::lean, solve) << " | " << fared(lines, &Line::half, solve) << " |\n";
}

void print(const std::vector<Line>& lines, bool with_largest) {
  std::cout << "| | blocks | sweep-edges | faces inside | choose s | of it solve s | proven | four colours s | / solve "
               "| half-edges s | / solve |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (auto at = lines.begin(); at != lines.end();) {
    const auto end = std::find_if(at, lines.end(), [&](const Line& l) { return l.family != at->family; });
    const std::vector<Line> family(at, end);
    print_row(family.front().family, family);
    if (with_largest && family.size() > 1)
      print_row("… its largest", {*std::ranges::max_element(family, {}, &Line::faces)});
    at = end;
  }
  std::cout << "\n" << std::flush;
}

void run(const Settings& settings) {
  segment::Options options;
  options.seconds = settings.limit;
  // Once for nothing: whoever is first pays for loading the solver.
  const Instance first = planted_instance(planted::preset("madrid", 1), "", options);
  (void)attempt(lean_colours(first.segmentation), settings.limit);
  std::vector<Line> all;
  const auto wanted = [&](const std::string& family) { return std::ranges::count(settings.families, family) > 0; };
  const auto finish = [&](std::vector<Line> lines, bool with_largest) {
    print(lines, with_largest);
    all.insert(all.end(), lines.begin(), lines.end());
  };
  if (wanted("presets")) {
    std::vector<Line> lines;
    for (const auto& preset : planted::presets())
      for (std::uint64_t seed = 1; seed <= settings.seeds; ++seed)
        lines.push_back(measure(planted_instance(planted::preset(preset.name, seed), preset.name, options), settings));
    finish(std::move(lines), false);
  }
  if (wanted("large")) {
    std::vector<Line> lines;
    for (const std::size_t faces : settings.large) {
      const auto recipe = planted::large(faces, 1);
      lines.push_back(measure(planted_instance(recipe, recipe.name, options), settings));
    }
    finish(std::move(lines), false);
  }
  if (wanted("real")) {
    std::vector<Line> lines;
    for (const RealInput& input : real_inputs())
      for_each_block(input, settings.data, options,
                     [&](Instance instance) { lines.push_back(measure(instance, settings)); });
    finish(std::move(lines), true);
  }
  if (settings.out.empty()) return;
  json out{{"limit", settings.limit}, {"blocks", json::array()}};
  for (const Line& l : all) out["blocks"].push_back(in_json(l));
  write_or_end(settings.out, out.dump(1) + "\n");
}

}  // namespace
}  // namespace mansard::bench

auto main(int argc, char** argv) -> int {
  mansard::bench::Settings settings;
  CLI::App app("The multicut beside a four-colour program and the reference's half-edge program.");
  app.add_option("--limit", settings.limit, "s for a program of a block; those it stops are marked");
  app.add_option("--seeds", settings.seeds, "planted blocks of each preset");
  app.add_option("--families", settings.families, "of presets, large, real")->delimiter(',');
  app.add_option("--large", settings.large, "faces of the large ones")->delimiter(',');
  app.add_option("--data", settings.data, "folder with the real scans");
  app.add_option("--out", settings.out, "JSON with every block");
  app.add_option("--programs", settings.programs, "folder for the other programs as MPS, for other solvers")
      ->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);
  mansard::base::limit_threads(1);
  mansard::bench::run(settings);
  return 0;
}
