#!/usr/bin/env python3
"""Compares the standard errors of attributes (ms_…_se) with the errors that they are about, on simulated scans whose truth is known.

usage: tools/standard_errors.py OUTDIR [--kinds KIND…] [--seeds N…] [--presets NAME…] [--size M] [--points DENSITY] [--more OPTION…]
The program is $MANSARD, else build/release/bin/mansard. Scans and truth in OUTDIR stay for the next run; models are made again.
For every preset of `mansard simulate` and every attribute: how many buildings have the number, its median absolute error and the
median of its standard error, and the share of buildings whose truth is within one and within two standard errors (68 and 95 % where
the standard errors are right). The truth is the planted model with the same attributes, measured of it, in truth.city.json.
Footprints of several buildings are left out, and so are buildings with parapets, which only sharp scans show. The worst are listed with --worst N.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

MANSARD = os.environ.get("MANSARD", "build/release/bin/mansard")
ATTRIBUTES = ["ms_h_ground", "ms_h_eave", "ms_h_ridge", "ms_h_roof_min", "ms_h_roof_50p", "ms_h_roof_70p", "ms_h_roof_max", "ms_volume_lod22",
              "ms_area_ground", "ms_area_wall", "ms_area_party_wall"]
PRESETS = ["clean", "nadir-drone", "oblique-aerial", "lidar-2.5d"]


def run(*command):
    done = subprocess.run([MANSARD, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode > 1:
        sys.exit(f"mansard {' '.join(map(str, command))} ended with exit code {done.returncode}:\n{done.stderr}")


def attributes(path):
    with open(path, encoding="utf-8") as file:
        objects = json.load(file)["CityObjects"]
    return {id: o.get("attributes", {}) for id, o in objects.items() if o["type"] == "Building"}


def compared(folder, kind, seed, preset, options):
    """Pairs of attributes, of the models and of the truth, of one block."""
    if not (folder / "truth.city.json").exists():
        shutil.rmtree(folder, ignore_errors=True)
        points = ["--points", options.points] if options.points else []
        run("simulate", "--block", kind, "--preset", preset, "--seed", seed, "--simulate-size", options.size, *options.more, *points,
            "-o", folder, "-q")
    scan = next(iter(sorted(folder.glob("points.*")))) if options.points else folder / "mesh.ply"
    run("reconstruct", scan, folder / "footprints.geojson", "-o", folder / "run", "--formats", "cityjson", "--overwrite", "-q", *options.reconstruct)
    model, truth = attributes(folder / "run/model.city.json"), attributes(folder / "truth.city.json")
    with open(folder / "truth.json", encoding="utf-8") as file:
        planted = json.load(file)
    of = {f["id"]: f["buildings"].split() for f in planted["footprints"]}
    parapets = {b["id"] for b in planted["buildings"] if any(part["role"] == "parapet" for part in b["parts"])}
    return [(f"{folder.name}/{id}", model[id], truth[of[id][0]]) for id in model
            if len(of[id]) == 1 and (options.parapets or of[id][0] not in parapets)]


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("outdir", type=pathlib.Path)
    ask.add_argument("--kinds", nargs="+", default=["terrace", "perimeter", "courtyard", "towers", "detached"])
    ask.add_argument("--seeds", nargs="+", type=int, default=[1, 3, 5])
    ask.add_argument("--presets", nargs="+", default=PRESETS)
    ask.add_argument("--size", type=float, default=50)
    ask.add_argument("--points", type=float)
    ask.add_argument("--more", nargs="+", default=[], help="options of mansard simulate, without the dashes: slope=0.3")
    ask.add_argument("--reconstruct", nargs="+", default=[], help="options of mansard reconstruct, likewise")
    ask.add_argument("--parapets", action="store_true", help="buildings with parapets too, which only sharp scans show")
    ask.add_argument("--worst", type=int, default=0)
    options = ask.parse_args()
    dashed = lambda given: [part for one in given for part in ("--" + one).split("=")]
    options.more, options.reconstruct = dashed(options.more), dashed(options.reconstruct)
    print("| preset | attribute | buildings | median error | median standard error | within 1 | within 2 |\n|---|---|---|---|---|---|---|")
    for preset in options.presets:
        pairs = []
        for kind in options.kinds:
            for seed in options.seeds:
                pairs += compared(options.outdir / f"{preset}-{kind}-{seed}", kind, seed, preset, options)
        for name in ATTRIBUTES:
            both = [(model[name] - truth[name], model.get(name + "_se"), id) for id, model, truth in pairs
                    if model.get(name) is not None and truth.get(name) is not None]
            known = [(error, se, id) for error, se, id in both if se is not None]
            within = lambda k: f"{sum(abs(e) <= k * se + 1e-9 for e, se, _ in known) / len(known):.2f}" if known else "–"
            median = lambda values: f"{statistics.median(values):.3f}" if values else "–"
            print(f"| {preset} | {name} | {len(known)} of {len(both)} | {median([abs(e) for e, _, _ in both])} (mean {median([e for e, _, _ in both])}) "
                  f"| {median([se for _, se, _ in known])} | {within(1)} | {within(2)} |", flush=True)
            for error, se, id in sorted(known, key=lambda one: -abs(one[0]) / (one[1] + 1e-4))[:options.worst]:
                print(f"    {id}: {error:+.3f} ± {se:.3f}")


main()
