#!/usr/bin/env python3
"""Extrudes random buildings with parts as OpenStreetMap has them: tools/building_parts.py MANSARD OUT [--count 2000]
[--seed 1] [--shapes] [--val3dity PROGRAM]

With --shapes: every roof:shape over seven outlines at three angles instead, of which each must be as high as its tag within
5 mm. Outlines of many kinds have up to six parts that stand side by side, on each other, within each other or in the air, with any
roof:shape and with tags as mappers write them. Checked are: every building has a model unless it says why; every part is
as high as its tags, or says why; no solid is invalid by mansard's own check; and with --val3dity, that finds no
error in the CityJSON. Features go through in files of CHUNK; a file with a fault stays in OUT.
"""
import argparse
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys

import val3dity

CHUNK = 250
SHAPES = """flat skillion gabled half-hipped hipped pyramidal gambrel mansard saltbox gabled_height_moved bellcast_gable
side_hipped side_half-hipped hipped-and-gabled round cone dome onion butterfly sawtooth crosspitched many dutch""".split()


def turned(ring, angle, x, y):
    c, s = math.cos(angle), math.sin(angle)
    points = [[round(x + c * px - s * py, 3), round(y + s * px + c * py, 3)] for px, py in ring]
    return points + points[:1]


def outline(chance, size):
    kind, w, d = chance.randrange(7), size * chance.uniform(0.6, 1.4), size * chance.uniform(0.4, 1)
    if kind == 0:
        return [[0, 0], [w, 0], [w, d], [0, d]]
    if kind == 1:
        return [[0, 0], [w, 0], [w, d / 2], [w / 3, d / 2], [w / 3, d], [0, d]]
    if kind == 2:
        return [[0, d / 2], [w / 3, d / 2], [w / 3, 0], [2 * w / 3, 0], [2 * w / 3, d / 2], [w, d / 2], [w, d], [0, d]]
    if kind == 3:
        n = chance.choice([5, 8, 12, 24])
        return [[w / 2 + w / 2 * math.cos(2 * math.pi * i / n), d / 2 + w / 2 * math.sin(2 * math.pi * i / n)] for i in range(n)]
    if kind == 4:
        return [[0, 0], [w, 0], [w * chance.random(), d]]
    if kind == 5:
        n = chance.randrange(5, 10)
        return [[w / 2 + w * chance.uniform(0.25, 0.6) * math.cos(2 * math.pi * (i + chance.uniform(0.1, 0.9)) / n),
                 d / 2 + w * chance.uniform(0.25, 0.6) * math.sin(2 * math.pi * (i + chance.uniform(0.1, 0.9)) / n)] for i in range(n)]
    return [[0, 0], [w, 0], [w, max(0.4, d / 20)], [0, max(0.4, d / 20)]]


def length(chance, metres):
    kind = chance.randrange(5)
    if kind == 0:
        return f"{metres:.2f} m"
    if kind == 1:
        return f"{metres:.2f}".replace(".", ",")
    if kind == 2:
        inches = round(metres / 0.0254)
        return f"{inches // 12}'{inches % 12}\""
    return round(metres, 2) if kind == 3 else f"{metres:.2f}"


def tags_of(chance, base):
    tags, top = {}, base + chance.choice([0.5, 3, 6, 9, 12, 20]) * chance.uniform(0.8, 1.3)
    tags["height"] = length(chance, top)
    if base > 0:
        tags["min_height"] = length(chance, base)
    if chance.random() < 0.8:
        tags["roof:shape"] = chance.choice(SHAPES)
    if chance.random() < 0.6:
        tags["roof:height"] = length(chance, (top - base) * chance.uniform(0.1, 1))
    if chance.random() < 0.2:
        tags["roof:direction"] = chance.choice(["N", "SE", "WSW", "200", "33.5"])
    if chance.random() < 0.2:
        tags["roof:orientation"] = chance.choice(["along", "across"])
    if chance.random() < 0.2:
        tags["building:colour"] = chance.choice(["red", "#ccaa99", "beige"])
    return tags, top


