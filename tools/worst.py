#!/usr/bin/env python3
"""Finds the worst buildings of a set of reconstructions and draws each beside the scan, close, from two sides.

usage: tools/worst.py RUNS DATA OUT [--before RUNS] [--count 10] [--only INPUT/ID,…]

RUNS is a folder that tools/targets.sh made, DATA the folder that it was given. OUT gets worst.md, a table, and a picture
of each building: a row from either side, with the scan, with --before the model of other RUNS, and the model. Three
lists are ranked: squared error over the footprint (total), the same by area, and faults of form (narrow roof faces, roof
faces over 65°, opposite pitches that nearly agree). The first of each list is taken, then the second of each, until
there are COUNT. A building is taken once, also where it is in two scans. Footprints under 12 m² are left out of the list
by area. Inputs are those in RUNS; leave out a folder to leave out an input. Needs python3-numpy.
"""
import json
import pathlib
import struct
import sys
import zlib
from math import atan2, cos, degrees, hypot, pi, radians, sin

import numpy

MESHES = {  # input of tools/targets.sh: its mesh, and the offset of that
    "block_A": ("sim_rotterdam/block_A_sim_mesh.ply", (0, 0, 0)),
    "delft": ("delft/delft_west_mesh.ply", (84800, 447400, 0)),
    "zhongshan_L19": ("zhongshan/zhongshan_A_L19.ply", (0, 0, 0)),
    "zhongshan_L18": ("zhongshan/zhongshan_A_L18.ply", (0, 0, 0)),
    "hall": ("mvs_buildings/cgal_building.off", (0, 0, 0)),
    "b9": ("mvs_buildings/b9_mesh.off", (0, 0, 0)),
}
WIDTH, HEIGHT = 520, 400  # of one drawing, in pixels
NARROW, STEEP, LEAST_GROUND = 0.75, 65, 12  # m, degrees, m²: the first two as in docs/evaluate.md, "Form"
SCAN, WALL, ROOF, GROUND, LINE = (150, 165, 190), (235, 228, 214), (190, 110, 85), (120, 124, 120), (40, 32, 28)


# --- files ---------------------------------------------------------------------------------------------------------


def read_ply(path):
    """Corners and triangles of a binary PLY; faces with more corners are fans."""
    data = path.read_bytes()
    end = data.index(b"end_header") + len(b"end_header")
    end = data.index(b"\n", end - 1) + 1
    kinds = {"float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8", "uchar": "u1", "uint8": "u1",
             "char": "i1", "int": "<i4", "int32": "<i4", "uint": "<u4", "uint32": "<u4", "short": "<i2", "ushort": "<u2"}
    elements, at = [], end
    for words in (line.split() for line in data[:end].decode("ascii", "replace").splitlines()):
        if words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
        elif words[:1] == ["format"] and words[1] != "binary_little_endian":
            sys.exit(f"{path}: only binary little endian PLY is read here")
    corners = triangles = None
    for name, count, properties in elements:
        lists = [p for p in properties if p[0] == "list"]
        if not lists:
            table = numpy.frombuffer(data, [(p[1], kinds[p[0]]) for p in properties], count, at)
            at += table.nbytes
            if name == "vertex":
                corners = numpy.stack([table[axis].astype(float) for axis in "xyz"], 1)
        elif name == "face":
            # All faces are triangles in the shared inputs, with nothing after the list.
            before = [(p[1], kinds[p[0]]) for p in properties[:properties.index(lists[0])]]
            after = [(p[1], kinds[p[0]]) for p in properties[properties.index(lists[0]) + 1:]]
            row = before + [("n", kinds[lists[0][1]]), ("i", kinds[lists[0][2]], (3,))] + after
            table = numpy.frombuffer(data, row, count, at)
            if (table["n"] != 3).any():
                sys.exit(f"{path}: a face is not a triangle")
            triangles = table["i"].astype(int)
    return corners, triangles


