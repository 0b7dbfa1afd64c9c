#!/usr/bin/env python3
"""Roofs whose shape is a formula: scans of them, models of the scans, and how far the models are from the formula.

usage: tools/shapes.py OUT [NAME…]
Each shape is scanned twice: an exact mesh, and 8 points/m² with a noise of 0.02 m. The program is $MANSARD, else build/release/bin/mansard.
Prints a Markdown table: RMSE from the formula 0.3 m inside the outline (m), faces of the roof, and of how many kinds these are (areas and
pitches alike). Needs python3-numpy and python3-shapely.
"""
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys

import numpy as np
import shapely.geometry as sg
from shapely.ops import triangulate
from shapely.prepared import prep

MANSARD = os.environ.get("MANSARD", "build/release/bin/mansard")
CELL, AROUND = 0.25, 12.0  # m: between the corners of an exact mesh; the ground around a shape
DENSITY, NOISE = 8, 0.02  # points/m², m
TAU = 2 * math.pi


def arc(x, y, radius, chords, start, end, flat=1.0):
    return [(x + radius * math.cos(start + (end - start) * i / chords), y + flat * radius * math.sin(start + (end - start) * i / chords))
            for i in range(chords + 1)]


def circle(x, y, radius, chords=48, flat=1.0):
    return arc(x, y, radius, chords, 0, TAU, flat)[:-1]


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def root(x):
    return math.sqrt(max(0.0, x))


def ring(radius, chords):
    """Two half circles with straight sides of 20 m between them."""
    return arc(40, 20, radius, chords, -TAU / 4, TAU / 4) + arc(20, 20, radius, chords, TAU / 4, 3 * TAU / 4)


def from_inner(x, y):
    return math.hypot(x - min(max(x, 20), 40), y - 20) - 12


def shapes():
    """name: [(ring, holes, height), …]; heights are above level ground at 0."""
    gambrel = lambda d: 5 + 1.8 * d if d < 1.5 else 7.7 + 0.5 * (d - 1.5)
    hall, tower, dome = box(0, 0, 30, 18), box(8, 6, 14, 12), circle(10, 10, 8)
    apse = [(0, 0)] + arc(20, 5, 5, 12, -TAU / 4, TAU / 4) + [(0, 10)]
    pitch = lambda d: 6 + 0.8 * d
    wings = [(0, 0), (14, 0), (14, 8), (8, 8), (8, 15), (0, 15)]
    main, annex = box(0, 0, 12, 8), box(12, 0, 15, 4)
    cut = [(0, 0), (12, 0), (12, 6), (10, 8), (0, 8)]
    return {
        "half hip": [(main, [], lambda x, y: min(pitch(min(y, 8 - y)), 7.6 + 0.8 * min(x, 12 - x)))],
        "gablet": [(box(*sides), [], lambda x, y: pitch(min(y, 8 - y) if 2 <= x <= 10 else min(x, 12 - x, y, 8 - y)))
                   for sides in [(0, 0, 2, 8), (2, 0, 10, 8), (10, 0, 12, 8)]],
        "two heights of eaves": [(main, [], lambda x, y: min(6 + 0.8 * y, 4 + 0.7 * (8 - y)))],
        "shed against a wall": [(main, [], lambda x, y: pitch(min(y, 8 - y))), (box(0, 8, 12, 11), [], lambda x, y: 3 + 0.4 * (11 - y))],
        "hip beside an annex": [(main, [], lambda x, y: pitch(min(x, 12 - x, y, 8 - y))), (annex, [], lambda x, y: 3.5)],
        "hipped L": [(wings, [], lambda x, y: pitch(max(min(x, 14 - x, y, 8 - y), min(x, 8 - x, y, 15 - y))))],
        "gabled L": [(wings, [], lambda x, y: pitch(max(min(y, 8 - y), min(x, 8 - x) if y > 4 else 0)))],
        "hip with a chamfer": [(cut, [], lambda x, y: pitch(min(x, 12 - x, y, 8 - y, (18 - x - y) / math.sqrt(2))))],
        "gable on a splayed plot": [([(0, 0), (14, 0), (14, 9), (0, 8)], [], lambda x, y: min(pitch(y), pitch(8 - y)))],
        "gable": [(box(0, 0, 12, 4), [], lambda x, y: 6 + 0.8 * y), (box(0, 4, 12, 8), [], lambda x, y: 6 + 0.8 * (8 - y))],
        "monopitch": [(box(0, 0, 10, 7), [], lambda x, y: 4 + 0.35 * y)],
        "gambrel": [(box(0, a, 14, b), [], lambda x, y: gambrel(min(y, 9 - y))) for a, b in [(0, 1.5), (1.5, 4.5), (4.5, 7.5), (7.5, 9)]],
        "butterfly": [(box(0, 0, 14, 5), [], lambda x, y: 7 - 0.4 * y), (box(0, 5, 14, 10), [], lambda x, y: 7 - 0.4 * (10 - y))],
        "sawtooth": [(box(0, 5 * i, 20, 5 * i + 5), [], lambda x, y, i=i: 6 + 0.5 * (y - 5 * i)) for i in range(4)],
        "tower on a hall": [(hall, [tower], lambda x, y: 7), (tower, [], lambda x, y: 19)],
        "barrel": [(box(0, 0, 20, 8), [], lambda x, y: 2 + root(25 - (y - 4) ** 2))],
        "quarter barrel": [(box(0, 0, 20, 8), [], lambda x, y: 5 + 5 * root(1 - ((y - 8) / 8) ** 2))],
        "dome": [(dome, [], lambda x, y: 6 + root(64 - (x - 10) ** 2 - (y - 10) ** 2))],
        "cone": [(dome, [], lambda x, y: 6 + 0.9 * max(0.0, 8 - math.hypot(x - 10, y - 10)))],
        "curved street front": [([(4, -2), (20, -2)] + arc(12, -10, 16, 23, TAU / 6, TAU / 3), [], lambda x, y: 12)],
        "stadium": [(ring(22, 23), [ring(12, 23)], lambda x, y: 4 + 0.7 * from_inner(x, y))],
        "round tower of 12 sides": [(circle(10, 10, 4, 12), [], lambda x, y: 14)],
        "flat dome": [(circle(10, 10, 9, 36, 0.6), [], lambda x, y: 6 + 4 * root(1 - ((x - 10) / 9) ** 2 - ((y - 10) / 5.4) ** 2))],
        "nave and apse": [(apse, [], lambda x, y: 8 + 0.9 * (5 - (abs(y - 5) if x < 20 else math.hypot(x - 20, y - 5))))],
    }


