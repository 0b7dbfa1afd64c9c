"""Opens a GLB of mansard in Blender with one collection per building and one object per class.

  blender --python tools/blender_import.py -- out/street/model.glb
  blender --background --python tools/blender_import.py -- out/street/model.glb street.blend

Blender's own importer (File > Import > glTF 2.0) makes one object per building, with a material per class, all in one
collection. This script calls it, then makes for every building a collection with the objects "wall ID", "roof ID", "ground ID",
…: a class is hidden, selected or given a material like any object. Attributes of the building are custom properties of its
collection and of its objects. Several files can be imported into one scene, one after the other. Blender 3.4 or later.
"""
import os
import sys

import bpy
import numpy

numpy.bool = bool  # the glTF importer of Debian 12's Blender uses it; its numpy has it no more


def class_of(name):
    """The class that a material stands for: Blender appends .001 to names that exist already."""
    stem, _, number = name.rpartition(".")
    return stem if stem and number.isdigit() else name


def pieces_of(mesh):
    """The mesh by material: (material, vertices n × 3 in metres, loop starts, loop totals, vertices of the loops, texture
    coordinates of the loops n × 2 or None)."""
    points = numpy.empty(len(mesh.vertices) * 3, numpy.float32)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    corners = numpy.empty(len(mesh.loops), numpy.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    totals, materials = (numpy.empty(len(mesh.polygons), numpy.int32) for _ in range(2))
    mesh.polygons.foreach_get("loop_total", totals)
    mesh.polygons.foreach_get("material_index", materials)
    material_of_corner = numpy.repeat(materials, totals)
    texture = None
    if mesh.uv_layers:
        texture = numpy.empty(len(mesh.loops) * 2, numpy.float32)
        mesh.uv_layers[0].data.foreach_get("uv", texture)
        texture = texture.reshape(-1, 2)
    for number, material in enumerate(mesh.materials):
        mine = material_of_corner == number
        used, renumbered = numpy.unique(corners[mine], return_inverse=True)
        count = totals[materials == number]
        if len(count):
            yield material, points[used], numpy.cumsum(count) - count, count, renumbered, None if texture is None else texture[mine]


def collection_of(building):
    """The collection for one imported object, with the objects of its classes; the object itself is removed."""
    name, mesh, attributes = building.name, building.data, dict(building.items())
    made = bpy.data.collections.new(attributes.get("building", name))
    for key, value in attributes.items():
        made[key] = value
    for material, points, starts, totals, corners, texture in pieces_of(mesh):
        title = f"{class_of(material.name)} {name}"
        piece = bpy.data.meshes.new(title)
        piece.vertices.add(len(points))
        piece.vertices.foreach_set("co", points.ravel())
        piece.loops.add(len(corners))
        piece.loops.foreach_set("vertex_index", corners.astype(numpy.int32))
        piece.polygons.add(len(starts))
        piece.polygons.foreach_set("loop_start", starts.astype(numpy.int32))
        piece.polygons.foreach_set("loop_total", totals.astype(numpy.int32))
        if texture is not None:
            piece.uv_layers.new(name="UVMap").data.foreach_set("uv", texture.ravel())
        piece.materials.append(material)
        piece.update(calc_edges=True)
        thing = bpy.data.objects.new(title, piece)
        thing.matrix_world = building.matrix_world
        for key, value in attributes.items():
            thing[key] = value
        made.objects.link(thing)
    bpy.data.objects.remove(building)
    bpy.data.meshes.remove(mesh)
    return made


def open_glb(path):
    """Imports a GLB; returns the collection of the file, which has a collection for each building."""
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=path)
    imported = sorted((o for o in bpy.data.objects if o not in before), key=lambda o: o.name)
    file = bpy.data.collections.new(bpy.path.display_name_from_filepath(path))
    bpy.context.scene.collection.children.link(file)
    for building in imported:
        if building.type == "MESH":
            file.children.link(collection_of(building))
    return file


def main():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if not 1 <= len(words) <= 2:
        sys.exit("usage: blender [--background] --python blender_import.py -- MODEL.glb [SAVED.blend]")
    if not bpy.data.filepath:  # Blender's default scene, not a file of the user
        for thing in [o for o in bpy.data.objects if o.name in ("Cube", "Light", "Camera")]:
            bpy.data.objects.remove(thing)
    file = open_glb(words[0])
    print(f"{words[0]}: {len(file.children)} buildings, {sum(len(b.objects) for b in file.children)} objects")
    if len(words) == 2:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(words[1]))


if __name__ == "__main__":
    main()