def read_off(path):
    words = path.read_text().split()
    start = 4 if words[0].upper().endswith("OFF") else 3
    points, faces = int(words[start - 3]), int(words[start - 2])
    corners = numpy.array(words[start:start + 3 * points], float).reshape(-1, 3)
    at, triangles = start + 3 * points, []
    for _ in range(faces):
        n = int(words[at])
        ring = [int(w) for w in words[at + 1:at + 1 + n]]
        triangles += [(ring[0], ring[k], ring[k + 1]) for k in range(1, n - 1)]
        at += n + 1
    return corners, numpy.array(triangles)


def mesh_of(name, runs, data):
    """The scan of an input and its offset; simulated scans are beside the runs."""
    if name in MESHES:
        return data / MESHES[name][0], MESHES[name][1]
    return runs / "scans" / name / "mesh.ply", (0, 0, 0)


def read_scan(name, runs, data):
    path, offset = mesh_of(name, runs, data)
    corners, triangles = (read_off if path.suffix == ".off" else read_ply)(path)
    return corners + numpy.array(offset, float), triangles


def read_models(path):
    """Building → its faces (class, rings of corners) at the highest level of detail."""
    city = json.loads(path.read_text(encoding="utf-8"))
    corners = numpy.array(city["vertices"], float) * city["transform"]["scale"] + city["transform"]["translate"]
    out = {}
    for key, thing in city["CityObjects"].items():
        owner = thing.get("parents", [key])[0]
        solids = [g for g in thing.get("geometry", []) if g["type"] == "Solid"]
        if not solids:
            continue
        solid = max(solids, key=lambda g: g["lod"])
        semantics = solid.get("semantics", {})
        for s, shell in enumerate(solid["boundaries"]):
            for f, rings in enumerate(shell):
                kind = semantics["surfaces"][semantics["values"][s][f]]["type"] if semantics else "WallSurface"
                out.setdefault(owner, []).append((kind, [corners[ring] for ring in rings]))
    return out


def png(path, pixels):
    height, width, _ = pixels.shape
    raw = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


# --- form ----------------------------------------------------------------------------------------------------------


def normal_of(ring):
    n = numpy.zeros(3)
    origin = ring[0]
    for a, b in zip(ring, numpy.roll(ring, -1, 0)):
        n += numpy.cross(a - origin, b - origin)
    return n / 2


def narrowest(ring):
    """Shorter side of the smallest rectangle around the plan of a ring."""
    best = numpy.inf
    for a, b in zip(ring, numpy.roll(ring, -1, 0)):
        along = (b - a)[:2]
        if hypot(*along) < 1e-6:
            continue
        along = along / hypot(*along)
        across = ring[:, :2] @ numpy.array((-along[1], along[0]))
        lengthwise = ring[:, :2] @ along
        best = min(best, min(numpy.ptp(across), numpy.ptp(lengthwise))) if numpy.ptp(across) * numpy.ptp(lengthwise) > 0 else best
    return best


def faults(faces):
    """Roof planes of a building, and how many are narrow, steep, or a pair of opposite pitches that nearly agree."""
    planes = []
    for kind, rings in faces:
        if kind != "RoofSurface":
            continue
        n = normal_of(rings[0])
        area = numpy.linalg.norm(n)
        if area < 1e-6:
            continue
        planes.append((degrees(atan2(hypot(n[0], n[1]), n[2])), degrees(atan2(n[0], n[1])) % 360, area, narrowest(rings[0])))
    narrow = sum(p[3] < NARROW for p in planes)
    steep = sum(p[0] > STEEP for p in planes)
    unequal = 0
    for i, a in enumerate(planes):
        for b in planes[:i]:
            opposite = abs((a[1] - b[1]) % 360 - 180) < 3
            if opposite and all(10 < p[0] < 65 for p in (a, b)) and 0.2 <= abs(a[0] - b[0]) < 3:
                unequal += 1
    return {"planes": len(planes), "narrow": narrow, "steep": steep, "unequal": unequal, "faults": narrow + steep + unequal}


