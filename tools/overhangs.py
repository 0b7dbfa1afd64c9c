#!/usr/bin/env python3
"""Compares the overhangs of a model's plans with those of a simulated block.

usage: tools/overhangs.py SIMULATED MODEL
SIMULATED is the folder of `mansard simulate` (plans.json, truth.city.json), MODEL that of `mansard reconstruct
--profile-overhangs soffits` (plans.json). The true overhang of an edge is the height of its gutter above the soffit of
its part, by its pitch. Edges of 2 m and more under a pitched roof are compared with the nearest parallel edge of the
model within 1 m.
"""
import json
import math
import os
import statistics
import sys


def edges(path):
    """(id of the part, from, to, profile, base, overhang) of every edge."""
    with open(path, encoding="utf-8") as file:
        city = json.load(file)
    x0, y0, z0 = city["frame"]["origin"]
    for building in city["buildings"]:
        for part in building["parts"]:
            plan = part["plan"]
            for ring in [plan["outer"], *plan["holes"]]:
                points = [(x + x0, y + y0) for x, y in ring["points"]]
                overhangs = ring.get("overhang_of_edge", [0] * len(points))
                for i, point in enumerate(points):
                    profile = plan["profiles"][ring["profile_of_edge"][i]]
                    yield part["id"], point, points[(i + 1) % len(points)], profile, plan["base"] + z0, overhangs[i]


def soffits(path):
    """The heights of the soffits of a file, with a corner of each."""
    with open(path, encoding="utf-8") as file:
        city = json.load(file)
    scale, move = city["transform"]["scale"], city["transform"]["translate"]
    corner = lambda v: tuple(city["vertices"][v][k] * scale[k] + move[k] for k in range(3))
    for thing in city["CityObjects"].values():
        for geometry in thing.get("geometry", []):
            if geometry["type"] != "Solid" or "semantics" not in geometry:
                continue
            surfaces, values = geometry["semantics"]["surfaces"], geometry["semantics"]["values"][0]
            for face, value in zip(geometry["boundaries"][0], values):
                if value is not None and surfaces[value]["type"] == "OuterCeilingSurface":
                    yield [corner(v) for ring in face for v in ring]


def pitch_of(profile):
    """Rise over run of the roof above a vertical wall; 0 where there is none."""
    if len(profile) < 3 or profile[1][0] > 0 or profile[2][0] <= 0:
        return 0
    return (profile[2][1] - profile[1][1]) / profile[2][0]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    simulated, model = sys.argv[1:]
    ceilings = list(soffits(os.path.join(simulated, "truth.city.json")))
    made = list(edges(os.path.join(model, "plans.json")))
    true_length = found_length = false_length = clear_length = 0.0
    errors, walls = [], []
    for _, a, b, profile, base, _ in edges(os.path.join(simulated, "plans.json")):
        length, pitch = math.dist(a, b), pitch_of(profile)
        if length < 2 or pitch <= 0:
            continue
        along = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
        # The soffit that has both ends of the edge among its corners.
        truth = 0.0
        for corners in ceilings:
            if all(any(math.dist(p, c[:2]) < 0.06 for c in corners) for p in (a, b)):
                truth = (base + profile[1][1] - corners[0][2]) / pitch
        best = None
        for _, p, q, _, _, overhang in made:
            own = math.dist(p, q)
            if own < 1 or ((q[0] - p[0]) * along[0] + (q[1] - p[1]) * along[1]) / own < 0.995:
                continue
            middle = ((p[0] + q[0]) / 2 - a[0], (p[1] + q[1]) / 2 - a[1])
            on = middle[0] * along[0] + middle[1] * along[1]
            off = middle[0] * along[1] - middle[1] * along[0]
            if 0 <= on <= length and abs(off) < 1 and (best is None or abs(off) < abs(best[0])):
                best = (off, overhang)
        overhang = best[1] if best else 0
        if best:
            walls.append(best[0])
        if truth >= 0.05:
            true_length += length
            if overhang > 0:
                found_length += length
                errors.append(overhang - truth)
        else:
            clear_length += length
            false_length += length if overhang > 0 else 0
    percent = lambda part, whole: f"{100 * part / whole:.0f} %" if whole else "-"
    print(f"eaves that overhang    {true_length:.0f} m, found {percent(found_length, true_length)}")
    print(f"eaves that do not      {clear_length:.0f} m, found to overhang {percent(false_length, clear_length)}")
    if errors:
        print(f"overhang - truth       median {statistics.median(errors):+.3f} m, "
              f"median absolute {statistics.median(abs(e) for e in errors):.3f} m, {len(errors)} edges")
    if walls:
        print(f"wall - truth, outward  median {statistics.median(walls):+.3f} m, "
              f"median absolute {statistics.median(abs(w) for w in walls):.3f} m, {len(walls)} edges")


main()
