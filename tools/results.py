#!/usr/bin/env python3
"""Measures the program and writes the tables of docs/results.md, docs/results/scans.md and docs/results/shapes.md.

usage: tools/results.py DATA OUT             measures with tools/accuracy.py and tools/shapes.py, then writes (some minutes)
       tools/results.py --measured OUT       writes from what an earlier call has left in OUT

DATA is the folder with airborne, sim_rotterdam, delft, mvs_buildings and zhongshan. The program is $MANSARD, else
build/release/bin/mansard. $VAL3DITY, where it is set, is val3dity 2: without it the row of valid models stays as it is.
A table is what is between `<!-- tools/results.py: NAME -->` and `<!-- end -->` in a page; the text around it is written by hand. Needs python3-pil,
which python3-matplotlib brings.
"""
import datetime
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
MANSARD = os.environ.get("MANSARD", "build/release/bin/mansard")
OF_TRUTH = {"20": "laser scan, 20 points/m²", "8": "laser scan, 8 points/m²", "3": "laser scan, 3 points/m²",
            "photogrammetric": "photogrammetric mesh", "perfect": "perfect scan"}
REAL = {"delft": "Delft: airborne laser scan, as a mesh without walls", "hall": "hall: photogrammetry",
        "b9": "b9: photogrammetry, most walls missing", "zhongshan-L19": "Zhongshan L19: oblique photogrammetry",
        "zhongshan-L18": "Zhongshan L18: the same, coarser"}

# roofer 1.1 with the same footprints, measured on 26 November 2026. Laser scans: on the same points, by `mansard evaluate`. Meshes: on clouds that
# were sampled from them with 10 and 40 points/m², mean of five clouds, worst and best of its settings.
# MSE over the footprints, m²; median, m; recall and precision of roof planes; CPU s.
ROOFER = {"20": ([0.351], [0.004], (0.87, 0.96), [2.6]), "8": ([0.580], [0.006], (0.82, 0.98), [1.4]),
          "3": ([1.641], [0.008], (0.58, 0.98), [0.7]), "photogrammetric": ([0.62, 0.36], [0.095, 0.093], None, [3.8, 1.7])}
# MSE 0.75 m inside of the footprints, m².
ROOFER_INSIDE = {"zhongshan-L19": [10.7, 2.1], "hall": [0.38, 0.15], "b9": [0.42, 0.15]}


def measure(data, out):
    out.mkdir(parents=True, exist_ok=True)
    for name, arguments in (("accuracy", [data, out / "accuracy"]), ("shapes", [out / "shapes"])):
        done = subprocess.run([sys.executable, ROOT / f"tools/{name}.py", *arguments], stdout=subprocess.PIPE, text=True, check=True)
        (out / f"{name}.md").write_text(done.stdout, encoding="utf-8")
    street = out / "street"
    shutil.rmtree(street, ignore_errors=True)
    subprocess.run([MANSARD, "reconstruct", ROOT / "data/delft/mesh.ply", ROOT / "data/delft/footprints.geojson", "--mesh-offset", "84800",
                    "447400", "0", "-o", street, "--picture", "-q"], stdout=subprocess.DEVNULL, check=True)
    validate(out)


def validate(out):
    """The number of buildings that val3dity accepts, of all models in OUT."""
    if "VAL3DITY" not in os.environ:
        return
    valid = buildings = 0
    for model in sorted([*out.glob("accuracy/*/run/model.city.json"), *out.glob("shapes/*/*/model.city.json")]):
        report = out / "val3dity.json"
        subprocess.run([os.environ["VAL3DITY"], model, "--report", report], stdout=subprocess.DEVNULL, check=False)
        features = json.loads(report.read_text(encoding="utf-8"))["features"]
        buildings += len(features)
        valid += sum(1 for feature in features if feature["validity"])
        report.unlink()
    (out / "valid.json").write_text(json.dumps({"buildings": buildings, "valid": valid}), encoding="utf-8")


def rmse(values, digits=2):
    """Root mean square of mean squares; of the worst and best of several, both."""
    return "–" if values is None else " to ".join(f"{value ** 0.5:.{digits}f}" for value in values)


def table(header, rows):
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in [header, ["---"] * len(header), *rows])


def read(out):
    found = {}
    for name in [*OF_TRUTH, *REAL]:
        folder = out / "accuracy" / name
        found[name] = [json.loads((folder / file).read_text(encoding="utf-8")) for file in ("evaluation/report.json", "run/run.json")]
    return found


