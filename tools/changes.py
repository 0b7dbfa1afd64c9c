#!/usr/bin/env python3
"""Plants changes between two simulated surveys of a block, and counts what `mansard compare` finds of them (docs/compare.md).

usage: tools/changes.py survey OUT [FIRST LAST]   simulates, reconstructs and compares pairs of surveys: OUT/*.json
       tools/changes.py table OUT                 what was found, by kind of change and by pair of scans
The program is $MANSARD, else build/release/bin/mansard. Needs shapely.
"""
import collections
import copy
import csv
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys

from shapely.geometry import Polygon
from shapely.ops import unary_union

MANSARD = os.environ.get("MANSARD", "build/release/bin/mansard")
KINDS = ["terrace", "perimeter", "courtyard", "towers", "detached"]
CHANGES = ["new", "gone", "raised", "lowered", "extended", "reduced", "re-roofed"]
SHARE = 0.3  # of the buildings change

# Name, preset, points per m² (0: the mesh), further options.
SCANS = [
    ("faces", "clean", 0, []),
    ("oblique", "oblique-aerial", 0, []),
    ("lidar 20", "lidar-2.5d", 20, ["--simulate-points-noise", "0.02"]),
    ("drone", "nadir-drone", 0, []),
    ("lidar 3", "lidar-2.5d", 3, ["--simulate-points-noise", "0.05"]),
    ("matched 10", "oblique-aerial", 10, ["--simulate-trees", "15"]),
    ("lidar 8", "lidar-2.5d", 8, ["--simulate-points-noise", "0.03"]),
]
WAYS = {"models and scans": [], "models": ["--no-scans"], "old models of others": ["--no-scans"]}


