#!/usr/bin/env bash
# Reconstructs the samples of data/ into out/ (or $RESULTS) with the release build (or $MANSARD) and says where the models and the pictures are.
# A sample whose result is newer than the program and its input is not made again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mansard=${MANSARD:-build/release/bin/mansard}
results=${RESULTS:-$PWD/out}

# name, what it is, then the arguments of `mansard reconstruct`
sample() {
  local name=$1 what=$2
  shift 2
  local out=$results/$name stale=
  for made in run.json model.city.json picture.png; do
    [[ -s $out/$made ]] || stale=yes
  done
  for source in "$mansard" data/"$name"/*; do
    [[ $out/run.json -nt $source ]] || stale=yes
  done
  if [[ $stale ]]; then
    echo "== $what"
    # 1: finished, some buildings fell back to a simpler model and the report says why. Anything above is a failure.
    local code=0
    "$mansard" reconstruct "$@" -o "$out" --overwrite --picture > /dev/null || code=$?
    [[ $code -le 1 ]] || exit "$code"
    for made in run.json model.city.json picture.png; do
      [[ -s $out/$made ]] || { echo "demo: $mansard ended with $code but left no $out/$made" >&2; exit 70; }
    done
  else
    echo "== $what (up to date)"
  fi
}

sample hall 'hall: a gabled hall with an annex, photogrammetry' data/hall/mesh.off data/hall/footprints.geojson
sample b9 'b9: a house around a courtyard, photogrammetry, most walls missing' data/b9/mesh.off data/b9/footprints.geojson
sample delft 'delft: 87 houses, airborne laser scan' data/delft/mesh.ply data/delft/footprints.geojson \
  --mesh-offset 84800 447400 0

echo
for name in hall b9 delft; do
  printf '%-6s model    %s\n%-6s picture  %s\n' "$name" "$results/$name/model.city.json" '' "$results/$name/picture.png"
done

echo
echo "Look at them and edit them in a browser: $mansard serve --open"
