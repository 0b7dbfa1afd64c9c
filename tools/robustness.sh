#!/usr/bin/env bash
# How much worse do models get as scans and surveys get worse? Simulates three small blocks of known truth, sweeps one
# disturbance at a time with all else as the preset oblique-aerial has it, reconstructs, and holds the models against
# the truth. Prints a Markdown table per disturbance, a verdict on each, and the worst cases: docs/robustness.md.
# usage: tools/robustness.sh OUT [disturbance…]        (all of them when none is named)
# Scans are kept in OUT/DISTURBANCE/LEVEL/BLOCK/scan and used again; OPTIONS="--preset paper" goes to reconstruct;
# JOBS=n is the number of threads; BLOCKS="terrace" does fewer. Ends with 0 whatever is found, with 1 where a program
# failed.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$1
shift
only=("$@")
mansard=${MANSARD:-build/release/bin/mansard}
jobs=${JOBS:-0}
read -ra options <<<"${OPTIONS:-}"
read -ra blocks <<<"${BLOCKS:-terrace perimeter detached}"
# Small, to be quick. A perimeter block much smaller has no room for rows between its corner houses. [m]
declare -A size=([terrace]=40 [perimeter]=55 [detached]=40)
failed=0

# name | what goes with it | option | levels, least disturbance first; * marks what the preset has, measured but once
sweeps='
missing_walls||missing-walls|0 0.03* 0.5 1
missing_share|--simulate-missing-walls 1|missing-share|0 0.25 0.5 0.8
trees||trees|0 8* 32 64
cars||cars|0 6* 25 50
slope||slope|0 0.02* 0.08 0.15
chimneys||chimneys|0 0.5* 1
noise||noise|0.02 0.06* 0.12 0.2
melt||melt|0.1 0.35* 0.5 0.7
holes||holes|0 0.07* 0.25 0.5
resolution||resolution|0.15 0.4* 0.7 1
seam|--simulate-tile 15|seam|0 0.1 0.2 0.4
displacement||displacement|0 0.2* 0.5 1
jitter||jitter|0 0.05* 0.2 0.4
eaves||eaves|0* 0.25 0.5 0.8
merged||merged|0 0.1* 0.5 1
'

wanted() {
  [ ${#only[@]} -eq 0 ] && return
  local name
  for name in "${only[@]}"; do
    [ "$name" = "$1" ] && return
  done
  return 1
}
ran() {
  local most=$1 log=$2 code=0
  shift 2
  "$@" >"$log" 2>&1 || code=$?
  if [ "$code" -gt "$most" ]; then
    echo "exit code $code: $*" | tee "$log.failed" >&2
    tail -n 3 "$log" >&2
    failed=1
    return 1
  fi
}
# One block at one level. A scan is made again when it was asked for with other options.
measure() {
  local cell=$1 what
  read -ra what <<<"$2"
  mkdir -p "$cell"
  rm -f "$cell"/*.failed "$cell/report.json"
  if [ "$(cat "$cell/asked" 2>/dev/null)" != "${what[*]}" ]; then
    ran 0 "$cell/simulate.log" "$mansard" simulate "${what[@]}" -j "$jobs" -q --overwrite -o "$cell/scan" || return 0
    echo "${what[*]}" >"$cell/asked"
  fi
  # An exit code of 1 says that some buildings fell back.
  ran 1 "$cell/reconstruct.log" "$mansard" reconstruct "$cell/scan/mesh.ply" "$cell/scan/footprints.geojson" \
    "${options[@]}" -j "$jobs" -q --overwrite -o "$cell/model" || return 0
  ran 0 "$cell/evaluate.log" "$mansard" evaluate "$cell/model/model.city.json" "$cell/scan/mesh.ply" \
    --truth "$cell/scan/truth.city.json" -j "$jobs" -q --overwrite -o "$cell/report.json" || return 0
}

mkdir -p "$out"
: >"$out/cells"
# Block after block, so that what was stopped half way has whole blocks.
for block in "${blocks[@]}"; do
  common="--block $block --seed 1 --preset oblique-aerial --simulate-size ${size[$block]:-40}"
  done_once=0
  while IFS='|' read -r name with option levels; do
    if [ -z "$name" ] || ! wanted "$name"; then continue; fi
    for level in $levels; do
      if [ "$level" != "${level%\*}" ]; then
        cell=preset/$block
        [ "$done_once" -eq 1 ] || measure "$out/$cell" "$common"
        done_once=1
      else
        cell=$name/$level/$block
        measure "$out/$cell" "$common $with --simulate-$option $level"
      fi
      echo "$name ${level%\*} $block $cell" >>"$out/cells"
    done
  done <<<"$sweeps"
done
python3 "$here/robustness.py" "$out"
exit $failed
