"""Clean, watertight, labelled and editable building models of a city scan.

    import mansard

    city = mansard.reconstruct("scan.ply", "footprints.gpkg")
    for building in city.buildings:
        print(building.id, building.outcome, building.rmse)
    city.write("models.city.json")

Coordinates are metres, angles radians, z is up. Every option of the command line is a keyword argument: the option
``--sweep-gamma`` is ``sweep_gamma``; :func:`options` lists them. Results are those of the command line, to the byte.
What goes wrong is an exception, :class:`Error`, with a code and what to do; Ctrl-C stops every function. Other threads of
Python go on while the engine works.
"""

import json as _json
import os as _os
import tempfile as _tempfile
from contextlib import contextmanager as _contextmanager

from . import _core, _docs, _inputs
from ._core import Building, City, Diagnostic, Part, Plan, ExtrudedBuilding, Scan, Simulation, Solid
from ._errors import Error

_docs.apply(_core)
__version__ = _core.__version__

__all__ = [
    "Building", "City", "Diagnostic", "Error", "Evaluation", "Labels", "Part", "Plan", "ExtrudedBuilding", "Scan",
    "Segmentation", "Simulation", "Solid", "FACE_CLASSES", "SCAN_CLASSES", "compare", "convert", "evaluate", "explain",
    "extrude", "formats", "label", "limit_threads", "options", "presets", "extrude_plan", "read_city", "read_scan",
    "reconstruct", "report", "segment", "simulate",
]

#: Names of the numbers in :attr:`Solid.classes`.
FACE_CLASSES = ("wall", "party_wall", "roof", "ground", "soffit")
#: Names of the numbers in :attr:`Labels.classes` and :attr:`Simulation.classes`.
SCAN_CLASSES = ("wall", "roof", "ground", "other")


def _settings(options):
    """Keyword arguments as the strings that options take."""
    def text(value):
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, (list, tuple)) or type(value).__module__ == "numpy" and getattr(value, "ndim", 0):
            return " ".join(text(each) for each in value)
        if isinstance(value, float):
            return repr(value)
        if type(value).__module__ == "numpy":
            return text(value.item())
        return _os.fspath(value) if hasattr(value, "__fspath__") else str(value)

    return [(name, text(value)) for name, value in options.items() if value is not None]


def read_scan(mesh, footprints=None, *, derive_footprints=False, preset="", progress=None, crs=None, **options):
    """Reads a mesh and footprints into one local frame, to be used several times.

    Args:
        mesh: a path, a list of paths, or arrays ``(vertices (n, 3), triangles (m, 3))`` in metres, z up.
        footprints: a path, features or geometries: GeoJSON-like mappings, anything with ``__geo_interface__`` (shapely,
            geopandas), or well-known binary.
        derive_footprints: draw the footprints from the mesh instead.
        preset: a set of values to start from; :func:`presets` lists them.
        progress: called with ``(stage, subject, fraction)``.
        crs: the CRS to work in and that of footprints given as features ("EPSG:n").
        **options: see :func:`options`.

    Returns:
        A :class:`Scan`.
    """
    if crs is not None:
        options.setdefault("ingest_crs", crs)
    with _inputs.files(mesh, footprints, crs) as (meshes, outlines):
        return _core.read_scan(meshes, outlines, derive_footprints, preset, _settings(options), progress)


def _scan(mesh, footprints, derive_footprints, preset, progress, crs, options):
    if isinstance(mesh, Scan):
        if footprints is not None:
            raise TypeError("a Scan comes with its footprints; leave the second argument out")
        return mesh
    return read_scan(mesh, footprints, derive_footprints=derive_footprints, preset=preset, progress=progress, crs=crs,
                     **options)


def reconstruct(mesh, footprints=None, *, derive_footprints=False, preset="", progress=None, crs=None, **options):
    """Makes building models of a mesh and footprints.

    Args:
        mesh: a :class:`Scan`, or as for :func:`read_scan`.
        footprints: as for :func:`read_scan`; not with a :class:`Scan`.
        derive_footprints, preset, progress, crs, **options: as for :func:`read_scan`.

    Returns:
        A :class:`City`, with the models that ``mansard reconstruct`` writes.
    """
    scan = _scan(mesh, footprints, derive_footprints, preset, progress, crs, dict(options))
    if crs is not None:
        options.setdefault("ingest_crs", crs)
    return _core.reconstruct(scan, preset, _settings(options), progress)


def segment(mesh, footprints=None, *, derive_footprints=False, preset="", progress=None, crs=None, **options):
    """Divides the footprints into parts and says why: the first stages of :func:`reconstruct`.

    Returns:
        A :class:`Segmentation`.
    """
    scan = _scan(mesh, footprints, derive_footprints, preset, progress, crs, dict(options))
    if crs is not None:
        options.setdefault("ingest_crs", crs)
    return Segmentation(*_core.segment(scan, preset, _settings(options), progress))