def features(chance, first, count):
    out = []
    for b in range(first, first + count):
        x, y, angle = 100.0 * (b % 40), 100.0 * (b // 40), chance.choice([0, 0.3, 1.1, chance.uniform(0, 6)])
        size = chance.uniform(6, 30)
        whole = outline(chance, size)

        def add(ring, name, tags):
            out.append({"type": "Feature", "properties": {"id": name, **tags},
                        "geometry": {"type": "Polygon", "coordinates": [turned(ring, angle, x, y)]}})

        own, _ = tags_of(chance, 0)
        add(whole, f"b{b}", {"building": "yes", **own})
        tops = [0.0]
        for p in range(chance.randrange(0, 7)):
            ring = whole if chance.random() < 0.3 else outline(chance, size * chance.uniform(0.2, 0.8))
            dx, dy = (0, 0) if ring is whole else (chance.uniform(-0.1, 0.6) * size, chance.uniform(-0.1, 0.6) * size)
            if chance.random() < 0.4:  # corners on a grid, so that walls coincide
                dx, dy = round(dx), round(dy)
                ring = [[round(px), round(py)] for px, py in ring] if ring is not whole else ring
            base = chance.choice([0, 0, chance.choice(tops), chance.choice(tops), chance.uniform(0, 1.2) * max(tops)])
            tags, top = tags_of(chance, round(base, 2))
            tops.append(round(top, 2))
            add([[px + dx, py + dy] for px, py in ring], f"b{b}p{p}", {"building:part": "yes", **tags})
    return out


def table():
    """Every shape over outlines of seven kinds at three angles, 9 m high with 3 m of roof."""
    out = []
    outlines = {"rectangle": [[0, 0], [12, 0], [12, 8], [0, 8]],
                "L": [[0, 0], [12, 0], [12, 5], [5, 5], [5, 12], [0, 12]],
                "T": [[0, 8], [6, 8], [6, 0], [10, 0], [10, 8], [16, 8], [16, 14], [0, 14]],
                "courtyard": [[0, 0], [20, 0], [20, 20], [0, 20]],
                "round": [[5 * math.cos(2 * math.pi * i / 24), 5 * math.sin(2 * math.pi * i / 24)] for i in range(24)],
                "sliver": [[0, 0], [20, 0], [20, 0.5], [0, 0.5]],
                "triangle": [[0, 0], [10, 0], [3, 7]]}
    for row, shape in enumerate(SHAPES[:-1]):
        for column, (name, ring) in enumerate(outlines.items()):
            for place, angle in enumerate((0, 0.37, 1.1)):
                x, y = 40 * (3 * column + place), 40 * row
                rings = [ring] + ([[[6, 6], [6, 14], [14, 14], [14, 6]]] if name == "courtyard" else [])
                out.append({"type": "Feature", "properties": {"id": f"{shape} {name} {place}", "building": "yes", "height": "9",
                                                              "roof:height": "3", "roof:shape": shape},
                            "geometry": {"type": "Polygon", "coordinates": [turned(one, angle, x, y) for one in rings]}})
    return out


def faults_of(folder, top=None):
    """Of run.json and the CityJSON."""
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    outcomes, faults, codes = {}, [], {}
    for building in run["buildings"]:
        outcomes[building["outcome"]] = outcomes.get(building["outcome"], 0) + 1
        for reason in building["reasons"]:
            codes[reason["code"]] = codes.get(reason["code"], 0) + 1
        if building["outcome"] in ("fallback", "refused") and not building["reasons"]:
            faults.append(f'{building["id"]}: {building["outcome"]} without a reason')
    city = json.loads((folder / "model.city.json").read_text(encoding="utf-8"))
    for name, thing in city["CityObjects"].items():
        own = thing.get("attributes", {})
        if top is not None and thing["type"] == "Building" and abs(own["ms_h_roof_max"] - top) > 0.005:
            faults.append(f'{name}: {own["ms_h_roof_max"]} m high')
        if own.get("ms_val3dity_lod22", "[]") != "[]":
            faults.append(f'{name}: {own["ms_val3dity_lod22"]} by mansard\'s own check')
    return outcomes, codes, faults


def main():
    asked = argparse.ArgumentParser()
    asked.add_argument("mansard")
    asked.add_argument("out", type=pathlib.Path)
    asked.add_argument("--count", type=int, default=2000)
    asked.add_argument("--seed", type=int, default=1)
    asked.add_argument("--shapes", action="store_true")
    asked.add_argument("--val3dity")
    asked = asked.parse_args()
    if asked.shapes:
        asked.count = 1
    chance, total, all_codes, faults, solids, done = random.Random(asked.seed), {}, {}, 0, 0, 0
    while done < asked.count:
        some = table() if asked.shapes else features(chance, done, min(CHUNK, asked.count - done))
        folder = asked.out / f"{done:06}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        source = folder / "osm.geojson"
        source.write_text(json.dumps({"type": "FeatureCollection", "features": some}), encoding="utf-8")
        done += CHUNK
        run = subprocess.run([asked.mansard, "extrude", "-q", source, "-o", folder / "out", "--crs", "local", "--formats",
                              "cityjson,glb"], capture_output=True, text=True)
        said = []
        if run.returncode in (0, 1):
            outcomes, codes, said = faults_of(folder / "out", 9 if asked.shapes else None)
            for to, some in ((total, outcomes), (all_codes, codes)):
                for name, count in some.items():
                    to[name] = to.get(name, 0) + count
            if asked.val3dity:
                found = val3dity.check(asked.val3dity, folder / "out" / "model.city.json", folder / "val3dity.json")
                solids += sum(kind["total"] for kind in found["primitives_overview"] if kind["type"] == "Solid")
                said += val3dity.errors_of(found)
        else:
            said = [f"exit code {run.returncode}: {run.stderr[-300:]}"]
        faults += len(said)
        print(f"building parts: {folder.name}: {'failed' if said else 'passed'}", flush=True)
        for line in said[:20]:
            print("  " + line)
        if not said:
            shutil.rmtree(folder)
    print(f"{sum(total.values())} buildings: {total}, {faults} faults" + (f", {solids} solids by val3dity" if asked.val3dity else ""))
    print("reasons: " + ", ".join(f"{name} {count}" for name, count in sorted(all_codes.items())))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
