#!/usr/bin/env python3
"""Runs mansard on inputs that are damaged or made to do harm, and writes what came of each: tools/hostile.py MANSARD [PAGE]

Every case is a few files, made here, and a command. A case passes if the program ends within its time with a listed exit
code and, where it is not 0, with one line that starts with "mansard: error[code]". That no file
outside the folder of the case is opened is tested elsewhere (tests/ingest/references_test.cpp). PAGE is docs/hostile.md by
default; "-" prints a summary only.
"""
import json
import os
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import zipfile
import zlib

CPU_SECONDS, WALL_SECONDS = 60, 300
MEMORY = 6 << 30  # bytes of address space

HOUSE = """v -20 -20 0\nv 40 -20 0\nv 40 40 0\nv -20 40 0
v 0 0 0\nv 12 0 0\nv 12 8 0\nv 0 8 0\nv 0 0 5\nv 12 0 5\nv 12 8 5\nv 0 8 5\nv 0 4 8\nv 12 4 8
f 1 2 3 4\nf 5 6 10 9\nf 6 7 11 14 10\nf 7 8 12 11\nf 8 5 9 13 12\nf 9 10 14 13\nf 11 12 13 14\n"""
RING = [[0, 0], [12, 0], [12, 8], [0, 8], [0, 0]]


def footprint(properties=None, ring=None, crs="urn:ogc:def:crs:EPSG::28992", more=()):
    feature = {"type": "Feature", "properties": properties or {"id": "a"},
               "geometry": {"type": "Polygon", "coordinates": [ring or RING]}}
    out = {"type": "FeatureCollection", "features": [feature, *more]}
    if crs:
        out["crs"] = {"type": "name", "properties": {"name": crs}}
    return json.dumps(out)


def las():
    points = [(x * 500, y * 500, 6000 if 0 <= x <= 24 and 0 <= y <= 16 else 0)
              for x in range(-20, 60) for y in range(-20, 60)]
    head = b"LASF" + bytes(20) + bytes([1, 2]) + bytes(64) + struct.pack("<HHHII", 1, 2026, 227, 227, 0)
    head += struct.pack("<BHI5I", 0, 20, len(points), len(points), 0, 0, 0, 0) + struct.pack("<6d", *[0.001] * 3, 0, 0, 0)
    head += struct.pack("<6d", 30, -10, 30, -10, 6, 0)
    return head + b"".join(struct.pack("<iiiHBBbBH", *p, 0, 9, 6 if p[2] else 2, 0, 0, 0) for p in points)


