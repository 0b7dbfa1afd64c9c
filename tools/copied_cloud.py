#!/usr/bin/env python3
"""A large city of copies of a point cloud and its footprints, for measuring time and memory.

usage: tools/copied_cloud.py CLOUD FOOTPRINTS COLUMNS ROWS SPACING OUT

CLOUD is LAS or LAZ with offsets and bounds in its header; a copy is the same file with both moved, so its points are moved
without decoding them. FOOTPRINTS is GeoJSON. OUT gets tile_C_R.laz and footprints.geojson; ids get the column and row.
"""
import copy
import json
import pathlib
import struct
import sys


def moved_cloud(data, dx, dy):
    out = bytearray(data)
    for at, by in ((155, dx), (163, dy), (179, dx), (187, dx), (195, dy), (203, dy)):
        struct.pack_into("<d", out, at, struct.unpack_from("<d", out, at)[0] + by)
    return bytes(out)


def move(coordinates, dx, dy):
    if isinstance(coordinates[0], list):
        for inner in coordinates:
            move(inner, dx, dy)
    else:
        coordinates[0] += dx
        coordinates[1] += dy


def main():
    if len(sys.argv) != 7:
        sys.exit(__doc__)
    cloud, footprints = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    columns, rows, spacing, out = int(sys.argv[3]), int(sys.argv[4]), float(sys.argv[5]), pathlib.Path(sys.argv[6])
    out.mkdir(parents=True, exist_ok=True)
    data, city = cloud.read_bytes(), json.loads(footprints.read_text())
    features = []
    for column in range(columns):
        for row in range(rows):
            dx, dy = column * spacing, row * spacing
            (out / f"tile_{column}_{row}{cloud.suffix}").write_bytes(moved_cloud(data, dx, dy))
            for feature in copy.deepcopy(city["features"]):
                move(feature["geometry"]["coordinates"], dx, dy)
                for name in ("gml_id", "id", "fid"):
                    if name in feature["properties"]:
                        feature["properties"][name] = f"{feature['properties'][name]}-{column}-{row}"
                feature.pop("id", None)
                features.append(feature)
    city["features"] = features
    (out / "footprints.geojson").write_text(json.dumps(city))


if __name__ == "__main__":
    main()
