#!/usr/bin/env bash
# The long runs, which are not part of `make test`: tools/nightly.sh [LANE…]; without LANE all of them, in this order.
#   debug       compiled without optimisation, with the standard library's assertions: all tests but those in browsers
#   asan        address and undefined behaviour sanitizers in the whole program: all tests but those in browsers
#   clang       compiled with clang 16: all tests but those in browsers
#   firefox     the tests of the workbench in Debian's Firefox: all that run in Chromium, where a test run has some of them
#   headers     every header compiles alone: tools/check_headers.sh --all
#   tidy        clang-tidy with the checks of .clang-tidy over all modules: tools/tidy.sh
#   fuzz        every fuzzer for FUZZ_SECONDS (600)
#   properties  the guarantees of docs/extrude.md over RUNS (100000) random plans from SEED (the date), where a test run takes
#               5,000. Every failing plan is reduced and written to tests/extrude/fixtures, which every test run replays
#   kills       runs killed at KILLS (1000) random moments, where a test run has 50: results have the bytes of an undisturbed run
#   fixed_point models of data and of simulated blocks, scanned perfectly and reconstructed again, have the same planes and
#               volume: tools/fixed_point.py. Models and lists of the buildings that differ: build/nightly/fixed_point
#   outlines    OUTLINES (30000) random footprints of every ugly kind extruded: tools/outlines.py. Files with a fault:
#               build/nightly/outlines
#   clean       `make demo` and `make test` in a new Debian 12: tools/clean_debian.sh, as root. CLEAN has its options, for
#               example CLEAN="--ccache /var/cache/ccache"
# The tests in browsers (ctest's label `browser`) test the page, which is the same whatever compiled the program. They run in the
# lanes `firefox` and `clean`, and in `make test`.
# JOBS is how many compilers, tests or checks run at once; without it as many as the machine has room for.
# UNTIL=HH:MM (today) is for a run with little time: debug, asan and clang build and run the tests of one module after another,
# and begin no module after that time. Their row says which modules were tested.
# A lane replaces its row of docs/nightly.md; the others keep what they say. Logs: build/nightly/LANE.log. Exit code 1 when a
# lane fails.
set -euo pipefail
{  # bash reads all of it before it begins: the checkout may change meanwhile
cd "$(dirname "${BASH_SOURCE[0]}")/.."
all=(debug asan clang firefox headers tidy fuzz properties kills fixed_point outlines clean)
declare -A meaning=(
  [debug]="not optimised, standard library's assertions: all tests but those in browsers"
  [asan]="address and undefined behaviour sanitizers: all tests but those in browsers"
  [clang]="compiled with clang 16: all tests but those in browsers"
  [firefox]="the workbench in Firefox: all tests that run in Chromium"
  [headers]="every header compiles alone"
  [tidy]="clang-tidy over all modules: one result a source"
  [fuzz]="each fuzzer for ${FUZZ_SECONDS:=600} s"
  [properties]="extrusion kernel: ${RUNS:=100000} random plans"
  [kills]="runs killed at ${KILLS:=1000} random moments"
  [fixed_point]="models scanned perfectly and reconstructed again have the same planes and volume: one result an input"
  [outlines]="${OUTLINES:=30000} random footprints of every ugly kind, in every format: one result a file"
  [clean]="\`make demo\` and \`make test\` in a new Debian 12")
lanes=("$@")
[[ $# -gt 0 ]] || lanes=("${all[@]}")
for lane in "${lanes[@]}"; do
  [[ -n ${meaning[$lane]:-} ]] || { echo "nightly: unknown lane '$lane'; expected ${all[*]}" >&2; exit 2; }
done
page=docs/nightly.md
logs=$PWD/build/nightly
mkdir -p "$logs"
jobs=${JOBS:-$(make -s jobs)}

# ---- the lanes
all_tests() {  # preset, further packages
  tools/setup.sh build test package "${@:2}" && cmake --preset "$1" --log-level=WARNING || return
  if [[ -n ${UNTIL:-} ]]; then
    tests_by_module "$1"
  else
    cmake --build --preset "$1" -j "$jobs" && ctest --preset "$1" --no-tests=error -j "$jobs" -LE browser
  fi
}
tests_by_module() {  # preset
  local module modules=() code=0
  while read -r module; do [[ ! -d tests/$module ]] || modules+=("$module"); done \
    < <(sed -nE 's/^mansard_module\((\w+).*/\1/p' cmake/modules.cmake; echo cli)
  for module in "${modules[@]}"; do
    [[ $(date +%H:%M) < $UNTIL ]] || { echo "nightly: it is $UNTIL: no more modules"; return $code; }
    cmake --build --preset "$1" -j "$jobs" --target "test_$module" || { echo "nightly: $module: not built"; code=1; continue; }
    echo "nightly: $module: tested"
    ctest --preset "$1" --no-tests=error -j "$jobs" -LE browser -R "^$module\\." || code=1
  done
  [[ $(date +%H:%M) < $UNTIL ]] || return $code
  cmake --build --preset "$1" -j "$jobs" || return
  echo "nightly: others: tested"
  ctest --preset "$1" -j "$jobs" -LE browser -E "^($(IFS='|'; echo "${modules[*]}"))\\." || code=1
  return $code
}
# What the lane was, where not all tests are in its log.
meaning_of() {  # lane
  local tested
  tested=$(sed -nE 's/^nightly: (\w+): tested$/`\1`/p' "$logs/$1.log")
  if [[ -z ${UNTIL:-} || ! $1 =~ ^(debug|asan|clang)$ || $tested == *'`others`' ]]; then
    echo "${meaning[$1]}"
  else
    echo "${meaning[$1]/all tests but those in browsers/the tests of ${tested//$'\n'/, } only, in a run that had until $UNTIL}"
  fi
}
run_debug() { all_tests debug; }
run_asan() { all_tests asan; }
run_clang() { all_tests clang clang; }
run_firefox() {
  tools/setup.sh build test firefox && cmake --preset release --log-level=WARNING &&
    cmake --build --preset release --target mansard -j "$jobs" || return
  MANSARD_BINARY=$PWD/build/release/bin/mansard MANSARD_DATA=$PWD/data \
    apps/workbench/tests/run.sh firefox build/release/apps/server/page/workbench
}
run_headers() { tools/setup.sh build python && JOBS=$jobs tools/check_headers.sh --all; }
run_tidy() { JOBS=$jobs tools/tidy.sh; }
run_fuzz() { JOBS=$jobs tools/fuzz.sh "$FUZZ_SECONDS"; }
run_properties() {
  tools/setup.sh build test && cmake --preset release --log-level=WARNING &&
    cmake --build --preset release --target test_extrude -j "$jobs" || return
  local shard pids=() code=0
  export MANSARD_RUNS=$RUNS MANSARD_KEEP_FAILURES=1
  export RC_PARAMS="seed=${SEED:-$(date +%Y%m%d)}"  # a failure says which seed repeats it
  echo "$RUNS random plans, $RC_PARAMS, $jobs at once"
  for ((shard = 0; shard < jobs; ++shard)); do
    GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$shard build/release/bin/test_extrude \
      --gtest_filter='Guarantee.*:*SharedPolygons*:*Fixture*' > "$logs/properties-$shard.log" 2>&1 &
    pids+=($!)
  done
  for pid in "${pids[@]}"; do wait "$pid" || code=1; done
  for ((shard = 0; shard < jobs; ++shard)); do cat "$logs/properties-$shard.log"; done
  return $code
}
run_kills() {
  tools/setup.sh build test && cmake --preset release --log-level=WARNING &&
    cmake --build --preset release --target test_cli -j "$jobs" &&
    MANSARD_KILLS=$KILLS build/release/bin/test_cli --gtest_filter='Resume*.*kills*'
}
run_fixed_point() {
  tools/setup.sh build && cmake --preset release --log-level=WARNING &&
    cmake --build --preset release --target mansard -j "$jobs" &&
    tools/fixed_point.py build/release/bin/mansard "$logs/fixed_point" data/hall data/delft data/b9 \
      {terrace,perimeter,courtyard,towers,detached}:{1,3,5}
}
run_outlines() {
  tools/setup.sh build && cmake --preset release --log-level=WARNING &&
    cmake --build --preset release --target mansard -j "$jobs" &&
    tools/outlines.py build/release/bin/mansard "$logs/outlines" --count "$OUTLINES" --seed "${SEED:-$(date +%Y%m%d)}"
}
# shellcheck disable=SC2086  # CLEAN is several words
run_clean() { tools/clean_debian.sh ${CLEAN:-}; }

# What a lane's log says: passed, failed and skipped, then the names of what failed, separated by commas.
results_of() {  # lane
  awk -v lane="$1" '
    function add(name) { if (!(name in seen)) names = names (names == "" ? "" : ",") name; seen[name] = 1 }
    lane == "fuzz" && /^fuzz: [a-z_]+: passed$/ { ++passed }
    lane == "fuzz" && /^fuzz: [a-z_]+: failed$/ { ++failed; sub(":", "", $2); add($2) }
    lane ~ /^(headers|tidy|fixed_point|outlines)$/ && /^(check_headers|tidy|fixed_point|outlines): [^ ]+: passed$/ { ++passed }
    lane ~ /^(headers|tidy|fixed_point|outlines)$/ && /^(check_headers|tidy|fixed_point|outlines): [^ ]+: failed$/ {
      ++failed; sub(":", "", $2); add($2)
    }
    lane ~ /^(properties|kills)$/ && /^\[  PASSED  \] [0-9]+ test/ { passed += $4 }
    lane ~ /^(properties|kills)$/ && /^\[  FAILED  \] [0-9]+ test/ { failed += $4; next }
    lane ~ /^(properties|kills)$/ && /^\[  FAILED  \] / { sub(",", "", $4); add($4) }
    lane == "firefox" && /^  [0-9]+ passed / { passed += $1 }
    lane == "firefox" && /^  [0-9]+ skipped$/ { skipped += $1 }
    lane == "firefox" && /^  [0-9]+ (failed|interrupted|flaky)$/ { failed += $1 }
    lane == "firefox" && /^  [0-9]+\) .* › / {
      sub(/^.*:[0-9]+:[0-9]+ › /, ""); sub(/ *(─)*$/, ""); gsub(/ @[a-z]+/, ""); gsub(/,/, ""); add($0)
    }
    lane ~ /^(debug|asan|clang|clean)$/ && /^[0-9]+% tests passed, [0-9]+ tests? failed out of [0-9]+$/ {
      failed += $4; passed += $NF - $4; summary = 1
    }
    /^nightly: [a-z0-9]+: not built$/ { ++failed; sub(":", "", $2); add($2) }
    summary && /^\t *[0-9]+ - .* \((Skipped|Disabled)\)$/ { ++skipped; if (/Skipped/) --passed; next }
    summary && /^\t *[0-9]+ - / { add($3) }
    END { printf "%d %d %d %s\n", passed, failed, skipped, names }' "$logs/$1.log"
}

# ---- the page
row_of() { grep -m1 "^| \`$1\` |" "$page" 2> /dev/null || echo "| \`$1\` | ${meaning[$1]} | not run | | | | | | |"; }
write_page() {  # the new row, and what failed in it
  local lane rows='' failures=''
  for lane in "${all[@]}"; do
    if [[ $1 == "| \`$lane\` |"* ]]; then
      rows+=$1$'\n'
      [[ -z $2 ]] || failures+="- \`$lane\`: $2"$'\n'
    else
      rows+=$(row_of "$lane")$'\n'
      failures+=$(grep "^- \`$lane\`: " "$page" 2> /dev/null && echo x || true)
      failures=${failures%x}
    fi
  done
  {
    echo '# Nightly runs'
    echo 'Results of the last run of each lane of [tools/nightly.sh](../tools/nightly.sh), written by that script.'
    echo
    echo '| lane | what | result | passed | failed | skipped | CPU minutes | date | version, commit |'
    echo '|---|---|---|---|---|---|---|---|---|'
    printf '%s' "$rows"
    [[ -z $failures ]] || printf '\nFailed:\n\n%s' "$failures"
  } > "$page.new"
  mv "$page.new" "$page"
}

git=(git -c 'safe.directory=*')
commit=$("${git[@]}" rev-parse --short HEAD)
[[ -z $("${git[@]}" status --porcelain -- . ":!$page" ':!tests/extrude/fixtures') ]] || commit+=' with changes'
version=$(sed -nE 's/^project\(mansard VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
code=0
for lane in "${lanes[@]}"; do
  echo "== $lane: log in $logs/$lane.log"
  result=passed
  TIMEFORMAT='%U %S'
  { time "run_$lane" > "$logs/$lane.log" 2>&1 || result=failed; } 2> "$logs/time"
  read -r passed failed skipped names < <(results_of "$lane")
  minutes=$(awk '{ printf "%.0f", ($1 + $2) / 60 }' "$logs/time")
  write_page "| \`$lane\` | $(meaning_of "$lane") | $result | $passed | $failed | $skipped | $minutes | $(date +%F) | $version, $commit |" \
    "${names//,/, }"
  echo "$result: $passed passed, $failed failed${names:+ ($names)}, $skipped skipped; $minutes minutes of CPU"
  [[ $result == passed ]] || code=1
done
exit $code
}
