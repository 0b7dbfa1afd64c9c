#!/usr/bin/env python3
"""Scans models that mansard wrote perfectly, reconstructs them again, and compares.

usage: tools/fixed_point.py [--planes SHARE] [--volume SHARE] MANSARD OUTDIR INPUT…
INPUT is a model of mansard (….city.json), a folder as those of data (footprints.geojson, a mesh, reading.json), or
KIND:SEED, a block of `mansard simulate` scanned with the preset oblique-aerial (KIND:SEED:SIZE: with --simulate-size).
What is no model is reconstructed first. The model is scanned with `mansard simulate MODEL --preset clean` and
reconstructed from that scan and its true footprints.
A building has the same planes when every roof plane of at least 1 m² of either model is found in the other one: within
3°, with a plan that overlaps at least half of the smaller of the two, and within 0.25 m in height in the middle of the
overlap, as `mansard evaluate --truth` has it; plans are sampled every 0.25 m here. The volume is that of all buildings;
the last column has it above the ground of the first model, since `simulate` makes another ground, with waves, and the
lowest of that at the walls is lower. OUTDIR/NAME/different.txt lists the buildings that differ.
Exit code 1 where less than --planes of the buildings of an input have the same planes (0.95), or its volume above the
first ground differs by more than --volume (0.005); 2 for a command that failed.
"""
import argparse
import glob
import json
import math
import os
import subprocess
import sys

STEP = 0.25  # m
LEAST, ANGLE, HEIGHT = 1.0, 3.0, 0.25  # m², degrees, m: found_… of mansard/evaluate/form.hpp
JOIN_ANGLE, JOIN_DISTANCE = 2.0, 0.1  # degrees, m: same_plane_… of the same


def read(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def newell(ring):
    """Twice the area of a ring, along its normal."""
    n = [0.0, 0.0, 0.0]
    for p, q in zip(ring, ring[1:] + ring[:1]):
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            n[k] += (p[i] - q[i]) * (p[j] + q[j])
    return n


def unit(n):
    length = math.sqrt(sum(x * x for x in n)) or 1.0
    return [x / length for x in n]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Plane:
    """Faces in one plane, and the cells of their plan."""

    def __init__(self, face):
        self.normal, self.point = unit(newell(face[0])), face[0][0]
        self.area, self.cells = 0.0, set()

    def takes(self, face):
        return (dot(self.normal, unit(newell(face[0]))) > math.cos(math.radians(JOIN_ANGLE)) and
                all(abs(dot(self.normal, [x - y for x, y in zip(p, self.point)])) < JOIN_DISTANCE for p in face[0]))

    def add(self, face):
        self.area += math.sqrt(sum(x * x for x in map(sum, zip(*map(newell, face))))) / 2
        ys = [p[1] for p in face[0]]
        for row in range(math.ceil(min(ys) / STEP - 0.5), math.floor(max(ys) / STEP - 0.5) + 1):
            y, cuts = (row + 0.5) * STEP, []
            for ring in face:
                for p, q in zip(ring, ring[1:] + ring[:1]):
                    if (p[1] > y) != (q[1] > y):
                        cuts.append(p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]))
            cuts.sort()
            for x0, x1 in zip(cuts[::2], cuts[1::2]):
                self.cells.update((c, row) for c in range(math.ceil(x0 / STEP - 0.5), math.floor(x1 / STEP - 0.5) + 1))

    def z(self, x, y):
        n, p = self.normal, self.point
        return p[2] - (n[0] * (x - p[0]) + n[1] * (y - p[1])) / n[2]

    def found_in(self, others):
        for other in others:
            both = self.cells & other.cells
            if not both or 2 * len(both) < min(len(self.cells), len(other.cells)):
                continue
            if dot(self.normal, other.normal) < math.cos(math.radians(ANGLE)):
                continue
            x, y = (STEP * (sum(c[k] for c in both) / len(both) + 0.5) for k in (0, 1))
            if abs(self.z(x, y) - other.z(x, y)) <= HEIGHT:
                return True
        return False


def buildings(city, origin):
    """id → (roof planes, m³, base, m² of ground) of every building of CityJSON, in coordinates less an origin."""
    scale, move = city["transform"]["scale"], city["transform"]["translate"]
    points = [[v[k] * scale[k] + (move[k] - origin[k]) for k in range(3)] for v in city["vertices"]]
    objects, out = city["CityObjects"], {}
    for name, thing in objects.items():
        if thing["type"] != "Building":
            continue
        faces, volume, base, ground = [], 0.0, math.inf, 0.0
        for part in [thing] + [objects[child] for child in thing.get("children", [])]:
            solids = [g for g in part.get("geometry", []) if g["type"] == "Solid"]
            if not solids:
                continue
            solid = max(solids, key=lambda g: g["lod"])
            for shell, kinds in zip(solid["boundaries"], solid["semantics"]["values"]):
                for rings, kind in zip(shell, kinds):
                    face = [[points[v] for v in ring] for ring in rings]
                    volume += sum(dot(ring[0], newell(ring)) for ring in face) / 6
                    kind = kind if kind is None else solid["semantics"]["surfaces"][kind]["type"]
                    if kind == "RoofSurface":
                        faces.append(face)
                    elif kind == "GroundSurface":
                        base = min(base, min(p[2] for p in face[0]))
                        ground -= sum(newell(ring)[2] for ring in face) / 2
        planes = []
        for face in sorted(faces, key=lambda f: -math.sqrt(sum(x * x for x in newell(f[0])))):
            if unit(newell(face[0]))[2] < 0.01:
                continue
            plane = next((p for p in planes if p.takes(face)), None)
            if plane is None:
                planes.append(plane := Plane(face))
            plane.add(face)
        out[name] = ([p for p in planes if p.area >= LEAST and p.cells], volume, base, ground)
    return out


