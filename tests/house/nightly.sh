#!/usr/bin/env bash
# Runs tools/nightly.sh among stand-ins for the tools it calls, and reads the page that it writes.
#   nightly.sh REPOSITORY CASE
set -euo pipefail
repository=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch/bin" "$scratch/tools" "$scratch/docs" "$scratch/build/release/bin"
export PATH=$scratch/bin:$PATH
unset JOBS UNTIL  # of the lane that runs this test
calls=$scratch/calls
: > "$calls"
page=$scratch/docs/nightly.md

fail() { echo "$*" >&2; cat "$scratch/stdout" "$page" "$calls" >&2; exit 1; }
stand_in() {  # path, body
  printf '#!/bin/bash\necho "%s $*" >> "%s"\n%s\n' "$1" "$calls" "$2" > "$scratch/$1"
  chmod +x "$scratch/$1"
}
says() { grep -qE -- "$1" "$page"; }
nightly() { "$scratch/tools/nightly.sh" "$@" > "$scratch/stdout" 2>&1; }

cp "$repository/tools/nightly.sh" "$scratch/tools/"
echo 'project(mansard VERSION 1.2.3 LANGUAGES CXX)' > "$scratch/CMakeLists.txt"
stand_in bin/make 'echo 1'
stand_in bin/cmake ''
stand_in bin/git '[[ "$*" != *rev-parse* ]] || echo abc1234'
stand_in tools/setup.sh ''
stand_in bin/ctest 'printf "100%% tests passed, 0 tests failed out of 12\n\nThe following tests did not run:\n\t  3 - a.b (Skipped)\n\t 40 - a.c (Disabled)\n"'

