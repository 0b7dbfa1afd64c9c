"""The Python package, over the samples of data/. Run with PYTHONPATH on the built package:

    python3 -m unittest discover tests/python

MANSARD_BINARY is the command line program, whose files the results are compared with, and MANSARD_DATA the samples.
"""

import inspect
import json
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

import mansard

DATA = pathlib.Path(os.environ["MANSARD_DATA"])
PROGRAM = os.environ["MANSARD_BINARY"]
MESH, FOOTPRINTS = str(DATA / "hall" / "mesh.off"), str(DATA / "hall" / "footprints.geojson")


def run(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=300)
    if done.returncode not in (0, 1):
        raise AssertionError(done.stderr)
    return done.stdout


class WithFolder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)


class Reconstruct(WithFolder):
    def test_gives_the_bytes_of_the_command_line_in_every_format(self):
        run("reconstruct", MESH, FOOTPRINTS, "-o", self.folder / "cli", "--formats", "all", "-q")
        city = mansard.reconstruct(MESH, FOOTPRINTS)
        compared = 0
        for path in sorted((self.folder / "cli").iterdir()):
            if not path.name.startswith("model") or path.suffix == ".mtl" or path.name.endswith(".plans.jsonl"):
                continue  # beside the OBJ
            city.write(self.folder / path.name)
            if path.is_dir():
                for file in sorted(path.rglob("*")):
                    if file.is_file():
                        self.assertEqual((self.folder / path.name / file.relative_to(path)).read_bytes(),
                                         file.read_bytes(), file.name)
                        compared += 1
                continue
            self.assertEqual((self.folder / path.name).read_bytes(), path.read_bytes(), path.name)
            compared += 1
        self.assertGreaterEqual(compared, 8)
        for beside in ("model.mtl", "model.plans.jsonl"):
            self.assertEqual((self.folder / beside).read_bytes(), (self.folder / "cli" / beside).read_bytes(), beside)
        report = json.loads((self.folder / "cli" / "run.json").read_text())
        self.assertEqual(city.report["buildings"], report["buildings"])

    def test_takes_the_options_of_the_command_line(self):
        run("reconstruct", MESH, FOOTPRINTS, "-o", self.folder / "cli", "--formats", "cityjson", "-q",
            "--refine-effort", "caps", "--mesh-offset", "1", "2", "3", "--bbox", "-1000", "-1000", "1000", "1000")
        city = mansard.reconstruct(MESH, FOOTPRINTS, refine_effort="caps", mesh_offset=(1, 2, 3),
                                   bbox=numpy.array([-1000, -1000, 1000, 1000]))
        city.write(self.folder / "model.city.json")
        self.assertEqual((self.folder / "model.city.json").read_bytes(),
                         (self.folder / "cli" / "model.city.json").read_bytes())

    def test_of_arrays_and_features_gives_the_models_of_the_files(self):
        scan = mansard.read_scan(MESH, FOOTPRINTS)
        from_files = mansard.reconstruct(scan)
        vertices = scan.vertices + scan.origin
        features = json.loads(pathlib.Path(FOOTPRINTS).read_text())
        from_arrays = mansard.reconstruct((vertices, scan.triangles), features)
        for mine, theirs in zip(from_arrays, from_files, strict=True):
            self.assertEqual(mine.id, theirs.id)
            for a, b in zip(mine.solids, theirs.solids, strict=True):
                numpy.testing.assert_array_equal(a.vertices, b.vertices)
                self.assertEqual(a.faces, b.faces)

    def test_takes_geometries_of_every_kind(self):
        scan = mansard.read_scan(MESH, FOOTPRINTS)
        mesh = (scan.vertices + scan.origin, scan.triangles)
        geometries = [feature["geometry"] for feature in scan.footprints["features"]]

        class Shape:
            def __init__(self, geometry):
                self.__geo_interface__ = geometry

        def wkb(geometry):
            rings = geometry["coordinates"]
            data = struct.pack("<BII", 1, 3, len(rings))
            for ring in rings:
                data += struct.pack("<I", len(ring)) + b"".join(struct.pack("<2d", *point) for point in ring)
            return data

        expected = [building.solids[0].volume for building in mansard.reconstruct(mesh, geometries)]
        for given in ([Shape(each) for each in geometries], [wkb(each) for each in geometries],
                      {"type": "FeatureCollection", "features": scan.footprints["features"]}):
            got = [building.solids[0].volume for building in mansard.reconstruct(mesh, given)]
            self.assertEqual(got, expected)

    def test_has_heights_and_corners_in_the_coordinates_of_the_files(self):
        building = mansard.reconstruct(MESH, FOOTPRINTS, mesh_offset=(0, 0, 500))["main"]
        self.assertAlmostEqual(building.ground, building.attributes["ms_h_ground"], 3)
        self.assertGreater(building.ground, 500)
        solid = building.solids[0]
        self.assertAlmostEqual((solid.vertices + solid.origin)[:, 2].min(), building.ground, 1)
        outline = numpy.array(building.__geo_interface__["geometry"]["coordinates"][0])
        drawn = [feature for feature in json.loads(pathlib.Path(FOOTPRINTS).read_text())["features"]
                 if feature["properties"]["id"] == "main"][0]["geometry"]["coordinates"][0]
        numpy.testing.assert_allclose(outline.min(axis=0), numpy.array(drawn)[:, :2].min(axis=0), atol=1e-6)

    def test_derives_footprints_when_asked(self):
        city = mansard.reconstruct(MESH, derive_footprints=True)
        self.assertGreaterEqual(len(city), 1)


