#!/usr/bin/env bash
# The paper's London block in its own place: real footprints around Regent Street with invented buildings, scanned,
# reconstructed and held against that truth. Prints one table, the one of docs/simulate.md.
# usage: tools/regent_street.sh DATA OUT [mansard reconstruct options…]     (DATA: data, the samples)
set -euo pipefail
data=$1 out=$2
shift 2
mansard=${MANSARD:-build/release/bin/mansard}
mkdir -p "$out"

"$mansard" simulate --footprints "$data/regent_street/footprints.geojson" --preset oblique-aerial --seed 1 \
  -o "$out/block" --overwrite -q >/dev/null
code=0
"$mansard" reconstruct "$out/block/mesh.ply" "$out/block/footprints.geojson" -o "$out/made" --overwrite -q "$@" \
  >/dev/null || code=$?
if [ "$code" -gt 1 ]; then
  echo "the reconstruction ended with exit code $code" >&2
  exit "$code"
fi
"$mansard" evaluate "$out/made/model.city.json" "$out/block/mesh.ply" --truth "$out/block/truth.city.json" \
  --footprints "$out/block/footprints.geojson" -o "$out/report.json" --overwrite -q >/dev/null

python3 - "$out/made/run.json" "$out/report.json" <<'PYTHON'
import json
import sys

run, report = (json.load(open(name, encoding="utf-8")) for name in sys.argv[1:])
total = lambda key: sum(block[key] for block in run["blocks"])
counts, truth = run["counts"], report["truth"]
walls, roofs, buildings = truth["party_walls"], truth["roofs"], truth["buildings"]
optimal = sum(block["objective"]["status"] == "optimal" for block in run["blocks"])
rows = [
    ("footprints: full, fallback, covered, refused",
     f'{counts["footprints"]}: {counts["full"]}, {counts["fallback"]}, {counts["covered"]}, {counts["refused"]}'),
    ("blocks, solved to optimality", f'{len(run["blocks"])}, {optimal}'),
    ("triangles of the scan", f'{run["mesh"]["triangles"]:,}'),
    ("sweep-edges", f'{total("sweep_edges"):,}'),
    ("faces, inside the footprints", f'{total("faces"):,}, {total("inside_faces"):,}'),
    ("variables", f'{total("variables"):,}'),
    ("segment, CPU seconds", f'{run["times"]["stages"]["segment"]["cpu_seconds"]:.2f}'),
    ("all stages, CPU seconds", f'{run["times"]["cpu_seconds"]:.1f}'),
    ("MSE over the bounding boxes", f'{run["scores"]["vertical_mse_m2"]:.3f} m²'),
    ("MSE over the footprints", f'{run["scores"]["footprint_mse_m2"]:.3f} m²'),
    ("buildings matched", f'{buildings["matched"]} of {buildings["truth"]}'),
    ("party walls found", f'{100 * walls["recall"]:.1f} % of {walls["truth_m"] / 2:.0f} m'),
    ("party walls of the model that are right", f'{100 * walls["precision"]:.1f} % of {walls["model_m"] / 2:.0f} m'),
    ("roof area within 3° and 0.25 m", f'{100 * roofs["share_within_both"]:.1f} %'),
    ("roof planes found", f'{roofs["planes_found"]} of {roofs["planes"]}'),
]
print("| | |\n|---|---|")
for name, value in rows:
    print(f"| {name} | {value} |")
PYTHON