def polygons(shape):
    parts = [(sg.Polygon(outer, holes), height) for outer, holes, height in shape]
    outline = parts[0][0].union(parts[1][0]) if len(parts) > 1 else parts[0][0]
    for part, _ in parts[2:]:
        outline = outline.union(part)
    return parts, outline


def exact_mesh(parts, outline):
    vertices, faces, known = [], [], {}

    def add(*corners):
        keys = [tuple(round(c, 6) for c in corner) for corner in corners]
        if len(set(keys)) == 3:
            faces.append([known.setdefault(k, len(known)) for k in keys])

    x0, y0, x1, y1 = outline.bounds
    around = sg.box(x0 - AROUND, y0 - AROUND, x1 + AROUND, y1 + AROUND).difference(outline)
    for area, height, cell in [(*part, CELL) for part in parts] + [(around, lambda x, y: 0.0, 4 * CELL)]:
        near, (a0, b0, a1, b1) = prep(area), area.bounds
        for i in range(math.floor(a0 / cell), math.ceil(a1 / cell)):
            for j in range(math.floor(b0 / cell), math.ceil(b1 / cell)):
                square = sg.box(i * cell, j * cell, (i + 1) * cell, (j + 1) * cell)
                if not near.intersects(square):
                    continue
                piece = square if near.contains(square) else area.intersection(square)
                for polygon in getattr(piece, "geoms", [piece]):
                    if polygon.geom_type != "Polygon" or polygon.area < 1e-9:
                        continue
                    for t in triangulate(polygon):
                        if polygon.contains(t.representative_point()):
                            add(*[(x, y, height(x, y)) for x, y in list(sg.polygon.orient(t).exterior.coords)[:3]])
    for area, height in parts:  # walls, each from the higher side
        turned = sg.polygon.orient(area)
        for line in [turned.exterior, *turned.interiors]:
            for (ax, ay), (bx, by) in zip(line.coords, line.coords[1:]):
                length = math.hypot(bx - ax, by - ay)
                pieces = max(1, math.ceil(length / CELL))
                for i in range(pieces):
                    p = [(ax + (bx - ax) * k / pieces, ay + (by - ay) * k / pieces) for k in (i, i + 1)]
                    beside = sg.Point((p[0][0] + p[1][0]) / 2 + (by - ay) / length * 1e-3, (p[0][1] + p[1][1]) / 2 - (bx - ax) / length * 1e-3)
                    low = next((h for other, h in parts if other.contains(beside)), lambda x, y: 0.0)
                    if height(*p[0]) + height(*p[1]) > low(*p[0]) + low(*p[1]) + 1e-9:
                        a, b, c, d = (*p[0], low(*p[0])), (*p[1], low(*p[1])), (*p[1], height(*p[1])), (*p[0], height(*p[0]))
                        add(a, b, c), add(a, c, d)
    vertices = list(known)
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", "property double x", "property double y", "property double z",
             f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    return "\n".join(lines + [" ".join(map(str, v)) for v in vertices] + ["3 " + " ".join(map(str, f)) for f in faces]) + "\n"


