#!/usr/bin/env python3
"""Extrudes random footprints of every ugly kind: tools/outlines.py MANSARD OUT [--count 30000] [--seed 1] [--val3dity PROGRAM]

Each footprint is one of the kinds in KINDS, with one of the roof shapes, some with a second footprint that touches or
overlaps it. For every building, either all formats have its solids in LoD 2.2 and run.json and the attributes its
measures, or none has; with --val3dity, that finds no error in the CityJSON. Footprints go through in files of CHUNK; a
file with a fault is kept in OUT. Ends with 1 if there is any.
"""
import argparse
import json
import math
import pathlib
import random
import re
import shutil
import sqlite3
import struct
import subprocess
import sys

import val3dity

CHUNK = 1500
SHAPES = ["flat", "gabled", "hipped", "half-hipped", "pyramidal", "skillion", "gambrel", "mansard", "dome", "round", "saltbox",
          "no such shape"]
EPSILONS = [1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 5e-4, 9e-4, 1e-3, 1.1e-3, 2e-3, 5e-3, 1e-2, 5e-2, 0.1]


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def ngon(r, n, radius, turn=0.0, squash=1.0):
    return [(radius * math.cos(turn + 2 * math.pi * i / n), squash * radius * math.sin(turn + 2 * math.pi * i / n)) for i in range(n)]


def neck(r, e):
    return [[(0, 0), (6, 0), (6, 6 - e), (12, 6 - e), (12, 12), (6 - e, 12), (6 - e, 6), (0, 6)]]


def slit(r, e):
    at = r.uniform(2, 6)
    return [[(0, 0), (9, 0), (9, 8), (at + e, 8), (at + e, 2), (at, 2), (at, 8), (0, 8)]]


def sliver(r, e):
    return [[(0, 0), (r.uniform(5, 15), 0), (r.uniform(5, 15), e)]]


def strip(r, e):
    return [box(0, 0, r.uniform(2, 20), e)]


def spike(r, e):
    x = r.uniform(1, 8)
    return [[(0, 0), (9, 0), (9, 7), (x + e, 7), (x, r.uniform(8, 14)), (x - e, 7), (0, 7)]]


def thin_ring(r, e):
    return [box(0, 0, 10, 9), box(e, e, 10 - e, 9 - e)[::-1]]


def court_at_wall(r, e):
    return [box(0, 0, 10, 10), [(5, e), (3, 4), (7, 4)][::-1]]


def courts_that_touch(r, e):
    return [box(0, 0, 14, 10), box(2, 2, 6, 8)[::-1], box(6 + e, 3, 11, 7)[::-1]]


def court_outside(r, e):
    return [box(0, 0, 10, 10), box(8, 8, 12, 12)[::-1]]


def courts_that_overlap(r, e):
    return [box(0, 0, 14, 10), box(2, 2, 7, 8)[::-1], box(5, 3, 11, 7)[::-1]]


def court_in_court(r, e):
    return [box(0, 0, 14, 12), box(2, 2, 12, 10)[::-1], box(4, 4, 9, 8)[::-1]]


def bow_tie(r, e):
    return [[(0, 0), (8, 6), (8, 0), (0, 6 + e)]]


def scribble(r, e):
    return [[(r.uniform(0, 12), r.uniform(0, 12)) for _ in range(r.randrange(4, 14))]]


def star(r, e):
    n = r.randrange(4, 20)
    return [[((9 if i % 2 else r.uniform(0.5, 8)) * math.cos(math.pi * i / n), (9 if i % 2 else r.uniform(0.5, 8)) * math.sin(math.pi * i / n))
             for i in range(2 * n)]]


def comb(r, e):
    ring, n = [(0, 0), (r.randrange(3, 12) * 1.0, 0)], 0
    n = int(ring[1][0])
    for i in range(n, 0, -1):
        ring += [(i, 6), (i - 0.5 - e, 6), (i - 0.5 - e, 1), (i - 1 + e, 1)]
    return [ring + [(0, 6)]]


