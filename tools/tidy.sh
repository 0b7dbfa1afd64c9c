#!/usr/bin/env bash
# Runs clang-tidy with the checks of .clang-tidy.
#   tools/tidy.sh [SOURCE…]     without SOURCE: all sources of the modules
# JOBS is how many run at once (2). Exit code 1 when there is a finding; about 40 CPU minutes for all modules.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
tools/setup.sh build test clang
# Every source alone, as it has to compile: the preset compiles folders as units.
cmake --preset clang -B build/tidy --log-level=WARNING -DMANSARD_QUICK_BUILD=OFF -DMANSARD_UNITY=OFF > /dev/null
header=laz/mansard/formats/las/laz_perf.h  # generated
! grep -q "$header" build/tidy/build.ninja || cmake --build build/tidy --target "$header" > /dev/null
sources=("$@")
[[ $# -gt 0 ]] || mapfile -t sources < <(find mansard -name '*.cpp' | LC_ALL=C sort)
[[ ${#sources[@]} -gt 0 ]] || { echo "tidy: found no sources" >&2; exit 2; }
# The check of optional access does not come to an end for a few sources, or crashes (clang-tidy 16), where others take less
# than 10 s: they are checked without it.
tidy() {
  local said code=0 run=(clang-tidy-16 -p build/tidy --quiet --warnings-as-errors='*' "--header-filter=^$PWD/(mansard|lab)/")
  said=$(timeout 100 "${run[@]}" "$1" 2> /dev/null) || code=$?
  if [[ $code -ge 124 ]]; then
    code=0
    said=$("${run[@]}" --checks=-bugprone-unchecked-optional-access "$1" 2> /dev/null) || code=$?
  fi
  if [[ $code == 0 ]]; then
    echo "tidy: $1: passed"
  else
    printf '%s\ntidy: %s: failed\n' "$said" "$1"
    return 1
  fi
}
export -f tidy
printf '%s\n' "${sources[@]}" | xargs -P "${JOBS:-2}" -I{} bash -c 'tidy "$1"' _ {} || exit 1
