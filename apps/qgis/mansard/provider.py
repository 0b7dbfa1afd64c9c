"""The algorithms in the toolbox of Processing, and the setting that names the program."""

import os

from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .algorithms import Evaluate, Extrude, Reconstruct, Segment
from .program import SETTING


class Provider(QgsProcessingProvider):
    def id(self):
        return "mansard"

    def name(self):
        return "mansard"

    def icon(self):
        return QIcon(os.path.join(os.path.dirname(__file__), "icon.svg"))

    def load(self):
        # Processing's settings exist only where its own plugin is loaded.
        try:
            from processing.core.ProcessingConfig import ProcessingConfig, Setting

            ProcessingConfig.addSetting(
                Setting("mansard", SETTING, "The program mansard (empty: the one in PATH)", "", valuetype=Setting.FILE))
            ProcessingConfig.readSettings()
        except ImportError:
            pass
        self.refreshAlgorithms()
        return True

    def unload(self):
        try:
            from processing.core.ProcessingConfig import ProcessingConfig

            ProcessingConfig.removeSetting(SETTING)
        except ImportError:
            pass

    def loadAlgorithms(self):
        for algorithm in (Reconstruct, Extrude, Segment, Evaluate):
            self.addAlgorithm(algorithm())