def run(*command, allow=(0, 1)):
    code = subprocess.run([MANSARD, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if code.returncode not in allow:
        raise RuntimeError(f"mansard {' '.join(map(str, command))} ended with exit code {code.returncode}:\n{code.stderr}")


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def outline(part):
    return Polygon(part["plan"]["outer"]["points"], [hole["points"] for hole in part["plan"]["holes"]])


def main_part(building):
    return max(building["parts"], key=lambda part: outline(part).area)


def wall_of(plan):
    """Height of the lowest wall: the upright beginning of the profiles that have one."""
    walls = [profile[1][1] for profile in plan["profiles"] if profile[1][0] == 0]
    return min(min(walls, default=0), plan["cap"])


def lifted(plan, by):
    for profile in plan["profiles"]:
        for point in profile[1:]:
            point[1] += by
    plan["cap"] += by


def is_pitched(plan):
    return any(len(profile) > 2 and profile[2][0] > profile[1][0] for profile in plan["profiles"]) and plan["cap"] > wall_of(plan) + 1


def reroof(building, rng):
    """A flat roof instead of a pitched one, or hips instead of a flat one. Whether that changes a height by 1 m."""
    plan = main_part(building)["plan"]
    wall = wall_of(plan)
    if wall < 2.5:
        return False
    if is_pitched(plan):
        plan["profiles"] = [[[0, 0], [0, wall]]]
        plan["cap"] = wall
    else:
        pitch = math.tan(math.radians(rng.uniform(28, 42)))
        wall = plan["cap"]
        plan["profiles"] = [[[0, 0], [0, wall], [10, wall + 10 * pitch]]]
        plan["cap"] = wall + 6
    for ring in [plan["outer"], *plan["holes"]]:
        ring["profile_of_edge"] = [0] * len(ring["points"])
    return True


def extend(building, others, rng):
    """A part of one storey on free ground beside the largest one."""
    part = main_part(building)
    points = part["plan"]["outer"]["points"]
    taken = unary_union([outline(p) for b in others for p in b["parts"]])
    edges = list(range(len(points)))
    rng.shuffle(edges)
    for i in edges:
        (ax, ay), (bx, by) = points[i], points[(i + 1) % len(points)]
        length = math.hypot(bx - ax, by - ay)
        if length < 4:
            continue
        ux, uy = (bx - ax) / length, (by - ay) / length
        depth, width = rng.uniform(2.5, 5), rng.uniform(0.6, 0.95) * length
        start = (length - width) / 2
        corner = lambda along, out: [ax + along * ux + out * uy, ay + along * uy - out * ux]
        ring = [corner(start, depth), corner(start + width, depth), corner(start + width, 0), corner(start, 0)]
        own = unary_union([outline(p) for p in building["parts"]])
        if Polygon(ring).buffer(0.5).intersects(taken) or Polygon(ring).intersection(own).area > 0.01:
            continue
        height = rng.uniform(2.8, 3.6)
        building["parts"].append({"id": building["id"] + "-x", "attributes": {"ms_role": "extension"},
                                  "plan": {"base": part["plan"]["base"], "cap": height, "holes": [], "profiles": [[[0, 0], [0, height]]],
                                           "outer": {"points": ring, "profile_of_edge": [0] * 4}}})
        building.pop("footprint", None)
        return True
    return False


def planted(base, seed):
    """The plans of both states, and the kind of change by building."""
    rng = random.Random(seed)
    old, new = copy.deepcopy(base), copy.deepcopy(base)
    changes = {}
    for number, building in enumerate(base["buildings"]):
        if rng.random() >= SHARE or sum(outline(p).area for p in building["parts"]) < 20:
            continue
        kind = rng.choice(CHANGES)
        before, after = old["buildings"][number], new["buildings"][number]
        others = lambda city: [b for i, b in enumerate(city["buildings"]) if i != number]
        done = True
        if kind in ("raised", "lowered"):
            by = rng.uniform(2.5, 3.5)
            lifted(main_part(after if kind == "raised" else before)["plan"], by)
        elif kind == "extended":
            done = extend(after, others(new), rng)
        elif kind == "reduced":
            done = extend(before, others(old), rng)
        elif kind == "re-roofed":
            done = reroof(after, rng)
        if done:
            changes[building["id"]] = kind
    old["buildings"] = [b for b in old["buildings"] if changes.get(b["id"]) != "new"]
    new["buildings"] = [b for b in new["buildings"] if changes.get(b["id"]) != "gone"]
    return old, new, changes


def reconstructed(folder, plans, scan, seed):
    name, preset, points, more = scan
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "plans.json").write_text(json.dumps(plans), encoding="utf-8")
    run("simulate", folder / "plans.json", "--preset", preset, "--seed", seed, *more, *(["--points", points] if points else []),
        "-o", folder / "scene", "-q")
    scene = folder / "scene"
    run("reconstruct", scene / ("points.las" if points else "mesh.ply"), scene / "footprints.geojson", "-o", folder / "run", "-q")
    return {f["id"]: f["buildings"].split() for f in read(scene / "truth.json")["footprints"]}


def survey(out, number):
    result = out / f"{number:04d}.json"
    if result.exists():
        return
    first = SCANS[number % len(SCANS)]
    second = SCANS[(number + 1 + (number // len(SCANS)) % (len(SCANS) - 1)) % len(SCANS)]
    kind = KINDS[(number // 2) % len(KINDS)]
    folder = out / f"work-{number}"
    shutil.rmtree(folder, ignore_errors=True)
    seed = 5000 + number
    run("simulate", "--block", kind, "--preset", "clean", "--seed", seed, "--simulate-size", 80, "-o", folder / "base", "-q")
    old, new, changes = planted(read(folder / "base/plans.json"), seed)
    before = reconstructed(folder / "old", old, first, 2 * seed)
    after = reconstructed(folder / "new", new, second, 2 * seed + 1)
    found = {}
    for way, options in WAYS.items():
        source = folder / ("old/scene/truth.obj" if way == "old models of others" else "old/run")
        run("compare", source, folder / "new/run", *options, "-o", folder / "changes.csv", "--overwrite", "-q")
        rows = []
        with open(folder / "changes.csv", encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                of = set(after.get(row["id"], []))
                for one in row["ms_change_old"].split():
                    of |= set(before.get(one, [one]))
                rows.append({"buildings": sorted(of), **{k: row[k] for k in ("id", "ms_change", "ms_change_all", "ms_change_doubtful", "ms_change_height",
                             "ms_change_area", "ms_change_sigmas", "ms_change_reasons")}})
        found[way] = rows
    result.write_text(json.dumps({"number": number, "old": first[0], "new": second[0], "kind": kind, "seed": seed, "changes": changes,
                                  "found": found}, indent=1) + "\n", encoding="utf-8")
    if not os.environ.get("KEEP"):
        shutil.rmtree(folder)


# Where neighbours are one feature of one survey, a building that is new or gone is a part of it.
MAY_BE = {"new": {"new", "extended", "raised"}, "gone": {"gone", "reduced", "lowered"}, "raised": {"raised"}, "lowered": {"lowered"},
          "extended": {"extended"}, "reduced": {"reduced"}, "re-roofed": {"re-roofed"}}


def is_change(row):
    return row["ms_change"] not in ("unchanged", "not compared")


def table(out):
    surveys = [read(path) for path in sorted(out.glob("[0-9]*.json"))]
    for way in WAYS:
        planted_of, found_of, right_of = collections.Counter(), collections.Counter(), collections.Counter()
        pairs = collections.defaultdict(lambda: [0, 0, 0, 0])
        unchanged = false = doubtful = found_doubtful = 0
        for survey_ in surveys:
            rows, pair = survey_["found"][way], pairs[survey_["old"], survey_["new"]]
            for building, kind in survey_["changes"].items():
                own = [row for row in rows if building in row["buildings"] and is_change(row)]
                planted_of[kind] += 1
                pair[0] += 1
                if own:
                    found_of[kind] += 1
                    found_doubtful += all(row["ms_change_doubtful"] == "true" for row in own)
                    pair[1] += 1
                elif os.environ.get("SHOW"):
                    print("missed", survey_["number"], survey_["kind"], survey_["old"], survey_["new"], building, kind,
                          [(r["ms_change"], r["ms_change_height"], r["ms_change_reasons"]) for r in rows if building in r["buildings"]])
                if any(MAY_BE[kind] & set(row["ms_change_all"].split("; ")) for row in own):
                    right_of[kind] += 1
            for row in rows:
                if any(b in survey_["changes"] for b in row["buildings"]):
                    continue
                unchanged += 1
                pair[2] += 1
                if is_change(row):
                    if row["ms_change_doubtful"] == "true":
                        doubtful += 1
                        continue
                    false += 1
                    pair[3] += 1
                    if os.environ.get("SHOW"):
                        print("false", survey_["number"], survey_["kind"], survey_["old"], survey_["new"], row)
        percent = lambda a, b: f"{100 * a / b:.1f} %" if b else "-"
        print(f"\n{way}: {len(surveys)} pairs of surveys; {sum(planted_of.values())} planted changes, {percent(sum(found_of.values()), sum(planted_of.values()))} found, "
              f"{percent(found_doubtful, sum(planted_of.values()))} as doubtful, {percent(sum(right_of.values()), sum(planted_of.values()))} with the right kind; {unchanged} unchanged buildings, "
              f"{percent(false, unchanged)} reported as changed, {percent(doubtful, unchanged)} as doubtful")
        print("| planted | changes | found | right kind |\n|---|---|---|---|")
        for kind in CHANGES:
            print(f"| {kind} | {planted_of[kind]} | {percent(found_of[kind], planted_of[kind])} | {percent(right_of[kind], planted_of[kind])} |")
        if os.environ.get("PAIRS"):
            print("| old | new | changes | found | unchanged | false |\n|---|---|---|---|---|---|")
            for (a, b), n in sorted(pairs.items()):
                print(f"| {a} | {b} | {n[0]} | {percent(n[1], n[0])} | {n[2]} | {percent(n[3], n[2])} |")


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    if sys.argv[1] == "survey":
        first, last = (int(sys.argv[3]), int(sys.argv[4])) if len(sys.argv) > 4 else (0, 70)
        for number in range(first, last):
            survey(folder, number)
            print(number, flush=True)
    else:
        table(folder)
