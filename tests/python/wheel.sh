#!/usr/bin/env bash
# The wheel as pip makes it from this checkout, installed into an empty environment: wheel.sh PYTHON SOURCE BUILD SCRATCH
set -euo pipefail
python=$1 source=$2 build=$3 scratch=$4
rm -rf "$scratch"
mkdir -p "$scratch"
if ! "$python" -m venv --system-site-packages "$scratch/env" > "$scratch/log" 2>&1; then
  cat "$scratch/log" >&2
  exit 1
fi
cd "$source"
"$scratch/env/bin/pip" wheel --no-deps --no-index --config-settings=build-dir="$build" -w "$scratch" "$source" >> "$scratch/log" 2>&1 ||
  { cat "$scratch/log" >&2; exit 1; }
"$scratch/env/bin/pip" wheel --no-deps --no-index --config-settings=build-dir="$build" -w "$scratch/again" "$source" >> "$scratch/log" 2>&1
cmp "$scratch"/mansard-*.whl "$scratch"/again/mansard-*.whl
"$scratch/env/bin/pip" install --no-index "$scratch"/mansard-*.whl >> "$scratch/log" 2>&1 || { cat "$scratch/log" >&2; exit 1; }
cd "$scratch"
"$scratch/env/bin/python" - "$source/data" << 'PYTHON'
import sys
import mansard
assert "/env/" in mansard.__file__, mansard.__file__
city = mansard.reconstruct(f"{sys.argv[1]}/hall/mesh.off", f"{sys.argv[1]}/hall/footprints.geojson")
assert [building.outcome for building in city] == ["full", "full"], city
city.write("hall.glb")
# STL is read by mansard-reader, which is in the wheel.
city.write("hall.stl")
again = mansard.reconstruct("hall.stl", f"{sys.argv[1]}/hall/footprints.geojson")
assert len(again) == 2, again
PYTHON
"$scratch/env/bin/pip" show mansard | grep "^License: Apache-2.0"
