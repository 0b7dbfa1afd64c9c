#!/usr/bin/env bash
# Measures the extrusion kernel beside CGAL's straight skeleton and prints the tables of docs/bench.md.
#   tools/bench.sh [RESULTS.json [ARGUMENTS OF THE BENCHMARK…]]     tools/bench.sh /tmp/b.json --benchmark_filter=house
# PLOT=docs/pictures/extrude-bench.svg tools/bench.sh  draws the plot too. Takes about ten minutes; keep the machine quiet.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
results=${1:-${TMPDIR:-/tmp}/mansard-bench.json}
shift || true

tools/setup.sh
cmake --preset bench --log-level=WARNING > /dev/null
cmake --build --preset bench --target bench_extrude > /dev/null
# Three times, in random order, so that a busy moment does not fall on one side of a ratio; the tables take the best.
build/bench/bin/bench_extrude --benchmark_repetitions=3 --benchmark_enable_random_interleaving=true \
  --benchmark_min_time=0.2 --benchmark_out="$results" --benchmark_out_format=json "$@" > /dev/null
echo "results: $results" >&2
tools/bench_plot.py "$results" ${PLOT:+"$PLOT"}