class Errors(unittest.TestCase):
    def test_carry_code_subject_and_remedy(self):
        with self.assertRaises(mansard.Error) as caught:
            mansard.reconstruct("nowhere.ply", FOOTPRINTS)
        self.assertEqual(caught.exception.code, "file-missing")
        self.assertIn("nowhere.ply", caught.exception.subject)
        self.assertTrue(caught.exception.remedy)
        self.assertEqual(mansard.explain("file-missing")["remedy"], caught.exception.remedy)

    def test_name_the_option_that_was_meant(self):
        with self.assertRaises(mansard.Error) as caught:
            mansard.reconstruct(MESH, FOOTPRINTS, sweep_gama=3, refine_effort="none")
        self.assertEqual(len(caught.exception.diagnostics), 2)
        self.assertIn("sweep_gamma", str(caught.exception))

    def test_refuse_arrays_of_the_wrong_shape(self):
        for mesh in ((numpy.zeros((3, 2)), numpy.zeros((1, 3), int)), (numpy.zeros((3, 3)), numpy.full((1, 3), 3)),
                     (numpy.zeros((3, 3)), numpy.zeros((1, 3)))):
            with self.assertRaises(ValueError):
                mansard.read_scan(mesh, FOOTPRINTS)

    def test_refuse_broken_binary(self):
        for data in (b"", b"\x01", struct.pack("<BI", 1, 1), struct.pack("<BIII", 1, 3, 1, 2**31)):
            with self.assertRaises(ValueError):
                mansard.extrude([data])


class Editing(WithFolder):
    def setUp(self):
        super().setUp()
        self.city = mansard.reconstruct(MESH, FOOTPRINTS)

    def test_shows_the_error_of_an_edit_and_writes_it(self):
        building = self.city.buildings[0]
        before = building.extrude_plans()
        self.assertTrue(before.valid)
        part = building.parts[0]
        part.plan.cap += 0.0
        self.assertFalse(part.edited)
        part.plan.cap *= 1.5
        part.plan.profiles = [profile * (1, 1.5) for profile in part.plan.profiles]
        self.assertTrue(part.edited and building.edited and self.city.edited)
        after = building.extrude_plans()
        self.assertGreater(after.rmse, before.rmse)
        self.assertGreater(after.volume, before.volume)
        edited = self.city.with_edits()
        self.assertGreater(edited[building.id].solids[0].volume, building.solids[0].volume)
        self.assertTrue(edited[building.id].attributes["ms_edited"])
        self.city.write(self.folder / "model.city.json")
        again = mansard.read_city(self.folder / "model.city.json")
        self.assertAlmostEqual(again[building.id].solids[0].volume, edited[building.id].solids[0].volume, 3)
        part.reset()
        self.assertFalse(self.city.edited)

    def test_refuses_plans_that_are_none(self):
        plan = self.city.buildings[0].parts[0].plan
        with self.assertRaises(ValueError):
            plan.outer = numpy.zeros((2, 2))
        with self.assertRaises(ValueError):
            plan.profile_of_edge = [99] * len(plan.outer)
        with self.assertRaises(ValueError):
            plan.outer[0] = 0  # a copy, and read-only: writing to it would change nothing

    def test_a_plan_made_by_hand_becomes_a_house(self):
        gable = [(0, 0), (0, 10.0), (0, 11.0)]
        plan = mansard.Plan([(0, 0), (10, 0), (10, 6), (0, 6)], profiles=[[(0, 0), (0, 5), (3, 8)], gable[:2]],
                            profile_of_edge=[0, 1, 0, 1])
        solid, full, warnings = mansard.extrude_plan(plan)
        self.assertTrue(full)
        self.assertEqual(solid.check(), [])
        self.assertAlmostEqual(solid.volume, 10 * 6 * 5 + 10 * 6 * 3 / 2)
        self.assertEqual(sorted(mansard.FACE_CLASSES[c] for c in solid.classes), ["ground"] + ["roof"] * 2 + ["wall"] * 4)


