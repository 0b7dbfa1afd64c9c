#!/usr/bin/env python3
"""Draws the pictures of docs/roof.md: tools/roof_pictures.py MANSARD [FOLDER]

Every roof:shape over a rectangle or a round tower, and a church whose parts are drawn as OpenStreetMap has them. Both are
written as GeoJSON, extruded by MANSARD, and its pictures put into FOLDER (docs/pictures).
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SHAPES = """flat skillion gabled half-hipped hipped
pyramidal gambrel mansard saltbox gabled_height_moved
bellcast_gable side_hipped side_half-hipped hipped-and-gabled round
cone dome onion butterfly sawtooth"""


def box(x, y, width, depth):
    return [[x, y], [x + width, y], [x + width, y + depth], [x, y + depth], [x, y]]


def tower(x, y, radius, corners=20):
    ring = [[x + radius * math.cos(2 * math.pi * i / corners), y + radius * math.sin(2 * math.pi * i / corners)]
            for i in range(corners)]
    return ring + ring[:1]


def feature(ring, **tags):
    return {"type": "Feature", "properties": {key.replace("__", ":"): value for key, value in tags.items()},
            "geometry": {"type": "Polygon", "coordinates": [ring]}}


def shapes():
    # Rows go to the right in a picture that is seen from the south-west.
    for row, names in enumerate(SHAPES.splitlines()):
        for column, name in enumerate(names.split()):
            x, y = 15 * column - 15 * row, -15 * column - 15 * row
            ring = tower(x + 6, y + 4, 5) if name in ("cone", "dome", "onion") else box(x, y, 13, 8)
            more = {"sawtooth": dict(roof__height="2", roof__direction="E"), "side_hipped": dict(roof__direction="W"),
                    "side_half-hipped": dict(roof__direction="W"), "saltbox": dict(roof__direction="S")}.get(name, {})
            yield feature(ring, id=name, building="yes", height="10 m", **{"roof__height": "4.5", "roof__shape": name, **more})


def church():
    stone, slate = "#d9cdb4", "slategrey"
    yield feature(box(0, 0, 56, 20), id="outline", building="church", building__colour=stone, roof__colour=slate)
    parts = {
        "nave": (box(8, 5, 34, 10), dict(height="18", roof__shape="gabled", roof__height="6")),
        "south aisle": (box(8, 0, 34, 5), dict(height="10", roof__shape="skillion", roof__height="3", roof__direction="S")),
        "north aisle": (box(8, 15, 34, 5), dict(height="10", roof__shape="skillion", roof__height="3", roof__direction="N")),
        "tower": (box(0, 6, 8, 8), dict(height="26", building__material="brick")),
        "spire": (box(0.5, 6.5, 7, 7), dict(min_height="26", height="38", roof__shape="pyramidal", roof__height="12",
                                            roof__material="copper")),
        "choir": (box(42, 5, 6, 10), dict(height="18", roof__shape="gabled", roof__height="6", roof__orientation="across")),
        "rotunda": (tower(52, 10, 5), dict(height="12")),
        "dome": (tower(52, 10, 4.5), dict(min_height="12", height="18", roof__shape="dome", roof__height="4.5",
                                          roof__colour="#6fa58f")),
        "arch": (box(14, -8, 8, 8), dict(min_height="4", height="7", roof__shape="round", roof__height="2",
                                         roof__orientation="across")),
        "gatehouse": (box(12, -16, 12, 8), dict(height="9", roof__shape="hipped", roof__height="4")),
    }
    for name, (ring, tags) in parts.items():
        extra = {"@relations": [{"role": "part", "rel": 1, "reltags": {"type": "building"}}]}
        one = feature(ring, id=name, building__part="yes", **tags)
        one["properties"].update(extra)
        yield one


def main():
    mansard = sys.argv[1]
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "docs/pictures")
    for name, features in (("roof-all-shapes", list(shapes())), ("roof-parts", list(church()))):
        features[0]["properties"].setdefault(
            "@relations", [{"role": "outline", "rel": 1, "reltags": {"type": "building"}}] if name == "roof-parts" else [])
        with tempfile.TemporaryDirectory() as there:
            source = pathlib.Path(there) / f"{name}.geojson"
            crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::28992"}}
            source.write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": features}))
            model = pathlib.Path(there) / f"{name}.glb"
            subprocess.run([mansard, "extrude", source, "-o", model, "--picture", "--quiet"], check=False)
            (folder / f"{name}.png").write_bytes(model.with_suffix(".png").read_bytes())


if __name__ == "__main__":
    main()
