#!/usr/bin/env python3
"""Prints a line 'sha256  case/file' for every result of tools/output_hashes.sh: all its bytes but timings, or its shapes.

usage: tools/output_hashes.py bytes|shapes WORK       (WORK has out/CASE/… and streams/CASE/…)
"""
import csv
import hashlib
import io
import json
import pathlib
import re
import sqlite3
import struct
import sys

# ---- bytes: the file without its timings ----
JSON_TIMES = re.compile(rb'("(?:times|seconds)"\s*:\s*)(\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\}|[-+0-9.eE]+)')
TABLE_SECONDS = re.compile(rb'(<td class="seconds">)[^<]*')


def without_timed_columns(text):
    rows = list(csv.reader(io.StringIO(text.decode(), newline="")))
    kept = [i for i, name in enumerate(rows[0]) if not name.endswith("_s")]
    return "\n".join(json.dumps([row[i] for i in kept]) for row in rows).encode()


def bytes_of(path):
    data = path.read_bytes()
    if path.suffix == ".json":
        return JSON_TIMES.sub(rb"\1null", data)
    if path.suffix == ".html":
        return TABLE_SECONDS.sub(rb"\1", data)
    if path.suffix == ".csv":
        return without_timed_columns(data)
    return data


# ---- shapes: coordinates and numbers without options, versions, attributes and sentences ----
NOT_MEASURED = {"seconds", "times", "options", "inputs", "made_by", "bytes", "schema"}
LAYERS = ("footprints", "edges", "roof_planes", "walls", "profiles", "faces", "sweep_edges", "conflicts", "gis_footprints")


def numbers(value):
    """The numbers of a report, in their places; None where there is none."""
    if isinstance(value, dict):
        kept = {key: numbers(v) for key, v in value.items() if key not in NOT_MEASURED}
        return {key: v for key, v in kept.items() if v is not None} or None
    if isinstance(value, list):
        kept = [numbers(v) for v in value]
        return kept if any(v is not None for v in kept) else None
    return value if isinstance(value, (bool, int, float)) else None


def of_plans(plans):
    without = lambda owner: {key: value for key, value in owner.items() if key != "attributes"}
    buildings = [without(b) | {"parts": [without(p) for p in b["parts"]]} for b in plans.get("buildings", [])]
    return {"frame": plans["frame"], "buildings": buildings}


def of_geometry(geometry):
    out = {key: geometry[key] for key in ("type", "lod", "boundaries")}
    if "semantics" in geometry:
        out["classes"] = [surface["type"] for surface in geometry["semantics"]["surfaces"]]
        out["values"] = geometry["semantics"]["values"]
    return out


def of_cityjson(model):
    objects = {}
    for name, item in model.get("CityObjects", {}).items():
        objects[name] = {key: item[key] for key in ("type", "parents", "children") if key in item}
        objects[name]["geometry"] = [of_geometry(g) for g in item.get("geometry", [])]
    return {"objects": objects, "vertices": model.get("vertices"), "transform": model.get("transform")}


def of_json(text):
    value = json.loads(text)
    kind = value.get("type") if isinstance(value, dict) else None
    if kind == "mansard-plan":
        return of_plans(value)
    if kind in ("CityJSON", "CityJSONFeature"):
        return of_cityjson(value)
    if kind == "FeatureCollection":
        return [feature["geometry"] for feature in value["features"]]
    return numbers(value)


def of_glb(data):
    """The bytes of all positions and triangles, compressed or not; a mesh after the other."""
    length = struct.unpack_from("<I", data, 12)[0]
    document, binary = json.loads(data[20 : 20 + length]), data[20 + length + 8 :]
    out = []
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            for accessor in (primitive["attributes"]["POSITION"], primitive.get("indices")):
                if accessor is None:
                    continue
                accessor = document["accessors"][accessor]
                view = document["bufferViews"][accessor["bufferView"]]
                view = view.get("extensions", {}).get("EXT_meshopt_compression", view)
                at = view.get("byteOffset", 0)
                described = {key: accessor.get(key) for key in ("byteOffset", "count", "min", "max")}
                out.append([described, hashlib.sha256(binary[at : at + view["byteLength"]]).hexdigest()])
    placed = ("mesh", "matrix", "translation", "rotation", "scale")
    nodes = [{key: node[key] for key in placed if key in node} for node in document["nodes"]]
    return [nodes, out]


def of_geopackage(path):
    file = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    out = {}
    for (layer,) in file.execute("select name from sqlite_master where type = 'table' order by name").fetchall():
        if layer not in LAYERS:
            continue
        columns = [row[1] for row in file.execute(f'pragma table_info("{layer}")')]
        columns = [c for c in columns if not c.startswith("ms_")]
        rows = file.execute(f'select {", ".join(chr(34) + c + chr(34) for c in columns)} from "{layer}"')
        # Texts are ids, classes and sentences; a profile's points are the only ones that are a shape.
        shaped = lambda name, v: name == "points" or not isinstance(v, str)
        out[layer] = [
            {c: v.hex() if isinstance(v, bytes) else v for c, v in zip(columns, row) if shaped(c, v)} for row in rows
        ]
    file.close()
    return out


def shapes_of(path):
    """None where a file describes no shape."""
    name, suffix = path.name, path.suffix
    if suffix == ".gpkg":
        return of_geopackage(path)
    data = path.read_bytes()
    if suffix == ".jsonl":
        return [of_json(line) for line in data.splitlines()]
    if suffix in (".json", ".geojson"):
        return of_json(data)
    if suffix == ".obj":
        return hashlib.sha256(b"\n".join(l for l in data.splitlines() if l.split(b" ")[0] in (b"v", b"f"))).hexdigest()
    if suffix == ".stl":
        return hashlib.sha256(data[80:]).hexdigest()
    if suffix == ".ply":
        return hashlib.sha256(data.split(b"end_header", 1)[1]).hexdigest()
    if suffix == ".glb":
        return of_glb(data)
    return hashlib.sha256(data).hexdigest() if suffix == ".tif" else None


def main():
    mode, work = sys.argv[1], pathlib.Path(sys.argv[2])
    lines = []
    for root in ("out", "streams") if mode == "bytes" else ("out",):
        for path in (work / root).rglob("*"):
            if not path.is_file() or (root == "streams" and path.stat().st_size == 0):
                continue
            if ".mansard" in path.parts:  # what a run keeps for the next one: it depends on the very program
                continue
            name = path.relative_to(work / root).as_posix()
            content = bytes_of(path) if mode == "bytes" else shapes_of(path)
            if content is None:
                continue
            if mode == "shapes":
                content = json.dumps(content, sort_keys=True).encode()
            lines.append(f"{hashlib.sha256(content).hexdigest()}  {name}")
    print("\n".join(sorted(lines, key=lambda line: line.split("  ", 1)[1])))


main()
