"""Renders the picture of README.md: the models of data/delft, seen at an angle, in soft light.

  mansard reconstruct data/delft/mesh.ply data/delft/footprints.geojson --mesh-offset 84800 447400 0 -o delft
  blender --background --factory-startup --python tools/readme_picture.py -- delft/model.glb docs/pictures/delft-street.jpg

Needs Blender 3.4 (Debian 12: blender, python3-numpy). Options after the two paths, as name=value: width, height,
samples; azimuth, elevation and distance (`view`, the width of the view in metres) of the camera, and the point in the
middle of the view (x, y, z, metres from the file's origin); `sun`, the sun's azimuth relative to the camera.
`scan=data/delft/mesh.ply` draws the scan in place of the models, for docs/pictures/delft-scan.jpg and, without it,
docs/pictures/delft-models.jpg (both with width=800 height=450).
"""
import json
import struct
import sys

import bpy
import numpy
from math import cos, radians, sin
from mathutils import Vector
from mathutils.kdtree import KDTree

numpy.bool = bool  # the glTF importer of Debian 12's Blender uses it; its numpy has it no more

WALL, PARTY, GROUND, LINE, SCAN = "#f1ece2", "#e2d9ca", "#bcbdb4", "#3a302b", "#8fa3bf"
ROOFS = ["#ab6148", "#a25742", "#b56c4f", "#9c5340", "#b0664e"]  # one of these per building


def arguments():
    words = sys.argv[sys.argv.index("--") + 1:]
    settings = {"width": 1600, "height": 900, "samples": 40, "azimuth": 246, "elevation": 25, "x": -15, "y": -15, "z": 4, "view": 84, "sun": -62, "scan": ""}
    for word in words[2:]:
        name, value = word.split("=")
        settings[name] = value if name == "scan" else type(settings[name])(float(value))
    return words[0], words[1], settings


def linear(colour):
    """A colour of the screen as Blender's linear RGBA."""
    parts = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts] + [1]


def material(name, colour, roughness=0.9):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = linear(colour)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Specular"].default_value = 0.1
    return made


def paint(models):
    """Light walls, and roofs that differ a little from house to house."""
    walls = {"wall": material("light wall", WALL), "party_wall": material("party", PARTY),
             "soffit": material("underside", WALL), "ground": material("base", GROUND)}
    roofs = [material(f"roof {i}", colour) for i, colour in enumerate(ROOFS)]
    names = sorted({model.name.rsplit("-", 1)[0] for model in models})
    for model in models:
        number = names.index(model.name.rsplit("-", 1)[0])
        for slot in model.material_slots:
            kind = slot.material.name.split(".")[0]
            slot.material = roofs[(number * 7) % len(roofs)] if kind.startswith("roof") else walls.get(kind, walls["wall"])


def base_points(models):
    """The lowest corners of every part: where it stands."""
    found = []
    for model in models:
        points = [model.matrix_world @ vertex.co for vertex in model.data.vertices]
        low = min(point.z for point in points)
        found += [point for point in points if point.z < low + 0.01]
    return found


