# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects to match, results to write, and a record of everything that a run may not change."""

from __future__ import annotations

from dataclasses import replace

import bmesh
import bpy
import numpy as np
from hiermatch.engine import CoarseMatch, MatchResult, SurfaceMap, SurfacePoints
from hiermatch.hiermatch_addon.jobs import match_job
from hiermatch.hiermatch_addon.scene.character import read_surface
from hiermatch.hiermatch_addon.storage.stored_map import find_maps

QUICK = {"points": 12, "coarse_points": 4, "coarse_candidates": 8, "samples": 48, "hypotheses": 2, "dense": False}
"""Settings with which a small mesh is matched in some tenths of a second."""

DENSE = QUICK | {"points": 24, "dense": True}
"""Settings with which it gets a dense map, in a second or two."""

MAP_ATTRIBUTES = [
    "HM Map Vertex 1",
    "HM Map Vertex 2",
    "HM Map Vertex 3",
    "HM Map Weights",
    "HM Map Confidence",
]
"""Names of the attributes that keep a dense map."""


def add_ball(name, segments, rings):
    """Add a ball of triangles and quads, whose faces are always in the same order.

    Blender sorts what it joins by addresses in memory, so that two balls of the same size may differ there.
    """
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=rings)
    obj = bpy.context.object
    obj.name = name
    obj.data.name = name
    faces = bmesh.new()
    faces.from_mesh(obj.data)
    ordered = sorted(faces.faces, key=lambda face: sorted(vertex.index for vertex in face.verts))
    for number, face in enumerate(ordered):
        face.index = number
    faces.faces.sort()
    faces.to_mesh(obj.data)
    faces.free()
    return obj


def add_blob(name, segments=20, rings=14):
    """Add a lopsided ball of triangles and quads, without symmetry."""
    obj = add_ball(name, segments, rings)
    co = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", co)
    x, y, z = co.reshape(-1, 3).T.astype(float)
    moved = np.stack([x * (1 + 0.6 * x) + 0.3 * y * z, 0.8 * y * (1 + 0.5 * z), z * (1 + 0.4 * y + 0.3 * x)], axis=1)
    obj.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    obj.data.update()
    return obj


def add_pair():
    """Add a source and a target, alike up to place and size, and select nothing."""
    source, target = add_blob("Source"), add_blob("Target")
    target.location.x, target.scale = 4, (2, 2, 2)
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None
    bpy.context.view_layer.update()
    return source, target


def add_picked_pair():
    """Add the same, picked in the panel."""
    state = bpy.context.scene.hiermatch
    state.source, state.target = add_pair()
    return state.source, state.target


def edit_twin(obj):
    """Put another object with the same mesh into Edit Mode, and return it."""
    twin = obj.copy()
    bpy.context.collection.objects.link(twin)
    bpy.ops.object.select_all(action="DESELECT")
    twin.select_set(state=True)
    bpy.context.view_layer.objects.active = twin
    bpy.ops.object.mode_set(mode="EDIT")
    return twin


def add_symmetric(name, segments=24, rings=16):
    """Add a long body with two equal sides, y and -y, and different ends, top and bottom."""
    obj = add_ball(name, segments, rings)
    for vertex in obj.data.vertices:
        x, y, z = vertex.co
        vertex.co = 1.6 * x * (1 + 0.6 * x), y * (1 + 0.5 * z) * (1 + 0.5 * x * x), (1.2 if z > 0 else 0.3) * z
    return obj


def add_symmetric_pair():
    """Add two alike bodies with different meshes, which match in two ways, and select nothing."""
    source, target = add_symmetric("Source"), add_symmetric("Target", 28, 18)
    target.location.x = 5
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None
    bpy.context.view_layer.update()
    return source, target


def localised(obj, folder):
    """Put an object into a collection of another file, override that here, and make the object local in it."""
    name, hero = obj.name, bpy.data.collections.new("Hero")
    hero.objects.link(obj)
    path = str(folder / "hero.blend")
    bpy.data.libraries.write(path, {hero})
    bpy.data.batch_remove([obj.data, hero])
    with bpy.data.libraries.load(path, link=True) as (_, here):
        here.collections = ["Hero"]
    layer = bpy.context.view_layer
    here.collections[0].override_hierarchy_create(bpy.context.scene, layer, do_fully_editable=True)
    layer.update()
    layer.objects[name].select_set(state=True)
    bpy.ops.object.make_local(type="SELECT_OBDATA")
    made = layer.objects[name]
    made.select_set(state=False)
    assert made.override_library is None
    assert [collection.override_library is None for collection in made.users_collection] == [False]
    return made


