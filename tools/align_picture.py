#!/usr/bin/env python3
"""Draws docs/pictures/align.png: PYTHONPATH=build/release/python tools/align_picture.py data docs/pictures/align.png"""

import pathlib
import sys

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402: after the choice of what draws

import mansard  # noqa: E402

data, out = pathlib.Path(sys.argv[1]), sys.argv[2]
scan = mansard.read_scan(data / "delft/mesh.ply", data / "delft/footprints.geojson", mesh_offset=(84800, 447400, 0))
points = (scan.vertices + scan.origin)[:, :2]
high = scan.vertices[:, 2] - scan.vertices[:, 2].min() > 4
figure, axes = pyplot.subplots(1, 2, figsize=(10, 5.5), sharex=True, sharey=True)
for axis, move, title in ((axes[0], (24, -17), "moved by 24 m and 17 m"),
                          (axes[1], (0, 0), "in the best place")):
    axis.plot(*(points[high] + move).T, ",", color="#b5473c", alpha=0.5)
    for feature in scan.footprints["features"]:
        if feature["geometry"]:
            for ring in feature["geometry"]["coordinates"]:
                if feature["geometry"]["type"] == "Polygon":
                    axis.plot(*numpy.array(ring)[:, :2].T, color="black", linewidth=0.7)
    axis.set_title(title)
    axis.set_aspect("equal")
    axis.set_axis_off()
figure.tight_layout()
figure.savefig(out, dpi=80)
