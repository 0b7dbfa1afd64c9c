#!/usr/bin/env python3
"""How far each level of detail is from LoD 2.2: faces and volumes by level, as a table in Markdown.

    levels.py NAME=MODEL.city.json…

MODEL has LoD 1.2, 1.3, 2.0 and 2.2 (`--lod cityjson=0,1.2,1.3,2.0,2.2`). *Difference* is the volume between the roofs of
a level and those of LoD 2.2, above or below, measured at every 0.2 m in plan; all levels have the same ground. *Net* is
|V − V of LoD 2.2|, summed over buildings: what is too high in one place makes up for what is too low in another. Exits
with 1 where a building has a level with more faces than the next finer one, or a larger difference by over 1 m³.
"""
import json
import sys

import numpy as np

LEVELS = ["1.2", "1.3", "2.0", "2.2"]
CELL = 0.2  # m


def solids(path):
    """Vertices in metres, and the solids of each building by level, each a list of (loops, type of surface)."""
    with open(path, encoding="utf-8") as file:
        city = json.load(file)
    vertices = np.array(city["vertices"], float) * city["transform"]["scale"]
    found = {}
    for name, thing in city["CityObjects"].items():
        building = name if thing["type"] == "Building" else thing["parents"][0]
        for geometry in thing.get("geometry", []):
            if geometry["type"] != "Solid":
                continue
            semantics = geometry["semantics"]
            types = [semantics["surfaces"][i]["type"] for i in semantics["values"][0]]
            shell = list(zip(geometry["boundaries"][0], types))
            found.setdefault(building, {}).setdefault(geometry["lod"], []).append(shell)
    return vertices, found


def volume(vertices, shell):
    origin = vertices[shell[0][0][0][0]]
    total = 0.0
    for loops, _ in shell:
        for loop in loops:
            p = vertices[loop] - origin
            total += sum(np.dot(p[0], np.cross(p[i], p[i + 1])) for i in range(1, len(p) - 1))
    return total / 6


def normal(loop):
    return sum(np.cross(loop[i] - loop[0], loop[(i + 1) % len(loop)] - loop[0]) for i in range(len(loop)))


def heights(vertices, shells, least, shape):
    """Heights of the roofs at the middles of cells; nan where there is none."""
    grid = np.full(shape, np.nan)
    for loops, kind in (face for shell in shells for face in shell):
        corners = [vertices[loop] for loop in loops]
        outer, up = corners[0], normal(corners[0])
        if kind != "RoofSurface" or up[2] <= 0:
            continue
        first = np.maximum(((outer.min(0)[:2] - least) / CELL).astype(int) - 1, 0)
        last = np.minimum(((outer.max(0)[:2] - least) / CELL).astype(int) + 2, shape[::-1])
        x, y = np.meshgrid(*(least[a] + (np.arange(first[a], last[a]) + 0.5) * CELL for a in (0, 1)))
        inside = np.zeros(x.shape, bool)
        for loop in corners:
            for a, b in zip(loop, np.roll(loop, -1, 0)):
                if a[1] != b[1]:
                    inside ^= ((a[1] <= y) != (b[1] <= y)) & (
                        x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
        middle = outer.mean(0)
        z = middle[2] - (up[0] * (x - middle[0]) + up[1] * (y - middle[1])) / up[2]
        part = grid[first[1]:last[1], first[0]:last[0]]
        part[inside] = np.fmax(part[inside], z[inside])
    return grid


def measure(path):
    """By building: by level its faces, its volume less that of LoD 2.2, and the difference."""
    vertices, buildings = solids(path)
    out = {}
    for name, levels in buildings.items():
        used = vertices[[v for shell in levels["2.2"] for loops, _ in shell for loop in loops for v in loop]]
        least = used.min(0)[:2]
        shape = tuple(((used.max(0)[:2] - least) / CELL).astype(int)[::-1] + 2)
        fine = heights(vertices, levels["2.2"], least, shape)
        exact = sum(volume(vertices, shell) for shell in levels["2.2"])
        row = []
        for level in LEVELS:
            shells = levels.get(level, [])
            off = heights(vertices, shells, least, shape) - fine
            row.append((sum(map(len, shells)), sum(volume(vertices, s) for s in shells) - exact,
                        np.nansum(np.abs(off)) * CELL * CELL))
        out[name] = row
    return out


def main(arguments):
    wrong = 0
    print("| set | buildings | faces: LoD 1.2, 1.3, 2.0, 2.2 | difference: 1.2, 1.3, 2.0, m³ | net: 1.2, 1.3, 2.0, m³ |")
    print("|---|---|---|---|---|")
    for argument in arguments:
        name, path = argument.split("=", 1)
        rows = measure(path)
        for building, row in rows.items():
            for coarse, fine in zip(row, row[1:]):
                if coarse[0] > fine[0] or coarse[2] + 1 < fine[2]:
                    print(f"{name}, {building}: {coarse} {fine}", file=sys.stderr)
                    wrong = 1
        table = np.array(list(rows.values()))
        faces = ", ".join(f"{n:,.0f}" for n in table[:, :, 0].sum(0))
        off = ", ".join(f"{v:,.0f}" for v in table[:, :3, 2].sum(0))
        net = ", ".join(f"{v:,.0f}" for v in np.abs(table[:, :3, 1]).sum(0))
        print(f"| `{name}` | {len(rows)} | {faces} | {off} | {net} |")
    return wrong


if __name__ == "__main__":
    if len(sys.argv) < 2 or any("=" not in argument for argument in sys.argv[1:]):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
