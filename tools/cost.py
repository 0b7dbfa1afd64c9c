#!/usr/bin/env python3
"""Measures what buildings cost against their size, and writes docs/cost.md: tools/cost.py MANSARD DATA OUT [PAGE]

DATA is the folder with sim_rotterdam, delft, mvs_buildings, zhongshan, airborne, points and faults. Every input there with
a scan is reconstructed, and simulated blocks of five kinds in six kinds of scans until there are 500 buildings. OUT keeps
the runs, so that an interrupted measurement goes on; PAGE is docs/cost.md by default. Needs numpy and shapely.
"""
import json
import pathlib
import subprocess
import sys

import numpy
from shapely.geometry import shape

SIMULATED = 500  # buildings
KINDS = ["terrace", "perimeter", "courtyard", "towers", "detached"]
SCANS = [  # name, preset, points per m² (0: a mesh), further options
    ("oblique", "oblique-aerial", 0, []),
    ("laser 20", "lidar-2.5d", 20, ["--simulate-points-noise", "0.03"]),
    ("drone", "nadir-drone", 0, []),
    ("laser 3", "lidar-2.5d", 3, ["--simulate-points-noise", "0.05"]),
    ("exact", "clean", 0, []),
    ("details", "oblique-aerial", 0, ["--simulate-dormers", "0.5", "--simulate-plant-rooms", "0.5", "--simulate-bays", "0.3",
                                      "--simulate-extensions", "0.3"]),
]
DELFT_OFFSET = ["--mesh-offset", "84800", "447400", "0"]
SHARED = [  # name, scan, footprints (none: derived), further options
    ("block_A", "sim_rotterdam/block_A_sim_mesh.ply", "sim_rotterdam/block_A_footprints.geojson", []),
    ("block_A_20", "airborne/block_A_20.las", "sim_rotterdam/block_A_footprints.geojson", []),
    ("block_A_8", "airborne/block_A_8.las", "sim_rotterdam/block_A_footprints.geojson", []),
    ("block_A_3", "airborne/block_A_3.las", "sim_rotterdam/block_A_footprints.geojson", []),
    ("block_A_perfect", "airborne/block_A_perfect.ply", "sim_rotterdam/block_A_footprints.geojson", []),
    ("delft", "delft/delft_west_mesh.ply", "delft/delft_west_footprints.geojson", DELFT_OFFSET),
    ("delft_points", "points/delft_west.laz", "delft/delft_west_footprints.geojson", []),
    ("hall", "mvs_buildings/cgal_building.off", "mvs_buildings/cgal_footprints.geojson", []),
    ("b9", "mvs_buildings/b9_mesh.off", "mvs_buildings/b9_footprints.geojson", []),
    ("zhongshan_L19", "zhongshan/zhongshan_A_L19.ply", "zhongshan/zhongshan_A_footprints.geojson", []),
    ("zhongshan_L18", "zhongshan/zhongshan_A_L18.ply", "zhongshan/zhongshan_A_footprints.geojson", []),
    ("campus", "campus/campus_2tiles.ply", None, []),
    ("steep_houses", "faults/seven_steep_houses.ply.gz", "faults/seven_steep_houses.geojson", []),
]
# Building: why it costs more than others of its size, from the columns beside it and what is known of its scan.
FEW = "3 points/m²: few samples, while making a roof costs the same"
CLUTTER = "a flat roof full of structures, each cut out by a search of its own (decision 132)"
WHY = {
    "block_A_3 `{57A29B73-F312-4C17-B33C-A91C5AC1E468}`": FEW + "; the outline has bays and piers",
    "block_A_3 `{75880515-DA3B-49F3-868A-97DD1193EF71}`": FEW + "; many parts",
    "block_A_3 `{7E3CC435-E15C-4C8A-996A-8E746CB54424}`": FEW,
    "block_A_3 `{E5248470-7A74-438C-88FE-D596BB3987DD}`": FEW + "; many parts on 67 m²",
    "block_A_3 `{23D1C43E-FAD1-4BF9-86A9-74178BD0697E}`": FEW + "; many parts",
    "block_A_3 `{EA541FCF-CC5D-4317-A6DA-D4BD6496A9A2}`": FEW + "; a hip that is parallel to no wall",
    "block_A_perfect `{EA541FCF-CC5D-4317-A6DA-D4BD6496A9A2}`": "an exact scan: differences of centimetres are significant, and worth a search",
    "block_A_8 `{EA541FCF-CC5D-4317-A6DA-D4BD6496A9A2}`": "a hip that is parallel to no wall",
    "delft `b31bd3852-00ba-11e6-b420-2bdcc4ab5d7f`": "few samples on 41 m², while making a roof costs the same",
    "b9 `main`": CLUTTER,
    "zhongshan_L19 `B2`": CLUTTER,
    "zhongshan_L19 `B3`": CLUTTER + "; its parts are united",
    "campus `derived-1`": "an outline derived from the scan, with many parts",
    "delft `b31bc9c58-00ba-11e6-b420-2bdcc4ab5d7f`": "a steep foot over an outline with piers of centimetres",
    "delft_points `b31bbd91c-00ba-11e6-b420-2bdcc4ab5d7f`": "many parts on 54 m²: pieces are searched, joined and searched once more",
    "delft_points `b31bc2699-00ba-11e6-b420-2bdcc4ab5d7f`": "six parts on 50 m²: pieces are searched, joined and searched once more",
    "delft_points `b31bcc27a-00ba-11e6-b420-2bdcc4ab5d7f`": "six parts on 52 m²: pieces are searched, joined and searched once more",
    "delft_points `b31bbff63-00ba-11e6-b420-2bdcc4ab5d7f`": "roofs of four heights on 53 m²",
    "zhongshan_L19 `B1`": CLUTTER,
    "delft_points `b31bbff68-00ba-11e6-b420-2bdcc4ab5d7f`": "many corners on 51 m²",
    "delft_points `b31bc2680-00ba-11e6-b420-2bdcc4ab5d7f`": "many corners on 59 m²",
}


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def run(program, *command):
    done = subprocess.run([program, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode > 1:
        sys.exit(f"mansard {' '.join(map(str, command))} ended with exit code {done.returncode}:\n{done.stderr}")


def reconstruct(program, out, scan, footprints, more):
    if not (out / "run.json").exists():
        inputs = [scan, footprints] if footprints else [scan, "--derive-footprints"]
        run(program, "reconstruct", "-q", *inputs, "-o", out, "--formats", "geojson", "--no-resume", "--overwrite", *more)


def areas_of(path):
    """Area of each footprint, m², by its id as the run has it."""
    out = {}
    for feature in read(path)["features"]:
        if feature["geometry"]:
            out[str(feature["properties"]["id"])] = shape(feature["geometry"]).area
    return out


def buildings_of(name, folder):
    """Every building of a run that was searched. A block's time of `refine` belongs to its buildings by their work, all
    other by their samples."""
    report = read(folder / "run.json")
    blocks = {block["name"]: block for block in report["blocks"]}
    of_block = {}
    for building in report["buildings"]:
        if "search" in building:
            of_block.setdefault(building["block"], []).append(building)
    for block, members in of_block.items():
        times = blocks[block]["times"]
        refining = times["stages"].get("refine", {"cpu_seconds": 0})["cpu_seconds"]
        work = sum(b["search"]["work"] for b in members)
        samples = sum(b["search"]["samples"] for b in members)
        for b in members:
            search = b["search"]
            own_refine = refining * search["work"] / max(work, 1)
            other = (times["cpu_seconds"] - refining) * search["samples"] / max(samples, 1)
            ground = b.get("areas_m2", {}).get("ground", 0)
            if ground > 0 and search["samples"] > 0:
                yield {"name": f'{name} `{b["id"]}`', "cpu": own_refine + other, "refine": own_refine, "area": ground,
                       "samples": search["samples"], "corners": search["corners"], "parts": b["parts"],
                       "work": search["work"], "bound": search["bound"], "variables": blocks[block]["variables"],
                       "nodes": blocks[block]["objective"]["nodes"],
                       "stages": {k: v["cpu_seconds"] for k, v in times["stages"].items()}}


def exponent(rows, size):
    """Least squares of log cost over log size: cost grows with size to this power; and R²."""
    x = numpy.log([row[size] for row in rows])
    y = numpy.log([max(row["cpu"], 1e-3) for row in rows])
    slope, intercept = numpy.polyfit(x, y, 1)
    return slope, intercept, 1 - numpy.var(y - slope * x - intercept) / numpy.var(y)


def classes(rows, size, edges):
    for low, high in zip(edges, edges[1:]):
        some = [row for row in rows if low <= row[size] < high]
        if some:
            cpu = numpy.array([row["cpu"] for row in some])
            each = numpy.array([1e6 * row["cpu"] / row["samples"] for row in some])
            share = numpy.array([row["work"] / row["bound"] for row in some if row["bound"] > 0])
            yield (f"{low:g} to {high:g}" if numpy.isfinite(high) else f"{low:g} and more", len(some), numpy.median(cpu),
                   numpy.percentile(cpu, 95), cpu.max(), numpy.median(each), each.max(), share.max() if len(share) else 0)


def main():
    program, data, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    page = pathlib.Path(sys.argv[4]) if len(sys.argv) > 4 else pathlib.Path(__file__).parent.parent / "docs" / "cost.md"
    shared, simulated = [], []
    for name, scan, footprints, more in SHARED:
        reconstruct(program, out / name, data / scan, data / footprints if footprints else None, more)
        shared += buildings_of(name, out / name)
    blocks = 0
    while len(simulated) < SIMULATED:
        scan, preset, points, more = SCANS[blocks // len(KINDS) % len(SCANS)]
        kind, seed = KINDS[blocks % len(KINDS)], 21 + 2 * (blocks // len(KINDS))
        blocks += 1
        name = f"{kind}_{seed}_{scan.replace(' ', '_')}"
        made = out / "scans" / name
        if not (made / "truth.json").exists():
            run(program, "simulate", "-q", "--block", kind, "--preset", preset, "--seed", seed, "--points", points, "-o", made,
                "--overwrite", *more)
        reconstruct(program, out / name, made / "points.las" if points else made / "mesh.ply", made / "footprints.geojson", [])
        simulated += buildings_of(name, out / name)
    write(page, shared, simulated, blocks)


def write(page, shared, simulated, blocks):
    rows = shared + simulated
    slope, intercept, _ = exponent(rows, "samples")
    for row in rows:
        row["times"] = row["cpu"] / numpy.exp(intercept + slope * numpy.log(row["samples"]))
    lines = [f"""# What a building costs

`tools/cost.py MANSARD DATA OUT` reconstructs all shared inputs ({len(shared)} buildings) and {blocks} simulated blocks ({len(simulated)} buildings), and writes this page.
Cost is processor time, of all stages but reading and writing files. What is measured for a block belongs to its buildings: `refine` by the
work of each, all else by samples. Samples are the points at which roofs are compared with the scan: a grid of 0.25 m, coarser over parts of more than 9,000 m².
Work is counted, so that it is the same on every machine; its bound is that of [decision 132](decisions/0132-bounded-work.md).

## Cost against size

Cost grows with size to the power of:

| | all | shared | simulated | R² of all |
|---|---|---|---|---|"""]
    for size, words in [("area", "plan area"), ("samples", "samples"), ("corners", "corners of its parts")]:
        each = [exponent(some, size) for some in (rows, shared, simulated)]
        lines.append(f"| {words} | " + " | ".join(f"{e[0]:.2f}" for e in each) + f" | {each[0][2]:.2f} |")
    head = "| buildings | median, CPU s | 95 %, CPU s | most, CPU s | median, µs a sample | most, µs a sample | most of the bound |"
    inf = numpy.inf
    for title, size, edges in [("Plan area, m²", "area", [0, 25, 50, 100, 200, 400, 1000, 3000, inf]),
                               ("Samples", "samples", [1, 100, 200, 400, 800, 1600, 5000, 15000, inf]),
                               ("Corners", "corners", [3, 5, 9, 17, 33, 65, 129, inf])]:
        lines += ["", f"| {title} {head}", "|---" * 8 + "|"]
        for label, count, median, most95, most, each, each_most, share in classes(rows, size, edges):
            lines.append(f"| {label} | {count} | {median:.2f} | {most95:.2f} | {most:.2f} | {each:.0f} | {each_most:.0f} | {share:.0%} |")
    worst = sorted(rows, key=lambda row: -row["times"])[:10]
    lines += ["", "## The ten that cost most for their size", "",
              "Against the cost that the fit over samples gives for their size.", "",
              "| building | CPU s | times the fit | plan area, m² | samples | corners | parts | work of its bound | first stages | why |",
              "|---|---|---|---|---|---|---|---|---|---|"]
    for row in worst:
        stages = sorted(row["stages"].items(), key=lambda s: -s[1])[:2]
        total = sum(row["stages"].values())
        shown = ", ".join(f"{name} {100 * cpu / total:.0f} %" for name, cpu in stages)
        lines.append(f'| {row["name"]} | {row["cpu"]:.2f} | {row["times"]:.1f} | {row["area"]:.0f} | {row["samples"]} | {row["corners"]} | '
                     f'{row["parts"]} | {row["work"] / max(row["bound"], 1):.0%} | {shown} | {WHY.get(row["name"], "–")} |')
    dearest = sorted(rows, key=lambda row: -row["cpu"])[:5]
    lines += ["", "Those that cost most in all: " + "; ".join(f'{r["name"]} {r["cpu"]:.1f} s ({r["samples"]} samples)' for r in dearest) + "."]
    met = [row for row in rows if row["bound"] and row["work"] > row["bound"]]
    lines += [f"{len(met)} of {len(rows)} buildings took more work than their bound."]
    page.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
