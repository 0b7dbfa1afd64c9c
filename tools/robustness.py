#!/usr/bin/env python3
"""Prints what tools/robustness.sh measured: a table per disturbance, a verdict on each, and the worst cases."""
import json
import pathlib
import statistics
import struct
import sys

OUT = pathlib.Path(sys.argv[1])
# A step is gentle when it does not more than double the error. Differences this small are those of single walls. [m²]
DOUBLED, DRAW = 2.0, 0.1
# A model runs away when it stands higher than its scan by more than this: twice the noise of the roughest level. [m]
RUN_AWAY = 0.5
WALL, ROOF = 0, 1


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def scan_of(path):
    """Vertices of a scan, and per triangle its corners, class and building."""
    data = path.read_bytes()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    counts = {words[1]: int(words[2]) for words in (line.split() for line in data[:start].decode().splitlines())
              if words[0] == "element"}
    faces = start + counts["vertex"] * 24
    vertices = list(struct.iter_unpack("<3d", data[start:faces]))
    return vertices, struct.iter_unpack("<B3iBi", data[faces:])


def tops_of(vertices, triangles, buildings):
    """Highest vertex of every building's walls and roof in the scan; -inf where it shows nothing of it."""
    tops = [float("-inf")] * buildings
    for _, a, b, c, kind, building in triangles:
        if building >= 0 and kind in (WALL, ROOF):
            tops[building] = max(tops[building], vertices[a][2], vertices[b][2], vertices[c][2])
    return tops


def model_vertices(path):
    """Vertices of every building's solids in their finest level of detail."""
    city = read(path)
    scale, move = city["transform"]["scale"], city["transform"]["translate"]
    made = {}
    for name, thing in city["CityObjects"].items():
        for geometry in thing.get("geometry", []):
            if geometry["lod"] == "2.2":
                used = {i for shell in geometry["boundaries"] for face in shell for ring in face for i in ring}
                owner = thing.get("parents", [name])[0]
                made.setdefault(owner, []).extend(
                    [v * s + m for v, s, m in zip(city["vertices"][i], scale, move)] for i in used)
    return made


def above_scan(cell):
    """Of every feature with a model: how much higher it is than what the scan shows of its buildings; of those that
    run away, also how much higher than anything in the scan over it, trees included."""
    truth = read(cell / "scan/truth.json")
    names = [building["id"] for building in truth["buildings"]]
    vertices, triangles = scan_of(cell / "scan/mesh.ply")
    tops = dict(zip(names, tops_of(vertices, triangles, len(names))))
    made = model_vertices(cell / "model/model.city.json")
    above, over_all = {}, {}
    for feature in truth["footprints"]:
        model = made.get(feature["id"])
        if model is None:
            continue
        top = max(v[2] for v in model)
        above[feature["id"]] = top - max(tops[name] for name in feature["buildings"].split())
        if above[feature["id"]] > RUN_AWAY:
            least, most = ([pick(v[axis] for v in model) for axis in (0, 1)] for pick in (min, max))
            over_all[feature["id"]] = top - max(
                v[2] for v in vertices if all(least[axis] <= v[axis] <= most[axis] for axis in (0, 1)))
    return above, over_all


def cell_of(folder):
    cell, where = OUT / folder, folder.replace("/", " ")
    if not (cell / "report.json").exists():
        return {"where": where, "failed": True}
    report, run = read(cell / "report.json"), read(cell / "model/run.json")
    truth, party = report["truth"], report["truth"]["party_walls"]
    made = party["model_m"]
    above, over_all = above_scan(cell)
    return {
        "where": where, "failed": False,
        "mse": truth["scores"]["footprint_mse_m2"], "inside": truth["scores"]["inside"]["mse_m2"],
        "median": truth["scores"]["footprint_median_absolute_m"], "prism": truth["prism"]["footprint_mse_m2"],
        "missing": [b["id"] for b in report["buildings"] if not b["modelled"]],
        "no_model": [f'{b["id"]} {b["outcome"]}' for b in run["buildings"] if b["outcome"] in ("covered", "refused")],
        "fallback": [f'{b["id"]} {", ".join(r["code"] for r in b["reasons"])}' for b in run["buildings"]
                     if b["outcome"] == "fallback"],
        "buildings": len(report["buildings"]), "above": above, "over_all": over_all,
        "party_m": party["truth_m"], "found_m": (party["recall"] or 0) * party["truth_m"],
        "made_m": made, "false_m": (1 - party["precision"]) * made if made else 0,
        "splits": truth["parts"]["splits"],
    }


