"""Run by Blender: the models of a GLB become collections by building with an object per class, as docs/blender.md says.
blender … --python check.py -- IMPORTER GLB IDS…"""
import importlib.util
import sys
from math import isclose

import bpy

importer, glb, *ids = sys.argv[sys.argv.index("--") + 1:]
spec = importlib.util.spec_from_file_location("blender_import", importer)
blender_import = importlib.util.module_from_spec(spec)
spec.loader.exec_module(blender_import)


def area(objects):
    return sum(p.area for o in objects for p in o.data.polygons)


def texture_of(objects):
    """Where the corners of all faces are in the images, in an order that does not depend on the objects."""
    return sorted((round(c.uv.x, 5), round(c.uv.y, 5)) for o in objects for layer in o.data.uv_layers for c in layer.data)


bpy.ops.import_scene.gltf(filepath=glb)
plain = [o for o in bpy.data.objects if o.type == "MESH" and "building" in o]
expected, texture = area(plain), texture_of(plain)
for thing in plain:
    bpy.data.objects.remove(thing)

for repetition in range(2):  # into one scene, twice
    file = blender_import.open_glb(glb)
    buildings = {b["building"]: b for b in file.children}
    assert sorted(buildings) == sorted(ids), (sorted(buildings), ids)
    things = [o for b in buildings.values() for o in b.objects]
    assert isclose(area(things), expected, rel_tol=1e-5), (area(things), expected)
    assert texture_of(things) == texture, "texture coordinates differ from those of Blender's importer"
    for building in buildings.values():
        classes = {o.name.split(" ")[0]: o for o in building.objects}
        assert {"wall", "roof", "ground"} <= set(classes), classes
        for name, thing in classes.items():
            assert [blender_import.class_of(m.name) for m in thing.data.materials] == [name]
            assert thing["building"] == building["building"] and thing["ms_h_ground"] == building["ms_h_ground"]
        assert all(p.normal.z > 0 for p in classes["roof"].data.polygons), "a roof looks down"
        lowest = min((o.matrix_world @ v.co).z for o in building.objects for v in o.data.vertices)
        assert all(isclose((classes["ground"].matrix_world @ v.co).z, lowest, abs_tol=1e-3) for v in classes["ground"].data.vertices)
print("checked")
