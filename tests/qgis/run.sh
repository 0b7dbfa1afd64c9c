#!/usr/bin/env bash
# The zip of the QGIS plugin in Debian's QGIS, without windows: run.sh ZIP MANSARD DATA SCRATCH. Skipped (77) without QGIS.
set -euo pipefail
zip=$(realpath "$1") program=$(realpath "$2") data=$(realpath "$3") here=$(dirname "$(realpath "$0")")
scratch=$4
if ! command -v qgis_process.bin > /dev/null || ! /usr/bin/python3 -c 'import qgis.core, processing' 2> /dev/null &&
   ! PYTHONPATH=/usr/share/qgis/python/plugins /usr/bin/python3 -c 'import qgis.core, processing' 2> /dev/null; then
  echo 'skipped: QGIS is not installed (tools/setup.sh qgis)' >&2
  exit 77
fi
rm -rf "$scratch"
mkdir -p "$scratch"/{plugins,home,work}
mkdir -m 700 "$scratch/run"
scratch=$(realpath "$scratch")
cmake -E chdir "$scratch/plugins" cmake -E tar xf "$zip"
export HOME=$scratch/home XDG_RUNTIME_DIR=$scratch/run QT_QPA_PLATFORM=offscreen QGIS_PLUGINPATH=$scratch/plugins
export MANSARD_PROGRAM=$program PATH=/usr/bin:/bin

# As a user of the command line. Debian's wrapper qgis_process passes an option that the program does not know.
# Not `| grep -q`, which would end before QGIS has written everything.
qgis_process.bin plugins enable mansard > "$scratch/plugins.txt" 2>&1
qgis_process.bin list > "$scratch/list.txt" 2>&1
for name in reconstruct extrude segment evaluate; do
  grep "mansard:$name" "$scratch/list.txt" > /dev/null || { echo "QGIS does not list mansard:$name" >&2; exit 1; }
done
qgis_process.bin run mansard:reconstruct -- "MESH=$data/hall/mesh.off" "FOOTPRINTS=$data/hall/footprints.geojson" \
  "OUTPUT=$scratch/work/process" > "$scratch/process.txt" 2>&1 || { cat "$scratch/process.txt" >&2; exit 1; }
cmp <(sed 's/"path": *"[^"]*"//g' "$scratch/work/process/plans.json") \
    <("$program" reconstruct "$data/hall/mesh.off" "$data/hall/footprints.geojson" -o "$scratch/work/own" --formats plans -q > /dev/null &&
      sed 's/"path": *"[^"]*"//g' "$scratch/work/own/plans.json")

# And as one of its windows, with layers, selections, cancel and errors.
/usr/bin/python3 "$here/check.py" "$scratch/plugins" "$program" "$data" "$scratch/work/python"
