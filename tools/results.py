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

import val3dity

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
          "3": ([1.641], [0.008], (0.58, 0.98), [0.7]), "photogrammetric": ([0.62, 0.36], [0.095, 0.093], (), [3.8, 1.7])}
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
        features = val3dity.check(os.environ["VAL3DITY"], model, report)["features"]
        buildings += len(features)
        valid += sum(1 for feature in features if feature["validity"])
        report.unlink()
    (out / "valid.json").write_text(json.dumps({"buildings": buildings, "valid": valid}), encoding="utf-8")


def both(theirs, ours, digits, most_is_best=False):
    """What roofer and mansard have, the better one bold; of several settings of roofer, the worst to the best."""
    shown = [f"{value:.{digits}f}" for value in theirs]
    best = f"{ours:.{digits}f}"
    rank = [float(value) * (-1 if most_is_best else 1) for value in (shown[-1], best)] if shown else [0, 0]
    bold = lambda text, is_best: f"**{text}**" if is_best else text
    return (" to ".join(shown[:-1] + [bold(shown[-1], rank[0] < rank[1])]) if shown else "–") + " / " + bold(best, rank[1] < rank[0])


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
        mse, median, of_planes, cpu = ROOFER.get(name, ([], [], [], []))
        rows.append([title, both([m ** 0.5 for m in mse], truth["scores"]["footprint_mse_m2"] ** 0.5, 2),
                     both(median, truth["scores"]["footprint_median_absolute_m"], 3),
                     both(of_planes[:1], planes["recall"], 2, True), both(of_planes[1:], planes["precision"], 2, True),
                     both(cpu, run["times"]["cpu_seconds"], 1)])
    prisms = [found[name][0]["truth"]["prism"]["footprint_mse_m2"] ** 0.5 for name in OF_TRUTH]
    header = ["roofer / mansard, 29 houses against the truth", "RMSE, m", "median error, m", "planes found", "planes right", "CPU s"]
    low, high = f"{min(prisms):.1f}", f"{max(prisms):.1f}"
    return table(header, rows) + "\n\nThe RMSE of prisms is " + (low if low == high else f"{low} to {high}") + " m."


def real(found):
    rows = []
    for name, title in REAL.items():
        report, run = found[name]
        scores = report["scores"]
        rows.append([title, run["counts"]["full"], f'{report["prism"]["inside_each"]["mse_m2"] ** 0.5:.2f} / '
                     + both([m ** 0.5 for m in ROOFER_INSIDE.get(name, [])], scores["inside"]["mse_m2"] ** 0.5, 2),
                     f'{scores["footprint_median_absolute_m"]:.3f}', f'{run["times"]["cpu_seconds"]:.1f}'])
    return table(["real scans, against the scan", "models", "RMSE, m: prism / roofer / mansard", "median error, m", "CPU s"], rows)


def chart(found):
    """The first column of the first table as bars."""
    left, width, row, bar = 190, 430, 52, 18
    names = [name for name in OF_TRUTH if name in ROOFER]
    scale = width / max(m ** 0.5 for name in names for m in ROOFER[name][0])
    text = lambda x, y, words, more="": f'<text x="{x:.0f}" y="{y}"{more}>{words}</text>'
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="760" height="{row * len(names) + 44}" font-family="sans-serif" font-size="14" fill="#222">',
           '<rect width="100%" height="100%" fill="#fff"/>']
    for i, name in enumerate(names):
        y = 10 + i * row
        out.append(text(left - 10, y + bar + 5, OF_TRUTH[name], ' text-anchor="end"'))
        bars = [("roofer", ROOFER[name][0][-1], "#9aa5b1"), ("mansard", found[name][0]["truth"]["scores"]["footprint_mse_m2"], "#c2553f")]
        for k, (program, mse, colour) in enumerate(bars):
            at, long = y + k * (bar + 2), mse ** 0.5 * scale
            out += [f'<rect x="{left}" y="{at}" width="{long:.0f}" height="{bar}" fill="{colour}"/>',
                    text(left + long + 6, at + 14, f"{program} {mse ** 0.5:.2f} m")]
    out += [text(left, row * len(names) + 30, "RMSE over the footprints of 29 houses, m; of roofer the best setting", ' fill="#555"'), "</svg>"]
    (ROOT / "docs/pictures/results.svg").write_text("\n".join(out) + "\n", encoding="utf-8")


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
        if not (out / "shapes.md").exists():
            sys.exit(f"{out}: an earlier run of tools/results.py has left nothing complete there; measure with tools/results.py DATA {out}")
        if "VAL3DITY" in os.environ:
            validate(out)
    elif not (pathlib.Path(sys.argv[1]) / "airborne").is_dir():
        sys.exit(f"{sys.argv[1]}: expected a folder with airborne, sim_rotterdam, delft, mvs_buildings and zhongshan")
    else:
        measure(pathlib.Path(sys.argv[1]), out)
    found = read(out)
    made = datetime.datetime.fromtimestamp((out / "accuracy/delft/run/run.json").stat().st_mtime)
    date = f"Measured on {made.day} {made:%B %Y} with version {found['delft'][1]['mansard']}."
    truth, scan = (out / "accuracy.md").read_text(encoding="utf-8").split("\n\n")
    fill("docs/results.md", {"date": date, "peers": peers(found), "real": real(found), "valid": valid(out)})
    fill("docs/results/scans.md", {"date": date, "truth": truth, "scan": scan, "form": form(found)})
    fill("docs/results/shapes.md", {"date": date, "shapes": (out / "shapes.md").read_text(encoding="utf-8")})
    chart(found)
    draw(out / "street")


main()
