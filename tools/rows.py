#!/usr/bin/env python3
"""Says whether a model draws alike what is alike: docs/evaluate.md, "Rows". Truth is a folder of `mansard simulate`.

usage: tools/rows.py TRUTH MODEL.city.json [TRUTH MODEL.city.json…]

The largest roof plane of a true house to each side (azimuths within 3°, pitched 10° to 75°, 8 m² and more seen from
above) is compared with that of the neighbour on the same side, and with that opposite in the same house: pitch, eave
(the middle of its lowest level edge of 1 m and more) and ridge (of its highest). Equal: within 0.2° and 1 cm. Unequal: 2° and 0.2 m apart and more; what
is between is counted nowhere. The model has the plane where it has a face of that azimuth within 5°, of that pitch
within 6° and within 0.5 m of the true plane's middle.
"""
import json
import math
import pathlib
import sys

EQUAL = {"pitch": 0.2, "eave": 0.01, "ridge": 0.01}
UNEQUAL = {"pitch": 2.0, "eave": 0.2, "ridge": 0.2}


def roof_faces(path):
    """[(building, plane)] of the highest level of detail of a CityJSON file."""
    city = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    scale, shift = city["transform"]["scale"], city["transform"]["translate"]
    points = [[v[i] * scale[i] + shift[i] for i in range(3)] for v in city["vertices"]]
    for name, thing in city["CityObjects"].items():
        solids = [g for g in thing.get("geometry", []) if g["type"] == "Solid"]
        if not solids:
            continue
        solid = max(solids, key=lambda g: g["lod"])
        kinds = solid["semantics"]["surfaces"]
        if solid["lod"].startswith("1"):
            continue
        building = (thing.get("parents") or [name])[0]
        for shell, values in zip(solid["boundaries"], solid["semantics"]["values"]):
            for face, value in zip(shell, values):
                if kinds[value]["type"] == "RoofSurface":
                    yield building, plane_of([[points[v] for v in loop] for loop in face])


def plane_of(loops):
    ring = loops[0]
    nx = ny = nz = 0.0
    for (ax, ay, az), (bx, by, bz) in zip(ring, ring[1:] + ring[:1]):
        nx += (ay - by) * (az + bz) / 2
        ny += (az - bz) * (ax + bx) / 2
        nz += (ax - bx) * (ay + by) / 2
    n = len(ring)
    # The middles of its nearly level edges of 1 m and more near its lowest and highest corner, or those corners.
    low, high = min(p[2] for p in ring), max(p[2] for p in ring)
    level = [(a[2] + b[2]) / 2 for a, b in zip(ring, ring[1:] + ring[:1])
             if math.dist(a, b) >= 1 and abs(a[2] - b[2]) < 0.05 * math.dist(a, b)]
    low = min([z for z in level if z < (low + high) / 2] or [low])
    high = max([z for z in level if z > (low + high) / 2] or [high])
    middle = [sum(p[i] for p in ring) / n for i in range(3)]
    return {"azimuth": math.degrees(math.atan2(ny, nx)), "pitch": math.degrees(math.atan2(math.hypot(nx, ny), nz)),
            "area": nz, "normal": (nx, ny, nz), "ring": ring, "middle": middle, "eave": low,
            "ridge": high}


def turn(a, b):
    return abs((a - b + 180) % 360 - 180)


def contains(ring, x, y):
    inside = False
    for (ax, ay, _), (bx, by, _) in zip(ring, ring[1:] + ring[:1]):
        if (ay <= y) != (by <= y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


def main_planes(path):
    """Building → its largest plane to each side."""
    out = {}
    for building, plane in sorted(roof_faces(path), key=lambda one: -one[1]["area"]):
        sides = out.setdefault(building, [])
        if 10 <= plane["pitch"] <= 75 and plane["area"] >= 8 and all(
                turn(plane["azimuth"], side["azimuth"]) > 3 for side in sides):
            sides.append(plane)
    return out


def in_model(plane, faces):
    x, y, z = plane["middle"]
    best = None
    for _, face in faces:
        if face["area"] <= 0 or turn(face["azimuth"], plane["azimuth"]) > 5 or abs(face["pitch"] - plane["pitch"]) > 6:
            continue
        if not contains(face["ring"], x, y):
            continue
        (nx, ny, nz), (mx, my, mz) = face["normal"], face["ring"][0]
        off = abs(mz - (nx * (x - mx) + ny * (y - my)) / nz - z)
        if off < 0.5 and (best is None or off < best[0]):
            best = off, face
    return best and best[1]


def compare(truth, model, counts):
    truth = pathlib.Path(truth)
    sides = main_planes(truth / "truth.city.json")
    faces = list(roof_faces(model))
    pairs = []
    for wall in json.loads((truth / "truth.json").read_text(encoding="utf-8"))["party_walls"]:
        for a in sides.get(wall["first"], []):
            for b in sides.get(wall["second"], []):
                if turn(a["azimuth"], b["azimuth"]) <= 3:
                    pairs.append(("row", a, b))
    for own in sides.values():
        for i, a in enumerate(own):
            for b in own[i + 1:]:
                if turn(a["azimuth"], b["azimuth"] + 180) <= 3:
                    pairs.append(("house", a, b))
    for kind, a, b in pairs:
        found = in_model(a, faces), in_model(b, faces)
        for what in EQUAL:
            off = abs(a[what] - b[what])
            real = "equal" if off <= EQUAL[what] else "unequal" if off >= UNEQUAL[what] else None
            if real is None:
                continue
            row = counts.setdefault((kind, what, real), [0, 0, 0])
            row[0] += 1
            if all(found):
                row[1] += 1
                # Files round coordinates: a tenth of a millimetre more.
                row[2] += abs(found[0][what] - found[1][what]) <= EQUAL[what] + 1e-4


if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
    sys.exit(__doc__)
counts = {}
for truth, model in zip(sys.argv[1::2], sys.argv[2::2]):
    compare(truth, model, counts)
print("| pairs | in truth | of the truth | both in the model | there equal |\n|---|---|---|---|---|")
for real in ("equal", "unequal"):
    for kind in ("house", "row"):
        for what in EQUAL:
            of, found, same = counts.get((kind, what, real), [0, 0, 0])
            share = f" ({100 * same / found:.0f} %)" if found else ""
            print(f"| {kind}: {what} | {real} | {of} | {found} | {same}{share} |")