def extrude(footprints, *, preset="", progress=None, crs=None, **options):
    """Makes building models of footprints and their attributes alone (height, storeys, roof shape).

    Args:
        footprints: as for :func:`read_scan`.

    Returns:
        A :class:`City`, with the models that ``mansard extrude`` writes.
    """
    if crs is not None:
        options.setdefault("ingest_crs", crs)
    with _inputs.files(None, footprints, crs) as (_, outlines):
        return _core.extrude_footprints(outlines, preset, _settings(options), progress)


def read_city(path, *, preset="", progress=None, **options):
    """Reads building models that mansard wrote, with their plans and profiles.

    Returns:
        A :class:`City`.
    """
    return _core.read_city(_os.fspath(path), preset, _settings(options), progress)


def convert(path, to, *, overwrite=False, progress=None, **options):
    """Writes models that mansard wrote in other formats, chosen by the file extensions.

    Args:
        path: the file to read.
        to: a path, or several.
    """
    read_city(path, progress=progress, **options).write(to, overwrite=overwrite, progress=progress)


@_contextmanager
def _model_path(model):
    if not isinstance(model, City):
        yield _os.fspath(model)
        return
    with _tempfile.TemporaryDirectory(prefix="mansard-") as folder:
        path = _os.path.join(folder, "model.city.json")
        model.write(path)
        yield path


def evaluate(model, mesh, *, truth=None, footprints=None, lod="", preset="", progress=None, **options):
    """Compares models with a mesh, and with a model that is known to be right.

    Args:
        model: a :class:`City`, or a path of models of any producer.
        mesh: as for :func:`read_scan`, in the coordinates of the model.
        truth: a :class:`City` or a path.
        footprints: what to measure over; without it those of the truth or the model.

    Returns:
        An :class:`Evaluation`.
    """
    if isinstance(mesh, Scan):
        mesh = (mesh.vertices + mesh.origin, mesh.triangles)
    with _model_path(model) as model_path, _inputs.files(mesh, footprints) as (meshes, outlines):
        arguments = (lod, preset, _settings(options), progress)
        if truth is None:
            return Evaluation(*_core.evaluate(model_path, meshes, "", outlines, *arguments))
        with _model_path(truth) as truth_path:
            return Evaluation(*_core.evaluate(model_path, meshes, truth_path, outlines, *arguments))


def _paths(one_or_several):
    if one_or_several is None:
        return []
    many = isinstance(one_or_several, (list, tuple))
    return [_os.fspath(path) for path in (one_or_several if many else [one_or_several])]


def compare(old, new, *, old_scan=None, new_scan=None, scans=True, progress=None, **options):
    """Tells what has changed between two states of a city.

    Args:
        old, new: a folder of ``mansard reconstruct``, a path of models of any producer, or of footprints with heights.
        old_scan, new_scan: the scan that the models were made from, a path or several; without it that of the run.
        scans: False compares the models alone.

    Returns:
        A dictionary: what ``mansard compare --json`` prints.
    """
    return _json.loads(_core.compare((_os.fspath(old), _paths(old_scan)), (_os.fspath(new), _paths(new_scan)), scans,
                                     _settings(options), progress))


def report(run, *, scan=None, scans=True, review=None, changes=None, worst=10, title="", date="", progress=None):
    """Writes a page about a run for those who ordered it, to read and to print.

    Args:
        run: an output folder of ``mansard reconstruct``, or the folder of a project's run.
        scan: the scan that the models were made from, a path or several; without it that of the run.
        scans: False draws the models without the scan.
        review: decisions of people: ``review.json`` of projects or their folders, a path or several.
        changes: ``changes.json`` of ``mansard compare``, or the folder that it wrote.
        worst: the number of models with a picture, those that are least sure first.
        title, date: of the page.

    Returns:
        The page: HTML that needs no other file.
    """
    return _core.report(_os.fspath(run), _paths(scan), scans, _paths(review), "" if changes is None else
                        _os.fspath(changes), worst, title, date, progress)


def label(mesh, model, *, lod="", progress=None, **options):
    """Says of every triangle of a mesh what it shows, by a model.

    Args:
        mesh: as for :func:`read_scan`, in the coordinates of the model.
        model: a :class:`City`, or a path of models of any producer.

    Returns:
        :class:`Labels`.
    """
    if isinstance(mesh, Scan):
        mesh = (mesh.vertices + mesh.origin, mesh.triangles)
    with _model_path(model) as path, _inputs.files(mesh) as (meshes, _):
        return Labels(*_core.label(meshes, path, lod, _settings(options), progress))


