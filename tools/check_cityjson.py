#!/usr/bin/env python3
"""Checks CityJSON files independently of mansard's own check; standard library only.

usage: tools/check_cityjson.py FILE…      exit code 1 when anything is wrong

Per file: shape of the document; parents and children name each other; no vertex twice or unused. Per solid: every
directed edge once, with its opposite once, in integer vertices; one umbrella of faces at every vertex; outward (a
positive volume); no ring with a repeated vertex; every surface planar within 0.2 mm; semantics that fit the surfaces.
"""
import json
import sys
from collections import Counter, defaultdict

PLANAR = 0.0002  # metres
ROOT_TYPES = {"Building"}
PART_TYPES = {"BuildingPart"}
SURFACES = {"GroundSurface", "WallSurface", "RoofSurface", "OuterFloorSurface", "OuterCeilingSurface", "ClosureSurface"}


def unique_keys(pairs):
    keys = [key for key, _ in pairs]
    twice = [key for key, n in Counter(keys).items() if n > 1]
    if twice:
        raise ValueError(f"object key twice: {twice[:3]}")
    return dict(pairs)


def newell(points):
    nx = ny = nz = 0.0
    for (ax, ay, az), (bx, by, bz) in zip(points, points[1:] + points[:1]):
        nx += (ay - by) * (az + bz)
        ny += (az - bz) * (ax + bx)
        nz += (ax - bx) * (ay + by)
    return nx, ny, nz


def fit(points, normal):
    """The plane of least squares near `normal` by a few inverse iterations on the covariance of the points."""
    n = len(points)
    centre = [sum(p[k] for p in points) / n for k in range(3)]
    cov = [[sum((p[i] - centre[i]) * (p[j] - centre[j]) for p in points) for j in range(3)] for i in range(3)]
    shift = 1e-12 * (cov[0][0] + cov[1][1] + cov[2][2]) + 1e-30
    m = [[cov[i][j] + (shift if i == j else 0) for j in range(3)] for i in range(3)]
    det = (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
           + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))
    if det == 0:
        return centre, normal
    adj = [[0.0] * 3 for _ in range(3)]
    for i in range(3):
        for j in range(3):
            r = [k for k in range(3) if k != j]
            c = [k for k in range(3) if k != i]
            minor = m[r[0]][c[0]] * m[r[1]][c[1]] - m[r[0]][c[1]] * m[r[1]][c[0]]
            adj[i][j] = minor if (i + j) % 2 == 0 else -minor
    v = list(normal)
    for _ in range(3):
        v = [sum(adj[i][j] * v[j] for j in range(3)) for i in range(3)]
        length = sum(x * x for x in v) ** 0.5
        if length == 0:
            return centre, normal
        v = [x / length for x in v]
    return centre, v


def off_plane(points):
    """Largest distance of the points from a plane: the better of Newell's and the fitted one."""
    normal = newell(points)
    length = sum(x * x for x in normal) ** 0.5
    if length == 0:
        return float("inf")
    normal = [x / length for x in normal]
    n = len(points)
    centre = [sum(p[k] for p in points) / n for k in range(3)]
    worst = []
    for c, v in ((centre, normal), fit(points, normal)):
        worst.append(max(abs(sum((p[k] - c[k]) * v[k] for k in range(3))) for p in points))
    return min(worst)