def made_up_result(source_mesh, target_mesh, points=5, seed=1):
    """Make a result of random points, with straight-line distances."""
    random = np.random.default_rng(seed)
    sides = []
    for mesh in (source_mesh, target_mesh):
        triangles = random.choice(mesh.triangle_count, points, replace=False)
        barycentric = random.dirichlet([1, 1, 1], points)
        barycentric[0] = [0, 1, 0]
        surface = SurfacePoints.from_barycentric(mesh, triangles, barycentric)
        distances = np.linalg.norm(surface.positions[:, None] - mesh.vertices[None], axis=2)
        sides.append((surface, distances))
    (source, source_distances), (target, target_distances) = sides
    coarse = CoarseMatch(source.nearest_vertices, target.nearest_vertices, 8, 1.0, 0.9, proven=False, nodes=7)
    return MatchResult(
        source_points=source,
        target_points=target,
        distortion=0.5,
        linear=0.2,
        quadratic=0.3,
        point_distortion=np.linspace(0, 0.1, points),
        orientation=0.8,
        levels=(),
        coarse=coarse,
        source_distances=source_distances,
        target_distances=target_distances,
        notes=(),
        seconds={},
    )


def made_up_maps(source_mesh, target_mesh, seed=2):
    """Make random maps of every vertex between two meshes."""
    random = np.random.default_rng(seed)

    def made_up(domain, image):
        triangles = random.integers(0, image.triangle_count, domain.vertex_count)
        barycentric = random.dirichlet([1, 1, 1], domain.vertex_count)
        return SurfaceMap.from_barycentric(image, triangles, barycentric, random.uniform(size=domain.vertex_count))

    return made_up(source_mesh, target_mesh), made_up(target_mesh, source_mesh)


def without_mirrored(monkeypatch):
    """Let all matches have one answer only."""
    real = match_job.match_steps

    def steps(*arguments, **names):
        return replace((yield from real(*arguments, **names)), alternatives=())

    monkeypatch.setattr(match_job, "match_steps", steps)


def weights_of(obj):
    """For each vertex group, its vertices and their weights."""
    groups = {group.name: {} for group in obj.vertex_groups}
    names = [group.name for group in obj.vertex_groups]
    for vertex in obj.data.vertices:
        for element in vertex.groups:
            groups[names[element.group]][vertex.index] = element.weight
    return groups


def values_of(attribute):
    """Values of an attribute, as bytes."""
    member, dtype, width = {
        "FLOAT": ("value", np.float32, 1),
        "INT": ("value", np.int32, 1),
        "BOOLEAN": ("value", bool, 1),
        "FLOAT_VECTOR": ("vector", np.float32, 3),
        "FLOAT2": ("vector", np.float32, 2),
        "INT32_2D": ("value", np.int32, 2),
        "FLOAT_COLOR": ("color", np.float32, 4),
        "BYTE_COLOR": ("color", np.float32, 4),
    }[attribute.data_type]
    values = np.empty(len(attribute.data) * width, dtype)
    attribute.data.foreach_get(member, values)
    return values


def maps_of(source, target, prefix=""):
    """The dense maps that two sides keep, with the meshes as they stand in the world."""
    found = find_maps(source, target, prefix)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    meshes = [read_surface(side, depsgraph, use_modifiers=found.use_modifiers) for side in (source, target)]
    return found.maps.between(*meshes)


def snapshot():
    """Everything about the scene that a user could see changed."""
    return {
        "objects": {
            obj.name: (obj.type, [list(row) for row in obj.matrix_world], obj.mode, obj.select_get(), dict(obj.items()))
            for obj in bpy.context.view_layer.objects
        },
        "active": getattr(bpy.context.view_layer.objects.active, "name", None),
        "meshes": {obj.name: mesh_snapshot(obj) for obj in bpy.data.objects if obj.type == "MESH"},
        "summary": {
            name: getattr(bpy.context.scene.hiermatch.summary, name)
            for name in bpy.context.scene.hiermatch.summary.bl_rna.properties.keys()  # noqa: SIM118 - not a dict
            if name != "rna_type"
        },
    }


def mesh_snapshot(obj):
    """Everything that a match could change on an object's mesh."""
    mesh = obj.data
    return {
        "groups": [(group.name, group.lock_weight) for group in obj.vertex_groups],
        "active_group": obj.vertex_groups.active_index,
        "weights": weights_of(obj),
        "attributes": [
            (attribute.name, attribute.data_type, attribute.domain, values_of(attribute).tobytes())
            for attribute in mesh.attributes
        ],
        "active_attribute": getattr(mesh.attributes.active, "name", None),
        "active_color": mesh.attributes.active_color_name,
        "render_color": mesh.attributes.default_color_name,
        "properties": {name: value.to_dict() if hasattr(value, "to_dict") else value for name, value in mesh.items()},
        "vertices": [tuple(vertex.co) for vertex in mesh.vertices],
        "name": mesh.name,
    }