def simulate(kind="terrace", *, footprints=None, preset="", progress=None, seed=1, **options):
    """Makes a block of buildings that are known exactly, and a mesh as a scan would show them.

    Args:
        kind: "terrace", "perimeter", "courtyard", "towers" or "detached".
        footprints: build on these instead, as for :func:`read_scan`.
        preset: "clean", "nadir-drone", "oblique-aerial" or "lidar-2.5d".
        seed: another number gives another block.
        **options: those of ``mansard simulate`` with and without the prefix ``simulate_``.

    Returns:
        A :class:`Simulation`.
    """
    named = {name if name.startswith("simulate_") else "simulate_" + name: value for name, value in options.items()}
    named["simulate_seed"] = seed
    with _inputs.files(None, footprints) as (_, outlines):
        return _core.simulate(kind, outlines, preset, _settings(named), progress)


def extrude_plan(plan, **options):
    """Extrudes one plan.

    Returns:
        ``(solid, full, warnings)``: a :class:`Solid`, whether it is as the plan says, and why not.
    """
    return _core.extrude_plan(plan, _settings(options))


def options(module=None, advanced=False):
    """The options of all functions: a list of dictionaries with keyword, default, unit, range and meaning.

    Args:
        module: only those of this module, for example "sweep".
        advanced: also those that few have a reason to change.
    """
    return [entry for entry in _core.option_table()
            if (module is None or entry["module"] == module) and (advanced or not entry["advanced"])]


def presets():
    """The presets: a list of dictionaries with name, meaning and values."""
    return _core.preset_table()


def formats():
    """The file formats: a list of dictionaries with name, extensions, what is read, whether it is written."""
    return _core.formats()


def explain(code):
    """Cause and remedy of a diagnostic code."""
    try:
        return _core.code_table()[code]
    except KeyError:
        raise KeyError(f"no diagnostic has the code {code!r}") from None


def limit_threads(threads):
    """Limits all functions to that many threads; 0 is one for each core. Results do not depend on it."""
    _core.limit_threads(threads)


class Segmentation:
    """The parts of the footprints and why there are walls between them.

    Attributes:
        report: what ``mansard segment`` writes to its report, as a dictionary.
        layers: name → GeoJSON FeatureCollection in the coordinates of the files: gis_footprints, sweep_edges, faces,
            edges, conflicts, footprints. ``geopandas.GeoDataFrame.from_features(layers["edges"])`` takes them.
    """

    def __init__(self, report, layers):
        self.report = _json.loads(report)
        self.layers = layers

    def __repr__(self):
        return f"<mansard.Segmentation with {len(self.layers['footprints']['features'])} parts>"


class Evaluation:
    """How good a model is.

    Attributes:
        report: all numbers, as ``mansard evaluate -o report.json`` writes them.
        table: the same for a person.
        error: (rows, columns), model − mesh in metres, from the south; NaN where either has no surface.
        extent: ``(xmin, xmax, ymin, ymax)`` of the map, for ``matplotlib.pyplot.imshow(…, origin="lower")``.
    """

    def __init__(self, report, table, error, extent):
        self.report = _json.loads(report)
        self.table = table
        self.error = error
        self.extent = extent

    def __repr__(self):
        return "<mansard.Evaluation>\n" + self.table


class Labels:
    """What the triangles of a mesh show.

    Attributes:
        vertices: (n, 3), metres from ``origin``.
        triangles: (m, 3) indices.
        classes: (m,), indices into :data:`SCAN_CLASSES`.
        origin: to be added to the vertices to get the coordinates of the files.
    """

    def __init__(self, vertices, triangles, classes, origin):
        self.vertices = vertices
        self.triangles = triangles
        self.classes = classes
        self.origin = origin

    def __repr__(self):
        return f"<mansard.Labels of {len(self.classes)} triangles>"


def _write(self, path, *, format="", overwrite=False, progress=None, **options):
    """Writes the city, with the edits of its plans, to one file or several.

    Args:
        path: a path or a list of paths; the file extension names the format (:func:`formats`). Where one cannot hold
            the city, the others are written, and the error says which is missing.
        format: the name of a format, instead of the file extension.
        overwrite: replace what exists.
        **options: those of the module "write".

    Returns:
        Warnings: what could not be written as asked.
    """
    paths = [path] if isinstance(path, (str, _os.PathLike)) else list(path)
    return self._write_all([_os.fspath(each) for each in paths], format, overwrite, _settings(options), progress)


City.write = _write
City.report = property(lambda self: _json.loads(self.report_text) if self.report_text else None,
                       doc="What the run reports (run.json), as a dictionary; None for a file that was read.")
City.__iter__ = lambda self: iter(self.buildings)
Simulation.footprints = property(lambda self: _json.loads(self.footprints_text),
                                 doc="What a surveyor would draw: a GeoJSON FeatureCollection.")