class Checker:
    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            self.city = json.load(file, object_pairs_hook=unique_keys)
        self.faults = []
        self.counts = Counter()
        self.flattest = 0.0

    def fault(self, where, what):
        self.faults.append(f"{where}: {what}")

    def point(self, index):
        v = self.city["vertices"][index]
        return tuple(v[k] * self.city["transform"]["scale"][k] for k in range(3))  # the translation does not matter

    def check(self):
        city = self.city
        if city.get("type") != "CityJSON" or city.get("version") != "2.0":
            self.fault("file", "not CityJSON 2.0")
        if not all(s > 0 for s in city["transform"]["scale"]):
            self.fault("transform", "scale is not positive")
        for i, v in enumerate(city["vertices"]):
            if len(v) != 3 or not all(isinstance(x, int) for x in v):
                self.fault(f"vertices[{i}]", "not three whole numbers")
        twice = len(city["vertices"]) - len({tuple(v) for v in city["vertices"]})
        if twice:
            self.fault("vertices", f"{twice} duplicates")
        self.used = set()
        self.family()
        for name, thing in city["CityObjects"].items():
            for i, geometry in enumerate(thing.get("geometry", [])):
                self.geometry(f"{name}.geometry[{i}]", geometry)
        unused = len(city["vertices"]) - len(self.used)
        if unused:
            self.fault("vertices", f"{unused} unused")
        self.extent()
        return self

    def family(self):
        things = self.city["CityObjects"]
        for name, thing in things.items():
            kind = thing.get("type")
            self.counts[kind] += 1
            if kind in PART_TYPES:
                if len(thing.get("parents", [])) != 1:
                    self.fault(name, "a part without exactly one parent")
            elif kind in ROOT_TYPES:
                if "parents" in thing:
                    self.fault(name, "a building with a parent")
            else:
                self.fault(name, f"type {kind}")
            for parent in thing.get("parents", []):
                if name not in things.get(parent, {}).get("children", []):
                    self.fault(name, f"parent {parent} does not know it")
            children = thing.get("children", [])
            if len(children) != len(set(children)):
                self.fault(name, "a child twice")
            for child in children:
                if name not in things.get(child, {}).get("parents", []):
                    self.fault(name, f"child {child} does not know it")

    def extent(self):
        said = self.city.get("metadata", {}).get("geographicalExtent")
        if said is None or not self.city["vertices"]:
            return
        scale, move = self.city["transform"]["scale"], self.city["transform"]["translate"]
        for k in range(3):
            values = [v[k] for v in self.city["vertices"]]
            for said_k, value in ((said[k], min(values)), (said[k + 3], max(values))):
                if abs(said_k - (value * scale[k] + move[k])) > 0.001:
                    self.fault("metadata.geographicalExtent", f"axis {k}: {said_k} is not {value * scale[k] + move[k]}")

    def geometry(self, where, geometry):
        kind, boundaries = geometry["type"], geometry["boundaries"]
        if not isinstance(geometry.get("lod"), str):
            self.fault(where, "lod is not a text")
        if kind == "MultiSurface":
            shells = [boundaries]
        elif kind == "Solid":
            shells = boundaries
            self.counts["solids"] += 1
        else:
            return self.fault(where, f"type {kind}")
        for shell in shells:
            for surface in shell:
                self.surface(where, surface)
        semantics = geometry.get("semantics")
        if semantics is not None:
            values = semantics["values"] if kind == "Solid" else [semantics["values"]]
            if [len(v) for v in values] != [len(s) for s in shells]:
                self.fault(where, "semantics do not have the shape of the boundaries")
            all_surfaces = semantics["surfaces"]
            used = {v for shell in values for v in shell if v is not None}
            if used - set(range(len(all_surfaces))):
                self.fault(where, "semantics name a surface that does not exist")
            for surface in all_surfaces:
                if surface["type"] not in SURFACES and not surface["type"].startswith("+"):
                    self.fault(where, f"semantic type {surface['type']}")
        elif kind == "Solid":
            self.fault(where, "a solid without semantics")
        if kind == "Solid":
            for shell in shells:
                self.shell(where, shell)

    def surface(self, where, surface):
        self.counts["surfaces"] += 1
        for ring in surface:
            self.used.update(ring)
            if len(ring) < 3 or len(set(ring)) != len(ring):
                self.fault(where, f"ring {ring[:8]} is too short or repeats a vertex")
        points = [self.point(i) for ring in surface for i in ring]
        outer = [self.point(i) for i in surface[0]]
        if sum(x * x for x in newell(outer)) == 0:
            self.fault(where, f"ring {surface[0][:8]} has no area")
            return
        # The plane is the outer ring's and the holes' together.
        distance = off_plane(outer) if len(surface) == 1 else max(off_plane(outer), self.spread(outer, points))
        self.flattest = max(self.flattest, distance)
        if distance > PLANAR:
            self.fault(where, f"ring {surface[0][:8]} is {1000 * distance:.3f} mm from a plane")

    @staticmethod
    def spread(outer, points):
        normal = newell(outer)
        length = sum(x * x for x in normal) ** 0.5
        start = fit(points, [x / length for x in normal])
        return max(abs(sum((p[k] - start[0][k]) * start[1][k] for k in range(3))) for p in points)

    def shell(self, where, shell):
        edges = Counter()
        volume = 0.0
        around = defaultdict(list)  # vertex → (before, after) of each ring through it
        reference = self.point(shell[0][0][0])
        for surface in shell:
            for ring in surface:
                for a, b, c in zip(ring[-1:] + ring[:-1], ring, ring[1:] + ring[:1]):
                    edges[(b, c)] += 1
                    around[b].append((a, c))
                points = [tuple(x - y for x, y in zip(self.point(i), reference)) for i in ring]
                normal = newell(points)
                centre = [sum(p[k] for p in points) / len(points) for k in range(3)]
                volume += sum(normal[k] * centre[k] for k in range(3)) / 6
        for (a, b), n in edges.items():
            if n != 1:
                self.fault(where, f"directed edge {a}-{b} {n} times")
            if edges.get((b, a), 0) != 1:
                self.fault(where, f"directed edge {a}-{b} has {edges.get((b, a), 0)} opposites")
        for vertex, pairs in around.items():
            follows = dict(pairs)
            if len(follows) != len(pairs):
                continue  # told above, as an edge that is there twice
            start = at = pairs[0][0]
            for steps in range(1, len(pairs) + 1):
                at = follows.get(at)
                if at is None or at == start:
                    break
            if at == start and steps != len(pairs):
                self.fault(where, f"vertex {vertex} joins {len(pairs)} faces in more than one umbrella")
        if volume <= 0:
            self.fault(where, f"not outward: volume {volume:.3f} m³")


def main(paths):
    bad = False
    for path in paths:
        try:
            checker = Checker(path).check()
        except (OSError, ValueError, KeyError, IndexError, TypeError) as e:
            print(f"{path}: cannot be checked: {type(e).__name__}: {e}")
            bad = True
            continue
        bad |= bool(checker.faults)
        c = checker.counts
        print(f"{path}: {len(checker.faults)} faults; {c['Building']} buildings, {c['BuildingPart']} parts, "
              f"{c['solids']} solids, {c['surfaces']} surfaces, off plane by at most {1000 * checker.flattest:.4f} mm")
        for fault in checker.faults[:20]:
            print(f"  {fault}")
    return 1 if bad else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(sys.argv[1:]))
