"""The verbs of mansard as algorithms."""

import json
import os
import shlex

from qgis.core import (
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingLayerPostProcessorInterface,
    QgsProcessingOutputFile,
    QgsProcessingOutputMultipleLayers,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterExtent,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterString,
    QgsVectorLayer,
    QgsWkbTypes,
)

from . import program

PRESETS = ["", "paper", "chordatlas"]
# File extensions of layers that the program reads as they are; others are exported to a GeoPackage first.
FOOTPRINT_FILES = ["gpkg", "geojson", "json", "shp", "fgb", "gml", "osm", "pbf"]


def _advanced(parameter):
    parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
    return parameter


class Show3D(QgsProcessingLayerPostProcessorInterface):
    """Gives layers with heights a 3D renderer, so that 3D map views show them as solids."""

    kept = []  # QGIS does not keep Python's objects alive

    @classmethod
    def create(cls, colour):
        made = cls()
        made.colour = colour
        cls.kept.append(made)
        return made

    def postProcessLayer(self, layer, context, feedback):
        try:
            from qgis._3d import QgsPhongMaterialSettings, QgsPolygon3DSymbol, QgsVectorLayer3DRenderer
            from qgis.PyQt.QtGui import QColor
        except ImportError:  # QGIS without 3D
            return
        if not isinstance(layer, QgsVectorLayer) or not QgsWkbTypes.hasZ(layer.wkbType()):
            return
        material = QgsPhongMaterialSettings()
        material.setDiffuse(QColor(self.colour))
        material.setAmbient(QColor(self.colour).darker(250))
        symbol = QgsPolygon3DSymbol()
        for set_material in ("setMaterialSettings", "setMaterial"):  # 3.30 and later, earlier
            if hasattr(symbol, set_material):
                try:
                    getattr(symbol, set_material)(material)
                    break
                except TypeError:
                    continue
        renderer = QgsVectorLayer3DRenderer(symbol)
        renderer.setLayer(layer)
        layer.setRenderer3D(renderer)
        layer.triggerRepaint()


class Verb(QgsProcessingAlgorithm):
    """What the algorithms share."""

    verb = title = help = ""

    def name(self):
        return self.verb

    def displayName(self):
        return self.title

    def shortHelpString(self):
        return self.help

    def group(self):
        return "Building models"

    def groupId(self):
        return "models"

    def createInstance(self):
        return type(self)()

    # Parameters.

    def _add_mesh(self):
        self.addParameter(QgsProcessingParameterFile(
            "MESH", "Mesh: a file (OBJ, PLY, OFF, GLB, tileset.json, raster of heights …)"))
        folder = QgsProcessingParameterFile("MESH_FOLDER", "Or a folder of mesh tiles",
                                            behavior=QgsProcessingParameterFile.Folder, optional=True)
        self.parameterDefinition("MESH").setFlags(
            self.parameterDefinition("MESH").flags() | QgsProcessingParameterDefinition.FlagOptional)
        self.addParameter(folder)

    def _add_footprints(self):
        self.addParameter(QgsProcessingParameterFeatureSource(
            "FOOTPRINTS", "Building footprints", [QgsProcessing.TypeVectorPolygon]))

    def _add_options(self):
        self.addParameter(QgsProcessingParameterExtent("EXTENT", "Only buildings in this extent", optional=True))
        self.addParameter(_advanced(QgsProcessingParameterString(
            "MESH_OFFSET", "Offset of the mesh: X Y Z in metres, added to its coordinates", optional=True)))
        self.addParameter(_advanced(QgsProcessingParameterCrs("CRS", "CRS to work in (metres)", optional=True)))
        self.addParameter(_advanced(QgsProcessingParameterEnum("PRESET", "Preset", ["default", *PRESETS[1:]],
                                                               defaultValue=0, optional=True)))
        self._add_more()

    def _add_more(self):
        self.addParameter(_advanced(QgsProcessingParameterString(
            "OPTIONS", "More options, as on the command line ('mansard options' lists them)", optional=True)))

    # Their values as arguments.

    def _mesh(self, parameters, context):
        mesh = self.parameterAsFile(parameters, "MESH", context)
        folder = self.parameterAsFile(parameters, "MESH_FOLDER", context)
        if bool(mesh) == bool(folder):
            raise QgsProcessingException("Give either a mesh file or a folder of mesh tiles.")
        return mesh or folder

    def _footprints(self, parameters, context, feedback):
        """Arguments that name the features, in a file of their own where only some are wanted, and their CRS."""
        source = self.parameterAsSource(parameters, "FOOTPRINTS", context)
        if source is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, "FOOTPRINTS"))
        if source.featureCount() == 0:
            raise QgsProcessingException("There are no footprints; select some, or choose another layer.")
        path, layer = self.parameterAsCompatibleSourceLayerPathAndLayerName(
            parameters, "FOOTPRINTS", context, FOOTPRINT_FILES, "gpkg", feedback)
        return [path], ["--layer", layer] if layer else [], source.sourceCrs()

    def _more(self, parameters, context, crs=None):
        arguments = []
        if self.parameterDefinition("EXTENT"):
            wanted = self.parameterAsCrs(parameters, "CRS", context)
            if wanted.isValid():
                arguments += ["--crs", wanted.authid()]
                crs = wanted
            if parameters.get("EXTENT"):
                box = self.parameterAsExtent(parameters, "EXTENT", context, crs) if crs is not None and crs.isValid() \
                    else self.parameterAsExtent(parameters, "EXTENT", context)
                if not box.isNull():
                    arguments += ["--bbox", *(repr(v) for v in
                                              (box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum()))]
            preset = self.parameterAsEnum(parameters, "PRESET", context)
            if preset:
                arguments += ["--preset", PRESETS[preset]]
        if self.parameterDefinition("MESH_OFFSET"):
            offset = self.parameterAsString(parameters, "MESH_OFFSET", context).replace(",", " ").split()
            if offset:
                if len(offset) != 3:
                    raise QgsProcessingException("The offset of the mesh needs three numbers: X Y Z.")
                arguments += ["--mesh-offset", *offset]
        try:
            return arguments + shlex.split(self.parameterAsString(parameters, "OPTIONS", context))
        except ValueError as error:
            raise QgsProcessingException(f"More options: {error}") from None

    # Results.

    def _load(self, path, names, context):
        """Adds layers of a GeoPackage to the project at the end, with the styles in the file."""
        ids = []
        for name, title, colour in names:
            uri = f"{path}|layername={name}"
            layer = QgsVectorLayer(uri, title, "ogr")
            if not layer.isValid() or layer.featureCount() == 0:
                continue
            context.temporaryLayerStore().addMapLayer(layer)
            details = QgsProcessingContext.LayerDetails(title, context.project(), title)
            if colour:
                details.setPostProcessor(Show3D.create(colour))
            context.addLayerToLoadOnCompletion(layer.id(), details)
            ids.append(layer.id())
        return ids


