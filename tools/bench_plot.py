#!/usr/bin/env python3
"""Tables of docs/bench.md from the JSON of bench_extrude, and its plot.   bench_plot.py RESULTS.json [PLOT.svg]"""
import json
import math
import sys

SHAPES = [("star", "stars: generic"), ("generic", "grid outlines, corners moved: generic"),
          ("tied", "grid outlines: tied"), ("tied_turned", "grid outlines turned by 0.3 rad: tied")]
SIZES = [16, 64, 256, 1000, 5000]
SERIES = [("cgal", "CGAL 5.5.1, unweighted skeleton", "#777777", ""),
          ("hip_sweep", "sweep alone, one slope", "#1f6fb4", "6 4"),
          ("hip", "raise, one slope", "#1f6fb4", ""),
          ("mixed", "raise, four profiles mixed", "#d1711b", "")]


def read(path):
    """Milliseconds of a polygon, corners and counters by name: the best of the repetitions."""
    best = {}
    for run in json.load(open(path))["benchmarks"]:
        if run.get("run_type") == "aggregate" or run.get("error_occurred"):
            continue
        name = run["run_name"].replace("/real_time", "")
        scale = {"ns": 1e-6, "us": 1e-3, "ms": 1, "s": 1e3}[run["time_unit"]]
        time = run["real_time" if "real_time" in run["run_name"] else "cpu_time"] * scale / run["polygons"]
        if name not in best or time < best[name]["ms"]:
            best[name] = dict(run, ms=time)
    return best


def exponent(points):
    """The slope of log t over log n by least squares."""
    xs, ys = [math.log(n) for n, _ in points], [math.log(t) for _, t in points]
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / sum((a - x) ** 2 for a in xs)


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def short(ms):
    return f"{ms:,.0f}" if ms >= 100 else f"{ms:.3g}"


def tables(best):
    ms = lambda name: best[name]["ms"] if name in best else None
    cell = lambda value, form=short: "–" if value is None else form(value)
    ratio = lambda a, b: None if a is None or b is None else a / b
    two = lambda value: f"{value:.2f}"

    rows = []
    for shape, _ in SHAPES:
        for n in SIZES:
            at = f"/{shape}/{n}"
            if not any(s + at in best for s, *_ in SERIES):
                continue
            cgal, hip = ms("cgal" + at), ms("hip" + at)
            refused = best.get("cgal" + at, {}).get("refused", 0)
            rows.append([shape, str(n), cell(cgal) + (f" ({refused:.0f} refused)" if refused else ""),
                         cell(ms("hip_sweep" + at)), cell(hip), cell(ms("hip_check" + at)), cell(ms("mixed" + at)),
                         cell(ratio(ms("hip_sweep" + at), cgal), two), cell(ratio(hip, cgal), two),
                         cell(ratio(ms("mixed" + at), cgal), two)])
    table(["polygon", "corners", "CGAL ms", "sweep ms", "raise ms", "of it check ms", "raise mixed ms", "sweep / CGAL",
           "raise / CGAL", "mixed / CGAL"], rows)

    rows = []
    for series in ("cgal", "hip_sweep", "hip", "mixed_sweep", "mixed"):
        row = [series]
        for shape, _ in SHAPES:
            points = [(best[k]["corners"], best[k]["ms"]) for n in SIZES if (k := f"{series}/{shape}/{n}") in best]
            large = [p for p in points if p[0] >= 200]
            row.append("–" if len(points) < 3 else
                       f"{exponent(points):.2f}" + (f" ({exponent(large):.2f})" if len(large) > 1 else ""))
        rows.append(row)
    table(["time ~ n^x, all sizes (256 on)"] + [s for s, _ in SHAPES], rows)

    rows = []
    for series in ("cgal", "hip_sweep", "hip", "mixed_sweep", "mixed"):
        for shape in ("tied", "tied_turned"):
            rows.append([series, shape] + [cell(ratio(ms(f"{series}/{shape}/{n}"), ms(f"{series}/generic/{n}")), two)
                                           for n in SIZES])
    table(["tied over generic", ""] + [str(n) for n in SIZES], rows)

    rows = [[name, f'{best[name]["corners"]:.1f}', f'{best[name]["ms"]:.3f}', f'{1000 / best[name]["ms"]:,.0f}']
            for name in ("house_sweep", "house_check", "house", "house_mixed", "house_cgal", "footprints",
                         "footprints_all_cores") if name in best]
    table(["small ones", "corners", "ms each", "a second"], rows)

    rows = [[name, f'{run["decisions"] / run["polygons"]:,.0f}', f'{run["moments"] / run["polygons"]:,.0f}',
             f'{100 * run["fixed"]:.2f} %', f'{100 * run["unbounded"]:.3f} %']
            for name, run in best.items() if "decisions" in run]
    if rows:
        table(["sweep", "decisions a polygon", "moments", "by 512-bit integers", "by GMP"], sorted(rows))
    short_of_full = [f'{n}: {r["full"]:.0f} of {r["polygons"]:.0f}' for n, r in best.items()
                     if r.get("full", r["polygons"]) < r["polygons"]]
    print("not full: " + ("; ".join(short_of_full) or "none"))


