#!/usr/bin/env bash
# Runs the six real inputs of docs/results/scans.md and prints their table.
# usage: tools/real_inputs.sh DATA OUT [mansard options…]     (DATA: the folder with mvs_buildings, delft, zhongshan, …)
set -euo pipefail
data=$1 out=$2
shift 2
mansard=${MANSARD:-build/release/bin/mansard}
mkdir -p "$out"

run() {
  local name=$1
  shift
  local code=0
  "$mansard" reconstruct "$@" -o "$out/$name" --overwrite --picture -q || code=$?
  if [ "$code" -gt 1 ]; then
    echo "$name ended with exit code $code" >&2
    exit "$code"
  fi
}

run hall "$data/mvs_buildings/cgal_building.off" "$data/mvs_buildings/cgal_footprints.geojson" "$@"
run b9 "$data/mvs_buildings/b9_mesh.off" "$data/mvs_buildings/b9_footprints.geojson" "$@"
run delft "$data/delft/delft_west_mesh.ply" "$data/delft/delft_west_footprints.geojson" --mesh-offset 84800 447400 0 "$@"
run zhongshan-L19 "$data/zhongshan/zhongshan_A_L19.ply" "$data/zhongshan/zhongshan_A_footprints.geojson" "$@"
run zhongshan-L18 "$data/zhongshan/zhongshan_A_L18.ply" "$data/zhongshan/zhongshan_A_footprints.geojson" "$@"
run block-A "$data/sim_rotterdam/block_A_sim_mesh.ply" "$data/sim_rotterdam/block_A_footprints.geojson" "$@"

python3 "$(dirname "$0")/table.py" "$out"/{hall,b9,delft,zhongshan-L19,zhongshan-L18,block-A}/run.json
