#!/usr/bin/env python3
"""Trains what the program says of its own models: `ms_confidence` and `ms_error` (docs/confidence.md).

usage: tools/confidence.py survey OUT [FIRST LAST]   simulates surveys with faults, reconstructs them, compares with truth: OUT/*.json
       tools/confidence.py train OUT HEADER          fits both models to all surveys but the held-out ones, writes the header
       tools/confidence.py test OUT PICTURES         curves and tables of the held-out surveys, by the program's own numbers
The program is $MANSARD, else build/release/bin/mansard. Needs numpy.
"""
import datetime
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np

MANSARD = os.environ.get("MANSARD", "build/release/bin/mansard")
KINDS = ["terrace", "perimeter", "courtyard", "towers", "detached"]
WRONG = 0.5  # m²; mean squared error against truth, 0.3 m inside the outline

# Name, preset, points per m² (0: the mesh), further options. The last four are held out: no survey of these is trained on.
SCANS = [
    ("oblique", "oblique-aerial", 0, []),
    ("drone", "nadir-drone", 0, []),
    ("lidar 8", "lidar-2.5d", 8, ["--simulate-points-noise", "0.03"]),
    ("lidar 20", "lidar-2.5d", 20, ["--simulate-points-noise", "0.02"]),
    ("faces 12", "clean", 12, ["--simulate-points-noise", "0.05"]),
    ("coarse", "oblique-aerial", 0, ["--simulate-resolution", "0.6", "--simulate-melt", "0.5", "--simulate-noise", "0.1"]),
    ("lidar 3", "lidar-2.5d", 3, ["--simulate-points-noise", "0.05"]),
    ("matched 10", "oblique-aerial", 10, ["--simulate-trees", "15"]),
    ("lidar 5", "lidar-2.5d", 5, ["--simulate-points-noise", "0.04", "--simulate-trees", "15"]),
    ("fine", "nadir-drone", 0, ["--simulate-noise", "0.015", "--simulate-melt", "0.1", "--simulate-jitter", "0.1"]),
]
HELD_OUT = [name for name, *_ in SCANS[-4:]]
# Share of the buildings of a survey that have a fault.
FAULTS = [0.35, 0.2, 0.0]
# m; footprints are of walls in most registers, and a roof that overhangs is not wrong.
OVERHANGS = [0.0, 0.3, 0.0, 0.8]


