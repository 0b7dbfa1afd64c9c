"""Paths, arrays and features as the files that the engine reads."""

import contextlib
import json
import os
import tempfile

import numpy


def _is_path(value):
    return isinstance(value, (str, os.PathLike))


def _mesh_arrays(value):
    """``(vertices, triangles)`` as arrays that a PLY file takes."""
    try:
        vertices, triangles = value
    except (TypeError, ValueError):
        raise TypeError("a mesh is a path, a list of paths, or a pair of arrays (vertices, triangles)") from None
    vertices = numpy.ascontiguousarray(vertices, dtype="<f8")
    given = numpy.asarray(triangles)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise ValueError(f"vertices have the shape {vertices.shape}; expected (n, 3), in metres, z up")
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu":
        raise ValueError(f"triangles have the shape {given.shape} and the type {given.dtype}; expected integers (m, 3)")
    if given.size and (given.min() < 0 or given.max() >= len(vertices)):
        raise ValueError(f"triangles name vertex {given.max() if given.min() >= 0 else given.min()} of {len(vertices)}")
    return vertices, given.astype("<i4")


def ply_bytes(vertices, triangles):
    """A binary PLY file with doubles, so that no digit is lost."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = numpy.empty(len(triangles), dtype=[("n", "u1"), ("v", "<i4", (3,))])
    faces["n"] = 3
    faces["v"] = triangles
    return header.encode() + vertices.tobytes() + faces.tobytes()


def _geometry(value):
    """A GeoJSON geometry of a mapping, of what has ``__geo_interface__``, or of well-known binary."""
    if isinstance(value, (bytes, bytearray, memoryview)):
        return _wkb(bytes(value))
    if hasattr(value, "__geo_interface__"):
        value = value.__geo_interface__
    if not isinstance(value, dict) or "type" not in value:
        raise TypeError("a footprint is a GeoJSON-like mapping, something with __geo_interface__, or well-known binary")
    return value


def _wkb(data):
    """The polygon or multipolygon of well-known binary (OGC 06-103r4, 8.2), with or without z and m."""
    import struct

    at = 0

    def take(form, order):
        nonlocal at
        size = struct.calcsize(form)
        if at + size > len(data):
            raise ValueError("the well-known binary ends too early")
        values = struct.unpack_from(order + form, data, at)
        at += size
        return values

    def geometry():
        nonlocal at
        order = "<" if take("B", "<")[0] == 1 else ">"
        kind = take("I", order)[0]
        dimensions = 2
        if kind & 0x80000000:
            dimensions += 1
        if kind & 0x40000000:
            dimensions += 1
        if kind & 0x20000000:
            take("I", order)  # the spatial reference of extended WKB
        kind &= 0x1FFFFFFF
        dimensions += {0: 0, 1: 1, 2: 1, 3: 2}.get(kind // 1000, 0)
        kind %= 1000
        if kind == 3:
            rings = []
            for _ in range(take("I", order)[0]):
                count = take("I", order)[0]
                if count * dimensions * 8 > len(data) - at:
                    raise ValueError("the well-known binary ends too early")
                ring = [take(f"{dimensions}d", order)[:2] for _ in range(count)]
                rings.append([list(point) for point in ring])
            return {"type": "Polygon", "coordinates": rings}
        if kind == 6:
            parts = [geometry()["coordinates"] for _ in range(take("I", order)[0])]
            return {"type": "MultiPolygon", "coordinates": parts}
        raise ValueError(f"well-known binary of type {kind}; expected a polygon (3) or a multipolygon (6)")

    return geometry()


def _plain(value):
    """A value that JSON knows: numpy's numbers as Python's, NaN and what is unknown as nothing or text."""
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple, numpy.ndarray)):
        return [_plain(each) for each in value]
    if isinstance(value, numpy.generic):
        value = value.item()
    if isinstance(value, float) and value != value:
        return None
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return str(value)


def _features(value):
    """GeoJSON features of whatever describes footprints."""
    if hasattr(value, "__geo_interface__"):
        value = value.__geo_interface__
    if isinstance(value, dict):
        kind = value.get("type")
        if kind == "FeatureCollection":
            return [dict(feature) for feature in value["features"]]
        if kind == "Feature":
            return [dict(value)]
        return [{"type": "Feature", "properties": {}, "geometry": value}]
    if isinstance(value, (bytes, bytearray, memoryview)):
        return [{"type": "Feature", "properties": {}, "geometry": _geometry(value)}]
    features = []
    for each in value:
        described = _geometry(each)
        if described.get("type") == "Feature":
            features.append(dict(described))
        elif described.get("type") == "FeatureCollection":
            features.extend(dict(feature) for feature in described["features"])
        else:
            features.append({"type": "Feature", "properties": {}, "geometry": described})
    return features


def _crs_name(crs, value):
    """The CRS to write: the one given, else that of a GeoDataFrame."""
    if crs is None:
        crs = getattr(value, "crs", None)
    if crs is None:
        return None
    if hasattr(crs, "to_epsg"):
        code = crs.to_epsg()
        if code is None:
            raise ValueError("the CRS of the footprints has no EPSG code; give crs='EPSG:n'")
        return f"EPSG:{code}"
    return str(crs)


def geojson_bytes(value, crs=None):
    """Footprints as GeoJSON; with ``crs`` ("EPSG:n") as member of the collection, without it in metres as they are."""
    features = [_plain(feature) for feature in _features(value)]
    for feature in features:
        feature.setdefault("type", "Feature")
        feature["properties"] = feature.get("properties") or {}
    collection = {"type": "FeatureCollection"}
    name = _crs_name(crs, value)
    if name and name.upper().startswith("EPSG:"):
        collection["crs"] = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::" + name.split(":")[1]}}
    collection["features"] = features
    return json.dumps(collection).encode()


@contextlib.contextmanager
def files(mesh=None, footprints=None, crs=None):
    """Paths of meshes and of footprints; arrays and features are put into files that are removed at the end."""
    with contextlib.ExitStack() as stack:
        folder = None

        def place(name, data):
            nonlocal folder
            if folder is None:
                folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="mansard-"))
            path = os.path.join(folder, name)
            with open(path, "wb") as file:
                file.write(data)
            return path

        if mesh is None:
            meshes = []
        elif _is_path(mesh):
            meshes = [os.fspath(mesh)]
        elif isinstance(mesh, (list, tuple)) and mesh and all(_is_path(each) for each in mesh):
            meshes = [os.fspath(each) for each in mesh]
        else:
            meshes = [place("mesh.ply", ply_bytes(*_mesh_arrays(mesh)))]
        if footprints is None:
            outlines = ""
        elif _is_path(footprints):
            outlines = os.fspath(footprints)
        else:
            outlines = place("footprints.geojson", geojson_bytes(footprints, crs))
        yield meshes, outlines