def points(parts, outline):
    chance = random.Random(7)
    x0, y0, x1, y1 = outline.bounds
    prepared = [(prep(area), height) for area, height in parts]
    lines = ["x,y,z,classification"]
    for _ in range(round((x1 - x0 + 2 * AROUND) * (y1 - y0 + 2 * AROUND) * DENSITY)):
        x, y = chance.uniform(x0 - AROUND, x1 + AROUND), chance.uniform(y0 - AROUND, y1 + AROUND)
        height = next((h for area, h in prepared if area.contains(sg.Point(x, y))), None)
        z = (height(x, y) if height else 0) + chance.gauss(0, NOISE)
        lines.append(f"{x:.3f},{y:.3f},{z:.3f},{6 if height else 2}")
    return "\n".join(lines) + "\n"


def roof_faces(model):
    city = json.loads(model.read_text())
    vertices = np.array(city["vertices"]) * city["transform"]["scale"] + city["transform"]["translate"]
    for entry in city["CityObjects"].values():
        for geometry in entry.get("geometry", []):
            if geometry["type"] != "Solid" or str(geometry["lod"]) not in ("2", "2.2"):
                continue
            semantics = geometry["semantics"]
            for face, kind in zip(geometry["boundaries"][0], semantics["values"][0]):
                if semantics["surfaces"][kind]["type"] == "RoofSurface":
                    rings = [vertices[r] for r in face]
                    centre = rings[0].mean(0)
                    normal = np.cross(rings[0] - centre, np.roll(rings[0], -1, 0) - centre).sum(0)
                    yield sg.Polygon(rings[0][:, :2], [r[:, :2] for r in rings[1:]]).buffer(1e-6), centre, normal


def measure(model, parts, outline):
    faces = list(roof_faces(model))
    inside, shown = prep(outline.buffer(-0.3)), [(prep(area), height) for area, height in parts]
    covers = [(prep(polygon), polygon.bounds, centre, normal) for polygon, centre, normal in faces]
    x0, y0, x1, y1 = outline.bounds
    squares, bare = [], 0
    for x in np.arange(x0 + 0.1, x1, 0.2):
        for y in np.arange(y0 + 0.1, y1, 0.2):
            at = sg.Point(x, y)
            height = next((h for area, h in shown if area.contains(at)), None) if inside.contains(at) else None
            if height is None:
                continue
            tops = [c[2] - (n[0] * (x - c[0]) + n[1] * (y - c[1])) / n[2] for area, b, c, n in covers
                    if b[0] <= x <= b[2] and b[1] <= y <= b[3] and area.contains(at)]
            if tops:
                squares.append((max(tops) - height(x, y)) ** 2)
            else:
                bare += 1
    kinds = {(round(math.degrees(math.atan2(math.hypot(n[0], n[1]), n[2]))), round(math.log(np.linalg.norm(n)) * 5)) for _, _, n in faces}
    return math.sqrt(sum(squares) / len(squares)), len(faces), len(kinds), bare


def main():
    out = pathlib.Path(sys.argv[1])
    print("| shape | mesh: RMSE, m | faces | kinds | points: RMSE, m | faces | kinds |\n|---|---|---|---|---|---|---|")
    for name, shape in shapes().items():
        if len(sys.argv) > 2 and name not in sys.argv[2:]:
            continue
        parts, outline = polygons(shape)
        folder = out / name.replace(" ", "_")
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / "points.csv").exists():
            feature = {"type": "Feature", "properties": {"id": name}, "geometry": sg.mapping(sg.polygon.orient(outline))}
            (folder / "footprint.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
            (folder / "mesh.ply").write_text(exact_mesh(parts, outline))
            (folder / "points.csv").write_text(points(parts, outline))
        row = [name]
        for scan in ("mesh.ply", "points.csv"):
            run = folder / pathlib.Path(scan).stem
            shutil.rmtree(run, ignore_errors=True)
            done = subprocess.run([MANSARD, "reconstruct", folder / scan, folder / "footprint.geojson", "-o", run, "--formats", "cityjson",
                                   "--crs", "local", "-q"], capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{name}, {scan}: exit code {done.returncode}\n{done.stderr}")
            rmse, faces, kinds, bare = measure(run / "model.city.json", parts, outline)
            row += [f"{rmse:.3f}" + (f" ({bare} places without roof)" if bare else ""), str(faces), str(kinds)]
        print("| " + " | ".join(row) + " |", flush=True)


main()