def peers(found):
    rows = []
    for name, title in OF_TRUTH.items():
        report, run = found[name]
        truth, planes = report["truth"], report["truth"]["form"]["planes"]
        mse, median, of_planes, cpu = ROOFER.get(name, (None, None, None, None))
        rows.append([title, rmse([truth["prism"]["footprint_mse_m2"]]), rmse(mse), f'**{rmse([truth["scores"]["footprint_mse_m2"]])}**',
                     "–" if median is None else " to ".join(f"{m:.3f}" for m in median), f'{truth["scores"]["footprint_median_absolute_m"]:.3f}',
                     "–" if of_planes is None else f"{of_planes[0]:.2f}, {of_planes[1]:.2f}", f'{planes["recall"]:.2f}, {planes["precision"]:.2f}',
                     "–" if cpu is None else " to ".join(f"{c:.1f}" for c in cpu), f'{run["times"]["cpu_seconds"]:.1f}'])
    return table(["29 houses, against the truth", "RMSE, m: prism", "roofer", "mansard", "median error, m: roofer", "mansard",
                  "roof planes found, right: roofer", "mansard", "CPU s: roofer", "mansard"], rows)


def real(found):
    rows = []
    for name, title in REAL.items():
        report, run = found[name]
        scores = report["scores"]
        rows.append([title, run["counts"]["full"], rmse([report["prism"]["inside_each"]["mse_m2"]]), rmse(ROOFER_INSIDE.get(name)),
                     f'**{rmse([scores["inside"]["mse_m2"]])}**', f'{scores["footprint_median_absolute_m"]:.3f}', f'{run["times"]["cpu_seconds"]:.1f}'])
    return table(["real scans, against the scan", "models", "RMSE, m: prism", "roofer", "mansard", "median error, m", "CPU s"], rows)


def valid(out):
    file = out / "valid.json"
    if not file.exists():
        return None
    counted = json.loads(file.read_text(encoding="utf-8"))
    return f'{counted["valid"]} of {counted["buildings"]} models of these scans and of the [exact shapes](results/shapes.md) are valid by val3dity 2.6.'


def form(found):
    rows = []
    of = lambda form, part, whole: f"{form[part]} of {form[whole]}"
    for name in [*OF_TRUTH, *REAL]:
        report, run = found[name]
        form = report["form"]
        worse = report["truth"]["worse_than_prism"] if report.get("truth") else report["worse_than_prism"]
        rows.append([{**OF_TRUTH, **REAL}[name].split(":")[0], report["model"]["faces"], of(form, "narrow_planes", "planes"),
                     of(form, "twins_unequal", "twins"), of(form, "steep_planes_without_scan", "steep_planes"), of(form, "short_edges", "edges"),
                     f'{len(worse)} of {run["counts"]["footprints"]}'])
    return table(["scan", "faces", "planes narrower than 0.75 m", "opposite pitches unequal", "planes over 65° without scan", "edges under 0.5 m",
                  "buildings worse than a prism"], rows)


def fill(page, tables):
    path = ROOT / page
    text = path.read_text(encoding="utf-8")
    for name, body in tables.items():
        if body is None:
            continue
        text, count = re.subn(rf"(<!-- tools/results.py: {name} -->\n)(?:(?!<!--).)*(<!-- end -->)",
                              lambda m: m[1] + "\n" + body.strip() + "\n\n" + m[2], text, flags=re.S)
        if count != 1:
            sys.exit(f"{page}: expected the table '{name}' once, found it {count} times")
    path.write_text(text, encoding="utf-8")


def draw(street):
    """The pictures of the run over data/delft, the first at half its size."""
    if not (street / "picture.png").exists():
        return
    with Image.open(street / "picture.png") as picture:
        picture.reduce(2).save(ROOT / "docs/pictures/delft.png", optimize=True)
    shutil.copyfile(street / "error.png", ROOT / "docs/pictures/delft-error.png")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[2])
    if sys.argv[1] == "--measured":
        if "VAL3DITY" in os.environ:
            validate(out)
    else:
        measure(pathlib.Path(sys.argv[1]), out)
    found = read(out)
    made = datetime.datetime.fromtimestamp((out / "accuracy/delft/run/run.json").stat().st_mtime)
    date = f"Measured on {made.day} {made:%B %Y} with version {found['delft'][1]['mansard']}."
    truth, scan = (out / "accuracy.md").read_text(encoding="utf-8").split("\n\n")
    fill("docs/results.md", {"date": date, "peers": peers(found), "real": real(found), "valid": valid(out)})
    fill("docs/results/scans.md", {"date": date, "truth": truth, "scan": scan, "form": form(found)})
    fill("docs/results/shapes.md", {"date": date, "shapes": (out / "shapes.md").read_text(encoding="utf-8")})
    draw(out / "street")


main()