# --- drawing -------------------------------------------------------------------------------------------------------


def ears(rings):
    """Triangles of a polygon with holes: corners and index triples, by cutting ears in the plane of the face."""
    n = normal_of(rings[0])
    drop = int(numpy.argmax(abs(n)))
    axes = [(1, 2), (2, 0), (0, 1)][drop]
    flip = n[drop] < 0

    def flat(ring):
        points = ring[:, axes]
        return points[:, ::-1] if flip else points

    outer, plan = list(rings[0]), list(flat(rings[0]))
    for hole in sorted(rings[1:], key=lambda r: -flat(r)[:, 0].max()):
        # A bridge from the hole's rightmost corner to the nearest corner that sees it.
        points = flat(hole)
        start = int(numpy.argmax(points[:, 0]))
        order = sorted(range(len(plan)), key=lambda k: hypot(*(plan[k] - points[start])))
        edges = [(plan[i], plan[(i + 1) % len(plan)]) for i in range(len(plan))]
        to = next((k for k in order if not any(crosses(points[start], plan[k], a, b) for a, b in edges)), order[0])
        turned = [(start + k) % len(hole) for k in range(len(hole) + 1)]
        outer[to + 1:to + 1] = [hole[k] for k in turned] + [outer[to]]
        plan[to + 1:to + 1] = [points[k] for k in turned] + [plan[to]]
    left, out = list(range(len(plan))), []
    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            if turn(plan[a], plan[b], plan[c]) > 1e-12 and not any(
                    within(plan[p], plan[a], plan[b], plan[c]) for p in left if p not in (a, b, c)):
                out.append((a, b, c))
                del left[k]
                break
        else:  # nothing left but corners on lines
            k = min(range(len(left)), key=lambda k: abs(turn(plan[left[k - 1]], plan[left[k]], plan[left[(k + 1) % len(left)]])))
            del left[k]
    out.append(tuple(left))
    return numpy.array(outer), out


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def within(p, a, b, c):
    return turn(a, b, p) >= 0 and turn(b, c, p) >= 0 and turn(c, a, p) >= 0 and not any((p == q).all() for q in (a, b, c))


def crosses(a, b, c, d):
    return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0


def camera(azimuth):
    """Rows: to the right, up on the picture, towards the viewer, who stands at `azimuth`, clockwise from north."""
    e = radians(38)
    to = numpy.array((sin(azimuth) * cos(e), cos(azimuth) * cos(e), sin(e)))
    right = numpy.array((-cos(azimuth), sin(azimuth), 0.0))
    return numpy.stack([right, numpy.cross(to, right), to])


