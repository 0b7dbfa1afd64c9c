#!/usr/bin/env bash
# Measures what a reconstruction has to reach, on real inputs and on simulated ones with known truth, and prints one
# table. How each number is measured: docs/evaluate.md, "Targets".
# usage: tools/targets.sh DATA OUT [real|simulated|all] [mansard reconstruct options…]
# DATA is the folder with mvs_buildings, delft, zhongshan and sim_rotterdam. Simulated scans are kept in OUT/scans and
# used again; JOBS=n is the number of threads, SEEDS the seeds of the blocks: by default 1 3 5, of the odd ones that the
# program is tuned on. SEEDS="4 6 8" are for scoring, once, when the work is done. Ends with 0 whether or not targets are reached.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
data=$1 out=$2 group=${3:-all}
shift $(($# < 3 ? $# : 3))
options=("$@")
mansard=${MANSARD:-build/release/bin/mansard}
jobs=${JOBS:-0}
kinds=(terrace perimeter courtyard detached towers regent_street)
read -ra seeds <<<"${SEEDS:-1 3 5}"
mkdir -p "$out"

# Runs with its CPU seconds (user and system) in a file; 1 means that some buildings fell back.
timed() {
  local file=$1 code=0
  shift
  { TIMEFORMAT='%U %S'; time "$@" >/dev/null 2>"$file.log" || code=$?; } 2>"$file"
  return $code
}
reconstruct() {
  local name=$1 code=0
  shift
  rm -rf "${out:?}/$name"
  mkdir -p "$out/$name"
  timed "$out/$name/cpu" "$mansard" reconstruct "$@" "${options[@]}" -j "$jobs" -o "$out/$name/model" -q || code=$?
  if [ "$code" -gt 1 ]; then
    echo "$name ended with exit code $code:" >&2
    cat "$out/$name/cpu.log" >&2
    exit "$code"
  fi
}
evaluate() {
  local name=$1
  shift
  "$mansard" evaluate "$out/$name/model/model.city.json" "$@" -j "$jobs" -o "$out/$name/report.json" --overwrite -q \
    >/dev/null
}
# What reading a mesh costs alone: nothing more is done with a model that lies elsewhere (exit code 3).
reading() {
  local name=$1
  shift
  printf 'v -9e6 -9e6 0\nv -8e6 -9e6 0\nv -8e6 -8e6 9\nf 1 2 3\n' >"$out/elsewhere.obj"
  timed "$out/$name/cpu_reading" "$mansard" label "$@" "$out/elsewhere.obj" -o "$out/none.ply" -q || true
  grep -q ingest-model-overlap "$out/$name/cpu_reading.log"
}

real() {
  local scene=$data/sim_rotterdam/block_A_sim_mesh.ply gis=$data/sim_rotterdam/block_A_footprints.geojson
  reconstruct block_A "$scene" "$gis"
  reading block_A "$scene"
  evaluate block_A "$scene" --footprints "$gis" --truth "$data/sim_rotterdam/block_A_truth.obj"
  "$mansard" label "$scene" "$out/block_A/model/model.city.json" --truth "$data/sim_rotterdam/block_A_truth.obj" \
    -o "$out/block_A/labelled.ply" --overwrite -q >"$out/block_A/labels.txt"
  rm "$out/block_A/labelled.ply"

  scene=$data/delft/delft_west_mesh.ply gis=$data/delft/delft_west_footprints.geojson
  local offset=(--mesh-offset 84800 447400 0)
  reconstruct delft "$scene" "$gis" "${offset[@]}"
  reading delft "$scene" "${offset[@]}"
  evaluate delft "$scene" "${offset[@]}" --footprints "$gis"

  gis=$data/zhongshan/zhongshan_A_footprints.geojson
  for level in L19 L18; do
    reconstruct "zhongshan_$level" "$data/zhongshan/zhongshan_A_$level.ply" "$gis"
    evaluate "zhongshan_$level" "$data/zhongshan/zhongshan_A_$level.ply" --footprints "$gis"
  done
  # One model held against the other as if it were the truth.
  "$mansard" evaluate "$out/zhongshan_L19/model/model.city.json" "$data/zhongshan/zhongshan_A_L19.ply" --footprints \
    "$gis" --truth "$out/zhongshan_L18/model/model.city.json" -o "$out/zhongshan_L19/stable.json" --overwrite -q >/dev/null

  for pair in "hall cgal_building.off cgal" "b9 b9_mesh.off b9"; do
    read -r name file prefix <<<"$pair"
    gis=$data/mvs_buildings/${prefix}_footprints.geojson
    reconstruct "$name" "$data/mvs_buildings/$file" "$gis"
    evaluate "$name" "$data/mvs_buildings/$file" --footprints "$gis"
  done
}

simulate() {
  local scan=$1 kind=$2 seed=$3 what=(--block "$2")
  [ "$kind" = regent_street ] && what=(--footprints "$here/../data/regent_street/footprints.geojson")
  [ -f "$scan/truth.city.json" ] && [ -f "$scan/mesh.ply" ] && return
  "$mansard" simulate "${what[@]}" --preset oblique-aerial --seed "$seed" -j "$jobs" -o "$scan" --overwrite -q >/dev/null
}
simulated() {
  for kind in "${kinds[@]}"; do
    for seed in "${seeds[@]}"; do
      local name=$kind-$seed scan=$out/scans/$kind-$seed
      simulate "$scan" "$kind" "$seed"
      reconstruct "$name" "$scan/mesh.ply" "$scan/footprints.geojson"
      evaluate "$name" "$scan/mesh.ply" --truth "$scan/truth.city.json"
    done
  done
}

case $group in
  real) real ;;
  simulated) simulated ;;
  all) real && simulated ;;
  *)
    echo "what to run: real, simulated or all, not '$group'" >&2
    exit 2
    ;;
esac
python3 "$here/targets.py" "$out" "$group"
echo
python3 "$here/form.py" "$out"
