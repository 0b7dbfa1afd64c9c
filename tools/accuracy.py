#!/usr/bin/env python3
"""Reconstructs scans of known and unlike accuracy with default options and prints the first two tables of docs/results/scans.md.

usage: tools/accuracy.py DATA OUT     DATA: the folder with airborne, sim_rotterdam, delft, mvs_buildings, zhongshan
The program is $MANSARD, else build/release/bin/mansard.
"""
import json
import os
import pathlib
import resource
import subprocess
import sys

MANSARD = os.environ.get("MANSARD", "build/release/bin/mansard")
DATA, OUT = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
BLOCK = DATA / "sim_rotterdam/block_A_footprints.geojson"
TRUTH = DATA / "sim_rotterdam/block_A_truth.obj"
OFFSET = ["--mesh-offset", "84800", "447400", "0"]
TRUE_SCANS = [("perfect", DATA / "airborne/block_A_perfect.ply"), ("20 points/m²", DATA / "airborne/block_A_20.las"),
              ("8 points/m²", DATA / "airborne/block_A_8.las"), ("3 points/m²", DATA / "airborne/block_A_3.las"),
              ("photogrammetric mesh", DATA / "sim_rotterdam/block_A_sim_mesh.ply")]
SCANS = [("delft", DATA / "delft/delft_west_mesh.ply", DATA / "delft/delft_west_footprints.geojson", OFFSET),
         ("hall", DATA / "mvs_buildings/cgal_building.off", DATA / "mvs_buildings/cgal_footprints.geojson", []),
         ("b9", DATA / "mvs_buildings/b9_mesh.off", DATA / "mvs_buildings/b9_footprints.geojson", []),
         ("zhongshan-L19", DATA / "zhongshan/zhongshan_A_L19.ply", DATA / "zhongshan/zhongshan_A_footprints.geojson", []),
         ("zhongshan-L18", DATA / "zhongshan/zhongshan_A_L18.ply", DATA / "zhongshan/zhongshan_A_footprints.geojson", [])]


def run(*command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    code = subprocess.run([MANSARD, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if code.returncode > 1:
        sys.exit(f"mansard {command[0]} ended with exit code {code.returncode}:\n{code.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def made(name, scan, footprints, more, truth):
    """The report of the evaluation, that of the run, and CPU seconds."""
    folder = OUT / name.split()[0]
    run_folder = folder / "run"
    subprocess.run(["rm", "-rf", folder], check=True)
    cpu = run("reconstruct", scan, footprints, *more, "-o", run_folder, "--overwrite", "-q")
    run("evaluate", run_folder / "model.city.json", scan, *more, "--footprints", footprints,
        *(["--truth", truth] if truth else []), "-o", folder / "evaluation", "--overwrite", "-q")
    read = lambda path: json.loads(path.read_text(encoding="utf-8"))
    return read(folder / "evaluation/report.json"), read(run_folder / "run.json"), cpu


def accuracy(report):
    a = report["accuracy"]
    return f'{a["noise_m"]:.3f} | {a["correlated_area_m2"]:.2f} | {a["spacing_m"]:.2f} | {a["blur_m"]:.2f} | {a["edge_noise_m"]:.2f}'


OUT.mkdir(parents=True, exist_ok=True)
print("| block A | noise, m | area, m² | spacing, m | blur, m | edges, m | footprint / inside MSE, m² | median, m | recall, precision of planes (of the model) "
      "| every plane right | CPU s |")
print("|---|---|---|---|---|---|---|---|---|---|---|")
for name, scan in TRUE_SCANS:
    report, of_run, cpu = made(name, scan, BLOCK, [], TRUTH)
    truth, form = report["truth"]["scores"], report["truth"]["form"]
    planes = form["planes"]
    print(f'| {name} | {accuracy(of_run)} | {truth["footprint_mse_m2"]:.3f} / {truth["inside"]["mse_m2"]:.3f} '
          f'| {truth["footprint_median_absolute_m"]:.3f} | {planes["recall"]:.2f}, {planes["precision"]:.2f} ({planes["model"]}) '
          f'| {form["buildings_with_every_plane_right"]} of {form["buildings"]} | {cpu:.1f} |', flush=True)
print("\n| against the scan | noise, m | area, m² | spacing, m | blur, m | edges, m | footprint / inside MSE, m² | median, m | planes | CPU s |")
print("|---|---|---|---|---|---|---|---|---|---|")
for name, scan, footprints, more in SCANS:
    report, of_run, cpu = made(name, scan, footprints, more, None)
    scores = report["scores"]
    print(f'| {name} | {accuracy(of_run)} | {scores["footprint_mse_m2"]:.3f} / {scores["inside"]["mse_m2"]:.3f} '
          f'| {scores["footprint_median_absolute_m"]:.3f} | {report["form"]["planes"]} | {cpu:.1f} |', flush=True)