class Drawing:
    def __init__(self, box, azimuth):
        self.camera = camera(azimuth)
        corners = numpy.array([[box[i & 1][0], box[i >> 1 & 1][1], box[i >> 2 & 1][2]] for i in range(8)]) @ self.camera.T
        low, high = corners.min(0), corners.max(0)
        self.scale = min(WIDTH / (high[0] - low[0]), HEIGHT / (high[1] - low[1])) * 0.96
        self.middle = (low + high) / 2
        self.pixels = numpy.full((HEIGHT, WIDTH, 3), 255, numpy.uint8)
        self.depth = numpy.full((HEIGHT, WIDTH), -numpy.inf)

    def project(self, points):
        p = (points @ self.camera.T - self.middle) * self.scale
        return numpy.stack([p[..., 0] + WIDTH / 2, HEIGHT / 2 - p[..., 1], p[..., 2]], -1)

    def triangle(self, p, colour):
        x0, x1 = max(int(p[:, 0].min()), 0), min(int(p[:, 0].max()) + 2, WIDTH)
        y0, y1 = max(int(p[:, 1].min()), 0), min(int(p[:, 1].max()) + 2, HEIGHT)
        area = turn(p[0], p[1], p[2])
        if x0 >= x1 or y0 >= y1 or abs(area) < 1e-9:
            return
        x, y = numpy.meshgrid(numpy.arange(x0, x1) + 0.5, numpy.arange(y0, y1) + 0.5)
        u = ((p[1][0] - x) * (p[2][1] - y) - (p[1][1] - y) * (p[2][0] - x)) / area
        v = ((p[2][0] - x) * (p[0][1] - y) - (p[2][1] - y) * (p[0][0] - x)) / area
        z = u * p[0][2] + v * p[1][2] + (1 - u - v) * p[2][2]
        seen = (u >= 0) & (v >= 0) & (u + v <= 1) & (z > self.depth[y0:y1, x0:x1])
        self.depth[y0:y1, x0:x1][seen] = z[seen]
        self.pixels[y0:y1, x0:x1][seen] = colour

    def shade(self, normal, colour):
        sun = self.camera.T @ numpy.array((-0.55, 0.65, 0.52))  # from the upper left, behind the viewer
        light = 0.5 + 0.5 * max(float(normal @ sun) / max(numpy.linalg.norm(normal), 1e-12), 0)
        return tuple(int(c * min(light + 0.05, 1)) for c in colour)

    def scan(self, corners, triangles):
        flat = self.project(corners)
        normals = numpy.cross(corners[triangles[:, 1]] - corners[triangles[:, 0]], corners[triangles[:, 2]] - corners[triangles[:, 0]])
        for triangle, normal in zip(triangles, normals):
            facing = normal if normal @ self.camera[2] > 0 else -normal
            self.triangle(flat[triangle], self.shade(facing, SCAN))

    def model(self, faces):
        for kind, rings in faces:
            n = normal_of(rings[0])
            if n @ self.camera[2] <= 0:
                continue
            colour = self.shade(n, ROOF if kind == "RoofSurface" else GROUND if kind == "GroundSurface" else WALL)
            points, triangles = ears(rings)
            flat = self.project(points)
            for triangle in triangles:
                if len(triangle) == 3:
                    self.triangle(flat[list(triangle)], colour)
        for _, rings in faces:
            for ring in rings:
                flat = self.project(ring)
                for a, b in zip(flat, numpy.roll(flat, -1, 0)):
                    steps = int(max(abs(b - a)[:2].max() * 2, 1))
                    for p in a + (b - a) * numpy.linspace(0, 1, steps + 1)[:, None]:
                        x, y = int(p[0]), int(p[1])
                        if 0 <= x < WIDTH and 0 <= y < HEIGHT and p[2] > self.depth[y, x] - 0.25 * self.scale:
                            self.pixels[y, x] = LINE


def long_side(faces):
    """Azimuth of the normal of the longest wall: clockwise from north."""
    best, azimuth = 0, 0
    for kind, rings in faces:
        if kind == "WallSurface":
            n = normal_of(rings[0])
            if numpy.linalg.norm(n) > best:
                best, azimuth = numpy.linalg.norm(n), atan2(n[0], n[1])
    return azimuth


def draw(building, scan, before):
    faces = building["model"]
    points = numpy.concatenate([ring for _, rings in faces for ring in rings])
    low, high = points.min(0) - (2, 2, 0), points.max(0) + (2, 2, 1)
    corners, triangles = scan
    middle = corners[triangles].mean(1)
    near = ((middle[:, :2] > low[:2]) & (middle[:, :2] < high[:2])).all(1)
    part = triangles[near]
    rows = []
    for side in (0, pi):
        azimuth = long_side(faces) + 0.5 + side
        panels = []
        drawing = Drawing((low, high), azimuth)
        drawing.scan(corners, part)
        panels.append(drawing.pixels)
        for model in ([before] if before is not None else []) + [faces]:
            drawing = Drawing((low, high), azimuth)
            drawing.model(model)
            panels.append(drawing.pixels)
        gap = numpy.full((HEIGHT, 6, 3), 200, numpy.uint8)
        rows.append(numpy.concatenate([p for panel in panels for p in (panel, gap)][:-1], 1))
    return numpy.concatenate([rows[0], numpy.full((6, rows[0].shape[1], 3), 200, numpy.uint8), rows[1]], 0)


