#!/usr/bin/env python3
"""Prints the project's Table 1 as Markdown from run.json files (one row a file, all its blocks added up)."""
import json
import pathlib
import sys


def row(path):
    run = json.loads(path.read_text())
    blocks, counts, scores = run["blocks"], run["counts"], run["scores"]
    total = lambda key: sum(block[key] for block in blocks)
    optimal = sum(block["objective"]["status"] == "optimal" for block in blocks)
    times = run["times"]
    segment = times["stages"].get("segment", {"cpu_seconds": 0})
    return [
        path.parent.name,
        f'{run["mesh"]["triangles"]:,}',
        f'{counts["footprints"]}: {counts["full"]} full, {counts["fallback"]} fallback, '
        f'{counts["covered"]} covered, {counts["refused"]} refused',
        str(total("parts")),
        str(total("sweep_edges")),
        f'{total("inside_faces")} of {total("faces")}',
        f'{total("variables"):,}',
        f'{optimal} of {len(blocks)}',
        f'{times["cpu_seconds"]:.1f}',
        f'{segment["cpu_seconds"]:.2f}',
        f'{scores["vertical_mse_m2"]:.3f}',
        f'{scores["footprint_mse_m2"]:.3f}',
        f'{scores["median_absolute_m"]:.3f}',
    ]


HEAD = ["data", "triangles", "footprints", "parts", "sweep-edges", "faces inside", "variables", "blocks optimal",
        "CPU s", "of it segment s", "vertical MSE m²", "over footprints m²", "median abs. m"]
print("| " + " | ".join(HEAD) + " |")
print("|" + "---|" * len(HEAD))
for name in sys.argv[1:]:
    print("| " + " | ".join(row(pathlib.Path(name))) + " |")