def run(*command):
    done = subprocess.run([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode > 1:  # 1: some buildings fell back
        print(f"fixed_point: {' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}", file=sys.stderr)
        sys.exit(2)


def model_of(mansard, given, out):
    """The model of an input, made where there is none."""
    if given.endswith(".json"):
        return given
    options = []
    if os.path.isdir(given):
        if os.path.exists(f"{given}/reading.json"):
            options = ["--mesh-offset", *read(f"{given}/reading.json")["ingest.mesh_offset"].split()]
        mesh = next(iter(m for kind in ("off", "ply") for m in glob.glob(f"{given}/*mesh.{kind}")), f"{given}/mesh.ply")
        footprints = next(iter(glob.glob(f"{given}/*footprints.geojson")), f"{given}/footprints.geojson")
    else:
        kind, seed, *size = given.split(":")
        run(mansard, "simulate", "-q", "--block", kind, "--seed", seed, "--preset", "oblique-aerial", "--overwrite",
            *[word for s in size for word in ("--simulate-size", s)], "-o", f"{out}/block")
        mesh, footprints = f"{out}/block/mesh.ply", f"{out}/block/footprints.geojson"
    run(mansard, "reconstruct", "-q", mesh, footprints, *options, "--overwrite", "-o", f"{out}/first")
    return f"{out}/first/model.city.json"


def compare(mansard, given, out):
    """Buildings, those with the same planes, the ratio of the volumes as they are and above one ground, who differs."""
    first = model_of(mansard, given, out)
    run(mansard, "simulate", "-q", first, "--preset", "clean", "--overwrite", "-o", f"{out}/scan")
    run(mansard, "reconstruct", "-q", f"{out}/scan/mesh.ply", f"{out}/scan/truth.geojson", "--overwrite", "-o",
        f"{out}/second")
    city, again = read(first), read(f"{out}/second/model.city.json")
    origin = city["transform"]["translate"]
    before, after = buildings(city, origin), buildings(again, origin)
    same, above, different = 0, 0.0, []
    for name, (planes, volume, base, _) in before.items():
        others, other_volume, other_base, ground = after.get(name, ([], 0.0, base, 0.0))
        above += other_volume - (ground * (base - other_base) if ground else 0)
        missing = sum(not p.found_in(others) for p in planes)
        extra = sum(not p.found_in(planes) for p in others)
        same += name in after and missing + extra == 0
        if missing + extra or name not in after:
            different.append(f"{name}: {missing} of {len(planes)} missing, {extra} of {len(others)} not in the first, "
                             f"volume {other_volume / volume if volume else 0:.3f}")
    total = sum(building[1] for building in before.values()) or 1
    return len(before), same, sum(building[1] for building in after.values()) / total, above / total, different


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n")[2][7:])
    parser.add_argument("--planes", type=float, default=0.95)
    parser.add_argument("--volume", type=float, default=0.005)
    parser.add_argument("mansard")
    parser.add_argument("out")
    parser.add_argument("inputs", nargs="+")
    arguments = parser.parse_args()
    results = []
    print("| input | buildings | same planes | volume | volume above the first ground |\n|---|---|---|---|---|", flush=True)
    for given in arguments.inputs:
        name = given.rstrip("/").split("/")[-1].replace(":", "_").removesuffix(".city.json")
        folder = os.path.join(arguments.out, name)
        os.makedirs(folder, exist_ok=True)
        count, same, ratio, above, different = compare(arguments.mansard, given, folder)
        print(f"| {name} | {count} | {same} ({100 * same / max(count, 1):.1f} %) | {ratio:.4f} | {above:.4f} |", flush=True)
        with open(os.path.join(folder, "different.txt"), "w", encoding="utf-8") as file:
            file.writelines(line + "\n" for line in different)
        passed = count > 0 and same >= arguments.planes * count and abs(above - 1) <= arguments.volume
        results.append((name, passed))
    for name, passed in results:
        print(f"fixed_point: {name}: {'passed' if passed else 'failed'}")
    return 0 if all(passed for _, passed in results) else 1


if __name__ == "__main__":
    sys.exit(main())
