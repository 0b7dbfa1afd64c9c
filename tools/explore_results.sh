#!/usr/bin/env bash
# Counts, errors and times of the stages as a table in Markdown: the six real inputs, then five simulated blocks, which are made first.
# usage: tools/explore_results.sh DATA OUT [mansard options…]     (DATA: the folder with mvs_buildings, delft, zhongshan, …)
set -euo pipefail
data=$1 out=$2
shift 2
mansard=${MANSARD:-build/release/bin/mansard}
tools=$(dirname "$0")
mkdir -p "$out"

for kind in terrace perimeter courtyard towers detached; do
  "$mansard" simulate --block $kind --preset oblique-aerial -o "$out/$kind" --overwrite -q >"$out/simulate.log"
done
"$mansard" explore table --datasets "$tools/datasets.toml" --data "$data" -o "$out/real" --overwrite -q "$@" >"$out/real.log"
"$mansard" explore table --datasets "$tools/simulated.toml" --data "$out" -o "$out/simulated" --overwrite -q "$@" \
  >"$out/simulated.log"

python3 - "$out/real/results.csv" "$out/simulated/results.csv" <<'PYTHON'
import csv
import sys

COLUMNS = [
    ("data", lambda r: r["dataset"]),
    ("triangles", lambda r: f'{int(r["triangles"]):,}'),
    ("footprints: full, fallback, covered, refused",
     lambda r: ": ".join([r["footprints"], ", ".join(r[k] for k in ("full", "fallback", "covered", "refused"))])),
    ("parts", lambda r: r["parts"]),
    ("sweep-edges", lambda r: r["sweep_edges"]),
    ("faces inside", lambda r: f'{r["inside_faces"]} of {r["faces"]}'),
    ("variables, reference", lambda r: f'{int(r["reference_variables"]):,}'),
    ("variables, ours", lambda r: f'{int(r["variables"]):,}'),
    ("blocks optimal", lambda r: f'{r["optimal"]} of {r["blocks"]}'),
    ("optimise, CPU s", lambda r: f'{float(r["optimise_cpu_s"]):.3f}'),
    ("CPU s", lambda r: f'{float(r["cpu_s"]):.1f}'),
    ("vertical MSE m²", lambda r: f'{float(r["vertical_mse_m2"]):.3f}'),
    ("over footprints m²", lambda r: f'{float(r["footprint_mse_m2"]):.3f}'),
    ("median abs. m", lambda r: f'{float(r["median_absolute_m"]):.3f}'),
]
print("| " + " | ".join(name for name, _ in COLUMNS) + " |")
print("|" + "---|" * len(COLUMNS))
for path in sys.argv[1:]:
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            cells = [f"{row['dataset']} failed: {row['failure']}"] if row["failure"] else [cell(row) for _, cell in COLUMNS]
            print("| " + " | ".join(cells) + " |")
PYTHON