def summary(cells):
    good = [cell for cell in cells if not cell["failed"]]
    mean = lambda key: statistics.fmean(cell[key] for cell in good)
    count = lambda key: sum(len(cell[key]) for cell in good)
    party, made = (sum(cell[key] for cell in good) for key in ("party_m", "made_m"))
    return {
        "mse": mean("mse"), "inside": mean("inside"), "median": mean("median"), "prism": mean("prism"),
        "each": [cell["mse"] for cell in good],
        "missing": count("missing"), "no_model": count("no_model"), "fallback": count("fallback"),
        "above": max(max(cell["above"].values()) for cell in good), "failed": len(cells) - len(good),
        "found": sum(cell["found_m"] for cell in good) / party if party else None,
        "false": sum(cell["false_m"] for cell in good) / made if made else None,
        "splits": sum(cell["splits"] for cell in good),
    }


def steep(levels, rows):
    """The steps that more than double the error."""
    return [f"{a} to {b}" for a, b, x, y in zip(levels, levels[1:], rows, rows[1:])
            if y["mse"] > DOUBLED * x["mse"] and y["mse"] - x["mse"] > DRAW]


def verdict(levels, rows):
    faults = []
    if steps := steep(levels, rows):
        faults.append("the error more than doubles from " + " and from ".join(steps))
    for key, what in (("missing", "buildings missing"), ("no_model", "features without a model of their own"),
                      ("failed", "runs failed")):
        if total := sum(row[key] for row in rows):
            faults.append(f"{total} {what}")
    high = [f'{level} ({row["above"]:.2f} m)' for level, row in zip(levels, rows) if row["above"] > RUN_AWAY]
    if high:
        faults.append("higher than the building's scan at " + ", ".join(high))
    growth = rows[-1]["mse"] / rows[0]["mse"]
    return f"{'gentle' if not faults else '**not gentle**: ' + '; '.join(faults)}. Last level / first: {growth:.1f}."


def table(name, blocks, levels, rows):
    share = lambda x: "–" if x is None else f"{100 * x:.0f} %"
    print(f"### {name}\n")
    print(f"| level | MSE m² ({', '.join(blocks)}) | 0.75 m inside | median m | prisms' MSE | missing | without own "
          "model | fallbacks | highest above its scan m | party walls found | of the model's false | false splits |")
    print("|" + "---|" * 12)
    for level, row in zip(levels, rows):
        each = ", ".join(f"{value:.2f}" for value in row["each"])
        print(f'| {level} | {row["mse"]:.3f} ({each}) | {row["inside"]:.3f} | {row["median"]:.3f} '
              f'| {row["prism"]:.2f} | {row["missing"]} | {row["no_model"]} | {row["fallback"]} '
              f'| {row["above"]:.2f} | {share(row["found"])} | {share(row["false"])} | {row["splits"]} |')
    print(f"\n{verdict(levels, rows)}\n")


def worst(cells):
    """Every building that runs away, lacks or fell back, the highest first."""
    lines = []
    for cell in cells:
        if cell["failed"]:
            lines.append((1e9, f'{cell["where"]}: failed'))
            continue
        high = {name: by for name, by in cell["above"].items() if by > RUN_AWAY}
        for name, by in high.items():
            lines.append((by, f'{cell["where"]}: {name} {by:.2f} m above the scan of itself, '
                              f'{cell["over_all"][name]:+.2f} m of all that the scan shows there'))
        kinds = {"missing": "not modelled", "no_model": "has no model of its own", "fallback": "fallback"}
        for key, what in kinds.items():
            lines += [(0, f'{cell["where"]}: {one}: {what}') for one in cell[key]]
    for _, line in sorted(lines, key=lambda line: -line[0]):
        print("- " + line)


def main():
    names, cells, blocks = {}, {}, []
    for line in (OUT / "cells").read_text(encoding="utf-8").splitlines():
        name, level, block, folder = line.split()
        if folder not in cells:
            cells[folder] = cell_of(folder)
        blocks += [block] if block not in blocks else []
        names.setdefault(name, {}).setdefault(level, []).append(cells[folder])
    for name, levels in names.items():
        usable = {level: summary(those) for level, those in levels.items() if not all(c["failed"] for c in those)}
        table(name, blocks, list(usable), list(usable.values()))
    print("### single cases\n")
    worst(cells.values())


main()
