#!/usr/bin/env bash
# tools/blender_import.py in Debian's Blender, without windows: run.sh ROOT MANSARD SCRATCH. Skipped (77) without Blender.
set -euo pipefail
root=$(realpath "$1") program=$(realpath "$2") scratch=$3
command -v blender > /dev/null || { echo 'skipped: Blender is not installed (apt-get install blender)' >&2; exit 77; }
rm -rf "$scratch"
mkdir -p "$scratch/a folder"
scratch=$(realpath "$scratch")
cd "$scratch"
"$program" reconstruct "$root/data/hall/mesh.off" "$root/data/hall/footprints.geojson" -o hall --formats glb,cityjson -q > /dev/null
mv hall/model.glb "a folder/hällen.glb"
ids=$(python3 -c 'import json; print("\n".join(k for k, v in json.load(open("hall/model.city.json"))["CityObjects"].items() if v["type"] == "Building"))')
mapfile -t ids <<< "$ids"
run() { blender --background --factory-startup --python-exit-code 3 --python "$@" > log.txt 2>&1 || { cat log.txt >&2; exit 1; }; }
run "$root/tests/blender/check.py" -- "$root/tools/blender_import.py" "a folder/hällen.glb" "${ids[@]}"
grep -q '^checked$' log.txt
"$program" reconstruct "$root/data/textured/houses.obj" "$root/data/textured/houses_footprints.geojson" --texture \
  -o textured --formats glb -q > /dev/null
run "$root/tests/blender/check.py" -- "$root/tools/blender_import.py" textured/model.glb gable l
grep -q '^checked$' log.txt
# As docs/blender.md says: opened and saved; a wrong call says how it is made.
run "$root/tools/blender_import.py" -- "a folder/hällen.glb" saved.blend
grep -q "hällen.glb: ${#ids[@]} buildings" log.txt && test -s saved.blend
! blender --background --factory-startup --python-exit-code 3 --python "$root/tools/blender_import.py" > log.txt 2>&1
grep -q '^usage: ' log.txt
