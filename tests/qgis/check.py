"""The QGIS plugin in a QGIS without windows: check.py PLUGINS MANSARD DATA SCRATCH. Needs Debian's Python with PyQGIS."""

import json
import os
import pathlib
import shutil
import sys

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
plugins, program, data, scratch = (pathlib.Path(word).resolve() for word in sys.argv[1:5])
os.environ["MANSARD_PROGRAM"] = str(program)
shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
sys.path[:0] = [str(plugins), "/usr/share/qgis/python/plugins"]

from qgis.core import (  # noqa: E402: the paths come first
    QgsApplication, QgsFeature, QgsGeometry, QgsMapRendererParallelJob, QgsMapSettings, QgsProcessingContext,
    QgsProcessingException, QgsProcessingFeatureSourceDefinition, QgsProcessingFeedback, QgsProject, QgsVectorLayer)
from qgis.PyQt.QtCore import QSize  # noqa: E402

QgsApplication.setPrefixPath("/usr", True)
application = QgsApplication([], False)
application.initQgis()
from processing.core.Processing import Processing  # noqa: E402

Processing.initialize()
from mansard.provider import Provider  # noqa: E402

provider = Provider()
assert QgsApplication.processingRegistry().addProvider(provider)
mesh, footprints = str(data / "hall/mesh.off"), str(data / "hall/footprints.geojson")


class Feedback(QgsProcessingFeedback):
    def __init__(self, cancel_at=None):
        super().__init__()
        self.lines, self.cancel_at = [], cancel_at
        self.progressChanged.connect(self.on_progress)
        self.seen = []

    def on_progress(self, value):
        self.seen.append(value)

    def setProgressText(self, text):
        self.lines.append(text)
        if self.cancel_at and text.startswith(self.cancel_at):
            self.cancel()

    def pushInfo(self, text):
        self.lines.append(text)


def run(name, context=None, feedback=None, **parameters):
    algorithm = QgsApplication.processingRegistry().createAlgorithmById(f"mansard:{name}")
    context = context or QgsProcessingContext()
    feedback = feedback or Feedback()
    parameters = {key: str(value) if isinstance(value, pathlib.Path) else value for key, value in parameters.items()}
    right, why = algorithm.checkParameterValues(parameters, context)
    assert right, why
    results, done = algorithm.run(parameters, context, feedback)
    return results, done, context, feedback


def failure(name, **parameters):
    """The words of an algorithm that must fail."""
    algorithm = QgsApplication.processingRegistry().createAlgorithmById(f"mansard:{name}")
    try:
        algorithm.processAlgorithm({key: str(value) for key, value in parameters.items()}, QgsProcessingContext(),
                                   Feedback())
    except QgsProcessingException as error:
        return str(error)
    raise AssertionError(f"{name} went through")


# A file as it is: every feature, progress, layers with styles and with a 3D renderer.
project = QgsProject()
context = QgsProcessingContext()
context.setProject(project)
results, done, _, feedback = run("reconstruct", context, MESH=mesh, FOOTPRINTS=footprints, OUTPUT=scratch / "all")
assert done and results["FULL"] == 2 and results["REFUSED"] == 0, results
assert feedback.seen and feedback.seen[-1] == 100, feedback.seen
layers = {}
for layer_id, details in context.layersToLoadOnCompletion().items():
    layer = context.takeResultLayer(layer_id)
    if details.postProcessor():
        details.postProcessor().postProcessLayer(layer, context, feedback)
    layers[layer.name()] = layer
    project.addMapLayer(layer)
assert {"Footprints", "Walls", "Roof planes"} <= set(layers), layers
assert layers["Roof planes"].renderer3D() is not None
assert layers["Roof planes"].renderer().type() != "singleSymbol" or layers["Walls"].renderer().type() != "singleSymbol"
settings = QgsMapSettings()
settings.setLayers([layers["Roof planes"], layers["Walls"], layers["Footprints"]])
settings.setExtent(layers["Footprints"].extent().buffered(5))
settings.setOutputSize(QSize(640, 640))
job = QgsMapRendererParallelJob(settings)
job.start()
job.waitForFinished()
image = job.renderedImage()
assert image.save(str(scratch / "map.png"))
assert len({image.pixel(x, y) for x in range(0, 640, 8) for y in range(0, 640, 8)}) > 2, "the map is empty"

# A layer in memory, and of it only what is selected; names that need care.
memory = QgsVectorLayer("Polygon?crs=EPSG:32611&field=fid:integer&field=name:string", "Häuser & Höfe", "memory")
outlines = QgsVectorLayer(footprints, "hall", "ogr")
for feature in outlines.getFeatures():
    copy = QgsFeature(memory.fields())
    copy.setGeometry(QgsGeometry(feature.geometry()))
    copy.setAttributes([7, f"ä {feature.id()}"])
    memory.dataProvider().addFeature(copy)
memory.updateExtents()
context = QgsProcessingContext()
context.setProject(project)
project.addMapLayer(memory)
memory.selectByIds([next(memory.getFeatures()).id()])
results, done, _, _ = run("reconstruct", context, MESH=mesh, OUTPUT=scratch / "ünd more", LOAD=False, FORMATS="",
                          FOOTPRINTS=QgsProcessingFeatureSourceDefinition(memory.id(), selectedFeaturesOnly=True))
assert done and results["FULL"] + results["FALLBACK"] == 1, results
assert (scratch / "ünd more" / "model.gpkg").exists()

# Segment, extrude and evaluate.
results, done, _, _ = run("segment", MESH=mesh, FOOTPRINTS=footprints, OUTPUT=scratch / "parts.gpkg", LOAD=False)
assert done and QgsVectorLayer(f"{scratch}/parts.gpkg|layername=edges", "edges", "ogr").featureCount() > 0
results, done, _, _ = run("extrude", FOOTPRINTS=footprints, OPTIONS="--default-height 9", OUTPUT=scratch / "flat", LOAD=False)
assert done and results["FULL"] == 2, results
results, done, _, _ = run("evaluate", MODEL=scratch / "all/model.city.json", MESH=mesh, FOOTPRINTS=footprints,
                          OUTPUT=scratch / "measured")
assert done and 0 < results["MSE"] < 2, results
assert json.loads((scratch / "measured/report.json").read_text())["scores"]["footprint_mse_m2"] == results["MSE"]

# Cancelled: nothing is left.
results, done, _, _ = run("reconstruct", None, Feedback(cancel_at="slice"), MESH=mesh, FOOTPRINTS=footprints,
                          OUTPUT=scratch / "cancelled")
assert not (scratch / "cancelled" / "model.gpkg").exists()

# What goes wrong is said with the words of the program, or ours.
assert "either" in failure("reconstruct", FOOTPRINTS=footprints, OUTPUT=scratch / "x")
assert "file-missing" in failure("reconstruct", MESH=scratch / "none.ply", FOOTPRINTS=footprints, OUTPUT=scratch / "x")
assert "X Y Z" in failure("reconstruct", MESH=mesh, FOOTPRINTS=footprints, MESH_OFFSET="1 2", OUTPUT=scratch / "x")
assert "output-exists" in failure("reconstruct", MESH=mesh, FOOTPRINTS=footprints, OUTPUT=scratch / "all")
os.environ["MANSARD_PROGRAM"] = "/nowhere/mansard"
assert "cannot be run" in failure("extrude", FOOTPRINTS=footprints, OUTPUT=scratch / "x")
print("the plugin works in QGIS")
sys.stdout.flush()
os._exit(0)  # PyQGIS 3.22 often crashes on the way out, after all is done
