#!/usr/bin/env python3
"""Prints the form scores of evaluations as one Markdown table, a column for each: docs/evaluate.md, "Form".

usage: tools/form.py REPORT.json|FOLDER…     (a folder as tools/targets.sh makes it: FOLDER/NAME/report.json)
"""
import json
import pathlib
import sys


def reports_in(arguments):
    for path in map(pathlib.Path, arguments):
        if path.is_dir():
            for file in sorted(path.glob("*/report.json")):
                yield file.parent.name, json.loads(file.read_text(encoding="utf-8"))
        else:
            yield path.parent.name if path.name == "report.json" else path.stem, json.loads(path.read_text(encoding="utf-8"))


def share(value):
    return "–" if value is None else f"{value:.2f}"


def of(form, part, whole):
    return f"{form[part]} of {form[whole]}"


def scores(report):
    """Name → text of what one report says."""
    form, truth = report["form"], report.get("truth", {}).get("form")
    against = report["truth"]["scores"] if truth else report["scores"]
    out = {
        "MSE over footprints, m²": f'{against["footprint_mse_m2"]:.3f}',
        "MSE inside, m²": f'{against["inside"]["mse_m2"]:.3f}' if against["inside"] else "–",
        "roof planes": str(form["planes"]),
        "narrower than 0.75 m": str(form["narrow_planes"]),
        "opposite pitches unequal": of(form, "twins_unequal", "twins"),
        "over 65° without scan": of(form, "steep_planes_without_scan", "steep_planes"),
        "parts taller than 3·√area": of(form, "tall_parts", "parts"),
        "near ridges unequal": of(form, "near_ridges_unequal", "near_ridges"),
        "edges under 0.5 m": of(form, "short_edges", "edges"),
        "vertices per building": f'{form["vertices_per_building"]:.1f}',
        "dormers, other structures": f'{form["dormers"]}, {form["roof_structures"]}',
    }
    if not truth:
        return out
    real = truth["truth_itself"]
    out["of the truth: planes, narrow"] = f'{real["planes"]}, {real["narrow_planes"]}'
    out["of the truth: pitches unequal"] = of(real, "twins_unequal", "twins")
    out["planes per building to truth"] = share(truth["planes_per_building_to_truth"])
    for name, found, unit in [("planes", truth["planes"], "m2")] + [
            (kind + "s", lines, "m") for kind, lines in truth["lines"].items()] + [
            ("dormers", truth["dormers"], "m2"), ("other structures", truth["roof_structures"], "m2")]:
        out[f"{name}: recall by count, size"] = f'{share(found["recall"])}, {share(found["recall_" + unit])}'
        out[f"{name}: precision by count, size"] = f'{share(found["precision"])}, {share(found["precision_" + unit])}'
    return out


columns = [(name, scores(report)) for name, report in reports_in(sys.argv[1:]) if "form" in report]
if not columns:
    sys.exit("no report has form scores\n" + __doc__)
rows = list(dict.fromkeys(key for _, column in columns for key in column))
print("| | " + " | ".join(name for name, _ in columns) + " |\n|---" + "|---" * len(columns) + "|")
for key in rows:
    print(f"| {key} | " + " | ".join(column.get(key, "") for _, column in columns) + " |")
