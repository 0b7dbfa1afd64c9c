#!/usr/bin/env python3
"""A run of any size for measurements: the models of a run, copied side by side on a grid.

    copied_run.py FOLDER OUT COPIES_A_SIDE [SPACING]

FOLDER is of `mansard reconstruct --formats plans`, or of a project's run. OUT gets the report and plans.json with COPIES_A_SIDE² times the
buildings, whose ids end in ~1, ~2, … from the second copy on. SPACING is in whole metres, 230 by default. Counts in the report are of all
copies; scores are those of the original, and blocks are left out but for those.
"""
import json
import pathlib
import sys


def moved(points, by):
    return [[p[0] + by[0], p[1] + by[1]] for p in points]


def copied(building, by, ending):
    out = dict(building, id=building["id"] + ending)
    out["footprint"] = [{"outer": moved(p["outer"], by), "holes": [moved(h, by) for h in p["holes"]]} for p in building["footprint"]]
    out["parts"] = []
    for part in building["parts"]:
        plan = dict(part["plan"])
        plan["outer"] = dict(plan["outer"], points=moved(plan["outer"]["points"], by))
        plan["holes"] = [dict(hole, points=moved(hole["points"], by)) for hole in plan["holes"]]
        attributes = dict(part["attributes"])
        if "ms_block" in attributes:
            attributes["ms_block"] += ending
        out["parts"].append(dict(part, id=part["id"] + ending, plan=plan, attributes=attributes))
    return out


def main(folder, out, side, spacing=230):
    folder, out, side, spacing = pathlib.Path(folder), pathlib.Path(out), int(side), int(spacing)
    out.mkdir(parents=True, exist_ok=True)
    name = "report.json" if (folder / "report.json").exists() else "run.json"
    plans, report = json.loads((folder / "plans.json").read_text()), json.loads((folder / name).read_text())
    places = [(column * spacing, row * spacing) for row in range(side) for column in range(side)]
    endings = ["" if not k else f"~{k}" for k in range(len(places))]
    buildings = plans.pop("buildings")
    with (out / "plans.json").open("w") as file:
        file.write(json.dumps(plans)[:-1] + ', "buildings": [')
        for k, (by, ending) in enumerate(zip(places, endings)):
            file.write(",\n".join([""] * (k > 0) + [json.dumps(copied(b, by, ending)) for b in buildings]))
        file.write("]}\n")
    for count in report["counts"]:
        report["counts"][count] *= len(places)
    reports = report.pop("buildings")
    with (out / name).open("w") as file:
        file.write(json.dumps(report)[:-1] + ', "buildings": [')
        for k, ending in enumerate(endings):
            file.write(",\n".join([""] * (k > 0) + [json.dumps(dict(b, id=b["id"] + ending, block=b["block"] + ending)) for b in reports]))
        file.write("]}\n")
    print(f"{len(buildings) * len(places)} buildings")


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    main(*sys.argv[1:])
