#!/usr/bin/env python3
"""A city of any size for measurements: copies of one scanned block on a grid, a mesh file for each.

    copied_city.py OUT MESH.ply FOOTPRINTS.geojson COPIES_A_SIDE [SPACING]

MESH.ply is binary and little-endian with x, y, z as doubles first, as `mansard simulate` writes it. OUT gets mesh/ with
COPIES_A_SIDE² files, and footprints.geojson, whose ids are b1, b2, … SPACING is in whole metres, 230 by default.
"""
import array
import json
import pathlib
import re
import sys


def moved(coordinates, by):
    if isinstance(coordinates[0], (int, float)):
        return [coordinates[0] + by[0], coordinates[1] + by[1]]
    return [moved(inner, by) for inner in coordinates]


def main(out, mesh, footprints, side, spacing=230):
    out, side, spacing = pathlib.Path(out), int(side), int(spacing)
    (out / "mesh").mkdir(parents=True, exist_ok=True)
    data = pathlib.Path(mesh).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode()
    if "format binary_little_endian" not in header or not re.search(
            r"element vertex \d+\nproperty double x\nproperty double y\nproperty double z\nelement", header):
        sys.exit(f"{mesh}: not a PLY as `mansard simulate` writes it")
    count = int(re.search(r"element vertex (\d+)", header)[1])
    faces = data[end + 24 * count:]
    features = json.loads(pathlib.Path(footprints).read_text())["features"]
    copies = []
    for row in range(side):
        for column in range(side):
            by = (column * spacing, row * spacing)
            numbers = array.array("d", data[end:end + 24 * count])
            for axis in (0, 1):
                numbers[axis::3] = array.array("d", (x + by[axis] for x in numbers[axis::3]))
            (out / "mesh" / f"{row:03d}_{column:03d}.ply").write_bytes(data[:end] + numbers.tobytes() + faces)
            for feature in features:
                geometry = {"type": feature["geometry"]["type"],
                            "coordinates": moved(feature["geometry"]["coordinates"], by)}
                copies.append({"type": "Feature", "properties": {"id": f"b{len(copies) + 1}"}, "geometry": geometry})
    crs = {"type": "name", "properties": {"name": "EPSG:28992"}}
    (out / "footprints.geojson").write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": copies}))
    print(f"{len(copies)} footprints, {side * side} mesh files")


if __name__ == "__main__":
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    main(*sys.argv[1:])
