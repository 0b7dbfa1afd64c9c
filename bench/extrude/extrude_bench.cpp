// How long the extrusion kernel takes, beside CGAL's unweighted straight skeleton of the same polygons in the same run.
// Names are <what>/<shape>/<corners>; every iteration does all polygons of that shape and size, and the counter
// `polygons` says how many that is. tools/bench.sh builds and runs it, tools/bench_plot.py makes tables and the plot.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/extrude/cgal_reference.hpp"
#include "bench/extrude/shapes.hpp"
#include "mansard/base/run.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/numbers.hpp"
#include "mansard/extrude/detail/plane.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "mansard/extrude/detail/sweep.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"

namespace {

using namespace mansard;
using geometry::Ring;
using model::Plan;

using Plans = std::vector<Plan>;

auto corners_of(const Plans& plans) -> double {
  double sum = 0;
  for (const Plan& p : plans) sum += static_cast<double>(p.outer.points.size());
  return sum / static_cast<double>(plans.size());
}

void describe(benchmark::State& state, const Plans& plans) {
  const auto count = static_cast<double>(plans.size());
  state.counters["polygons"] = count;
  state.counters["corners"] = corners_of(plans);
  state.counters["each"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);  // s
}

/// The whole public function: canonical footprint, sweep, rounding, check.
void raise(benchmark::State& state, const Plans& plans) {
  double full = 0;
  for (auto _ : state) {
    full = 0;
    for (const Plan& plan : plans) {
      const auto raised = extrude::raise(plan);
      full += raised && raised->outcome == extrude::Outcome::full ? 1 : 0;
      benchmark::DoNotOptimize(raised);
    }
  }
  describe(state, plans);
  state.counters["full"] = full;
}

/// The part of it that a straight skeleton is: from points to the faces' corners. Counts which tier of the predicates
/// decided.
void sweep(benchmark::State& state, const Plans& plans) {
  extrude::detail::Tiers tiers;
  double moments = 0, broken = 0;
  for (auto _ : state) {
    tiers = {};
    moments = broken = 0;
    for (const Plan& plan : plans) {
      std::string why;
      try {
        const auto source = extrude::detail::prepared(plan);
        const auto footprint = extrude::detail::canonical(source.value(), {}, why);
        if (!footprint) throw extrude::detail::Broken(why);
        const auto surface = extrude::detail::sweep(*footprint, extrude::detail::on_grid(plan.cap), {});
        tiers += surface.planes.tiers();
        moments += static_cast<double>(surface.moments);
      } catch (const extrude::detail::Broken&) {
        ++broken;
      }
    }
  }
  describe(state, plans);
  const auto decisions = static_cast<double>(tiers.filtered + tiers.fixed + tiers.unbounded);
  state.counters["decisions"] = decisions;
  state.counters["fixed"] = static_cast<double>(tiers.fixed) / decisions;
  state.counters["unbounded"] = static_cast<double>(tiers.unbounded) / decisions;
  state.counters["moments"] = moments;
  state.counters["broken"] = broken;
}

/// The check of the solids alone.
void check(benchmark::State& state, const Plans& plans) {
  std::vector<model::Solid> solids;
  for (const Plan& plan : plans) {
    auto raised = extrude::raise(plan);
    if (raised) solids.push_back(std::move(raised->solid));
  }
  for (auto _ : state)
    for (const auto& solid : solids) benchmark::DoNotOptimize(solid::check(solid));
  describe(state, plans);
}

void cgal(benchmark::State& state, const Plans& plans) {
  double refused = 0;
  for (auto _ : state) {
    refused = 0;
    for (const Plan& plan : plans) refused += bench::nodes_of_cgal_skeleton(plan.outer.points) == 0 ? 1 : 0;
  }
  describe(state, plans);
  state.counters["refused"] = refused;
}

/// Many small plans on all cores, as a city is extruded.
void in_parallel(benchmark::State& state, const Plans& plans) {
  std::vector<double> volumes(plans.size());
  for (auto _ : state)
    base::parallel_for(plans.size(), [&](std::size_t i) {
      const auto raised = extrude::raise(plans[i]);
      volumes[i] = raised ? solid::volume(raised->solid) : 0;
    });
  benchmark::DoNotOptimize(volumes);
  describe(state, plans);
}

using Work = void (*)(benchmark::State&, const Plans&);

/// Plans are made when the benchmark runs, so that a filter does not pay for the others.
void add(const std::string& name, Work work, const std::function<Plans()>& make, bool wall_clock = false) {
  auto* made =
      benchmark::RegisterBenchmark(name.c_str(), [work, make](benchmark::State& state) { work(state, make()); });
  made->Unit(benchmark::kMillisecond);
  if (wall_clock) made->UseRealTime();
}

struct Shape {
  std::string name;
  Ring (*make)(base::Random&, std::size_t);
};
const std::vector<Shape> shapes{
    {"star", bench::star},
    {"generic", [](base::Random& r, std::size_t n) { return bench::jittered(r, bench::grid(r, n)); }},
    {"tied", bench::grid},
    {"tied_turned", [](base::Random& r, std::size_t n) { return bench::turned(bench::grid(r, n), 0.3); }},
};

/// Polygons of one size in an iteration: fewer of the large ones.
auto count_of(std::size_t corners) -> std::size_t {
  return corners <= 64 ? 16 : corners <= 256 ? 8 : corners <= 1000 ? 3 : 1;
}

void add_all() {
  // `tied` and `generic` of one seed are the same outline, before and after the corners were moved.
  for (const Shape& shape : shapes) {
    for (const std::size_t corners : {16, 64, 256, 1000, 5000}) {
      const auto rings = [shape, corners] {
        std::vector<Ring> made;
        for (std::size_t i = 0; i < count_of(corners); ++i) {
          base::Random random(1 + i);
          made.push_back(shape.make(random, corners));
        }
        return made;
      };
      const auto hips = [rings] {
        Plans plans;
        for (Ring& ring : rings()) plans.push_back(bench::plan_of(std::move(ring), bench::hip));
        return plans;
      };
      const auto mixed = [rings] {
        Plans plans;
        base::Random random(7);
        for (Ring& ring : rings()) plans.push_back(bench::mixed_plan_of(random, std::move(ring)));
        return plans;
      };
      const std::string at = "/" + shape.name + "/" + std::to_string(corners);
      if (at != "/tied_turned/5000") add("cgal" + at, cgal, hips);  // takes minutes there
      add("hip_sweep" + at, sweep, hips);
      add("hip" + at, raise, hips);
      add("hip_check" + at, check, hips);
      add("mixed_sweep" + at, sweep, mixed);
      add("mixed" + at, raise, mixed);
    }
  }

  const auto many = [](std::size_t count, auto ring, auto plan) {
    return [=] {
      Plans plans;
      base::Random random(11);
      for (std::size_t i = 0; i < count; ++i) plans.push_back(plan(random, ring(random)));
      return plans;
    };
  };
  const auto all_mansard = [](base::Random&, Ring ring) { return bench::plan_of(std::move(ring), bench::mansard, 12); };
  const auto all_hip = [](base::Random&, Ring ring) { return bench::plan_of(std::move(ring), bench::hip); };
  const auto houses = many(200, bench::house, all_mansard);
  add("house_sweep", sweep, houses);
  add("house_check", check, houses);
  add("house", raise, houses);
  add("house_mixed", raise, many(200, bench::house, bench::mixed_plan_of));
  add("house_cgal", cgal, houses);
  add("footprints", raise, many(1000, bench::small_footprint, all_hip));
  add("footprints_all_cores", in_parallel, many(1000, bench::small_footprint, all_hip), true);
}

}  // namespace

auto main(int argc, char** argv) -> int {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