def plot(best, path):
    wide, high, left, top, gap_x, gap_y = 400, 270, 64, 86, 70, 64
    x0, x1, y0, y1 = 10, 8000, 0.05, 60000
    fx = lambda n: wide * math.log(n / x0) / math.log(x1 / x0)
    fy = lambda t: high * (1 - math.log(t / y0) / math.log(y1 / y0))
    total_x, total_y = left + 2 * wide + gap_x + 24, top + 2 * high + gap_y + 52
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total_x} {total_y}" font-family="sans-serif" '
           f'font-size="12" fill="#222">', f'<rect width="{total_x}" height="{total_y}" fill="white"/>',
           f'<text x="{left}" y="24" font-size="15" font-weight="bold">CPU time of one polygon by its number of corners'
           '</text>']
    for i, (_, label, colour, dash) in enumerate(SERIES):
        x, y = left + (0, 262, 476, 640)[i % 4], 48
        out.append(f'<path d="M{x} {y - 4}h26" stroke="{colour}" stroke-width="2.5" stroke-dasharray="{dash}"/>'
                   f'<text x="{x + 32}" y="{y}">{label}</text>')
    for index, (shape, title) in enumerate(SHAPES):
        ox, oy = left + (index % 2) * (wide + gap_x), top + (index // 2) * (high + gap_y)
        out.append(f'<g transform="translate({ox} {oy})"><text x="0" y="-8" font-weight="bold">{title}</text>')
        for power in range(-1, 5):
            y = fy(10.0 ** power)
            label = {-1: "0.1 ms", 0: "1 ms", 1: "10 ms", 2: "0.1 s", 3: "1 s", 4: "10 s"}[power]
            out.append(f'<path d="M0 {y:.1f}h{wide}" stroke="#e2e2e2"/>'
                       f'<text x="-6" y="{y + 4:.1f}" text-anchor="end">{label}</text>')
        for n in SIZES:
            out.append(f'<path d="M{fx(n):.1f} 0v{high}" stroke="#e2e2e2"/>'
                       f'<text x="{fx(n):.1f}" y="{high + 16}" text-anchor="middle">{n:,}</text>')
        out.append(f'<rect width="{wide}" height="{high}" fill="none" stroke="#999"/>')
        for name, _, colour, dash in SERIES:
            points = [(fx(best[k]["corners"]), fy(best[k]["ms"])) for n in SIZES
                      if (k := f"{name}/{shape}/{n}") in best]
            if not points:
                continue
            line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
            out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2" '
                       f'stroke-dasharray="{dash}"/>')
            out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
        out.append("</g>")
    out.append("</svg>")
    open(path, "w").write("\n".join(out) + "\n")


results = read(sys.argv[1])
tables(results)
if len(sys.argv) > 2:
    plot(results, sys.argv[2])