# Layers of model.gpkg, from below: name, title, colour in 3D views.
MODEL_LAYERS = [("footprints", "Footprints", None), ("ground", "Ground surfaces", "#9a9a9a"),
                ("walls", "Walls", "#d9d4cc"), ("roof_planes", "Roof planes", "#b5473c")]
REASON_LAYERS = [("faces", "Faces of the ground plane", None), ("footprints", "Parts", None),
                 ("sweep_edges", "Sweep-edges", None), ("edges", "Walls, with reasons", None)]


class Models(Verb):
    """Reconstruct and extrude: a folder of models, and their layers."""

    def _add_outputs(self):
        self.addParameter(QgsProcessingParameterString(
            "FORMATS", "Formats besides GeoPackage (cityjson, glb, tiles, obj, stl, plans …)",
            defaultValue="cityjson,plans", optional=True))
        self.addParameter(QgsProcessingParameterBoolean("LOAD", "Add the layers to the project", defaultValue=True))
        self.addParameter(QgsProcessingParameterBoolean("OVERWRITE", "Replace earlier results in the folder",
                                                        defaultValue=False))
        self.addParameter(QgsProcessingParameterFolderDestination("OUTPUT", "Folder for the models"))
        self.addOutput(QgsProcessingOutputFile("GEOPACKAGE", "GeoPackage"))
        self.addOutput(QgsProcessingOutputFile("REPORT", "Report (run.json)"))
        self.addOutput(QgsProcessingOutputMultipleLayers("LAYERS", "Layers"))
        for name, title in (("FULL", "Buildings in full"), ("FALLBACK", "Buildings with a simpler model"),
                            ("COVERED", "Buildings covered by neighbours"), ("REFUSED", "Refused buildings")):
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def _make(self, arguments, parameters, context, feedback):
        folder = self.parameterAsString(parameters, "OUTPUT", context)
        formats = [word.strip() for word in self.parameterAsString(parameters, "FORMATS", context).split(",")]
        wanted = ",".join(dict.fromkeys([*filter(None, formats), "geopackage"]))
        arguments = [self.verb, *arguments, "-o", folder, "--formats", wanted]
        if self.parameterAsBool(parameters, "OVERWRITE", context):
            arguments.append("--overwrite")
        program.run(arguments, feedback)
        if feedback.isCanceled():
            return {}
        path, report = os.path.join(folder, "model.gpkg"), os.path.join(folder, "run.json")
        with open(report, encoding="utf-8") as file:
            outcomes = [building["outcome"] for building in json.load(file)["buildings"]]
        layers = []
        if self.parameterAsBool(parameters, "LOAD", context):
            layers = self._load(path, MODEL_LAYERS, context)
        counts = {name.upper(): outcomes.count(name) for name in ("full", "fallback", "covered", "refused")}
        return {"OUTPUT": folder, "GEOPACKAGE": path, "REPORT": report, "LAYERS": layers, **counts}