def spiral(r, e):
    turns, wide = r.randrange(2, 4), r.uniform(1.2, 2)
    out = [((1 + a * 0.5) * math.cos(a), (1 + a * 0.5) * math.sin(a)) for a in (k * 0.4 for k in range(int(turns * 15)))]
    return [[(x * (1 + wide / math.hypot(x, y)), y * (1 + wide / math.hypot(x, y))) for x, y in out] + out[::-1]]


def many_corners(r, e):
    return [ngon(r, r.randrange(30, 300), r.uniform(4, 12), squash=r.uniform(0.3, 1))]


def nearly_straight(r, e):
    base = box(0, 0, r.uniform(6, 14), r.uniform(5, 10))
    out = []
    for (x0, y0), (x1, y1) in zip(base, base[1:] + base[:1]):
        out.append((x0, y0))
        for t in sorted(r.random() for _ in range(r.randrange(1, 5))):
            out.append((x0 + t * (x1 - x0) + r.uniform(-e, e), y0 + t * (y1 - y0) + r.uniform(-e, e)))
    return [out]


def repeated(r, e):
    out = []
    for p in ngon(r, r.randrange(3, 9), 7, r.random()):
        out += [p] * r.randrange(1, 4)
    return [out]


def there_and_back(r, e):
    return [[(0, 0), (8, 0), (8, 6), (12, 6), (8, 6 + e), (0, 6)]]


def stairs(r, e):
    n, out = r.randrange(3, 12), [(0, 0), (10, 0)]
    for i in range(n):
        out += [(10 - 10 * i / n, 2 + 6 * i / n), (10 - 10 * i / n, 2 + 6 * (i + 1) / n)]
    return [out + [(0, 8)]]


def tiny(r, e):
    return [ngon(r, r.randrange(3, 7), 10 * e, r.random())]


def huge(r, e):
    return [ngon(r, r.randrange(3, 7), r.uniform(100, 400), r.random(), r.uniform(0.02, 1))]


def right_angles(r, e):
    w, d, a, b = r.uniform(8, 14), r.uniform(8, 14), r.uniform(2, 6), r.uniform(2, 6)
    return [[(0, 0), (w, 0), (w, b), (a + r.uniform(-e, e), b + r.uniform(-e, e)), (a, d), (0, d)]]


def wrong_way(r, e):
    return [right_angles(r, e)[0][::-1]]


KINDS = [neck, slit, sliver, strip, spike, thin_ring, court_at_wall, courts_that_touch, court_outside, courts_that_overlap,
         court_in_court, bow_tie, scribble, star, comb, spiral, many_corners, nearly_straight, repeated, there_and_back, stairs, tiny,
         huge, right_angles, wrong_way]


def placed(rings, angle, x, y):
    c, s = math.cos(angle), math.sin(angle)
    return [[[x + c * u - s * v, y + s * u + c * v] for u, v in ring + ring[:1]] for ring in rings]


def features(chance, first, count):
    out = []
    for i in range(first, first + count):
        kind = chance.choice(KINDS)
        where = (chance.choice([0, 0, chance.uniform(0, math.pi)]), 1000.0 * (i % 40), 1000.0 * (i // 40 % 40))
        if chance.random() < 0.3:
            where = (where[0], where[1] + chance.random(), where[2] + chance.random())
        for n in range(2 if chance.random() < 1 / 8 else 1):
            rings = kind(chance, chance.choice(EPSILONS)) if n == 0 else [box(-4 + chance.choice([0, 1e-4, 0.3]), -3, 0, 12)]
            out.append({"type": "Feature", "properties": {
                "id": f"{kind.__name__}_{i}" + "b" * n, "roof:shape": chance.choice(SHAPES), "height": chance.choice([3, 6, 9, 30]),
                **chance.choice([{}, {"roof:height": chance.choice([0.001, 2, 5])}, {"roof:angle": chance.choice([1, 30, 60, 85])},
                                 {"roof:orientation": "across"}, {"roof:direction": chance.uniform(0, 360)}])},
                "geometry": {"type": "Polygon", "coordinates": placed(rings, *where)}})
    return out


def in_glb(path):
    data = path.read_bytes()
    nodes = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]]).get("nodes", [])
    return {node["extras"]["building"] for node in nodes if "mesh" in node and "building" in node.get("extras", {})}


