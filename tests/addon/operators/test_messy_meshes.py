# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as they are delivered: each is matched, or refused in one clear sentence."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
import pytest

from tests.addon.scenes import DENSE, MAP_ATTRIBUTES, add_blob, add_pair, maps_of, snapshot, values_of


def put_in_order(elements, place):
    ranks = {element: rank for rank, element in enumerate(sorted(elements, key=place))}
    elements.sort(key=ranks.get)


def edited(obj, change):
    """Change a mesh as a modelling tool would."""
    mesh = bmesh.new()
    mesh.from_mesh(obj.data)
    for elements in (mesh.verts, mesh.edges, mesh.faces):
        elements.ensure_lookup_table()
    change(mesh)
    # Blender's operators leave elements in an order that differs from run to run.
    put_in_order(mesh.verts, lambda vertex: tuple(vertex.co))
    put_in_order(mesh.faces, lambda face: tuple(face.calc_center_median()))
    mesh.to_mesh(obj.data)
    mesh.free()


def joined(obj, *others):
    with bpy.context.temp_override(active_object=obj, selected_editable_objects=[obj, *others]):
        bpy.ops.object.join()


def with_parts(obj):
    parts = []
    for number, place in enumerate([(1.2, 0, 0.5), (0, 1, 0.3), (0, 0, 3)]):
        part = add_blob(f"Part {number}", 8, 6)
        part.location, part.scale = place, (0.1, 0.1, 0.1)
        parts.append(part)
    joined(obj, *parts)


def loose_vertices_and_wires(mesh):
    for place in ((0, 0, 5), (0, 0, 6), (3, 0, 0)):
        mesh.verts.new(place)
    mesh.verts.ensure_lookup_table()
    mesh.edges.new(mesh.verts[-3:-1])
    mesh.edges.new((mesh.verts[-1], mesh.verts[0]))


def hole(mesh):
    bmesh.ops.delete(mesh, geom=[face for face in mesh.faces if face.calc_center_median().z > 0.9], context="FACES")


def limb_cut_off(mesh):
    bmesh.ops.delete(mesh, geom=[vertex for vertex in mesh.verts if vertex.co.x > 1.2], context="VERTS")


def seam(mesh):
    half = [face for face in mesh.faces if face.calc_center_median().y > 0]
    bmesh.ops.split(mesh, geom=half)


def soup(mesh):
    bmesh.ops.triangulate(mesh, faces=mesh.faces)
    bmesh.ops.split_edges(mesh, edges=mesh.edges)


def fin(mesh):
    edge = mesh.edges[len(mesh.edges) // 2]
    top = mesh.verts.new(1.3 * edge.verts[0].co)
    mesh.faces.new((*edge.verts, top))


def needles_and_flat_faces(mesh):
    bmesh.ops.poke(mesh, faces=mesh.faces[40:60])
    mesh.verts.ensure_lookup_table()
    for vertex in mesh.verts[-20:]:
        vertex.co = vertex.link_edges[0].other_vert(vertex).co  # a triangle without area and two needles


def some_turned(mesh):
    bmesh.ops.reverse_faces(mesh, faces=list(mesh.faces)[::5])


def all_turned(mesh):
    bmesh.ops.reverse_faces(mesh, faces=mesh.faces[:])


def ngons(mesh):
    bmesh.ops.dissolve_limit(mesh, angle_limit=0.25, verts=mesh.verts, edges=mesh.edges)


def same_face_twice(mesh):
    copies = bmesh.ops.duplicate(mesh, geom=mesh.faces[10:14])
    bmesh.ops.remove_doubles(mesh, verts=[v for v in copies["geom"] if isinstance(v, bmesh.types.BMVert)], dist=1e-6)


MESSES = {
    "parts": with_parts,
    "loose vertices and wires": loose_vertices_and_wires,
    "hole": hole,
    "limb cut off": limb_cut_off,
    "seam": seam,
    "soup": soup,
    "fin": fin,
    "needles": needles_and_flat_faces,
    "some turned": some_turned,
    "all turned": all_turned,
    "n-gons": ngons,
    "double faces": same_face_twice,
}


@pytest.mark.parametrize("mess", MESSES)
def test_a_mess_is_matched(mess):
    source, target = add_pair()
    edited(source, lambda _: None)
    change = MESSES[mess]
    if mess == "parts":
        change(target)
    else:
        edited(target, change)
    assert bpy.ops.hiermatch.match(source="Source", target="Target", **DENSE) == {"FINISHED"}
    maps = maps_of(source, target)
    for obj, sides in ((source, maps), (target, maps.reverse)):
        way = sides.source_to_target
        assert len(way) == len(obj.data.vertices)
        assert all(np.isfinite(array).all() for array in (way.positions, way.barycentric, way.confidence))
        for name in (*MAP_ATTRIBUTES, "HM Match", "HM Distortion", "HM Distortion Value", "HM Confidence"):
            assert np.isfinite(values_of(obj.data.attributes[name])).all()
    # The target stands beside the source, twice as large: most vertices come where they are.
    home = (maps.target.vertices - np.array(target.location)) / 2
    on_main = np.linalg.norm(home, axis=1) < 2
    errors = np.linalg.norm(maps.target_to_source.positions - home, axis=1) / np.sqrt(maps.source.area)
    assert np.median(errors[on_main]) < (0.1 if mess == "limb cut off" else 0.03)
    assert bpy.context.scene.hiermatch.summary.verdict


def one_triangle():
    return [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]


def line():
    return [(i, 0, 0) for i in range(60)], [(i, i + 1, i + 2) for i in range(58)]


def point():
    return [(1, 1, 1)] * 60, [(i, i + 1, i + 2) for i in range(58)]


def twice_used():
    return [(i, i * i, 0) for i in range(60)], [(i, i, i + 1) for i in range(59)]


def infinite():
    return [(i, i * i, float("inf") if i == 7 else 0) for i in range(60)], [(i, i + 1, i + 2) for i in range(58)]


def crumbs():
    return [(i % 3, i // 3, i % 2) for i in range(60)], [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(20)]


HOPELESS = [one_triangle, line, point, twice_used, infinite, crumbs]


@pytest.mark.parametrize("make", HOPELESS)
@pytest.mark.parametrize("role", ["source", "target"])
def test_what_is_hopeless_is_refused_in_a_sentence(make, role):
    add_pair()
    data = bpy.data.meshes.new("Broken")
    vertices, faces = make()
    data.from_pydata(vertices, [], faces)
    bpy.context.collection.objects.link(bpy.data.objects.new("Broken", data))
    before = repr(snapshot())
    names = {"source": "Source", "target": "Target"} | {role: "Broken"}
    with pytest.raises(RuntimeError) as told:
        bpy.ops.hiermatch.match(**names, **DENSE)
    assert "Traceback" not in str(told.value)
    assert str(told.value).strip().endswith((".", ".)"))
    assert repr(snapshot()) == before