case $2 in
  nightly_says_which_lanes_were_not_run)
    JOBS=3 nightly debug || fail "failed"
    grep -qE '^bin/ctest --preset debug .*-j 3 -LE browser$' "$calls" || fail "not as many tests at once, or those in browsers"
    says '^\| `debug` \| .* \| passed \| 11 \| 0 \| 2 \| 0 \| 20[0-9-]+ \| 1\.2\.3, abc1234 \|$' || fail "no row of debug"
    for lane in asan clang firefox headers tidy fuzz properties kills fixed_point outlines clean; do
      says "^\| \`$lane\` \| .* \| not run \| \| \| \| \| \| \|$" || fail "$lane was not run"
    done
    ;;
  nightly_keeps_the_rows_of_other_lanes)
    nightly debug || fail "failed"
    stand_in bin/ctest 'printf "50%% tests passed, 6 tests failed out of 12\n\nThe following tests FAILED:\n\t  3 - a.b (Timeout)\n\t 40 - a.c (Not Run)\n"; exit 8'
    ! nightly asan || fail "a failed lane is a failure"
    says '^\| `debug` \| .* \| passed \| 11 \|' || fail "debug is gone"
    says '^\| `asan` \| .* \| failed \| 6 \| 6 \| 0 \|' || fail "no row of asan"
    says '^- `asan`: a\.b, a\.c$' || fail "what failed is not named"
    nightly debug || [[ $? -eq 1 ]] || fail "failed"
    says '^- `asan`: a\.b, a\.c$' || fail "what failed in asan is gone"
    says '^- `debug`: a\.b, a\.c$' || fail "what failed in debug is not named"
    [[ $(grep -c '^| `' "$page") -eq 12 ]] || fail "a lane has not one row"
    ;;
  nightly_reports_a_lane_that_does_not_build)
    stand_in bin/cmake '[[ "$*" != *--build* ]]'
    ! nightly clang || fail "passed"
    says '^\| `clang` \| .* \| failed \| 0 \| 0 \| 0 \|' || fail "no row of clang"
    ! grep -q '^bin/ctest' "$calls" || fail "tests without a build"
    grep -q '^tools/setup.sh build test package clang$' "$calls" || fail "clang was not installed"
    ;;
  nightly_counts_fuzzers_and_properties)
    stand_in tools/fuzz.sh 'printf "noise\nfuzz: plan_json: passed\nfuzz: extrude: failed\nfuzz: models: passed\n"; exit 1'
    stand_in build/release/bin/test_extrude 'printf "[  PASSED  ] 7 tests.\n[  FAILED  ] Guarantee.holds (12 ms)\n[  FAILED  ] 1 test, listed below:\n[  FAILED  ] Guarantee.holds\n"; exit 1'
    stand_in bin/make 'echo 2'
    FUZZ_SECONDS=5 RUNS=10 nightly fuzz properties || [[ $? -eq 1 ]] || fail "failed"
    grep -q '^tools/fuzz.sh 5$' "$calls" || fail "not the seconds given"
    says '^\| `fuzz` \| each fuzzer for 5 s \| failed \| 2 \| 1 \| 0 \|' || fail "no row of fuzz"
    says '^\| `properties` \| .*10 random plans \| failed \| 14 \| 2 \| 0 \|' || fail "no row of properties"
    says '^- `fuzz`: extrude$' && says '^- `properties`: Guarantee.holds$' || fail "what failed is not named"
    ;;
  nightly_counts_files_of_outlines)
    stand_in tools/outlines.py 'printf "outlines: 000000: passed\n  noise\noutlines: 001500: failed\n"; exit 1'
    OUTLINES=3000 SEED=7 nightly outlines || [[ $? -eq 1 ]] || fail "failed"
    grep -q '^tools/outlines.py build/release/bin/mansard .*/outlines --count 3000 --seed 7$' "$calls" || fail "not those given"
    says '^\| `outlines` \| 3000 random .* \| failed \| 1 \| 1 \| 0 \|' || fail "no row of outlines"
    says '^- `outlines`: 001500$' || fail "what failed is not named"
    ;;
  nightly_counts_headers_and_sources)
    stand_in tools/check_headers.sh 'printf "check_headers: mansard/a/a.hpp: passed\nnoise: passed\n"'
    stand_in tools/tidy.sh 'printf "tidy: mansard/a/a.cpp: passed\ntidy: mansard/a/b.cpp: failed\n"; exit 1'
    stand_in tools/fixed_point.py 'printf "| hall | 3 |\nfixed_point: hall: passed\nfixed_point: terrace_1: failed\n"; exit 1'
    nightly headers tidy fixed_point || [[ $? -eq 1 ]] || fail "failed"
    grep -q '^tools/check_headers.sh --all$' "$calls" || fail "not all headers"
    says '^\| `headers` \| .* \| passed \| 1 \| 0 \| 0 \|' || fail "no row of headers"
    says '^\| `tidy` \| .* \| failed \| 1 \| 1 \| 0 \|' || fail "no row of tidy"
    says '^- `tidy`: mansard/a/b.cpp$' || fail "what failed is not named"
    says '^\| `fixed_point` \| .* \| failed \| 1 \| 1 \| 0 \|' && says '^- `fixed_point`: terrace_1$' || fail "no row of fixed_point"
    ;;
  nightly_counts_tests_in_firefox)
    mkdir -p "$scratch/apps/workbench/tests"
    stand_in apps/workbench/tests/run.sh 'printf "  1) tests/w.spec.ts:10:1 › a part is split, and merged @firefox ────\n    at tests/w.spec.ts:11:2 › x\n  1 failed\n    tests/w.spec.ts:10:1 › a part is split, and merged @firefox\n  2 skipped\n  28 passed (15.1m)\n"; exit 1'
    nightly firefox || [[ $? -eq 1 ]] || fail "failed"
    grep -q '^tools/setup.sh build test firefox$' "$calls" || fail "Firefox was not installed"
    grep -q '^apps/workbench/tests/run.sh firefox build/release/apps/server/page/workbench$' "$calls" || fail "not all tests"
    says '^\| `firefox` \| .* \| failed \| 28 \| 1 \| 2 \|' || fail "no row of firefox"
    says '^- `firefox`: a part is split and merged$' || fail "what failed is not named"
    ;;
  nightly_says_what_a_run_with_little_time_has_tested)
    mkdir -p "$scratch/cmake" "$scratch"/tests/{base,geometry,solid,cli}
    printf 'mansard_module(base     USES x)\nmansard_module(geometry DEPENDS base)\nmansard_module(lone DEPENDS base)\nmansard_module(solid)\n' \
      > "$scratch/cmake/modules.cmake"
    stand_in bin/cmake '[[ "$*" != *test_geometry* ]]'
    stand_in bin/date "[[ \$1 != +%F ]] || exec /bin/date \$1
      if grep -q 'ctest.*solid' '$calls'; then echo 10:31; else echo 10:29; fi"
    UNTIL=10:30 nightly asan || [[ $? -eq 1 ]] || fail "failed"
    says '^\| `asan` \| .*: the tests of `base`, `solid` only, in a run that had until 10:30 \| failed \| 22 \| 1 \| 4 \|' || fail "no row of asan"
    says '^- `asan`: geometry$' || fail "what was not built is not named"
    ! grep -qE '^bin/(cmake|ctest) .*(cli|lone)' "$calls" || fail "something was begun after the time"
    stand_in bin/cmake ''
    UNTIL=10:32 nightly asan || fail "failed"
    grep -qE '^bin/ctest .* -E \^\(base\|geometry\|solid\|cli\)\\.$' "$calls" || fail "the other tests did not run"
    says '^\| `asan` \| .*: all tests but those in browsers \| passed \| 55 \| 0 \| 10 \|' || fail "all tests are not all tests"
    ;;
  nightly_refuses_a_lane_that_does_not_exist)
    ! nightly debug asam || fail "passed"
    grep -q "unknown lane 'asam'; expected debug asan" "$scratch/stdout" || fail "the error does not list the lanes"
    [[ ! -e $page ]] || fail "a page was written"
    ;;
  *)
    fail "no such case: $2"
    ;;
esac
