"""mansard in QGIS: a provider of Processing algorithms."""


def classFactory(iface):  # the name that QGIS calls
    from .plugin import Plugin

    return Plugin()