class Arrays(unittest.TestCase):
    def test_are_views_and_agree_with_each_other(self):
        city = mansard.reconstruct(MESH, FOOTPRINTS)
        solid = city.buildings[0].solids[0]
        self.assertFalse(solid.vertices.flags.owndata or solid.vertices.flags.writeable)
        triangles, face_of = solid.triangles()
        corners = solid.vertices[triangles]
        areas = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        numpy.testing.assert_allclose(numpy.bincount(face_of, areas), solid.areas, rtol=1e-6)
        volume = numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6
        self.assertAlmostEqual(volume / solid.volume, 1, 5)
        self.assertEqual(len(solid.classes), len(solid.faces))

    def test_outlive_what_they_were_taken_from(self):
        vertices = mansard.reconstruct(MESH, FOOTPRINTS).buildings[0].solids[0].vertices
        plan = mansard.reconstruct(MESH, FOOTPRINTS).buildings[0].parts[0].plan
        self.assertTrue(numpy.isfinite(vertices).all())
        self.assertTrue(numpy.isfinite(plan.outer).all())


class Others(WithFolder):
    def test_evaluate_gives_the_numbers_of_the_command_line(self):
        city = mansard.reconstruct(MESH, FOOTPRINTS)
        city.write(self.folder / "model.city.json")
        run("evaluate", self.folder / "model.city.json", MESH, "-o", self.folder / "report.json", "-q")
        report = json.loads((self.folder / "report.json").read_text())
        by_path = mansard.evaluate(self.folder / "model.city.json", MESH)
        by_city = mansard.evaluate(city, MESH)
        self.assertEqual(by_path.report["scores"], report["scores"])
        self.assertEqual(by_city.report["scores"], report["scores"])
        self.assertEqual(by_path.error.ndim, 2)
        self.assertLess(by_path.extent[0], by_path.extent[1])

    def test_report_gives_the_page_of_the_command_line(self):
        run("reconstruct", MESH, FOOTPRINTS, "-o", self.folder / "run", "-q")
        run("report", self.folder / "run", "--worst", "1", "--date", "today", "-q")
        page = mansard.report(self.folder / "run", worst=1, date="today")
        self.assertEqual(page, (self.folder / "run" / "report.html").read_text())
        with self.assertRaisesRegex(mansard.Error, "run.json"):
            mansard.report(self.folder)

    def test_compare_gives_the_report_of_the_command_line(self):
        city = mansard.reconstruct(MESH, FOOTPRINTS)
        city.write(self.folder / "old.city.json")
        city.write(self.folder / "new.city.json")
        printed = json.loads(run("compare", self.folder / "old.city.json", self.folder / "new.city.json", "--json", "-q"))
        same = mansard.compare(self.folder / "old.city.json", self.folder / "new.city.json", compare_smallest=0.5)
        self.assertEqual(same, printed)
        with self.assertRaises(mansard.Error):
            mansard.compare(self.folder / "old.city.json", self.folder / "none.city.json")

    def test_label_counts_as_the_command_line_does(self):
        city = mansard.reconstruct(MESH, FOOTPRINTS)
        city.write(self.folder / "model.city.json")
        printed = run("label", MESH, self.folder / "model.city.json", "-o", self.folder / "labelled.ply", "-q")
        labels = mansard.label(MESH, self.folder / "model.city.json")
        counts = numpy.bincount(labels.classes, minlength=4)
        self.assertIn("triangles  " + "  ".join(f"{name} {count}" for name, count in zip(mansard.SCAN_CLASSES, counts)),
                      printed)

    def test_segment_gives_layers_with_reasons(self):
        segmentation = mansard.segment(MESH, FOOTPRINTS)
        self.assertTrue(any("why" in feature["properties"] for feature in segmentation.layers["edges"]["features"]))
        self.assertIn("blocks", segmentation.report)

    def test_simulate_gives_the_bytes_of_the_command_line(self):
        run("simulate", "--block", "terrace", "-o", self.folder / "block", "--seed", "3", "--simulate-size", "40", "-q")
        block = mansard.simulate("terrace", seed=3, size=40)
        self.assertEqual(block.mesh_ply, (self.folder / "block" / "mesh.ply").read_bytes())
        self.assertEqual(block.footprints_text, (self.folder / "block" / "footprints.geojson").read_text())
        city = mansard.reconstruct((block.vertices, block.triangles), block.footprints)
        self.assertGreater(len(city), 0)
        self.assertLess(mansard.evaluate(city, (block.vertices, block.triangles), truth=block.truth)
                        .report["scores"]["footprint_mse_m2"], 5)

    def test_extrude_gives_the_bytes_of_the_command_line(self):
        features = {"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {"id": "a", "height": 7, "roof:shape": "gabled"},
             "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [12, 0], [12, 8], [0, 8], [0, 0]]]}}]}
        path = self.folder / "outlines.geojson"
        path.write_text(json.dumps(features))
        run("extrude", path, "-o", self.folder / "cli.city.json", "-q")
        mansard.extrude(path).write(self.folder / "python.city.json")
        self.assertEqual((self.folder / "python.city.json").read_bytes(), (self.folder / "cli.city.json").read_bytes())
        self.assertAlmostEqual(mansard.extrude(features)["a"].solids[0].volume, mansard.extrude(path)["a"].solids[0].volume)

    def test_of_several_formats_are_written_but_for_one_that_fails(self):
        # No way leads from Mars to WGS 84, which 3D Tiles need.
        outline = {"type": "Polygon", "coordinates": [[[0, 0], [12, 0], [12, 8], [0, 8], [0, 0]]]}
        city = mansard.extrude([outline], crs="IAU_2015:49910", default_height=6)
        paths = [self.folder / name for name in ("a.obj", "a.3dtiles", "a.city.json")]
        with self.assertRaises(mansard.Error) as caught:
            city.write(paths)
        self.assertEqual(caught.exception.code, "write-tiles-crs")
        self.assertIn("there is no a.3dtiles, and the other files are complete", str(caught.exception))
        self.assertEqual([path.exists() for path in paths], [True, False, True])
        self.assertEqual(len(mansard.read_city(paths[2])), 1)
        # Where nothing could be written, no others are spoken of; and nothing is written where a name is wrong.
        with self.assertRaises(mansard.Error) as caught:
            city.write(self.folder / "b.3dtiles")
        self.assertNotIn("other files", str(caught.exception))
        with self.assertRaises(mansard.Error):
            city.write([self.folder / "c.obj", self.folder / "c.nothing"])
        self.assertFalse((self.folder / "c.obj").exists())

    def test_refuses_pipes_wherever_they_are_given(self):
        pipe = str(self.folder / "pipe.geojson")
        os.mkfifo(pipe)
        model = str(self.folder / "model.city.json")
        mansard.extrude(FOOTPRINTS, default_height=6).write(model)
        for call in (lambda: mansard.reconstruct(pipe, FOOTPRINTS), lambda: mansard.reconstruct(MESH, pipe),
                     lambda: mansard.extrude(pipe), lambda: mansard.read_city(pipe), lambda: mansard.read_scan(MESH, pipe),
                     lambda: mansard.evaluate(pipe, MESH), lambda: mansard.evaluate(model, pipe), lambda: mansard.label(MESH, pipe),
                     lambda: mansard.reconstruct(MESH, FOOTPRINTS, dtm=pipe), lambda: mansard.compare(pipe, pipe)):
            with self.assertRaises(mansard.Error) as caught:
                call()
            self.assertIn("to a file, and give that file", str(caught.exception))

    def test_convert_gives_the_bytes_of_the_command_line(self):
        mansard.reconstruct(MESH, FOOTPRINTS).write(self.folder / "model.city.json")
        run("convert", self.folder / "model.city.json", "-o", self.folder / "cli.glb", "-q")
        mansard.convert(self.folder / "model.city.json", self.folder / "python.glb")
        self.assertEqual((self.folder / "python.glb").read_bytes(), (self.folder / "cli.glb").read_bytes())
        with self.assertRaises(mansard.Error) as caught:
            mansard.convert(self.folder / "model.city.json", self.folder / "python.glb")
        self.assertEqual(caught.exception.code, "output-exists")


class Running(unittest.TestCase):
    def test_progress_is_told_and_other_threads_go_on(self):
        told, ticks, stop = [], [], threading.Event()

        def tick():
            while not stop.wait(0.01):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        mansard.reconstruct(MESH, FOOTPRINTS, progress=lambda *news: told.append(news))
        stop.set()
        thread.join()
        self.assertTrue(told)
        self.assertTrue(all(0 <= fraction <= 1 for _, _, fraction in told))
        self.assertGreater(len(ticks), 1)

    def test_an_exception_of_the_progress_function_ends_the_work(self):
        class Enough(Exception):
            pass

        def progress(*_):
            raise Enough

        with self.assertRaises(Enough):
            mansard.simulate("courtyard", progress=progress)

    def test_control_c_ends_the_work(self):
        script = ("import mansard, sys\n"
                  "try:\n"
                  "    mansard.simulate('courtyard', size=400, progress=lambda *n: print('at work', flush=True))\n"
                  "except KeyboardInterrupt:\n"
                  "    sys.exit(42)\n")
        child = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        child.stdout.readline()
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.wait(60), 42)
        child.stdout.close()


