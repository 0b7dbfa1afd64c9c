#!/usr/bin/env bash
# Fuzzes the extrusion kernel and what reads files, each for SECONDS, from fuzz/corpus and what earlier runs have found.
#   tools/fuzz.sh SECONDS [plan_json|extrude|mesh_files|tilesets|models|points|references]
# JOBS is how many sources are compiled at once (2).
# A failure is made smaller and its path printed; copied into fuzz/corpus/<name>/ it is replayed by every test run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:?"SECONDS for each fuzzer"}
targets=(plan_json extrude mesh_files tilesets models points references)
[[ $# -lt 2 ]] || targets=("${@:2}")

tools/setup.sh build clang
cmake --preset fuzz --log-level=WARNING > /dev/null
cmake --build --preset fuzz -j "${JOBS:-2}" --target "${targets[@]/#/fuzz_}"
findings=$PWD/build/fuzz/findings
mkdir -p "$findings"
code=0
for target in "${targets[@]}"; do
  program=build/fuzz/bin/fuzz_$target
  grown=build/fuzz/corpus/$target  # what is new goes here, not into the repository
  mkdir -p "$grown"
  length=2000
  [[ $target == plan_json || $target == extrude ]] || length=20000  # as large as a file with all its parts
  options=(-timeout=60 -rss_limit_mb=4096 -artifact_prefix="$findings/$target-")
  [[ ! -f fuzz/$target.dict ]] || options+=(-dict="fuzz/$target.dict")
  if "$program" "$grown" "fuzz/corpus/$target" -max_total_time="$seconds" -max_len=$length -print_final_stats=1 "${options[@]}"; then
    echo "fuzz: $target: passed"
    continue
  fi
  code=1
  echo "fuzz: $target: failed"
  for crash in "$findings/$target"-{crash,oom,timeout}-*; do
    [[ -e $crash ]] || continue
    "$program" -minimize_crash=1 -max_total_time=60 -exact_artifact_path="$crash.small" "$crash" > /dev/null 2>&1 || true
    [[ -s $crash.small ]] || cp "$crash" "$crash.small"
    echo "fuzz: $target breaks a promise on $crash.small"
    "$program" "$crash.small" 2>&1 | grep -A20 -m1 -E 'broken promise|ERROR|runtime error' || true
  done
done
exit $code