def run(*command, allow=(0, 1)):
    code = subprocess.run([MANSARD, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if code.returncode not in allow:
        raise RuntimeError(f"mansard {' '.join(map(str, command))} ended with exit code {code.returncode}:\n{code.stderr}")


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def survey(out, number):
    """One simulated survey: every model with its evidence, what it is wrong by, and the fault that was planted."""
    result = out / f"{number:04d}.json"
    if result.exists():
        return
    name, preset, points, more = SCANS[number % len(SCANS)]
    kind = KINDS[(number // len(SCANS)) % len(KINDS)]
    faults = FAULTS[(number // 7) % len(FAULTS)]
    heights = ["--simulate-heights", "true"] if (number // 3) % 2 else []
    overhang = OVERHANGS[(number // 4) % len(OVERHANGS)]
    folder = out / f"work-{number}"
    shutil.rmtree(folder, ignore_errors=True)
    seed = 1000 + number
    run("simulate", "--block", kind, "--preset", preset, "--seed", seed, "--simulate-faults", faults, "--simulate-size", 80,
        "--simulate-overhang", overhang, *heights, *more, *(["--points", points] if points else []), "-o", folder / "scene", "-q")
    scene = folder / "scene"
    scan = scene / ("points.las" if points else "mesh.ply")
    run("reconstruct", scan, scene / "footprints.geojson", "-o", folder / "run", "-q")
    run("evaluate", folder / "run/model.city.json", scene / "mesh.ply", "--truth", scene / "truth.city.json",
        "--footprints", scene / "truth.geojson", "--evaluate-inset", 0.3, "-o", folder / "evaluation", "-q")
    truth, made, judged = read(scene / "truth.json"), read(folder / "run/run.json"), read(folder / "evaluation/report.json")
    fault_of = {fault["building"]: fault for fault in truth.get("faults", [])}
    scores = {b["id"]: b["truth"]["inside_each"] for b in judged["buildings"]}
    of_feature = {f["id"]: f["buildings"].split() for f in truth["footprints"]}
    rows = []
    for building in made["buildings"]:
        own = [scores[b] for b in of_feature[building["id"]] if b in scores]
        cells = sum(s["cells"] for s in own)
        rows.append({
            "id": building["id"],
            "outcome": building["outcome"],
            "evidence": building.get("evidence"),
            "said": building.get("confidence"),
            "mse": sum(s["cells"] * s["mse_m2"] for s in own) / cells if cells else None,
            "faults": [fault_of[b]["kind"] for b in of_feature[building["id"]] if b in fault_of]})
    result.write_text(json.dumps({"number": number, "scan": name, "kind": kind, "share": faults, "seed": seed,
                                  "heights": bool(heights), "buildings": rows}, indent=1) + "\n", encoding="utf-8")
    shutil.rmtree(folder)


# Scale of each measure: what of it is already worth a look. The accuracy of the scan (noise, spacing …) is not among them: with it, a
# model is better on scans like those that it was trained on, and worse on others. Those in EITHER may speak for a model, too.
SCALE = {
    "area": 50, "height": 3, "unseen": 0.05, "crowns": 0.05, "bare": 0.02, "razed": 0.05, "rms": 0.1, "bias": 0.05, "above": 0.02, "below": 0.02,
    "patch_above": 1, "patch_below": 1, "stacked": 0.05, "sunk": 0.05, "top": 0.3, "rough": 0.02, "ring_high": 0.05,
    "ring_side": 0.1, "gap": 0.05, "rim_low": 0.05, "rim_side": 0.1, "free": 0.3, "walls": 0.2, "steps": 1, "misplaced": 0.05, "relief": 0.5, "low": 0.1,
    "ground_off": 0.2, "samples": 50, "planes": 3, "small_planes": 0.05, "steep": 0.05, "spread": 1,
    "height_off": 0.5, "fallback": 0.5}
EITHER = {"area", "height", "free", "walls", "relief", "samples", "planes", "spread"}
# What two measures say together, a hole by what stands around it; and squares, where little says nothing and much a lot.
PRODUCTS = [("unseen", "unseen", 0.05), ("seamless", "seamless", 0.1), ("unseen", "spread", 0.2), ("height_off", "height_off", 2), ("gap", "height", 0.3),
            ("steps", "edge_noise", 0.1), ("ring_side", "rim_side", 0.05), ("relief", "relief", 2), ("spread", "free", 0.5)]
TERMS = [(name, "", scale) for name, scale in SCALE.items()] + [(a, b, scale) for a, b, scale in PRODUCTS]
CLOSE = 3.0  # weight of the ridge, in standard deviations of the terms


def rows_of(out):
    for path in sorted(out.glob("[0-9]*.json")):
        found = read(path)
        for building in found["buildings"]:
            if building["evidence"] is not None and building["mse"] is not None:
                yield found, building


def term_values(buildings):
    columns = []
    for a, b, scale in TERMS:
        columns.append([math.log1p(abs(x["evidence"][a] * (x["evidence"][b] if b else 1)) / scale) for x in buildings])
    return np.array(columns).T


def solve(terms, free, target, logistic):
    """Ridge regression, logistic or linear; weights that are not free are never negative."""
    spread = terms.std(0) + 1e-9
    usual = terms.mean(0)
    x = np.c_[np.ones(len(terms)), (terms - usual) / spread]
    used = np.ones(x.shape[1], bool)
    while True:
        w = np.zeros(x.shape[1])
        own, ridge = x[:, used], CLOSE * np.eye(used.sum())
        ridge[0, 0] = 1e-6
        part = np.zeros(used.sum())
        for _ in range(100):
            value = own @ part
            p = 1 / (1 + np.exp(-value)) if logistic else value
            weight = p * (1 - p) + 1e-9 if logistic else np.ones(len(p))
            step = np.linalg.solve((own.T * weight) @ own + ridge, own.T @ (p - target) + ridge @ part)
            part -= step
            if abs(step).max() < 1e-10:
                break
        w[used] = part
        wrong = np.r_[False, ~free] & (w < 0)
        if not wrong.any():
            break
        used &= ~wrong
    return w[0] - (w[1:] / spread) @ usual, w[1:] / spread


def area_under_curve(score, wrong):
    """Probability that a wrong one has a higher score than a right one."""
    _, place, count = np.unique(score, return_inverse=True, return_counts=True)
    rank = (np.cumsum(count) - (count - 1) / 2)[place]
    n = wrong.sum()
    return (rank[wrong].sum() - n * (n + 1) / 2) / (n * (len(wrong) - n))


def train(out, header):
    rows = [row for row in rows_of(out) if row[0]["scan"] not in HELD_OUT]
    buildings = [building for _, building in rows]
    mse = np.array([b["mse"] for b in buildings])
    wrong = mse > WRONG
    terms = term_values(buildings)
    free = np.array([a in EITHER and (not b or b in EITHER) for a, b, _ in TERMS])
    bias, weights = solve(terms, free, wrong.astype(float), True)
    error_bias, error_weights = solve(terms, free, 0.5 * np.log(mse + 1e-3), False)
    usual = terms[~wrong].mean(0)
    lines = []
    for (a, b, scale), u, w, e in zip(TERMS, usual, weights, error_weights):
        if round(w, 4) == 0 and round(e, 4) == 0:
            continue
        second = f"Measure::{b}" if b else "alone"
        lines.append(f"    {{Measure::{a}, {second}, {scale}, {u:.4f}, {w:.4f}, {e:.4f}}},")
    surveys = len({f["number"] for f, _ in rows})
    text = f"""// Written by tools/confidence.py train: change the script, not this file.
// {datetime.date.today()}: {len(rows)} models of {surveys} simulated surveys, {int(wrong.sum())} of them wrong.
#pragma once

#include <array>

#include "mansard/confidence/detail/term.hpp"

namespace mansard::confidence::detail {{

inline constexpr double wrong_bias = {bias + weights @ usual:.4f}, error_bias = {error_bias + error_weights @ usual:.4f};
inline constexpr std::array<Term, {len(lines)}> terms{{{{
{chr(10).join(lines)}
}}}};

}}  // namespace mansard::confidence::detail
"""
    pathlib.Path(header).write_text(text, encoding="utf-8")
    subprocess.run(["clang-format", "-i", header], check=False)
    print(f"{len(rows)} models, {int(wrong.sum())} wrong; area under the curve {area_under_curve(terms @ weights, wrong):.3f} in training")


def groups_of(rows, name_of):
    names = {}
    for i, row in enumerate(rows):
        for name in name_of(row):
            names.setdefault(name, []).append(i)
    return names


def test(out, pictures):
    rows = [row for row in rows_of(out) if row[0]["scan"] in HELD_OUT and row[1]["said"]]
    wrong = np.array([building["mse"] > WRONG for _, building in rows])
    p = np.array([1 - building["said"]["right"] for _, building in rows])
    print(f"{len(rows)} models, {int(wrong.sum())} wrong; area under the curve {area_under_curve(p, wrong):.3f}")
    for limit in (0.1, 0.15, 0.2, 0.3, 0.5):
        print(f"flagged from {limit}: {100 * (p[wrong] >= limit).mean():.0f} % of the wrong, {100 * (p[~wrong] >= limit).mean():.0f} % of the right")
    print("| said to be right | models | right |")
    for tenth in range(10):
        inside = (1 - p >= tenth / 10) & (1 - p < (tenth + 1) / 10 + (tenth == 9))
        if inside.any():
            print(f"| {tenth / 10:.1f} to {(tenth + 1) / 10:.1f}, mean {(1 - p[inside]).mean():.2f} | {inside.sum()} | {(~wrong[inside]).mean():.2f} |")
    print("| scan | models | wrong | area under the curve |")
    for name, own in groups_of(rows, lambda row: [row[0]["scan"]]).items():
        if wrong[own].any():
            print(f"| {name} | {len(own)} | {int(wrong[own].sum())} | {area_under_curve(p[own], wrong[own]):.2f} |")
    print("| fault | models | wrong | of the wrong, from 0.15 | of the right, from 0.15 |")
    for name, own in sorted(groups_of(rows, lambda row: row[1]["faults"] or ["none"]).items()):
        own = np.array(own)
        bad, good = own[wrong[own]], own[~wrong[own]]
        share = lambda of: f"{100 * (p[of] >= 0.15).mean():.0f} %" if len(of) else "-"
        print(f"| {name} | {len(own)} | {len(bad)} | {share(bad)} | {share(good)} |")
    if pictures:
        pathlib.Path(pictures).mkdir(parents=True, exist_ok=True)
        (pathlib.Path(pictures) / "confidence.svg").write_text(picture(p, wrong), encoding="utf-8")


def picture(p, wrong):
    """Beside each other: how often models are right of which a probability is said, and the curve of flagged models."""
    def chart(x0, title, across, up):
        return [f'<text x="{x0 + 150}" y="22" text-anchor="middle" font-size="15">{title}</text>',
                f'<rect x="{x0}" y="35" width="300" height="300" fill="none" stroke="#888"/>',
                f'<path d="M{x0} 335 L{x0 + 300} 35" stroke="#bbb" stroke-dasharray="4 4" fill="none"/>',
                f'<text x="{x0 + 150}" y="372" text-anchor="middle" font-size="13">{across}</text>',
                f'<text transform="translate({x0 - 34} 185) rotate(-90)" text-anchor="middle" font-size="13">{up}</text>',
                *[f'<text x="{x0 + 60 * i}" y="352" text-anchor="middle" font-size="11">{i / 5:.1f}</text>' for i in range(6)],
                *[f'<text x="{x0 - 6}" y="{339 - 60 * i}" text-anchor="end" font-size="11">{i / 5:.1f}</text>' for i in range(6)]]
    lines = chart(60, "reliability", "probability said to be right", "share that is right")
    edges = np.quantile(1 - p, np.linspace(0, 1, 11))
    for low, high in zip(edges[:-1], edges[1:]):
        own = (1 - p >= low) & (1 - p <= high)
        x, y = (1 - p[own]).mean(), (~wrong[own]).mean()
        error = math.sqrt(max(y * (1 - y), 0.01) / own.sum())
        lines.append(f'<path d="M{60 + 300 * x:.1f} {335 - 300 * min(1, y + error):.1f} V{335 - 300 * max(0, y - error):.1f}" stroke="#27c"/>')
        lines.append(f'<circle cx="{60 + 300 * x:.1f}" cy="{335 - 300 * y:.1f}" r="4" fill="#27c"/>')
    lines += chart(440, "models to look at", "share of the right that are flagged", "share of the wrong that are flagged")
    order = np.sort(np.unique(p))[::-1]
    points = [(0, 0)] + [((p[~wrong] >= t).mean(), (p[wrong] >= t).mean()) for t in order]
    path = " L".join(f"{440 + 300 * x:.1f} {335 - 300 * y:.1f}" for x, y in points)
    lines.append(f'<path d="M{path}" stroke="#27c" stroke-width="2" fill="none"/>')
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="780" height="390" font-family="sans-serif"><rect width="780" height="390" fill="white"/>'
            + "".join(lines) + "</svg>\n")


if __name__ == "__main__":
    out = pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    if sys.argv[1] == "survey":
        first, last = (int(sys.argv[3]), int(sys.argv[4])) if len(sys.argv) > 4 else (0, 150)
        for number in range(first, last):
            survey(out, number)
            print(number, flush=True)
    elif sys.argv[1] == "train":
        train(out, sys.argv[3])
    else:
        test(out, sys.argv[3] if len(sys.argv) > 3 else "")