# --- ranking -------------------------------------------------------------------------------------------------------


def buildings_of(runs):
    for folder in sorted(runs.iterdir()):
        if not (folder / "report.json").exists():
            continue
        report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        models = read_models(folder / "model" / "model.city.json")
        for entry in report["buildings"]:
            scores, model = entry["scores"], models.get(entry["id"])
            if scores.get("footprint_mse_m2") is None or not model:
                continue
            ground = scores["footprint_cells"] * report["grid_m"] ** 2
            yield {"input": folder.name, "id": entry["id"], "model": model, "ground": ground,
                   "mse": scores["footprint_mse_m2"], "total": scores["footprint_mse_m2"] * ground, **faults(model)}


def ranked(buildings, count):
    lists = [("total error", sorted(buildings, key=lambda b: -b["total"])),
             ("error by area", sorted((b for b in buildings if b["ground"] >= LEAST_GROUND), key=lambda b: -b["mse"])),
             ("form", sorted(buildings, key=lambda b: (-b["faults"], -b["total"])))]
    def place(building):
        return building["input"].removesuffix("_L18").removesuffix("_L19"), building["id"]

    taken, out = set(), []
    while len(out) < count and any(rest for _, rest in lists):
        for reason, rest in lists:
            while rest and place(rest[0]) in taken:
                rest.pop(0)
            if rest and len(out) < count:
                taken.add(place(rest[0]))
                out.append(rest.pop(0) | {"reason": reason})
    return out


def main(arguments):
    options = {"--before": None, "--count": "10", "--only": None}
    names = []
    while arguments:
        word = arguments.pop(0)
        if word in options and arguments:
            options[word] = arguments.pop(0)
        else:
            names.append(word)
    if len(names) != 3:
        sys.exit(__doc__)
    runs, data, out = map(pathlib.Path, names)
    out.mkdir(parents=True, exist_ok=True)
    found = list(buildings_of(runs))
    if options["--only"]:
        order = options["--only"].split(",")
        found = [b | {"reason": "asked for"} for b in found if f'{b["input"]}/{b["id"]}' in order]
        worst = sorted(found, key=lambda b: order.index(f'{b["input"]}/{b["id"]}'))
    else:
        worst = ranked(found, int(options["--count"]))
    before = pathlib.Path(options["--before"]) if options["--before"] else None
    old = {(b["input"], b["id"]): b for b in buildings_of(before)} if before else {}
    scans, lines = {}, ["| | building | taken for | footprint, m² | MSE, m² | squared error, m⁴ | planes | narrow | over 65° | unequal |",
                        "|---|---|---|---|---|---|---|---|---|---|"]

    def cells(key):
        now, then = building, old.get((building["input"], building["id"]))
        form = "{:.2f}" if key == "mse" else "{:.0f}"
        return (form.format(then[key]) + " → " if then else "") + form.format(now[key])

    for number, building in enumerate(worst, 1):
        name = building["input"]
        if name not in scans:
            scans[name] = read_scan(name, runs, data)
        then = old.get((name, building["id"]))
        png(out / f"{number:02}.png", draw(building, scans[name], then["model"] if then else None))
        lines.append(f'| {number} | {name} `{building["id"]}` | {building["reason"]} | {building["ground"]:.0f} | ' +
                     " | ".join(cells(k) for k in ("mse", "total", "planes", "narrow", "steep", "unequal")) + " |")
    (out / "worst.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1:])
