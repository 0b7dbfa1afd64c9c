#!/usr/bin/env python3
"""Processor seconds and memory of whole cities, their growth, and a plot: docs/city.md, "Measured".

    city_bench.py MANSARD FOOTPRINTS.geojson OUT [--sizes 1000,3000,10000] [--mesh MESH.ply] [--plot PLOT.svg] [-- OPTIONS…]

The city is the footprints, moved over a grid until there are as many as a size says. Without --mesh they are extruded
(`mansard extrude`, to CityJSONSeq). With --mesh, a scan of just these footprints as `mansard simulate` writes it, the
mesh is copied with them (tools/copied_city.py), and the city is reconstructed. OPTIONS go to mansard. Seconds are user
and system time of the process, which load beside it hardly changes; memory is the peak resident size.
"""
import argparse
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

COPIES = pathlib.Path(__file__).resolve().parents[2] / "tools" / "copied_city.py"


def moved(coordinates, by):
    if isinstance(coordinates[0], (int, float)):
        return [coordinates[0] + by[0], coordinates[1] + by[1]]
    return [moved(inner, by) for inner in coordinates]


def corners(coordinates):
    if isinstance(coordinates[0], (int, float)):
        yield coordinates
    else:
        for inner in coordinates:
            yield from corners(inner)


def write_footprints(source, count, path):
    """Copies of all features on a grid that is 20 m wider than they are; one line at a time."""
    city = json.loads(pathlib.Path(source).read_text())
    features = [f for f in city["features"] if f["geometry"]]
    points = [p for f in features for p in corners(f["geometry"]["coordinates"])]
    width, height = (math.ceil(max(p[i] for p in points) - min(p[i] for p in points)) + 20 for i in (0, 1))
    columns = max(1, round(math.sqrt(count / len(features))))
    head = {key: value for key, value in city.items() if key not in ("features", "name")}
    with open(path, "w") as out:
        out.write(json.dumps(head)[:-1] + ', "features": [\n')
        for i in range(count):
            copy, feature = divmod(i, len(features))
            by = (copy % columns * width, copy // columns * height)
            given = features[feature]
            properties = dict(given["properties"] or {}, id=f"b{i + 1}")
            properties.setdefault("building:levels", 2 + i % 4)
            out.write((",\n" if i else "") + json.dumps({
                "type": "Feature", "properties": properties,
                "geometry": {"type": given["geometry"]["type"], "coordinates": moved(given["geometry"]["coordinates"], by)}}))
        out.write("\n]}\n")


def measured(command):
    """Processor seconds and the peak of resident memory in MB; ends where the command fails."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1):  # 1: some buildings are simpler than asked for
        sys.exit(f"exit code {process.returncode}: {' '.join(map(str, command))}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def exponent(points):
    """The slope of log y over log x by least squares."""
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / sum((a - x) ** 2 for a in xs)


def svg(rows, title):
    """Seconds and memory over the number of buildings, both axes logarithmic."""
    width, height, left, top = 420, 260, 60, 40
    panels = [("processor s", 1, "#1f6fb4"), ("memory, MB", 2, "#d1711b")]
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * width}" height="{height + 90}" '
           f'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>'
           f'<text x="{left}" y="20" font-size="14">{title}</text>']
    x0, x1 = math.floor(math.log10(rows[0][0])), math.ceil(math.log10(rows[-1][0]))
    for panel, (name, column, colour) in enumerate(panels):
        shift = panel * width + left
        values = [row[column] for row in rows]
        y0, y1 = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
        across = lambda n: shift + (math.log10(n) - x0) / max(1, x1 - x0) * (width - left - 30)
        up = lambda v: top + height - (math.log10(v) - y0) / max(1, y1 - y0) * height
        for e in range(y0, y1 + 1):
            out.append(f'<path d="M{shift} {up(10 ** e):.1f}h{width - left - 30}" stroke="#ddd"/>'
                       f'<text x="{shift - 8}" y="{up(10 ** e) + 4:.1f}" text-anchor="end">{10 ** e:g}</text>')
        for e in range(x0, x1 + 1):
            out.append(f'<path d="M{across(10 ** e):.1f} {top}v{height}" stroke="#ddd"/>'
                       f'<text x="{across(10 ** e):.1f}" y="{top + height + 18}" text-anchor="middle">{10 ** e:,}</text>')
        line = " ".join(f"{across(row[0]):.1f},{up(row[column]):.1f}" for row in rows)
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{across(row[0]):.1f}" cy="{up(row[column]):.1f}" r="3.5" fill="{colour}"/>' for row in rows]
        out.append(f'<text x="{shift}" y="{top + height + 40}">{name} over buildings</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mansard")
    parser.add_argument("footprints")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--sizes", default="1000,3000,10000")
    parser.add_argument("--mesh")
    parser.add_argument("--plot")
    own = sys.argv[1:]
    extra = own[own.index("--") + 1:] if "--" in own else []
    request = parser.parse_args(own[:own.index("--")] if "--" in own else own)
    request.out.mkdir(parents=True, exist_ok=True)
    rows = []
    print("| buildings | processor s | ms a building | memory, MB |\n|---|---|---|---|")
    for size in sorted(int(word) for word in request.sizes.split(",")):
        if request.mesh:
            city, made = request.out / f"city{size}", request.out / f"made{size}"
            block = len(json.loads(pathlib.Path(request.footprints).read_text())["features"])
            side = max(1, round(math.sqrt(size / block)))
            size = side * side * block
            subprocess.run([sys.executable, COPIES, city, request.mesh, request.footprints, str(side)], check=True,
                           stdout=subprocess.DEVNULL)
            command = [request.mansard, "reconstruct", city / "mesh", city / "footprints.geojson", "-o", made]
        else:
            city, made = request.out / f"city{size}.geojson", request.out / f"made{size}.city.jsonl"
            write_footprints(request.footprints, size, city)
            command = [request.mansard, "extrude", city, "-o", made]
        seconds, memory = measured([*command, "--overwrite", "-q", *extra])
        rows.append((size, seconds, memory))
        print(f"| {size:,} | {seconds:.1f} | {1000 * seconds / size:.2f} | {memory:.0f} |", flush=True)
        for path in (city, made):
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    if len(rows) > 1:
        more = 1024 * (rows[-1][2] - rows[-2][2]) / (rows[-1][0] - rows[-2][0])
        print(f"\nprocessor seconds grow as n^{exponent([(n, s) for n, s, _ in rows]):.2f}, memory as "
              f"n^{exponent([(n, m) for n, _, m in rows]):.2f}; {more:.2f} kB a building between the last two")
    if request.plot and len(rows) > 1:
        verb = "reconstruct" if request.mesh else "extrude"
        pathlib.Path(request.plot).write_text(svg(rows, f"mansard {verb}"))


if __name__ == "__main__":
    main()
