#!/usr/bin/env bash
# Measures the extrusion kernel beside CGAL's straight skeleton and prints the tables of docs/bench.md.
#   tools/bench.sh [RESULTS.json [ARGUMENTS OF THE BENCHMARK…]]     tools/bench.sh /tmp/b.json --benchmark_filter=house
# PLOT=docs/pictures/extrude-bench.svg tools/bench.sh  draws the plot too. Takes five minutes; keep the machine quiet.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
results=${1:-${TMPDIR:-/tmp}/mansard-bench.json}
shift || true

tools/setup.sh build bench
cmake --preset bench --log-level=WARNING > /dev/null
cmake --build --preset bench --target bench_extrude > /dev/null
# CGAL takes seconds to minutes for one polygon of 5,000 corners: those that it takes minutes for are left out. With
# --benchmark_repetitions=3 --benchmark_enable_random_interleaving=true the tables take the best of three, in an hour.
some='^[a-z_]+/(generic|tied|tied_turned|star)/(16|64|256)$|^[a-z_]+/(generic|tied|star)/1000$|house|footprints|.*/(generic|tied)/5000$'
build/bench/bin/bench_extrude --benchmark_min_time=0.1 --benchmark_filter="$some" \
  --benchmark_out="$results" --benchmark_out_format=json "$@" > /dev/null
echo "results: $results" >&2
tools/bench_plot.py "$results" ${PLOT:+"$PLOT"}