def in_cityjson(objects):
    return {thing.get("parents", [key])[0] for key, thing in objects.items()
            if any(g["type"] == "Solid" and str(g["lod"]) == "2.2" for g in thing.get("geometry", []))}


def found_in(folder):
    """The buildings with a solid of LoD 2.2, format by format."""
    gml = (folder / "model.gml").read_text(encoding="utf-8")
    with sqlite3.connect(folder / "model.gpkg") as table:
        has = table.execute("select count(*) from sqlite_master where name = 'solids_lod22'").fetchone()[0]
        package = {row[0] for row in table.execute("select building_id from solids_lod22")} if has else set()
    lines = (folder / "model.city.jsonl").read_text(encoding="utf-8").splitlines()
    obj, owner = set(), None
    for line in (folder / "model.obj").read_text(encoding="utf-8").splitlines():
        owner = line[2:] if line.startswith("o ") else owner
        if line.startswith("f "):
            obj.add(owner)
    return {"cityjson": in_cityjson(json.loads((folder / "model.city.json").read_text(encoding="utf-8"))["CityObjects"]),
            "cityjsonseq": set().union(*(in_cityjson(json.loads(line).get("CityObjects", {})) for line in lines)),
            "citygml": {m for m in re.findall(r'<gml:Solid gml:id="(.*?)(?:_solid\d+)?_lod2"', gml)},
            "geopackage": package, "obj": obj, "glb": in_glb(folder / "model.glb")}


def faults_of(folder):
    report = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    city = json.loads((folder / "model.city.json").read_text(encoding="utf-8"))["CityObjects"]
    outcomes, faults, there = {}, [], set()
    for building in report["buildings"]:
        outcomes[building["outcome"]] = outcomes.get(building["outcome"], 0) + 1
        made = building["outcome"] in ("full", "fallback")
        if made:
            there.add(building["id"])
        own = city[building["id"]]["attributes"]
        if made != (building.get("volume_m3", 0) > 0) or made != (building["parts"] > 0) or made != own["ms_success"] or \
                made != ("ms_volume_lod22" in own) or (not made and not building["reasons"]):
            faults.append(f'{building["id"]}: {building["outcome"]} with {building["parts"]} parts')
    for name, ids in found_in(folder).items():
        for one in sorted(ids ^ there):
            faults.append(f'{one}: {"only" if one in ids else "not"} in {name}')
    return outcomes, faults


def main():
    asked = argparse.ArgumentParser()
    asked.add_argument("mansard")
    asked.add_argument("out", type=pathlib.Path)
    asked.add_argument("--count", type=int, default=30000)
    asked.add_argument("--seed", type=int, default=1)
    asked.add_argument("--val3dity")
    asked = asked.parse_args()
    chance, total, faults, done = random.Random(asked.seed), {}, 0, 0
    while done < asked.count:
        some = features(chance, done, min(CHUNK, asked.count - done))
        folder = asked.out / f"{done:06}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        prints = folder / "footprints.geojson"
        prints.write_text(json.dumps({"type": "FeatureCollection", "features": some}), encoding="utf-8")
        done += CHUNK
        run = subprocess.run([asked.mansard, "extrude", "-q", prints, "-o", folder / "out", "--crs", "local", "--formats",
                              "cityjson,cityjsonseq,citygml,geopackage,obj,glb"], capture_output=True, text=True)
        said = []
        if run.returncode in (0, 1):
            outcomes, said = faults_of(folder / "out")
            for name, count in outcomes.items():
                total[name] = total.get(name, 0) + count
            if asked.val3dity:
                found = val3dity.check(asked.val3dity, folder / "out" / "model.city.json", folder / "val3dity.json")
                said += val3dity.errors_of(found)
        else:
            said = [f"exit code {run.returncode}: {run.stderr[-300:]}"]
        faults += len(said)
        print(f"outlines: {folder.name}: {'failed' if said else 'passed'}", flush=True)
        for line in said[:20]:
            print("  " + line)
        if not said:
            shutil.rmtree(folder)
    print(f"{asked.count} footprints: {total}, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