class Reference(unittest.TestCase):
    def test_every_option_of_the_command_line_is_a_keyword(self):
        known = {f"{option['module']}_{option['name']}": str(option["default"])
                 for option in json.loads(run("options", "--all", "--json"))["options"]}
        mine = {entry["keyword"]: entry["default"] for entry in mansard.options(advanced=True)}
        self.assertEqual(set(known) ^ set(mine), set())

    def test_the_stubs_have_the_names_of_the_package(self):
        import ast

        stub = ast.parse((pathlib.Path(mansard.__file__).parent / "__init__.pyi").read_text())
        described = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        real = [name for name in mansard.__all__ if not isinstance(getattr(mansard, name), tuple)]
        self.assertEqual(set(real), set(described))
        for name in real:
            node, value = described[name], getattr(mansard, name)
            if isinstance(node, ast.FunctionDef):
                given = [each.arg for each in node.args.args + node.args.kwonlyargs]
                self.assertEqual(given, [each for each in inspect.signature(value).parameters if each != "options"] if
                                 name != "options" else ["module", "advanced"], name)
                continue
            members = {each.name if isinstance(each, ast.FunctionDef) else each.target.id
                       for each in node.body if isinstance(each, (ast.FunctionDef, ast.AnnAssign))}
            public = {each for each in vars(value) if not each.startswith("_")}
            self.assertLessEqual(public, members, name)
            self.assertLessEqual({each for each in members if not each.startswith("__")} - public,
                                 {"report", "layers", "table", "error", "extent", "vertices", "triangles", "classes",
                                  "origin", "diagnostics", "code", "message", "subject"}, name)

    def test_everything_public_has_a_docstring(self):
        for name in mansard.__all__:
            value = getattr(mansard, name)
            if isinstance(value, tuple):
                continue
            self.assertTrue(value.__doc__, name)
            if not isinstance(value, type):
                continue
            for member, found in vars(value).items():
                if not member.startswith("_") or member == "__geo_interface__":
                    self.assertTrue(getattr(found, "__doc__", None), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
