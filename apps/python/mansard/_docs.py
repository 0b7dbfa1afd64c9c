"""What the classes of the extension module and their properties are, for ``help()``, the stubs and the reference."""

CLASSES = {
    "City": "Building models with the plans and profiles that they were made of. ``city[id]`` is a building.",
    "Building": "One feature of the footprints and its models.",
    "Part": "A part of a building: a plan with profiles, and the solid made of them.",
    "Plan": (
        "The outline of a part and a profile for each of its edges: what a model is made of. Coordinates are metres "
        "from the city's origin. Change it by assigning: ``plan.cap = 8``, ``plan.outer = plan.outer + (1, 0)``, "
        "``plan.set_profile(0, points)``. A profile goes from (0, 0), metres inward and metres above "
        "the base, never back or down: vertical pieces are walls, sloped ones roofs; the last goes on until roofs meet."
    ),
    "Solid": "A closed surface of plane polygons, each wall, party wall, roof, ground or soffit.",
    "ExtrudedBuilding": "What edited plans make, before anything is changed.",
    "Diagnostic": "One thing to tell: a code that is never renamed, a message, and what it is about.",
    "Scan": "A mesh and footprints in one local frame.",
    "Simulation": "Buildings that are known exactly, and a mesh as a scan would show them.",
}

PROPERTIES = {
    "City.buildings": "All buildings, in the order of the footprints.",
    "City.crs": 'The coordinate reference system ("EPSG:n"); empty for a local frame.',
    "City.origin": "Whole metres (x, y, z), to be added to coordinates of plans and solids for those of the files.",
    "City.version": "The version of mansard that made it.",
    "City.options": "What it was made with: module.name → value, as text.",
    "City.warnings": "What the run had to say, a list of Diagnostic.",
    "City.report_text": "What the run reports (run.json), as text; empty for a file that was read.",
    "City.edited": "Whether a plan was changed since the models were made.",
    "Building.id": "The feature's id.",
    "Building.attributes": "Attributes: the source's own, then those with the prefix ``ms_``.",
    "Building.ground": "z of its ground, metres, in the coordinates of the files.",
    "Building.__geo_interface__": "Its footprint with attributes, as a GeoJSON feature in the coordinates of the files.",
    "Building.parts": "Its parts.",
    "Building.solids": "What is written of it: as a rule one solid, the union of its parts.",
    "Building.outcome": '"full", "fallback", "covered" or "refused"; None for a file that was read.',
    "Building.reasons": "Why the outcome is not full, and remarks: a list of Diagnostic.",
    "Building.rmse": "Vertical error against the mesh, metres; None where it is not known.",
    "Building.edited": "Whether a plan of it was changed since the models were made.",
    "Part.id": "The id of the part.",
    "Part.attributes": "Its attributes, with the prefix ``ms_``.",
    "Part.plan": "Its plan. Changes count for ``extrude_plans`` of the building, and for ``with_edits`` and ``write`` of the city.",
    "Part.edited": "Whether the plan was changed since the solid was made.",
    "Part.solid": "Its solid, as it was made.",
    "Plan.outer": "(n, 2); the corners, counter-clockwise, metres. Edge i goes from corner i to i + 1.",
    "Plan.holes": "A tuple of (n, 2), clockwise.",
    "Plan.profiles": "A tuple of (n, 2): metres inward, metres above the base.",
    "Plan.profile_of_edge": "For each edge of ``outer`` the index of its profile.",
    "Plan.profile_of_hole_edge": "The same for the holes, a tuple for each.",
    "Plan.base": "z of the ground floor, metres.",
    "Plan.cap": "Height above the base at which the roof is cut off flat, metres.",
    "Solid.vertices": "(n, 3), metres from the origin; read-only, without a copy.",
    "Solid.origin": "Whole metres (x, y, z), to be added to the vertices for the coordinates of the files.",
    "Solid.faces": "For each face its loops of vertex indices: the outer one, counter-clockwise from outside, then holes.",
    "Solid.normals": "(faces, 3); unit, outward.",
    "Solid.areas": "(faces,), m².",
    "Solid.classes": "(faces,); indices into ``mansard.FACE_CLASSES``; read-only, without a copy.",
    "Solid.volume": "m³.",
    "ExtrudedBuilding.valid": "Whether it may be written: every part has a solid as its plan says, and none overlap.",
    "ExtrudedBuilding.rmse": "Vertical error against the mesh, metres; None where it is not known.",
    "ExtrudedBuilding.volume": "m³, over the parts.",
    "ExtrudedBuilding.diagnostics": "Differences from the plans: a list of Diagnostic.",
    "ExtrudedBuilding.solids": "Part id → Solid, or None where there is none.",
    "Diagnostic.severity": '"error" or "warning".',
    "Diagnostic.code": "What it is; ``mansard.explain(code)`` tells cause and remedy.",
    "Diagnostic.message": "What is wrong and what to do.",
    "Diagnostic.subject": "A file, a feature id or an option; may be empty.",
    "Scan.vertices": "(n, 3), metres from the origin; read-only, without a copy.",
    "Scan.triangles": "(m, 3); indices of vertices; read-only, without a copy.",
    "Scan.origin": "Whole metres (x, y, z), to be added to the vertices for the coordinates of the files.",
    "Scan.crs": 'The coordinate reference system ("EPSG:n"); empty for a local frame.',
    "Scan.warnings": "What was left out in reading: a list of Diagnostic.",
    "Scan.footprints": "A GeoJSON FeatureCollection in the coordinates of the files.",
    "Simulation.truth": "The buildings, a City.",
    "Simulation.vertices": "(n, 3), metres; read-only, without a copy.",
    "Simulation.triangles": "(m, 3); indices of vertices; read-only, without a copy.",
    "Simulation.classes": "(m,); indices into ``mansard.SCAN_CLASSES``.",
    "Simulation.mesh_ply": "The mesh as ``mansard simulate`` writes it (mesh.ply).",
    "Simulation.footprints_text": "What a surveyor would draw, as ``mansard simulate`` writes it (footprints.geojson).",
}


def apply(module):
    """Gives the classes and properties of the extension module these descriptions."""
    for name, text in CLASSES.items():
        getattr(module, name).__doc__ = text
    for name, text in PROPERTIES.items():
        owner, member = name.split(".")
        owner = getattr(module, owner)
        found = owner.__dict__[member]
        setattr(owner, member, property(found.fget, found.fset, found.fdel, text))
