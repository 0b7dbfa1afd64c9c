#!/usr/bin/env python3
"""Counts planted tree crowns that leave a model as it is.

usage: tools/crowns.py SCAN MODEL.city.json WITHOUT.city.json [more triples…]

SCAN is a folder of `mansard simulate` with --simulate-crowns or --simulate-roof-trees; the two models are of that scan
and of the same scan without these trees. Samples are taken every 0.25 m within the radius of a crown, over either model.
A crown is without effect if the highest surfaces of the two models differ by more than 0.25 m, or one is missing, on at
most 5 % of them. It does no harm if the model is farther from the truth than the one without trees, by more than 0.25 m,
on at most 5 % of them.
"""
import json
import sys

SPACING, TOLERANCE, SHARE = 0.25, 0.25, 0.05


def faces_of(path):
    """Faces whose normal points upwards: ring, holes, plane and box of each."""
    with open(path, encoding="utf-8") as file:
        city = json.load(file)
    scale, shift = city["transform"]["scale"], city["transform"]["translate"]
    corners = [[v[i] * scale[i] + shift[i] for i in range(3)] for v in city["vertices"]]
    out = []
    for thing in city["CityObjects"].values():
        for geometry in thing.get("geometry", []):
            if geometry.get("lod") != "2.2" or geometry["type"] != "Solid":
                continue
            for shell in geometry["boundaries"]:
                for loops in shell:
                    rings = [[corners[v] for v in loop] for loop in loops]
                    normal = newell(rings[0])
                    if normal[2] > 1e-3 * sum(abs(n) for n in normal):
                        xs, ys = [p[0] for p in rings[0]], [p[1] for p in rings[0]]
                        out.append((rings, normal, min(xs), max(xs), min(ys), max(ys)))
    return out


def newell(ring):
    n = [0.0, 0.0, 0.0]
    for a, b in zip(ring, ring[1:] + ring[:1]):
        n[0] += (a[1] - b[1]) * (a[2] + b[2])
        n[1] += (a[2] - b[2]) * (a[0] + b[0])
        n[2] += (a[0] - b[0]) * (a[1] + b[1])
    return n


def inside(rings, x, y):
    odd = False
    for ring in rings:
        for a, b in zip(ring, ring[1:] + ring[:1]):
            if (a[1] <= y) != (b[1] <= y) and a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x:
                odd = not odd
    return odd


def top(faces, x, y):
    best = None
    for rings, n, west, east, south, north in faces:
        if not (west <= x <= east and south <= y <= north) or not inside(rings, x, y):
            continue
        p = rings[0][0]
        z = p[2] - (n[0] * (x - p[0]) + n[1] * (y - p[1])) / n[2]
        best = z if best is None else max(best, z)
    return best


def differing(crown, first, second, true):
    """Shares of the samples that differ, and that are worse, and how many there are."""
    (cx, cy, _), r = crown["centre"], crown["radius"]
    near = [[f for f in faces if f[2] <= cx + r and f[3] >= cx - r and f[4] <= cy + r and f[5] >= cy - r]
            for faces in (first, second, true)]
    steps = int(r / SPACING) + 1
    count = off = worse = 0
    for i in range(-steps, steps + 1):
        for j in range(-steps, steps + 1):
            x, y = cx + (i + 0.5) * SPACING, cy + (j + 0.5) * SPACING
            if (x - cx) ** 2 + (y - cy) ** 2 > r * r:
                continue
            a, b = top(near[0], x, y), top(near[1], x, y)
            if a is None and b is None:
                continue
            count += 1
            if a is None or b is None or abs(a - b) > TOLERANCE:
                off += 1
                truth = top(near[2], x, y)
                if error(a, truth) > error(b, truth) + TOLERANCE:
                    worse += 1
    return off / max(count, 1), worse / max(count, 1), count


def error(z, truth):
    """Both missing is right, one missing is wrong by a storey."""
    if z is None or truth is None:
        return 0.0 if z is truth else 3.0
    return abs(z - truth)


def main(arguments):
    if len(arguments) < 4 or (len(arguments) - 1) % 3:
        sys.exit(__doc__)
    total = {False: [0, 0, 0], True: [0, 0, 0]}
    for k in range(1, len(arguments), 3):
        folder, first, second = arguments[k:k + 3]
        with open(f"{folder}/truth.json", encoding="utf-8") as file:
            crowns = json.load(file)["crowns"]
        first, second, true = faces_of(first), faces_of(second), faces_of(f"{folder}/truth.city.json")
        for crown in crowns:
            share, worse, count = differing(crown, first, second, true)
            if count == 0:
                continue
            sums = total[crown["within"]]
            sums[0] += 1
            sums[1] += share <= SHARE
            sums[2] += worse <= SHARE
            if share > SHARE:
                x, y, z = crown["centre"]
                print(f"{folder} {crown['building']} ({x:.1f}, {y:.1f}, {z:.1f}) radius {crown['radius']:.1f} m, "
                      f"{'within' if crown['within'] else 'beside'}: {100 * share:.0f} % of {count} samples differ, "
                      f"{100 * worse:.0f} % are worse")
    for within, name in ((False, "beside the building"), (True, "within the outline")):
        print(f"crowns {name}: {total[within][1]} of {total[within][0]} without effect, {total[within][2]} without harm")
    both = [a + b for a, b in zip(total[False], total[True])]
    print(f"all: {both[1]} of {both[0]} without effect, {both[2]} without harm")


if __name__ == "__main__":
    main(sys.argv)