def glb(document, binary=b""):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def gltf(buffer=None, image=None, length=36):
    out = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
           "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
           "bufferViews": [{"buffer": 0, "byteLength": length}], "buffers": [{"byteLength": length}]}
    if buffer is not None:
        out["buffers"][0]["uri"] = buffer
    if image is not None:
        out["images"], out["textures"] = [{"uri": image}], [{"source": 0}]
        out["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
        out["meshes"][0]["primitives"][0]["material"] = 0
    return out


TRIANGLE = struct.pack("<9f", 0, 0, 0, 9, 0, 0, 0, 9, 0)
BOX = {"box": [0, 0, 0, 99, 0, 0, 0, 99, 0, 0, 0, 99]}


def tileset(root):
    return json.dumps({"asset": {"version": "1.1"}, "geometricError": 9,
                       "root": {"boundingVolume": BOX, "geometricError": 1, **root}})


def ply(head="", body="0 0 0\n12 0 0\n12 8 5\n3 0 1 2\n", vertices=3, faces=1):
    return (f"ply\nformat ascii 1.0\n{head}element vertex {vertices}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n{body}")


VRT = ('<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0,1,0,2,0,-1</GeoTransform>'
       '<VRTRasterBand dataType="Float32" band="1"{}>{}</VRTRasterBand></VRTDataset>')
GML = ('<gml:FeatureCollection xmlns:gml="http://www.opengis.net/gml" xmlns:t="http://t" '
       'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"{}>{}<gml:featureMember><t:a><t:g><gml:Polygon>'
       '<gml:exterior><gml:LinearRing><gml:posList>0 0 12 0 12 8 0 8 0 0</gml:posList></gml:LinearRing>'
       '</gml:exterior></gml:Polygon></t:g></t:a></gml:featureMember></gml:FeatureCollection>')

REFERENCES = {  # kind: (file, text, whether it is a mesh)
    "OBJ, mtllib": ("a.obj", lambda r: "mtllib " + r + "\n" + HOUSE, True),
    "PLY, TextureFile": ("a.ply", lambda r: ply(f"comment TextureFile {r}\n"), True),
    "glTF, buffer": ("a.gltf", lambda r: json.dumps(gltf(buffer=r)), True),
    "glTF, image": ("a.gltf", lambda r: json.dumps(gltf("data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAA", r)), True),
    "3D Tiles, content": ("tileset.json", lambda r: tileset({"content": {"uri": r}}), True),
    "3D Tiles, tileset": ("tileset.json", lambda r: tileset({"content": {"uri": r + ".json"}}), True),
    "VRT, source": ("a.vrt", lambda r: VRT.format("", f"<SimpleSource><SourceFilename>{r}</SourceFilename></SimpleSource>"), True),
    "VRT, raw band": ("a.vrt", lambda r: VRT.format(' subClass="VRTRawRasterBand"', f"<SourceFilename>{r}</SourceFilename>"), True),
    "OGR VRT, source": ("v.vrt", lambda r: f'<OGRVRTDataSource><OGRVRTLayer name="secret"><SrcDataSource>{r}</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>', False),
    "GML, schema": ("g.gml", lambda r: GML.format(f' xsi:schemaLocation="http://t {r}"', ""), False),
    "GML, entity": ("g.gml", lambda r: f'<!DOCTYPE a [<!ENTITY e SYSTEM "{r}">]>' + GML.format("", "<t:n>&e;</t:n>"), False),
    "KML, network link": ("k.kml", lambda r: f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document><NetworkLink><Link><href>{r}</href></Link></NetworkLink></Document></kml>', False),
    "GeoJSON, crs link": ("f.geojson", lambda r: json.dumps({"type": "FeatureCollection", "features": [], "crs": {"type": "link", "properties": {"href": r}}}), False),
    "GeoJSON, crs name": ("f.geojson", lambda r: footprint(crs=r), False),
}
SPELLINGS = ["../outside/secret", "{outside}/secret", "x/../../outside/secret", "%2e%2e/outside/secret",
             "file://{outside}/secret", "link/secret", "..\\outside\\secret", "/vsicurl/http://127.0.0.1:9/secret",
             "http://127.0.0.1:9/secret", "\\\\127.0.0.1\\share\\secret", "PG:host=127.0.0.1 port=9", "/vsistdin/",
             "/dev/zero", "MEM:::DATAPOINTER=4096,PIXELS=2,LINES=2,DATATYPE=Float32"]


PIPES = {  # what a program that has it open has written; none: no program has it open
    "a pipe that nobody writes to": None,
    "a pipe whose writer writes nothing": b"",
    "a pipe whose writer has written a house": HOUSE.encode(),
}


class Cases:
    def __init__(self):
        self.all = []

    def add(self, group, name, files, inputs, more=()):
        self.all.append((group, name, files, inputs, list(more)))

    def mesh(self, group, name, file, data, more=()):
        self.add(group, name, {file: data, "f.geojson": footprint()}, [file, "f.geojson"], more)

    def prints(self, group, name, file, data, more=()):
        self.add(group, name, {file: data, "m.obj": HOUSE}, ["m.obj", file], more)


def good_files():
    return {"m.obj": HOUSE.encode(), "m.ply": ply().encode(), "m.glb": glb(gltf(), TRIANGLE), "m.las": las(),
            "m.off": b"OFF\n3 1 0\n0 0 0\n12 0 0\n12 8 5\n3 0 1 2\n",
            "m.asc": b"ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 4\n" + b"1 2 3 4\n" * 4,
            "m.stl": b"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 12 0 0\nvertex 12 8 5\nendloop\n"
                     b"endfacet\nendsolid s\n"}


def cases():
    c = Cases()
    for kind, (file, text, is_mesh) in REFERENCES.items():
        for spelling in SPELLINGS:
            # What is wrong with a triangle as a scan is not to hide what is done with its reference.
            (c.mesh if is_mesh else c.prints)("References", f"{kind}: `{spelling.replace('{outside}', '/…/outside')}`", file,
                                              lambda outside, t=text, s=spelling: t(s.replace("{outside}", outside)),
                                              ["--pipeline-scan-checks", "warn"])
    chance = random.Random(1)
    for name, data in good_files().items():
        for share in (0, 0.1, 0.5, 0.95):
            c.mesh("Truncated", f"{name} after {share:.0%}", name, data[:int(len(data) * share)])
        for seed in range(3):
            noisy = bytearray(data)
            for _ in range(max(4, len(noisy) // 100)):
                noisy[chance.randrange(len(noisy))] = chance.randrange(256)
            c.mesh("Changed bytes", f"{name}, random {seed + 1}", name, bytes(noisy))
    text = footprint().encode()
    for share in (0, 0.1, 0.5, 0.95):
        c.prints("Truncated", f"f.geojson after {share:.0%}", "f.geojson", text[:int(len(text) * share)])
    for label, value in {"a number": 7, "null": None, "an object": {"a": 1}, "a list": [1], "empty": "", "a blank": " ",
                         "300 characters": "x" * 300, "a slash": "a/b", "dots": "..", "a quotation mark": 'a"b',
                         "a line break": "a\nb", "NUL": "a\0b", "an escape code": "\x1b[31m", "markup": "<b>&amp;",
                         "a formula": "=1+1", "right to left": "\u202eabc", "a surrogate": "\ud800", "emoji": "🏠",
                         "a tilde": "a~2"}.items():
        c.prints("Ids", label, "f.geojson", footprint({"id": value}), ["--formats", "cityjson,geopackage,obj,citygml"])
    second = json.loads(footprint({"id": "12-1"}, [[12, 0], [20, 0], [20, 8], [12, 8], [12, 0]]))["features"]
    c.prints("Ids", "`12` beside `12-1`", "f.geojson", footprint({"id": "12"}, more=second))
    c.prints("Ids", "2,500 attributes", "f.geojson", footprint({"id": "a", **{f"n{i}": i for i in range(2500)}}),
             ["--formats", "cityjson,geopackage,flatgeobuf"])
    for name in ["Amersfoort / RD New", "nonsense", "EPSG:99999", "EPSG:0", "EPSG:-1", "EPSG:4326", "EPSG:2263", "", "local",
                 "+proj=utm +zone=31 +nadgrids=https://127.0.0.1:9/x", "+init=/etc/passwd:x", "http://127.0.0.1:9/crs",
                 "/etc/passwd", "PROJCS[", "x" * 100000]:
        label = name if len(name) < 60 else f"{len(name):,} characters"
        c.prints("CRS names", f"`{label}` in a GeoJSON", "f.geojson", footprint(crs=name or " "))
        c.mesh("CRS names", f"`{label}` as --crs", "m.obj", HOUSE, ["--crs", name])
    for codec in ["utf-16", "utf-32", "latin-1", "cp037"]:
        c.prints("Encodings", f"GeoJSON in {codec}", "f.geojson", footprint({"id": "Straße"}).replace("\\u00df", "ß").encode(codec))
        c.mesh("Encodings", f"OBJ in {codec}", "m.obj", HOUSE.encode(codec))
    big = zlib.compressobj(9, zlib.DEFLATED, 31)
    zeros = b"".join([big.compress(bytes(1 << 20)) for _ in range(2048)] + [big.flush()])
    c.mesh("Sizes", "2 GB of zeros in an .obj.gz of 2 MB", "m.obj.gz", zeros)
    c.mesh("Sizes", "PLY that promises 4 thousand million vertices", "m.ply", ply(vertices=4_000_000_000))
    c.mesh("Sizes", "OFF that promises as many", "m.off", b"OFF\n4000000000 1 0\n0 0 0\n")
    c.mesh("Sizes", "glTF buffer of 1 TB", "m.gltf", json.dumps(gltf("data:;base64,AAAA", length=1 << 40)))
    c.mesh("Sizes", "grid of 10⁹ by 10⁹ cells", "m.asc", b"ncols 1000000000\nnrows 1000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n")
    c.mesh("Sizes", "JSON nested a million deep", "m.gltf", "[" * 1_000_000)
    c.prints("Sizes", "GeoJSON nested a million deep", "f.geojson", '{"type":' + "[" * 1_000_000)
    c.mesh("Sizes", "face of 100,000 corners", "m.obj", HOUSE + "f" + " 1 2 3" * 33333 + "\n")
    c.mesh("Sizes", "coordinates of 10³⁰⁰", "m.obj", HOUSE.replace("12", "1e300"))
    c.mesh("Sizes", "coordinates that are NaN", "m.obj", HOUSE.replace("12", "nan"))
    c.mesh("Sizes", "a line of 20 MB", "m.obj", "#" * 20_000_000 + "\n" + HOUSE)
    c.prints("Sizes", "a ring of 100,000 points", "f.geojson", footprint(ring=[[i % 7 * .1, i * 8e-5] for i in range(100_000)] + [[0, 0]]))
    c.mesh("Sizes", "tileset of a million empty tiles", "tileset.json",
           tileset({"children": [{"boundingVolume": BOX, "geometricError": 0}] * 1_000_000}))
    tree = {"boundingVolume": BOX, "geometricError": 0}
    for level in range(6):
        tree = {"boundingVolume": BOX, "geometricError": level, "children": [tree] * 10}
    c.mesh("Sizes", "tree of a million empty tiles", "tileset.json", tileset({"children": [tree]}))
    c.mesh("Sizes", "tileset in itself", "tileset.json", tileset({"content": {"uri": "tileset.json"}}))
    c.mesh("Sizes", "implicit tiling of 30 levels", "tileset.json", tileset(
        {"content": {"uri": "{level}-{x}-{y}.glb"}, "implicitTiling": {"subdivisionScheme": "QUADTREE", "availableLevels": 30,
                                                                      "subtreeLevels": 3, "subtrees": {"uri": "{level}-{x}-{y}.subtree"}}}))
    c.mesh("Sizes", "archive of 100,000 members", "m.zip", "ZIP")
    for label in [*PIPES, "a folder", "an empty folder", "a link to itself", "a link to nothing",
                  "/dev/zero", "/dev/null", "/dev/stdin", "no such file", "a file without permission to read"]:
        c.mesh("No files", f"{label} as a mesh", "m.obj", label)
        c.prints("No files", f"{label} as footprints", "f.geojson", label)
    return c.all


def make(folder, files, outside):
    """Returns what is to be closed when the case is over."""
    open_pipes = []
    for name, data in files.items():
        path = os.path.join(folder, name)
        if callable(data):
            data = data(outside)
        if data == "ZIP":
            with zipfile.ZipFile(path, "w") as archive:
                for i in range(100_000):
                    archive.writestr(f"{i}.txt", "")
        elif isinstance(data, str) and data in PIPES:
            os.mkfifo(path)
            if PIPES[data] is not None:
                open_pipes.append(os.open(path, os.O_RDWR))
                os.write(open_pipes[-1], PIPES[data])
        elif data == "a folder":
            os.makedirs(os.path.join(path, "x"))
        elif data == "an empty folder":
            os.makedirs(path)
        elif data == "a link to itself":
            os.symlink(path, path)
        elif data == "a link to nothing":
            os.symlink("nothing", path)
        elif isinstance(data, str) and data.startswith("/dev/") and len(data) < 20:
            os.symlink(data, path)
        elif data == "no such file":
            pass
        elif data == "a file without permission to read":
            with open(path, "w") as file:
                file.write(HOUSE)
            os.chmod(path, 0)
        else:
            with open(path, "wb") as file:
                file.write(data.encode(errors="surrogatepass") if isinstance(data, str) else data)
    os.symlink(outside, os.path.join(folder, "link"))
    return open_pipes


def run(program, folder, inputs, more):
    """The exit code or "no end", what it said, and what it used."""

    def limits():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    command = [program, "reconstruct", "-q", *inputs, "-o", "out", *more]
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said,
                                   preexec_fn=limits)
        end = threading.Timer(WALL_SECONDS, process.kill)
        end.start()
        _, status, usage = os.wait4(process.pid, 0)
        end.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        err = said.read().decode(errors="replace")
    ended = process.returncode not in (-signal.SIGKILL, -signal.SIGXCPU)
    return process.returncode if ended else "no end", err, usage


def main():
    program = os.path.abspath(sys.argv[1])
    page = sys.argv[2] if len(sys.argv) > 2 else os.path.join(os.path.dirname(__file__), "..", "docs", "hostile.md")
    rows, failures = [], []
    for group, name, files, inputs, more in cases():
        with tempfile.TemporaryDirectory() as place:
            outside, folder = os.path.join(place, "outside"), os.path.join(place, "in")
            os.makedirs(outside)
            os.makedirs(folder)
            with open(os.path.join(outside, "secret"), "w") as file:
                file.write("secret")
            open_pipes = make(folder, files, outside)
            code, err, usage = run(program, folder, inputs, more)
            for pipe in open_pipes:
                os.close(pipe)
            cpu, memory = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
            errors = re.findall(r"error\[([a-z-]+)\]", err)
            warnings = sorted(set(re.findall(r"warning\[([a-z-]+)\]", err)))
            clear = code in (0, 1) or (code in (2, 3, 4, 5, 6) and len(errors) >= 1)
            # Cases are about inputs. An option that is refused would hide what the input does.
            if code == 2 or (code == 4 and "--crs" not in more):
                clear = False
            if not clear:
                failures.append((group, name, code, err[-300:]))
            words = f"`{errors[0]}`" if errors else "models" if code in (0, 1) else "–"
            if warnings and not errors:
                words += " (" + ", ".join(f"`{w}`" for w in warnings) + ")"
            rows.append((group, name, code, words, cpu, memory))
            shutil.rmtree(folder, ignore_errors=True)
    passed = len(rows) - len(failures)
    print(f"{passed} of {len(rows)} cases end with a result or a clear error")
    for failure in failures:
        print("FAILED", *failure)
    if page != "-":
        write(page, rows, failures)
    return 1 if failures else 0


def write(page, rows, failures):
    with open(page, "w") as out:
        out.write(f"""# Damaged and hostile inputs

`tools/hostile.py MANSARD` makes {len(rows)} inputs that are damaged, unlucky or made to do harm, runs `mansard reconstruct` on each and writes this page.
{len(rows) - len(failures)} end with a result or with one clear error; the longest takes {max(r[4] for r in rows):.1f} s of CPU time, and none uses more than {max(r[5] for r in rows):.0f} MB.
What files may refer to: [ingest](ingest.md#damaged-and-malicious-files).

`exit` is the exit code; the outcome is the code of the error, or `models` with the codes of warnings. CPU time is in seconds, memory the largest resident set in MB.
""")
        group = None
        for kind, name, code, words, cpu, memory in rows:
            if kind != group:
                group = kind
                out.write(f"\n## {kind}\n\n| input | exit | outcome | CPU, s | memory, MB |\n|---|---|---|---|---|\n")
            shown = name.replace("|", "\\|")
            out.write(f"| {shown} | {code} | {words} | {cpu:.1f} | {memory:.0f} |\n")


if __name__ == "__main__":
    sys.exit(main())