def make_ground(models, spacing=1.0, reach=400.0):
    """A smooth surface through the feet of the buildings: near them a grid, far from them level."""
    feet = base_points(models)
    tree = KDTree(len(feet))
    for i, point in enumerate(feet):
        tree.insert((point.x, point.y, 0), i)
    tree.balance()
    xs = [p.x for p in feet]
    ys = [p.y for p in feet]
    level = sorted(p.z for p in feet)[len(feet) // 2]

    def axis(low, high):
        steps = int((high - low + 30) / spacing)
        return [low - reach] + [low - 15 + i * spacing for i in range(steps + 1)] + [high + reach]

    gx, gy = axis(min(xs), max(xs)), axis(min(ys), max(ys))
    vertices = []
    for y in gy:
        for x in gx:
            near = tree.find_n((x, y, 0), 24)
            weights = [1 / (d + 0.5) ** 2 for _, _, d in near]
            z = sum(w * feet[i].z for w, (_, i, _) in zip(weights, near)) / sum(weights)
            far = min(1.0, near[0][2] / 30)
            vertices.append((x, y, z + (level - z) * far))
    n = len(gx)
    faces = [(j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i)
             for j in range(len(gy) - 1) for i in range(n - 1)]
    mesh = bpy.data.meshes.new("terrain")
    mesh.from_pydata(vertices, [], faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    mesh.materials.append(material("terrain", GROUND))
    bpy.context.collection.objects.link(bpy.data.objects.new("terrain", mesh))


def make_lines(models, radius=0.025):
    """Thin dark lines along ridges, eaves and corners."""
    curve = bpy.data.curves.new("lines", "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = radius
    curve.bevel_resolution = 0
    for model in models:
        normals, ends = {}, {}
        for polygon in model.data.polygons:
            normal = (model.matrix_world.to_3x3() @ polygon.normal).normalized()
            corners = [model.matrix_world @ model.data.vertices[v].co for v in polygon.vertices]
            for a, b in zip(corners, corners[1:] + corners[:1]):
                key = tuple(sorted((tuple(round(c, 3) for c in a), tuple(round(c, 3) for c in b))))
                normals.setdefault(key, []).append(normal)
                ends[key] = (a, b)
        for key, (a, b) in ends.items():
            sides = normals[key]
            if len(sides) == 2 and sides[0].dot(sides[1]) > 0.985:
                continue
            if all(side.z < -0.9 for side in sides):
                continue
            spline = curve.splines.new("POLY")
            spline.points.add(1)
            spline.points[0].co = (*a, 1)
            spline.points[1].co = (*b, 1)
    curve.materials.append(material("line", LINE))
    bpy.context.collection.objects.link(bpy.data.objects.new("lines", curve))


def origin_of(glb):
    """What was subtracted from the coordinates of a GLB that mansard wrote."""
    with open(glb, "rb") as file:
        length, = struct.unpack("<I", file.read(20)[12:16])
        return json.loads(file.read(length))["asset"]["extras"]["origin"]


def show_scan(path, glb, offset=(84800, 447400, 0)):
    """The scan in the frame of the models."""
    bpy.ops.import_mesh.ply(filepath=path)
    scan = bpy.context.view_layer.objects.active
    scan.location = [a - b for a, b in zip(offset, origin_of(glb))]
    scan.data.materials.clear()
    scan.data.materials.append(material("scan", SCAN))
    bpy.ops.mesh.primitive_plane_add(size=1000, location=(0, 0, -0.5))
    bpy.context.view_layer.objects.active.data.materials.append(material("terrain", GROUND))


def light():
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.86, 0.92, 1.0, 1)
    background.inputs["Strength"].default_value = 0.6
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy = 2.1
    sun.angle = radians(2)
    sun.color = (1.0, 0.95, 0.87)
    placed = bpy.data.objects.new("sun", sun)
    bpy.context.collection.objects.link(placed)
    return placed


def smooth_light(scene):
    """Light and colour apart, the light smoothed within faces: Debian's Blender has no denoiser."""
    layer = scene.view_layers[0]
    layer.use_pass_normal = layer.use_pass_diffuse_color = True
    layer.use_pass_diffuse_direct = layer.use_pass_diffuse_indirect = True
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()

    def node(kind, first, second, **settings):
        made = tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(made, name, value)
        inputs = [socket for socket in made.inputs if socket.type == "RGBA"]
        tree.links.new(first, inputs[0])
        if second is not None:
            tree.links.new(second, inputs[1])
        return made.outputs[0] if made.outputs else None

    passes = tree.nodes.new("CompositorNodeRLayers").outputs
    light = node("CompositorNodeMixRGB", passes["DiffDir"], passes["DiffInd"], blend_type="ADD")
    light = node("CompositorNodeBilateralblur", light, passes["Normal"], iterations=5, sigma_color=0.05, sigma_space=5)
    painted = node("CompositorNodeMixRGB", light, passes["DiffCol"], blend_type="MULTIPLY")
    node("CompositorNodeComposite", painted, None)


def main():
    source, target, settings = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=source)
    models = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
    if settings["scan"]:
        for model in models:
            bpy.data.objects.remove(model)
        show_scan(settings["scan"], source)
    else:
        paint(models)
        make_ground(models)
        make_lines(models)

    sun = light()
    azimuth, elevation = radians(settings["azimuth"]), radians(settings["elevation"])
    towards = Vector((sin(azimuth) * cos(elevation), cos(azimuth) * cos(elevation), sin(elevation)))
    side = radians(settings["azimuth"] + settings["sun"])
    sun.rotation_euler = Vector((sin(side) * 0.75, cos(side) * 0.75, 0.8)).to_track_quat("Z", "Y").to_euler()

    camera = bpy.data.cameras.new("camera")
    camera.lens = 70
    camera.clip_end = 2000
    distance = settings["view"] * camera.lens / camera.sensor_width
    placed = bpy.data.objects.new("camera", camera)
    target_point = Vector((settings["x"], settings["y"], settings["z"]))
    placed.location = target_point + towards * distance
    placed.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
    bpy.context.collection.objects.link(placed)

    scene = bpy.context.scene
    scene.camera = placed
    scene.render.engine = "CYCLES"
    scene.cycles.samples = settings["samples"]
    scene.cycles.seed = 1
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 4
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"
    scene.render.resolution_x, scene.render.resolution_y = settings["width"], settings["height"]
    scene.render.image_settings.file_format = "JPEG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.quality = 92
    scene.render.filepath = target
    smooth_light(scene)
    bpy.ops.render.render(write_still=True)


main()
