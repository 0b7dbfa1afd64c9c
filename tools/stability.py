#!/usr/bin/env python3
"""How many buildings change when nothing that matters does? Reconstructs one scan as it is and with every vertex moved
by a random vector of a given length, and compares building by building: docs/robustness.md, "Stability".
usage: tools/stability.py OUT MESH.ply FOOTPRINTS [METRES…] [-- mansard reconstruct options…]
METRES: 1e-9 1e-6 1e-3 when none is given. The PLY file must be binary, with x, y, z as the first properties of its
vertices. Prints a row for each length: buildings, those of which any corner moved, and by more than 5 cm or 1 m.
MANSARD=path of the program. OPTIONS="…" goes to reconstruct too."""
import json
import os
import random
import struct
import subprocess
import sys

SIZES = {"char": 1, "uchar": 1, "int8": 1, "uint8": 1, "short": 2, "ushort": 2, "int16": 2, "uint16": 2, "int": 4,
         "uint": 4, "int32": 4, "uint32": 4, "float": 4, "float32": 4, "double": 8, "float64": 8}


def moved(source, target, metres):
    """Writes the mesh with doubles for x, y, z, every vertex moved by `metres` in a direction of its own."""
    with open(source, "rb") as file:
        data = file.read()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:start].decode("ascii").splitlines()
    if "format binary_little_endian 1.0" not in lines:
        sys.exit(f"{source}: not a binary little-endian PLY file; convert it")
    at = next(i for i, line in enumerate(lines) if line.startswith("element vertex"))
    count = int(lines[at].split()[2])
    properties = []
    for line in lines[at + 1:]:
        if not line.startswith("property"):
            break
        properties.append(line.split()[1:])
    if [name for _, name in properties[:3]] != ["x", "y", "z"]:
        sys.exit(f"{source}: x, y, z are not the first properties of its vertices")
    kind = properties[0][0]
    code, size = ("<3f", 12) if kind.startswith("float") and kind != "float64" else ("<3d", 24)
    stride = sum(SIZES[kind] for kind, _ in properties)
    rest = stride - size
    for i in range(3):
        lines[at + 1 + i] = "property double " + "xyz"[i]
    out = bytearray("\n".join(lines).encode("ascii") + b"\n")
    chance = random.Random(1)
    for v in range(count):
        p = struct.unpack_from(code, data, start + v * stride)
        d = [chance.gauss(0, 1) for _ in range(3)]
        length = sum(c * c for c in d) ** 0.5 or 1
        out += struct.pack("<3d", *(p[k] + metres * d[k] / length for k in range(3)))
        out += data[start + v * stride + size:start + v * stride + size + rest]
    out += data[start + count * stride:]
    with open(target, "wb") as file:
        file.write(out)


def corners_of(path):
    """Of every building, the corners of its finest models, in metres."""
    with open(path, encoding="utf-8") as file:
        city = json.load(file)
    scale, offset = city["transform"]["scale"], city["transform"]["translate"]
    places = [tuple(v[k] * scale[k] + offset[k] for k in range(3)) for v in city["vertices"]]

    def indices(nested):
        if isinstance(nested, int):
            yield nested
        else:
            for one in nested:
                yield from indices(one)

    out = {}
    for name, thing in city["CityObjects"].items():
        building = thing.get("parents", [name])[0]
        for geometry in thing.get("geometry", []):
            if geometry["lod"] == "2.2":
                out.setdefault(building, set()).update(places[i] for i in indices(geometry["boundaries"]))
    return out


def farthest(some, others):
    """The greatest distance of one of `some` from the nearest of `others`."""
    return max(min(sum((a[k] - b[k]) ** 2 for k in range(3)) for b in others) for a in some) ** 0.5


def change(a, b):
    if a == b:
        return 0.0
    if not a or not b:
        return float("inf")
    return max(farthest(a - b, b) if a - b else 0, farthest(b - a, a) if b - a else 0)


def main():
    words = sys.argv[1:]
    options = os.environ.get("OPTIONS", "").split()
    if "--" in words:
        options += words[words.index("--") + 1:]
        words = words[:words.index("--")]
    if len(words) < 3:
        sys.exit(__doc__)
    out, mesh, footprints, *lengths = words
    program = os.environ.get("MANSARD", "build/release/bin/mansard")
    os.makedirs(out, exist_ok=True)

    def run(name, scan):
        folder = os.path.join(out, name)
        command = [program, "reconstruct", scan, footprints, "-o", folder, "--formats", "cityjson", "--overwrite", "-q"]
        if subprocess.run(command + options, stdout=subprocess.DEVNULL, check=False).returncode > 1:
            sys.exit("this failed: " + " ".join(command + options))
        return corners_of(os.path.join(folder, "model.city.json"))

    still = os.path.join(out, "still.ply")
    moved(mesh, still, 0)
    before = run("still", still)
    print("| moved by, m | buildings | any change | more than 5 cm | more than 1 m |\n|---|---|---|---|---|")
    for length in lengths or ["1e-9", "1e-6", "1e-3"]:
        scan = os.path.join(out, f"moved-{length}.ply")
        moved(mesh, scan, float(length))
        after = run(f"moved-{length}", scan)
        os.remove(scan)
        changes = [change(corners, after.get(name, set())) for name, corners in before.items() if corners]
        print(f"| {length} | {len(changes)} | {sum(c > 1e-9 for c in changes)} | {sum(c > 0.05 for c in changes)} "
              f"| {sum(c > 1 for c in changes)} |", flush=True)


if __name__ == "__main__":
    main()