class Reconstruct(Models):
    verb = "reconstruct"
    title = "Reconstruct buildings from a mesh and footprints"
    help = ("Makes watertight building models with labelled walls and roofs of a mesh (photogrammetry or LiDAR) and "
            "building footprints. The footprints' CRS must be metric, or their UTM zone is used. A mesh in a local frame "
            "needs its offset.")

    def initAlgorithm(self, configuration=None):
        self._add_mesh()
        self._add_footprints()
        self._add_options()
        self._add_outputs()

    def processAlgorithm(self, parameters, context, feedback):
        mesh = self._mesh(parameters, context)
        footprints, layer, crs = self._footprints(parameters, context, feedback)
        return self._make([mesh, *footprints, *layer, *self._more(parameters, context, crs)], parameters, context, feedback)


class Extrude(Models):
    verb = "extrude"
    title = "Extrude buildings from footprints and attributes"
    help = ("Makes building models of footprints alone: heights, storeys and roof shapes come from attributes "
            "(those of OpenStreetMap and others).")

    def initAlgorithm(self, configuration=None):
        self._add_footprints()
        self._add_more()
        self._add_outputs()

    def processAlgorithm(self, parameters, context, feedback):
        footprints, layer, _ = self._footprints(parameters, context, feedback)
        return self._make([*footprints, *layer, *self._more(parameters, context)], parameters, context, feedback)


class Segment(Verb):
    verb = "segment"
    title = "Divide footprints into parts, with reasons"
    help = ("Divides footprints into building parts by the walls that the mesh shows, and says for every wall why it was "
            "drawn or not.")

    def initAlgorithm(self, configuration=None):
        self._add_mesh()
        self._add_footprints()
        self._add_options()
        self.addParameter(QgsProcessingParameterBoolean("LOAD", "Add the layers to the project", defaultValue=True))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Layers", "GeoPackage (*.gpkg)"))
        self.addOutput(QgsProcessingOutputMultipleLayers("LAYERS", "Layers"))

    def processAlgorithm(self, parameters, context, feedback):
        mesh = self._mesh(parameters, context)
        footprints, layer, crs = self._footprints(parameters, context, feedback)
        out = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        program.run(["segment", mesh, *footprints, *layer, *self._more(parameters, context, crs), "-o", out,
                     "--overwrite"], feedback)
        if feedback.isCanceled():
            return {}
        layers = []
        if self.parameterAsBool(parameters, "LOAD", context):
            layers = self._load(out, REASON_LAYERS, context)
        return {"OUTPUT": out, "LAYERS": layers}


class Evaluate(Verb):
    verb = "evaluate"
    title = "Measure models against a mesh"
    help = ("Measures how far models (CityJSON, CityJSONSeq, OBJ of any producer, or any format of mansard) are from a "
            "mesh, building by building.")

    def initAlgorithm(self, configuration=None):
        self.addParameter(QgsProcessingParameterFile("MODEL", "Models"))
        self._add_mesh()
        self.addParameter(QgsProcessingParameterFeatureSource(
            "FOOTPRINTS", "Footprints to measure over", [QgsProcessing.TypeVectorPolygon], optional=True))
        self.addParameter(_advanced(QgsProcessingParameterString(
            "MESH_OFFSET", "Offset of the mesh: X Y Z in metres, added to its coordinates", optional=True)))
        self._add_more()
        self.addParameter(QgsProcessingParameterFolderDestination("OUTPUT", "Folder for the report and the error map"))
        self.addOutput(QgsProcessingOutputFile("ERROR_MAP", "Error map, model - mesh in metres (GeoTIFF)"))
        self.addOutput(QgsProcessingOutputFile("REPORT", "Report (report.json)"))
        self.addOutput(QgsProcessingOutputNumber("MSE", "Mean squared vertical error over the footprints, m²"))
        self.addOutput(QgsProcessingOutputString("TABLE", "The report in words"))

    def processAlgorithm(self, parameters, context, feedback):
        arguments = ["evaluate", self.parameterAsFile(parameters, "MODEL", context), self._mesh(parameters, context)]
        if parameters.get("FOOTPRINTS"):
            footprints, layer, _ = self._footprints(parameters, context, feedback)
            arguments += ["--footprints", *footprints, *layer]
        folder = self.parameterAsString(parameters, "OUTPUT", context)
        _, printed = program.run([*arguments, *self._more(parameters, context), "-o", folder, "--overwrite"], feedback)
        if feedback.isCanceled():
            return {}
        report = os.path.join(folder, "report.json")
        with open(report, encoding="utf-8") as file:
            scores = json.load(file)["scores"]
        error_map = os.path.join(folder, "error.tif")
        context.addLayerToLoadOnCompletion(
            error_map, QgsProcessingContext.LayerDetails("Error, model - mesh", context.project(), "ERROR_MAP"))
        return {"OUTPUT": folder, "ERROR_MAP": error_map, "REPORT": report, "MSE": scores["footprint_mse_m2"],
                "TABLE": "\n".join(printed)}
