#!/usr/bin/env bash
# Measures the segmentation's multicut beside two other programs for the same choice and prints the tables of
# docs/bench.md.
#   tools/bench_segment.sh [RESULTS.json [ARGUMENTS OF THE BENCHMARK…]]
#   tools/bench_segment.sh /tmp/b.json --families presets --seeds 1 --limit 60     build/bench/bin/bench_segment --help
# DATA=FOLDER holds the real scans (../shared/data). With all families and the limit of 300 s it takes hours, nearly all
# of them in the baselines; keep the machine quiet.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
results=${1:-${TMPDIR:-/tmp}/mansard-bench-segment.json}
shift || true

tools/setup.sh build bench
cmake --preset bench --log-level=WARNING \
  -DMANSARD_MODULES='base;geometry;rays;solver;model;solid;crs;formats;ingest;block;slice;sweep;fracture;segment;extrude' > /dev/null
cmake --build --preset bench --target bench_segment > /dev/null
build/bench/bin/bench_segment --data "${DATA:-../shared/data}" --out "$results" "$@"
echo "results: $results" >&2
